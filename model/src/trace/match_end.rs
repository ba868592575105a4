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
    EndOfTrace,
    /// To an event that it does not have.
    Departure(Departure),
    /// To an event at which it would know more darts than a bound allows. What follows is not matched.
    Bound {
        event: TraceEvent,
        bound: usize,
    },
}

/// The first event of a trace that no run of an algorithm has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Departure {
    pub algorithm: MappingAlgorithm,
    pub event: TraceEvent,
    /// What the algorithm does there instead, for each choice that leads there.
    pub allowed: Vec<AllowedStep>,
}

/// What an algorithm does instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AllowedStep {
    pub door: Option<Door>,
    pub purpose: StepPurpose,
}

impl fmt::Display for AllowedStep {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        if let Some(door) = self.door {
            write!(out, "door {} ({})", door.0, self.purpose)
        } else {
            write!(out, "{}", self.purpose)
        }
    }
}

/// Why a run along a trace ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RunStop {
    EndOfTrace,
    /// The run has something else than this event.
    Departure {
        event: WalkEvent,
        allowed: AllowedStep,
    },
    /// What the run would do after this event is not known.
    Bound {
        event: WalkEvent,
        bound: usize,
    },
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

    /// At the end of a run, after some moves, with a purpose; `None` if the trace ends, too.
    pub(super) fn after_end(moves: usize, purpose: StepPurpose, trace: &Trace) -> Option<Self> {
        let allowed = AllowedStep { door: None, purpose };
        let stop = Self::Departure { event: WalkEvent::Door(moves), allowed };
        (moves != trace.doors().len()).then_some(stop)
    }
}

impl MatchEnd {
    /// How far the only run of an algorithm follows a trace, which may have stopped.
    pub(super) fn of_only_run(
        stop: Option<RunStop>,
        algorithm: MappingAlgorithm,
        trace: &Trace,
    ) -> Self {
        let at = |event: WalkEvent| trace.event(event.index());
        match stop {
            None => Self::Mapped,
            Some(RunStop::EndOfTrace) => Self::EndOfTrace,
            Some(RunStop::Departure { event, allowed }) => {
                Self::Departure(Departure { algorithm, event: at(event), allowed: vec![allowed] })
            }
            Some(RunStop::Bound { event, bound }) => Self::Bound { event: at(event), bound },
        }
    }
}
