//! The enumeration against published counts (OEIS), by number of edges 1, 2, 3, ...

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{collections::HashSet, ops::ControlFlow};

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, EnumeratedGraph, Enumeration, SizeError},
    isomorphism::{canonical, code},
};

fn for_each(each: Each, class: Class, edges: usize, mut visit: impl FnMut(EnumeratedGraph)) {
    let _ = Enumeration::new(each, class, edges).unwrap().for_each(&mut |found| {
        visit(found);
        ControlFlow::Continue(())
    });
}

fn count(
    each: Each,
    class: Class,
    up_to: usize,
    among: impl Fn(&EmbeddedGraph) -> bool,
) -> Vec<u64> {
    (1..=up_to)
        .map(|edges| {
            let mut count = 0;
            for_each(each, class, edges, |found| count += u64::from(among(found.graph)));
            count
        })
        .collect()
}

fn all(_: &EmbeddedGraph) -> bool {
    true
}

fn plane(graph: &EmbeddedGraph) -> bool {
    graph.genus() == 0
}

/// A000698: rooted maps of any genus.
#[test]
fn starts() {
    let counts = count(Each::Start, Class::Multigraph, 7, all);
    assert_eq!(counts, [2, 10, 74, 706, 8162, 110_410, 1_708_394]);
}

/// A170946: sensed maps of any genus.
#[test]
fn worlds() {
    let counts = count(Each::World, Class::Multigraph, 8, all);
    assert_eq!(counts, [2, 5, 20, 107, 870, 9436, 122_840, 1_863_359]);
}

/// A214816: maps of any genus, mirror images counted once.
#[test]
fn worlds_up_to_mirror_images() {
    let counts: Vec<_> = (1..=6)
        .map(|edges| {
            let mut least = HashSet::new();
            for_each(Each::World, Class::Multigraph, edges, |found| {
                let (code, mirror) =
                    (canonical(found.graph).code, canonical(&found.graph.mirror_image()).code);
                least.insert(code.min(mirror));
            });
            least.len()
        })
        .collect();
    assert_eq!(counts, [2, 5, 20, 96, 644, 5839]);
}

/// A000168: rooted maps in the plane.
#[test]
fn starts_in_the_plane() {
    let counts = count(Each::Start, Class::Multigraph, 6, plane);
    assert_eq!(counts, [2, 9, 54, 378, 2916, 24_057]);
}

/// A006384: sensed maps in the plane.
#[test]
fn worlds_in_the_plane() {
    let counts = count(Each::World, Class::Multigraph, 6, plane);
    assert_eq!(counts, [2, 4, 14, 57, 312, 2071]);
}

/// A006394: simple sensed maps in the plane.
#[test]
fn simple_worlds_in_the_plane() {
    let counts = count(Each::World, Class::Planar, 7, all);
    assert_eq!(counts, [1, 1, 3, 5, 15, 52, 213]);
}

/// A069840: the embeddings of the wheel with 4 spokes, which is the one simple graph with 8 edges
/// and these degrees.
#[test]
fn embeddings_of_the_wheel() {
    let mut by_genus = [0; 3];
    for_each(Each::World, Class::Simple, 8, |EnumeratedGraph { graph, .. }| {
        let mut degrees: Vec<_> = graph.vertices().map(|vertex| graph.degree(vertex)).collect();
        degrees.sort_unstable();
        if degrees == [3, 3, 3, 3, 4] {
            by_genus[graph.genus()] += 1;
        }
    });
    assert_eq!(by_genus, [1, 10, 5]);
}

/// The classes prune while they generate; what they leave is what a filter would leave.
#[test]
fn the_classes_are_what_a_filter_would_leave() {
    for class in Class::ALL {
        let belongs = |graph: &EmbeddedGraph| match class {
            Class::Multigraph => true,
            Class::Simple => graph.is_simple(),
            Class::Corridor => {
                graph.is_simple() && graph.vertices().all(|vertex| graph.degree(vertex) <= 3)
            }
            Class::Planar => graph.is_simple() && graph.genus() == 0,
        };
        for edges in 1..=6 {
            for each in [Each::Start, Each::World] {
                let mut pruned = HashSet::new();
                for_each(each, class, edges, |found| {
                    assert!(pruned.insert(code(found.graph, Dart(0))));
                });
                let mut filtered = HashSet::new();
                for_each(each, Class::Multigraph, edges, |found| {
                    if belongs(found.graph) {
                        filtered.insert(code(found.graph, Dart(0)));
                    }
                });
                assert_eq!(pruned, filtered, "{class} {edges} {each:?}");
            }
        }
    }
}

/// A world with `a` automorphisms has `2m / a` starts.
#[test]
fn the_worlds_account_for_all_starts() {
    for class in Class::ALL {
        for edges in 1..=6 {
            let mut starts = 0;
            for_each(Each::World, class, edges, |found| {
                starts += found.graph.dart_count() as u64 / u64::from(found.automorphisms);
            });
            assert_eq!(starts, count(Each::Start, class, edges, all)[edges - 1]);
        }
    }
}

#[test]
fn a_world_is_shown_at_its_least_start_with_its_automorphisms() {
    for class in Class::ALL {
        for edges in 1..=6 {
            for_each(Each::World, class, edges, |found| {
                let form = canonical(found.graph);
                assert_eq!(form.code, code(found.graph, Dart(0)));
                assert_eq!(form.automorphisms, found.automorphisms as usize);
            });
        }
    }
}

#[test]
fn the_parts_are_the_whole_in_order() {
    for class in Class::ALL {
        let enumeration = Enumeration::new(Each::World, class, 6).unwrap();
        let mut whole = Vec::new();
        for_each(Each::World, class, 6, |found| whole.push(found.graph.clone()));
        let mut joined = Vec::new();
        for part in enumeration.parts() {
            let _ = part.for_each(&mut |found| {
                joined.push(found.graph.clone());
                ControlFlow::Continue(())
            });
        }
        assert_eq!(joined, whole);
    }
}

#[test]
fn sizes_without_worlds_are_refused() {
    let error = |edges| Enumeration::new(Each::World, Class::Simple, edges).unwrap_err();
    assert_eq!(error(0), SizeError::NoEdge);
    assert_eq!(error(33), SizeError::TooManyEdges(33));
}
