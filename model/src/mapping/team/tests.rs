//! The judge finds each flaw of mapping with scouts on a small start, and no robot makes more than one move in a round.

use super::*;
use crate::{
    any_graph::{Class, starts},
    check::smallest_failure::{injected_failure, new},
    mapping::explore,
    world::GraphWorld,
};

#[test]
fn the_judge_finds_each_flaw_on_a_small_start() {
    let (heading, round) = (Team::of(2, true), Team::of(2, false));
    let no_other_dart = "after 3 moves: the world contradicts itself: no vertex looks like this: degree 1 with robot 2 \
                         here along door 0";
    let not_there = "after 5 moves: the world contradicts itself: at the known vertex v2, entered by its dart 1: \
                     expected degree 2 with robot 2 here, found degree 1 with robot 2 elsewhere at 2 doors";
    for (flaw, team, class, failure) in [
        (None, heading, Class::Multigraph, None),
        (
            Some(InjectedFlaw::EveryPlaceIsNew),
            heading,
            Class::Multigraph,
            Some((2, vec![new(1), new(3), 3], no_other_dart.to_owned())),
        ),
        (
            Some(InjectedFlaw::OneCandidateSearched),
            heading,
            Class::Multigraph,
            Some((2, vec![new(1), new(3), 3], no_other_dart.to_owned())),
        ),
        (None, round, Class::Simple, None),
        (
            Some(InjectedFlaw::FirstDartIsIt),
            round,
            Class::Simple,
            Some((4, vec![new(3), new(2), new(1), new(2), 7], not_there.to_owned())),
        ),
    ] {
        let found = injected_failure(flaw, TeamRun::with(team), class, 5);
        assert_eq!(found, failure, "{flaw:?}");
    }
}

/// Every move is made by some robot in some round: the rounds are at most the moves, and at least those of one of so
/// many robots.
#[test]
fn rounds_are_fewer_than_moves_and_not_too_few() {
    for robots in [2, 3] {
        for graph in (1..=4).flat_map(|edges| starts(Class::Multigraph, edges)) {
            let mut run = TeamRun::with(Team::of(robots, true));
            let mut world = GraphWorld::with_aid(&graph, run.aid(), Dart(0));
            explore(&mut run, &mut world).unwrap();
            assert_eq!(run.moves(), world.moves());
            assert!(run.rounds() <= run.moves());
            assert!(run.rounds() * u64::from(robots) >= run.moves());
        }
    }
}
