//! Smallest worlds against brute force over all small worlds.

use proptest::prelude::*;

use super::*;
use crate::{
    any_graph::{any_graph, starts},
    folding::fold,
    isomorphism::code,
    marker::{Directional, NoMarker},
    percept::{Door, Percept, Sighting},
    trace::{
        Trace, TraceEventKind, poses,
        tests::{explored, recorded},
    },
    world::{GraphWorld, State},
};

fn search(class: Class) -> WorldSearch {
    WorldSearch { class, max_edges: None, steps: 10_000_000 }
}

fn folded(trace: &Trace) -> FoldedTrail {
    fold(trace.percepts(), trace.doors()).unwrap()
}

fn smallest(trace: &Trace, class: Class) -> SmallestWorld {
    smallest_world(&folded(trace), search(class), &())
}

/// The number of edges of the smallest world, by trying them all.
fn by_trying_all(trace: &Trace, class: Class, most: usize) -> Option<usize> {
    let is_explained = |graph: &EmbeddedGraph| {
        graph.darts().map(Some).chain([None]).any(|marker| explains(graph, marker, trace))
    };
    (1..=most).find(|&edges| starts(class, edges).iter().any(is_explained))
}

/// Whether a world explains a trace of a robot that starts with dart 0 behind it.
fn explains(graph: &EmbeddedGraph, marker: Option<Dart>, trace: &Trace) -> bool {
    let state = State { pose: Dart(0), placed: Some(marker.unwrap_or(Dart(0))) };
    match marker {
        Some(_) => poses(graph, &Directional, &[state], trace).misfit.is_none(),
        None => poses(graph, &NoMarker, &[state], trace).misfit.is_none(),
    }
}

/// A walk from dart 0 in a world with the marker along a dart.
fn walk(graph: &EmbeddedGraph, facing: Dart, turns: &[u8]) -> Trace {
    let world = GraphWorld::new(graph, facing);
    let world = world.clone().at(State { pose: Dart(0), ..world.state() });
    recorded(world, turns.iter().copied().map(u32::from))
}

#[test]
fn a_long_walk_without_a_marker_does_not_exhaust_the_stack() {
    let plain = |degree| Percept { degree, sighting: Sighting::Nothing };
    // Degrees that no small world has in this order.
    let degree = |moves: u32| 2 + (moves * moves / 7) % 3;
    let events = (0..5_000).flat_map(|moves| {
        [TraceEventKind::Percept(plain(degree(moves))), TraceEventKind::Door(Door(1))]
    });
    let trace = Trace::new(events).unwrap();
    let search = WorldSearch { steps: WorldSearch::STEPS, ..search(Class::Multigraph) };
    let SmallestWorld::World { graph, marker, .. } = smallest_world(&folded(&trace), search, &())
    else {
        panic!()
    };
    assert!(explains(&graph, marker, &trace));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_run_of_algorithm_1_is_explained_by_its_own_world_alone(
        graph in any_graph(Class::Multigraph, 10),
    ) {
        let trace = explored(&graph, Dart(0));
        prop_assert_eq!(folded(&trace).open_count(), 0);
        let found = smallest(&trace, Class::Multigraph);
        let SmallestWorld::World { graph: found, marker, limit: None } = found else {
            panic!("{found:?}")
        };
        prop_assert_eq!(marker, Some(Dart(0)));
        prop_assert_eq!(code(&found, Dart(0)), code(&graph, Dart(0)));
    }

    #[test]
    fn the_smallest_world_of_a_walk_is_as_small_as_trying_all_finds(
        graph in prop_oneof![any_graph(Class::Simple, 5), any_graph(Class::Multigraph, 5)],
        turns in prop::collection::vec(any::<u8>(), 0..12),
        class in prop::sample::select(Class::ALL.to_vec()),
        marked in any::<prop::sample::Index>(),
    ) {
        let facing = Dart(marked.index(graph.dart_count()) as u32);
        let trace = walk(&graph, facing, &turns);
        let edges = match smallest(&trace, class) {
            SmallestWorld::World { graph, marker, limit: None } => {
                prop_assert!(explains(&graph, marker, &trace));
                prop_assert!(class.contains(&graph));
                Some(graph.edge_count())
            }
            SmallestWorld::NoWorld => None,
            // There may be a smaller one, so this case says nothing, and another one takes its place.
            SmallestWorld::World { graph, marker, limit: Some(SearchLimit::Steps) } => {
                prop_assert!(explains(&graph, marker, &trace) && class.contains(&graph));
                return Err(TestCaseError::reject("the search reached its limit of steps"));
            }
            other => panic!("{other:?}"),
        };
        let most = if class == Class::Multigraph { 5 } else { 6 };
        prop_assert_eq!(edges.filter(|&edges| edges <= most), by_trying_all(&trace, class, most));
    }
}
