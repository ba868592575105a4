//! Two undirected markers that look different, at the ends of an edge.

use super::{Marker, MarkerLook, MarkerPart};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    percept::Sighting,
};

/// Two undirected markers that look different: the first at the start vertex, the second at the
/// other end of the edge faced. At each vertex the robot senses which of them lie there. With a loop
/// faced, both lie at the start vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TwoDistinct;

/// The vertices at the ends of the edge of a dart: its own, and the other.
pub(super) fn vertices(graph: &EmbeddedGraph, dart: Dart) -> [Vertex; 2] {
    [graph.vertex(dart), graph.vertex(graph.opposite(dart))]
}

impl Marker for TwoDistinct {
    fn name(&self) -> &'static str {
        "two-distinct"
    }

    fn about(&self) -> &'static str {
        "two undirected markers that look different, at the start vertex and at the other end of the \
         edge faced: which of them are here?"
    }

    fn sighting(&self, graph: &EmbeddedGraph, facing: Dart, pose: Dart) -> Sighting {
        let here = graph.vertex(pose);
        match vertices(graph, facing).map(|vertex| vertex == here) {
            [false, false] => Sighting::Nothing,
            [true, false] => Sighting::First,
            [false, true] => Sighting::Second,
            [true, true] => Sighting::Both,
        }
    }

    fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart {
        let [here, there] = vertices(graph, facing);
        let alike = |dart: &Dart| graph.vertex(graph.opposite(*dart)) == there;
        graph.darts_of(here).find(alike).unwrap_or(facing)
    }

    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        graph.darts_of(graph.vertex(facing)).collect()
    }

    fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        let [first, second] = vertices(graph, facing);
        vec![
            MarkerPart::At { vertex: first, look: MarkerLook::One },
            MarkerPart::At { vertex: second, look: MarkerLook::Other },
        ]
    }
}
