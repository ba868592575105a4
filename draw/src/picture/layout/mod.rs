//! The positions of the vertices, and of bends that keep loops and parallel edges apart.
//!
//! A planar embedded graph is laid out without crossings, any other graph by the lengths of its paths. The unit is the length of a usual edge; y points down.

mod planar;
mod planar_part;
mod radial;
mod refine;
mod stress;
mod subdivision;
mod upright;

use refine::Keep;
use subdivision::Subdivision;
use toposlam_model::embedded_graph::EmbeddedGraph;

use super::geometry::Point;

/// The most vertices of a polished layout; larger ones are plain.
pub(super) const POLISHED: usize = 120;

#[derive(Clone, Debug)]
pub(super) struct Layout {
    /// One point a vertex.
    pub(super) vertices: Vec<Point>,
    /// The bends of each edge, in the order of `EmbeddedGraph::edges`, from its first dart on.
    pub(super) bends: Vec<Vec<Point>>,
}

/// The most nodes, with bends, for which a planar layout is affordable.
const PLANAR: usize = 6000;

pub(super) fn lay_out(graph: &EmbeddedGraph) -> Layout {
    let mut layout = if graph.edge_count() > 2 * POLISHED {
        large(graph)
    } else if graph.genus() == 0 {
        in_the_plane(graph)
    } else {
        let part = planar_part::planar_part(graph);
        let in_part = part.map(|part| in_the_plane(&part).vertices);
        straight(stress::best(graph, in_part), graph)
    };
    upright::turn_upright(graph, &mut layout);
    layout
}

/// The layout of a graph that is too large for the best one.
fn large(graph: &EmbeddedGraph) -> Layout {
    if graph.edge_count() + 1 == graph.vertex_count() {
        return straight(radial::tree(graph), graph);
    }
    if graph.genus() == 0 {
        let subdivision = Subdivision::new(graph);
        if subdivision.nodes <= PLANAR {
            let points = planar::without_crossings(&subdivision, planar::EVENING);
            return layout_of(graph, &subdivision, &points);
        }
    }
    straight(stress::plain(graph), graph)
}

/// The layout with each vertex at its given position; there, y points up.
pub(super) fn given(graph: &EmbeddedGraph, positions: &[[f64; 2]]) -> Layout {
    let vertices = positions.iter().map(|&[x, y]| Point::new(x, -y)).collect();
    straight(vertices, graph)
}

fn in_the_plane(graph: &EmbeddedGraph) -> Layout {
    let subdivision = Subdivision::new(graph);
    let mut points = planar::without_crossings(&subdivision, 0);
    refine::refine(&subdivision, &mut points, Keep::Embedding);
    layout_of(graph, &subdivision, &points)
}

fn layout_of(graph: &EmbeddedGraph, subdivision: &Subdivision, points: &[Point]) -> Layout {
    let bends = subdivision.bends.iter();
    Layout {
        vertices: points[..graph.vertex_count()].to_vec(),
        bends: bends.map(|nodes| nodes.iter().map(|&node| points[node]).collect()).collect(),
    }
}

fn straight(vertices: Vec<Point>, graph: &EmbeddedGraph) -> Layout {
    Layout { vertices, bends: vec![Vec::new(); graph.edge_count()] }
}
