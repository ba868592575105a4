//! Why no world explains a walk.

use thiserror::Error;

use crate::{
    counts::{counted, grouped},
    percept::{Sighting, WalkEvent},
};

/// The first event that no world of any size explains together with the events before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{reason}")]
pub struct TrailContradiction {
    /// The event.
    pub event: WalkEvent,
    /// The reason.
    pub reason: ContradictionReason,
}

/// Why a walk cannot be folded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum FoldError {
    /// No world of any size explains the walk.
    #[error(transparent)]
    Contradiction(#[from] TrailContradiction),
    /// The trail is too large. Nothing is proved.
    #[error("the junctions on the walk have more than {} doors together", grouped(MAX_DARTS as u128))]
    TooManyDarts {
        /// The percept.
        event: WalkEvent,
    },
}

/// The largest number of darts of a trail, which bounds its memory.
pub const MAX_DARTS: usize = 1 << 25;

/// Why a trail cannot be continued.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum TrailError {
    /// No world of any size explains the walk.
    #[error(transparent)]
    Contradiction(#[from] ContradictionReason),
    /// The trail would have more than [`MAX_DARTS`] darts.
    #[error("the junctions on the walk have more than {} doors together", grouped(MAX_DARTS as u128))]
    TooManyDarts,
}

impl TrailError {
    /// The error with the event at which it occurred.
    pub(super) fn at(self, event: WalkEvent) -> FoldError {
        match self {
            Self::Contradiction(reason) => TrailContradiction { event, reason }.into(),
            Self::TooManyDarts => FoldError::TooManyDarts { event },
        }
    }
}

/// Why no world explains a walk. Visits are numbered by the moves before them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ContradictionReason {
    /// A vertex of a connected graph with an edge has a door.
    #[error("a junction has at least one door")]
    NoDoors,
    /// The robot left by a door that the vertex does not have.
    #[error("door {door} was taken at a junction with {}", counted(*degree as usize, "door"))]
    NoSuchDoor {
        /// The door.
        door: u32,
        /// The number of doors.
        degree: u32,
    },
    /// The marker points along a door that the vertex does not have.
    #[error(
        "the marker points along door {door} of a junction with {}",
        counted(*degree as usize, "door")
    )]
    MarkerDoor {
        /// The door.
        door: u32,
        /// The number of doors.
        degree: u32,
    },
    /// Two visits are visits of one vertex, with different degrees.
    #[error(
        "the junctions after {} and {} moves are the same one, with {} and with {}",
        visits[0], visits[1], counted(degrees[0] as usize, "door"), degrees[1]
    )]
    Degree {
        /// The visits.
        visits: [usize; 2],
        /// The degree at each.
        degrees: [u32; 2],
    },
    /// Two visits are visits of one vertex, and the marker is not seen in the same way.
    #[error(
        "the junctions after {} and {} moves are the same one, with {} and with {}",
        visits[0], visits[1], sightings[0], sightings[1]
    )]
    Marker {
        /// The visits.
        visits: [usize; 2],
        /// What was seen at each, for a robot with the pose of the second.
        sightings: [Sighting; 2],
    },
    /// A pose is identified with another pose at its vertex.
    #[error("the junction after {} would be turned onto itself", counted(*visit, "move"))]
    Rotation {
        /// A visit of the vertex.
        visit: usize,
    },
    /// Two visits are visits of one vertex, and of two that are proved to be distinct.
    #[error("the junctions after {} and {} moves are the same one and distinct", visits[0], visits[1])]
    Distinct {
        /// The visits.
        visits: [usize; 2],
    },
    /// A dart is identified with its opposite.
    #[error("an edge at the junction after {} would have one end only", counted(*visit, "move"))]
    OwnOpposite {
        /// A visit of the vertex.
        visit: usize,
    },
}
