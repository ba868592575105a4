//! How far an algorithm follows a trace, and what it does instead of the first event that differs.
//! Section 2.3.

use std::fmt;

use super::{Trace, TraceEvent, TraceWorldError};
use crate::{
    embedded_graph::Dart,
    mapping::{Contradiction, DirectionalAlgorithm, InvalidStep, MappingError, PartialMap},
    percept::{Door, WalkEvent},
};

/// How far an algorithm follows a trace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MatchEnd {
    /// To the end of both: the map is complete.
    Mapped,
    /// To the end of the trace.
    EndOfTrace,
    /// To an event that it does not have.
    Departure(Departure),
    /// To an event at which it would know more darts than a bound allows. What follows is not matched.
    Bound {
        /// The event.
        event: TraceEvent,
        /// The bound.
        bound: usize,
    },
}

/// The first event of a trace that no run of an algorithm has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Departure {
    /// The algorithm.
    pub algorithm: DirectionalAlgorithm,
    /// The event.
    pub event: TraceEvent,
    /// What the algorithm does there instead, for each choice that leads there.
    pub allowed: Vec<AllowedStep>,
}

/// What an algorithm does instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AllowedStep {
    /// The door that it takes, if any.
    pub door: Option<Door>,
    /// The purpose.
    pub purpose: StepPurpose,
}

/// A dart of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapDart {
    /// The vertex's number.
    pub vertex: u32,
    /// The index of the dart.
    pub index: u32,
}

impl MapDart {
    pub(super) fn of(map: &PartialMap, dart: Dart) -> Self {
        Self { vertex: map.vertex(dart).0, index: map.index(dart) }
    }
}

impl fmt::Display for MapDart {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        write!(out, "dart {} of vertex v{}", self.index, self.vertex)
    }
}

/// The purpose of a step of an algorithm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepPurpose {
    /// Lines 5 and 6 of Algorithm 1: to explore this dart.
    Explore(MapDart),
    /// Lines 10 to 15 of Algorithm 1: to follow the path of the hypothesis that it arrived by this dart, or
    /// to return.
    Try(MapDart),
    /// Line 4 of Algorithm 1: the map is complete.
    Done,
    /// The folding explorer goes to this open dart, and takes it.
    ExploreOpen(MapDart),
    /// The folding explorer tests whether these two darts are one edge.
    Test {
        /// The dart that was explored.
        edge: MapDart,
        /// The dart by which it may lead back into the map.
        hypothesis: MapDart,
    },
    /// The folding explorer has followed every dart.
    NoOpenDart,
    /// The robot audits its map.
    Audit,
    /// The audits of the map are over.
    Audited,
    /// The robot goes on with the folding explorer after a recovery.
    GoOn,
    /// The robot recovers, and looks for its marker.
    FindMarker,
    /// The robot tries the doors that are blocked once more.
    TryBlocked,
    /// The robot turns back to its marker, to keep within its budget.
    TurnBack,
    /// The robot got lost, and gives up.
    Lost,
    /// The percept is a contradiction.
    Contradicted(Contradiction),
    /// The step is not valid: the enumeration of choices is wrong.
    InvalidStep(InvalidStep),
}

impl fmt::Display for StepPurpose {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Explore(dart) => write!(out, "line 5: explores the unexplored {dart}"),
            Self::Try(dart) => write!(out, "line 9: tests whether it arrived by {dart}"),
            Self::Done => write!(out, "line 4: the map is complete"),
            Self::ExploreOpen(dart) => write!(out, "explores the open {dart}"),
            Self::Test { edge, hypothesis } => {
                write!(out, "tests whether {edge} leads to {hypothesis}")
            }
            Self::NoOpenDart => write!(out, "no dart is open: the map is complete"),
            Self::Audit => write!(out, "audits the map"),
            Self::Audited => write!(out, "the map is complete and audited"),
            Self::GoOn => write!(out, "goes on with the folding explorer"),
            Self::FindMarker => write!(out, "looks for its marker"),
            Self::TryBlocked => write!(out, "tries the blocked doors once more"),
            Self::TurnBack => write!(out, "turns back, to keep within its budget"),
            Self::Lost => write!(out, "the robot got lost, and gives up"),
            Self::Contradicted(contradiction) => write!(out, "{contradiction}"),
            Self::InvalidStep(step) => write!(out, "{step}"),
        }
    }
}

impl fmt::Display for AllowedStep {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        if let Some(door) = self.door {
            write!(out, "door {} (", door.0)?;
            write!(out, "{})", self.purpose)
        } else {
            write!(out, "{}", self.purpose)
        }
    }
}

/// Why a run along a trace ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RunStop {
    /// The trace has no further event.
    EndOfTrace,
    /// The run has something else than this event.
    Departure { event: WalkEvent, allowed: AllowedStep },
    /// What the run would do after this event is not known.
    Bound { event: WalkEvent, bound: usize },
}

impl RunStop {
    /// Why a step with a purpose failed, after some moves.
    pub(super) fn of(
        error: &MappingError<TraceWorldError>,
        moves: usize,
        purpose: StepPurpose,
    ) -> Self {
        let event = WalkEvent::Percept(moves);
        let contradicted =
            |purpose| Self::Departure { event, allowed: AllowedStep { door: None, purpose } };
        match error {
            MappingError::World(TraceWorldError::End) => Self::EndOfTrace,
            MappingError::World(TraceWorldError::Lost) => {
                let allowed = AllowedStep { door: None, purpose: StepPurpose::Lost };
                Self::Departure { event: WalkEvent::Percept(moves + 1), allowed }
            }
            MappingError::World(TraceWorldError::Door { asked, .. }) => {
                let allowed = AllowedStep { door: Some(*asked), purpose };
                Self::Departure { event: WalkEvent::Door(moves), allowed }
            }
            MappingError::Contradiction(contradiction) => {
                contradicted(StepPurpose::Contradicted(*contradiction))
            }
            MappingError::InvalidStep(step) => contradicted(StepPurpose::InvalidStep(*step)),
            MappingError::Bound { bound } => Self::Bound { event, bound: *bound },
        }
    }

    /// The same, for the only run of an algorithm.
    pub(super) fn end(self, algorithm: DirectionalAlgorithm, trace: &Trace) -> MatchEnd {
        match self {
            Self::EndOfTrace => MatchEnd::EndOfTrace,
            Self::Departure { event, allowed } => MatchEnd::Departure(Departure {
                algorithm,
                event: trace.event(event.index()),
                allowed: vec![allowed],
            }),
            Self::Bound { event, bound } => {
                MatchEnd::Bound { event: trace.event(event.index()), bound }
            }
        }
    }
}
