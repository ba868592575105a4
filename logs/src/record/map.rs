//! A map as a log records it.

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    mapping::{MapWalk, PartialMap},
};

/// A map in numbers. Darts are numbered from 0 vertex by vertex, clockwise.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MapRecord {
    pub moves: u64,
    pub degrees: Vec<u32>,
    /// The other end of each dart; `None` if it is unexplored.
    pub opposite: Vec<Option<Dart>>,
    pub robot: Dart,
}

impl MapRecord {
    pub fn from_walk(journey: &MapWalk) -> Self {
        Self::new(journey.moves(), journey.map(), journey.robot())
    }

    /// A map after a number of moves, and the dart by which the robot came in.
    pub fn new(moves: u64, map: &PartialMap, robot: Dart) -> Self {
        let darts = map.vertices().flat_map(|vertex| map.darts_of(vertex));
        Self {
            moves,
            degrees: map.vertices().map(|vertex| map.degree(vertex)).collect(),
            opposite: darts.map(|dart| map.opposite(dart)).collect(),
            robot,
        }
    }

    /// The embedded graph with these darts; `None` if the map is not complete, or not a map.
    pub fn graph(&self) -> Option<EmbeddedGraph> {
        let darts: u64 = self.degrees.iter().map(|&degree| u64::from(degree)).sum();
        if darts != self.opposite.len() as u64 || self.degrees.contains(&0) {
            return None;
        }
        let opposite: Option<Vec<_>> =
            self.opposite.iter().map(|other| Some((*other)?.0)).collect();
        let mut clockwise = Vec::with_capacity(self.opposite.len());
        for &degree in &self.degrees {
            let first = clockwise.len() as u32;
            clockwise.extend((1..=degree).map(|index| first + index % degree));
        }
        EmbeddedGraph::from_permutations(&opposite?, &clockwise).ok().map(|(graph, _)| graph)
    }

    /// Whether the maps are the same, wherever the robot is.
    pub fn same_map(&self, other: &Self) -> bool {
        (&self.degrees, &self.opposite) == (&other.degrees, &other.opposite)
    }
}
