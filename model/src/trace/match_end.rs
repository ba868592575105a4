//! How far an algorithm follows a trace, and what it does instead of the first event that differs.
//! Section 2.3.

use std::fmt;

use super::{Trace, TraceEvent, TracePosition, TraceWorldError};
use crate::{
    aid::Action,
    mapping::{MappingAlgorithm, MappingError, StepPurpose},
    percept::WalkEvent,
};

/// How far an algorithm follows a trace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MatchEnd {
    /// To the end of both: the map is complete.
    Mapped,
    /// To its end, or to a percept that is not recorded.
    EndOfTrace,
    /// To an event that it does not have.
    Departure(Departure),
    /// To an event at which it would know more darts than a bound allows. What follows is not matched.
    Bound { event: TraceEvent, bound: usize },
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
    pub action: Option<Action>,
    pub purpose: StepPurpose,
}

impl fmt::Display for AllowedStep {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self.action {
            Some(Action::Take(door)) => write!(out, "door {} ({})", door.0, self.purpose),
            Some(Action::Do(action)) => write!(out, "{action} ({})", self.purpose),
            None => write!(out, "{}", self.purpose),
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
    /// The run has something else than the next action with the marking aid.
    AtAction {
        position: TracePosition,
        allowed: AllowedStep,
    },
    /// The run contradicts what was perceived after the last action with the marking aid.
    AfterAction {
        position: TracePosition,
        allowed: AllowedStep,
    },
    /// What the run would do after this event is not known.
    Bound {
        event: WalkEvent,
        bound: usize,
    },
}

impl RunStop {
    /// Why a step with a purpose failed, where it did.
    pub(super) fn new(
        error: &MappingError<TraceWorldError>,
        position: TracePosition,
        purpose: StepPurpose,
    ) -> Self {
        let moves = position.moves;
        let event = WalkEvent::Percept(moves);
        let contradicted = |purpose| {
            let allowed = AllowedStep { action: None, purpose };
            match position.actions {
                0 => Self::Departure { event, allowed },
                _ => Self::AfterAction { position, allowed },
            }
        };
        match error {
            MappingError::World(TraceWorldError::End) => Self::EndOfTrace,
            MappingError::World(TraceWorldError::Lost) => {
                let allowed = AllowedStep { action: None, purpose: StepPurpose::Lost };
                Self::Departure { event: WalkEvent::Percept(moves + 1), allowed }
            }
            MappingError::World(TraceWorldError::Action { recorded, asked }) => {
                let allowed = AllowedStep { action: Some(*asked), purpose };
                match recorded {
                    Action::Take(_) => Self::Departure { event: WalkEvent::Door(moves), allowed },
                    Action::Do(_) => Self::AtAction { position, allowed },
                }
            }
            MappingError::Contradiction(contradiction) => {
                contradicted(StepPurpose::Contradicted(*contradiction))
            }
            MappingError::InvalidStep(step) => contradicted(StepPurpose::InvalidStep(*step)),
            MappingError::GaveUp(_) => contradicted(StepPurpose::GaveUp),
            MappingError::Bound { bound } => Self::Bound { event, bound: *bound },
        }
    }

    /// At the end of a run, with a purpose; `None` if the trace ends, too.
    pub(super) fn after_end(
        position: TracePosition,
        purpose: StepPurpose,
        trace: &Trace,
    ) -> Option<Self> {
        let TracePosition { moves, actions } = position;
        let allowed = AllowedStep { action: None, purpose };
        if actions < trace.actions_after(moves).len() {
            return Some(Self::AtAction { position, allowed });
        }
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
            Some(RunStop::AtAction { position, allowed }) => {
                let TracePosition { moves, actions } = position;
                let done = trace.actions_after(moves).get(actions).map(|action| action.event());
                let event = done.unwrap_or_else(|| at(WalkEvent::Door(moves)));
                Self::Departure(Departure { algorithm, event, allowed: vec![allowed] })
            }
            Some(RunStop::AfterAction { position, allowed }) => {
                let TracePosition { moves, actions } = position;
                let done = trace.actions_after(moves).iter().take(actions);
                let seen = done.rev().find_map(|action| action.percept_event());
                let event = seen.unwrap_or_else(|| at(WalkEvent::Percept(moves)));
                Self::Departure(Departure { algorithm, event, allowed: vec![allowed] })
            }
            Some(RunStop::Bound { event, bound }) => Self::Bound { event: at(event), bound },
        }
    }
}
