//! Why a run ended early.

use thiserror::Error;
use toposlam_model::{
    counts::counted,
    driving::algorithm2::{Lost, LostReason},
    percept::Door,
};

use crate::{budget::BudgetLimit, capture::FrameKind, robot::RobotError};

/// Why a run ended early. Moves are counted from 1; 0 is the start.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ExplorerError {
    /// The robot does not know where it is.
    #[error("on move {moves}, {}: {lost}", by_door(*.door))]
    Lost { moves: u64, door: Option<Door>, lost: Lost },
    /// The camera gives no usable image, or the scanner no usable scan. `cause` is what is wrong with the last one.
    #[error("on move {moves}, {}: {images} unusable {frame}s in a row: {cause}", by_door(*.door))]
    NoImage { moves: u64, door: Option<Door>, images: u32, cause: String, frame: FrameKind },
    /// A robot in a network of corridors does not know at which junction it is.
    #[error("on move {moves}, {}: {cause}", by_door(*.door))]
    NoJunction { moves: u64, door: Option<Door>, cause: CorridorFailure },
    #[error("the robot is at a junction with {}; a run starts at an L", counted(*.degree as usize, "door"))]
    NotAnL { degree: u32 },
    #[error(transparent)]
    Robot(#[from] RobotError),
    /// The robot could not go on and still return to its marker within its budget. The moves are those of the way
    /// back, too.
    #[error(
        "the robot turned back to keep within {limit}; after {moves} moves {}",
        if *.is_at_marker { "it is back at its marker" } else { "it did not find back to its marker" }
    )]
    Budget { moves: u64, limit: BudgetLimit, is_at_marker: bool },
    /// The user or an observer stopped the run.
    #[error("the run was ended on move {moves}")]
    Stopped { moves: u64 },
}

/// Why a robot in a network of corridors does not know at which junction it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum CorridorFailure {
    /// It has not come to a junction yet, or not back to one.
    #[error("no junction is seen")]
    Missed,
    /// The number of doors, or the door at which the marker lies.
    #[error("what the junction is like is undecided")]
    Undecided,
    /// It is that by which it left.
    #[error("the door is that of an alcove")]
    Alcove,
    #[error("something stops the robot")]
    Stopped,
    #[error("it is not seen whether the way goes on")]
    Unseen,
    #[error("the robot drove too far without a junction")]
    TooFar,
}

impl ExplorerError {
    pub(super) fn is_stalled(&self) -> bool {
        matches!(self, Self::Lost { lost: Lost { why: LostReason::Stalled { .. }, .. }, .. })
    }
}

fn by_door(door: Option<Door>) -> String {
    door.map_or_else(|| "at the start".to_owned(), |door| format!("by door {}", door.0))
}
