//! Algorithm 1 ends on every world, also on one that breaks, lies, or has no end.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use proptest::prelude::*;
use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph, MAX_EDGES, Vertex},
    mapping::{
        Algorithm1Run, Contradiction, Explorer, MapWalk, MappingError, MappingEvent, Nearest,
        map_world,
    },
    percept::{Door, Percept},
    world::{GraphWorld, RefusedAction, World},
};

use crate::scripted_world::{ScriptedWorld, marked, plain};

const BOUND: usize = 60;

fn map(world: &mut impl World<Error = RefusedAction>) -> Result<u64, MappingError<RefusedAction>> {
    let mut exploration = Algorithm1Run::new(BOUND);
    map_world(world, &mut Nearest, &mut exploration, &mut ()).map(|()| exploration.moves())
}

fn scripted(percepts: &[Percept]) -> MappingError<RefusedAction> {
    map(&mut ScriptedWorld::new(percepts)).unwrap_err()
}

// paper: alg1.1, alg1.terminates
#[test]
fn a_world_without_end_runs_into_the_bound() {
    assert_eq!(scripted(&[marked(3, 0), plain(3)]), MappingError::Bound { bound: BOUND });
    assert_eq!(scripted(&[marked(u32::MAX, 0)]), MappingError::Bound { bound: BOUND });
    assert_eq!(scripted(&[marked(3, 0), plain(u32::MAX)]), MappingError::Bound { bound: BOUND });
}

#[test]
fn the_bound_is_never_more_than_the_darts_that_can_be_numbered() {
    let begin = |mut exploration: Algorithm1Run| {
        exploration.begin(&mut ScriptedWorld::new(&[marked(u32::MAX, 0)]), &mut ())
    };
    let exploration = Algorithm1Run::new(usize::MAX);
    assert_eq!(begin(exploration), Err(MappingError::Bound { bound: 2 * MAX_EDGES }));
    let mut exploration = Algorithm1Run::new(BOUND);
    exploration.set_bound(usize::MAX);
    assert_eq!(begin(exploration), Err(MappingError::Bound { bound: 2 * MAX_EDGES }));
}

#[test]
fn a_start_without_its_marker_is_a_contradiction() {
    for perceived in [plain(3), plain(0), marked(3, 1), marked(0, 0)] {
        assert_eq!(scripted(&[perceived]), Contradiction::Start { perceived }.into());
    }
}

#[test]
fn a_percept_that_no_vertex_gives_is_a_contradiction() {
    for perceived in [plain(0), marked(2, 2), marked(0, 0)] {
        let expected = Contradiction::Impossible { perceived }.into();
        assert_eq!(scripted(&[marked(1, 0), perceived]), expected);
    }
}

// paper: alg1.6
#[test]
fn a_known_place_that_changed_is_a_contradiction() {
    // A dead end behind each of two doors; but the start has three doors when met again.
    let expected = Contradiction::KnownPlace {
        vertex: Vertex(0),
        index: 0,
        expected: marked(2, 0),
        perceived: marked(3, 0),
    };
    assert_eq!(scripted(&[marked(2, 0), plain(1), marked(3, 0)]), expected.into());
    // The marker may not turn, either.
    let turned = Contradiction::KnownPlace {
        vertex: Vertex(0),
        index: 0,
        expected: marked(2, 0),
        perceived: marked(2, 1),
    };
    assert_eq!(scripted(&[marked(2, 0), plain(1), marked(2, 1)]), turned.into());
    assert_eq!(
        MappingError::<RefusedAction>::from(expected).to_string(),
        "the world contradicts itself: at the known vertex v0, entered by its dart 0: expected \
         degree 2 with the marker along door 0, found degree 3 with the marker along door 0"
    );
}

#[test]
fn a_marker_where_it_cannot_be_is_a_contradiction() {
    for perceived in [marked(3, 1), marked(2, 0)] {
        let expected = Contradiction::Marker { vertex: Vertex(0), index: 0, perceived };
        assert_eq!(scripted(&[marked(2, 0), perceived]), expected.into());
    }
}

#[test]
fn a_way_back_that_changed_is_a_contradiction() {
    // v0 has one door, v1 behind it three; behind the second of these again three: is it v1, by its
    // third? The path back to v0 shows three doors again, and the way back of that shows two.
    let percepts = [marked(1, 0), plain(3), plain(3), plain(3), plain(2)];
    let expected = Contradiction::WayBack { expected: plain(3), perceived: plain(2) };
    assert_eq!(scripted(&percepts), expected.into());
}

#[test]
fn the_worlds_own_error_is_passed_on() {
    struct Closed;
    impl World for Closed {
        type Error = RefusedAction;
        fn percept(&mut self) -> Result<Percept, RefusedAction> {
            Ok(marked(2, 0))
        }
        fn traverse(&mut self, door: Door) -> Result<(), RefusedAction> {
            Err(RefusedAction::NoSuchDoor { door, degree: 0 })
        }
    }
    let error = RefusedAction::NoSuchDoor { door: Door(0), degree: 0 };
    assert_eq!(map(&mut Closed), Err(MappingError::World(error)));
}

proptest! {
    #[test]
    fn every_sensor_comes_to_an_end(
        percepts in proptest::collection::vec((0..5u32, 0..8u32), 1..200),
    ) {
        let percepts: Vec<_> = std::iter::once(marked(2, 0))
            .chain(percepts.into_iter().map(|(degree, door)| {
                if door < degree { marked(degree, door) } else { plain(degree) }
            }))
            .collect();
        let _ = map(&mut ScriptedWorld::new(&percepts));
    }
}

/// The events contain every move and every decision.
// paper: cost.moves
// paper: alg1.2, alg1.3, alg1.7, alg1.18, alg1.19, alg1.20, alg1.21, alg1.22, alg1.23, alg1.return
#[test]
fn the_story_of_a_triangle_with_a_tail() {
    let graph = EmbeddedGraph::from_neighbour_lists(&[
        ("end", vec!["a"]),
        ("a", vec!["end", "b", "c"]),
        ("b", vec!["a", "c"]),
        ("c", vec!["b", "a"]),
    ])
    .unwrap();
    let mut story = Vec::new();
    let mut exploration = Algorithm1Run::new(graph.dart_count());
    let mut listen = |_: &mut _, _: &MapWalk, event: MappingEvent| {
        if !matches!(event, MappingEvent::Moved { .. }) {
            story.push(event);
        }
    };
    let mut world = GraphWorld::new(&graph, Dart(0));
    map_world(&mut world, &mut Nearest, &mut exploration, &mut listen).unwrap();
    let arrived = |edge, percept, contradicted, hypotheses| MappingEvent::Arrived {
        edge: Dart(edge),
        percept,
        contradicted,
        hypotheses,
    };
    let added =
        |edge, vertex| MappingEvent::VertexAdded { edge: Dart(edge), vertex: Vertex(vertex) };
    assert_eq!(
        story,
        [
            MappingEvent::Started { percept: marked(1, 0) },
            arrived(0, plain(3), 0, 0),
            added(0, 1),
            arrived(2, plain(2), 1, 0),
            added(2, 2),
            arrived(5, plain(2), 1, 0),
            added(5, 3),
            arrived(7, plain(3), 0, 1),
            MappingEvent::Confirmed { hypothesis: Dart(3), followed: 1 },
            MappingEvent::LoopClosed { edge: Dart(7), other: Dart(3) },
        ]
    );
    assert_eq!(exploration.moves(), 5);
}
