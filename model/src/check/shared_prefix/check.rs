//! The lazy check of a class and a size, in units that can be run in any order and on any machine.

use std::{collections::BTreeMap, sync::atomic::AtomicU64};

use super::{
    leaf::LeafJudge,
    search::{RunSearch, prefixes},
    world::PrefixSource,
};
use crate::{
    check::{
        EnumeratedStart, FailedStart, PartTally, Shard, Tally, WorstStart, judge_start,
        one_by_one::check_stop,
    },
    enumerate::{
        Answer, Class, Draft, Each, Enumeration, EnumerationPart, SizeError, Watch, in_parts,
    },
    isomorphism::Candidate,
    mapping::Explorer,
};

/// The number of edges that are decided in the beginning that a unit's runs have in common. A unit of 7 edges
/// then has about a thousand starts.
fn prefix_edges(edges: usize) -> usize {
    if edges < 8 { 2 } else { 3 }
}

/// The number of units from which the most moves of a run are first estimated.
const SAMPLE: usize = 16;

/// A check of every start of every world of a class with a number of edges, without repetition.
#[derive(Clone, Debug)]
pub struct SharedPrefixCheck {
    worlds: Enumeration,
    draft: Draft,
    shard: Shard,
}

/// A random probe of the tree of all runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// The product of the numbers of answers that were possible where one was drawn.
    pub weight: f64,
    pub tally: PartTally,
}

/// The units that were finished before, and those that are finished now, for checks that can be resumed. A unit
/// has an index among those of its shard.
pub trait FinishedUnits: Sync {
    /// The counts of a unit that was finished before.
    fn finished(&self, unit: usize) -> Option<PartTally>;

    /// A unit is finished now. Units are finished in any order, and by several threads.
    fn finish(&self, unit: usize, tally: &PartTally);
}

/// No unit was finished before.
impl FinishedUnits for () {
    fn finished(&self, _: usize) -> Option<PartTally> {
        None
    }

    fn finish(&self, _: usize, _: &PartTally) {}
}

impl SharedPrefixCheck {
    /// A check of one shard of the starts.
    ///
    /// # Errors
    /// Returns an error if the worlds cannot be enumerated.
    pub fn new(class: Class, edges: usize, shard: Shard) -> Result<Self, SizeError> {
        let worlds = Enumeration::new(Each::World, class, edges)?;
        Ok(Self { worlds, draft: Draft::new(class, edges)?, shard })
    }

    pub fn class(&self) -> Class {
        self.worlds.class()
    }

    /// Checks explorers, each on one unit. The result does not depend on the number of threads.
    pub fn run<E: Explorer>(&self, new: impl Fn() -> E + Sync, watch: &dyn Watch) -> Tally {
        self.resume(new, &(), watch)
    }

    /// Checks explorers on the units that were not finished before. The result is that of [`run`](Self::run).
    pub fn resume<E: Explorer>(
        &self,
        new: impl Fn() -> E + Sync,
        units: &dyn FinishedUnits,
        watch: &dyn Watch,
    ) -> Tally {
        let pieces = CheckPieces::new(self, &new, watch);
        let check = |&unit: &usize| {
            units.finished(unit).unwrap_or_else(|| {
                let tally = pieces.check(unit, new(), watch);
                if !tally.interrupted {
                    units.finish(unit, &tally);
                }
                tally
            })
        };
        // Some runs from all over the tree come first, so that few others can be the worst one.
        let all: Vec<usize> = (0..pieces.unit_count()).collect();
        let sample = all.iter().step_by(all.len().div_ceil(SAMPLE).max(1));
        let sample: BTreeMap<_, _> = sample.map(|unit| (*unit, check(unit))).collect();
        let check = |unit: &usize| sample.get(unit).cloned().unwrap_or_else(|| check(unit));
        let merge = PartTally::merged;
        let found = in_parts(&all, watch, PartTally::default, check, |tally| tally.starts, merge);
        // The progress is that of the runs.
        let all: Vec<usize> = (pieces.unit_count()..pieces.count()).collect();
        let count = |&piece: &usize| pieces.check(piece, new(), watch);
        let worlds = in_parts(&all, &(), PartTally::default, count, |found| found.worlds, merge);
        CheckPieces::finished(found.merged(worlds), new)
    }

    /// Knuth's random probe of the tree of all runs. Each number draws one of the possible answers; then every
    /// answer is given, until all is decided. The expected value of a count times the weight is that of the
    /// whole tree. There is one decision for the degree of the start vertex, and one for each edge.
    pub fn probe<E: Explorer>(&self, explorer: E, numbers: Vec<u64>, watch: &dyn Watch) -> Probe {
        let most_moves = AtomicU64::new(u64::MAX);
        let (tally, weight) =
            self.check_subtree(PrefixSource::Drawn(numbers), explorer, &most_moves, watch);
        Probe { weight, tally }
    }

    /// The units of the shard, by the answers with which their runs begin. They do not depend on the number of
    /// threads.
    fn units<E: Explorer>(&self, new: impl Fn() -> E, watch: &dyn Watch) -> Vec<Vec<Answer>> {
        let edges = self.draft.edges_left();
        let cut_at = edges.saturating_sub(prefix_edges(edges));
        self.shard.select(prefixes(new(), self.draft.clone(), cut_at, watch))
    }

    /// Checks the starts of a subtree, and returns the weight of what was drawn.
    fn check_subtree<E: Explorer>(
        &self,
        prefix: PrefixSource,
        explorer: E,
        most_moves: &AtomicU64,
        watch: &dyn Watch,
    ) -> (PartTally, f64) {
        let mut judge = LeafJudge::new(&explorer.aid(), most_moves);
        let mut search = RunSearch::new(explorer, self.draft.clone(), prefix, None, watch);
        let ended = search
            .for_each_end(&mut |world, explorer, end| judge.judge(world, explorer, &end, watch));
        let (moves_made, interrupted) = (search.world.moves_made, ended.is_break());
        (PartTally { moves_made, interrupted, ..judge.tally }, search.world.weight)
    }
}

/// The pieces of a [`SharedPrefixCheck`], which are done in any order and on any machine: its units, and then the parts
/// of the worlds that are counted. Equal checks have equal pieces on every machine.
#[derive(Debug)]
pub struct CheckPieces {
    check: SharedPrefixCheck,
    units: Vec<Vec<Answer>>,
    world_parts: Vec<EnumerationPart>,
    /// The most moves of a run in a unit that was checked here.
    most_moves: AtomicU64,
}

impl CheckPieces {
    pub fn new<E: Explorer>(
        check: &SharedPrefixCheck,
        new: impl Fn() -> E,
        watch: &dyn Watch,
    ) -> Self {
        Self {
            units: check.units(new, watch),
            world_parts: check.shard.select(check.worlds.parts()),
            most_moves: AtomicU64::new(0),
            check: check.clone(),
        }
    }

    pub fn count(&self) -> usize {
        self.units.len() + self.world_parts.len()
    }

    pub fn unit_count(&self) -> usize {
        self.units.len()
    }

    /// The counts of a piece; none if there is no such piece.
    pub fn check<E: Explorer>(&self, piece: usize, explorer: E, watch: &dyn Watch) -> PartTally {
        let mut found = PartTally::default();
        if let Some(unit) = self.units.get(piece) {
            if watch.stop() {
                return PartTally { interrupted: true, ..found };
            }
            let prefix = PrefixSource::Given(unit.clone());
            return self.check.check_subtree(prefix, explorer, &self.most_moves, watch).0;
        }
        if let Some(part) = self.world_parts.get(piece - self.units.len()) {
            let ended = part.for_each(&mut |_| {
                found.worlds += 1;
                check_stop(watch)
            });
            found.interrupted = ended.is_break();
        }
        found
    }

    /// The result, from the counts of all pieces. It is that of [`SharedPrefixCheck::run`].
    pub fn finished<E: Explorer>(counts: PartTally, new: impl Fn() -> E) -> Tally {
        let failure = counts.failure.as_ref().and_then(EnumeratedStart::start);
        let failure = failure.and_then(|(graph, facing)| {
            let (moves, judged) =
                judge_start(&mut new(), &graph, facing, &mut Candidate::default());
            Some(FailedStart::new(&new, (&graph, facing), judged.err()?, Some(moves)))
        });
        let worst = counts.worst.as_ref().and_then(|&(moves, ref start)| {
            let (graph, facing) = start.start()?;
            Some(WorstStart { graph, facing, moves })
        });
        counts.with_starts(worst, failure)
    }
}
