//! A breadth-first tree from the marker, and the length of a certificate.

use crate::embedded_graph::{Dart, EmbeddedGraph, Vertex};

/// The distance of a vertex that was not reached.
const UNREACHED: usize = usize::MAX;

/// A breadth-first tree from the marker's vertex. Memory is reused from tree to tree.
///
/// An edge of it *hangs* if what is behind it is a tree: the robot traverses it there and back.
#[derive(Clone, Debug, Default)]
pub(crate) struct MarkerTree {
    /// The distance of each vertex from the marker.
    distance: Vec<usize>,
    /// The dart at each vertex that leads toward the marker; of no use at the marker's vertex.
    up: Vec<Dart>,
    /// Whether each vertex is behind a hanging edge.
    hangs: Vec<bool>,
    /// The number of hanging edges on the way from each vertex to the marker.
    hanging: Vec<usize>,
    /// The vertices in the order of their distances.
    order: Vec<Vertex>,
}

impl MarkerTree {
    /// Makes it the tree of a graph with the marker at a vertex.
    pub(crate) fn grow(&mut self, graph: &EmbeddedGraph, root: Vertex) {
        let count = graph.vertex_count();
        self.distance.clear();
        self.distance.resize(count, UNREACHED);
        self.up.clear();
        self.up.resize(count, Dart(0));
        self.order.clear();
        self.order.push(root);
        self.distance[root.at()] = 0;
        let mut next = 0;
        while let Some(&vertex) = self.order.get(next) {
            next += 1;
            for dart in graph.darts_of(vertex) {
                let entry = graph.opposite(dart);
                let other = graph.vertex(entry);
                if self.distance[other.at()] == UNREACHED {
                    self.distance[other.at()] = self.distance[vertex.at()] + 1;
                    self.up[other.at()] = entry;
                    self.order.push(other);
                }
            }
        }
        self.find_hanging(graph);
    }

    /// A vertex hangs if each of its darts but the one that leads up leads to a child that hangs.
    fn find_hanging(&mut self, graph: &EmbeddedGraph) {
        let count = graph.vertex_count();
        self.hangs.clear();
        self.hangs.resize(count, false);
        // At first the number of children that hang.
        self.hanging.clear();
        self.hanging.resize(count, 0);
        for &vertex in self.order[1..].iter().rev() {
            if self.hanging[vertex.at()] + 1 == graph.degree(vertex) as usize {
                self.hangs[vertex.at()] = true;
                let parent = self.parent(graph, vertex);
                self.hanging[parent.at()] += 1;
            }
        }
        let root = self.root();
        self.hanging[root.at()] = 0;
        for next in 1..self.order.len() {
            let vertex = self.order[next];
            let above = self.hanging[self.parent(graph, vertex).at()];
            self.hanging[vertex.at()] = above + usize::from(self.hangs[vertex.at()]);
        }
    }

    /// The marker's vertex.
    pub(super) fn root(&self) -> Vertex {
        self.order[0]
    }

    /// The dart at a vertex, not the marker's, that leads toward the marker.
    pub(crate) fn up(&self, vertex: Vertex) -> Dart {
        self.up[vertex.at()]
    }

    /// The next vertex on the way from a vertex, not the marker's, to the marker.
    pub(super) fn parent(&self, graph: &EmbeddedGraph, vertex: Vertex) -> Vertex {
        graph.vertex(graph.opposite(self.up(vertex)))
    }

    /// Whether a vertex is behind a hanging edge.
    pub(super) fn hangs(&self, vertex: Vertex) -> bool {
        self.hangs[vertex.at()]
    }

    /// Whether a dart leads toward the marker along the tree.
    pub(super) fn leads_up(&self, graph: &EmbeddedGraph, dart: Dart) -> bool {
        let vertex = graph.vertex(dart);
        vertex != self.root() && self.up(vertex) == dart
    }

    /// The hanging leaf at which a shortest certificate ends, and what that saves; `None` if it ends at
    /// the marker.
    pub(super) fn last_leaf(&self, graph: &EmbeddedGraph) -> Option<(Vertex, usize)> {
        let saved = |&vertex: &Vertex| {
            let (hanging, distance) = (self.hanging[vertex.at()], self.distance[vertex.at()]);
            let leaf = self.hangs(vertex) && graph.degree(vertex) == 1;
            (leaf && 2 * hanging > distance).then(|| (vertex, 2 * hanging - distance))
        };
        // The first of the best, in the order of the tree.
        self.order.iter().rev().filter_map(saved).max_by_key(|&(_, saved)| saved)
    }

    /// The number of moves of a shortest certificate.
    ///
    /// Over all edges `uv`, the sum of `d(u) + d(v) + 1` is the number of edges plus the sum of each
    /// vertex's degree times its distance. The edge of the tree above a vertex contributes twice the
    /// vertex's distance to it.
    pub(crate) fn length(&self, graph: &EmbeddedGraph) -> usize {
        let (mut added, mut tree, mut hanging) = (graph.edge_count(), 0, 0);
        for &vertex in &self.order {
            let distance = self.distance[vertex.at()];
            added += graph.degree(vertex) as usize * distance;
            tree += 2 * distance;
            hanging += usize::from(self.hangs(vertex));
        }
        let saved =
            if hanging == 0 { 0 } else { self.last_leaf(graph).map_or(0, |(_, saved)| saved) };
        added + 2 * hanging - tree - saved
    }
}
