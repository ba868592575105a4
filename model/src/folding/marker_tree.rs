//! A breadth-first tree from the marker, and the length of a certificate.

use crate::embedded_graph::{Dart, EmbeddedGraph, Vertex};

/// The distance of a vertex that was not reached.
const UNREACHED: u32 = u32::MAX;

/// A breadth-first tree from the marker's vertex. Memory is reused from tree to tree.
///
/// An edge of it *hangs* if what is behind it is a tree: the robot traverses it there and back.
#[derive(Clone, Debug, Default)]
pub(crate) struct MarkerTree {
    vertices: Vec<TreeVertex>,
    /// The vertices in the order of their distances.
    order: Vec<Vertex>,
    hanging: usize,
}

#[derive(Clone, Copy, Debug)]
struct TreeVertex {
    distance: u32,
    /// Its dart that leads toward the marker; of no use at the marker's vertex.
    up: Dart,
    hangs: bool,
    /// The number of hanging edges on its way to the marker.
    hanging: u32,
}

const NOT_REACHED: TreeVertex =
    TreeVertex { distance: UNREACHED, up: Dart(0), hangs: false, hanging: 0 };

impl MarkerTree {
    /// The number of moves of a shortest certificate of a graph with the marker at a vertex.
    pub(crate) fn certificate(&mut self, graph: &EmbeddedGraph, marked: Vertex) -> usize {
        self.grow(graph, marked);
        self.length(graph)
    }

    /// Makes it the tree of a graph with the marker at a vertex.
    pub(crate) fn grow(&mut self, graph: &EmbeddedGraph, root: Vertex) {
        let Self { vertices, order, .. } = self;
        vertices.clear();
        vertices.resize(graph.vertex_count(), NOT_REACHED);
        order.clear();
        order.push(root);
        vertices[root.at()].distance = 0;
        let mut next = 0;
        'all_reached: while let Some(&parent) = order.get(next) {
            next += 1;
            let distance = vertices[parent.at()].distance + 1;
            for up in graph.opposites_of(parent) {
                let vertex = graph.vertex(up);
                let place = &mut vertices[vertex.at()];
                if place.distance == UNREACHED {
                    *place = TreeVertex { distance, up, ..NOT_REACHED };
                    order.push(vertex);
                    if order.len() == vertices.len() {
                        break 'all_reached;
                    }
                }
            }
        }
        self.find_hanging(graph);
    }

    /// A vertex hangs if each of its darts but the one that leads up leads to a child that hangs.
    fn find_hanging(&mut self, graph: &EmbeddedGraph) {
        let Self { vertices, order, hanging } = self;
        *hanging = 0;
        // At first `hanging` of a vertex is the number of children that hang.
        for &vertex in order[1..].iter().rev() {
            let place = &mut vertices[vertex.at()];
            if place.hanging + 1 == graph.degree(vertex) {
                place.hangs = true;
                let parent = graph.vertex(graph.opposite(place.up));
                vertices[parent.at()].hanging += 1;
                *hanging += 1;
            }
        }
        if *hanging == 0 {
            return;
        }
        vertices[order[0].at()].hanging = 0;
        for &vertex in &order[1..] {
            let TreeVertex { up, hangs, .. } = vertices[vertex.at()];
            let parent = graph.vertex(graph.opposite(up));
            vertices[vertex.at()].hanging = vertices[parent.at()].hanging + u32::from(hangs);
        }
    }

    pub(super) fn root(&self) -> Vertex {
        self.order[0]
    }

    pub(crate) fn up(&self, vertex: Vertex) -> Dart {
        self.vertices[vertex.at()].up
    }

    pub(super) fn hangs(&self, vertex: Vertex) -> bool {
        self.vertices[vertex.at()].hangs
    }

    pub(super) fn leads_up(&self, graph: &EmbeddedGraph, dart: Dart) -> bool {
        let vertex = graph.vertex(dart);
        vertex != self.root() && self.up(vertex) == dart
    }

    /// The hanging leaf at which a shortest certificate ends, and what that saves; `None` if it ends at
    /// the marker.
    pub(super) fn last_leaf(&self, graph: &EmbeddedGraph) -> Option<(Vertex, usize)> {
        if self.hanging == 0 {
            return None;
        }
        let saved = |&vertex: &Vertex| {
            let TreeVertex { distance, hangs, hanging, .. } = self.vertices[vertex.at()];
            let leaf = hangs && graph.degree(vertex) == 1;
            (leaf && 2 * hanging > distance).then(|| (vertex, (2 * hanging - distance) as usize))
        };
        // The first of the best, in the order of the tree.
        self.order.iter().rev().filter_map(saved).max_by_key(|&(_, saved)| saved)
    }

    /// Over all edges `uv`, the sum of `d(u) + d(v) + 1` is the number of edges plus the sum of each
    /// vertex's degree times its distance. The edge of the tree above a vertex contributes twice the
    /// vertex's distance to it.
    fn length(&self, graph: &EmbeddedGraph) -> usize {
        let (mut added, mut tree) = (graph.edge_count(), 0);
        for &vertex in &self.order {
            let distance = self.vertices[vertex.at()].distance as usize;
            added += graph.degree(vertex) as usize * distance;
            tree += 2 * distance;
        }
        let saved = self.last_leaf(graph).map_or(0, |(_, saved)| saved);
        added + 2 * self.hanging - tree - saved
    }
}
