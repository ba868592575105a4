//! A world that is only known from a recorded run.

use thiserror::Error;

use super::Trace;
use crate::{
    mapping::ObservedWorld,
    percept::{Door, Percept},
    world::World,
};

/// A world with the recorded percepts, as long as the recorded doors are taken.
#[derive(Clone, Debug)]
pub struct TraceWorld<'t> {
    trace: &'t Trace,
    moves: usize,
    /// Whether the robot is on the way to a vertex to which it came after it got lost.
    is_lost: bool,
}

/// Why a recorded world cannot continue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum TraceWorldError {
    #[error("door {} was taken then, not door {}", recorded.0, asked.0)]
    Door { recorded: Door, asked: Door },
    #[error("the trace ends here")]
    End,
    #[error("the robot got lost")]
    Lost,
}

impl<'t> TraceWorld<'t> {
    /// The world of a trace, with the robot where it is after some moves.
    pub fn after(trace: &'t Trace, moves: usize) -> Self {
        Self { trace, moves, is_lost: false }
    }

    /// A robot that got lost comes to the next vertex. Returns whether it was lost.
    pub(super) fn relocate(&mut self) -> bool {
        let was_lost = std::mem::take(&mut self.is_lost);
        self.moves += usize::from(was_lost);
        was_lost
    }

    /// The moves made so far.
    pub fn moves(&self) -> usize {
        self.moves
    }
}

impl ObservedWorld for TraceWorld<'_> {}

impl World for TraceWorld<'_> {
    type Error = TraceWorldError;

    fn percept(&mut self) -> Result<Percept, TraceWorldError> {
        self.trace.percepts().get(self.moves).copied().ok_or(TraceWorldError::End)
    }

    fn traverse(&mut self, asked: Door) -> Result<(), TraceWorldError> {
        match self.trace.doors().get(self.moves) {
            None => Err(TraceWorldError::End),
            Some(&recorded) if recorded != asked => Err(TraceWorldError::Door { recorded, asked }),
            Some(_) if self.trace.is_relocation(self.moves + 1) => {
                self.is_lost = true;
                Err(TraceWorldError::Lost)
            }
            Some(_) => {
                self.moves += 1;
                Ok(())
            }
        }
    }
}
