//! No marker at all. Section 2.2.

use super::{Marker, MarkerPart};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    percept::Sighting,
};

/// No marker: the robot senses degrees and nothing else, and may have begun anywhere.
// paper: marker.none-insufficient, marker.none-cycles
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoMarker;

impl Marker for NoMarker {
    fn name(&self) -> &'static str {
        "none"
    }

    fn about(&self) -> &'static str {
        "no marker at all: the robot senses the number of doors and nothing else"
    }

    fn sighting(&self, _: &EmbeddedGraph, _: Dart, _: Dart) -> Sighting {
        Sighting::Nothing
    }

    fn first_alike(&self, _: &EmbeddedGraph, _: Dart) -> Dart {
        Dart(0)
    }

    fn starts(&self, graph: &EmbeddedGraph, _: Dart) -> Vec<Dart> {
        graph.darts().collect()
    }

    fn parts(&self, _: &EmbeddedGraph, _: Dart) -> Vec<MarkerPart> {
        Vec::new()
    }

    fn is_local(&self) -> bool {
        true
    }
}
