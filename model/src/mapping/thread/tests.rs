//! The judge finds each flaw of mapping with a string on a small start, and the string is never longer than n edges.

use super::*;
use crate::{
    any_graph::{Class, starts},
    check::smallest_failure::{injected_failure, new},
    mapping::explore,
    world::GraphWorld,
};

#[test]
fn the_judge_finds_each_flaw_on_a_small_start() {
    let two_moves = "after 2 moves: no more than 2 moves are allowed";
    let not_there = "after 3 moves: there is no marker here that could be picked up";
    for (flaw, failure) in [
        (None, None),
        (Some(InjectedFlaw::EveryPlaceIsNew), Some((1, vec![new(2), 1], two_moves.to_owned()))),
        (
            Some(InjectedFlaw::OneHypothesisExamined),
            Some((4, vec![new(2), new(3), 4, new(3), 7], not_there.to_owned())),
        ),
    ] {
        let found = injected_failure(flaw, ThreadRun::default(), Class::Multigraph, 4);
        assert_eq!(found, failure, "{flaw:?}");
    }
}

#[test]
fn the_string_is_never_longer_than_n_edges() {
    for graph in (1..=4).flat_map(|edges| starts(Class::Multigraph, edges)) {
        let mut run = ThreadRun::default();
        let mut world = GraphWorld::with_aid(&graph, run.aid(), Dart(0));
        explore(&mut run, &mut world).unwrap();
        assert!(run.longest_way() <= graph.vertex_count());
    }
}
