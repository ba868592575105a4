//! The exhaustive check: an algorithm run on every start of every small world, and judged.

mod costs;
mod enumerated_start;
mod every_way;
mod guess;
mod judge;
mod mapping_algorithm;
mod mistakes;
mod one_by_one;
mod run_choices;
mod shared_prefix;
mod tally;

pub use costs::{ChoicesLimit, Costs, EveryWay};
pub use enumerated_start::EnumeratedStart;
pub use every_way::{DEFAULT_STATE_BUDGET, every_way};
pub use guess::determines_world;
pub use judge::{FalseStep, first_false_step, judge, judge_map, judge_start};
pub use mistakes::{
    MISTAKE_KINDS, Mistake, MistakeCheck, MistakeCounts, MistakeEffect, MistakeKind, MistakeTally,
    UndetectedMistake,
};
pub use one_by_one::{Check, Shard, ShardError, check_worlds};
pub use run_choices::RunChoices;
pub use shared_prefix::{CheckPieces, FinishedUnits, LazyWorld, Probe, SharedPrefixCheck};
pub use tally::{FailedStart, KeptStart, PartTally, Tally, WorstStart};

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        any_graph::{Class, any_graph},
        embedded_graph::{Dart, EmbeddedGraph},
        isomorphism::Candidate,
        mapping::{
            Algorithm1Run, Choices, Flaw, MovableMarkerRun, Nearest, PartialMap, explore,
            map_with_movable_marker, map_world,
        },
        marker::Movable,
        world::GraphWorld,
    };

    /// Chooses as the numbers say.
    struct Drawn<'n> {
        numbers: &'n [u16],
        next: usize,
    }

    impl Drawn<'_> {
        fn below(&mut self, bound: usize) -> usize {
            self.next = (self.next + 1) % self.numbers.len();
            usize::from(self.numbers[self.next]) % bound
        }
    }

    impl Choices for Drawn<'_> {
        fn next_edge(&mut self, map: &PartialMap, _: Dart, nearest: Dart) -> Dart {
            let place = self.below(map.unexplored_count() as usize);
            map.unexplored().nth(place).unwrap_or(nearest)
        }

        fn next_hypothesis(&mut self, _: &PartialMap, hypotheses: &[Dart]) -> usize {
            self.below(hypotheses.len())
        }
    }

    fn flaw_with_movable(
        graph: &EmbeddedGraph,
        facing: Dart,
        mut choices: impl Choices,
    ) -> Option<Flaw> {
        let mut world = GraphWorld::with_marker(graph, Movable, facing);
        let mut search = MovableMarkerRun::new(graph.dart_count());
        let mut candidate = Candidate::default();
        map_with_movable_marker(&mut world, &mut choices, &mut search, &mut ())
            .map_err(Flaw::from)
            .and_then(|()| judge(&search, facing, &world, &mut candidate))
            .err()
    }

    proptest! {
        // paper: alg1.5, alg1.9, alg1.isomorphic, alg1.located
        #[test]
        fn larger_worlds_are_mapped_right_whatever_the_choices(
            graph in any_graph(Class::Multigraph, 40),
            facing in any::<u32>(),
            numbers in proptest::collection::vec(any::<u16>(), 1..20),
        ) {
            let facing = Dart(facing % graph.dart_count() as u32);
            let mut world = GraphWorld::new(&graph, facing);
            let mut exploration = Algorithm1Run::new(graph.dart_count());
            let mut choices = Drawn { numbers: &numbers, next: 0 };
            map_world(&mut world, &mut choices, &mut exploration, &mut ()).unwrap();
            let mut candidate = Candidate::default();
            let verdict = judge(&exploration, facing, &world, &mut candidate);
            prop_assert!(verdict.is_ok());
        }

        // paper: movable.place, movable.new, movable.known, movable.back-link
        #[test]
        fn larger_simple_worlds_are_mapped_right_with_a_movable_marker(
            graph in any_graph(Class::Simple, 60),
            facing in any::<u32>(),
            numbers in proptest::collection::vec(any::<u16>(), 1..20),
        ) {
            let facing = Dart(facing % graph.dart_count() as u32);
            let drawn = Drawn { numbers: &numbers, next: 0 };
            prop_assert_eq!(flaw_with_movable(&graph, facing, Nearest), None);
            prop_assert_eq!(flaw_with_movable(&graph, facing, drawn), None);
        }

        /// The default choices look at nothing but the map, so the numbers of a world do not matter.
        #[test]
        fn isomorphic_starts_cost_the_same(
            graph in any_graph(Class::Multigraph, 30),
            facing in any::<u32>(),
        ) {
            let facing = Dart(facing % graph.dart_count() as u32);
            let copy = crate::isomorphism::as_discovered(&graph, facing);
            let moves = |graph, facing| {
                let mut exploration = Algorithm1Run::new(60);
                let mut world = GraphWorld::new(graph, facing);
                explore(&mut exploration, &mut world, &mut ()).unwrap();
                exploration.moves()
            };
            prop_assert_eq!(moves(&graph, facing), moves(&copy, Dart(0)));
        }
    }
}
