//! The exhaustive check: an algorithm run on every start of every small world, and judged.

mod costs;
mod every_way;
mod guess;
mod judge;
mod mapping_algorithm;
mod mistakes;
mod one_by_one;
mod shared_prefix;
#[cfg(test)]
pub(crate) mod smallest_failure;
mod tally;

pub use costs::{ChoicesLimit, Costs, EveryWay};
pub use every_way::{DEFAULT_STATE_BUDGET, RunChoices, every_way};
pub use guess::determines_world;
pub use judge::{FalseStep, first_false_step, judge, judge_map, judge_start};
pub use mistakes::{
    MISTAKE_KINDS, Mistake, MistakeCheck, MistakeCounts, MistakeEffect, MistakeKind, MistakeTally,
    UndetectedMistake,
};
pub use one_by_one::{Check, Shard, ShardError, check_worlds};
pub use shared_prefix::{CheckPieces, FinishedUnits, LazyWorld, Probe, SharedPrefixCheck};
pub use tally::{EnumeratedStart, FailedStart, KeptStart, PartTally, Tally, WorstStart};

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        any_graph::{Class, any_graph},
        embedded_graph::{Dart, EmbeddedGraph},
        isomorphism::{Candidate, as_discovered},
        mapping::{Algorithm1Run, Explorer, Flaw, MovableMarkerRun, explore, explore_with},
        world::GraphWorld,
    };

    /// The flaw of a run, with its default choices or with those that numbers draw.
    fn flaw<E: Explorer>(
        mut run: E,
        (graph, facing): (&EmbeddedGraph, Dart),
        numbers: &[u16],
    ) -> Option<Flaw> {
        let mut world = GraphWorld::with_marker(graph, run.marker(), facing);
        let mut numbers = numbers.iter().cycle();
        let explored = explore_with(&mut run, &mut world, |run| {
            let open = run.choices()?;
            let Some(&number) = numbers.next() else { return run.choose() };
            Ok(open.get(usize::from(number) % open.len().max(1)).copied())
        });
        let mut candidate = Candidate::default();
        explored
            .map_err(Flaw::from)
            .and_then(|()| judge(&run, facing, &world, &mut candidate))
            .err()
    }

    proptest! {
        // paper: alg1.5, alg1.9, alg1.isomorphic, alg1.located
        #[test]
        fn larger_worlds_are_mapped_right_whatever_the_choices(
            graph in any_graph(Class::Multigraph, 40),
            facing in any::<prop::sample::Index>(),
            numbers in proptest::collection::vec(any::<u16>(), 1..20),
        ) {
            let start = (&graph, Dart(facing.index(graph.dart_count()) as u32));
            prop_assert_eq!(flaw(Algorithm1Run::new(graph.dart_count()), start, &numbers), None);
        }

        // paper: movable.place, movable.new, movable.known, movable.back-link
        #[test]
        fn larger_simple_worlds_are_mapped_right_with_a_movable_marker(
            graph in any_graph(Class::Simple, 60),
            facing in any::<prop::sample::Index>(),
            numbers in proptest::collection::vec(any::<u16>(), 1..20),
        ) {
            let start = (&graph, Dart(facing.index(graph.dart_count()) as u32));
            for numbers in [&[], &numbers[..]] {
                let run = MovableMarkerRun::new(graph.dart_count());
                prop_assert_eq!(flaw(run, start, numbers), None);
            }
        }

        /// The default choices look at nothing but the map, so the numbers of a world do not matter.
        #[test]
        fn isomorphic_starts_cost_the_same(
            graph in any_graph(Class::Multigraph, 30),
            facing in any::<prop::sample::Index>(),
        ) {
            let facing = Dart(facing.index(graph.dart_count()) as u32);
            let moves = |graph, facing| {
                let mut run = Algorithm1Run::default();
                explore(&mut run, &mut GraphWorld::new(graph, facing)).unwrap();
                run.moves()
            };
            let copy = as_discovered(&graph, facing);
            prop_assert_eq!(moves(&graph, facing), moves(&copy, Dart(0)));
        }
    }
}
