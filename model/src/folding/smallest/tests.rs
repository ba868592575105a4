//! Smallest worlds against brute force over all small worlds.

use proptest::prelude::*;

use super::*;
use crate::{
    aid::State,
    any_graph::{any_graph, starts},
    folding::fold,
    isomorphism::code,
    marker::{Directional, NoMarker},
    percept::{Door, Percept, Sighting},
    trace::{
        Trace, TraceEventKind, poses,
        tests::{explored, lollipop, recorded, walked},
    },
    world::GraphWorld,
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
fn places(class: Class, edges: usize) -> impl Iterator<Item = (EmbeddedGraph, Option<Dart>)> {
    starts(class, edges).into_iter().flat_map(|graph| {
        let markers: Vec<_> = graph.darts().map(Some).chain([None]).collect();
        markers.into_iter().map(move |marker| (graph.clone(), marker))
    })
}

/// The number of edges of the smallest world, by trying them all.
fn by_trying_all(trace: &Trace, class: Class, most: usize) -> Option<usize> {
    (1..=most)
        .find(|&edges| places(class, edges).any(|(graph, marker)| explains(&graph, marker, trace)))
}

/// Whether a world explains a trace of a robot that starts with dart 0 behind it.
fn explains(graph: &EmbeddedGraph, marker: Option<Dart>, trace: &Trace) -> bool {
    let state = State { pose: Dart(0), placed: marker.unwrap_or(Dart(0)) };
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
fn the_smallest_world_depends_on_the_class() {
    use Class::{Corridor, Multigraph, Planar, Simple};
    let percept = |degree, sighting| TraceEventKind::Percept(Percept { degree, sighting });
    // A walk round a ring of four, without a marker.
    let corner = percept(2, Sighting::Nothing);
    let ring = Trace::new([corner, TraceEventKind::Door(Door(1))].repeat(4)).unwrap();
    // Nothing but a vertex with four doors is known: two loops are a world, and without loops there are four
    // dead ends.
    let crossing = Trace::new([percept(4, Sighting::Pointing(Door::BACK))]).unwrap();
    // A vertex with a loop at its marked dart, and a dead end.
    let lists = [("fork", vec!["loop", "loop", "way"]), ("end", vec!["way"])];
    let looped = walked(&EmbeddedGraph::from_edge_lists(&lists).unwrap(), Dart(0), &[Door(0)]);
    for (trace, classes) in [
        (ring, &[(Multigraph, Some(1)), (Simple, Some(3))][..]),
        (
            crossing,
            &[(Multigraph, Some(2)), (Simple, Some(4)), (Planar, Some(4)), (Corridor, None)],
        ),
        (looped, &[(Multigraph, Some(2)), (Simple, None)]),
    ] {
        for &(class, edges) in classes {
            let found = match smallest(&trace, class) {
                SmallestWorld::World { graph, limit: None, .. } => Some(graph.edge_count()),
                SmallestWorld::NoWorld => None,
                other => panic!("{class}: {other:?}"),
            };
            assert_eq!(found, edges, "{class}");
        }
    }
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
            let found = places(Class::Multigraph, edges);
            let found = found.filter(|(graph, marker)| explains(graph, *marker, &trace));
            worlds.extend(found.map(|(graph, marker)| (code(&graph, Dart(0)), marker)));
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
