//! A map as a log records it.

use toposlam_model::{
    embedded_graph::Dart,
    mapping::{Journey, PartialMap},
};

/// A map in numbers. Darts are numbered from 0 vertex by vertex, clockwise.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MapRecord {
    /// The number of moves made.
    pub moves: u64,
    /// The degree of each vertex.
    pub degrees: Vec<u32>,
    /// The other end of each dart; `None` if it is unexplored.
    pub opposite: Vec<Option<Dart>>,
    /// The dart by which the robot came in.
    pub robot: Dart,
}

impl MapRecord {
    /// The present map of a journey.
    #[must_use]
    pub fn of(journey: &Journey) -> Self {
        Self::new(journey.moves(), journey.map(), journey.robot())
    }

    /// A map after a number of moves, and the dart by which the robot came in.
    #[must_use]
    pub fn new(moves: u64, map: &PartialMap, robot: Dart) -> Self {
        let darts = map.vertices().flat_map(|vertex| map.darts_of(vertex));
        Self {
            moves,
            degrees: map.vertices().map(|vertex| map.degree(vertex)).collect(),
            opposite: darts.map(|dart| map.opposite(dart)).collect(),
            robot,
        }
    }

    /// Whether the maps are the same, wherever the robot is.
    #[must_use]
    pub fn same_map(&self, other: &Self) -> bool {
        (&self.degrees, &self.opposite) == (&other.degrees, &other.opposite)
    }
}
