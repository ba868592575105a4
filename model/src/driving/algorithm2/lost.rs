//! Why a path is given up, and where. Section 4.3.

use std::fmt;

use thiserror::Error;

use super::PathState;
use crate::percept::Door;

#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{}", self.with(FrameKind::Image))]
pub struct Lost {
    pub why: LostReason,
    pub state: PathState,
    /// How far it had come since it last turned to a door, in metres of odometry.
    pub since_turn: f64,
}

/// What a robot takes to see where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameKind {
    Image,
    Scan,
}

impl Lost {
    /// The error of a robot that takes such frames, in words.
    pub fn with(self, frame: FrameKind) -> String {
        let Self { why, state, since_turn } = self;
        let (why, state) = (why.with(frame), about(state));
        format!("{why}; {state}, {since_turn:.2} m after the last turn to a door")
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{}", self.with(FrameKind::Image))]
pub enum LostReason {
    /// So many images in a row do not show where the robot is.
    Unknown {
        images: u32,
    },
    /// No image of the last metres shows where the robot is.
    Crept {
        metres: f64,
    },
    /// The hallway runs so far from where it should be by odometry.
    Turned {
        degrees: f64,
    },
    /// So many commands in a row were not carried out.
    Stalled {
        times: u32,
    },
    /// The robot has made no progress in so many images.
    Idle {
        rounds: u32,
    },
    /// There is no junction after so many metres of hallway.
    TooFar {
        metres: f64,
    },
    NoSuchDoor {
        door: Door,
        degree: u32,
    },
}

impl LostReason {
    /// The reason of a robot that takes such frames, in words.
    pub fn with(self, frame: FrameKind) -> String {
        match self {
            Self::Unknown { images } => {
                format!("{images} {frame}s in a row do not show where the robot is")
            }
            Self::Crept { metres } => {
                format!("no {frame} of the last {metres:.2} m shows where the robot is")
            }
            Self::Turned { degrees } => {
                format!("the hallway runs {degrees:.0} degrees from where it should be by odometry")
            }
            Self::Stalled { times } => format!("{times} commands in a row were not carried out"),
            Self::Idle { rounds } => format!("the robot has made no progress in {rounds} {frame}s"),
            Self::TooFar { metres } => {
                format!("there is no junction after {metres:.0} m of hallway")
            }
            Self::NoSuchDoor { door, degree } => {
                format!("there is no door {} at a junction with {degree}", door.0)
            }
        }
    }
}

impl fmt::Display for FrameKind {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Image => "image",
            Self::Scan => "scan",
        })
    }
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
    fn a_robot_with_a_scanner_is_lost_by_scans() {
        for (why, in_words) in [
            (LostReason::Unknown { images: 7 }, "7 scans in a row do not show where the robot is"),
            (
                LostReason::Crept { metres: 1.0 },
                "no scan of the last 1.00 m shows where the robot is",
            ),
            (LostReason::Idle { rounds: 9 }, "the robot has made no progress in 9 scans"),
        ] {
            assert_eq!(why.with(FrameKind::Scan), in_words);
            assert_eq!(why.to_string(), in_words.replace("scan", "image"));
            let lost = Lost { why, state: PathState::Hallway, since_turn: 2.0 };
            let expected =
                format!("{in_words}; in a hallway, 2.00 m after the last turn to a door");
            assert_eq!(lost.with(FrameKind::Scan), expected);
        }
    }
}
