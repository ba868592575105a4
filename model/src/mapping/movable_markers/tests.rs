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
    for (flaw, edges, code, failure) in [
        (InjectedFlaw::EveryPlaceIsNew, 3, cycle(3), String::new()),
        (InjectedFlaw::OneCandidateSearched, 0, vec![], String::new()),
        (InjectedFlaw::LeftBehind, 0, vec![], String::new()),
        (InjectedFlaw::MarkerLeftBehind, 0, vec![], String::new()),
        (InjectedFlaw::FirstDartIsIt, 0, vec![], String::new()),
        (InjectedFlaw::NotCarried, 0, vec![], String::new()),
        (InjectedFlaw::RejectedIsConfirmed, 0, vec![], String::new()),
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
