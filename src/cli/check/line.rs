//! The result for one number of edges: a line of `check --json`, a row of the table, a case for CI. `--add` reads
//! the lines of shards.

use std::{collections::BTreeMap, fmt::Write as _, ops::Not};

use serde::{Deserialize, Serialize};
use serde_json::Value;
use toposlam_model::{
    aid::AidKind,
    check::{EnumeratedStart, FailedStart, Tally, WorstStart},
    embedded_graph::{Dart, EmbeddedGraph},
    format::{named_world::NamedWorld, world_file},
    mapping::MappingAlgorithm,
};

use crate::cli::{
    CliError, Outcome, RunChoices,
    ci_report::CiCase,
    explorer::{ExplorerFault, ReportedRun},
    text::{counted, grouped},
};

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct SizeLine {
    pub(super) edges: usize,
    /// `None` if the worlds are from a file.
    pub(super) class: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) from: Option<String>,
    pub(super) marker: String,
    /// `None` if an explorer is checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) algorithm: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) explorer: Option<String>,
    pub(super) worlds: u64,
    pub(super) starts: u64,
    pub(super) mapped: u64,
    pub(super) failed: u64,
    /// Of an explorer: starts on which a limit was reached.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) unknown: Option<u64>,
    pub(super) moves_total: u64,
    pub(super) moves_max: u64,
    /// The moves that were made, if runs share their beginnings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) moves_made: Option<u64>,
    // With a directional marker: the lengths of the certificates of the starts; of an explorer, of those that were
    // mapped correctly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) certificate_total: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) certificate_max: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) below_certificate: Option<u64>,
    /// The total of the moves divided by that of the certificates; `None` without a start.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) ratio: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) largest_ratio: Option<f64>,
    // With all choices: distinct states, runs, and the fewest and the most moves of a run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) states: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) runs: Option<u128>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) moves_least: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) moves_most: Option<u64>,
    /// Starts with runs that were not tried.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) gave_up: Option<u64>,
    /// Those with more states than `--choices` allows, and those with more than fit in memory.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) limits: Option<BTreeMap<String, u64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) max_states: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) shard: Option<String>,
    /// With --proof: SHA-256 of the proofs of all runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) proofs_sha256: Option<String>,
    /// Of a shard: the version of the program.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) version: Option<String>,
    /// Of an explorer: the number of starts for each name of a fault.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) causes: Option<BTreeMap<String, u64>>,
    /// Of an explorer: whether starts were left out because too many runs ended their process.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) stopped: Option<bool>,
    #[serde(default, skip_serializing_if = "Not::not")]
    pub(super) interrupted: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) failure: Option<FailureLine>,
    /// The first start on which an explorer reached a limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) limit: Option<FailureLine>,
    pub(super) holds: bool,
}

/// The first start that was mapped wrongly.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct FailureLine {
    pub(super) cause: String,
    pub(super) moves: Option<u64>,
    world: Value,
    #[serde(flatten)]
    pub(super) run: FailedRun,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(untagged)]
pub(super) enum FailedRun {
    Explorer(ReportedRun),
    Algorithm { step: Option<String> },
}

impl FailureLine {
    /// A failure in a run from a start. `about` describes the start.
    pub(super) fn new(
        cause: String,
        moves: Option<u64>,
        about: &str,
        (graph, facing): (&EmbeddedGraph, Dart),
        run: FailedRun,
    ) -> Self {
        let world = NamedWorld::discovered("failed", about, graph, facing);
        Self { cause, moves, world: world_file::to_json(&world), run }
    }

    fn of_algorithm(algorithm: MappingAlgorithm, failure: &FailedStart) -> Self {
        let FailedStart { graph, facing, flaw, moves, false_step } = failure;
        let after = || moves.map(|moves| format!("after {}", counted(moves as usize, "move")));
        let step = false_step.map(|step| step.to_string()).or_else(after);
        let about = format!("{} fails here: {flaw}", algorithm.info().title);
        let run = FailedRun::Algorithm { step };
        Self::new(flaw.to_string(), *moves, &about, (graph, *facing), run)
    }

    /// The same failure; with the other world of a guess.
    pub(super) fn explained(mut self, marker: AidKind) -> Self {
        if self.cause == ExplorerFault::GUESSED
            && let Some(world) = self.named_world()
            && let (FailedRun::Explorer(run), Some(facing)) = (&mut self.run, world.start)
        {
            run.find_other_world((&world.graph, facing), marker);
        }
        self
    }

    /// The world with its start; `None` if it is not a world.
    pub(super) fn named_world(&self) -> Option<NamedWorld> {
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

/// The sum of some counts is larger than 64 bits hold.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("with this, the sum of `{0}` is 2^64 or more")]
pub(super) struct CountOverflow(&'static str);

impl From<CountOverflow> for CliError {
    fn from(overflow: CountOverflow) -> Self {
        Self::Input(overflow.to_string())
    }
}

impl SizeLine {
    /// The same line with the counts of a check.
    pub(super) fn with_counts<F>(self, tally: &Tally<Option<WorstStart>, F>) -> Self {
        let certificate = |value| self.certificate_total.and(Some(value));
        let mut line = Self {
            worlds: tally.worlds,
            starts: tally.starts,
            mapped: tally.mapped,
            failed: tally.failed(),
            moves_total: tally.moves_total,
            moves_max: tally.moves_max(),
            certificate_total: certificate(tally.certificate_total),
            certificate_max: certificate(tally.certificate_max),
            interrupted: tally.interrupted,
            ..self
        };
        line.set_ratio_and_verdict();
        line
    }

    /// The same line with the counts of an algorithm. `moves_made` are those that were made, if runs share some.
    pub(super) fn of_algorithm(
        self,
        (algorithm, choices): (MappingAlgorithm, RunChoices),
        tally: &Tally,
        moves_made: Option<u64>,
    ) -> Self {
        let below = self.certificate_total.and(Some(tally.below_certificate));
        let mut line = Self {
            algorithm: Some(algorithm.info().title.to_owned()),
            moves_made,
            below_certificate: below,
            largest_ratio: Some(tally.largest_ratio(self.edges, algorithm.info().order)),
            failure: tally.failure.as_ref().map(|it| FailureLine::of_algorithm(algorithm, it)),
            ..self
        };
        if let RunChoices::All { budget } = choices {
            let limits = [("max-states", tally.over_budget), ("memory", tally.over_memory)];
            let reached = limits.into_iter().filter(|(_, count)| *count > 0);
            line = Self {
                states: Some(tally.states),
                runs: Some(tally.runs),
                moves_least: tally.extremes.map(|(least, _)| least),
                moves_most: tally.extremes.map(|(_, most)| most),
                gave_up: Some(tally.gave_up()),
                limits: Some(reached.map(|(limit, count)| (limit.to_owned(), count)).collect()),
                max_states: Some(budget),
                ..line
            };
        }
        line.with_counts(tally)
    }

    fn set_ratio_and_verdict(&mut self) {
        let certificates = self.certificate_total.filter(|&total| total > 0);
        self.ratio = certificates.map(|total| self.moves_total as f64 / total as f64);
        self.holds = self.verdict().0 == Outcome::Holds;
    }

    /// The outcome of a check, and its name. A check does not hold if it is empty or interrupted.
    pub(super) fn verdict(&self) -> (Outcome, &'static str) {
        let is_some = |count: Option<u64>| count.is_some_and(|count| count > 0);
        match () {
            () if self.failed > 0 || is_some(self.below_certificate) => {
                (Outcome::Violated, "violated")
            }
            () if self.interrupted => (Outcome::Incomplete, "not known, interrupted"),
            () if self.starts == 0 => (Outcome::Incomplete, "not known: there is nothing to check"),
            () if is_some(self.gave_up) || is_some(self.unknown) || self.stopped == Some(true) => {
                (Outcome::Incomplete, "not known")
            }
            () => (Outcome::Holds, "holds"),
        }
    }

    pub(super) fn reached(&self, limit: &str) -> u64 {
        self.limits.as_ref().and_then(|limits| limits.get(limit)).copied().unwrap_or_default()
    }

    /// The first thing in which the counts of a line contradict each other.
    pub(super) fn contradiction(&self) -> Option<String> {
        let Self { starts, mapped, failed, moves_total, moves_max, holds: said, .. } = *self;
        let (below, gave_up) = (self.below_certificate, self.gave_up);
        let limits =
            self.limits.iter().flatten().try_fold(0_u64, |sum, (_, &n)| sum.checked_add(n));
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
            () if said != holds => {
                format!("`holds` is {said}, but by the counts it is {holds}")
            }
            () => return None,
        };
        Some(problem)
    }

    /// Adds the result of other starts.
    ///
    /// # Errors
    /// Returns an error if a sum is too large.
    pub(super) fn add(&mut self, other: Self) -> Result<(), CountOverflow> {
        for (sum, count, name) in [
            (&mut self.worlds, other.worlds, "worlds"),
            (&mut self.starts, other.starts, "starts"),
            (&mut self.mapped, other.mapped, "mapped"),
            (&mut self.failed, other.failed, "failed"),
            (&mut self.moves_total, other.moves_total, "moves_total"),
        ] {
            *sum = sum.checked_add(count).ok_or(CountOverflow(name))?;
        }
        for (sum, count, name) in [
            (&mut self.unknown, other.unknown, "unknown"),
            (&mut self.moves_made, other.moves_made, "moves_made"),
            (&mut self.certificate_total, other.certificate_total, "certificate_total"),
            (&mut self.below_certificate, other.below_certificate, "below_certificate"),
            (&mut self.states, other.states, "states"),
            (&mut self.gave_up, other.gave_up, "gave_up"),
        ] {
            if let Some(count) = count {
                let added = sum.unwrap_or_default().checked_add(count);
                *sum = Some(added.ok_or(CountOverflow(name))?);
            }
        }
        for (limit, starts) in other.limits.into_iter().flatten() {
            let known = self.limits.get_or_insert_default().entry(limit).or_default();
            *known = known.checked_add(starts).ok_or(CountOverflow("limits"))?;
        }
        self.moves_max = self.moves_max.max(other.moves_max);
        self.certificate_max = self.certificate_max.max(other.certificate_max);
        self.largest_ratio =
            [self.largest_ratio, other.largest_ratio].into_iter().flatten().max_by(f64::total_cmp);
        self.runs = match (self.runs, other.runs) {
            (Some(one), Some(other)) => Some(one.saturating_add(other)),
            (one, other) => one.or(other),
        };
        self.moves_least = self.moves_least.into_iter().chain(other.moves_least).min();
        self.moves_most = self.moves_most.max(other.moves_most);
        self.stopped = self.stopped.max(other.stopped);
        self.interrupted |= other.interrupted;
        self.failure = match (self.failure.take(), other.failure) {
            (Some(one), Some(other)) => Some(if other.place() < one.place() { other } else { one }),
            (one, other) => one.or(other),
        };
        self.set_ratio_and_verdict();
        Ok(())
    }

    pub(super) fn worlds_in_words(&self) -> String {
        let worlds = match &self.from {
            Some(path) => format!("the worlds of {path}"),
            None => format!("class {}", self.class.as_deref().unwrap_or_default()),
        };
        match &self.shard {
            None => worlds,
            Some(shard) => format!("{worlds}, shard {shard}"),
        }
    }

    pub(super) fn name(&self) -> String {
        format!("{}, {}", counted(self.edges, "edge"), self.worlds_in_words())
    }

    pub(super) fn ci_case(&self) -> CiCase {
        let (mapped, starts) = (grouped(self.mapped.into()), grouped(self.starts.into()));
        let mut message = format!("{mapped} of {starts} starts mapped correctly");
        if let Some(failure) = self.failure.as_ref().or(self.limit.as_ref()) {
            let _ = match &failure.run {
                FailedRun::Algorithm { .. } => {
                    write!(message, "; the first wrong one: {}", failure.cause)
                }
                FailedRun::Explorer(run) => {
                    let what = run.message.as_deref().unwrap_or_default();
                    let what = what.strip_prefix("The explorer ").unwrap_or(what);
                    write!(message, "; on the first other one, the explorer {what}")
                }
            };
        } else if self.interrupted {
            message += "; interrupted";
        } else if self.gave_up.unwrap_or_default() > 0 {
            message += "; the other runs of some starts reached a limit";
        }
        let file = self.from.as_ref().map(Into::into);
        CiCase { name: self.name(), outcome: self.verdict().0, message, file, seconds: None }
    }
}
