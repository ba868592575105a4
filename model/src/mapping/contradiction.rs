//! The errors and flaws of a run.

use std::fmt;

use thiserror::Error;

use crate::{
    aid::RefusedAction,
    counts::grouped,
    embedded_graph::{Dart, GraphError, Vertex},
    folding::{ContradictionReason, MAX_DARTS, TrailError},
    percept::{Percept, Sighting},
};

/// Why a map could not be made.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum MappingError<E> {
    #[error(transparent)]
    World(E),
    #[error("the world contradicts itself: {0}")]
    Contradiction(Contradiction),
    #[error("invalid step: {0}")]
    InvalidStep(InvalidStep),
    #[error("the explorer gave up: {0}")]
    GaveUp(String),
    #[error(
        "more than {} darts (edge ends) are known, and the map is not complete",
        grouped(*bound as u128)
    )]
    Bound { bound: usize },
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

impl<E> From<TrailError> for MappingError<E> {
    fn from(error: TrailError) -> Self {
        match error {
            TrailError::Contradiction(reason) => {
                Contradiction::Trail { reason, expected: None }.into()
            }
            TrailError::TooManyDarts => Self::Bound { bound: MAX_DARTS },
        }
    }
}

/// A step that is not valid in the state of the run, or a choice that is not open. Vertices and darts
/// are those of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum InvalidStep {
    #[error("dart {} of the map is not unexplored", .0.0)]
    NotUnexplored(Dart),
    #[error("hypothesis {index} does not exist, {left} left")]
    NoHypothesis { index: usize, left: usize },
    #[error("dart {} of the map is still being explored", .0.0)]
    EdgeInProgress(Dart),
    #[error("there is nothing left to do, and the trail is not complete")]
    NoPlan,
    #[error("no edge is being explored")]
    NoEdge,
    #[error("the robot cannot carry its marker")]
    NoMovableMarker,
}

/// A percept that contradicts the earlier ones. Vertices and darts are those of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Contradiction {
    #[error("at the start the marker must point along door 0, but there is {}", Seen(perceived))]
    Start { perceived: Percept },
    #[error("the marker must lie at the start, but there is {}", Seen(perceived))]
    StartWithoutMarker { perceived: Percept },
    /// A vertex with no door, or a marker that points along a door that is not there.
    #[error("no vertex looks like this: {}", Seen(perceived))]
    Impossible { perceived: Percept },
    /// A known place, entered by its dart with this index, looks different.
    #[error(
        "at the known vertex v{}, entered by its dart {index}: expected {}, found {}",
        vertex.0, Seen(expected), Seen(perceived)
    )]
    KnownPlace { vertex: Vertex, index: u32, expected: Percept, perceived: Percept },
    /// The marker is seen at the far end of an unexplored edge, where no unexplored dart of the
    /// marked vertex agrees with it. The edge left the vertex by its dart with this index.
    #[error(
        "behind the unexplored dart {index} of vertex v{} there is {}, which agrees with no \
         unexplored dart of the marked vertex",
        vertex.0, Seen(perceived)
    )]
    Marker { vertex: Vertex, index: u32, perceived: Percept },
    /// A marker is seen at the far end of an unexplored edge while the robot carries it.
    #[error(
        "the robot carries the marker, but behind the unexplored dart {index} of vertex v{} there \
         is {}",
        vertex.0, Seen(perceived)
    )]
    SecondMarker { vertex: Vertex, index: u32, perceived: Percept },
    /// Both ends of an unexplored edge are at known vertices, but no unexplored dart of the one
    /// leads to the marker at the other.
    #[error(
        "an unexplored edge joins the vertices v{} and v{}, but no unexplored dart of v{} leads to \
         the marker at v{}",
        marked.0, vertex.0, vertex.0, marked.0
    )]
    NoBackLink { vertex: Vertex, marked: Vertex },
    /// A place looks different on the way back: from a rejected hypothesis, or to a marker that was
    /// left there. Expected is what was seen on the way out, from the new entry.
    #[error("on the way back: expected {}, found {}", Seen(expected), Seen(perceived))]
    WayBack { expected: Percept, perceived: Percept },
    #[error("the audit of the map: expected {}, found {}", Seen(expected), Seen(perceived))]
    Audit { expected: Percept, perceived: Percept },
    #[error(
        "the measurements of the hallways contradict each other: the robot was moved, or its wheels slipped"
    )]
    Moved,
    #[error("a door that was blocked is free")]
    Unblocked,
    /// A robot that looks for the marker has seen every place that it can reach, or has looked for too long.
    #[error("the marker is not found; perhaps an obstacle cuts the robot off from it")]
    NoMarker,
    #[error("{reason}")]
    Trail {
        reason: ContradictionReason,
        /// The percept of the place before, seen from the new entry, if the robot came there along edges that
        /// it knew. Otherwise it is not known which percept is false.
        expected: Option<Percept>,
    },
}

struct Seen<'p>(&'p Percept);

impl fmt::Display for Seen<'_> {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let Percept { degree, sighting } = self.0;
        write!(out, "degree {degree} ")?;
        match sighting {
            Sighting::Nothing => write!(out, "without the marker"),
            Sighting::Pointing(_) | Sighting::TwoMarkers(_) => write!(out, "with the {sighting}"),
            Sighting::Lying(1) => write!(out, "with a marker lying there"),
            Sighting::String(_) | Sighting::Team(_) | Sighting::Ball(_) | Sighting::Compass(_) => {
                write!(out, "with {sighting}")
            }
            _ => write!(out, "with a sign of another kind of marker ({sighting})"),
        }
    }
}

/// What is wrong with a run.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Flaw {
    /// It ended with an error: a door that does not exist, a contradiction, the bound.
    #[error(transparent)]
    Error(#[from] MappingError<RefusedAction>),
    #[error("it ended with {unexplored} edge ends unexplored")]
    Unfinished { unexplored: u32 },
    #[error("the map is not isomorphic to the world")]
    WrongMap,
    #[error(
        "the robot believes it came in by the map's dart {}, which is dart {} of the world, but it \
         came in by dart {}",
        believed.0, image.0, truly.0
    )]
    WrongPose { believed: Dart, image: Dart, truly: Dart },
    #[error("the map is not an embedded graph: {0}")]
    NoGraph(#[from] GraphError),
    /// The facing dart or the robot's pose is not a dart of the map.
    #[error("the map has no dart {dart}")]
    NoSuchDart { dart: u32 },
    #[error("it took {} moves; the bound is {}", grouped((*moves).into()), grouped((*bound).into()))]
    TooManyMoves { moves: u64, bound: u64 },
}

impl From<RefusedAction> for Flaw {
    fn from(refused: RefusedAction) -> Self {
        Self::Error(MappingError::World(refused))
    }
}

impl From<InvalidStep> for Flaw {
    fn from(step: InvalidStep) -> Self {
        Self::Error(step.into())
    }
}
