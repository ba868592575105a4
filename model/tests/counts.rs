//! The enumeration against published counts (OEIS), by number of edges.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use std::ops::ControlFlow;

use toposlam_model::{
    embedded_graph::Dart,
    enumerate::{Class, Each, Enumeration},
    isomorphism::{canonical, code},
};

fn count(each: Each, class: Class, edges: usize) -> u64 {
    let mut count = 0;
    let enumeration = Enumeration::new(each, class, edges).unwrap();
    let _ = enumeration.for_each(&mut |_| {
        count += 1;
        ControlFlow::Continue(())
    });
    count
}

fn counts(each: Each, class: Class, up_to: usize) -> Vec<u64> {
    (1..=up_to).map(|edges| count(each, class, edges)).collect()
}

/// A000698: rooted maps of any genus.
#[test]
fn starts() {
    assert_eq!(counts(Each::Start, Class::Multigraph, 6), [2, 10, 74, 706, 8162, 110_410]);
}

/// A170946: sensed maps of any genus.
#[test]
fn worlds() {
    assert_eq!(counts(Each::World, Class::Multigraph, 6), [2, 5, 20, 107, 870, 9436]);
}

/// A006394: simple planar sensed maps.
#[test]
fn simple_planar_worlds() {
    assert_eq!(counts(Each::World, Class::Planar, 7), [1, 1, 3, 5, 15, 52, 213]);
}

#[test]
fn a_world_is_shown_at_its_least_start_with_its_automorphisms() {
    for class in Class::ALL {
        for edges in 1..=5 {
            let _ = Enumeration::new(Each::World, class, edges).unwrap().for_each(&mut |found| {
                let form = canonical(found.graph);
                assert_eq!(form.code, code(found.graph, Dart(0)));
                assert_eq!(form.automorphisms, found.automorphisms as usize);
                ControlFlow::Continue(())
            });
        }
    }
}
