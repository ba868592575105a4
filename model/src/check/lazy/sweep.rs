//! The lazy check of a class and a size, in units that can be run in any order and on any machine.

use std::{ops::ControlFlow, sync::atomic::AtomicU64};

use super::{
    LazyTally, StepExplorer, Stepwise,
    leaf::LeafJudge,
    search::{Search, beginnings},
    world::Prefix,
};
use crate::{
    check::{FailedStart, Shard, Tally, WorstStart, judge_start, sweep::go_on},
    enumerate::{
        Class, Draft, Each, Enumeration, EnumerationPart, Outcome, SizeError, Watch, in_parts,
    },
    isomorphism::Candidate,
};

/// The number of edges that are decided in the beginning that a unit's runs have in common.
const BEGINNING: usize = 3;

/// The number of units from which the most moves of a run are first estimated.
const SAMPLE: usize = 16;

/// A check of every start of every world of a class with a number of edges, without repetition.
#[derive(Clone, Debug)]
pub struct LazySweep {
    worlds: Enumeration,
    draft: Draft,
    shard: Shard,
}

/// The result of a lazy check.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LazyCheck {
    /// The same as of a [`Sweep`](crate::check::Sweep).
    pub tally: Tally,
    /// The moves that were made. `tally.moves_total` would be made by one run for each start.
    pub moves_made: u64,
}

/// A part of the tree of all runs: those that begin with the same answers.
#[derive(Clone, Debug)]
pub(super) struct Unit(Vec<Outcome>);

/// Embedded graphs up to isomorphism.
#[derive(Clone, Copy, Debug, Default)]
struct WorldCount {
    worlds: u64,
    interrupted: bool,
}

impl LazySweep {
    /// A check of one shard of the starts.
    ///
    /// # Errors
    /// Returns an error if the worlds cannot be enumerated.
    pub fn new(class: Class, edges: usize, shard: Shard) -> Result<Self, SizeError> {
        let worlds = Enumeration::new(Each::World, class, edges)?;
        Ok(Self { worlds, draft: Draft::new(class, edges)?, shard })
    }

    /// The class of worlds.
    #[must_use]
    pub fn class(&self) -> Class {
        self.worlds.class()
    }

    /// Checks explorers, each on one unit. The result does not depend on the number of threads.
    pub fn run<E: StepExplorer>(&self, new: impl Fn() -> E + Sync, watch: &dyn Watch) -> LazyCheck {
        let units = self.units(&new, watch);
        let most_moves = AtomicU64::new(0);
        // Some runs from all over the tree, so that few others can be the worst one.
        for unit in units.iter().step_by(units.len().div_ceil(SAMPLE).max(1)) {
            self.check_unit(unit, new(), &most_moves, watch);
        }
        let check = |unit: &Unit| self.check_unit(unit, new(), &most_moves, watch);
        let merge = |mut sum: LazyTally, other: LazyTally| {
            sum.merge(other);
            sum
        };
        let found = in_parts(&units, watch, LazyTally::default, check, |tally| tally.starts, merge);
        self.finished(found, new, watch)
    }

    /// The units of the shard. They do not depend on the number of threads.
    fn units<E: StepExplorer>(&self, new: impl Fn() -> E, watch: &dyn Watch) -> Vec<Unit> {
        let cut_at = self.draft.edges_left().saturating_sub(BEGINNING);
        let all = beginnings(new(), self.draft.clone(), cut_at, watch);
        self.shard.select(all.into_iter().map(Unit).collect())
    }

    /// Checks the starts of a unit.
    fn check_unit<E: StepExplorer>(
        &self,
        unit: &Unit,
        explorer: E,
        most_moves: &AtomicU64,
        watch: &dyn Watch,
    ) -> LazyTally {
        let mut judge = LeafJudge::new(&explorer.marker(), most_moves);
        if watch.stop() {
            return LazyTally { interrupted: true, ..LazyTally::default() };
        }
        let prefix = Prefix::Given(unit.0.clone());
        let mut search = Search::new(explorer, self.draft.clone(), prefix, None, watch);
        let ended = search.for_each_end(&mut |world, explorer, end| {
            judge.judge(world, explorer, &end);
            ControlFlow::Continue(())
        });
        let moves_made = search.world.moves_made;
        LazyTally { moves_made, interrupted: ended.is_break(), ..judge.tally }
    }

    /// The result, from the counts of all units.
    fn finished<E: StepExplorer>(
        &self,
        found: LazyTally,
        new: impl Fn() -> E,
        watch: &dyn Watch,
    ) -> LazyCheck {
        let WorldCount { worlds, interrupted } = self.count_worlds(watch);
        let failure = found.failure.and_then(|start| start.start()).and_then(|(graph, facing)| {
            let mut explorer = Stepwise(new());
            let judged = judge_start(&mut explorer, &graph, facing, &mut Candidate::default());
            let (moves, flaw) = (Some(judged.0), judged.1.err()?);
            Some(FailedStart { graph, facing, flaw, moves, false_step: None })
        });
        let worst = found.worst.and_then(|(moves, start)| {
            let (graph, facing) = start.start()?;
            Some(WorstStart { graph, facing, moves })
        });
        let tally = Tally {
            worlds,
            starts: found.starts,
            mapped: found.mapped,
            moves_total: found.moves_total,
            certificate_total: found.certificate_total,
            certificate_max: found.certificate_max,
            below_certificate: found.below_certificate,
            worst,
            dearest: found.dearest,
            failure,
            interrupted: found.interrupted || interrupted,
            ..Tally::default()
        };
        LazyCheck { tally, moves_made: found.moves_made }
    }

    /// The embedded graphs of the shard.
    fn count_worlds(&self, watch: &dyn Watch) -> WorldCount {
        let parts = self.shard.select(self.worlds.parts());
        let count = |part: &EnumerationPart| {
            let mut found = WorldCount::default();
            let ended = part.for_each(&mut |_| {
                found.worlds += 1;
                go_on(watch)
            });
            found.interrupted = ended.is_break();
            found
        };
        let merge = |one: WorldCount, other: WorldCount| WorldCount {
            worlds: one.worlds + other.worlds,
            interrupted: one.interrupted || other.interrupted,
        };
        in_parts(&parts, watch, WorldCount::default, count, |found| found.worlds, merge)
    }
}
