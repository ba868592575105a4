//! How far an algorithm follows a trace, and what it does instead of the first event that differs.
//! Section 2.3.

use std::fmt;

use super::{Trace, TraceEvent, TraceWorldError};
use crate::{
    mapping::{MappingAlgorithm, MappingError, StepPurpose},
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
    pub algorithm: MappingAlgorithm,
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
    pub(super) fn new(
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
            MappingError::GaveUp(_) => contradicted(StepPurpose::GaveUp),
            MappingError::Bound { bound } => Self::Bound { event, bound: *bound },
        }
    }

    /// The same, for the only run of an algorithm.
    pub(super) fn end(self, algorithm: MappingAlgorithm, trace: &Trace) -> MatchEnd {
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
