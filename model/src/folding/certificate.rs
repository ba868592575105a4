//! Certificates: shortest walks that determine their world.
//!
//! Each return to the marker raises the cycle rank of the folded trail by at most one, so a certificate closes each edge
//! that is not in a breadth-first tree by a way there and a way back. A *hanging* edge leads to a part of the world that
//! is a tree without the marker. It is traversed there and back, except on the last way. No explorer can map a world in
//! fewer moves than its certificate has.

use std::mem;

use super::marker_tree::MarkerTree;
use crate::{
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    percept::Door,
};

struct CertificateWalk<'g> {
    graph: &'g EmbeddedGraph,
    tree: MarkerTree,
    visited: Vec<bool>,
    /// The vertices on the last way, which is not walked back.
    on_last_way: Vec<bool>,
    darts: Vec<Dart>,
}

impl<'g> CertificateWalk<'g> {
    fn new(graph: &'g EmbeddedGraph, root: Vertex) -> Self {
        let mut tree = MarkerTree::default();
        tree.grow(graph, root);
        let visited = vec![false; graph.vertex_count()];
        Self { graph, tree, on_last_way: visited.clone(), visited, darts: Vec::new() }
    }

    /// Walks along the tree and along each edge outside it, and ends on the last way.
    fn walk(&mut self) {
        let last_way = match self.tree.last_leaf(self.graph) {
            Some((leaf, _)) => self.way_from_marker(leaf),
            None => Vec::new(),
        };
        for &dart in &last_way {
            let vertex = self.behind(dart);
            self.on_last_way[vertex.at()] = true;
        }
        self.visit(self.tree.root());
        for (one, other) in self.graph.edges() {
            if [one, other].into_iter().any(|dart| self.tree.leads_up(self.graph, dart)) {
                continue;
            }
            for dart in self.way_from_marker(self.graph.vertex(one)) {
                self.take(dart);
            }
            self.take(one);
            let mut at = self.graph.vertex(other);
            while at != self.tree.root() {
                let up = self.tree.up(at);
                self.take(up);
                at = self.behind(up);
            }
        }
        for dart in last_way {
            self.take(dart);
        }
    }

    fn behind(&self, dart: Dart) -> Vertex {
        self.graph.vertex(self.graph.opposite(dart))
    }

    fn way_from_marker(&self, mut vertex: Vertex) -> Vec<Dart> {
        let mut way = Vec::new();
        while vertex != self.tree.root() {
            let down = self.graph.opposite(self.tree.up(vertex));
            way.push(down);
            vertex = self.graph.vertex(down);
        }
        way.reverse();
        way
    }

    /// Takes a dart. At the first visit of a vertex, what hangs there is traversed.
    fn take(&mut self, dart: Dart) {
        self.darts.push(dart);
        self.visit(self.behind(dart));
    }

    fn visit(&mut self, vertex: Vertex) {
        // A way through hanging trees, with the darts that are still to be tried at each vertex.
        let mut open = vec![(vertex, self.first_visit(vertex))];
        while let Some((vertex, darts)) = open.last_mut() {
            let Some(dart) = darts.pop() else {
                let vertex = *vertex;
                open.pop();
                if !open.is_empty() {
                    self.darts.push(self.tree.up(vertex));
                }
                continue;
            };
            let next = self.behind(dart);
            self.darts.push(dart);
            let darts = self.first_visit(next);
            open.push((next, darts));
        }
    }

    /// The darts that lead to what hangs at a vertex and is not on the last way, the first one last.
    fn first_visit(&mut self, vertex: Vertex) -> Vec<Dart> {
        if mem::replace(&mut self.visited[vertex.at()], true) {
            return Vec::new();
        }
        let leads_down = |&dart: &Dart| {
            let next = self.behind(dart);
            self.tree.hangs(next)
                && !self.on_last_way[next.at()]
                && self.tree.leads_up(self.graph, self.graph.opposite(dart))
        };
        let mut darts: Vec<Dart> = self.graph.darts_of(vertex).filter(leads_down).collect();
        darts.reverse();
        darts
    }
}

/// The number of moves of a shortest walk that determines the world of a start:
///
/// the sum over the edges `uv` that are not in a breadth-first tree from the marker of
/// `d(u) + d(v) + 1`, plus `2 A`, plus the least of 0 and `d(l) - 2 a(l)` over the hanging leaves `l`,
///
/// where `d` is the distance from the marker, `A` is the number of hanging edges, a hanging leaf is a
/// vertex of degree 1 behind one, and `a(l)` is the number of hanging edges on its way to the marker.
/// It depends on the marker's vertex, and not on where the marker points.
pub fn certificate_length(graph: &EmbeddedGraph, facing: Dart) -> usize {
    MarkerTree::default().certificate(graph, graph.vertex(facing))
}

/// The darts by which a shortest walk from a vertex leaves, if the marker lies there and the walk
/// determines the world.
pub(crate) fn certificate_darts(graph: &EmbeddedGraph, marked: Vertex) -> Vec<Dart> {
    let mut walk = CertificateWalk::new(graph, marked);
    walk.walk();
    walk.darts
}

/// The doors of a shortest walk that determines the world of a start.
pub fn certificate(graph: &EmbeddedGraph, facing: Dart) -> Vec<Door> {
    let darts = certificate_darts(graph, graph.vertex(facing));
    let mut pose = facing;
    let mut doors = Vec::with_capacity(darts.len());
    for dart in darts {
        let degree = graph.degree(graph.vertex(pose));
        doors.push(Door::between(graph.index(pose), graph.index(dart), degree));
        pose = graph.opposite(dart);
    }
    doors
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;
    use crate::{
        any_graph::{Class, starts, walk},
        folding::{FoldedTrail, fold},
        world::{GraphWorld, World},
    };

    /// The moves of a shortest walk whose folded trail is complete, by trying all walks.
    fn shortest_by_trying_all(graph: &EmbeddedGraph, facing: Dart) -> usize {
        let world = GraphWorld::new(graph, facing);
        let trail = FoldedTrail::new(world.sensed()).unwrap();
        let mut seen = HashSet::from([trail.seen_from_robot()]);
        let mut level = vec![(world, trail)];
        let mut moves = 0;
        while !level.iter().any(|(_, trail)| trail.is_complete()) {
            moves += 1;
            let mut later = Vec::new();
            for (world, trail) in &level {
                for door in 0..world.sensed().degree {
                    let (mut world, mut trail) = (world.clone(), trail.clone());
                    world.traverse(Door(door)).unwrap();
                    trail.step(Door(door), world.sensed()).unwrap();
                    if seen.insert(trail.seen_from_robot()) {
                        later.push((world, trail));
                    }
                }
            }
            level = later;
        }
        moves
    }

    /// The robot has its back to leaf 0 and comes back from each leaf, but from the last one.
    #[test]
    fn the_leaves_of_a_star_are_visited_clockwise() {
        let leaves = ["a", "b", "c", "d"];
        let star = [("x", leaves.to_vec())].into_iter().chain(leaves.map(|leaf| (leaf, vec!["x"])));
        let star = EmbeddedGraph::from_neighbour_lists(&star.collect::<Vec<_>>()).unwrap();
        assert_eq!(certificate(&star, Dart(0)), [1, 0, 1, 0, 1, 0, 1].map(Door));
    }

    #[test]
    fn a_cycle_a_chain_and_a_star_have_the_lengths_of_the_formula() {
        for count in 3..9 {
            assert_eq!(certificate_length(&EmbeddedGraph::cycle(count), Dart(0)), count);
        }
        assert_eq!(certificate_length(&EmbeddedGraph::chain(3), Dart(0)), 3);
        let leaves = ["a", "b", "c", "d", "e"];
        let lists = leaves.map(|leaf| (leaf, vec!["hub"]));
        let star = [&[("hub", leaves.to_vec())], &lists[..]].concat();
        let star = EmbeddedGraph::from_neighbour_lists(&star).unwrap();
        assert_eq!(certificate_length(&star, Dart(0)), 9);
    }

    #[test]
    fn no_shorter_walk_determines_its_world() {
        for (class, most) in [(Class::Multigraph, 3), (Class::Simple, 5)] {
            for graph in (1..=most).flat_map(|edges| starts(class, edges)) {
                let least = shortest_by_trying_all(&graph, Dart(0));
                assert_eq!(certificate_length(&graph, Dart(0)), least, "{graph:?}");
            }
        }
    }

    #[test]
    fn every_certificate_has_the_length_of_the_formula_and_determines_its_world() {
        for (class, most) in [(Class::Multigraph, 5), (Class::Simple, 7)] {
            for graph in (1..=most).flat_map(|edges| starts(class, edges)) {
                let doors = certificate(&graph, Dart(0));
                assert_eq!(doors.len(), certificate_length(&graph, Dart(0)));
                let world = GraphWorld::new(&graph, Dart(0));
                let (percepts, doors) = walk(world, doors.iter().map(|door| door.0));
                assert!(fold(&percepts, &doors).unwrap().is_complete(), "{graph:?}");
            }
        }
    }
}
