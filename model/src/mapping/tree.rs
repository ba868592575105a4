//! Shortest paths in the known map: breadth-first trees, the darts of a vertex in index order, the
//! first parent kept. Section 2.3, Algorithm 1, lines 6 and 10; the search for a movable marker.

use super::partial_map::PartialMap;
use crate::{
    clone_in_place::clone_in_place,
    embedded_graph::{Dart, Vertex},
    percept::Door,
};

/// A breadth-first tree of the known map.
#[derive(Debug, Default)]
pub(super) struct BreadthFirstTree {
    /// The vertices of the map; empty if there is no tree.
    vertices: Vec<TreeVertex>,
    root: Option<Vertex>,
    /// Scratch: the vertices in the order in which they were reached.
    reached: Vec<Vertex>,
}

clone_in_place!(BreadthFirstTree { vertices, root; scratch reached });

#[derive(Clone, Copy, Debug)]
struct TreeVertex {
    hops: u32,
    /// Its dart that leads towards the root; of no use at the root and outside of the tree.
    up: Dart,
}

const UNREACHED: u32 = u32::MAX;

impl BreadthFirstTree {
    pub(super) fn grow_from(&mut self, map: &PartialMap, root: Vertex) {
        let Self { vertices, reached, .. } = self;
        vertices.clear();
        vertices.resize(map.vertex_count(), TreeVertex { hops: UNREACHED, up: Dart(0) });
        vertices[root.at()].hops = 0;
        reached.clear();
        reached.push(root);
        let mut next = 0;
        'all_reached: while let Some(&vertex) = reached.get(next) {
            next += 1;
            let hops = vertices[vertex.at()].hops + 1;
            for far in map.known_opposites(vertex) {
                let neighbour = map.vertex(far);
                let place = &mut vertices[neighbour.at()];
                if place.hops == UNREACHED {
                    *place = TreeVertex { hops, up: far };
                    reached.push(neighbour);
                    if reached.len() == vertices.len() {
                        break 'all_reached;
                    }
                }
            }
        }
        self.root = Some(root);
    }

    #[inline]
    pub(super) fn clear(&mut self) {
        self.vertices.clear();
        self.root = None;
    }

    #[inline]
    pub(super) fn is_grown(&self) -> bool {
        self.root.is_some()
    }

    /// Grows a new tree, unless this is one of the map, from that root.
    #[inline]
    pub(super) fn grow_from_unless_rooted(&mut self, map: &PartialMap, root: Vertex) {
        if self.root != Some(root) || self.vertices.len() != map.vertex_count() {
            self.grow_from(map, root);
        }
    }

    /// Adds a vertex that was just added to the map with one edge. The tree stays breadth-first.
    pub(super) fn add_leaf(&mut self, map: &PartialMap, leaf: Vertex) {
        let entry = map.first_dart(leaf);
        if let Some(parent) = map.opposite(entry) {
            let hops = self.hops(map.vertex(parent)) + 1;
            self.vertices.push(TreeVertex { hops, up: entry });
        }
    }

    /// Whether a new edge between two of its vertices leaves the whole tree as it is. It does if both
    /// are equally far from the root: then neither is reached through the other.
    #[inline]
    pub(super) fn stays_with(&self, map: &PartialMap, one: Dart, other: Dart) -> bool {
        self.hops(map.vertex(one)) == self.hops(map.vertex(other))
    }

    /// Of the unexplored darts that are open, the one that is fewest hops from the root; then of the vertex discovered
    /// first; then with the lowest index. `None` if there is none.
    pub(super) fn nearest_unexplored(
        &self,
        map: &PartialMap,
        is_open: impl Fn(Dart) -> bool,
    ) -> Option<Dart> {
        // Of equals the first is returned.
        let open = map.unexplored().filter(|dart| is_open(*dart));
        open.min_by_key(|dart| self.hops(map.vertex(*dart)))
    }

    /// The number of edges from a vertex to the root; the vertex is in the tree.
    #[inline]
    pub(super) fn hops(&self, vertex: Vertex) -> u32 {
        self.vertices[vertex.at()].hops
    }

    /// Writes the darts of the path from the root to `target`.
    pub(super) fn path_from_root(&self, map: &PartialMap, target: Vertex, path: &mut Vec<Dart>) {
        path.clear();
        let mut vertex = target;
        while self.hops(vertex) != 0 {
            let Some(down) = map.opposite(self.vertices[vertex.at()].up) else {
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
        let mut ahead: Vec<_> = self.root.into_iter().collect();
        while let Some(vertex) = ahead.pop() {
            order.push(vertex);
            for far in map.darts_of(vertex).rev().filter_map(|dart| map.opposite(dart)) {
                let neighbour = map.vertex(far);
                let TreeVertex { hops, up } = self.vertices[neighbour.at()];
                if hops != UNREACHED && hops != 0 && up == far {
                    ahead.push(neighbour);
                }
            }
        }
    }

    /// The next door towards the root, and the pose behind it; `None` at the root, or without a tree.
    #[inline]
    pub(super) fn toward_root(&self, map: &PartialMap, pose: Dart) -> Option<(Door, Dart)> {
        let &TreeVertex { hops, up } = self.vertices.get(map.vertex(pose).at())?;
        if hops == 0 {
            return None;
        }
        Some((map.door(pose, up), map.opposite(up)?))
    }
}
