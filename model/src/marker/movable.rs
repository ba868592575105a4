//! One undirected marker that the robot can move. Section 2.3, after the paper's reference 8:
//! Dudek, Jenkin, Milios and Wilkes, "Robotic exploration as graph construction" (1991).

use super::{Marker, MarkerPart, Undirected};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    percept::Sighting,
};

/// One undirected marker, at the start vertex at first. At each vertex the robot senses whether it
/// lies there; it can pick it up at the vertex where it lies, carry it, and drop it at another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Movable;

impl Marker for Movable {
    fn name(&self) -> &'static str {
        "movable"
    }

    fn about(&self) -> &'static str {
        "one undirected marker, at the start vertex at first, that the robot can pick up, carry and \
         drop: is it here?"
    }

    fn sighting(&self, graph: &EmbeddedGraph, facing: Dart, pose: Dart) -> Sighting {
        Undirected.sighting(graph, facing, pose)
    }

    fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart {
        Undirected.first_alike(graph, facing)
    }

    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        Undirected.starts(graph, facing)
    }

    fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        Undirected.parts(graph, facing)
    }

    fn is_movable(&self) -> bool {
        true
    }

    fn is_local(&self) -> bool {
        true
    }
}
