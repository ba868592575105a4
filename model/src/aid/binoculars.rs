//! Binoculars: the robot sees the embedded ball around its vertex, and has no marker. Chalopin, Godard and Naudin,
//! "Anonymous graph exploration with binoculars" (2015).
//!
//! As there, the robot sees the subgraph that the vertices within some distance induce, with the order of the doors. It
//! sees all doors of these vertices, also those that lead out of the ball.

use super::{Aid, PlaceNames, Places, State};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::MarkerPart,
    percept::{Ball, Door, Sighting},
};

/// Binoculars that reach so many edges far. They have no places.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Binoculars {
    /// From 1 to 3.
    radius: u8,
}

impl Binoculars {
    pub(super) const fn of(radius: u8) -> Self {
        Self { radius }
    }

    pub fn radius(self) -> u8 {
        self.radius
    }

    fn ball(self, graph: &EmbeddedGraph, pose: Dart) -> Ball {
        let around = |dart: Dart| {
            (0..graph.degree_around(dart)).map(|door| graph.behind(dart, Door(door))).collect()
        };
        Ball::around(pose, self.radius.into(), around, |dart| Some(graph.opposite(dart)))
    }
}

impl Aid for Binoculars {
    type Placed = Places;

    fn name(&self) -> &'static str {
        match self.radius {
            1 => "binoculars-1",
            2 => "binoculars-2",
            _ => "binoculars-3",
        }
    }

    fn about(&self) -> &'static str {
        match self.radius {
            1 => {
                "no marker, but binoculars that reach one edge far: which vertices are near, what doors do they have, and \
                 which edges join them?"
            }
            2 => {
                "no marker, but binoculars that reach two edges far: which vertices are near, what doors do they have, and \
                 which edges join them?"
            }
            _ => {
                "no marker, but binoculars that reach three edges far: which vertices are near, what doors do they have, \
                 and which edges join them?"
            }
        }
    }

    fn placed(&self, _graph: &EmbeddedGraph, _facing: Dart) -> Places {
        Places::from_slice(&[])
    }

    fn exists(&self, _graph: &EmbeddedGraph, placed: &Places) -> bool {
        placed.is_empty()
    }

    fn sighting(&self, graph: &EmbeddedGraph, state: &State<Places>) -> Sighting {
        Sighting::Ball(self.ball(graph, state.pose))
    }

    fn first_alike(&self, _graph: &EmbeddedGraph, _facing: Dart) -> Dart {
        Dart(0)
    }

    fn starts(&self, graph: &EmbeddedGraph, _facing: Dart) -> Vec<Dart> {
        graph.darts().collect()
    }

    fn parts(&self, _graph: &EmbeddedGraph, _facing: Dart) -> Vec<MarkerPart> {
        Vec::new()
    }

    fn placed_text(&self, _placed: &Places, _names: &dyn PlaceNames) -> String {
        String::new()
    }

    fn is_seen_everywhere(&self, graph: &EmbeddedGraph) -> bool {
        graph.darts().all(|pose| self.ball(graph, pose) != Ball::TOO_LARGE)
    }

    fn unseen_place(&self) -> String {
        "a vertex with more around it than 128 bits describe".to_owned()
    }
}
