//! Writing plantri's codes.

use super::{PlantriCode, PlantriWriteError};
use crate::embedded_graph::EmbeddedGraph;

/// The worlds in one of the codes, with its header.
///
/// `planar_code` gets the bare header, or `>>planar_code le<<` if a world has more than 255 vertices.
///
/// # Errors
/// Returns an error if `planar_code` cannot represent a world.
pub fn write(worlds: &[EmbeddedGraph], code: PlantriCode) -> Result<Vec<u8>, PlantriWriteError> {
    match code {
        PlantriCode::Planar => write_planar_code(worlds),
        PlantriCode::Edge => {
            let mut bytes = b">>edge_code<<".to_vec();
            for graph in worlds {
                push_edge_code(&mut bytes, graph);
            }
            Ok(bytes)
        }
    }
}

fn write_planar_code(worlds: &[EmbeddedGraph]) -> Result<Vec<u8>, PlantriWriteError> {
    let is_large = |graph: &EmbeddedGraph| graph.vertex_count() > 255;
    let header: &[u8] =
        if worlds.iter().any(is_large) { b">>planar_code le<<" } else { b">>planar_code<<" };
    let mut bytes = header.to_vec();
    for (number, graph) in worlds.iter().enumerate() {
        let world = number + 1;
        let vertices = graph.vertex_count();
        if !graph.is_simple() {
            return Err(PlantriWriteError::NotSimple { world });
        }
        if vertices > usize::from(u16::MAX) {
            return Err(PlantriWriteError::TooManyVertices { world, vertices });
        }
        let size = if is_large(graph) {
            bytes.push(0);
            2
        } else {
            1
        };
        let mut push = |number: u32| bytes.extend(&number.to_le_bytes()[..size]);
        push(vertices as u32);
        for vertex in graph.vertices() {
            for dart in graph.darts_of(vertex) {
                push(graph.vertex(graph.opposite(dart)).0 + 1);
            }
            push(0);
        }
    }
    Ok(bytes)
}

fn push_edge_code(bytes: &mut Vec<u8>, graph: &EmbeddedGraph) {
    let edge_of = graph.edge_numbers();
    let body = |edge_bytes: usize| edge_bytes * graph.dart_count() + graph.vertex_count() - 1;
    let edge_bytes = if body(1) <= 255 {
        bytes.push(body(1) as u8);
        1
    } else {
        let edge_bytes = bytes_of_edges(graph.edge_count());
        let length = body(edge_bytes).to_be_bytes();
        let leading = length.iter().take_while(|&&byte| byte == 0).count();
        let length_bytes = length.len() - leading;
        bytes.extend([0, (16 * length_bytes + edge_bytes) as u8]);
        bytes.extend(&length[leading..]);
        edge_bytes
    };
    for vertex in graph.vertices() {
        if vertex.0 > 0 {
            bytes.push(255);
        }
        for dart in graph.darts_of(vertex) {
            bytes.extend(&edge_of[dart.at()].to_be_bytes()[4 - edge_bytes..]);
        }
    }
}

/// The number of bytes for every edge's number, so that its first byte is not 255.
fn bytes_of_edges(edges: usize) -> usize {
    (1..4).find(|&size| edges <= 255 << (8 * (size - 1))).unwrap_or(4)
}
