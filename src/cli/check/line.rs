//! A line of `check --json`: the result for one number of edges. `merge` reads the lines of shards.

use std::{collections::BTreeMap, path::Path};

use serde::{Deserialize, Serialize};
use toposlam_model::{
    check::{EnumeratedStart, FailedStart, Shard, Tally},
    enumerate::Class,
    format::{named_world::NamedWorld, world_file},
    mapping::{CostOrder, MappingAlgorithm},
    marker::{Directional, Marker},
};

use crate::cli::{CliError, Outcome, RunChoices, text::counted, version::version};

/// The algorithm that is checked, and its marker.
#[derive(Clone, Copy)]
pub(in crate::cli) struct AlgorithmInfo {
    pub(super) algorithm: &'static str,
    pub(super) marker: &'static str,
    /// Whether the starts have certificates.
    pub(super) certificates: bool,
    /// The order of its cost.
    pub(super) order: CostOrder,
}

impl AlgorithmInfo {
    pub(in crate::cli) fn of(algorithm: MappingAlgorithm) -> Self {
        Self {
            algorithm: algorithm.info().title,
            marker: algorithm.marker().name(),
            certificates: *algorithm.marker() == *(&Directional as &dyn Marker),
            order: algorithm.info().order,
        }
    }
}

/// The result for one number of edges.
pub(super) struct SizeResult<'a> {
    pub(super) edges: usize,
    /// The class of the worlds, unless they are from a file.
    pub(super) class: Class,
    pub(super) from: Option<&'a Path>,
    /// The share of the worlds.
    pub(super) shard: Shard,
    pub(super) tally: &'a Tally,
    /// The moves that were made, if runs share their beginnings.
    pub(super) moves_made: Option<u64>,
}

/// The result for one number of edges, as it is printed.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(in crate::cli) struct SizeLine {
    pub(in crate::cli) edges: usize,
    /// `None` if the worlds are from a file.
    pub(in crate::cli) class: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) from: Option<String>,
    pub(in crate::cli) marker: String,
    pub(in crate::cli) algorithm: String,
    pub(in crate::cli) worlds: u64,
    pub(in crate::cli) starts: u64,
    pub(in crate::cli) mapped: u64,
    pub(in crate::cli) failed: u64,
    pub(in crate::cli) moves_total: u64,
    pub(in crate::cli) moves_max: u64,
    /// The moves that were made, if runs share their beginnings.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) moves_made: Option<u64>,
    // With a directional marker: the lengths of the certificates of the starts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) certificate_total: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) certificate_max: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) below_certificate: Option<u64>,
    /// The total of the moves divided by that of the certificates; `None` without a start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) ratio: Option<f64>,
    pub(in crate::cli) largest_ratio: f64,
    // With all choices: distinct states, runs, and the fewest and the most moves of a run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) states: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) runs: Option<u128>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) moves_least: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) moves_most: Option<u64>,
    /// Starts with runs that were not tried.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) gave_up: Option<u64>,
    /// Those with more states than `--max-states`, and those with more than fit in memory.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) limits: Option<BTreeMap<String, u64>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) max_states: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) shard: Option<String>,
    /// Of a shard: the version of the program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) version: Option<String>,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(in crate::cli) interrupted: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) failure: Option<FailureLine>,
    pub(in crate::cli) holds: bool,
}

/// The first start that was mapped wrongly.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::cli) struct FailureLine {
    pub(in crate::cli) cause: String,
    pub(in crate::cli) step: Option<String>,
    moves: Option<u64>,
    pub(in crate::cli) world: serde_json::Value,
}

impl FailureLine {
    fn new(failure: &FailedStart, subject: AlgorithmInfo) -> Self {
        let step = failure.false_step.map(|step| step.to_string());
        Self {
            cause: failure.flaw.to_string(),
            step: step.or_else(|| {
                failure.moves.map(|moves| format!("after {}", counted(moves as usize, "move")))
            }),
            moves: failure.moves,
            world: world_file::to_json(&failed_world(failure, subject)),
        }
    }

    /// The world with its start; `None` if it is not a world.
    pub(in crate::cli) fn named_world(&self) -> Option<NamedWorld> {
        world_file::read(self.world.to_string().as_bytes()).ok()
    }

    /// Its place among all starts, from the first to the last; last if it is not a world.
    fn place(&self) -> (bool, Option<EnumeratedStart>) {
        let place = self.named_world().and_then(|world| {
            let facing = world.start?;
            Some(EnumeratedStart::new(&world.graph, facing))
        });
        (place.is_none(), place)
    }
}

fn failed_world(failure: &FailedStart, subject: AlgorithmInfo) -> NamedWorld {
    let about = format!("{} fails here: {}", subject.algorithm, failure.flaw);
    NamedWorld::discovered("failed", &about, &failure.graph, failure.facing)
}

/// The sum of some counts is larger than 64 bits hold.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("with this, the sum of `{0}` is 2^64 or more")]
pub(in crate::cli) struct CountOverflow(&'static str);

impl From<CountOverflow> for CliError {
    fn from(overflow: CountOverflow) -> Self {
        Self::Input(overflow.to_string())
    }
}

/// Adds a count with a name.
fn add_count(sum: &mut u64, count: u64, name: &'static str) -> Result<(), CountOverflow> {
    *sum = sum.checked_add(count).ok_or(CountOverflow(name))?;
    Ok(())
}

/// Adds a count that not all results have.
fn add_some(
    sum: &mut Option<u64>,
    count: Option<u64>,
    name: &'static str,
) -> Result<(), CountOverflow> {
    match (sum.as_mut(), count) {
        (Some(sum), Some(count)) => add_count(sum, count, name),
        (Some(_), None) => Ok(()),
        (None, count) => {
            *sum = count;
            Ok(())
        }
    }
}

impl SizeLine {
    pub(super) fn new(size: &SizeResult, subject: AlgorithmInfo, choice: RunChoices) -> Self {
        let &SizeResult { edges, class, from, shard, tally, moves_made } = size;
        let certificate = |value| subject.certificates.then_some(value);
        let all = choice != RunChoices::Default;
        let is_shard = shard != Shard::WHOLE;
        let mut line = Self {
            edges,
            class: from.is_none().then(|| class.name().to_owned()),
            from: from.map(|path| path.display().to_string()),
            marker: subject.marker.to_owned(),
            algorithm: subject.algorithm.to_owned(),
            worlds: tally.worlds,
            starts: tally.starts,
            mapped: tally.mapped,
            failed: tally.failed(),
            moves_total: tally.moves_total,
            moves_max: tally.moves_max(),
            moves_made,
            certificate_total: certificate(tally.certificate_total),
            certificate_max: certificate(tally.certificate_max),
            below_certificate: certificate(tally.below_certificate),
            ratio: certificate(tally.certificate_total)
                .and_then(|total| ratio(tally.moves_total, total)),
            largest_ratio: tally.largest_ratio(edges, subject.order),
            states: all.then_some(tally.states),
            runs: all.then_some(tally.runs),
            moves_least: tally.extremes.filter(|_| all).map(|(least, _)| least),
            moves_most: tally.extremes.filter(|_| all).map(|(_, most)| most),
            gave_up: all.then(|| tally.gave_up()),
            limits: all.then(|| limits(tally)),
            max_states: match choice {
                RunChoices::All { budget } => Some(budget),
                RunChoices::Default => None,
            },
            shard: is_shard.then(|| shard.to_string()),
            version: is_shard.then(|| version().to_owned()),
            interrupted: tally.interrupted,
            failure: tally.failure.as_ref().map(|failure| FailureLine::new(failure, subject)),
            holds: false,
        };
        line.holds = line.verdict().0 == Outcome::Holds;
        line
    }

    /// The outcome of a check, and its name. A check does not hold if it is empty or interrupted.
    pub(in crate::cli) fn verdict(&self) -> (Outcome, &'static str) {
        match () {
            () if self.failed > 0 || self.below_certificate.unwrap_or_default() > 0 => {
                (Outcome::Violated, "violated")
            }
            () if self.interrupted => (Outcome::Incomplete, "incomplete, interrupted"),
            () if self.starts == 0 => {
                (Outcome::Incomplete, "incomplete: there is nothing to check")
            }
            () if self.gave_up.unwrap_or_default() > 0 => (Outcome::Incomplete, "incomplete"),
            () => (Outcome::Holds, "holds"),
        }
    }

    /// The number of starts that reached a limit.
    pub(super) fn reached(&self, limit: &str) -> u64 {
        self.limits.as_ref().and_then(|limits| limits.get(limit)).copied().unwrap_or_default()
    }

    /// The first thing in which the counts of a line contradict each other.
    pub(in crate::cli) fn contradiction(&self) -> Option<String> {
        let Self { starts, mapped, failed, moves_total, moves_max, .. } = *self;
        let (below, gave_up) = (self.below_certificate, self.gave_up);
        let limits =
            self.limits.iter().flatten().try_fold(0_u64, |sum, (_, &n)| sum.checked_add(n));
        let is = |holds| if holds { "true" } else { "false" };
        let holds = self.verdict().0 == Outcome::Holds;
        let problem = match () {
            () if mapped.checked_add(failed) != Some(starts) => {
                format!("`starts` is {starts}, but {mapped} are mapped and {failed} failed")
            }
            () if self.failure.is_some() != (failed > 0) => {
                format!("`failed` is {failed}, which disagrees with `failure`")
            }
            () if moves_max > moves_total => {
                format!("`moves_max` is {moves_max}, but `moves_total` is {moves_total}")
            }
            () if below.is_some_and(|below| below > mapped) => {
                format!("`below_certificate` is more than `mapped`, {mapped}")
            }
            () if gave_up.is_some_and(|gave_up| gave_up > starts || limits != Some(gave_up)) => {
                "`gave_up` is not the sum of `limits`, or more than `starts`".to_owned()
            }
            () if self.holds != holds => {
                format!("`holds` is {}, but by the counts it is {}", is(self.holds), is(holds))
            }
            () => return None,
        };
        Some(problem)
    }

    /// Adds the result of other starts.
    ///
    /// # Errors
    /// Returns an error if a sum is too large.
    pub(in crate::cli) fn add(&mut self, other: Self) -> Result<(), CountOverflow> {
        add_count(&mut self.worlds, other.worlds, "worlds")?;
        add_count(&mut self.starts, other.starts, "starts")?;
        add_count(&mut self.mapped, other.mapped, "mapped")?;
        add_count(&mut self.failed, other.failed, "failed")?;
        add_count(&mut self.moves_total, other.moves_total, "moves_total")?;
        self.moves_max = self.moves_max.max(other.moves_max);
        add_some(&mut self.moves_made, other.moves_made, "moves_made")?;
        add_some(&mut self.certificate_total, other.certificate_total, "certificate_total")?;
        self.certificate_max = self.certificate_max.max(other.certificate_max);
        add_some(&mut self.below_certificate, other.below_certificate, "below_certificate")?;
        self.ratio = self.certificate_total.and_then(|total| ratio(self.moves_total, total));
        self.largest_ratio = self.largest_ratio.max(other.largest_ratio);
        add_some(&mut self.states, other.states, "states")?;
        self.runs = match (self.runs, other.runs) {
            (Some(one), Some(other)) => Some(one.saturating_add(other)),
            (one, other) => one.or(other),
        };
        self.moves_least = self.moves_least.into_iter().chain(other.moves_least).min();
        self.moves_most = self.moves_most.max(other.moves_most);
        add_some(&mut self.gave_up, other.gave_up, "gave_up")?;
        if let Some(limits) = other.limits {
            let known = self.limits.get_or_insert_default();
            for (limit, starts) in limits {
                add_count(known.entry(limit).or_default(), starts, "limits")?;
            }
        }
        self.interrupted |= other.interrupted;
        self.failure = match (self.failure.take(), other.failure) {
            (Some(one), Some(other)) => Some(if other.place() < one.place() { other } else { one }),
            (one, other) => one.or(other),
        };
        self.holds = self.verdict().0 == Outcome::Holds;
        Ok(())
    }
}

/// The ratio of moves to the moves of certificates.
fn ratio(moves: u64, certificates: u64) -> Option<f64> {
    (certificates > 0).then(|| moves as f64 / certificates as f64)
}

/// The number of starts that reached each limit on the search for all runs.
fn limits(tally: &Tally) -> BTreeMap<String, u64> {
    let counts = [("max-states", tally.over_budget), ("memory", tally.over_memory)];
    let reached = counts.into_iter().filter(|(_, count)| *count > 0);
    reached.map(|(limit, count)| (limit.to_owned(), count)).collect()
}
