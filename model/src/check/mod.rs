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
pub use every_way::{DEFAULT_STATE_BUDGET, RunChoices, SearchMemory, every_way};
pub use guess::{determines_world, other_world};
pub use judge::{FalseStep, first_false_step, judge, judge_map, judge_start};
pub use mistakes::{
    Mistake, MistakeCheck, MistakeCounts, MistakeEffect, MistakeKind, MistakeTally,
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
        embedded_graph::Dart,
        isomorphism::Candidate,
        mapping::{Explorer, Flaw, MovableMarkerRun, explore_with},
        world::GraphWorld,
    };

    proptest! {
        // paper: movable.place, movable.new, movable.known, movable.back-link
        #[test]
        fn larger_simple_worlds_are_mapped_right_with_a_movable_marker_whatever_the_choices(
            graph in any_graph(Class::Simple, 60),
            facing in any::<prop::sample::Index>(),
            numbers in proptest::collection::vec(any::<u16>(), 1..20),
        ) {
            let facing = Dart(facing.index(graph.dart_count()) as u32);
            let mut run = MovableMarkerRun::new(graph.dart_count());
            let mut world = GraphWorld::with_aid(&graph, run.aid(), facing);
            let mut numbers = numbers.iter().cycle();
            let explored = explore_with(&mut run, &mut world, |run| {
                let open = run.choices()?;
                let number = numbers.next().map_or(0, |&number| usize::from(number));
                Ok(open.get(number % open.len().max(1)).copied())
            });
            let mut candidate = Candidate::default();
            let judged = explored
                .map_err(Flaw::from)
                .and_then(|()| judge(&run, facing, &world, &mut candidate).map(|_| ()));
            prop_assert_eq!(judged, Ok(()));
        }
    }
}
