//! Certificates: shortest walks that determine their world.
//!
//! A walk determines its world exactly if its folded trail is complete. Each return to the marker raises
//! the cycle rank of the folded trail by at most one, so a certificate closes each edge that is not in a
//! breadth-first tree by a way there and a way back. A *hanging* edge leads to a part of the world that
//! is a tree without the marker. It is traversed there and back, except on the last way.
//!
//! No explorer can map a world in fewer moves than its certificate has, whatever it does.

use std::collections::VecDeque;

use crate::{
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    percept::Door,
};

/// A breadth-first tree from the marker's vertex.
struct MarkerTree<'g> {
    graph: &'g EmbeddedGraph,
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

impl<'g> MarkerTree<'g> {
    fn new(graph: &'g EmbeddedGraph, facing: Dart) -> Self {
        let count = graph.vertex_count();
        let root = graph.vertex(facing);
        let mut tree = Self {
            graph,
            distance: vec![usize::MAX; count],
            up: vec![facing; count],
            hangs: vec![true; count],
            hanging: vec![0; count],
            order: Vec::with_capacity(count),
        };
        tree.distance[root.at()] = 0;
        let mut queue = VecDeque::from([root]);
        while let Some(vertex) = queue.pop_front() {
            tree.order.push(vertex);
            for dart in graph.darts_of(vertex) {
                let entry = graph.opposite(dart);
                let next = graph.vertex(entry).at();
                if tree.distance[next] == usize::MAX {
                    tree.distance[next] = tree.distance[vertex.at()] + 1;
                    tree.up[next] = entry;
                    queue.push_back(graph.vertex(entry));
                }
            }
        }
        tree.hangs[root.at()] = false;
        for (one, other) in tree.loops().collect::<Vec<_>>() {
            for dart in [one, other] {
                tree.hangs[graph.vertex(dart).at()] = false;
            }
        }
        for &vertex in tree.order.iter().skip(1).rev() {
            if !tree.hangs[vertex.at()] {
                let parent = tree.parent(vertex);
                tree.hangs[parent.at()] = false;
            }
        }
        for &vertex in tree.order.iter().skip(1) {
            let hangs = usize::from(tree.hangs[vertex.at()]);
            tree.hanging[vertex.at()] = tree.hanging[tree.parent(vertex).at()] + hangs;
        }
        tree
    }

    fn root(&self) -> Vertex {
        self.order[0]
    }

    fn parent(&self, vertex: Vertex) -> Vertex {
        self.graph.vertex(self.graph.opposite(self.up[vertex.at()]))
    }

    fn is_tree_edge(&self, one: Dart, other: Dart) -> bool {
        [one, other].into_iter().any(|dart| {
            let vertex = self.graph.vertex(dart);
            vertex != self.root() && self.up[vertex.at()] == dart
        })
    }

    /// The edges that are not in the tree.
    fn loops(&self) -> impl Iterator<Item = (Dart, Dart)> + '_ {
        self.graph.edges().filter(|&(one, other)| !self.is_tree_edge(one, other))
    }

    fn distance_of(&self, dart: Dart) -> usize {
        self.distance[self.graph.vertex(dart).at()]
    }

    /// The hanging leaf at which a shortest certificate ends, and what that saves; `None` if it ends at
    /// the marker.
    fn last_leaf(&self) -> Option<(Vertex, usize)> {
        let saved = |&vertex: &Vertex| {
            let (hanging, distance) = (self.hanging[vertex.at()], self.distance[vertex.at()]);
            let leaf = self.hangs[vertex.at()] && self.graph.degree(vertex) == 1;
            (leaf && 2 * hanging > distance).then(|| (vertex, 2 * hanging - distance))
        };
        // The first of the best, in the order of the tree.
        self.order.iter().rev().filter_map(saved).max_by_key(|&(_, saved)| saved)
    }

    fn length(&self) -> usize {
        let loops: usize = self
            .loops()
            .map(|(one, other)| self.distance_of(one) + self.distance_of(other) + 1)
            .sum();
        let hanging = self.hangs.iter().filter(|&&hangs| hangs).count();
        loops + 2 * hanging - self.last_leaf().map_or(0, |(_, saved)| saved)
    }

    /// The darts by which a shortest certificate leaves, in order.
    fn walk(&self) -> Vec<Dart> {
        let last = self.last_leaf().map(|(leaf, _)| leaf);
        let mut on_last_way = vec![false; self.graph.vertex_count()];
        let mut last_way = Vec::new();
        let mut at = last.unwrap_or(self.root());
        while at != self.root() {
            on_last_way[at.at()] = true;
            last_way.push(self.graph.opposite(self.up[at.at()]));
            at = self.parent(at);
        }
        last_way.reverse();
        let mut walk = CertificateWalk {
            tree: self,
            visited: vec![false; self.hangs.len()],
            on_last_way,
            darts: vec![],
        };
        walk.visit(self.root());
        for (one, other) in self.loops() {
            let mut there = Vec::new();
            let mut at = self.graph.vertex(one);
            while at != self.root() {
                there.push(self.graph.opposite(self.up[at.at()]));
                at = self.parent(at);
            }
            for dart in there.into_iter().rev().chain([one]) {
                walk.take(dart);
            }
            let mut at = self.graph.vertex(other);
            while at != self.root() {
                walk.take(self.up[at.at()]);
                at = self.parent(at);
            }
        }
        for dart in last_way {
            walk.take(dart);
        }
        walk.darts
    }
}

/// A certificate under construction.
struct CertificateWalk<'t> {
    tree: &'t MarkerTree<'t>,
    visited: Vec<bool>,
    /// The vertices on the last way, which is not walked back.
    on_last_way: Vec<bool>,
    darts: Vec<Dart>,
}

impl CertificateWalk<'_> {
    /// Takes a dart. At the first visit of a vertex, what hangs there is traversed.
    fn take(&mut self, dart: Dart) {
        self.darts.push(dart);
        self.visit(self.tree.graph.vertex(self.tree.graph.opposite(dart)));
    }

    fn visit(&mut self, vertex: Vertex) {
        let graph = self.tree.graph;
        // A way through hanging trees, with the darts that are still to be tried at each vertex.
        let mut open = vec![(vertex, self.first_visit(vertex))];
        while let Some((vertex, darts)) = open.last_mut() {
            let Some(dart) = darts.pop() else {
                let vertex = *vertex;
                open.pop();
                if !open.is_empty() {
                    self.darts.push(self.tree.up[vertex.at()]);
                }
                continue;
            };
            let next = graph.vertex(graph.opposite(dart));
            self.darts.push(dart);
            let darts = self.first_visit(next);
            open.push((next, darts));
        }
    }

    /// The darts that lead to what hangs at a vertex and is not on the last way, the first one last.
    fn first_visit(&mut self, vertex: Vertex) -> Vec<Dart> {
        if std::mem::replace(&mut self.visited[vertex.at()], true) {
            return Vec::new();
        }
        let (tree, graph) = (self.tree, self.tree.graph);
        let leads_down = |dart: &Dart| {
            let next = graph.vertex(graph.opposite(*dart));
            tree.hangs[next.at()]
                && !self.on_last_way[next.at()]
                && next != tree.root()
                && tree.up[next.at()] == graph.opposite(*dart)
        };
        let mut darts: Vec<Dart> = graph.darts_of(vertex).filter(leads_down).collect();
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
#[must_use]
pub fn certificate_length(graph: &EmbeddedGraph, facing: Dart) -> usize {
    MarkerTree::new(graph, facing).length()
}

/// The doors of a shortest walk that determines the world of a start.
#[must_use]
pub fn certificate(graph: &EmbeddedGraph, facing: Dart) -> Vec<Door> {
    let mut pose = facing;
    let mut doors = Vec::new();
    for dart in MarkerTree::new(graph, facing).walk() {
        let degree = graph.degree(graph.vertex(pose));
        doors.push(Door::between(graph.index(pose), graph.index(dart), degree));
        pose = graph.opposite(dart);
    }
    doors
}

#[cfg(test)]
mod tests {
    use std::{
        collections::{HashMap, HashSet},
        ops::ControlFlow,
    };

    use super::*;
    use crate::{
        enumerate::{Class, Each, EnumeratedGraph, Enumeration},
        folding::{FoldedTrail, fold},
        percept::Percept,
        world::{GraphWorld, World},
    };

    fn percepts(graph: &EmbeddedGraph, facing: Dart, doors: &[Door]) -> Vec<Percept> {
        let mut world = GraphWorld::new(graph, facing);
        let mut percepts = vec![world.sensed()];
        for &door in doors {
            world.traverse(door).unwrap();
            percepts.push(world.sensed());
        }
        percepts
    }

    /// The folded trail as it is seen from the robot: two walks with one code have the same future.
    fn seen_from_robot(trail: &FoldedTrail) -> Vec<u32> {
        let mut number = HashMap::from([(trail.vertex(trail.pose()), (0, trail.pose()))]);
        let mut order = vec![trail.pose()];
        let mut code = Vec::new();
        let mut next = 0;
        while let Some(&pose) = order.get(next) {
            next += 1;
            let degree = trail.degree(pose);
            code.push(degree);
            for door in 0..degree {
                let dart = trail.behind(pose, Door(door));
                code.push(u32::from(trail.marker() == Some(dart)));
                let Some(far) = trail.opposite(dart) else {
                    code.push(u32::MAX);
                    continue;
                };
                let count = number.len() as u32;
                let (found, entry) = *number.entry(trail.vertex(far)).or_insert_with(|| {
                    order.push(far);
                    (count, far)
                });
                code.extend([found, trail.door(entry, far).0]);
            }
        }
        code
    }

    /// The moves of a shortest walk whose folded trail is complete, by trying all walks.
    fn shortest_by_trying_all(graph: &EmbeddedGraph, facing: Dart) -> usize {
        let world = GraphWorld::new(graph, facing);
        let trail = FoldedTrail::new(world.sensed()).unwrap();
        let mut seen = HashSet::from([seen_from_robot(&trail)]);
        let mut level = vec![(world, trail)];
        for moves in 0.. {
            if level.iter().any(|(_, trail)| trail.is_complete()) {
                return moves;
            }
            let mut later = Vec::new();
            for (world, trail) in &level {
                for door in 0..world.sensed().degree {
                    let (mut world, mut trail) = (world.clone(), trail.clone());
                    world.traverse(Door(door)).unwrap();
                    trail.step(Door(door), world.sensed()).unwrap();
                    if seen.insert(seen_from_robot(&trail)) {
                        later.push((world, trail));
                    }
                }
            }
            level = later;
        }
        unreachable!()
    }

    fn every_start(class: Class, edges: usize, mut visit: impl FnMut(&EmbeddedGraph)) {
        let starts = Enumeration::new(Each::Start, class, edges).unwrap();
        let mut visit = |found: EnumeratedGraph| {
            visit(found.graph);
            ControlFlow::Continue(())
        };
        let _: ControlFlow<()> = starts.for_each(&mut visit);
    }

    #[test]
    fn a_cycle_a_chain_and_a_star_have_the_lengths_of_the_formula() {
        let cycle = |count: usize| {
            let names: Vec<String> = (0..count).map(|vertex| vertex.to_string()).collect();
            let lists: Vec<(&str, Vec<&str>)> = (0..count)
                .map(|vertex| {
                    let [before, after] =
                        [vertex + count - 1, vertex + 1].map(|other| names[other % count].as_str());
                    (names[vertex].as_str(), vec![before, after])
                })
                .collect();
            EmbeddedGraph::from_neighbour_lists(&lists).unwrap()
        };
        for count in 3..9 {
            assert_eq!(certificate_length(&cycle(count), Dart(0)), count);
        }
        let chain = EmbeddedGraph::from_neighbour_lists(&[
            ("a", vec!["b"]),
            ("b", vec!["a", "c"]),
            ("c", vec!["b", "d"]),
            ("d", vec!["c"]),
        ])
        .unwrap();
        assert_eq!(certificate_length(&chain, Dart(0)), 3);
        let star = EmbeddedGraph::from_neighbour_lists(&[
            ("hub", vec!["a", "b", "c", "d", "e"]),
            ("a", vec!["hub"]),
            ("b", vec!["hub"]),
            ("c", vec!["hub"]),
            ("d", vec!["hub"]),
            ("e", vec!["hub"]),
        ])
        .unwrap();
        assert_eq!(certificate_length(&star, Dart(0)), 9);
    }

    #[test]
    fn every_certificate_has_the_length_of_the_formula_and_determines_its_world() {
        for (class, most) in [(Class::Multigraph, 5), (Class::Simple, 7)] {
            for edges in 1..=most {
                every_start(class, edges, |graph| {
                    let doors = certificate(graph, Dart(0));
                    assert_eq!(doors.len(), certificate_length(graph, Dart(0)));
                    let trail = fold(&percepts(graph, Dart(0), &doors), &doors).unwrap();
                    assert!(trail.is_complete(), "{graph:?}");
                });
            }
        }
    }

    #[test]
    fn no_shorter_walk_determines_its_world() {
        for (class, most) in [(Class::Multigraph, 3), (Class::Simple, 5)] {
            for edges in 1..=most {
                every_start(class, edges, |graph| {
                    let least = shortest_by_trying_all(graph, Dart(0));
                    assert_eq!(certificate_length(graph, Dart(0)), least, "{graph:?}");
                });
            }
        }
    }
}
