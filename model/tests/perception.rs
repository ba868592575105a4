//! What a robot can sense and do in an embedded graph, and nothing else.

use proptest::prelude::*;
use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    percept::{Door, Percept},
    world::{GraphWorld, World},
};

use crate::{marked, markers::junction, plain};

/// The percepts along a door sequence, the first at the start.
fn percepts(graph: &EmbeddedGraph, facing: Dart, doors: &[u32]) -> Vec<Percept> {
    let mut world = GraphWorld::new(graph, facing);
    let mut percepts = vec![world.percept().unwrap()];
    for &door in doors {
        world.traverse(Door(door)).unwrap();
        percepts.push(world.percept().unwrap());
    }
    percepts
}

// paper: world.interface, percept.degree, percept.entry, percept.doors, motion.door, motion.arrival
// paper: motion.path
#[test]
fn doors_lead_clockwise_from_the_entry() {
    let graph = junction();
    let from_the_dead_end = |doors: &[u32]| percepts(&graph, Dart(0), doors);
    assert_eq!(from_the_dead_end(&[0, 0]), [marked(1, 0), plain(4), marked(1, 0)]);
    assert_eq!(from_the_dead_end(&[0, 1, 1]), [marked(1, 0), plain(4), plain(2), plain(1)]);
    // Round the loop: the other end is entered, and the way back is one or two doors on.
    assert_eq!(from_the_dead_end(&[0, 2, 1]), [marked(1, 0), plain(4), plain(4), marked(1, 0)]);
    assert_eq!(from_the_dead_end(&[0, 3, 2]), [marked(1, 0), plain(4), plain(4), marked(1, 0)]);
}

proptest! {
    /// Names, numbers and places are nothing that a robot could sense.
    // paper: world.unlabelled, percept.featureless, percept.no-metric
    #[test]
    fn renumbering_a_world_changes_nothing_that_is_perceived(
        order in Just([0, 1, 5, 7].map(Dart).to_vec()).prop_shuffle(),
        turn in 0..4u32,
        facing in 0..8u32,
        doors in proptest::collection::vec(0..12u32, 0..30),
    ) {
        let graph = junction();
        let firsts: Vec<_> = order.iter().map(|&dart| graph.behind(dart, Door(turn))).collect();
        let (copy, number) = graph.relabelled(&firsts).unwrap();
        let mut world = GraphWorld::new(&graph, Dart(facing));
        let mut other = GraphWorld::new(&copy, number[facing as usize]);
        for door in doors {
            let percept = world.percept().unwrap();
            prop_assert_eq!(percept, other.percept().unwrap());
            let door = Door(door % percept.degree);
            world.traverse(door).unwrap();
            other.traverse(door).unwrap();
        }
    }
}
