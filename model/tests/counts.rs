//! The enumeration against published counts (OEIS), by number of edges 1, 2, 3, ...

use std::{collections::HashSet, ops::ControlFlow};

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, EnumeratedGraph, Enumeration, SearchEnd, SizeError},
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

fn plane(graph: &EmbeddedGraph) -> bool {
    graph.genus() == 0
}

#[test]
fn counts_are_those_of_the_encyclopedia_of_integer_sequences() {
    type Filter = fn(&EmbeddedGraph) -> bool;
    let all: Filter = |_| true;
    let cases: [(_, _, _, Filter, &[u64]); 5] = [
        // Rooted maps of any genus.
        (
            "A000698",
            Each::Start,
            Class::Multigraph,
            all,
            &[2, 10, 74, 706, 8162, 110_410, 1_708_394],
        ),
        // Sensed maps of any genus.
        (
            "A170946",
            Each::World,
            Class::Multigraph,
            all,
            &[2, 5, 20, 107, 870, 9436, 122_840, 1_863_359],
        ),
        // Rooted maps in the plane.
        ("A000168", Each::Start, Class::Multigraph, plane, &[2, 9, 54, 378, 2916, 24_057]),
        // Sensed maps in the plane.
        ("A006384", Each::World, Class::Multigraph, plane, &[2, 4, 14, 57, 312, 2071]),
        // Simple sensed maps in the plane.
        ("A006394", Each::World, Class::Planar, all, &[1, 1, 3, 5, 15, 52, 213]),
    ];
    for (sequence, each, class, among, counts) in cases {
        assert_eq!(count(each, class, counts.len(), among), counts, "{sequence}");
    }
}

#[test]
fn graphs_are_made_one_after_the_other_in_the_order_of_the_visits() {
    for class in Class::ALL {
        for each in [Each::Start, Each::World] {
            let mut visited = Vec::new();
            for_each(each, class, 4, |found| visited.push(found.graph.clone()));
            let mut graphs = Enumeration::new(each, class, 4).unwrap().graphs();
            assert_eq!(graphs.by_ref().collect::<Vec<_>>(), visited);
            assert_eq!(graphs.next(), None);
        }
    }
}

/// With 32 edges, the most, there are more than 10^40 starts.
#[test]
fn the_first_graphs_of_many_are_found_in_a_few_steps_and_a_search_can_go_on() {
    let mut graphs = Enumeration::new(Each::Start, Class::Multigraph, 32).unwrap().graphs();
    let mut found = Vec::new();
    let mut paused = 0;
    while found.len() < 100 {
        match graphs.search(10) {
            SearchEnd::Found => found.push(graphs.graph().clone()),
            SearchEnd::Paused => paused += 1,
            SearchEnd::Finished => unreachable!("there are more"),
        }
    }
    assert!((1..100).contains(&paused), "{paused}");
    let at_once = Enumeration::new(Each::Start, Class::Multigraph, 32).unwrap().graphs().take(100);
    assert!(at_once.eq(found));
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
        for edges in 1..=6 {
            for each in [Each::Start, Each::World] {
                let mut pruned = HashSet::new();
                for_each(each, class, edges, |found| {
                    assert!(pruned.insert(code(found.graph, Dart(0))));
                });
                let mut filtered = HashSet::new();
                for_each(each, Class::Multigraph, edges, |found| {
                    if class.contains(found.graph) {
                        filtered.insert(code(found.graph, Dart(0)));
                    }
                });
                assert_eq!(pruned, filtered, "{class} {edges} {each:?}");
            }
        }
    }
}

#[test]
fn sizes_without_worlds_are_refused() {
    let error = |edges| Enumeration::new(Each::World, Class::Simple, edges).unwrap_err();
    assert_eq!(error(0), SizeError::NoEdge);
    assert_eq!(error(33), SizeError::TooManyEdges(33));
}

/// A world is shown at its least start; with `a` automorphisms it has `2m / a` starts.
#[test]
fn the_worlds_account_for_all_starts() {
    for class in Class::ALL {
        for edges in 1..=6 {
            let mut starts = 0;
            for_each(Each::World, class, edges, |found| {
                let form = canonical(found.graph);
                assert_eq!(form.code, code(found.graph, Dart(0)));
                assert_eq!(form.automorphisms, found.automorphisms as usize);
                starts += found.graph.dart_count() as u64 / u64::from(found.automorphisms);
            });
            assert_eq!(starts, count(Each::Start, class, edges, |_| true)[edges - 1]);
        }
    }
}
