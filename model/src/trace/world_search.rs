//! Finds the smallest world that explains a trace, by growing worlds along the trace. Section 2.1.
//!
//! If the robot leaves by a dart whose other end is free, it reaches a new vertex or a free dart of a known
//! one. Each start with the given number of edges has exactly one such history, so none is missed.

use crate::{
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    enumerate::{Class, Watch},
    mapping::{FACING, PartialMap},
    percept::{Door, Percept, Sighting},
};

use super::Trace;

/// The worlds to search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WorldSearch {
    /// The class of worlds.
    pub class: Class,
    /// The largest number of edges, up to [`WorldSearch::MOST_EDGES`].
    pub max_edges: usize,
    /// The largest number of steps.
    pub steps: u64,
}

impl WorldSearch {
    /// About a second's work.
    pub const STEPS: u64 = 500_000;

    /// The largest number of edges that is ever tried: the depth of the search is the number of edges.
    pub const MOST_EDGES: usize = 1000;
}

/// The smallest world that explains a trace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SmallestWorld {
    /// A world; the first found with this number of edges.
    World {
        /// The world; the robot starts with dart 0 behind it.
        graph: EmbeddedGraph,
        /// The dart along which the marker lies, if it was perceived.
        marker: Option<Dart>,
    },
    /// No world with at most this many edges explains the trace. Larger ones were not searched.
    NotFound {
        /// The number of edges.
        edges: usize,
        /// Why the search ended.
        limit: SearchLimit,
    },
}

/// Why a search ended without a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchLimit {
    /// It reached the largest number of edges.
    Edges,
    /// It reached the largest number of steps.
    Steps,
    /// It was stopped.
    Stopped,
}

/// Finds the smallest world of a class in which a robot from some start, with a directional marker
/// somewhere or without one, has the recorded percepts.
///
/// The `known` map of Algorithm 1 for the trace is part of every such world.
#[must_use]
pub fn smallest(
    trace: &Trace,
    known: Option<&PartialMap>,
    search: WorldSearch,
    watch: &dyn Watch,
) -> SmallestWorld {
    let mut growing = Growing::new(trace, search.class, watch);
    growing.steps = search.steps;
    // Vertices with different degrees are different, and a world has at least their darts.
    let mut degrees: Vec<u32> = trace.percepts().iter().map(|percept| percept.degree).collect();
    degrees.sort_unstable();
    degrees.dedup();
    let darts: u64 = degrees.iter().map(|&degree| u64::from(degree)).sum();
    let known = known.filter(|map| map.vertex_count() > 0);
    let darts = darts.max(known.map_or(1, |map| map.dart_count() as u64));
    let least = usize::try_from(darts.div_ceil(2)).unwrap_or(usize::MAX);
    let most = search.max_edges.min(WorldSearch::MOST_EDGES);
    for edges in least..=most {
        growing.edges = edges;
        if growing.begin(known) {
            let (graph, marker) = (growing.world.graph(), growing.world.marker.map(Dart));
            return SmallestWorld::World { graph, marker };
        }
        if let Some(limit) = growing.stopped {
            return SmallestWorld::NotFound { edges: edges - 1, limit };
        }
    }
    SmallestWorld::NotFound { edges: most.max(least - 1), limit: SearchLimit::Edges }
}

/// A world that grows, and the state of the search.
struct Growing<'t> {
    trace: &'t Trace,
    class: Class,
    watch: &'t dyn Watch,
    edges: usize,
    steps: u64,
    stopped: Option<SearchLimit>,
    world: Draft,
}

/// The pose, and the number of moves explained.
#[derive(Clone, Copy)]
struct At {
    pose: u32,
    moves: usize,
}

/// Vertices with free darts, joined one edge at a time, which can be undone.
#[derive(Default)]
struct Draft {
    /// The first dart of each vertex.
    first: Vec<u32>,
    vertex: Vec<u32>,
    opposite: Vec<u32>,
    free: usize,
    /// The dart along which the marker lies, if it was seen.
    marker: Option<u32>,
}

/// Stands as the opposite of a free dart.
const FREE: u32 = u32::MAX;

impl Draft {
    /// What Algorithm 1 knows; the robot started with the marker along its entry dart.
    fn of(map: &PartialMap) -> Self {
        let mut draft = Self { marker: Some(FACING.0), ..Self::default() };
        for vertex in map.vertices() {
            draft.add(map.degree(vertex));
        }
        for dart in 0..map.dart_count() as u32 {
            if let Some(other) = map.opposite(Dart(dart)).filter(|other| other.0 > dart) {
                draft.join(dart, other.0);
            }
        }
        draft
    }

    fn degree(&self, vertex: u32) -> u32 {
        let next = self.first.get(vertex as usize + 1).copied();
        next.unwrap_or(self.vertex.len() as u32) - self.first[vertex as usize]
    }

    fn behind(&self, pose: u32, door: u32) -> u32 {
        let vertex = self.vertex[pose as usize];
        let first = self.first[vertex as usize];
        first + (pose - first + door) % self.degree(vertex)
    }

    fn door(&self, pose: u32, dart: u32) -> Door {
        let vertex = self.vertex[pose as usize];
        Door((dart + self.degree(vertex) - pose) % self.degree(vertex))
    }

    fn add(&mut self, degree: u32) -> u32 {
        let (vertex, first) = (self.first.len() as u32, self.vertex.len() as u32);
        self.first.push(first);
        let darts = self.vertex.len() + degree as usize;
        self.vertex.resize(darts, vertex);
        self.opposite.resize(darts, FREE);
        self.free += degree as usize;
        first
    }

    fn remove_last(&mut self) {
        if let Some(first) = self.first.pop() {
            self.free -= self.vertex.len() - first as usize;
            self.vertex.truncate(first as usize);
            self.opposite.truncate(first as usize);
        }
    }

    fn join(&mut self, one: u32, other: u32) {
        self.opposite[one as usize] = other;
        self.opposite[other as usize] = one;
        self.free -= 2;
    }

    fn part(&mut self, one: u32, other: u32) {
        self.opposite[one as usize] = FREE;
        self.opposite[other as usize] = FREE;
        self.free += 2;
    }

    /// Edges that are there or will have to be.
    fn edges(&self) -> usize {
        self.vertex.len().div_ceil(2)
    }

    fn adjacent(&self, one: u32, other: u32) -> bool {
        let first = self.first[one as usize] as usize;
        let darts = first..first + self.degree(one) as usize;
        darts.into_iter().any(|dart| {
            let opposite = self.opposite[dart];
            opposite != FREE && self.vertex[opposite as usize] == other
        })
    }

    /// The darts with no other end, after one.
    fn free_after(&self, dart: u32) -> Vec<u32> {
        let after = dart as usize + 1;
        (after..self.opposite.len())
            .filter(|&dart| self.opposite[dart] == FREE)
            .map(|dart| dart as u32)
            .collect()
    }

    fn graph(&self) -> EmbeddedGraph {
        let mut graph = EmbeddedGraph::unfinished();
        for vertex in 0..self.first.len() as u32 {
            let _: Vertex = graph.add_vertex(self.degree(vertex));
        }
        for (dart, &opposite) in self.opposite.iter().enumerate() {
            graph.join(Dart(dart as u32), Dart(opposite));
        }
        graph
    }
}

impl<'t> Growing<'t> {
    fn new(trace: &'t Trace, class: Class, watch: &'t dyn Watch) -> Self {
        let world = Draft::default();
        Self { trace, class, watch, edges: 0, steps: 0, stopped: None, world }
    }

    /// Explains the whole trace with the present number of edges.
    fn begin(&mut self, known: Option<&PartialMap>) -> bool {
        let first = self.trace.percepts()[0];
        if let Some(map) = known {
            self.world = Draft::of(map);
            return self.fits(FACING.0, first) && self.explain(At { pose: FACING.0, moves: 0 });
        }
        self.world = Draft::default();
        self.at_new_vertex(first, |growing, pose| growing.explain(At { pose, moves: 0 }))
    }

    /// Goes on with a new vertex that the robot perceives, if there may be one.
    fn at_new_vertex(
        &mut self,
        percept: Percept,
        go_on: impl FnOnce(&mut Self, u32) -> bool,
    ) -> bool {
        let Percept { degree, sighting } = percept;
        let points = match sighting {
            Sighting::Nothing => None,
            Sighting::Pointing(door) if door.0 < degree => Some(door.0),
            _ => return false,
        };
        let room = 2 * self.edges - self.world.vertex.len().min(2 * self.edges);
        let may = degree > 0 && degree <= self.class.max_degree() && degree as usize <= room;
        // There is one marker.
        if !may || (points.is_some() && self.world.marker.is_some()) {
            return false;
        }
        let pose = self.world.add(degree);
        let marker = self.world.marker;
        if let Some(door) = points {
            self.world.marker = Some(pose + door);
        }
        let found = go_on(self, pose);
        if !found {
            self.world.marker = marker;
            self.world.remove_last();
        }
        found
    }

    /// Explains what was recorded after so many moves, from a pose.
    fn explain(&mut self, mut at: At) -> bool {
        // Along known edges there is no choice.
        let leaving = loop {
            let Some(&door) = self.trace.doors().get(at.moves) else {
                return self.complete(0);
            };
            let vertex = self.world.vertex[at.pose as usize];
            if door.0 >= self.world.degree(vertex) {
                return false;
            }
            let dart = self.world.behind(at.pose, door.0);
            let opposite = self.world.opposite[dart as usize];
            if opposite == FREE {
                break dart;
            }
            at = At { pose: opposite, moves: at.moves + 1 };
            match self.trace.percepts().get(at.moves) {
                None => return self.complete(0),
                Some(&percept) if self.fits(at.pose, percept) => {}
                Some(_) => return false,
            }
        };
        let Some(&percept) = self.trace.percepts().get(at.moves + 1) else {
            return self.complete(0);
        };
        self.leave(leaving, percept, at.moves + 1)
    }

    /// Every way in which a dart with no other end can lead to where this is perceived.
    fn leave(&mut self, dart: u32, percept: Percept, moves: usize) -> bool {
        if self.is_over() {
            return false;
        }
        let near = self.world.vertex[dart as usize];
        for other in 0..self.world.opposite.len() as u32 {
            let far = self.world.vertex[other as usize];
            let possible = other != dart
                && self.world.opposite[other as usize] == FREE
                && self.fits(other, percept)
                && self.may_join(near, far);
            if possible {
                self.world.join(dart, other);
                if self.explain(At { pose: other, moves }) {
                    return true;
                }
                self.world.part(dart, other);
            }
        }
        self.at_new_vertex(percept, |growing, pose| {
            growing.world.join(dart, pose);
            let found = growing.explain(At { pose, moves });
            if !found {
                growing.world.part(dart, pose);
            }
            found
        })
    }

    /// Joins what is left over after everything is explained, from a dart on.
    fn complete(&mut self, from: u32) -> bool {
        if self.world.free == 0 {
            let exact = self.world.vertex.len() == 2 * self.edges;
            // What Algorithm 1 knows may be outside of the class.
            return exact
                && (self.class == Class::Multigraph || self.class.contains(&self.world.graph()));
        }
        if self.is_over() {
            return false;
        }
        let free = (from..self.world.opposite.len() as u32)
            .find(|&dart| self.world.opposite[dart as usize] == FREE);
        let Some(dart) = free else { return false };
        let near = self.world.vertex[dart as usize];
        for other in self.world.free_after(dart) {
            if self.may_join(near, self.world.vertex[other as usize]) {
                self.world.join(dart, other);
                if self.complete(dart + 1) {
                    return true;
                }
                self.world.part(dart, other);
            }
        }
        let room = 2 * self.edges - self.world.vertex.len().min(2 * self.edges);
        for degree in 1..=self.class.max_degree().min(room as u32) {
            let first = self.world.add(degree);
            self.world.join(dart, first);
            if self.complete(dart + 1) {
                return true;
            }
            self.world.part(dart, first);
            self.world.remove_last();
        }
        false
    }

    fn may_join(&self, near: u32, far: u32) -> bool {
        !self.class.is_simple() || (near != far && !self.world.adjacent(near, far))
    }

    /// Whether this is perceived by a robot that has come in by a dart of a vertex that it knows.
    fn fits(&self, pose: u32, percept: Percept) -> bool {
        let vertex = self.world.vertex[pose as usize];
        if self.world.degree(vertex) != percept.degree {
            return false;
        }
        let marker = self.world.marker.filter(|&dart| self.world.vertex[dart as usize] == vertex);
        let expected = match marker {
            Some(dart) => Sighting::Pointing(self.world.door(pose, dart)),
            None => Sighting::Nothing,
        };
        percept.sighting == expected
    }

    /// Whether there are too many edges, or the search is to end.
    fn is_over(&mut self) -> bool {
        if self.watch.stop() {
            self.stopped = Some(SearchLimit::Stopped);
        } else if self.steps == 0 {
            self.stopped = Some(SearchLimit::Steps);
        }
        self.steps = self.steps.saturating_sub(1);
        self.stopped.is_some() || self.world.edges() > self.edges
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use proptest::prelude::*;

    use super::*;
    use crate::{
        any_graph::any_graph,
        enumerate::{Each, Enumeration},
        isomorphism::code,
        marker::Directional,
        trace::{
            TraceClaim, TraceEventKind, match_algorithm, poses,
            tests::{explored, lollipop, walked},
        },
        world::{GraphWorld, State},
    };

    fn search(class: Class, edges: usize) -> WorldSearch {
        WorldSearch { class, max_edges: edges, steps: 10_000_000 }
    }

    /// The number of edges of the smallest world, by trying them all: every start, with the marker
    /// along each of its darts, or without one.
    fn by_trying_all(trace: &Trace, class: Class, most: usize) -> Option<usize> {
        (1..=most).find(|&edges| {
            let all = Enumeration::new(Each::Start, class, edges).unwrap();
            let explains = |graph: &EmbeddedGraph| {
                let marked = |facing| explains(graph, Some(facing), trace);
                explains(graph, None, trace) || graph.darts().any(marked)
            };
            let visit = |found: crate::enumerate::EnumeratedGraph| {
                if explains(found.graph) {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            };
            all.for_each(&mut { visit }).is_break()
        })
    }

    /// Whether a world explains a trace.
    fn explains(graph: &EmbeddedGraph, marker: Option<Dart>, trace: &Trace) -> bool {
        let state = State { pose: Dart(0), placed: Some(marker.unwrap_or(Dart(0))) };
        match marker {
            Some(_) => poses(graph, &Directional, &[state], trace).misfit.is_none(),
            None => poses(graph, &crate::marker::NoMarker, &[state], trace).misfit.is_none(),
        }
    }

    #[test]
    fn a_ring_of_three_explains_a_walk_round_a_ring_of_four_without_a_marker() {
        let corner = TraceEventKind::Percept(Percept { degree: 2, sighting: Sighting::Nothing });
        let trace = Trace::new([corner, TraceEventKind::Door(Door(1))].repeat(4)).unwrap();
        for (class, edges) in [(Class::Multigraph, 1), (Class::Simple, 3)] {
            let SmallestWorld::World { graph, marker } =
                smallest(&trace, None, search(class, 9), &())
            else {
                panic!("{class}")
            };
            assert_eq!((graph.edge_count(), marker), (edges, None));
        }
    }

    #[test]
    fn no_world_explains_a_vertex_that_changes() {
        let graph = lollipop();
        let mut trace = walked(&graph, Dart(0), &[Door(0), Door(0), Door(0)]);
        // The end of the tail is left and come back to, and looks different.
        trace.percepts[2].degree = 3;
        let found = smallest(&trace, None, search(Class::Multigraph, 6), &());
        assert_eq!(found, SmallestWorld::NotFound { edges: 6, limit: SearchLimit::Edges });
    }

    #[test]
    fn there_is_one_marker() {
        let percept = |degree| {
            TraceEventKind::Percept(Percept { degree, sighting: Sighting::Pointing(Door::BACK) })
        };
        // An end and a corner are not one vertex.
        let trace = Trace::new([percept(1), TraceEventKind::Door(Door(0)), percept(2)]).unwrap();
        let found = smallest(&trace, None, search(Class::Multigraph, 6), &());
        assert_eq!(found, SmallestWorld::NotFound { edges: 6, limit: SearchLimit::Edges });
    }

    #[test]
    fn a_search_names_the_limit_that_it_reached() {
        let trace = explored(&lollipop(), Dart(0));
        // The world of the trace has four edges.
        let limited = |search| smallest(&trace, None, search, &());
        assert_eq!(
            limited(search(Class::Multigraph, 3)),
            SmallestWorld::NotFound { edges: 3, limit: SearchLimit::Edges }
        );
        // Vertices of degrees 1, 2 and 3 have three edges, which no bound makes fewer.
        assert_eq!(
            limited(search(Class::Multigraph, 1)),
            SmallestWorld::NotFound { edges: 2, limit: SearchLimit::Edges }
        );
        let short = WorldSearch { steps: 3, ..search(Class::Multigraph, 6) };
        let SmallestWorld::NotFound { limit, .. } = limited(short) else { panic!() };
        assert_eq!(limit, SearchLimit::Steps);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn what_algorithm_1_knows_is_in_the_smallest_world(
            graph in any_graph(Class::Multigraph, 6), part in any::<prop::sample::Index>(),
        ) {
            let trace = explored(&graph, Dart(0));
            let trace = trace.up_to(part.index(trace.len()));
            let known = match_algorithm(&trace, TraceClaim::Part, 100).exploration.map().clone();
            let edges = |known| match smallest(&trace, known, search(Class::Multigraph, 6), &()) {
                SmallestWorld::World { graph, marker } => {
                    assert!(explains(&graph, marker, &trace));
                    graph.edge_count()
                }
                other @ SmallestWorld::NotFound { .. } => panic!("{other:?}"),
            };
            prop_assert_eq!(edges(Some(&known)), edges(None));
        }

        #[test]
        fn a_run_of_algorithm_1_is_explained_by_its_own_world_alone(
            graph in any_graph(Class::Multigraph, 10),
        ) {
            let trace = explored(&graph, Dart(0));
            let found = smallest(&trace, None, search(Class::Multigraph, 12), &());
            let SmallestWorld::World { graph: found, marker } = found else { panic!("{found:?}") };
            prop_assert_eq!(marker, Some(Dart(0)));
            prop_assert_eq!(code(&found, Dart(0)), code(&graph, Dart(0)));
        }

        #[test]
        fn the_smallest_world_of_a_walk_is_as_small_as_trying_all_finds(
            graph in any_graph(Class::Simple, 5),
            walk in prop::collection::vec(any::<u8>(), 0..12),
            class in prop::sample::select(Class::ALL.to_vec()),
            marked in any::<prop::sample::Index>(),
        ) {
            let facing = Dart(marked.index(graph.dart_count()) as u32);
            let mut world = GraphWorld::new(&graph, facing);
            world = world.clone().at(State { pose: Dart(0), ..world.state() });
            let mut events = vec![TraceEventKind::Percept(world.sensed())];
            for step in walk {
                let door = Door(u32::from(step) % world.sensed().degree);
                crate::world::World::traverse(&mut world, door).unwrap();
                events.extend([TraceEventKind::Door(door), TraceEventKind::Percept(world.sensed())]);
            }
            let trace = Trace::new(events).unwrap();
            let edges = match smallest(&trace, None, search(class, 5), &()) {
                SmallestWorld::World { graph, marker } => {
                    prop_assert!(explains(&graph, marker, &trace));
                    Some(graph.edge_count())
                }
                SmallestWorld::NotFound { limit: SearchLimit::Edges, .. } => None,
                other @ SmallestWorld::NotFound { .. } => panic!("{other:?}"),
            };
            prop_assert_eq!(edges, by_trying_all(&trace, class, 5));
        }
    }
}
