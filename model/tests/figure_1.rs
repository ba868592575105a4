//! Section 2.2: that one undirected marker does not suffice, the cases of the printed proof of it, and
//! the other claims about markers there. The proof's base and step are lemmas of `toposlam-proofs`.

use std::collections::BTreeMap;

use toposlam_model::{
    aid::{AidKind, State, named},
    ambiguity::{Comparison, Relation},
    embedded_graph::{Dart, EmbeddedGraph},
    format::named_world::NamedWorld,
    isomorphism::isomorphism,
    percept::Door,
};

use crate::world;

fn comparison<'w>(marker: AidKind, [one, other]: [&'w NamedWorld; 2]) -> Comparison<'w> {
    let placed = |world: &'w NamedWorld| (&world.graph, world.start.unwrap());
    Comparison::new(marker, placed(one), placed(other))
}

fn starts([one, other]: [&NamedWorld; 2]) -> [Dart; 2] {
    [one.start.unwrap(), other.start.unwrap()]
}

/// The degrees of the neighbours, as enumerated from the entry on.
fn neighbours(graph: &EmbeddedGraph, pose: Dart) -> Vec<u32> {
    let doors = (0..graph.degree_around(pose)).map(Door);
    doors.map(|door| graph.degree_around(graph.after(pose, door))).collect()
}

/// The relation of the two worlds of Figure 1 with an undirected marker at their centres.
fn relation([a, b]: [&NamedWorld; 2]) -> Relation {
    let undirected = named("undirected").unwrap();
    let comparison = comparison(undirected, [a, b]);
    let relation = comparison.relation(starts([a, b])).unwrap();
    let [one, other] = comparison.starts(starts([a, b]));
    assert!(relation.verify(&one, &other));
    relation
}

// paper: marker.undirected-insufficient
#[test]
fn no_walk_tells_the_worlds_of_figure_1_apart_with_an_undirected_marker() {
    let worlds = [world("figure-1a"), world("figure-1b")];
    assert!(isomorphism(&worlds[0].graph, &worlds[1].graph).is_err());
    let [a, b] = &worlds;
    assert_eq!(relation([a, b]).0.len(), 32);
    assert_eq!(comparison(named("undirected").unwrap(), [a, b]).walk(starts([a, b])), None);
}

// paper: fig1.cases
#[test]
fn the_cases_of_the_printed_proof() {
    let [a, b] = [world("figure-1a"), world("figure-1b")];
    let mut cases = BTreeMap::new();
    for (State { pose: here, .. }, State { pose: there, .. }) in relation([&a, &b]).0 {
        let list = neighbours(&a.graph, here);
        assert_eq!(list, neighbours(&b.graph, there));
        let case = match list.as_slice() {
            // An erratum: the print says [4, 4, 4, 4].
            [3, 3, 3, 3] => "1: the centre",
            // The centre's edge is the last, so the entry is the first after it.
            [3, 3, 4] => "2a: by the first edge next to the centre's",
            [3, 4, 3] => "2b: by the second",
            [4, 3, 3] => "2c: by the centre's own",
            other => panic!("no case has {other:?}"),
        };
        *cases.entry(case).or_insert(0) += 1;
    }
    assert_eq!(cases.into_values().collect::<Vec<_>>(), [8, 8, 8, 8]);
}

// paper: marker.none-cycles, marker.none-insufficient
#[test]
fn without_a_marker_the_cycles_of_three_and_of_four_cannot_be_told_apart() {
    let [three, four] = [world("cycle-3"), world("cycle-4")];
    let comparison = comparison(named("none").unwrap(), [&three, &four]);
    for (one, other) in three.graph.darts().flat_map(|d| four.graph.darts().map(move |e| (d, e))) {
        let relation = comparison.relation([one, other]).unwrap();
        let [here, there] = comparison.starts([one, other]);
        assert!(relation.verify(&here, &there));
        // Two robots on cycles of coprime lengths meet in every way that agrees on the sense.
        assert_eq!(relation.0.len(), 2 * 3 * 4);
    }
}

// paper: marker.undirected-cycles
#[test]
fn an_undirected_marker_tells_cycles_of_different_lengths_apart() {
    let undirected = named("undirected").unwrap();
    for (shorter, longer) in (3..12).flat_map(|n| (n + 1..=12).map(move |m| (n, m))) {
        let [one, other] = [shorter, longer].map(EmbeddedGraph::cycle);
        let comparison = Comparison::new(undirected, (&one, Dart(0)), (&other, Dart(0)));
        // Once round the shorter one.
        let walk = comparison.walk([Dart(0), Dart(0)]).unwrap();
        assert_eq!(walk.actions.len(), shorter);
    }
}
