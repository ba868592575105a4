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
    for (flaw, team, class, failure) in [
        (None, Team::of(2, true), Class::Multigraph, None),
        (
            Some(InjectedFlaw::EveryPlaceIsNew),
            Team::of(2, true),
            Class::Multigraph,
            Some((1, vec![new(2), 1], String::new())),
        ),
        (Some(InjectedFlaw::OneCandidateSearched), Team::of(2, true), Class::Multigraph, None),
        (Some(InjectedFlaw::FirstDartIsIt), Team::of(2, false), Class::Simple, None),
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
