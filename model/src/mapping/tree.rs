//! Shortest paths in the known map: breadth-first trees, the darts of a vertex in index order, the
//! first parent kept. Section 2.3, Algorithm 1, lines 6 and 10; the search for a movable marker.

use super::partial_map::PartialMap;
use crate::{
    clone_in_place::clone_in_place,
    embedded_graph::{Dart, Vertex},
    percept::Door,
};

/// A breadth-first tree of the known map, grown on demand.
#[derive(Debug, Default)]
pub(super) struct BreadthFirstTree {
    /// For each vertex the number of edges to the root.
    hops: Vec<u32>,
    /// For each vertex in the tree, but for the root, its dart that leads towards the root.
    up: Vec<Dart>,
    /// The vertices in the tree in the order in which they were reached.
    reached: Vec<Vertex>,
    /// The number of `reached` vertices with all their neighbours in the tree.
    grown: usize,
}

clone_in_place!(BreadthFirstTree { hops, up, reached, grown });

/// The hops of a vertex that is not in the tree.
const UNREACHED: u32 = u32::MAX;

impl BreadthFirstTree {
    /// Begins a new tree at its root.
    pub(super) fn plant(&mut self, map: &PartialMap, root: Vertex) {
        self.hops.clear();
        self.hops.resize(map.vertex_count(), UNREACHED);
        self.up.resize(map.vertex_count(), Dart(0));
        self.reached.clear();
        self.grown = 0;
        self.hops[root.at()] = 0;
        self.reached.push(root);
    }

    /// Discards the tree: it no longer fits the map.
    pub(super) fn clear(&mut self) {
        self.reached.clear();
    }

    /// Begins a new tree, unless this is one of the map, from that root.
    pub(super) fn plant_unless_rooted(&mut self, map: &PartialMap, root: Vertex) {
        if self.reached.first() != Some(&root) || self.hops.len() != map.vertex_count() {
            self.plant(map, root);
        }
    }

    /// Adds the neighbours of one more vertex; `false` if there is none.
    fn grow(&mut self, map: &PartialMap) -> bool {
        let Some(&vertex) = self.reached.get(self.grown) else {
            return false;
        };
        self.grown += 1;
        for dart in map.darts_of(vertex) {
            if let Some(far) = map.opposite(dart) {
                let neighbour = map.vertex(far);
                if self.hops[neighbour.at()] == UNREACHED {
                    self.hops[neighbour.at()] = self.hops[vertex.at()] + 1;
                    self.up[neighbour.at()] = far;
                    self.reached.push(neighbour);
                }
            }
        }
        true
    }

    /// Grows the tree over the whole map.
    pub(super) fn grow_whole(&mut self, map: &PartialMap) {
        while self.grow(map) {}
    }

    /// Adds a vertex that was just added to the map with one edge. The tree stays breadth-first.
    pub(super) fn add_leaf(&mut self, map: &PartialMap, leaf: Vertex) {
        let entry = map.first_dart(leaf);
        if let Some(parent) = map.opposite(entry) {
            self.hops.push(self.hops[map.vertex(parent).at()] + 1);
            self.up.push(entry);
        }
    }

    /// Whether a new edge between two of its vertices leaves the whole tree as it is. It does if both
    /// are equally far from the root: then neither is reached through the other.
    pub(super) fn stays_with(&self, map: &PartialMap, one: Dart, other: Dart) -> bool {
        self.hops(map.vertex(one)) == self.hops(map.vertex(other))
    }

    /// The unexplored dart that is fewest hops from the root; then of the vertex discovered first;
    /// then with the lowest index. `None` if nothing is unexplored.
    pub(super) fn nearest_unexplored(&mut self, map: &PartialMap) -> Option<Dart> {
        let mut level = 0;
        loop {
            let end = self.reached.len();
            let frontier =
                self.reached[level..end].iter().filter(|&&vertex| map.is_frontier(vertex));
            if let Some(&vertex) = frontier.min() {
                return map.unexplored_at(vertex).next();
            }
            level = end;
            while self.grown < end {
                self.grow(map);
            }
            if self.reached.len() == end {
                return None;
            }
        }
    }

    /// The number of edges from a vertex to the root; the vertex is in the tree.
    #[inline]
    pub(super) fn hops(&self, vertex: Vertex) -> u32 {
        self.hops[vertex.at()]
    }

    /// Writes the darts of the path from the root to `target`.
    pub(super) fn path_from_root(
        &mut self,
        map: &PartialMap,
        target: Vertex,
        path: &mut Vec<Dart>,
    ) {
        while self.hops[target.at()] == UNREACHED && self.grow(map) {}
        path.clear();
        let mut vertex = target;
        while self.hops[vertex.at()] != 0 {
            let Some(down) = map.opposite(self.up[vertex.at()]) else {
                break;
            };
            path.push(down);
            vertex = map.vertex(down);
        }
        path.reverse();
    }

    /// Writes the vertices of the tree in preorder, with the darts of a vertex in index order.
    pub(super) fn preorder(&self, map: &PartialMap, order: &mut Vec<Vertex>) {
        order.clear();
        let mut ahead: Vec<_> = self.reached.first().copied().into_iter().collect();
        while let Some(vertex) = ahead.pop() {
            order.push(vertex);
            for far in map.darts_of(vertex).rev().filter_map(|dart| map.opposite(dart)) {
                let neighbour = map.vertex(far);
                let hops = self.hops[neighbour.at()];
                if hops != UNREACHED && hops != 0 && self.up[neighbour.at()] == far {
                    ahead.push(neighbour);
                }
            }
        }
    }

    /// The next door towards the root, and the pose behind it; `None` at the root.
    #[inline]
    pub(super) fn toward_root(&self, map: &PartialMap, pose: Dart) -> Option<(Door, Dart)> {
        let vertex = map.vertex(pose);
        if self.hops[vertex.at()] == 0 {
            return None;
        }
        let up = self.up[vertex.at()];
        Some((map.door(pose, up), map.opposite(up)?))
    }
}
