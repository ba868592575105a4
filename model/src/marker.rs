//! What a marker adds to a percept. Sections 2.2 and 2.3.

use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    percept::{Door, Sighting},
};

/// A marker that stays where it is.
pub trait Marker {
    /// What it adds to the percept of a robot that has just come in by the dart `pose`.
    fn sighting(&self, graph: &EmbeddedGraph, pose: Dart) -> Sighting;
}

/// One directional marker at the start vertex, which points along the facing dart.
// paper: marker.directional-sufficient
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Directional {
    /// The facing dart.
    pub along: Dart,
}

impl Marker for Directional {
    #[inline]
    fn sighting(&self, graph: &EmbeddedGraph, pose: Dart) -> Sighting {
        if graph.vertex(pose) != graph.vertex(self.along) {
            return Sighting::Nothing;
        }
        let (from, to) = (graph.index(pose), graph.index(self.along));
        Sighting::Pointing(Door::between(from, to, graph.degree_around(pose)))
    }
}
