//! An embedded graph for the scripts of pages: for each vertex and each of its darts, clockwise, the vertex and the index
//! of the other end.

use serde_json::{Value, json};
use toposlam_model::embedded_graph::{Dart, EmbeddedGraph};

pub(super) fn graph_json(graph: &EmbeddedGraph) -> Value {
    let vertex = |vertex| -> Value {
        graph.darts_of(vertex).map(|dart| dart_json(graph, graph.opposite(dart))).collect()
    };
    graph.vertices().map(vertex).collect()
}

/// The vertex of a dart, and its index there.
pub(super) fn dart_json(graph: &EmbeddedGraph, dart: Dart) -> Value {
    json!([graph.vertex(dart).at(), graph.index(dart)])
}
