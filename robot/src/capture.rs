//! A frame that shows where a robot is now: it is taken again if it is missing, too old, or the same as before. Section 4.

use std::fmt;

use thiserror::Error;
use toposlam_logs::record::{Frame, SensingError};

use crate::robot::{Robot, RobotError};

/// What a robot takes to see where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameKind {
    Image,
    Scan,
}

impl fmt::Display for FrameKind {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Image => "image",
            Self::Scan => "scan",
        })
    }
}

/// Why a frame cannot be used.
#[derive(Debug, Error)]
pub(crate) enum UnusableFrame {
    #[error("the camera gives no image")]
    Missing,
    #[error("it is older than the end of the last motion")]
    Stale,
    #[error("it is the same as before the robot moved")]
    Same,
    #[error(transparent)]
    NotSensed(#[from] SensingError),
    #[error(transparent)]
    Robot(RobotError),
}

impl UnusableFrame {
    /// What is wrong with a frame of this kind.
    pub(crate) fn cause(&self, frame: FrameKind) -> String {
        match (self, frame) {
            (Self::Missing, FrameKind::Scan) => "the scanner gives no scan".to_owned(),
            _ => self.to_string(),
        }
    }
}

/// The robot gives up after this many unusable frames in a row.
pub(crate) const RETAKES: u32 = 6;

/// A frame that was taken since the robot last moved, after the last one that was used.
pub(crate) fn capture(
    robot: &mut impl Robot,
    last: Option<&Frame>,
) -> Result<Frame, UnusableFrame> {
    let at = robot.odometry();
    let frame = robot.capture().map_err(|error| match error {
        RobotError::NoImage => UnusableFrame::Missing,
        RobotError::StaleImage { .. } => UnusableFrame::Stale,
        error => UnusableFrame::Robot(error),
    })?;
    if frame.taken < at.time {
        return Err(UnusableFrame::Stale);
    }
    let same = |last: &Frame| last.odometry != at.odometry && last.same_data(&frame);
    if last.is_some_and(same) { Err(UnusableFrame::Same) } else { Ok(frame) }
}
