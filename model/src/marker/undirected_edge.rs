//! A mark on an edge that shows no sense.

use super::{Marker, MarkerPart};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    percept::Sighting,
};

/// A mark in the middle of the edge faced at the start. The robot notices it when, and only when, it
/// traverses that edge, in whichever sense. At the start it counts as having just done so.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct UndirectedEdge;

/// The ends of the edge of a dart, in the order of their numbers.
pub(super) fn ends(graph: &EmbeddedGraph, dart: Dart) -> [Dart; 2] {
    let other = graph.opposite(dart);
    [dart.min(other), dart.max(other)]
}

impl Marker for UndirectedEdge {
    fn name(&self) -> &'static str {
        "undirected-edge"
    }

    fn about(&self) -> &'static str {
        "a mark in the middle of the edge faced at the start: was it on the edge just traversed?"
    }

    fn sighting(&self, graph: &EmbeddedGraph, facing: Dart, pose: Dart) -> Sighting {
        if ends(graph, facing).contains(&pose) { Sighting::Passed } else { Sighting::Nothing }
    }

    fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart {
        ends(graph, facing)[0]
    }

    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        ends(graph, facing).to_vec()
    }

    fn parts(&self, _: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        vec![MarkerPart::OnEdge(facing)]
    }
}
