//! Why a run ended early.

use thiserror::Error;
use toposlam_model::{
    counts::counted,
    driving::algorithm2::{Lost, LostReason},
    percept::Door,
};

use crate::{budget::BudgetLimit, robot::RobotError};

/// Why a run ended early.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ExplorerError {
    /// The robot does not know where it is any more.
    #[error("on move {moves}, {}: {lost}", by_door(*.door))]
    Lost {
        /// The number of the move, counted from 1; 0 at the start.
        moves: u64,
        /// The door that it took.
        door: Option<Door>,
        /// What happened.
        lost: Lost,
    },
    /// The camera gives no usable image.
    #[error("on move {moves}, {}: {images} unusable images in a row: {cause}", by_door(*.door))]
    NoImage {
        /// The number of the move.
        moves: u64,
        /// The door that it took.
        door: Option<Door>,
        /// The number of images.
        images: u32,
        /// What is wrong with the last one.
        cause: String,
    },
    /// The robot does not start at an L.
    #[error("the robot is at a junction with {}; a run starts at an L", counted(*.degree as usize, "door"))]
    NotAnL {
        /// The degree of the junction.
        degree: u32,
    },
    /// The robot failed.
    #[error(transparent)]
    Robot(#[from] RobotError),
    /// The robot could not go on and still return to its marker within its budget.
    #[error("{}", budget_in_words(*.moves, *.limit, *.is_at_marker))]
    Budget {
        /// The moves, with those of the way back.
        moves: u64,
        /// The limit.
        limit: BudgetLimit,
        /// Whether it is back at its marker.
        is_at_marker: bool,
    },
    /// The user or an observer stopped the run.
    #[error("the run was ended on move {moves}")]
    Stopped {
        /// The number of the move.
        moves: u64,
    },
}

impl ExplorerError {
    /// Whether something is in the robot's way.
    pub(super) fn is_stalled(&self) -> bool {
        matches!(self, Self::Lost { lost: Lost { why: LostReason::Stalled { .. }, .. }, .. })
    }
}

fn by_door(door: Option<Door>) -> String {
    door.map_or_else(|| "at the start".to_owned(), |door| format!("by door {}", door.0))
}

fn budget_in_words(moves: u64, limit: BudgetLimit, is_at_marker: bool) -> String {
    let place = if is_at_marker {
        "it is back at its marker"
    } else {
        "it did not find back to its marker"
    };
    format!("the robot turned back to keep within {limit}; after {moves} moves {place}")
}
