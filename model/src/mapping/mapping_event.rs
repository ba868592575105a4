//! The events of a run.

use super::Contradiction;
use crate::{
    embedded_graph::{Dart, Vertex},
    percept::{Door, Percept},
    world::Action,
};

/// An event of a run. Vertices and darts are those of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MappingEvent {
    /// Lines 1 to 3: the marker lies at the start vertex.
    Started {
        /// The percept there.
        percept: Percept,
    },
    /// One move.
    Moved {
        /// The door taken.
        door: Door,
        /// The percept behind it.
        percept: Percept,
    },
    /// Lines 5 to 7: the robot stands at the unknown end of an edge.
    Arrived {
        /// The known end of the edge.
        edge: Dart,
        /// The percept at the unknown one.
        percept: Percept,
        /// The number of hypotheses that the percept contradicts at once.
        contradicted: usize,
        /// The number of hypotheses that are left.
        hypotheses: usize,
    },
    /// Lines 13 to 15: a hypothesis was rejected, and the robot is back.
    Rejected {
        /// The unexplored dart by which the robot would have come in.
        hypothesis: Dart,
        /// The number of moves along its path.
        followed: u32,
        /// The expected percept after the last of them.
        expected: Percept,
        /// The percept after the last of them.
        perceived: Percept,
    },
    /// Lines 16 and 17: a hypothesis was confirmed; the robot is at the marker.
    Confirmed {
        /// The unexplored dart by which the robot came in.
        hypothesis: Dart,
        /// The number of moves along its path.
        followed: u32,
    },
    /// Lines 18 to 20: an edge was added between known vertices.
    LoopClosed {
        /// The end from which it was explored.
        edge: Dart,
        /// The other end.
        other: Dart,
    },
    /// Lines 21 to 23: a vertex was added, with the edge that leads to it.
    VertexAdded {
        /// The end from which the edge was explored.
        edge: Dart,
        /// The new vertex.
        vertex: Vertex,
    },
    /// An event of the movable marker algorithm.
    Movable(MovableEvent),
    /// An event of the folding explorer.
    Folding(FoldingEvent),
    /// An audit, or a recovery.
    Safeguard(SafeguardEvent),
}

impl MappingEvent {
    /// Whether the map has changed.
    #[must_use]
    pub fn grows_map(&self) -> bool {
        matches!(
            self,
            Self::Started { .. }
                | Self::LoopClosed { .. }
                | Self::VertexAdded { .. }
                | Self::Safeguard(SafeguardEvent::MarkerFound { .. })
        )
    }

    /// The robot's action, if the event is one.
    #[must_use]
    pub fn action(self) -> Option<Action> {
        match self {
            Self::Moved { door, .. } => Some(Action::Take(door)),
            Self::Movable(MovableEvent::PickedUp) => Some(Action::PickUp),
            Self::Movable(MovableEvent::Dropped) => Some(Action::Drop),
            _ => None,
        }
    }
}

/// An event that only runs with a movable marker have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MovableEvent {
    /// The robot is at the unknown end of an edge and carries the marker.
    Arrived {
        /// The known end of the edge.
        edge: Dart,
        /// The percept at the unknown one.
        percept: Percept,
        /// The number of known vertices that this may be.
        candidates: usize,
    },
    /// The robot dropped the marker where it is.
    Dropped,
    /// The robot picked the marker up where it is.
    PickedUp,
    /// Place validation: the marker is not at this candidate, where the robot is.
    NotAt {
        /// The vertex.
        vertex: Vertex,
    },
    /// Place validation: the marker lies at a known vertex, where the robot is.
    Found {
        /// The vertex.
        vertex: Vertex,
    },
    /// Place validation: the marker is at no known vertex.
    NotFound,
    /// Back-link validation: the marker is not behind this unexplored dart, and the robot is back.
    NotBehind {
        /// The dart.
        dart: Dart,
        /// The percept behind it.
        percept: Percept,
    },
    /// Back-link validation: the marker is behind this unexplored dart, and the robot is there.
    Behind {
        /// The dart.
        dart: Dart,
    },
}

/// An event that only runs of the folding explorer have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FoldingEvent {
    /// The robot has gone to an unexplored dart and taken it.
    Explored {
        /// The dart.
        edge: Dart,
        /// The percept behind it.
        percept: Percept,
    },
    /// The robot is going to test a hypothesis.
    Testing {
        /// The dart that leads to the place that the hypothesis is about.
        edge: Dart,
        /// The dart by which the place is entered, if the hypothesis is true.
        hypothesis: Dart,
        /// The number of moves to the marker, if it is true.
        cost: usize,
    },
    /// The test refuted its hypothesis. The robot goes on from where it is.
    Refuted {
        /// The dart that leads to the place.
        edge: Dart,
        /// The hypothesis.
        hypothesis: Dart,
        /// The expected percept.
        expected: Percept,
        /// The percept.
        perceived: Percept,
    },
    /// The test ended at the marker as expected.
    Confirmed {
        /// The dart that leads to the place.
        edge: Dart,
        /// The hypothesis.
        hypothesis: Dart,
    },
    /// The robot has seen the marker, and the trail was folded.
    Folded {
        /// The number of vertices of the trail before.
        before: usize,
        /// The number of vertices afterwards.
        after: usize,
    },
}

/// An event that only runs with audits or recoveries have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SafeguardEvent {
    /// The map is complete, and the robot begins an audit.
    AuditBegun,
    /// Every percept of the audit agreed with the map.
    AuditPassed {
        /// The moves of the audit.
        moves: u64,
    },
    /// The robot has detected a contradiction, and looks for the marker.
    Contradicted(Contradiction),
    /// The map becomes too large. The robot discards it, and looks for the marker.
    TooLarge {
        /// The bound on darts.
        bound: usize,
    },
    /// The robot got lost or was switched off. It has found a junction, and looks for the marker.
    Relocated,
    /// The robot has found the marker. It folds its walks, and goes on with those that agree.
    MarkerFound {
        /// The number of walks that agree.
        kept: usize,
        /// The number of walks.
        walks: usize,
    },
    /// The robot goes to the doors that are blocked, to see whether they still are.
    BlockedRetried {
        /// The number of doors.
        doors: usize,
    },
}
