//! One directional marker that stays where it is: that of Algorithm 1. Section 2.3.

use super::{Marker, MarkerPart};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    percept::{Door, Sighting},
};

/// One directional marker at the start vertex: there the robot senses along which door it points,
/// which is the door of the facing dart.
// paper: marker.directional-sufficient
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Directional;

impl Marker for Directional {
    fn name(&self) -> &'static str {
        "directional"
    }

    fn about(&self) -> &'static str {
        "one directional marker at the start vertex: is it here, and which door does it point along?"
    }

    #[inline]
    fn sighting(&self, graph: &EmbeddedGraph, facing: Dart, pose: Dart) -> Sighting {
        if graph.vertex(pose) != graph.vertex(facing) {
            return Sighting::Nothing;
        }
        let (from, to) = (graph.index(pose), graph.index(facing));
        Sighting::Pointing(Door::between(from, to, graph.degree_around(pose)))
    }

    fn first_alike(&self, _: &EmbeddedGraph, facing: Dart) -> Dart {
        facing
    }

    fn starts(&self, _: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        vec![facing]
    }

    fn parts(&self, _: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        vec![MarkerPart::Pointing(facing)]
    }

    fn is_local(&self) -> bool {
        true
    }
}
