//! A mark on an edge that shows a sense.

use super::{Marker, MarkerPart, undirected_edge::ends};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    percept::Sighting,
};

/// An arrow in the middle of the edge faced at the start, which points away from the start vertex.
/// The robot notices it when, and only when, it traverses that edge, and then in which sense. At the
/// start it counts as having just come in by the facing dart: against the arrow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DirectedEdge;

impl Marker for DirectedEdge {
    fn name(&self) -> &'static str {
        "directed-edge"
    }

    fn about(&self) -> &'static str {
        "an arrow in the middle of the edge faced at the start: was it on the edge just traversed, \
         and which way did it point?"
    }

    fn sighting(&self, graph: &EmbeddedGraph, facing: Dart, pose: Dart) -> Sighting {
        if pose == facing {
            Sighting::PassedAgainst
        } else if pose == graph.opposite(facing) {
            Sighting::PassedAlong
        } else {
            Sighting::Nothing
        }
    }

    fn first_alike(&self, _: &EmbeddedGraph, facing: Dart) -> Dart {
        facing
    }

    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        ends(graph, facing).to_vec()
    }

    fn parts(&self, _: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        vec![MarkerPart::OnEdgeAlong(facing)]
    }
}
