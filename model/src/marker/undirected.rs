//! One undirected marker that stays where it is. Section 2.2.

use super::{Marker, MarkerLook, MarkerPart};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    percept::Sighting,
};

/// One undirected marker at the start vertex: at each vertex the robot senses whether it lies there.
// paper: marker.undirected-insufficient, marker.undirected-cycles
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Undirected;

impl Marker for Undirected {
    fn name(&self) -> &'static str {
        "undirected"
    }

    fn about(&self) -> &'static str {
        "one undirected marker at the start vertex: is it here?"
    }

    fn sighting(&self, graph: &EmbeddedGraph, facing: Dart, pose: Dart) -> Sighting {
        if graph.vertex(pose) == graph.vertex(facing) {
            Sighting::Lying(1)
        } else {
            Sighting::Nothing
        }
    }

    fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart {
        graph.first_dart(graph.vertex(facing))
    }

    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        graph.darts_of(graph.vertex(facing)).collect()
    }

    fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        vec![MarkerPart::At { vertex: graph.vertex(facing), look: MarkerLook::One }]
    }

    fn is_local(&self) -> bool {
        true
    }
}
