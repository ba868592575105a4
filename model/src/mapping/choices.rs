//! What Algorithm 1 leaves open: which unexplored edge next (line 5), which hypothesis next
//! (line 9). Mapping with a movable marker leaves open the former alone.

use super::partial_map::PartialMap;
use crate::embedded_graph::Dart;

/// Resolves what Algorithm 1 leaves open. Each method is told what the default is, and answers it if
/// it is not written; an answer that is not among what is there to choose counts as the default.
pub trait Choices {
    /// Line 5: one of the unexplored darts of the map. The robot has come in by the dart `robot`;
    /// the default is the `nearest`.
    fn next_edge(&mut self, map: &PartialMap, robot: Dart, nearest: Dart) -> Dart {
        let _ = (map, robot);
        nearest
    }

    /// Line 9: the place in `hypotheses` (never empty) of the one to follow next. They stand from
    /// the farthest to the nearest; the default is the last.
    fn next_hypothesis(&mut self, map: &PartialMap, hypotheses: &[Dart]) -> usize {
        let _ = map;
        hypotheses.len() - 1
    }
}

/// The default: everything by the fewest hops; then the vertex discovered first; then the lowest
/// index. So every run of everyone is the same run.
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
        mapping::{Exploration, Journey, MappingEvent, map_world},
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
        let mut listen = |_: &mut GraphWorld, _: &Journey, event: MappingEvent| story.push(event);
        let mut exploration = Exploration::new(graph.dart_count());
        let mut world = GraphWorld::new(graph, Dart(0));
        map_world(&mut world, choices, &mut exploration, &mut listen).unwrap();
        story
    }

    /// Chooses what is not there.
    struct Elsewhere;

    impl Choices for Elsewhere {
        fn next_edge(&mut self, map: &PartialMap, _: Dart, _: Dart) -> Dart {
            Dart(map.dart_count() as u32)
        }

        fn next_hypothesis(&mut self, _: &PartialMap, hypotheses: &[Dart]) -> usize {
            hypotheses.len()
        }
    }

    #[test]
    fn the_default_hypothesis_is_the_last() {
        let exploration = Exploration::new(0);
        let hypotheses = [Dart(5), Dart(3), Dart(1)];
        assert_eq!(Nearest.next_hypothesis(exploration.map(), &hypotheses), 2);
    }

    proptest! {
        #[test]
        fn a_choice_of_what_is_not_there_is_the_default(graph in any_graph(Class::Multigraph, 40)) {
            prop_assert_eq!(story(&graph, &mut Elsewhere), story(&graph, &mut Nearest));
        }

        // paper: alg1.5, alg1.9
        #[test]
        fn the_default_choices_are_those_of_the_design(graph in any_graph(Class::Multigraph, 40)) {
            prop_assert_eq!(story(&graph, &mut Nearest), story(&graph, &mut AsWritten));
        }
    }
}
