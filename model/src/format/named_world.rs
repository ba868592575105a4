//! A world with the names that its file gives to its vertices and edges.

use crate::embedded_graph::{Dart, EmbeddedGraph};

/// A world as a file tells it.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedWorld {
    /// What the world is called.
    pub name: String,
    /// What it is, in a line or two; may be empty.
    pub about: String,
    /// The embedded graph; its vertices and darts are numbered in the order of the file.
    pub graph: EmbeddedGraph,
    /// The facing dart, where the file has a start.
    pub start: Option<Dart>,
    /// The name of each vertex.
    pub vertex_names: Vec<String>,
    /// The name of each dart's edge, one entry a dart; `None` where the file speaks of neighbours.
    pub edge_names: Option<Vec<String>>,
    /// Where each vertex is, where the world is a floor plan: metres, x to the east, y to the north.
    pub positions: Option<Vec<[f64; 2]>>,
}
