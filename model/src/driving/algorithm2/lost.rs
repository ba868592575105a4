//! Why a path is given up, and where. Section 4.3.

use thiserror::Error;

use super::PathState;
use crate::percept::Door;

/// The robot no longer knows where it is.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{why}; {}, {since_turn:.2} m after the last turn to a door", about(*state))]
pub struct Lost {
    /// What happened.
    pub why: LostReason,
    /// The state of Algorithm 2.
    pub state: PathState,
    /// How far it had come since it last turned to a door, in metres of odometry.
    pub since_turn: f64,
}

/// What makes a robot give up a path.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum LostReason {
    /// Too many images in a row show no place where the robot could be.
    #[error("{images} images in a row do not show where the robot is")]
    Unknown {
        /// How many.
        images: u32,
    },
    /// The robot has gone too far without knowing where it is.
    #[error("no image of the last {metres:.2} m shows where the robot is")]
    Crept {
        /// How far.
        metres: f64,
    },
    /// The hallway runs otherwise than odometry says.
    #[error("the hallway runs {degrees:.0} degrees from where it should be by odometry")]
    Turned {
        /// By how much.
        degrees: f64,
    },
    /// Motions are not carried out.
    #[error("{times} commands in a row were not carried out")]
    Stalled {
        /// How many.
        times: u32,
    },
    /// The robot looks and turns without getting anywhere.
    #[error("the robot has made no progress in {rounds} images")]
    Idle {
        /// How many.
        rounds: u32,
    },
    /// There is no junction for too long.
    #[error("there is no junction after {metres:.0} m of hallway")]
    TooFar {
        /// How far the robot came.
        metres: f64,
    },
    /// The path asks for a door that is not there.
    #[error("there is no door {} at a junction with {degree}", .door.0)]
    NoSuchDoor {
        /// What was asked for.
        door: Door,
        /// How many there are.
        degree: u32,
    },
}

fn about(state: PathState) -> &'static str {
    match state {
        PathState::Leaving => "leaving a junction",
        PathState::Hallway => "in a hallway",
        PathState::Junction => "at a junction",
        PathState::Unknown => "looking around at a junction",
    }
}
