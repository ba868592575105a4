//! The check fails on broken variants of Algorithm 1, each on its smallest start; steps out of order are errors; and
//! the default choices are those of the design.

use std::collections::BTreeMap;

use proptest::prelude::*;

use super::*;
use crate::{
    any_graph::{Class, any_graph, by_edges, starts},
    check::{
        every_way,
        smallest_failure::{delegate_to_run, new, smallest_failure, too_large},
    },
    embedded_graph::{EmbeddedGraph, Vertex},
    mapping::{self, Observed, explore, explore_with},
    world::{GraphWorld, World},
};

/// Algorithm 1 with something broken in lines 10 to 17.
#[derive(Clone)]
struct Broken {
    flaw: Flaw,
    run: Algorithm1Run,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Flaw {
    /// Line 15 is left out.
    NoRetrace,
    /// Line 12 does not look where the marker points.
    DirectionIgnored,
    /// A hypothesis is confirmed by the first percept that matches: that on arrival.
    FirstPerceptSuffices,
    /// Line 10 expects the marker to point one door further than it does.
    OffByOne,
    /// No hypothesis that takes a path is ever confirmed.
    NeverConfirmed,
    /// At the marker, the robot believes that it is still where the path began.
    LeftBehind,
}

impl Flaw {
    fn matches(self, expected: Percept, perceived: Percept) -> bool {
        match (self, expected.sighting, perceived.sighting) {
            (Self::DirectionIgnored, Sighting::Pointing(_), Sighting::Pointing(_)) => {
                expected.degree == perceived.degree
            }
            (Self::OffByOne, Sighting::Pointing(door), _) => {
                let door = Door((door.0 + 1) % expected.degree);
                Percept { sighting: Sighting::Pointing(door), ..expected } == perceived
            }
            _ => expected == perceived,
        }
    }

    fn try_path<W: ObservedWorld>(
        self,
        run: &mut Algorithm1Run,
        hypothesis: Dart,
        world: &mut W,
    ) -> Mapped<W, bool> {
        run.trail.clear();
        let mut pose = hypothesis;
        if self == Self::FirstPerceptSuffices {
            run.arrive_at_marker(pose);
            return Ok(true);
        }
        while let Some((door, next)) = run.walk.from_start.toward_root(run.map(), pose) {
            let expected = run.map().expected(next);
            let perceived = run.go_through(door, world)?;
            if !self.matches(expected, perceived) {
                if self != Self::NoRetrace {
                    run.retrace(world)?;
                }
                return Ok(false);
            }
            pose = next;
        }
        if self == Self::NeverConfirmed && pose != hypothesis {
            run.retrace(world)?;
            return Ok(false);
        }
        run.arrive_at_marker(if self == Self::LeftBehind { hypothesis } else { pose });
        Ok(true)
    }
}

impl Explorer for Broken {
    delegate_to_run!(DirectionalMarker, MappingChoice);

    fn add_choices(&mut self, choices: &mut Vec<MappingChoice>) -> Result<(), InvalidStep> {
        self.run.add_choices(choices)
    }

    fn step<W: ObservedWorld>(&mut self, choice: MappingChoice, world: &mut W) -> Mapped<W> {
        let flaw = self.flaw;
        self.run.step_with(choice, world, |run, hypothesis, world| {
            flaw.try_path(run, hypothesis, world)
        })
    }

    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        self.run.move_bound(edges, vertices)
    }
}

fn broken(flaw: Flaw) -> Broken {
    Broken { flaw, run: Algorithm1Run::default() }
}

// paper: alg1.validation, alg1.hypotheses
// paper: alg1.10, alg1.11, alg1.12, alg1.13, alg1.14, alg1.15, alg1.16, alg1.17
#[test]
fn every_broken_variant_is_caught_on_a_small_start() {
    for (flaw, edges, code, failure) in [
        (
            Flaw::NoRetrace,
            3,
            vec![new(1), new(5), 5, 4],
            too_large("after 4 moves the map's darts 2 and 4 are wrongly made one edge", 6),
        ),
        (
            Flaw::DirectionIgnored,
            4,
            vec![new(2), new(6), 4, 7, 6],
            too_large("after 5 moves the map's darts 3 and 5 are wrongly made one edge", 8),
        ),
        (
            Flaw::FirstPerceptSuffices,
            3,
            vec![new(1), new(5), 5, 4],
            "after 2 moves the map's darts 2 and 3 are wrongly made one edge: the world \
             contradicts itself: behind the unexplored dart 3 of vertex v1 there is degree 1 with \
             the marker along door 0, which agrees with no unexplored dart of the marked vertex"
                .to_owned(),
        ),
        (
            Flaw::OffByOne,
            3,
            vec![new(2), new(4), 3, 5],
            too_large("after 6 moves vertex v2 is wrongly added behind the map's dart 4", 6),
        ),
        (
            Flaw::NeverConfirmed,
            2,
            vec![new(1), new(3), 3],
            too_large("after 4 moves vertex v2 is wrongly added behind the map's dart 2", 4),
        ),
    ] {
        let found = smallest_failure(|| broken(flaw), Class::Multigraph, 4);
        assert_eq!(found, (edges, code, failure), "{flaw:?}");
    }
}

/// With all choices, too, the end of every run is judged: what the broken variants do wrong there is
/// seen in the map and in the pose, not only where they run into a contradiction.
#[test]
fn every_way_of_a_broken_variant_is_judged() {
    let mut seen = BTreeMap::new();
    for flaw in [Flaw::DirectionIgnored, Flaw::FirstPerceptSuffices, Flaw::LeftBehind] {
        for graph in (1..=4).flat_map(|edges| starts(Class::Multigraph, edges)) {
            let kind = match every_way(broken(flaw), &graph, Dart(0), 100_000, &()) {
                Ok(_) => "right",
                Err(mapping::Flaw::WrongMap) => "map",
                Err(mapping::Flaw::WrongPose { .. }) => "pose",
                Err(_) => "error",
            };
            *seen.entry((flaw, kind)).or_insert(0) += 1;
        }
    }
    assert_eq!(seen[&(Flaw::DirectionIgnored, "map")], 32);
    assert_eq!(seen[&(Flaw::FirstPerceptSuffices, "map")], 94);
    assert_eq!(seen[&(Flaw::LeftBehind, "pose")], 142);
}

fn theta() -> EmbeddedGraph {
    by_edges("u: a b c | v: c b a")
}

/// A step out of order is an error and changes nothing. Nothing is left of an earlier run.
#[test]
fn a_step_out_of_order_is_an_error() {
    let error = |step| Err(MappingError::InvalidStep(step));
    let [edge, hypothesis] = [MappingChoice::Edge(Dart(0)), MappingChoice::Hypothesis(0)];
    let unexplored = InvalidStep::NotUnexplored(Dart(0));
    let no_hypothesis = InvalidStep::NoHypothesis { index: 0, left: 0 };
    let graph = theta();
    let mut world = GraphWorld::new(&graph, Dart(0));
    let mut fresh = Algorithm1Run::new(6);
    let mut done = Algorithm1Run::new(6);
    explore(&mut done, &mut GraphWorld::new(&graph, Dart(0))).unwrap();
    for run in [&mut fresh, &mut done] {
        let map = run.map().clone();
        assert_eq!(run.choose().unwrap(), None);
        assert_eq!(run.choices().unwrap(), []);
        assert_eq!(run.step(edge, &mut world), error(unexplored));
        assert_eq!(run.step(hypothesis, &mut world), error(no_hypothesis));
        assert_eq!(run.close_loop(Dart(0), &mut world), Err(InvalidStep::NoEdge));
        assert_eq!(run.add_place(&mut world), error(InvalidStep::NoEdge));
        assert_eq!(run.map(), &map);
    }
    assert_eq!((fresh.moves(), fresh.map().complete()), (0, None));
    // A start that is refused leaves nothing of the run before.
    world.traverse(Door(1)).unwrap();
    done.begin(&mut world).unwrap_err();
    assert_eq!((done.robot(), done.moves(), done.map().dart_count()), (Dart(0), 0, 0));
}

/// A loop is closed by another unexplored dart than the one that is being explored, or not at all.
/// Meanwhile no other edge can be chosen.
#[test]
fn a_loop_is_not_closed_by_a_dart_that_is_explored() {
    let graph = theta();
    let mut world = GraphWorld::new(&graph, Dart(0));
    let mut run = Algorithm1Run::new(6);
    run.begin(&mut world).unwrap();
    run.step(MappingChoice::Edge(Dart(0)), &mut world).unwrap();
    let map = run.map().clone();
    run.explore(Dart(4), &mut world).unwrap();
    for dart in [0, 3, 4, 6].map(Dart) {
        let invalid = InvalidStep::NotUnexplored(dart);
        assert_eq!(run.close_loop(dart, &mut world), Err(invalid));
    }
    let left = run.hypotheses().len();
    for (choice, invalid) in [
        (MappingChoice::Edge(Dart(1)), InvalidStep::EdgeInProgress(Dart(4))),
        (MappingChoice::Edge(Dart(4)), InvalidStep::EdgeInProgress(Dart(4))),
        (MappingChoice::Hypothesis(left), InvalidStep::NoHypothesis { index: left, left }),
    ] {
        assert_eq!(run.step(choice, &mut world), Err(invalid.into()));
    }
    // All of that has changed nothing.
    assert_eq!((run.map(), run.is_at_line_8()), (&map, true));
    run.close_loop(Dart(1), &mut world).unwrap();
    assert_eq!(run.map().opposite(Dart(1)), Some(Dart(4)));
}

/// The fewest edges from each vertex to a root, by relaxing every edge until nothing changes.
fn hops(map: &PartialMap, root: Vertex) -> Vec<usize> {
    let mut hops = vec![usize::MAX; map.vertex_count()];
    hops[root.at()] = 0;
    for _ in map.vertices() {
        for dart in map.vertices().flat_map(|vertex| map.darts_of(vertex)) {
            if let Some(far) = map.opposite(dart) {
                let (near, far) = (map.vertex(dart).at(), map.vertex(far).at());
                hops[near] = hops[near].min(hops[far].saturating_add(1));
            }
        }
    }
    hops
}

/// The default choices as the design words them.
fn as_written(run: &mut Algorithm1Run) -> Option<MappingChoice> {
    let map = run.map();
    let root = if run.is_at_line_8() { START } else { map.vertex(run.robot()) };
    let hops = hops(map, root);
    let key = |dart: Dart| (hops[map.vertex(dart).at()], map.vertex(dart), map.index(dart));
    if run.is_at_line_8() {
        let places = 0..run.hypotheses.len();
        places.min_by_key(|&place| key(run.hypotheses[place])).map(MappingChoice::Hypothesis)
    } else {
        map.unexplored().min_by_key(|&dart| key(dart)).map(MappingChoice::Edge)
    }
}

proptest! {
    // paper: alg1.5, alg1.9
    #[test]
    fn the_default_choices_are_those_of_the_design(graph in any_graph(Class::Multigraph, 40)) {
        let story = |choose: fn(&mut Algorithm1Run) -> Option<MappingChoice>| {
            let mut story = Vec::new();
            let mut listen =
                |_: &mut GraphWorld, _: &MapWalk, event: MappingEvent| story.push(event);
            let mut world = GraphWorld::new(&graph, Dart(0));
            let mut run = Algorithm1Run::new(graph.dart_count());
            let world = &mut Observed::new(&mut world, &mut listen);
            explore_with(&mut run, world, |run| Ok(choose(run))).unwrap();
            story
        };
        prop_assert_eq!(story(|run| run.choose().unwrap()), story(as_written));
    }
}
