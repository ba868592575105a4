//! The movable marker algorithm maps every small world without loops and parallel edges, at the cost
//! that a second implementation has, too; and with loops or parallel edges it does not.

use toposlam_model::{
    aid::{AidKind, markers::MOVABLE},
    ambiguity::Comparison,
    check::judge,
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Class,
    isomorphism::{Candidate, code, isomorphism},
    mapping::{Flaw, MappingAlgorithm, MovableMarkerRun, explore},
    world::GraphWorld,
};

use crate::{checked, starts};

/// The starts, the sum of the moves, and the most moves: by `tests/oracle/movable_marker.py` of the workspace.
// paper: movable.place, movable.new, movable.known, movable.back-link
#[test]
fn every_start_of_every_small_simple_world_is_mapped_right() {
    for (class, edges, row) in [
        (Class::Simple, 1, (1, 1, 1)),
        (Class::Simple, 2, (2, 5, 3)),
        (Class::Simple, 3, (6, 27, 6)),
        (Class::Simple, 4, (23, 173, 15)),
        (Class::Simple, 5, (108, 1222, 24)),
        (Class::Simple, 6, (596, 9519, 36)),
        (Class::Simple, 7, (3790, 80_494, 50)),
        (Class::Simple, 8, (27_339, 740_807, 66)),
        (Class::Corridor, 10, (61_455, 2_348_793, 104)),
        (Class::Planar, 8, (15_485, 371_598, 66)),
    ] {
        let tally = checked(class, edges, MovableMarkerRun::default);
        assert_eq!((tally.failure.as_ref(), tally.mapped), (None, tally.starts), "{class} {edges}");
        assert_eq!((tally.starts, tally.moves_total, tally.moves_max()), row, "{class} {edges}");
    }
}

/// The moves of a run. At its end the robot carries the marker.
fn moves(graph: &EmbeddedGraph, facing: Dart) -> u64 {
    let mut run = MovableMarkerRun::new(graph.dart_count());
    let mut world = GraphWorld::with_aid(graph, AidKind::Markers(MOVABLE), facing);
    explore(&mut run, &mut world).unwrap();
    assert_eq!(world.held(), 1);
    run.moves()
}

/// From an end, no known vertex can ever be the place just reached.
#[test]
fn a_chain_of_m_edges_costs_m_from_an_end() {
    for edges in 1..40 {
        assert_eq!(moves(&EmbeddedGraph::chain(edges), Dart(0)), edges as u64);
    }
}

/// The marker is left behind `v3`, `v4`, ..., and looked for at the start: from `vk` and back that
/// is `2 k` moves, and three over the edge. At the last edge it is there.
// paper: movable.new, movable.known
#[test]
fn a_cycle_of_m_edges_costs_m_squared_plus_m_minus_6() {
    for edges in 3..40_u64 {
        let graph = EmbeddedGraph::cycle(edges as usize);
        let new = (2..edges - 1).map(|known_end| 2 * known_end + 3).sum::<u64>();
        let last = 1 + 1 + (edges - 1);
        assert_eq!(2 + new + last, edges * edges + edges - 6);
        for facing in graph.darts() {
            assert_eq!(moves(&graph, facing), edges * edges + edges - 6);
        }
    }
}

#[test]
fn the_bound_is_the_stated_one() {
    let bound = |m, n| MappingAlgorithm::MovableMarkers(MOVABLE).move_bound(m, n);
    assert_eq!(bound(1, 2), 3);
    assert_eq!(bound(3, 3), 9 + (18 - 7));
    assert_eq!(bound(6, 4), 18 + 3 * (24 - 7));
    for n in 2..50 {
        for m in n - 1..=n * (n - 1) / 2 {
            assert!(bound(m, n) < 6 * (m * n) as u64);
        }
    }
    // A loop is no simple world, and takes no panic either.
    assert_eq!(bound(1, 1), 0);
}

/// What a run on a world with loops or parallel edges comes to.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum End {
    Right,
    WrongMap,
    Error,
}

fn end(graph: &EmbeddedGraph, facing: Dart) -> End {
    let mut search = MovableMarkerRun::new(10 * graph.dart_count());
    let mut world = GraphWorld::with_aid(graph, AidKind::Markers(MOVABLE), facing);
    let mut candidate = Candidate::default();
    let run = explore(&mut search, &mut world);
    let judged = run
        .map_err(Flaw::from)
        .and_then(|()| judge(&search, facing, &world, &mut candidate).map(|_| ()));
    match judged {
        Ok(()) => End::Right,
        Err(Flaw::WrongMap) => End::WrongMap,
        Err(Flaw::Error(_)) => End::Error,
        Err(flaw) => panic!("{flaw}"),
    }
}

/// That the worlds must be simple is no idle condition: no other one is mapped correctly, and some are
/// mapped wrongly without a sign of it.
#[test]
fn no_world_with_loops_or_parallel_edges_is_mapped_right() {
    let (mut wrong, mut errors) = (Vec::new(), 0);
    for graph in (1..=5).flat_map(|edges| starts(Class::Multigraph, edges)) {
        match end(&graph, Dart(0)) {
            End::Right => assert!(graph.is_simple()),
            End::WrongMap => wrong.push(graph),
            End::Error => errors += 1,
        }
    }
    assert!(wrong.iter().all(|graph| !graph.is_simple()));
    assert_eq!((wrong.len(), errors), (6, 8808));
    // The smallest: a triangle with one edge doubled.
    let doubled = EmbeddedGraph::from_edge_lists(&[
        ("u", vec!["once", "two", "three"]),
        ("v", vec!["once", "other"]),
        ("w", vec!["two", "other", "three"]),
    ])
    .unwrap();
    assert_eq!(code(&wrong[0], Dart(0)), code(&doubled, Dart(0)));
    assert_eq!(end(&doubled, Dart(0)), End::WrongMap);
}

/// Whether a robot that starts at the marker perceives the same in both worlds, whatever it does
/// with doors and marker: by a relation that is verified, or else by a walk that is.
fn indistinguishable(one: &EmbeddedGraph, other: &EmbeddedGraph) -> bool {
    let starts = [Dart(0); 2];
    let comparison = Comparison::new(MOVABLE, (one, starts[0]), (other, starts[1]));
    let [here, there] = comparison.starts(starts);
    let told_apart = comparison.walk(starts).map(|walk| assert!(walk.verify(&here, &there)));
    let relation = comparison.relation(starts).map(|it| assert!(it.verify(&here, &there)));
    assert_ne!(told_apart.is_some(), relation.is_some());
    relation.is_some()
}

/// No algorithm can do it with one movable marker: the smallest two worlds that it leaves alike, and
/// the smallest two without loops.
// paper: movable.place
#[test]
fn with_loops_or_parallel_edges_one_movable_marker_does_not_suffice() {
    let two_loops = |order: [&str; 4]| EmbeddedGraph::from_edge_lists(&[("v", order.to_vec())]);
    let beside = two_loops(["a", "a", "b", "b"]).unwrap();
    let crossing = two_loops(["a", "b", "a", "b"]).unwrap();
    let theta = |far: [&str; 3]| {
        EmbeddedGraph::from_edge_lists(&[("u", vec!["a", "b", "c"]), ("v", far.to_vec())])
    };
    let (plane, torus) = (theta(["c", "b", "a"]).unwrap(), theta(["a", "b", "c"]).unwrap());
    for (one, other) in [(&beside, &crossing), (&plane, &torus)] {
        assert!(isomorphism(one, other).is_err());
        assert!(indistinguishable(one, other));
    }
    // The only worlds with one edge, which the degree distinguishes.
    let one_loop = EmbeddedGraph::from_edge_lists(&[("v", vec!["a", "a"])]).unwrap();
    assert!(!indistinguishable(&EmbeddedGraph::chain(1), &one_loop));
    // The marker does distinguish some that are indistinguishable without it.
    assert!(!indistinguishable(&EmbeddedGraph::cycle(3), &EmbeddedGraph::cycle(4)));
}
