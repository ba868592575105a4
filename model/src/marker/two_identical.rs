//! Two undirected markers that look alike, at the ends of an edge.

use super::{Marker, MarkerLook, MarkerPart, TwoDistinct, two_distinct::vertices};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    percept::Sighting,
};

/// Two undirected markers that look alike, at the start vertex and at the other end of the edge
/// faced. At each vertex the robot senses how many lie there: with a loop faced, both lie at the
/// start vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TwoIdentical;

impl Marker for TwoIdentical {
    fn name(&self) -> &'static str {
        "two-identical"
    }

    fn about(&self) -> &'static str {
        "two undirected markers that look alike, at the start vertex and at the other end of the edge \
         faced: how many are here?"
    }

    fn sighting(&self, graph: &EmbeddedGraph, facing: Dart, pose: Dart) -> Sighting {
        let here = graph.vertex(pose);
        match vertices(graph, facing).iter().filter(|&&vertex| vertex == here).count() {
            0 => Sighting::Nothing,
            lying => Sighting::Lying(lying as u32),
        }
    }

    fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart {
        let first = |dart| TwoDistinct.first_alike(graph, dart);
        first(facing).min(first(graph.opposite(facing)))
    }

    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        let mut vertices = vertices(graph, facing).to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        vertices.into_iter().flat_map(|vertex| graph.darts_of(vertex)).collect()
    }

    fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        vertices(graph, facing)
            .map(|vertex| MarkerPart::At { vertex, look: MarkerLook::One })
            .to_vec()
    }
}
