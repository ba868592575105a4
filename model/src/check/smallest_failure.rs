//! The smallest start on which a broken variant of an algorithm fails.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::{Check, FailedStart, RunChoices, Shard, judge};
use crate::{
    any_graph::starts,
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Class,
    folding::ArrivalSenses,
    injected_flaw::{InjectedFlaw, inject},
    isomorphism::{Candidate, code},
    mapping::{Explorer, Flaw, explore},
    world::{GraphWorld, SensingWorld},
};

/// The edges of a start, its code, and what went wrong there.
pub(crate) type Failure = (usize, Vec<u32>, String);

/// The first start of a class with up to so many edges on which an explorer fails.
pub(crate) fn smallest_failure<E: Explorer>(
    new: impl Fn() -> E + Sync,
    class: Class,
    most: usize,
) -> Failure {
    let failure = (1..=most).find_map(|edges| {
        let check = Check::new(class, edges, Shard::WHOLE).unwrap();
        let tally = check.run(&new, RunChoices::Default, &());
        assert_eq!(tally.failed() > 0, tally.failure.is_some());
        let FailedStart { graph, facing, flaw, moves, false_step } = tally.failure?;
        let words = code(&graph, facing).words().to_vec();
        let step = false_step
            .map_or_else(|| format!("after {} moves", moves.unwrap()), |step| step.to_string());
        Some((edges, words, format!("{step}: {flaw}")))
    });
    failure.expect("the check catches it")
}

/// The first start of a class with up to so many edges on which an explorer fails with an injected flaw.
pub(crate) fn injected_failure<E: Explorer>(
    flaw: Option<InjectedFlaw>,
    explorer: E,
    class: Class,
    most: usize,
) -> Option<Failure> {
    injected_failure_with(|_, _| ArrivalSenses::default(), flaw, explorer, class, most)
}

/// [`injected_failure`] of a robot with other senses: those of a graph and a pose.
pub(crate) fn injected_failure_with<E: Explorer>(
    sense: impl Fn(&EmbeddedGraph, Dart) -> ArrivalSenses,
    flaw: Option<InjectedFlaw>,
    mut explorer: E,
    class: Class,
    most: usize,
) -> Option<Failure> {
    let mut candidate = Candidate::default();
    let mut fails = || {
        (1..=most).flat_map(|edges| starts(class, edges)).find_map(|graph| {
            // With a flaw, what the code relies on may be false. Overflows panic in tests.
            let judged = catch_unwind(AssertUnwindSafe(|| {
                let bound = explorer.move_bound(graph.edge_count(), graph.vertex_count());
                // The map may have more darts than the world.
                let world = GraphWorld::with_aid(&graph, explorer.aid(), Dart(0));
                let sense = |world: &GraphWorld<_>| sense(&graph, world.pose());
                let mut world = SensingWorld::new(world.with_bound(bound), sense);
                let ended = explore(&mut explorer, &mut world).map_err(Flaw::from);
                let world = world.world();
                let judged = ended
                    .and_then(|()| judge(&explorer, Dart(0), world, &mut candidate).map(|_| ()));
                judged.map_err(|flaw| format!("after {} moves: {flaw}", world.moves()))
            }));
            let report = judged.unwrap_or_else(|_| Err("it panics".to_owned())).err()?;
            Some((graph.edge_count(), code(&graph, Dart(0)).words().to_vec(), report))
        })
    };
    inject(flaw, &mut fails)
}

/// The word of a code for a new vertex. The word for an edge to a known vertex is the number of a dart.
pub(crate) fn new(degree: u32) -> u32 {
    u32::MAX - degree
}

/// A wrong addition to the map, after which it becomes larger than the world.
pub(crate) fn too_large(step: &str, darts: u32) -> String {
    format!("{step}: more than {darts} darts (edge ends) are known, and the map is not complete")
}

/// The items of an [`Explorer`] that are those of its field `run`.
macro_rules! delegate_to_run {
    ($aid:ty, $choice:ty) => {
        type Aid = $aid;
        type Choice = $choice;

        fn aid(&self) -> $aid {
            self.run.aid()
        }

        fn limit_darts(&mut self, max_darts: usize) {
            self.run.limit_darts(max_darts);
        }

        fn begin<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
            self.run.begin(world)
        }

        fn choose(&mut self) -> Result<Option<$choice>, InvalidStep> {
            self.run.choose()
        }

        fn map_walk(&self) -> Option<&MapWalk> {
            self.run.map_walk()
        }

        fn write_key(&self, key: &mut Vec<u32>) -> Option<StateLevel> {
            self.run.write_key(key)
        }
    };
}

pub(crate) use delegate_to_run;
