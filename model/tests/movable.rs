//! The movable marker algorithm maps every small world without loops and parallel edges, at the cost
//! that a second implementation has, too; and with loops or parallel edges it does not.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use std::ops::ControlFlow;

use toposlam_model::{
    ambiguity::Comparison,
    check::{Check, RunChoices, Shard, judge},
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    enumerate::{Class, Each, Enumeration},
    isomorphism::{Candidate, code, isomorphism},
    mapping::{
        Flaw, MapWalk, MappingAlgorithm, MappingEvent, MovableEvent, MovableMarkerRun, Nearest,
        explore, map_with_movable_marker,
    },
    marker::{MarkerKind, Movable},
    percept::{Percept, Sighting},
    world::GraphWorld,
};

/// For each number of edges: starts, the sum of the moves, the most moves.
fn rows(class: Class, up_to: usize) -> Vec<(u64, u64, u64)> {
    let rows = (1..=up_to).map(|edges| {
        let sweep = Check::new(class, edges, Shard::WHOLE).unwrap();
        let tally = sweep.run(MovableMarkerRun::default, RunChoices::Default, &());
        assert_eq!(tally.failure, None);
        assert_eq!(tally.mapped, tally.starts);
        (tally.starts, tally.moves_total, tally.moves_max())
    });
    rows.collect()
}

/// The moves: by `tests/oracle/movable_marker.py` of the workspace.
// paper: movable.place, movable.new, movable.known, movable.back-link
#[test]
fn every_start_of_every_simple_world_with_up_to_eight_edges_is_mapped_right() {
    assert_eq!(
        rows(Class::Simple, 8),
        [
            (1, 1, 1),
            (2, 5, 3),
            (6, 27, 6),
            (23, 173, 15),
            (108, 1222, 24),
            (596, 9519, 36),
            (3790, 80_494, 50),
            (27_339, 740_807, 66),
        ]
    );
}

#[test]
fn every_start_of_every_corridor_world_with_up_to_ten_edges_is_mapped_right() {
    let rows = rows(Class::Corridor, 10);
    assert_eq!(rows.last(), Some(&(61_455, 2_348_793, 104)));
}

#[test]
fn every_start_of_every_planar_world_with_up_to_eight_edges_is_mapped_right() {
    let rows = rows(Class::Planar, 8);
    assert_eq!(rows.last(), Some(&(15_485, 371_598, 66)));
}

fn run(graph: &EmbeddedGraph, facing: Dart) -> (MovableMarkerRun, GraphWorld<'_, MarkerKind>) {
    let mut search = MovableMarkerRun::new(graph.dart_count());
    let mut world = GraphWorld::with_marker(graph, Movable, facing);
    explore(&mut search, &mut world, &mut ()).unwrap();
    (search, world)
}

#[test]
fn at_the_end_the_robot_carries_the_marker() {
    let starts = Enumeration::new(Each::Start, Class::Simple, 6).unwrap();
    let _ = starts.for_each(&mut |found| {
        let (_, world) = run(found.graph, Dart(0));
        assert!(world.carries());
        ControlFlow::Continue(())
    });
}

/// From an end, no known vertex can ever be the place just reached.
#[test]
fn a_chain_of_m_edges_costs_m_from_an_end() {
    for edges in 1..40 {
        assert_eq!(run(&EmbeddedGraph::chain(edges), Dart(0)).0.moves(), edges as u64);
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
            assert_eq!(run(&graph, facing).0.moves(), edges * edges + edges - 6);
        }
    }
}

#[test]
fn the_bound_is_the_stated_one() {
    let bound = |m, n| MappingAlgorithm::MovableMarker.move_bound(m, n);
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

/// The tetrahedron: every vertex has three doors.
fn k4() -> EmbeddedGraph {
    EmbeddedGraph::from_neighbour_lists(&[
        ("hub", vec!["a", "b", "c"]),
        ("a", vec!["hub", "c", "b"]),
        ("b", vec!["hub", "a", "c"]),
        ("c", vec!["hub", "b", "a"]),
    ])
    .unwrap()
}

/// What happens on the way, but for the moves, each with the moves made by then.
fn story(graph: &EmbeddedGraph) -> Vec<(u64, MappingEvent)> {
    let mut story = Vec::new();
    let mut listen = |_: &mut _, journey: &MapWalk, event: MappingEvent| {
        if !matches!(event, MappingEvent::Moved { .. }) {
            story.push((journey.moves(), event));
        }
    };
    let mut search = MovableMarkerRun::new(graph.dart_count());
    let mut world = GraphWorld::with_marker(graph, Movable, Dart(0));
    map_with_movable_marker(&mut world, &mut Nearest, &mut search, &mut listen).unwrap();
    story
}

/// The events contain every decision.
// paper: movable.place, movable.new, movable.known, movable.back-link
#[test]
fn the_story_of_the_tetrahedron() {
    use MovableEvent::{Behind, Dropped, NotBehind, PickedUp};
    let percept = Percept { degree: 3, sighting: Sighting::Nothing };
    let started =
        MappingEvent::Started { percept: Percept { degree: 3, sighting: Sighting::Lying(1) } };
    let arrived = |edge, candidates| {
        MappingEvent::Movable(MovableEvent::Arrived { edge: Dart(edge), percept, candidates })
    };
    let not_at = |vertex| MappingEvent::Movable(MovableEvent::NotAt { vertex: Vertex(vertex) });
    let found = |vertex| MappingEvent::Movable(MovableEvent::Found { vertex: Vertex(vertex) });
    let added =
        |edge, vertex| MappingEvent::VertexAdded { edge: Dart(edge), vertex: Vertex(vertex) };
    let closed = |edge, other| MappingEvent::LoopClosed { edge: Dart(edge), other: Dart(other) };
    assert_eq!(
        story(&k4()),
        [
            (0, started),
            (0, MappingEvent::Movable(PickedUp)),
            (1, arrived(0, 0)),
            (1, added(0, 1)),
            (2, arrived(4, 0)),
            (2, added(4, 2)),
            // Back over the edge, and by v1 to v0.
            (3, arrived(7, 1)),
            (3, MappingEvent::Movable(Dropped)),
            (6, found(0)),
            // To v2 by v1, and back: v0 has two unexplored darts.
            (6, MappingEvent::Movable(PickedUp)),
            (8, MappingEvent::Movable(Dropped)),
            (12, MappingEvent::Movable(NotBehind { dart: Dart(1), percept })),
            (13, MappingEvent::Movable(Behind { dart: Dart(2) })),
            (13, MappingEvent::Movable(PickedUp)),
            (13, closed(7, 2)),
            (14, arrived(8, 0)),
            (14, added(8, 3)),
            // Back over the edge, by v2 to v1, and on to v0, which has one unexplored dart left.
            (15, arrived(10, 2)),
            (15, MappingEvent::Movable(Dropped)),
            (18, not_at(1)),
            (19, found(0)),
            (19, MappingEvent::Movable(PickedUp)),
            (19, closed(10, 1)),
            (21, arrived(5, 1)),
            (21, MappingEvent::Movable(Dropped)),
            (24, found(3)),
            (24, MappingEvent::Movable(PickedUp)),
            (24, closed(5, 11)),
        ]
    );
    // In a cycle, no place is v0 but that behind the last edge.
    let story = story(&EmbeddedGraph::cycle(7));
    let not_found = story
        .iter()
        .filter(|(_, event)| matches!(event, MappingEvent::Movable(MovableEvent::NotFound)));
    assert_eq!(not_found.count(), 4);
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
    let mut world = GraphWorld::with_marker(graph, Movable, facing);
    let mut candidate = Candidate::default();
    let run = explore(&mut search, &mut world, &mut ());
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
    for edges in 1..=5 {
        let starts = Enumeration::new(Each::Start, Class::Multigraph, edges).unwrap();
        let _ = starts.for_each(&mut |found| {
            match end(found.graph, Dart(0)) {
                End::Right => assert!(found.graph.is_simple()),
                End::WrongMap => wrong.push(found.graph.clone()),
                End::Error => errors += 1,
            }
            ControlFlow::Continue(())
        });
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
    let comparison = Comparison::new(&Movable, (one, starts[0]), (other, starts[1]));
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
