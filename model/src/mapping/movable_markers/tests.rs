//! The check fails on broken variants of the movable marker algorithm, each on its smallest start; steps out of order
//! are errors.

use super::*;
use crate::{
    any_graph::Class,
    check::smallest_failure::{injected_failure, new},
    embedded_graph::EmbeddedGraph,
    world::GraphWorld,
};

// paper: movable.place, movable.new, movable.known, movable.back-link
#[test]
fn every_broken_variant_is_caught_on_a_small_start() {
    let cycle = |edges: u32| [vec![new(2); edges as usize], vec![2 * edges - 1]].concat();
    let kite = || vec![new(3), new(2), new(1), new(2), 7];
    let too_many =
        |moves: u32| format!("after {moves} moves: no more than {moves} moves are allowed");
    let no_marker = "after 12 moves: there is no marker here that could be picked up";
    let left_there = "after 7 moves: the world contradicts itself: the robot carries the marker, but behind the \
                      unexplored dart 1 of vertex v3 there is degree 2 with a marker lying there";
    let seen = |vertex: u32, degree: u32, moves: u32| {
        format!(
            "after {moves} moves: the world contradicts itself: at the known vertex v{vertex}, entered by its \
             dart 1: expected degree {degree} without the marker, found degree {degree} with a marker lying there"
        )
    };
    for (flaw, edges, code, failure) in [
        (InjectedFlaw::EveryPlaceIsNew, 3, cycle(3), too_many(20)),
        (
            InjectedFlaw::OneCandidateSearched,
            6,
            vec![new(3), new(3), new(3), new(3), 7, 10, 11],
            too_many(69),
        ),
        (InjectedFlaw::LeftBehind, 4, cycle(4), left_there.to_owned()),
        (InjectedFlaw::MarkerLeftBehind, 4, cycle(4), seen(3, 2, 11)),
        (InjectedFlaw::FirstDartIsIt, 4, kite(), too_many(35)),
        (InjectedFlaw::NotCarried, 4, vec![new(3), new(2), new(2), new(1), 6], seen(0, 3, 8)),
        (InjectedFlaw::RejectedIsConfirmed, 4, kite(), no_marker.to_owned()),
    ] {
        let found = injected_failure(Some(flaw), MovableMarkerRun::default(), Class::Simple, 6);
        assert_eq!(found, Some((edges, code, failure)), "{flaw:?}");
    }
}

/// A step out of order is an error and changes nothing. Nothing is left of an earlier run.
#[test]
fn a_step_out_of_order_is_an_error() {
    let error = |step| Err(MappingError::InvalidStep(step));
    let graph = EmbeddedGraph::chain(2);
    let mut world = GraphWorld::with_aid(&graph, AidKind::Markers(MOVABLE), Dart(1));
    let mut run = MovableMarkerRun::new(4);
    assert_eq!((run.choose().unwrap(), run.next_candidate()), (None, None));
    let unexplored = InvalidStep::NotUnexplored(Dart(0));
    assert_eq!(run.step(Dart(0), &mut world), error(unexplored));
    assert_eq!(run.go_back(&mut world), error(InvalidStep::NoEdge));
    assert_eq!((run.moves(), run.map().dart_count()), (0, 0));
    run.begin(&mut world).unwrap();
    run.step(Dart(1), &mut world).unwrap();
    assert_eq!(run.step(Dart(1), &mut world), error(InvalidStep::NotUnexplored(Dart(1))));
    assert_eq!((run.moves(), run.map().dart_count(), run.robot()), (1, 3, Dart(2)));
    // A start that is refused leaves nothing of the run before.
    run.begin(&mut world).unwrap_err();
    assert_eq!((run.robot(), run.moves(), run.map().dart_count()), (Dart(0), 0, 0));
}
