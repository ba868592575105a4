//! The events of a run contain every move and every decision.

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    mapping::{
        Algorithm1Run, Explorer, MapWalk, MappingEvent, MovableEvent, MovableMarkerRun, Observed,
        explore,
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
    let mut world = GraphWorld::with_aid(graph, run.aid(), Dart(0));
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

// paper: cost.moves
// paper: alg1.2, alg1.3, alg1.7, alg1.18, alg1.19, alg1.20, alg1.21, alg1.22, alg1.23, alg1.return
#[test]
fn algorithm_1_in_a_triangle_with_a_tail() {
    let graph = EmbeddedGraph::from_neighbour_lists(&[
        ("end", vec!["a"]),
        ("a", vec!["end", "b", "c"]),
        ("b", vec!["c", "a"]),
        ("c", vec!["a", "b"]),
    ])
    .unwrap();
    let arrived = |edge, degree, contradicted, hypotheses| {
        let (edge, percept) = (Dart(edge), plain(degree));
        MappingEvent::Arrived { edge, percept, contradicted, hypotheses }
    };
    assert_eq!(
        story::<Algorithm1Run>(&graph),
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

/// In a cycle, no place is v0 but that behind the last edge. The other stories are snapshots of the command line.
#[test]
fn the_movable_marker_is_not_found_at_the_new_places_of_a_cycle() {
    let story = story::<MovableMarkerRun>(&EmbeddedGraph::cycle(7));
    let not_found = MappingEvent::Movable(MovableEvent::NotFound);
    assert_eq!(story.iter().filter(|&&(_, event)| event == not_found).count(), 4);
}
