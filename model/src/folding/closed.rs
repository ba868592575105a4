//! A folded trail as a world.

use super::FoldedTrail;
use crate::embedded_graph::{Dart, EmbeddedGraph, Vertex};

/// A folded trail as a world.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClosedTrail {
    pub graph: EmbeddedGraph,
    /// The dart along which the marker points, or a dart of the vertex at which an undirected one lies, if it was
    /// seen.
    pub marker: Option<Dart>,
    /// The dart by which the robot had come in at the start.
    pub start: Dart,
    /// The dart by which the robot has come in.
    pub pose: Dart,
}

impl FoldedTrail {
    /// The folded trail as a world with a dead end behind each open dart. It explains the walk. If the
    /// trail [is complete](Self::is_complete) it is the only world that does. `None` if nothing was
    /// perceived.
    pub fn closed(&self) -> Option<ClosedTrail> {
        (self.vertex_count() > 0).then(|| self.closed_by(&[]))
    }

    /// The folded trail as a world in which these pairs of open darts are edges, with a dead end behind each
    /// other open dart. At least one thing was perceived.
    pub(super) fn closed_by(&self, edges: &[(Dart, Dart)]) -> ClosedTrail {
        let mut joined = vec![None; self.dart_count()];
        for &(one, other) in edges {
            (joined[one.at()], joined[other.at()]) = (Some(other), Some(one));
        }
        let mut graph = EmbeddedGraph::unfinished();
        let mut number = vec![0; self.dart_count()];
        let mut next = 0;
        for dart in self.vertices().flat_map(|first| self.darts_around(first)) {
            number[dart.at()] = next;
            next += 1;
        }
        for first in self.vertices() {
            let _: Vertex = graph.add_vertex(self.degree(first));
        }
        for _ in 2 * edges.len()..self.open_count() {
            let _: Vertex = graph.add_vertex(1);
        }
        for dart in self.vertices().flat_map(|first| self.darts_around(first)) {
            let one = Dart(number[dart.at()]);
            match self.opposite(dart).or(joined[dart.at()]) {
                None => {
                    graph.join(one, Dart(next));
                    next += 1;
                }
                Some(other) if dart < other => graph.join(one, Dart(number[other.at()])),
                Some(_) => {}
            }
        }
        let numbered = |dart: Dart| Dart(number[dart.at()]);
        let [start, pose] = [self.start(), self.pose()].map(numbered);
        let marker = self.marker().or(self.marked_vertex()).map(numbered);
        // The arrow comes from what is behind an open dart.
        let [_, head] = self.arrow.ends(&self.classes);
        let marker = marker.or_else(|| Some(graph.opposite(numbered(head?))));
        ClosedTrail { graph, marker, start, pose }
    }
}
