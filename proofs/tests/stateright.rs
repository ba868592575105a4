//! Algorithm 1 of Wang, Jenkin and Dymond, "Deterministic Topological Visual SLAM", Section 2.3, with
//! every order at line 5 and at line 9: a second opinion on `toposlam check --choices all`.
//!
//! Nothing here is the specification's but embedded graphs, percepts and the verifier of a bijection:
//! the map, the walks in it and the hypotheses are written separately, and stateright explores the states.
//! The way back is not: after a rejection the robot is where it was.

use std::{
    collections::VecDeque,
    hash::{Hash, Hasher},
};

use stateright::{Checker, Model, Property};
use toposlam_model::{
    check::{DEFAULT_STATE_BUDGET, every_way},
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    enumerate::Class,
    isomorphism::Bijection,
    mapping::Algorithm1Run,
    percept::{Door, Percept, Sighting},
};

use crate::starts;

/// An edge end of the map: a vertex, in the order of discovery, and a place clockwise from the dart
/// by which it was first entered; at the start vertex, from the facing dart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct End {
    vertex: usize,
    index: usize,
}

/// The start vertex, at which the marker lies.
const START: usize = 0;

/// S, with U: for each vertex and index, the other end of the edge; `None` in U.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Map(Vec<Vec<Option<End>>>);

/// What line 4 sees: the map, and the robot's vertex in it.
#[derive(Clone, Debug)]
struct AtLine4 {
    map: Map,
    vertex: usize,
    /// The world's vertex where it truly is. No state has two, or there would be more states.
    truly_at: Vertex,
    /// By which dart of the map it has come in, and by which of the world: needed to go on, but
    /// part of no state.
    index: usize,
    pose: Dart,
}

/// The edge chosen at line 5, and the order in which line 9 chooses hypotheses.
#[derive(Clone, Debug, PartialEq)]
struct Round {
    edge: End,
    hypotheses: Vec<End>,
}

/// How hypotheses are validated.
#[derive(Clone, Copy, PartialEq)]
enum Validation {
    /// Lines 10 to 17.
    Path,
    /// A broken variant: the first hypothesis is confirmed.
    Blind,
}

/// Algorithm 1 on a start.
#[derive(Clone)]
struct Mapping {
    world: EmbeddedGraph,
    facing: Dart,
    validation: Validation,
}

impl AtLine4 {
    fn sees(&self) -> (&Map, usize, Vertex) {
        (&self.map, self.vertex, self.truly_at)
    }
}

impl PartialEq for AtLine4 {
    fn eq(&self, other: &Self) -> bool {
        self.sees() == other.sees()
    }
}

impl Hash for AtLine4 {
    fn hash<H: Hasher>(&self, hasher: &mut H) {
        self.sees().hash(hasher);
    }
}

impl Map {
    fn degree(&self, vertex: usize) -> usize {
        self.0[vertex].len()
    }

    fn opposite(&self, end: End) -> Option<End> {
        self.0[end.vertex][end.index]
    }

    fn ends(&self) -> impl Iterator<Item = End> {
        let indices = |vertex| (0..self.degree(vertex)).map(move |index| End { vertex, index });
        (0..self.0.len()).flat_map(indices)
    }

    fn unexplored(&self) -> impl Iterator<Item = End> {
        self.ends().filter(|&end| self.opposite(end).is_none())
    }

    fn join(&mut self, one: End, other: End) {
        self.0[one.vertex][one.index] = Some(other);
        self.0[other.vertex][other.index] = Some(one);
    }

    /// What a robot expects to perceive that comes in by this end.
    fn expected(&self, end: End) -> Percept {
        let degree = self.degree(end.vertex);
        let pointing = || Sighting::Pointing(Door(((degree - end.index) % degree) as u32));
        let sighting = if end.vertex == START { pointing() } else { Sighting::Nothing };
        Percept { degree: degree as u32, sighting }
    }

    /// The ends by which a shortest path leaves the vertices from one to another.
    fn path(&self, from: usize, to: usize) -> Vec<End> {
        let mut paths = vec![None; self.0.len()];
        paths[from] = Some(Vec::new());
        let mut open = VecDeque::from([from]);
        while let Some(vertex) = open.pop_front() {
            for index in 0..self.degree(vertex) {
                let Some(far) = self.opposite(End { vertex, index }) else { continue };
                if paths[far.vertex].is_none() {
                    let mut path: Vec<End> = paths[vertex].clone().unwrap();
                    path.push(End { vertex, index });
                    paths[far.vertex] = Some(path);
                    open.push_back(far.vertex);
                }
            }
        }
        paths[to].clone().expect("what is known is connected")
    }

    /// Where the ends truly are: each vertex was first entered from one discovered before it.
    fn image(&self, world: &EmbeddedGraph, facing: Dart) -> Vec<Vec<Dart>> {
        let mut image: Vec<Vec<Dart>> = Vec::new();
        for vertex in 0..self.0.len() {
            let entry = match self.opposite(End { vertex, index: 0 }) {
                Some(from) if vertex != START => world.opposite(image[from.vertex][from.index]),
                _ => facing,
            };
            let around = std::iter::successors(Some(entry), |&dart| Some(world.clockwise(dart)));
            image.push(around.take(self.degree(vertex)).collect());
        }
        image
    }
}

impl Mapping {
    fn at_line_4(&self, map: Map, End { vertex, index }: End, pose: Dart) -> AtLine4 {
        AtLine4 { map, vertex, truly_at: self.world.vertex(pose), index, pose }
    }

    fn perceived(&self, pose: Dart) -> Percept {
        let degree = self.world.degree_around(pose);
        let mut doors = (0..degree).map(Door);
        let marked = doors.find(|&door| self.world.behind(pose, door) == self.facing);
        Percept { degree, sighting: marked.map_or(Sighting::Nothing, Sighting::Pointing) }
    }

    /// Leaves a vertex of the map by `out` that was entered by `index`, and answers where that
    /// truly leads.
    fn leave(&self, map: &Map, index: usize, pose: Dart, out: End) -> Dart {
        let degree = map.degree(out.vertex);
        self.world.after(pose, Door(((degree + out.index - index) % degree) as u32))
    }

    /// Lines 6 and 7: where the robot truly is at the unknown end of an edge; `None` where a known
    /// place is not as it was.
    fn explore(&self, state: &AtLine4, edge: End) -> Option<Dart> {
        let AtLine4 { map, mut index, mut pose, .. } = state.clone();
        for out in map.path(state.vertex, edge.vertex) {
            pose = self.leave(&map, index, pose, out);
            let entered = map.opposite(out).expect("the path is explored");
            if self.perceived(pose) != map.expected(entered) {
                return None;
            }
            index = entered.index;
        }
        Some(self.leave(&map, index, pose, edge))
    }

    /// Line 7: H, without what the percept contradicts at once.
    fn hypotheses(&self, map: &Map, edge: End, pose: Dart) -> Vec<End> {
        let perceived = self.perceived(pose);
        let others = map.unexplored().filter(|&end| end != edge);
        others.filter(|&end| map.expected(end) == perceived).collect()
    }

    /// Lines 10 to 17: where the robot believes it is, and truly is, at the end of the path to the
    /// marker; `None` if the percepts do not match, and it has gone back.
    fn try_path(&self, map: &Map, hypothesis: End, mut pose: Dart) -> Option<(End, Dart)> {
        let mut at = hypothesis;
        if self.validation == Validation::Blind {
            return Some((at, pose));
        }
        for out in map.path(hypothesis.vertex, START) {
            pose = self.leave(map, at.index, pose, out);
            at = map.opposite(out).expect("the path is explored");
            if self.perceived(pose) != map.expected(at) {
                return None;
            }
        }
        Some((at, pose))
    }
}

impl Model for Mapping {
    type State = AtLine4;
    type Action = Round;

    /// Lines 1 to 3.
    fn init_states(&self) -> Vec<AtLine4> {
        let degree = self.world.degree_around(self.facing) as usize;
        let map = Map(vec![vec![None; degree]]);
        vec![self.at_line_4(map, End { vertex: START, index: 0 }, self.facing)]
    }

    /// Lines 5 and 9. From a wrong map a run may go on without end; it is enough that it is wrong.
    fn actions(&self, state: &AtLine4, rounds: &mut Vec<Round>) {
        if !self.embeds(state) {
            return;
        }
        for edge in state.map.unexplored() {
            let Some(pose) = self.explore(state, edge) else { continue };
            let orders = orders(&self.hypotheses(&state.map, edge, pose));
            rounds.extend(orders.into_iter().map(|hypotheses| Round { edge, hypotheses }));
        }
    }

    /// Lines 6 to 23.
    fn next_state(&self, state: &AtLine4, Round { edge, hypotheses }: Round) -> Option<AtLine4> {
        let mut map = state.map.clone();
        let pose = self.explore(state, edge)?;
        for hypothesis in hypotheses {
            // 18 to 20.
            if let Some((at, pose)) = self.try_path(&map, hypothesis, pose) {
                map.join(edge, hypothesis);
                return Some(self.at_line_4(map, at, pose));
            }
        }
        // 21 to 23.
        let vertex = map.0.len();
        map.0.push(vec![None; self.perceived(pose).degree as usize]);
        let entry = End { vertex, index: 0 };
        map.join(edge, entry);
        Some(self.at_line_4(map, entry, pose))
    }

    fn properties(&self) -> Vec<Property<Self>> {
        vec![
            Property::always(EMBEDS, Self::embeds),
            Property::always(LOCATED, Self::is_located),
            Property::always(AS_IT_WAS, Self::goes_everywhere),
            Property::always(ISOMORPHIC, |mapping, state: &AtLine4| {
                !state.is_finished() || mapping.is_isomorphic(state)
            }),
            Property::sometimes(FINISHED, |_, state: &AtLine4| state.is_finished()),
        ]
    }
}

const EMBEDS: &str = "the known map embeds in the world";
const LOCATED: &str = "the robot is where it believes it is";
const AS_IT_WAS: &str = "every known place is as it was";
const ISOMORPHIC: &str = "a finished map is isomorphic to the world";
const FINISHED: &str = "a map is finished";

impl AtLine4 {
    fn is_finished(&self) -> bool {
        self.map.unexplored().next().is_none()
    }
}

impl Mapping {
    /// Dart for dart, whole vertices, no two at the same place, and edges on edges.
    fn embeds(&self, AtLine4 { map, .. }: &AtLine4) -> bool {
        let image = map.image(&self.world, self.facing);
        let of = |end: End| image[end.vertex][end.index];
        let mut taken = image.concat();
        taken.sort_unstable();
        let is_whole =
            |around: &Vec<Dart>| around.len() == self.world.degree_around(around[0]) as usize;
        let lies_on_an_edge =
            |end| map.opposite(end).is_none_or(|far| of(far) == self.world.opposite(of(end)));
        taken.windows(2).all(|pair| pair[0] != pair[1])
            && image.iter().all(is_whole)
            && map.ends().all(lies_on_an_edge)
    }

    fn is_located(&self, state: &AtLine4) -> bool {
        let image = state.map.image(&self.world, self.facing);
        image[state.vertex][state.index] == state.pose
    }

    fn goes_everywhere(&self, state: &AtLine4) -> bool {
        state.map.unexplored().all(|edge| self.explore(state, edge).is_some())
    }

    /// Whether the bijection that discovery gives is one of the finished map and the world.
    fn is_isomorphic(&self, AtLine4 { map, .. }: &AtLine4) -> bool {
        let number = |end: End| map.ends().position(|other| other == end).unwrap() as u32;
        let far = |end| map.opposite(end).expect("nothing is unexplored");
        let next = |end: End| End { index: (end.index + 1) % map.degree(end.vertex), ..end };
        let opposite: Vec<u32> = map.ends().map(|end| number(far(end))).collect();
        let clockwise: Vec<u32> = map.ends().map(|end| number(next(end))).collect();
        let (graph, _) = EmbeddedGraph::from_permutations(&opposite, &clockwise).unwrap();
        let images = map.image(&self.world, self.facing).concat();
        Bijection::claimed(images).verify(&graph, &self.world)
    }
}

/// Every order of these.
fn orders(ends: &[End]) -> Vec<Vec<End>> {
    if ends.is_empty() {
        return vec![vec![]];
    }
    let first = |place| {
        let mut rest = ends.to_vec();
        let first = rest.remove(place);
        orders(&rest).into_iter().map(move |order| [vec![first], order].concat())
    };
    (0..ends.len()).flat_map(first).collect()
}

/// The numbers of starts are OEIS A000698; those of states come from an independent computation.
#[test]
fn stateright_finds_the_states_of_every_way_and_no_wrong_map() {
    for (edges, count, states) in [(1, 2, 4), (2, 10, 43), (3, 74, 725), (4, 706, 16471)] {
        let starts = starts(Class::Multigraph, edges..=edges);
        assert_eq!(starts.len(), count);
        let mut total = 0;
        for world in starts {
            let facing = Dart(0);
            let every_way =
                every_way(Algorithm1Run::default(), &world, facing, DEFAULT_STATE_BUDGET, &());
            let mapping = Mapping { world, facing, validation: Validation::Path };
            let checker = mapping.checker().threads(1).spawn_dfs().join();
            checker.assert_properties();
            let found = checker.unique_state_count();
            assert_eq!(every_way.unwrap().states, found as u64, "{:?}", checker.model().world);
            total += found;
        }
        assert_eq!(total, states, "{edges} edges");
    }
}

/// Two edges are too few: there every hypothesis that the percept leaves is right.
#[test]
fn hypotheses_that_are_confirmed_blindly_make_wrong_maps() {
    for (edges, wrong) in [(1, 0), (2, 0), (3, 14), (4, 267)] {
        let mut discovered = 0;
        for world in starts(Class::Multigraph, edges..=edges) {
            let mapping = Mapping { world, facing: Dart(0), validation: Validation::Blind };
            let checker = mapping.checker().threads(1).spawn_dfs().join();
            if let Some(path) = checker.discovery(EMBEDS) {
                discovered += 1;
                let state = path.last_state();
                assert!(!checker.model().embeds(state), "a wrong map is shown: {state:?}");
            }
        }
        assert_eq!(discovered, wrong, "{edges} edges");
    }
}
