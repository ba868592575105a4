//! The report of a check: a row or a JSON object for each number of edges, and the verdict.

use std::{collections::BTreeMap, fmt::Write as _, io::Write, path::Path, time::Duration};

use serde::Serialize;
use toposlam_model::{
    check::{CostOrder, FailedStart, MappingAlgorithm, Shard, Tally},
    enumerate::Class,
    format::{named_world::NamedWorld, world_file},
    marker::{Directional, Marker},
};

use crate::cli::{
    CliError, Outcome, RunChoices,
    ci_report::CiCase,
    json::print_line,
    text::{grouped, print_hanging, print_paragraph},
};

/// The algorithm that is checked, and its marker.
#[derive(Clone, Copy)]
pub(super) struct AlgorithmInfo {
    algorithm: &'static str,
    marker: &'static str,
    /// Whether the starts have certificates.
    certificates: bool,
    /// The order of its cost.
    order: CostOrder,
}

impl AlgorithmInfo {
    pub(super) fn of(algorithm: &MappingAlgorithm) -> Self {
        Self {
            algorithm: algorithm.name(),
            marker: algorithm.marker().name(),
            certificates: *algorithm.marker() == *(&Directional as &dyn Marker),
            order: algorithm.order(),
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
}

impl SizeResult<'_> {
    /// The worlds, in words.
    fn worlds(&self) -> String {
        let worlds = match self.from {
            Some(path) => format!("the worlds of {}", path.display()),
            None => format!("class {}", self.class),
        };
        match self.shard {
            Shard::WHOLE => worlds,
            shard => format!("{worlds}, shard {shard}"),
        }
    }

    /// The result for CI systems.
    pub(super) fn ci_case(&self) -> CiCase {
        let tally = self.tally;
        let (mapped, starts) = (grouped(tally.mapped.into()), grouped(tally.starts.into()));
        let mut message = format!("{mapped} of {starts} starts mapped correctly");
        if let Some(failure) = &tally.failure {
            let _ = write!(message, "; the first wrong one: {}", failure.flaw);
        } else if tally.interrupted {
            message += "; interrupted";
        } else if tally.gave_up() > 0 {
            message += "; the other runs of some starts reached a limit";
        }
        let file = self.from.map(Path::to_owned);
        CiCase { name: self.name(), outcome: verdict(tally).0, message, file }
    }

    /// What is checked.
    pub(super) fn name(&self) -> String {
        format!("{} edges, {}", self.edges, self.worlds())
    }
}

/// The outcome of a check, and its name. A check does not hold if it is empty or interrupted.
fn verdict(tally: &Tally) -> (Outcome, &'static str) {
    match () {
        () if tally.mapped < tally.starts || tally.below_certificate > 0 => {
            (Outcome::Violated, "violated")
        }
        () if tally.interrupted => (Outcome::Incomplete, "incomplete, interrupted"),
        () if tally.starts == 0 => (Outcome::Incomplete, "incomplete: there is nothing to check"),
        () if tally.gave_up() > 0 => (Outcome::Incomplete, "incomplete"),
        () => (Outcome::Holds, "holds"),
    }
}

/// The mean over the starts, and the largest value.
fn mean_and_most(tally: &Tally, total: u64, most: u64) -> String {
    format!("{:.1}/{}", total as f64 / tally.starts.max(1) as f64, grouped(most.into()))
}

/// Prints each result when it is there.
pub(super) struct CheckReport<'o> {
    out: &'o mut dyn Write,
    json: bool,
    subject: AlgorithmInfo,
    choice: RunChoices,
    header: bool,
    total: Tally,
}

impl<'o> CheckReport<'o> {
    pub(super) fn new(
        out: &'o mut dyn Write,
        json: bool,
        subject: AlgorithmInfo,
        choice: RunChoices,
    ) -> Self {
        Self { out, json, subject, choice, header: false, total: Tally::default() }
    }

    /// Prints the result for one number of edges.
    pub(super) fn size(&mut self, size: &SizeResult) -> Result<(), CliError> {
        if self.json {
            let line = Line::new(size, self.subject, self.choice);
            print_line(self.out, "size", &line)?;
        } else {
            self.row(size)?;
        }
        self.out.flush()?;
        self.total.merge(size.tally.clone());
        Ok(())
    }

    fn header(&mut self, size: &SizeResult) -> Result<(), CliError> {
        let AlgorithmInfo { algorithm, marker, certificates, order } = self.subject;
        let head = format!("{algorithm}, {marker} marker, {}", size.worlds());
        print_paragraph(self.out, &head)?;
        writeln!(
            self.out,
            "\n{:>5} {:>10}  {:>12}  {:>6}  {:>14}{}  {:>11}",
            "edges",
            "worlds",
            "starts",
            "failed",
            "mean/max moves",
            if certificates { "  certificate" } else { "" },
            format!("max/({order})"),
        )?;
        Ok(())
    }

    fn row(&mut self, size: &SizeResult) -> Result<(), CliError> {
        let &SizeResult { edges, tally, .. } = size;
        if !std::mem::replace(&mut self.header, true) {
            self.header(size)?;
        }
        let certificate = if self.subject.certificates {
            let certificate = mean_and_most(tally, tally.certificate_total, tally.certificate_max);
            format!("  {certificate:>11}")
        } else {
            String::new()
        };
        writeln!(
            self.out,
            "{edges:>5} {:>10}  {:>12}  {:>6}  {:>14}{certificate}  {:>11.3}",
            grouped(tally.worlds.into()),
            grouped(tally.starts.into()),
            grouped(tally.failed().into()),
            mean_and_most(tally, tally.moves_total, tally.moves_max()),
            tally.largest_ratio(edges, self.subject.order),
        )?;
        if self.choice != RunChoices::Default {
            let (least, most) = tally.extremes.unwrap_or_default();
            let at_least =
                if tally.runs == u128::MAX || tally.gave_up() > 0 { "at least " } else { "" };
            let all = format!(
                "{} states, {at_least}{} runs of {} to {} moves",
                grouped(tally.states.into()),
                grouped(tally.runs),
                grouped(least.into()),
                grouped(most.into()),
            );
            print_hanging(self.out, "       all choices: ", &all)?;
        }
        if tally.interrupted {
            writeln!(self.out, "       interrupted")?;
        }
        if let Some(failure) = &tally.failure {
            let step = step(failure).map_or(String::new(), |step| format!(" {step}"));
            writeln!(self.out)?;
            print_paragraph(self.out, &format!("Wrong{step}: {}", failure.flaw))?;
            let explore = format!("toposlam explore --marker {}", self.subject.marker);
            print_paragraph(self.out, &format!("The start, as a world file for `{explore}`:"))?;
            writeln!(self.out, "\n{}", world_file::to_toml(&failed_world(failure, self.subject)))?;
        }
        Ok(())
    }

    /// Prints the verdict and returns the outcome.
    pub(super) fn verdict(self, elapsed: Duration) -> Result<Outcome, CliError> {
        let (outcome, verdict) = verdict(&self.total);
        let Tally { starts, mapped, below_certificate, over_budget, over_memory, .. } = self.total;
        if self.json {
            return Ok(outcome);
        }
        let mut verdict = verdict.to_owned();
        if starts > 0 {
            let (mapped, starts) = (grouped(mapped.into()), grouped(starts.into()));
            let _ = write!(verdict, ": {mapped} of {starts} starts mapped correctly, ");
            verdict += "each proved by a bijection";
        }
        if below_certificate > 0 {
            let starts = grouped(below_certificate.into());
            let _ = write!(verdict, "; {starts} in fewer moves than their certificates have");
        }
        if over_budget > 0 {
            let starts = grouped(over_budget.into());
            let _ = write!(verdict, "; {starts} have more states than --max-states");
        }
        if over_memory > 0 {
            let starts = grouped(over_memory.into());
            let _ = write!(verdict, "; the states of {starts} need more than 1 GiB of memory");
        }
        writeln!(self.out)?;
        print_paragraph(self.out, &verdict)?;
        remark!("{:.2} s on {} threads", elapsed.as_secs_f64(), rayon::current_num_threads());
        Ok(outcome)
    }
}

/// A line of `--json`, for one number of edges.
#[derive(Serialize)]
struct Line<'a> {
    edges: usize,
    /// `None` if the worlds are from a file.
    class: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    from: Option<String>,
    marker: &'a str,
    worlds: u64,
    starts: u64,
    mapped: u64,
    failed: u64,
    moves_total: u64,
    moves_max: u64,
    #[serde(flatten)]
    certificates: Option<CertificatesLine>,
    largest_ratio: f64,
    #[serde(flatten)]
    every_way: Option<EveryWayLine>,
    #[serde(skip_serializing_if = "Option::is_none")]
    shard: Option<String>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    interrupted: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    failure: Option<FailureLine>,
    holds: bool,
}

/// With a directional marker: the lengths of the certificates of the starts.
#[derive(Serialize)]
struct CertificatesLine {
    certificate_total: u64,
    certificate_max: u64,
    below_certificate: u64,
}

/// With all choices: distinct states, runs, and the fewest and the most moves of a run.
#[derive(Serialize)]
struct EveryWayLine {
    states: u64,
    runs: u128,
    moves_least: Option<u64>,
    moves_most: Option<u64>,
    /// Starts with runs that were not tried.
    gave_up: u64,
    /// Those with more states than `--max-states`, and those with more than fit in memory.
    limits: BTreeMap<&'static str, u64>,
}

/// The first start that was mapped wrongly.
#[derive(Serialize)]
struct FailureLine {
    cause: String,
    step: Option<String>,
    moves: Option<u64>,
    world: serde_json::Value,
}

impl<'a> Line<'a> {
    fn new(size: &SizeResult<'a>, subject: AlgorithmInfo, choice: RunChoices) -> Self {
        let &SizeResult { edges, class, from, shard, tally } = size;
        Self {
            edges,
            class: from.is_none().then(|| class.name()),
            from: from.map(|path| path.display().to_string()),
            marker: subject.marker,
            worlds: tally.worlds,
            starts: tally.starts,
            mapped: tally.mapped,
            failed: tally.failed(),
            moves_total: tally.moves_total,
            moves_max: tally.moves_max(),
            certificates: subject.certificates.then_some(CertificatesLine {
                certificate_total: tally.certificate_total,
                certificate_max: tally.certificate_max,
                below_certificate: tally.below_certificate,
            }),
            largest_ratio: tally.largest_ratio(edges, subject.order),
            every_way: (choice != RunChoices::Default).then(|| EveryWayLine {
                states: tally.states,
                runs: tally.runs,
                moves_least: tally.extremes.map(|(least, _)| least),
                moves_most: tally.extremes.map(|(_, most)| most),
                gave_up: tally.gave_up(),
                limits: limits(tally),
            }),
            shard: (shard != Shard::WHOLE).then(|| shard.to_string()),
            interrupted: tally.interrupted,
            failure: tally.failure.as_ref().map(|failure| FailureLine {
                cause: failure.flaw.to_string(),
                step: step(failure),
                moves: failure.moves,
                world: world_file::to_json(&failed_world(failure, subject)),
            }),
            holds: verdict(tally).0 == Outcome::Holds,
        }
    }
}

/// The number of starts that reached each limit on the search for all runs.
fn limits(tally: &Tally) -> BTreeMap<&'static str, u64> {
    let counts = [("max-states", tally.over_budget), ("memory", tally.over_memory)];
    counts.into_iter().filter(|(_, count)| *count > 0).collect()
}

fn failed_world(failure: &FailedStart, subject: AlgorithmInfo) -> NamedWorld {
    let about = format!("{} fails here: {}", subject.algorithm, failure.flaw);
    NamedWorld::discovered("failed", &about, &failure.graph, failure.facing)
}

/// The step at which the run went wrong, if it is known.
fn step(failure: &FailedStart) -> Option<String> {
    let step = failure.false_step.map(|step| step.to_string());
    step.or_else(|| failure.moves.map(|moves| format!("after {moves} moves")))
}

#[cfg(test)]
mod tests {

    use super::*;

    #[test]
    fn more_runs_than_64_bits_hold_are_printed_exactly() {
        let tally = Tally { runs: u128::MAX, extremes: Some((1, 2)), ..Tally::default() };
        let (class, shard) = (Class::Simple, Shard::WHOLE);
        let size = SizeResult { edges: 1, class, from: None, shard, tally: &tally };
        let subject = AlgorithmInfo::of(&MappingAlgorithm::Algorithm1);
        let mut line = Vec::new();
        print_line(&mut line, "size", &Line::new(&size, subject, RunChoices::All { budget: 9 }))
            .unwrap();
        let line = String::from_utf8(line).unwrap();
        assert!(line.contains(r#""runs":340282366920938463463374607431768211455,"#), "{line}");
    }
}
