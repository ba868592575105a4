//! Smallest worlds against brute force over all small worlds.

use std::ops::ControlFlow;

use proptest::prelude::*;

use super::*;
use crate::{
    any_graph::any_graph,
    enumerate::{Each, EnumeratedGraph, Enumeration},
    folding::fold,
    isomorphism::code,
    marker::{Directional, NoMarker},
    percept::{Door, Percept, Sighting},
    trace::{
        Trace, TraceEventKind, poses,
        tests::{explored, lollipop, walked},
    },
    world::{GraphWorld, State, World},
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

/// Every start with this number of edges, with the marker along each of its darts, or without one.
fn for_each_place(
    class: Class,
    edges: usize,
    visit: &mut dyn FnMut(&EmbeddedGraph, Option<Dart>) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let all = Enumeration::new(Each::Start, class, edges).unwrap();
    let mut each = |found: EnumeratedGraph| {
        found
            .graph
            .darts()
            .map(Some)
            .chain([None])
            .try_for_each(|marker| visit(found.graph, marker))
    };
    all.for_each(&mut each)
}

/// The number of edges of the smallest world, by trying them all.
fn by_trying_all(trace: &Trace, class: Class, most: usize) -> Option<usize> {
    (1..=most).find(|&edges| {
        let mut visit = |graph: &EmbeddedGraph, marker| {
            if explains(graph, marker, trace) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        for_each_place(class, edges, &mut visit).is_break()
    })
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
    let mut world = GraphWorld::new(graph, facing);
    world = world.clone().at(State { pose: Dart(0), ..world.state() });
    let mut events = vec![TraceEventKind::Percept(world.sensed())];
    for &turn in turns {
        let door = Door(u32::from(turn) % world.sensed().degree);
        world.traverse(door).unwrap();
        events.extend([TraceEventKind::Door(door), TraceEventKind::Percept(world.sensed())]);
    }
    Trace::new(events).unwrap()
}

#[test]
fn a_ring_of_three_explains_a_walk_round_a_ring_of_four_without_a_marker() {
    let corner = TraceEventKind::Percept(Percept { degree: 2, sighting: Sighting::Nothing });
    let trace = Trace::new([corner, TraceEventKind::Door(Door(1))].repeat(4)).unwrap();
    for (class, edges) in [(Class::Multigraph, 1), (Class::Simple, 3)] {
        let SmallestWorld::World { graph, marker, limit: None } = smallest(&trace, class) else {
            panic!("{class}")
        };
        assert_eq!((graph.edge_count(), marker), (edges, None));
    }
}

/// Nothing but a vertex with four doors is known: two loops are a world, and without loops there are four
/// dead ends.
#[test]
fn open_doors_are_joined_as_far_as_the_class_allows() {
    let percept = Percept { degree: 4, sighting: Sighting::Pointing(Door::BACK) };
    let trace = Trace::new([TraceEventKind::Percept(percept)]).unwrap();
    for (class, edges) in [(Class::Multigraph, 2), (Class::Simple, 4), (Class::Planar, 4)] {
        let SmallestWorld::World { graph, limit: None, .. } = smallest(&trace, class) else {
            panic!("{class}")
        };
        assert_eq!(graph.edge_count(), edges, "{class}");
    }
    assert_eq!(smallest(&trace, Class::Corridor), SmallestWorld::NoWorld);
}

#[test]
fn a_world_with_a_loop_explains_no_walk_through_a_simple_world() {
    // A vertex with a loop at its marked dart, and a dead end.
    let graph = EmbeddedGraph::from_edge_lists(&[
        ("fork", vec!["loop", "loop", "way"]),
        ("end", vec!["way"]),
    ])
    .unwrap();
    let trace = walked(&graph, Dart(0), &[Door(0)]);
    assert!(matches!(smallest(&trace, Class::Multigraph), SmallestWorld::World { .. }));
    assert_eq!(smallest(&trace, Class::Simple), SmallestWorld::NoWorld);
}

#[test]
fn a_search_that_ends_early_has_a_world_and_names_its_limit() {
    let trace = explored(&lollipop(), Dart(0));
    let short = trace.up_to(6);
    let limited = |trace: &Trace, steps| {
        smallest_world(&folded(trace), WorldSearch { steps, ..search(Class::Multigraph) }, &())
    };
    let SmallestWorld::World { graph, marker, limit } = limited(&short, 0) else { panic!() };
    assert!(explains(&graph, marker, &short));
    assert_eq!(limit, Some(SearchLimit::Steps));
    // A complete trail is a world that needs no search.
    let SmallestWorld::World { graph, limit, .. } = limited(&trace, 0) else { panic!() };
    assert_eq!((graph.edge_count(), limit), (4, None));
}

#[test]
fn a_largest_number_of_edges_leaves_out_larger_worlds_only() {
    let trace = explored(&lollipop(), Dart(0));
    for trace in [trace.up_to(6), trace] {
        let SmallestWorld::World { graph, marker, limit: None } =
            smallest(&trace, Class::Multigraph)
        else {
            panic!()
        };
        let edges = graph.edge_count();
        let within = |edges| {
            let search = WorldSearch { max_edges: Some(edges), ..search(Class::Multigraph) };
            smallest_world(&folded(&trace), search, &())
        };
        assert_eq!(within(edges), SmallestWorld::World { graph, marker, limit: None });
        assert_eq!(within(edges - 1), SmallestWorld::NotFound { limit: SearchLimit::Edges });
    }
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

    #[test]
    fn a_walk_has_one_world_exactly_if_no_door_is_open(
        graph in any_graph(Class::Multigraph, 3),
        turns in prop::collection::vec(any::<u8>(), 0..14),
        marked in any::<prop::sample::Index>(),
        seen in any::<bool>(),
    ) {
        let facing = Dart(marked.index(graph.dart_count()) as u32);
        let mut trace = walk(&graph, facing, &turns);
        if !seen {
            trace = trace.without_marker();
        }
        let open = folded(&trace).open_count();
        // Dead ends, and a chain behind one of the open doors, are two worlds.
        let most = folded(&trace).closed().unwrap().graph.edge_count() + 1;
        prop_assume!(most <= 5);
        let mut worlds = HashSet::new();
        for edges in 1..=most {
            let _ = for_each_place(Class::Multigraph, edges, &mut |graph, marker| {
                if explains(graph, marker, &trace) {
                    worlds.insert((code(graph, Dart(0)), marker));
                }
                ControlFlow::Continue(())
            });
        }
        // A marker that was not seen is anywhere else, or nowhere.
        let markers: HashSet<_> = worlds.iter().map(|(_, marker)| *marker).collect();
        if open == 0 {
            prop_assert_eq!((worlds.len(), markers.len()), (1, 1));
        } else {
            let graphs: HashSet<_> = worlds.iter().map(|(graph, _)| graph.clone()).collect();
            prop_assert!(graphs.len() > 1);
        }
    }
}
