//! A world that is only known from a recorded run.

use thiserror::Error;

use super::Trace;
use crate::{
    aid::{Action, AidAction},
    mapping::ObservedWorld,
    percept::{Door, Percept},
    world::{AidHandler, World},
};

/// A world with the recorded percepts, as long as the recorded actions are done.
#[derive(Clone, Debug)]
pub struct TraceWorld<'t> {
    trace: &'t Trace,
    position: TracePosition,
    /// Whether the robot is on the way to a vertex to which it came after it got lost.
    is_lost: bool,
}

/// How much of a trace was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct TracePosition {
    pub moves: usize,
    /// The number of actions with the marking aid since the last move.
    pub actions: usize,
}

/// Why a recorded world cannot continue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum TraceWorldError {
    #[error("the robot did `{recorded}` then, not `{asked}`")]
    Action { recorded: Action, asked: Action },
    #[error("the trace ends here, or does not record what the robot perceived")]
    End,
    #[error("the robot got lost")]
    Lost,
}

impl<'t> TraceWorld<'t> {
    /// The world of a trace, with the robot where it is after some moves.
    pub fn after(trace: &'t Trace, moves: usize) -> Self {
        Self::at(trace, TracePosition { moves, actions: 0 })
    }

    /// The world of a trace, of which so much was done.
    pub fn at(trace: &'t Trace, position: TracePosition) -> Self {
        Self { trace, position, is_lost: false }
    }

    /// A robot that got lost comes to the next vertex. Returns whether it was lost.
    pub(super) fn relocate(&mut self) -> bool {
        let was_lost = std::mem::take(&mut self.is_lost);
        if was_lost {
            self.move_on();
        }
        was_lost
    }

    /// The moves made so far.
    pub fn moves(&self) -> usize {
        self.position.moves
    }

    pub fn position(&self) -> TracePosition {
        self.position
    }

    /// What the robot did next.
    fn recorded(&self) -> Result<Action, TraceWorldError> {
        let TracePosition { moves, actions } = self.position;
        let aid = self.trace.actions_after(moves).get(actions).map(|next| Action::Do(next.action));
        let door = || self.trace.doors().get(moves).copied().map(Action::Take);
        aid.or_else(door).ok_or(TraceWorldError::End)
    }

    fn check(&self, asked: Action) -> Result<(), TraceWorldError> {
        let recorded = self.recorded()?;
        if recorded == asked { Ok(()) } else { Err(TraceWorldError::Action { recorded, asked }) }
    }

    fn move_on(&mut self) {
        self.position = TracePosition { moves: self.position.moves + 1, actions: 0 };
    }
}

impl ObservedWorld for TraceWorld<'_> {}

impl World for TraceWorld<'_> {
    type Error = TraceWorldError;

    /// After an action with the aid, what is recorded then. If nothing is, it is not known.
    fn percept(&mut self) -> Result<Percept, TraceWorldError> {
        let TracePosition { moves, actions } = self.position;
        let last =
            actions.checked_sub(1).and_then(|last| self.trace.actions_after(moves).get(last));
        let percept = match last {
            Some(action) => action.percept(),
            None => self.trace.percepts().get(moves).copied(),
        };
        percept.ok_or(TraceWorldError::End)
    }

    fn traverse(&mut self, asked: Door) -> Result<(), TraceWorldError> {
        self.check(Action::Take(asked))?;
        if self.trace.is_relocation(self.position.moves + 1) {
            self.is_lost = true;
            return Err(TraceWorldError::Lost);
        }
        self.move_on();
        Ok(())
    }

    fn handler(&mut self) -> Option<&mut dyn AidHandler<Error = TraceWorldError>> {
        Some(self)
    }
}

impl AidHandler for TraceWorld<'_> {
    type Error = TraceWorldError;

    fn handle(&mut self, action: AidAction) -> Result<(), TraceWorldError> {
        self.check(Action::Do(action))?;
        self.position.actions += 1;
        Ok(())
    }
}
