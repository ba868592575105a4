//! A world that is only known from a recorded run.

use thiserror::Error;

use super::Trace;
use crate::{
    percept::{Door, Percept},
    world::World,
};

/// A world with the recorded percepts, as long as the recorded doors are taken.
#[derive(Clone, Debug)]
pub struct TraceWorld<'t> {
    trace: &'t Trace,
    moves: usize,
}

/// Why a recorded world cannot continue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum TraceWorldError {
    /// Another door was taken.
    #[error("door {} was taken then, not door {}", recorded.0, asked.0)]
    Door {
        /// The door that was taken.
        recorded: Door,
        /// The door that the algorithm takes.
        asked: Door,
    },
    /// The trace has no further event.
    #[error("the trace ends here")]
    End,
}

impl<'t> TraceWorld<'t> {
    /// The world of a trace, with the robot where it is after some moves.
    #[must_use]
    pub fn after(trace: &'t Trace, moves: usize) -> Self {
        Self { trace, moves }
    }

    /// The moves made so far.
    #[must_use]
    pub fn moves(&self) -> usize {
        self.moves
    }
}

impl World for TraceWorld<'_> {
    type Error = TraceWorldError;

    fn percept(&mut self) -> Result<Percept, TraceWorldError> {
        self.trace.percepts().get(self.moves).copied().ok_or(TraceWorldError::End)
    }

    fn traverse(&mut self, asked: Door) -> Result<(), TraceWorldError> {
        match self.trace.doors().get(self.moves) {
            None => Err(TraceWorldError::End),
            Some(&recorded) if recorded != asked => Err(TraceWorldError::Door { recorded, asked }),
            Some(_) => {
                self.moves += 1;
                Ok(())
            }
        }
    }
}
