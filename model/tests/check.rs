//! The exhaustive check holds, its numbers are pinned, and it fails on broken variants of
//! Algorithm 1.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use std::sync::atomic::{AtomicUsize, Ordering};

use toposlam_model::{
    check::{
        Check, ChoicesLimit, DEFAULT_STATE_BUDGET, RunChoices, Shard, Tally, check_worlds,
        every_way,
    },
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, Enumeration, Watch},
    mapping::{
        Algorithm1Run, Explorer, Flaw, InvalidStep, MapWalk, MappingAlgorithm, MappingChoice,
        MappingError, Observer, StateKey, explore,
    },
    marker::MarkerKind,
    world::{GraphWorld, World},
};

const ALL_CHOICES: RunChoices = RunChoices::All { budget: DEFAULT_STATE_BUDGET };

fn shards(class: Class, edges: usize) -> Check {
    Check::new(class, edges, Shard::WHOLE).unwrap()
}

fn sweep(class: Class, edges: usize, choices: RunChoices) -> Tally {
    shards(class, edges).run(Algorithm1Run::default, choices, &())
}

/// Starts: A000698. Moves: by the independent implementation in `tests/oracle` of the workspace.
// paper: marker.directional-sufficient, alg1.isomorphic, alg1.terminates, alg1.located, cost.bound
#[test]
fn every_start_with_up_to_six_edges_is_mapped_right() {
    let rows: Vec<_> = (1..=6)
        .map(|edges| {
            let tally = sweep(Class::Multigraph, edges, RunChoices::Default);
            assert_eq!(tally.failure, None);
            assert_eq!(tally.mapped, tally.starts);
            (tally.worlds, tally.starts, tally.moves_total, tally.moves_max())
        })
        .collect();
    assert_eq!(
        rows,
        [
            (2, 2, 2, 1),
            (5, 10, 23, 3),
            (20, 74, 289, 10),
            (107, 706, 4182, 21),
            (870, 8162, 68_652, 36),
            (9436, 110_410, 1_257_094, 55),
        ]
    );
}

/// The states at line 4, summed over all starts, by an independent computation.
// paper: alg1.4, alg1.5, alg1.8, alg1.9
#[test]
fn every_way_of_every_start_is_mapped_right() {
    let states: Vec<_> = (1..=4)
        .map(|edges| {
            let tally = sweep(Class::Multigraph, edges, ALL_CHOICES);
            assert_eq!(tally.failure, None);
            tally.states
        })
        .collect();
    assert_eq!(states, [4, 43, 725, 16_471]);
}

#[test]
fn a_start_with_more_states_than_the_budget_is_given_up() {
    let graph = EmbeddedGraph::cycle(5);
    let all = every_way(Algorithm1Run::default(), &graph, Dart(0), 1000, &()).unwrap();
    assert_eq!(all.limit, None);
    let some = every_way(Algorithm1Run::default(), &graph, Dart(0), all.states - 1, &()).unwrap();
    assert_eq!(some.limit, Some(ChoicesLimit::States(all.states - 1)));
    assert!(some.states < all.states);
    let is_complete = |edges, budget| {
        every_way(Algorithm1Run::default(), &EmbeddedGraph::chain(edges), Dart(0), budget, &())
            .unwrap()
            .limit
            .is_none()
    };
    // A long run without a choice.
    assert!(is_complete(1000, 3000));
    // A chain of one edge: line 4, line 8 without a hypothesis, line 4 again.
    assert!(is_complete(1, 3));
    assert!(!is_complete(1, 2));
    let tally = check_worlds(&[graph], Algorithm1Run::default, RunChoices::All { budget: 3 }, &());
    assert_eq!((tally.starts, tally.mapped, tally.over_budget), (1, 1, 1));
}

/// Asked to stop, a check says that it did not finish, and does no more.
#[test]
fn an_interrupted_check_says_so() {
    struct AfterParts(AtomicUsize);
    impl Watch for AfterParts {
        fn part_done(&self, _: u64) {
            self.0.fetch_add(1, Ordering::Relaxed);
        }
        fn stop(&self) -> bool {
            self.0.load(Ordering::Relaxed) > 2
        }
    }
    let sweep = Check::new(Class::Multigraph, 5, Shard::WHOLE).unwrap();
    let tally = MappingAlgorithm::Algorithm1.sweep(
        &sweep,
        RunChoices::Default,
        &AfterParts(AtomicUsize::new(0)),
    );
    assert!(tally.interrupted);
    assert!(tally.worlds < 870);
    assert_eq!(tally.mapped, tally.starts);
}

#[test]
fn the_default_run_is_among_all_runs() {
    let enumeration = Enumeration::new(Each::Start, Class::Multigraph, 4).unwrap();
    let mut starts = 0;
    let _ = enumeration.for_each(&mut |found| {
        let mut exploration = Algorithm1Run::new(8);
        let mut world = GraphWorld::new(found.graph, Dart(0));
        explore(&mut exploration, &mut world, &mut ()).unwrap();
        let ways =
            every_way(Algorithm1Run::default(), found.graph, Dart(0), DEFAULT_STATE_BUDGET, &())
                .unwrap();
        assert!(ways.costs.contains(exploration.moves()));
        starts += 1;
        std::ops::ControlFlow::Continue(())
    });
    assert_eq!(starts, 706);
}

#[test]
fn the_shards_are_the_whole() {
    for class in Class::ALL {
        let of = |shard: &str| {
            let sweep = Check::new(class, 6, shard.parse().unwrap());
            sweep.unwrap().run(Algorithm1Run::default, RunChoices::Default, &())
        };
        let whole = of("1/1");
        let mut shares = Tally::default();
        for shard in ["1/3", "2/3", "3/3"] {
            let share = of(shard);
            assert!(share.worlds < whole.worlds);
            shares.merge(share);
        }
        assert_eq!(
            (shares.worlds, shares.starts, shares.mapped, shares.moves_total, shares.moves_max()),
            (whole.worlds, whole.starts, whole.mapped, whole.moves_total, whole.moves_max())
        );
    }
    for wrong in ["3/2", "0/2", "1", "1/0", "a/b", "-1/2", "+1/2", ""] {
        assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
    }
}

fn moves(graph: &EmbeddedGraph, facing: Dart) -> u64 {
    let mut exploration = Algorithm1Run::new(graph.dart_count());
    let mut world = GraphWorld::new(graph, facing);
    explore(&mut exploration, &mut world, &mut ()).unwrap();
    exploration.moves()
}

// paper: cost.cycle
#[test]
fn a_cycle_of_m_edges_costs_m_from_every_start() {
    for edges in 3..40 {
        let graph = EmbeddedGraph::cycle(edges);
        assert!(graph.darts().all(|facing| moves(&graph, facing) == edges as u64));
    }
}

// paper: cost.chain
#[test]
fn a_chain_of_m_edges_costs_m_from_an_end() {
    for edges in 1..40 {
        let graph = EmbeddedGraph::chain(edges);
        assert_eq!(moves(&graph, Dart(0)), edges as u64);
        let ways = every_way(Algorithm1Run::default(), &graph, Dart(0), DEFAULT_STATE_BUDGET, &())
            .unwrap();
        assert_eq!(ways.costs.iter().collect::<Vec<_>>(), [edges as u64]);
    }
}

// paper: cost.lower-bound
#[test]
fn no_run_takes_fewer_moves_than_there_are_edges() {
    for edges in 1..=4 {
        let tally = sweep(Class::Multigraph, edges, ALL_CHOICES);
        assert_eq!(tally.extremes.map(|(least, _)| least), Some(edges as u64));
    }
}

/// Algorithm 1 with something altered.
#[derive(Clone)]
struct Altered {
    altered: Alteration,
    run: Algorithm1Run,
}

impl Altered {
    fn new(altered: Alteration) -> Self {
        Self { altered, run: Algorithm1Run::default() }
    }
}

#[derive(Clone, Copy)]
enum Alteration {
    /// It claims to need no more moves than these.
    Claimed(u64),
    /// The choices that it is given are off by one.
    OffByOne,
}

impl Explorer for Altered {
    delegate_to_run!(MappingChoice);

    /// The numbers of hypotheses are off by one, if that is altered.
    fn choices(&mut self) -> Result<Vec<MappingChoice>, InvalidStep> {
        let by = usize::from(matches!(self.altered, Alteration::OffByOne));
        let choices = self.run.choices()?.into_iter().map(|choice| match choice {
            MappingChoice::Hypothesis(index) => MappingChoice::Hypothesis(index + by),
            edge @ MappingChoice::Edge(_) => edge,
        });
        Ok(choices.collect())
    }

    fn step<W: World>(
        &mut self,
        choice: MappingChoice,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        self.run.step(choice, world, observer)
    }

    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        match self.altered {
            Alteration::Claimed(moves) => moves,
            Alteration::OffByOne => self.run.move_bound(edges, vertices),
        }
    }
}

/// Choices that are not open are an error. They are not replaced by others, with less coverage.
#[test]
fn a_broken_enumeration_of_choices_fails() {
    let new = || Altered::new(Alteration::OffByOne);
    let tally = shards(Class::Multigraph, 3).run(new, ALL_CHOICES, &());
    let flaw = tally.failure.unwrap().flaw;
    let invalid = InvalidStep::NoHypothesis { index: 1, left: 1 };
    assert_eq!(flaw, Flaw::Error(MappingError::InvalidStep(invalid)));
    assert_eq!(flaw.to_string(), "invalid step: hypothesis 1 does not exist, 1 left");
}

/// States are explored once, so the dearest run may be none that was followed to its end.
#[test]
fn the_dearest_of_all_runs_is_held_against_the_bound() {
    for edges in 1..=3 {
        let enumeration = Enumeration::new(Each::Start, Class::Multigraph, edges).unwrap();
        let _ = enumeration.for_each(&mut |found| {
            let with_bound = |bound| {
                let claimed = Altered::new(Alteration::Claimed(bound));
                every_way(claimed, found.graph, Dart(0), DEFAULT_STATE_BUDGET, &())
            };
            let moves = with_bound(u64::MAX).unwrap().costs.max().unwrap();
            assert!(with_bound(moves).is_ok());
            let bound = moves - 1;
            let flaw = with_bound(bound).unwrap_err();
            assert!(matches!(flaw, Flaw::TooManyMoves { bound: b, .. } if b == bound));
            std::ops::ControlFlow::Continue(())
        });
    }
}

#[test]
fn the_bound_is_the_stated_one() {
    let algorithm = MappingAlgorithm::Algorithm1;
    assert_eq!(algorithm.move_bound(6, 6), 6 * 6 + 2 * 36 * 5);
    assert_eq!(algorithm.move_bound(1, 1), 1);
}
