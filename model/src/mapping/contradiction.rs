//! The errors of a run: the world fails, it contradicts itself, a step is invalid, or the bound is
//! reached.

use std::fmt;

use thiserror::Error;

use crate::{
    counts::grouped,
    embedded_graph::{Dart, Vertex},
    folding::ContradictionReason,
    percept::{Percept, Sighting},
};

/// Why a map could not be made.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum MappingError<E> {
    /// Sensing or moving failed.
    #[error(transparent)]
    World(E),
    /// No world has these percepts.
    #[error("the world contradicts itself: {0}")]
    Contradiction(Contradiction),
    /// A step was not valid in the state of the run, or a choice was not open.
    #[error("invalid step: {0}")]
    InvalidStep(InvalidStep),
    /// The explorer gave up.
    #[error("the explorer gave up: {0}")]
    GaveUp(String),
    /// More darts are known than the bound allows.
    #[error(
        "more than {} darts (edge ends) are known, and the map is not complete",
        grouped(*bound as u128)
    )]
    Bound {
        /// The bound.
        bound: usize,
    },
}

impl<E> From<Contradiction> for MappingError<E> {
    fn from(contradiction: Contradiction) -> Self {
        Self::Contradiction(contradiction)
    }
}

impl<E> From<InvalidStep> for MappingError<E> {
    fn from(step: InvalidStep) -> Self {
        Self::InvalidStep(step)
    }
}

/// A step that is not valid in the state of the run, or a choice that is not open. Vertices and darts
/// are those of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum InvalidStep {
    /// The dart to explore, or to close a loop with, is not an unexplored one.
    #[error("dart {} of the map is not unexplored", .0.0)]
    NotUnexplored(Dart),
    /// A loop cannot be closed by the dart that is being explored.
    #[error("dart {} of the map cannot be both ends of an edge", .0.0)]
    SameDart(Dart),
    /// No hypothesis has this index.
    #[error("hypothesis {index} does not exist, {left} left")]
    NoHypothesis {
        /// The index.
        index: usize,
        /// The number of hypotheses that are left.
        left: usize,
    },
    /// An edge is chosen while another is being explored.
    #[error("dart {} of the map is still being explored", .0.0)]
    EdgeInProgress(Dart),
    /// The folding explorer has nothing to do, and its trail is not complete.
    #[error("there is nothing left to do, and the trail is not complete")]
    NoPlan,
    /// No edge is being explored.
    #[error("no edge is being explored")]
    NoEdge,
    /// The explorer needs a marker that the robot can carry.
    #[error("the robot cannot carry its marker")]
    NoMovableMarker,
    /// The vertex is not in the map.
    #[error("the map has no vertex v{}", .0.0)]
    UnknownVertex(Vertex),
}

/// A percept that contradicts the earlier ones. Vertices and darts are those of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Contradiction {
    /// At the start the directional marker must be seen pointing along door 0.
    #[error("at the start the marker must point along door 0, but there is {}", Seen(perceived))]
    Start {
        /// The percept.
        perceived: Percept,
    },
    /// The movable marker must lie at the start.
    #[error("the marker must lie at the start, but there is {}", Seen(perceived))]
    StartWithoutMarker {
        /// The percept.
        perceived: Percept,
    },
    /// A vertex with no door, or a marker that points along a door that is not there.
    #[error("no vertex looks like this: {}", Seen(perceived))]
    Impossible {
        /// The percept.
        perceived: Percept,
    },
    /// A known place looks different.
    #[error(
        "at the known vertex v{}, entered by its dart {index}: expected {}, found {}",
        vertex.0, Seen(expected), Seen(perceived)
    )]
    KnownPlace {
        /// The vertex.
        vertex: Vertex,
        /// The index of the dart by which it was entered.
        index: u32,
        /// The percept by the map.
        expected: Percept,
        /// The percept.
        perceived: Percept,
    },
    /// The marker is seen at the far end of an unexplored edge, where no unexplored dart of the
    /// marked vertex agrees with it.
    #[error(
        "behind the unexplored dart {index} of vertex v{} there is {}, which agrees with no \
         unexplored dart of the marked vertex",
        vertex.0, Seen(perceived)
    )]
    Marker {
        /// The vertex from which the unexplored edge left.
        vertex: Vertex,
        /// The index of its dart.
        index: u32,
        /// The percept.
        perceived: Percept,
    },
    /// A marker is seen at the far end of an unexplored edge while the robot carries it.
    #[error(
        "the robot carries the marker, but behind the unexplored dart {index} of vertex v{} there \
         is {}",
        vertex.0, Seen(perceived)
    )]
    SecondMarker {
        /// The vertex from which the unexplored edge left.
        vertex: Vertex,
        /// The index of its dart.
        index: u32,
        /// The percept.
        perceived: Percept,
    },
    /// Both ends of an unexplored edge are at known vertices, but no unexplored dart of the one
    /// leads to the marker at the other.
    #[error(
        "an unexplored edge joins the vertices v{} and v{}, but no unexplored dart of v{} leads to \
         the marker at v{}",
        marked.0, vertex.0, vertex.0, marked.0
    )]
    NoBackLink {
        /// The vertex whose unexplored darts were tried.
        vertex: Vertex,
        /// The vertex at which the marker lies.
        marked: Vertex,
    },
    /// A place looks different on the way back: from a rejected hypothesis, or to a marker that was
    /// left there.
    #[error("on the way back: expected {}, found {}", Seen(expected), Seen(perceived))]
    WayBack {
        /// The percept there on the way out, seen from the new entry, with the marker if the robot left
        /// it there.
        expected: Percept,
        /// The percept on the way back.
        perceived: Percept,
    },
    /// An audit of the map found another percept than the map predicts.
    #[error("the audit of the map: expected {}, found {}", Seen(expected), Seen(perceived))]
    Audit {
        /// The percept by the map.
        expected: Percept,
        /// The percept.
        perceived: Percept,
    },
    /// Lengths of hallways, or other measurements, contradict each other.
    #[error(
        "the measurements of the hallways contradict each other: the robot was moved, or its wheels slipped"
    )]
    Moved,
    /// A hallway that was blocked is free.
    #[error("a door that was blocked is free")]
    Unblocked,
    /// A robot that looks for the marker has seen every place that it can reach, or has looked for too long.
    #[error("the marker is not found; perhaps an obstacle cuts the robot off from it")]
    NoMarker,
    /// The folded trail contradicts itself.
    #[error("{reason}")]
    Trail {
        /// The reason.
        reason: ContradictionReason,
        /// The percept of the place before, seen from the new entry, if the robot came there along edges that
        /// it knew. Otherwise it is not known which percept is false.
        expected: Option<Percept>,
    },
}

/// A percept in words.
struct Seen<'p>(&'p Percept);

impl fmt::Display for Seen<'_> {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let Percept { degree, sighting } = self.0;
        write!(out, "degree {degree} ")?;
        match sighting {
            Sighting::Nothing => write!(out, "without the marker"),
            Sighting::Pointing(_) => write!(out, "with the {sighting}"),
            Sighting::Lying(1) => write!(out, "with a marker lying there"),
            _ => write!(out, "with a sign of another kind of marker ({sighting})"),
        }
    }
}
