//! Why a path is given up, and where. Section 4.3.

use thiserror::Error;

use super::PathState;
use crate::percept::Door;

#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{why}; {}, {since_turn:.2} m after the last turn to a door", about(*.state))]
pub struct Lost {
    pub why: LostReason,
    pub state: PathState,
    /// How far it had come since it last turned to a door, in metres of odometry.
    pub since_turn: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum LostReason {
    #[error("{images} images in a row do not show where the robot is")]
    Unknown { images: u32 },
    #[error("no image of the last {metres:.2} m shows where the robot is")]
    Crept { metres: f64 },
    #[error("the hallway runs {degrees:.0} degrees from where it should be by odometry")]
    Turned { degrees: f64 },
    #[error("{times} commands in a row were not carried out")]
    Stalled { times: u32 },
    #[error("the robot has made no progress in {rounds} images")]
    Idle { rounds: u32 },
    #[error("there is no junction after {metres:.0} m of hallway")]
    TooFar { metres: f64 },
    #[error("there is no door {} at a junction with {degree}", .door.0)]
    NoSuchDoor { door: Door, degree: u32 },
}

fn about(state: PathState) -> &'static str {
    match state {
        PathState::Leaving => "leaving a junction",
        PathState::Hallway => "in a hallway",
        PathState::Junction => "at a junction",
        PathState::Unknown => "looking around at a junction",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_names_the_reason_and_the_place() {
        let why = LostReason::Crept { metres: 1.0 };
        let lost = Lost { why, state: PathState::Hallway, since_turn: 2.0 };
        let expected = "no image of the last 1.00 m shows where the robot is; in a hallway, 2.00 m after the last turn \
                        to a door";
        assert_eq!(lost.to_string(), expected);
    }
}
