//! The events of a run, and the purposes of its steps.

use std::fmt;

use super::{Contradiction, InvalidStep, PartialMap};
use crate::{
    aid::{Action, AidAction},
    embedded_graph::{Dart, Vertex},
    percept::{Door, Percept},
};

/// An event of a run. Vertices and darts are those of the map. `edge` is the known end of the edge that is explored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MappingEvent {
    /// Lines 1 to 3: the marker lies at the start vertex.
    Started { percept: Percept },
    /// One move: the door taken, and the percept behind it.
    Moved { door: Door, percept: Percept },
    /// Lines 5 to 7: the robot stands at the unknown end of an edge. The percept there contradicts some hypotheses
    /// at once; the others are left.
    Arrived { edge: Dart, percept: Percept, contradicted: usize, hypotheses: usize },
    /// Lines 13 to 15: a hypothesis, the dart by which the robot would have come in, was rejected after this number
    /// of moves along its path, by the percept after the last of them. The robot is back.
    Rejected { hypothesis: Dart, followed: u32, expected: Percept, perceived: Percept },
    /// Lines 16 and 17: a hypothesis was confirmed; the robot is at the marker.
    Confirmed { hypothesis: Dart, followed: u32 },
    /// Lines 18 to 20: an edge was added between known vertices.
    LoopClosed { edge: Dart, other: Dart },
    /// Lines 21 to 23: a vertex was added, with the edge that leads to it.
    VertexAdded { edge: Dart, vertex: Vertex },
    /// Of an explorer whose marking aid moves.
    Movable(MovableEvent),
    /// Of the folding explorer.
    Folding(FoldingEvent),
    /// Of an audit or a recovery.
    Safeguard(SafeguardEvent),
}

impl MappingEvent {
    /// Whether the map has changed.
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
    pub fn action(self) -> Option<Action> {
        match self {
            Self::Moved { door, .. } => Some(Action::Take(door)),
            Self::Movable(MovableEvent::Did(action)) => Some(Action::Do(action)),
            _ => None,
        }
    }
}

/// An event that only runs with a marking aid that moves have: markers, a string, or scouts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MovableEvent {
    /// The robot is at the unknown end of an edge with the markers or the string, or a scout is there. This number of known
    /// vertices may be the place; with a string, of unexplored darts.
    Arrived { edge: Dart, percept: Percept, candidates: usize },
    /// The robot has done something with the aid.
    Did(AidAction),
    /// Place validation: the marker or scout is not at this candidate, where the robot is.
    NotAt { vertex: Vertex },
    /// Place validation: the marker or scout is at a known vertex, where the robot is.
    Found { vertex: Vertex },
    /// Place validation: the marker or scout is at no known vertex.
    NotFound,
    /// Back-link validation: the marker or scout is not behind this unexplored dart, and the robot is back.
    NotBehind { dart: Dart, percept: Percept },
    /// Back-link validation: the marker or scout is behind this unexplored dart, and the robot is there.
    Behind { dart: Dart },
}

/// An event that only runs of the folding explorer have. A hypothesis is that the place behind `edge` is entered by a
/// certain dart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FoldingEvent {
    /// The robot has gone to an unexplored dart and taken it.
    Explored { edge: Dart, percept: Percept },
    /// The robot is going to test a hypothesis. If it is true, the marker is this number of moves away.
    Testing { edge: Dart, hypothesis: Dart, cost: usize },
    /// The test refuted its hypothesis. The robot goes on from where it is. If the percepts are equal, it was refuted by what
    /// the robot [senses](crate::world::World::senses) besides.
    Refuted { edge: Dart, hypothesis: Dart, expected: Percept, perceived: Percept },
    /// The test ended at the marker as expected.
    Confirmed { edge: Dart, hypothesis: Dart },
    /// The robot has seen the marker, and the trail was folded: its numbers of vertices.
    Folded { before: usize, after: usize },
}

/// An event that only runs with audits or recoveries have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SafeguardEvent {
    /// The map is complete, and the robot begins an audit.
    AuditBegun,
    /// Every percept of the audit agreed with the map.
    AuditPassed { moves: u64 },
    /// The robot has detected a contradiction, and looks for the marker.
    Contradicted(Contradiction),
    /// The map has more darts than the bound. The robot discards it, and looks for the marker.
    TooLarge { bound: usize },
    /// The robot got lost or was switched off. It has found a junction, and looks for the marker.
    Relocated,
    /// The robot has found the marker. It folds its walks, and goes on with those that agree.
    MarkerFound { kept: usize, walks: usize },
    /// The robot goes to the doors that are blocked, to see whether they still are.
    BlockedRetried { doors: usize },
}

/// A dart of the map, by its vertex and index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapDart {
    pub vertex: u32,
    pub index: u32,
}

impl MapDart {
    pub fn new(map: &PartialMap, dart: Dart) -> Self {
        Self { vertex: map.vertex(dart).0, index: map.index(dart) }
    }
}

impl fmt::Display for MapDart {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        write!(out, "dart {} of vertex v{}", self.index, self.vertex)
    }
}

/// The purpose of a step of an algorithm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepPurpose {
    /// Lines 5 and 6 of Algorithm 1: to explore this dart.
    Explore(MapDart),
    /// Lines 10 to 15 of Algorithm 1: to follow the path of the hypothesis that it arrived by this dart, or
    /// to return.
    Try(MapDart),
    Done,
    /// An explorer begins.
    Begin,
    /// An explorer whose marking aid moves goes to an unexplored dart, and over its edge.
    Follow(MapDart),
    /// The map of such an explorer is complete.
    Complete,
    ExploreOpen(MapDart),
    Test {
        edge: MapDart,
        hypothesis: MapDart,
    },
    /// The folding explorer carries its movable marker to this vertex of the map.
    CarryMarker(Vertex),
    /// The folding explorer has followed every dart.
    NoOpenDart,
    Audit,
    Audited,
    /// The robot goes on with the folding explorer after a recovery.
    GoOn,
    /// The robot recovers, and looks for its marker.
    FindMarker,
    TryBlocked,
    TurnBack,
    Lost,
    GaveUp,
    /// The percept is a contradiction.
    Contradicted(Contradiction),
    /// The step is not valid: the enumeration of choices is wrong.
    InvalidStep(InvalidStep),
}

impl fmt::Display for StepPurpose {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Explore(dart) => write!(out, "line 5: explores the unexplored {dart}"),
            Self::Try(dart) => write!(out, "line 9: tests whether it arrived by {dart}"),
            Self::Done => write!(out, "line 4: the map is complete"),
            Self::Begin => write!(out, "begins"),
            Self::Follow(dart) => write!(out, "follows the unexplored {dart}"),
            Self::Complete => write!(out, "the map is complete"),
            Self::ExploreOpen(dart) => write!(out, "explores the open {dart}"),
            Self::Test { edge, hypothesis } => {
                write!(out, "tests whether {edge} leads to {hypothesis}")
            }
            Self::CarryMarker(vertex) => write!(out, "carries the marker to vertex v{}", vertex.0),
            Self::NoOpenDart => write!(out, "no dart is open: the map is complete"),
            Self::Audit => write!(out, "audits the map"),
            Self::Audited => write!(out, "the map is complete and audited"),
            Self::GoOn => write!(out, "goes on with the folding explorer"),
            Self::FindMarker => write!(out, "looks for its marker"),
            Self::TryBlocked => write!(out, "tries the blocked doors once more"),
            Self::TurnBack => write!(out, "turns back, to keep within its budget"),
            Self::Lost => write!(out, "the robot got lost, and gives up"),
            Self::GaveUp => write!(out, "the explorer gives up"),
            Self::Contradicted(contradiction) => write!(out, "{contradiction}"),
            Self::InvalidStep(step) => write!(out, "{step}"),
        }
    }
}
