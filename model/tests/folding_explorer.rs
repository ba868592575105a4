//! The folding explorer reports its steps, ends on every world, and maps right however its ties are
//! broken.

use std::ops::ControlFlow;

use proptest::prelude::*;
use toposlam_model::{
    check::{every_way, first_false_step},
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    enumerate::{Class, Each, EnumeratedGraph, Enumeration},
    folding::ContradictionReason,
    mapping::{
        Contradiction, Explorer, FoldingEvent, FoldingRun, MapWalk, MappingError, MappingEvent,
        explore,
    },
    percept::{Door, Percept, Sighting},
    world::{GraphWorld, RefusedAction, World},
};

use crate::scripted_world::{ScriptedWorld, marked, plain};

const BOUND: usize = 60;

fn scripted(percepts: &[Percept]) -> Result<(), MappingError<RefusedAction>> {
    let mut exploration = FoldingRun::new(BOUND);
    explore(&mut exploration, &mut ScriptedWorld::new(percepts), &mut ())
}

fn contradiction(percepts: &[Percept]) -> Contradiction {
    match scripted(percepts) {
        Err(MappingError::Contradiction(contradiction)) => contradiction,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_world_without_end_runs_into_the_bound() {
    let bound = Err(MappingError::Bound { bound: BOUND });
    assert_eq!(scripted(&[marked(3, 0), plain(3)]), bound);
    assert_eq!(scripted(&[marked(u32::MAX, 0)]), bound);
}

#[test]
fn a_start_without_its_marker_is_a_contradiction() {
    for perceived in [plain(3), plain(0), marked(3, 1), marked(0, 0)] {
        assert_eq!(contradiction(&[perceived]), Contradiction::Start { perceived });
    }
}

#[test]
fn a_percept_that_no_vertex_gives_is_a_contradiction() {
    for perceived in [plain(0), marked(2, 2), marked(0, 0)] {
        let expected = Contradiction::Impossible { perceived };
        assert_eq!(contradiction(&[marked(1, 0), perceived]), expected);
    }
}

#[test]
fn a_world_that_contradicts_itself_is_an_error_with_the_visits() {
    // Behind each door of the start is a dead end; but the start has three doors when met again.
    let visits = [0, 2];
    let reason = ContradictionReason::Degree { visits, degrees: [2, 3] };
    let found = contradiction(&[marked(2, 0), plain(1), marked(3, 0)]);
    // The robot went back, so it is known what it should have seen.
    assert_eq!(found, Contradiction::Trail { reason, expected: Some(marked(2, 0)) });
    assert_eq!(
        found.to_string(),
        "the junctions after 0 and 2 moves are the same one, with 2 doors and with 3"
    );
    // The marker may not turn, either.
    let found = contradiction(&[marked(2, 0), plain(1), marked(2, 1)]);
    let sightings = [0, 1].map(|door| Sighting::Pointing(Door(door)));
    let reason = ContradictionReason::Marker { visits, sightings };
    assert_eq!(found, Contradiction::Trail { reason, expected: Some(marked(2, 0)) });
    // The marker is behind its own door, and is come to by it.
    let found = contradiction(&[marked(3, 0), marked(3, 0)]);
    let reason = ContradictionReason::OwnOpposite { visit: 0 };
    assert_eq!(found, Contradiction::Trail { reason, expected: None });
}

#[test]
fn a_map_always_embeds_in_its_world() {
    for (class, edges) in [(Class::Multigraph, 4), (Class::Simple, 6), (Class::Corridor, 7)] {
        let starts = Enumeration::new(Each::Start, class, edges).unwrap();
        let mut visit = |found: EnumeratedGraph| {
            let step = first_false_step(FoldingRun::default(), found.graph, Dart(0));
            assert_eq!(step, None, "{:?}", found.graph);
            ControlFlow::Continue(())
        };
        let _: ControlFlow<()> = starts.for_each(&mut visit);
    }
}

/// A loop of four edges, and a tail at which the robot starts.
fn loop_with_a_tail() -> EmbeddedGraph {
    EmbeddedGraph::from_neighbour_lists(&[
        ("end", vec!["a"]),
        ("a", vec!["end", "b", "d"]),
        ("b", vec!["a", "c"]),
        ("c", vec!["b", "d"]),
        ("d", vec!["c", "a"]),
    ])
    .unwrap()
}

#[test]
fn the_story_of_a_loop_with_a_tail() {
    let graph = loop_with_a_tail();
    let mut story = Vec::new();
    let mut moves = 0;
    let mut listen = |_: &mut _, journey: &MapWalk, event: MappingEvent| {
        moves = journey.moves();
        if !matches!(event, MappingEvent::Moved { .. }) {
            story.push(event);
        }
    };
    let mut exploration = FoldingRun::default();
    let mut world = GraphWorld::new(&graph, Dart(0));
    explore(&mut exploration, &mut world, &mut listen).unwrap();
    assert_eq!((moves, exploration.moves()), (6, 6));
    let added =
        |edge, vertex| MappingEvent::VertexAdded { edge: Dart(edge), vertex: Vertex(vertex) };
    let explored = |edge, degree| {
        MappingEvent::Folding(FoldingEvent::Explored { edge: Dart(edge), percept: plain(degree) })
    };
    let [edge, hypothesis] = [9, 3].map(Dart);
    assert_eq!(
        story,
        [
            MappingEvent::Started { percept: marked(1, 0) },
            explored(0, 3),
            added(0, 1),
            explored(2, 2),
            added(2, 2),
            explored(5, 2),
            added(5, 3),
            explored(7, 2),
            added(7, 4),
            explored(9, 3),
            MappingEvent::Folding(FoldingEvent::Testing { edge, hypothesis, cost: 1 }),
            MappingEvent::Folding(FoldingEvent::Confirmed { edge, hypothesis }),
            MappingEvent::Folding(FoldingEvent::Folded { before: 7, after: 5 }),
            MappingEvent::LoopClosed { edge: hypothesis, other: edge },
        ]
    );
}

#[test]
fn the_default_choice_is_the_first_of_all() {
    let starts = Enumeration::new(Each::Start, Class::Multigraph, 4).unwrap();
    let mut visit = |found: EnumeratedGraph| {
        let mut world = GraphWorld::new(found.graph, Dart(0));
        let mut at = FoldingRun::default();
        at.begin(&mut world, &mut ()).unwrap();
        while let Some(choice) = at.choose().unwrap() {
            assert_eq!(at.choices().unwrap().first(), Some(&choice));
            at.step(choice, &mut world, &mut ()).unwrap();
        }
        ControlFlow::Continue(())
    };
    let _: ControlFlow<()> = starts.for_each(&mut visit);
}

#[test]
fn every_start_with_up_to_four_edges_is_mapped_however_ties_are_broken() {
    let runs = [1, 2, 3, 4].map(|edges| {
        let starts = Enumeration::new(Each::Start, Class::Multigraph, edges).unwrap();
        let mut runs = 0;
        let mut visit = |found: EnumeratedGraph| {
            let explorer = FoldingRun::default();
            // The end of each run is judged.
            runs += every_way(explorer, found.graph, Dart(0), u64::MAX, &()).unwrap().runs;
            ControlFlow::Continue(())
        };
        let _: ControlFlow<()> = starts.for_each(&mut visit);
        runs
    });
    assert_eq!(runs, [3, 43, 1521, 472_285]);
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
        let _ = scripted(&percepts);
    }

    #[test]
    fn a_sensor_that_lies_once_never_panics(
        moves in 0..30usize,
        lie in (1..4u32, 0..6u32),
    ) {
        struct Lying<'g> {
            world: GraphWorld<'g>,
            at: u64,
            lie: Percept,
        }
        impl World for Lying<'_> {
            type Error = RefusedAction;

            fn percept(&mut self) -> Result<Percept, RefusedAction> {
                if self.world.moves() == self.at { Ok(self.lie) } else { self.world.percept() }
            }

            fn traverse(&mut self, door: Door) -> Result<(), RefusedAction> {
                let degree = self.world.sensed().degree;
                self.world.traverse(Door(door.0 % degree))
            }
        }
        let graph = loop_with_a_tail();
        let lie = if lie.1 < lie.0 { marked(lie.0, lie.1) } else { plain(lie.0) };
        let mut world = Lying { world: GraphWorld::new(&graph, Dart(0)), at: moves as u64, lie };
        let mut exploration = FoldingRun::new(BOUND);
        match explore(&mut exploration, &mut world, &mut ()) {
            Ok(()) => prop_assert!(exploration.is_complete()),
            Err(MappingError::Contradiction(_) | MappingError::Bound { .. }) => {}
            Err(error) => panic!("{error}"),
        }
    }
}
