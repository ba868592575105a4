//! The known vertices that the unknown end of an edge can be: place validation, Section 2.3.

use super::partial_map::PartialMap;
use crate::embedded_graph::{Dart, Vertex};

/// Some of the vertices of a map. A vertex that was added later is not among them.
#[derive(Clone, Debug, Default)]
pub(super) struct Candidates(Vec<bool>);

impl Candidates {
    /// Those that look like the unknown end of an edge, and have an unexplored dart besides it.
    pub(super) fn of_end(map: &PartialMap, edge: Dart, degree: u32) -> Self {
        let known_end = map.vertex(edge);
        let can_be = |vertex| {
            let besides = u32::from(vertex == known_end);
            map.degree(vertex) == degree && map.unexplored_count_at(vertex) > besides
        };
        Self(map.vertices().map(can_be).collect())
    }

    /// The same in a world without loops and parallel edges: neither the known end nor a vertex that is joined to it.
    pub(super) fn in_simple_world(mut self, map: &PartialMap, edge: Dart) -> Self {
        let known_end = map.vertex(edge);
        self.exclude(known_end);
        for far in map.darts_of(known_end).filter_map(|dart| map.opposite(dart)) {
            self.exclude(map.vertex(far));
        }
        self
    }

    pub(super) fn contains(&self, vertex: Vertex) -> bool {
        self.0.get(vertex.at()) == Some(&true)
    }

    /// Returns whether the vertex was a candidate.
    pub(super) fn exclude(&mut self, vertex: Vertex) -> bool {
        self.0.get_mut(vertex.at()).is_some_and(std::mem::take)
    }

    pub(super) fn count(&self) -> usize {
        self.0.iter().filter(|can_be| **can_be).count()
    }
}
