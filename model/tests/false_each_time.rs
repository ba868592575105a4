//! Percepts that are false each time in the same way: which of them no robot can detect.

use toposlam_model::{
    aid::RefusedAction,
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Class,
    isomorphism::Bijection,
    mapping::{FACING, MappingAlgorithm, MappingMethod, Relocate},
    percept::{Door, Percept, Sighting},
    world::{GraphWorld, World},
};

use crate::starts;

/// A world in which percepts are false, given the robot's pose, the true percept and the number of moves.
struct Falsified<'g, F> {
    world: GraphWorld<'g>,
    falsify: F,
}

impl<F: FnMut(Dart, Percept, u64) -> Percept> World for Falsified<'_, F> {
    type Error = RefusedAction;

    fn percept(&mut self) -> Result<Percept, RefusedAction> {
        let percept = self.world.percept()?;
        Ok((self.falsify)(self.world.pose(), percept, self.world.moves()))
    }

    fn traverse(&mut self, door: Door) -> Result<(), RefusedAction> {
        self.world.traverse(door)
    }
}

impl<F: FnMut(Dart, Percept, u64) -> Percept> Relocate for Falsified<'_, F> {}

/// The map that a robot makes and audits twice; `None` if it notices something.
fn mapped(
    graph: &EmbeddedGraph,
    falsify: impl FnMut(Dart, Percept, u64) -> Percept,
) -> Option<EmbeddedGraph> {
    let mut world = Falsified { world: GraphWorld::new(graph, FACING), falsify };
    let method = MappingMethod::By { algorithm: MappingAlgorithm::Folding, audits: 2 };
    let (run, mapped) = method.map_world(&mut world, 100, &[], &mut ());
    mapped.ok().and_then(|_| run.map().complete().cloned())
}

fn is_right(map: &EmbeddedGraph, graph: &EmbeddedGraph) -> bool {
    Bijection::of_starts((map, FACING), (graph, FACING)).verify(map, graph)
}

/// Maps that are not noticed to be wrong, in all starts with some edges. The percept is false at each visit of the
/// marked vertex after the start, by this function of another door.
fn unnoticed_at_the_marker(edges: usize, sighting: impl Fn(Door) -> Sighting) -> usize {
    let mut wrong = 0;
    for graph in starts(Class::Multigraph, edges) {
        for by in 1..graph.degree_around(FACING) {
            let found = mapped(&graph, |_, percept, moves| match percept.sighting {
                Sighting::Pointing(door) if moves > 0 => {
                    let door = Door((door.0 + by) % percept.degree);
                    Percept { sighting: sighting(door), ..percept }
                }
                _ => percept,
            });
            wrong += usize::from(found.is_some_and(|map| !is_right(&map, &graph)));
        }
    }
    wrong
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn a_marker_that_is_missed_or_turned_each_time_is_always_noticed() {
    for edges in 1..=4 {
        assert_eq!(unnoticed_at_the_marker(edges, Sighting::Pointing), 0);
        assert_eq!(unnoticed_at_the_marker(edges, |_| Sighting::Nothing), 0);
    }
}

#[test]
fn a_marker_that_is_invented_each_time_can_make_a_cycle_of_two_a_loop() {
    for (edges, unnoticed) in [(1, 0), (2, 1), (3, 0), (4, 14)] {
        let mut wrong = Vec::new();
        for graph in starts(Class::Multigraph, edges) {
            let marked = graph.vertex(FACING);
            for along in graph.darts().filter(|&dart| graph.vertex(dart) != marked) {
                let found = mapped(&graph, |pose, percept, _| {
                    if graph.vertex(pose) != graph.vertex(along) {
                        return percept;
                    }
                    let [pose, along] = [pose, along].map(|dart| graph.index(dart));
                    let door = Door::between(pose, along, percept.degree);
                    Percept { sighting: Sighting::Pointing(door), ..percept }
                });
                wrong.extend(found.filter(|map| !is_right(map, &graph)));
            }
        }
        assert_eq!(wrong.len(), unnoticed, "{edges}");
        if let (2, [map]) = (edges, &wrong[..]) {
            assert_eq!((map.vertex_count(), map.edge_count()), (1, 1));
        }
    }
}

#[test]
fn doors_that_are_never_seen_are_missing_in_a_map_that_no_walk_contradicts() {
    for (edges, unnoticed) in [(1, 0), (2, 7), (3, 80)] {
        let mut wrong = 0;
        for graph in starts(Class::Multigraph, edges) {
            for vertex in graph.vertices() {
                for degree in 1..=2 * edges as u32 {
                    let found = mapped(&graph, |pose, percept, _| {
                        let is_there = graph.vertex(pose) == vertex;
                        Percept {
                            degree: if is_there { degree } else { percept.degree },
                            ..percept
                        }
                    });
                    wrong += usize::from(found.is_some_and(|map| !is_right(&map, &graph)));
                }
            }
        }
        assert_eq!(wrong, unnoticed, "{edges}");
    }
    // The middle of a chain of three, of which one door is never seen.
    let three = EmbeddedGraph::from_neighbour_lists(&[
        ("middle", vec!["left", "right"]),
        ("left", vec!["middle"]),
        ("right", vec!["middle"]),
    ])
    .unwrap();
    let middle = three.vertex(FACING);
    let map = mapped(&three, |pose, percept, _| {
        let degree = if three.vertex(pose) == middle { 1 } else { percept.degree };
        Percept { degree, ..percept }
    });
    assert!(is_right(&map.unwrap(), &EmbeddedGraph::chain(1)));
}
