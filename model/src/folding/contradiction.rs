//! Why no world explains a walk.

use thiserror::Error;

use super::LengthInterval;
use crate::{
    counts::{counted, grouped},
    percept::{Sighting, WalkEvent},
};

/// Why a walk cannot be folded, and the first event that no world of any size explains together with the events
/// before it, or at which the trail is too large.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{error}")]
pub struct FoldError {
    pub event: WalkEvent,
    pub error: TrailError,
}

/// The largest number of darts of a trail, which bounds its memory.
pub const MAX_DARTS: usize = 1 << 25;

/// Why a trail cannot be continued.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum TrailError {
    #[error(transparent)]
    Contradiction(#[from] ContradictionReason),
    #[error("the junctions on the walk have more than {} doors together", grouped(MAX_DARTS as u128))]
    TooManyDarts,
}

/// Why no world explains a walk. Visits are numbered by the moves before them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ContradictionReason {
    #[error("a junction has at least one door")]
    NoDoors,
    #[error("door {door} was taken at a junction with {}", counted(*degree as usize, "door"))]
    NoSuchDoor { door: u32, degree: u32 },
    #[error(
        "the marker points along door {door} of a junction with {}",
        counted(*degree as usize, "door")
    )]
    MarkerDoor { door: u32, degree: u32 },
    #[error(
        "the junctions after {} and {} moves are the same one, with {} and with {}",
        visits[0], visits[1], counted(degrees[0] as usize, "door"), degrees[1]
    )]
    Degree { visits: [usize; 2], degrees: [u32; 2] },
    #[error(
        "the junctions after {} and {} moves are the same one, with {} and with {}",
        visits[0], visits[1], sightings[0], sightings[1]
    )]
    Marker {
        visits: [usize; 2],
        /// What was seen at each, for a robot with the pose of the second.
        sightings: [Sighting; 2],
    },
    #[error(
        "an edge at the junctions after {} and {} moves is the same one, with a length of {} and of {}",
        visits[0], visits[1], lengths[0], lengths[1]
    )]
    Length { visits: [usize; 2], lengths: [LengthInterval; 2] },
    #[error("the junction after {} would be turned onto itself", counted(*visit, "move"))]
    Rotation { visit: usize },
    #[error("the junctions after {} and {} moves are the same one and distinct", visits[0], visits[1])]
    Distinct { visits: [usize; 2] },
    #[error("an edge at the junction after {} would have one end only", counted(*visit, "move"))]
    OwnOpposite { visit: usize },
}
