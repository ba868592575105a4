//! The choices that Algorithm 1 leaves open: the next unexplored edge (line 5) and the next
//! hypothesis (line 9). Mapping with a movable marker leaves only the former open.

use super::partial_map::PartialMap;
use crate::embedded_graph::Dart;

/// One open choice, made. A mapping algorithm takes one step for each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MappingChoice {
    /// Line 5: the unexplored dart to explore next.
    Edge(Dart),
    /// Line 9: the index of the hypothesis to try next, among those that are left.
    Hypothesis(usize),
}

/// Makes the open choices. The default implementation of a method makes the default choice. A choice
/// that is not open ends the run with [`InvalidStep`](super::InvalidStep).
pub trait Choices {
    /// Line 5: returns one of the map's unexplored darts. The robot came in by the dart `robot`. The
    /// default is `nearest`.
    fn next_edge(&mut self, map: &PartialMap, robot: Dart, nearest: Dart) -> Dart {
        let _ = (map, robot);
        nearest
    }

    /// Line 9: returns the index in `hypotheses` (never empty) of the one to try next. They are
    /// ordered from the farthest to the nearest. The default is the last.
    fn next_hypothesis(&mut self, map: &PartialMap, hypotheses: &[Dart]) -> usize {
        let _ = map;
        hypotheses.len() - 1
    }
}

/// The default choices: the fewest hops; then the vertex discovered first; then the lowest index. So
/// a run is reproducible.
// paper: cost.cycle, cost.chain
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Nearest;

impl Choices for Nearest {}

#[cfg(test)]
mod tests {
    use std::cmp::Reverse;

    use proptest::prelude::*;

    use super::*;
    use crate::{
        any_graph::{Class, any_graph},
        embedded_graph::{EmbeddedGraph, Vertex},
        mapping::{Algorithm1Run, InvalidStep, MapWalk, MappingError, MappingEvent, map_world},
        world::GraphWorld,
    };

    /// The fewest edges from each vertex to a root, by relaxing every edge until nothing changes.
    fn hops(map: &PartialMap, root: Vertex) -> Vec<usize> {
        let mut hops = vec![usize::MAX; map.vertex_count()];
        hops[root.at()] = 0;
        for _ in map.vertices() {
            for dart in map.vertices().flat_map(|vertex| map.darts_of(vertex)) {
                if let Some(far) = map.opposite(dart) {
                    let (near, far) = (map.vertex(dart).at(), map.vertex(far).at());
                    hops[near] = hops[near].min(hops[far].saturating_add(1));
                }
            }
        }
        hops
    }

    /// The default choices as the design words them.
    struct AsWritten;

    impl Choices for AsWritten {
        fn next_edge(&mut self, map: &PartialMap, robot: Dart, _: Dart) -> Dart {
            let hops = hops(map, map.vertex(robot));
            let key =
                |&dart: &Dart| (hops[map.vertex(dart).at()], map.vertex(dart), map.index(dart));
            map.unexplored().min_by_key(key).unwrap()
        }

        fn next_hypothesis(&mut self, map: &PartialMap, hypotheses: &[Dart]) -> usize {
            let hops = hops(map, Vertex(0));
            let key = |&place: &usize| {
                let dart = hypotheses[place];
                Reverse((hops[map.vertex(dart).at()], map.vertex(dart), map.index(dart)))
            };
            (0..hypotheses.len()).max_by_key(key).unwrap()
        }
    }

    fn story(graph: &EmbeddedGraph, choices: &mut impl Choices) -> Vec<MappingEvent> {
        let mut story = Vec::new();
        let mut listen = |_: &mut GraphWorld, _: &MapWalk, event: MappingEvent| story.push(event);
        let mut exploration = Algorithm1Run::new(graph.dart_count());
        let mut world = GraphWorld::new(graph, Dart(0));
        map_world(&mut world, choices, &mut exploration, &mut listen).unwrap();
        story
    }

    /// Chooses an edge or a hypothesis that is not there.
    enum Elsewhere {
        Edge,
        Hypothesis,
    }

    impl Choices for Elsewhere {
        fn next_edge(&mut self, map: &PartialMap, _: Dart, nearest: Dart) -> Dart {
            match self {
                Self::Edge => Dart(map.dart_count() as u32),
                Self::Hypothesis => nearest,
            }
        }

        fn next_hypothesis(&mut self, _: &PartialMap, hypotheses: &[Dart]) -> usize {
            hypotheses.len()
        }
    }

    #[test]
    fn the_default_hypothesis_is_the_last() {
        let exploration = Algorithm1Run::new(0);
        let hypotheses = [Dart(5), Dart(3), Dart(1)];
        assert_eq!(Nearest.next_hypothesis(exploration.map(), &hypotheses), 2);
    }

    proptest! {
        #[test]
        fn a_choice_that_is_not_open_is_an_error(graph in any_graph(Class::Multigraph, 40)) {
            let error = |choices: &mut dyn FnMut(&mut Algorithm1Run, &mut GraphWorld) -> _| {
                let mut exploration = Algorithm1Run::new(graph.dart_count());
                choices(&mut exploration, &mut GraphWorld::new(&graph, Dart(0)))
            };
            let degree = graph.degree_around(Dart(0));
            let no_edge = error(&mut |exploration, world| {
                map_world(world, &mut Elsewhere::Edge, exploration, &mut ())
            });
            let invalid = InvalidStep::NotUnexplored(Dart(degree));
            prop_assert_eq!(no_edge, Err(MappingError::InvalidStep(invalid)));
            // Without a hypothesis there is nothing to choose.
            let mut tried = false;
            for event in story(&graph, &mut Nearest) {
                tried |= matches!(event, MappingEvent::Arrived { hypotheses: 1.., .. });
            }
            let no_hypothesis = error(&mut |exploration, world| {
                map_world(world, &mut Elsewhere::Hypothesis, exploration, &mut ())
            });
            let is_invalid =
                matches!(no_hypothesis, Err(MappingError::InvalidStep(InvalidStep::NoHypothesis { .. })));
            prop_assert_eq!(is_invalid, tried);
        }

        // paper: alg1.5, alg1.9
        #[test]
        fn the_default_choices_are_those_of_the_design(graph in any_graph(Class::Multigraph, 40)) {
            prop_assert_eq!(story(&graph, &mut Nearest), story(&graph, &mut AsWritten));
        }
    }
}
