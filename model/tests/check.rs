//! The exhaustive check holds, and its numbers are pinned.

use std::sync::atomic::{AtomicUsize, Ordering};

use toposlam_model::{
    check::{
        Check, ChoicesLimit, DEFAULT_STATE_BUDGET, EveryWay, RunChoices, Shard, Tally,
        check_worlds, every_way,
    },
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Watch},
    mapping::{Algorithm1Run, MappingAlgorithm, explore},
    world::GraphWorld,
};

use crate::starts;

fn check(class: Class, edges: usize, choices: RunChoices) -> Tally {
    let tally = Check::new(class, edges, Shard::WHOLE).unwrap();
    let tally = tally.run(Algorithm1Run::default, choices, &());
    assert_eq!((tally.failure.as_ref(), tally.mapped), (None, tally.starts));
    tally
}

/// All runs of Algorithm 1 on the start of dart 0.
fn all_runs(graph: &EmbeddedGraph, budget: u64) -> EveryWay {
    every_way(Algorithm1Run::default(), graph, Dart(0), budget, &()).unwrap()
}

/// Starts: A000698. Moves: by the independent implementation in `tests/oracle` of the workspace.
// paper: marker.directional-sufficient, alg1.isomorphic, alg1.terminates, alg1.located, cost.bound
#[test]
fn every_start_with_up_to_six_edges_is_mapped_right() {
    for (edges, row) in [
        (1, (2, 2, 2, 1)),
        (2, (5, 10, 23, 3)),
        (3, (20, 74, 289, 10)),
        (4, (107, 706, 4182, 21)),
        (5, (870, 8162, 68_652, 36)),
        (6, (9436, 110_410, 1_257_094, 55)),
    ] {
        let tally = check(Class::Multigraph, edges, RunChoices::Default);
        assert_eq!((tally.worlds, tally.starts, tally.moves_total, tally.moves_max()), row);
    }
}

/// The states at line 4, summed over all starts, by an independent computation. No run takes fewer moves than there
/// are edges.
// paper: alg1.4, alg1.5, alg1.8, alg1.9, cost.lower-bound
#[test]
fn every_way_of_every_start_is_mapped_right() {
    for (edges, states) in [(1, 4), (2, 43), (3, 725), (4, 16_471)] {
        let all = RunChoices::All { budget: DEFAULT_STATE_BUDGET };
        let tally = check(Class::Multigraph, edges, all);
        assert_eq!(tally.states, states);
        assert_eq!(tally.extremes.map(|(least, _)| least), Some(edges as u64));
    }
}

#[test]
fn a_start_with_more_states_than_the_budget_is_given_up() {
    let graph = EmbeddedGraph::cycle(5);
    let all = all_runs(&graph, 1000);
    assert_eq!(all.limit, None);
    let some = all_runs(&graph, all.states - 1);
    assert_eq!(some.limit, Some(ChoicesLimit::States(all.states - 1)));
    assert!(some.states < all.states);
    // A long run without a choice. A chain of one edge: line 4, line 8 without a hypothesis, line 4 again.
    for (edges, budget, is_complete) in [(1000, 3000, true), (1, 3, true), (1, 2, false)] {
        let all = all_runs(&EmbeddedGraph::chain(edges), budget);
        assert_eq!(all.limit.is_none(), is_complete, "{edges} {budget}");
    }
    let tally =
        check_worlds(&[(graph, None)], Algorithm1Run::default, RunChoices::All { budget: 3 }, &());
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
    let check = Check::new(Class::Multigraph, 5, Shard::WHOLE).unwrap();
    let watch = AfterParts(AtomicUsize::new(0));
    let tally = MappingAlgorithm::Algorithm1.sweep(&check, RunChoices::Default, &watch);
    assert!(tally.interrupted && tally.worlds < 870);
    assert_eq!(tally.mapped, tally.starts);
}

#[test]
fn the_default_run_is_among_all_runs() {
    for graph in starts(Class::Multigraph, 4) {
        assert!(all_runs(&graph, DEFAULT_STATE_BUDGET).costs.contains(moves(&graph, Dart(0))));
    }
}

#[test]
fn the_shards_are_the_whole() {
    for class in Class::ALL {
        let of = |shard: &str| {
            let check = Check::new(class, 6, shard.parse().unwrap()).unwrap();
            check.run(Algorithm1Run::default, RunChoices::Default, &())
        };
        let whole = of("1/1");
        let mut shares = Tally::default();
        for shard in ["1/3", "2/3", "3/3"] {
            let share = of(shard);
            assert!(share.worlds < whole.worlds);
            shares.merge(share);
        }
        let counts = |tally: &Tally| Tally { worst: None, ..tally.clone() };
        assert_eq!((counts(&shares), shares.moves_max()), (counts(&whole), whole.moves_max()));
    }
    for wrong in ["3/2", "0/2", "1", "1/0", "a/b", "-1/2", "+1/2", ""] {
        assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
    }
}

fn moves(graph: &EmbeddedGraph, facing: Dart) -> u64 {
    let mut run = Algorithm1Run::new(graph.dart_count());
    explore(&mut run, &mut GraphWorld::new(graph, facing)).unwrap();
    run.moves()
}

// paper: cost.cycle, cost.chain
#[test]
fn a_cycle_costs_its_edges_from_every_start_and_a_chain_from_an_end() {
    for edges in 1..40 {
        let cycle = EmbeddedGraph::cycle(edges);
        assert!(edges < 3 || cycle.darts().all(|facing| moves(&cycle, facing) == edges as u64));
        let chain = EmbeddedGraph::chain(edges);
        assert_eq!(moves(&chain, Dart(0)), edges as u64);
        let ways = all_runs(&chain, DEFAULT_STATE_BUDGET);
        assert_eq!(ways.costs.iter().collect::<Vec<_>>(), [edges as u64]);
    }
}

#[test]
fn the_bound_is_the_stated_one() {
    let algorithm = MappingAlgorithm::Algorithm1;
    assert_eq!(algorithm.move_bound(6, 6), 6 * 6 + 2 * 36 * 5);
    assert_eq!(algorithm.move_bound(1, 1), 1);
}
