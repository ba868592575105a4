//! The events of a run contain every move and every decision.

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    mapping::{
        Algorithm1Run, Explorer, FoldingEvent, FoldingRun, MapWalk, MappingEvent, MovableEvent,
        MovableMarkerRun, Observed, explore,
    },
    percept::{Door, Percept, Sighting},
    world::GraphWorld,
};

use crate::plain;

/// What happens in a run, but for the moves, each with the moves made by then.
fn story<E: Explorer + Default>(graph: &EmbeddedGraph) -> Vec<(u64, MappingEvent)> {
    let mut story = Vec::new();
    let mut listen = |_: &mut _, walk: &MapWalk, event: MappingEvent| {
        if !matches!(event, MappingEvent::Moved { .. }) {
            story.push((walk.moves(), event));
        }
    };
    let mut run = E::default();
    let mut world = GraphWorld::with_marker(graph, run.marker(), Dart(0));
    explore(&mut run, &mut Observed::new(&mut world, &mut listen)).unwrap();
    story
}

fn started(degree: u32, sighting: Sighting) -> MappingEvent {
    MappingEvent::Started { percept: Percept { degree, sighting } }
}

fn added(edge: u32, vertex: u32) -> MappingEvent {
    MappingEvent::VertexAdded { edge: Dart(edge), vertex: Vertex(vertex) }
}

fn closed(edge: u32, other: u32) -> MappingEvent {
    MappingEvent::LoopClosed { edge: Dart(edge), other: Dart(other) }
}

/// A cycle with a tail at its first vertex, at whose end the robot starts.
fn cycle_with_a_tail(names: &[&str]) -> EmbeddedGraph {
    let count = names.len();
    let list = |at: usize| {
        let tail = ["end"].into_iter().take(usize::from(at == 0));
        let around = [1, count - 1].map(|by| names[(at + by) % count]);
        (names[at], tail.chain(around).collect())
    };
    let lists: Vec<(&str, Vec<&str>)> =
        std::iter::once(("end", vec![names[0]])).chain((0..count).map(list)).collect();
    EmbeddedGraph::from_neighbour_lists(&lists).unwrap()
}

// paper: cost.moves
// paper: alg1.2, alg1.3, alg1.7, alg1.18, alg1.19, alg1.20, alg1.21, alg1.22, alg1.23, alg1.return
#[test]
fn algorithm_1_in_a_triangle_with_a_tail() {
    let arrived = |edge, degree, contradicted, hypotheses| {
        let (edge, percept) = (Dart(edge), plain(degree));
        MappingEvent::Arrived { edge, percept, contradicted, hypotheses }
    };
    assert_eq!(
        story::<Algorithm1Run>(&cycle_with_a_tail(&["a", "b", "c"])),
        [
            (0, started(1, Sighting::Pointing(Door(0)))),
            (1, arrived(0, 3, 0, 0)),
            (1, added(0, 1)),
            (2, arrived(2, 2, 1, 0)),
            (2, added(2, 2)),
            (3, arrived(5, 2, 1, 0)),
            (3, added(5, 3)),
            (4, arrived(7, 3, 0, 1)),
            (5, MappingEvent::Confirmed { hypothesis: Dart(3), followed: 1 }),
            (5, closed(7, 3)),
        ]
    );
}

#[test]
fn the_folding_explorer_in_a_loop_with_a_tail() {
    let explored = |edge, degree| {
        MappingEvent::Folding(FoldingEvent::Explored { edge: Dart(edge), percept: plain(degree) })
    };
    let [edge, hypothesis] = [9, 3].map(Dart);
    assert_eq!(
        story::<FoldingRun>(&cycle_with_a_tail(&["a", "b", "c", "d"])),
        [
            (0, started(1, Sighting::Pointing(Door(0)))),
            (1, explored(0, 3)),
            (1, added(0, 1)),
            (2, explored(2, 2)),
            (2, added(2, 2)),
            (3, explored(5, 2)),
            (3, added(5, 3)),
            (4, explored(7, 2)),
            (4, added(7, 4)),
            (5, explored(9, 3)),
            (5, MappingEvent::Folding(FoldingEvent::Testing { edge, hypothesis, cost: 1 })),
            (6, MappingEvent::Folding(FoldingEvent::Confirmed { edge, hypothesis })),
            (6, MappingEvent::Folding(FoldingEvent::Folded { before: 7, after: 5 })),
            (6, closed(3, 9)),
        ]
    );
}

/// The tetrahedron: every vertex has three doors.
// paper: movable.place, movable.new, movable.known, movable.back-link
#[test]
fn the_movable_marker_algorithm_in_the_tetrahedron() {
    use MovableEvent::{Arrived, Behind, Dropped, Found, NotAt, NotBehind, NotFound, PickedUp};
    let tetrahedron = EmbeddedGraph::from_neighbour_lists(&[
        ("hub", vec!["a", "b", "c"]),
        ("a", vec!["hub", "c", "b"]),
        ("b", vec!["hub", "a", "c"]),
        ("c", vec!["hub", "b", "a"]),
    ])
    .unwrap();
    let percept = plain(3);
    let movable = MappingEvent::Movable;
    let arrived = |edge, candidates| movable(Arrived { edge: Dart(edge), percept, candidates });
    let found = |vertex| movable(Found { vertex: Vertex(vertex) });
    assert_eq!(
        story::<MovableMarkerRun>(&tetrahedron),
        [
            (0, started(3, Sighting::Lying(1))),
            (0, movable(PickedUp)),
            (1, arrived(0, 0)),
            (1, added(0, 1)),
            (2, arrived(4, 0)),
            (2, added(4, 2)),
            // Back over the edge, and by v1 to v0.
            (3, arrived(7, 1)),
            (3, movable(Dropped)),
            (6, found(0)),
            // To v2 by v1, and back: v0 has two unexplored darts.
            (6, movable(PickedUp)),
            (8, movable(Dropped)),
            (12, movable(NotBehind { dart: Dart(1), percept })),
            (13, movable(Behind { dart: Dart(2) })),
            (13, movable(PickedUp)),
            (13, closed(7, 2)),
            (14, arrived(8, 0)),
            (14, added(8, 3)),
            // Back over the edge, by v2 to v1, and on to v0, which has one unexplored dart left.
            (15, arrived(10, 2)),
            (15, movable(Dropped)),
            (18, movable(NotAt { vertex: Vertex(1) })),
            (19, found(0)),
            (19, movable(PickedUp)),
            (19, closed(10, 1)),
            (21, arrived(5, 1)),
            (21, movable(Dropped)),
            (24, found(3)),
            (24, movable(PickedUp)),
            (24, closed(5, 11)),
        ]
    );
    // In a cycle, no place is v0 but that behind the last edge.
    let story = story::<MovableMarkerRun>(&EmbeddedGraph::cycle(7));
    assert_eq!(story.iter().filter(|&&(_, event)| event == movable(NotFound)).count(), 4);
}
