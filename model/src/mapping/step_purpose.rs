//! The purpose of a step of a robot that maps.

use std::fmt;

use super::{Contradiction, InvalidStep, PartialMap};
use crate::embedded_graph::Dart;

/// A dart of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapDart {
    /// The vertex's number.
    pub vertex: u32,
    /// The index of the dart.
    pub index: u32,
}

impl MapDart {
    /// A dart by its vertex and index.
    #[must_use]
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
    /// Line 4 of Algorithm 1: the map is complete.
    Done,
    /// The folding explorer goes to this open dart, and takes it.
    ExploreOpen(MapDart),
    /// The folding explorer tests whether these two darts are one edge.
    Test {
        /// The dart that was explored.
        edge: MapDart,
        /// The dart by which it may lead back into the map.
        hypothesis: MapDart,
    },
    /// The folding explorer has followed every dart.
    NoOpenDart,
    /// The robot audits its map.
    Audit,
    /// The audits of the map are over.
    Audited,
    /// The robot goes on with the folding explorer after a recovery.
    GoOn,
    /// The robot recovers, and looks for its marker.
    FindMarker,
    /// The robot tries the doors that are blocked once more.
    TryBlocked,
    /// The robot turns back to its marker, to keep within its budget.
    TurnBack,
    /// The robot got lost, and gives up.
    Lost,
    /// The explorer gave up.
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
            Self::ExploreOpen(dart) => write!(out, "explores the open {dart}"),
            Self::Test { edge, hypothesis } => {
                write!(out, "tests whether {edge} leads to {hypothesis}")
            }
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
