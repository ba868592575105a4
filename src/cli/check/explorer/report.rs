//! The report of a check of an explorer that is another program.

use std::{collections::BTreeMap, fmt::Write as _, io::Write, path::Path, time::Duration};

use serde::Serialize;
use serde_json::Value;
use toposlam_model::{
    check::Tally,
    enumerate::Class,
    format::{named_world::NamedWorld, world_file},
    marker::{Directional, Marker},
};

use super::{
    super::report::{mean_and_most, worlds_in_words},
    tally::{ExplorerTally, UnmappedStart},
};
use crate::cli::{
    CliError, Outcome,
    ci_report::CiCase,
    json::{action_json, print_line},
    text::{capital, counted, grouped, print_hanging, print_indented, print_paragraph},
};

/// The result for one number of edges.
pub(super) struct ExplorerSize<'a> {
    pub(super) edges: usize,
    /// The class of the worlds, unless they are from a file.
    pub(super) class: Class,
    pub(super) from: Option<&'a Path>,
    pub(super) tally: &'a ExplorerTally,
}

impl ExplorerSize<'_> {
    /// The worlds, in words.
    fn worlds(&self) -> String {
        worlds_in_words(self.from.map(Path::display), self.class.name())
    }

    /// Its name for CI systems.
    pub(super) fn name(&self) -> String {
        format!("{}, {}", counted(self.edges, "edge"), self.worlds())
    }

    /// The result for CI systems.
    pub(super) fn ci_case(&self) -> CiCase {
        let tally = self.tally;
        let (mapped, starts) =
            (grouped(tally.counts.mapped.into()), grouped(tally.counts.starts.into()));
        let mut message = format!("{mapped} of {starts} starts mapped correctly");
        if let Some(start) = tally.counts.failure.as_ref().or(tally.limit.as_ref()) {
            let _ = write!(message, "; on the first other one, the explorer {}", start.fault);
        } else if tally.counts.interrupted {
            message += "; interrupted";
        }
        CiCase {
            name: self.name(),
            outcome: tally.verdict().0,
            message,
            file: self.from.map(Path::to_owned),
        }
    }
}

/// The start as a world.
pub(super) fn failed_world(explorer: &str, start: &UnmappedStart) -> NamedWorld {
    let about = format!("The explorer {explorer} does not map it: {}", start.fault.name());
    NamedWorld::discovered("failed", &about, &start.graph, start.facing)
}

/// Prints each result when it is there.
pub(super) struct ExplorerReport<'o> {
    out: &'o mut dyn Write,
    json: bool,
    explorer: &'o str,
    marker: &'static dyn Marker,
    header: bool,
    total: ExplorerTally,
}

impl<'o> ExplorerReport<'o> {
    pub(super) fn new(
        out: &'o mut dyn Write,
        json: bool,
        explorer: &'o str,
        marker: &'static dyn Marker,
    ) -> Self {
        Self { out, json, explorer, marker, header: false, total: ExplorerTally::default() }
    }

    fn has_certificates(&self) -> bool {
        self.marker.name() == Directional.name()
    }

    /// Prints the result for one number of edges.
    pub(super) fn size(&mut self, size: &ExplorerSize) -> Result<(), CliError> {
        if self.json {
            let line = ExplorerLine::new(size, self.explorer, self.marker);
            print_line(self.out, "explorer-size", &line)?;
        } else {
            self.row(size)?;
        }
        self.out.flush()?;
        self.total.merge(size.tally.clone());
        Ok(())
    }

    fn header(&mut self, size: &ExplorerSize) -> Result<(), CliError> {
        let marker = self.marker.name();
        let head = format!("Explorer {}, {marker} marker, {}", self.explorer, size.worlds());
        print_paragraph(self.out, &head)?;
        let certificates = if self.has_certificates() { "  certificate  ratio" } else { "" };
        writeln!(
            self.out,
            "\n{:>5}  {:>8}  {:>10}  {:>6}  {:>7}  {:>14}{certificates}",
            "edges", "worlds", "starts", "failed", "unknown", "mean/max moves",
        )?;
        Ok(())
    }

    fn row(&mut self, size: &ExplorerSize) -> Result<(), CliError> {
        let &ExplorerSize { edges, tally, .. } = size;
        if !std::mem::replace(&mut self.header, true) {
            self.header(size)?;
        }
        let mean_and_most = |total, most| mean_and_most(total, tally.counts.mapped, most);
        let certificates = match tally.ratio() {
            Some(ratio) => {
                let certificate =
                    mean_and_most(tally.counts.certificate_total, tally.counts.certificate_max);
                format!("  {certificate:>11}  {ratio:>5.2}")
            }
            None => String::new(),
        };
        writeln!(
            self.out,
            "{edges:>5}  {:>8}  {:>10}  {:>6}  {:>7}  {:>14}{certificates}",
            grouped(tally.counts.worlds.into()),
            grouped(tally.counts.starts.into()),
            grouped(tally.counts.failed().into()),
            grouped(tally.counts.unknown.into()),
            mean_and_most(tally.counts.moves_total, tally.counts.moves_max()),
        )?;
        if !tally.causes.is_empty() {
            let causes = tally.causes.iter();
            let causes: Vec<_> = causes
                .map(|(cause, &count)| format!("{cause} {}", grouped(count.into())))
                .collect();
            print_hanging(self.out, "       causes: ", &causes.join(", "))?;
        }
        if tally.stopped {
            let ended = counted(tally.processes_ended as usize, "run");
            writeln!(self.out, "       stopped: {ended} ended their process (--restarts)")?;
        }
        if tally.counts.interrupted {
            writeln!(self.out, "       interrupted")?;
        }
        match (&tally.counts.failure, &tally.limit) {
            (Some(start), _) => self.unmapped("failed", start),
            (None, Some(start)) => self.unmapped("reached a limit", start),
            (None, None) => Ok(()),
        }
    }

    /// Prints a start that was not mapped, and what the explorer did there.
    fn unmapped(&mut self, what: &str, start: &UnmappedStart) -> Result<(), CliError> {
        let UnmappedStart { fault, moves, actions, stderr, .. } = start;
        writeln!(self.out)?;
        let moves = counted(*moves as usize, "move");
        print_paragraph(
            self.out,
            &format!("The first start on which the explorer {what}. After {moves}, it {fault}."),
        )?;
        if !actions.is_empty() {
            let actions: Vec<_> = actions.iter().map(ToString::to_string).collect();
            print_hanging(self.out, "  last doors  ", &actions.join(" "))?;
        }
        if !stderr.is_empty() {
            writeln!(self.out, "  the end of its standard error:")?;
            for line in stderr.lines() {
                let plain = line.replace(char::is_control, " ");
                print_indented(self.out, "    ", 4, plain.trim_end())?;
            }
        }
        print_paragraph(self.out, "The start, as a world file:")?;
        let world = failed_world(self.explorer, start);
        writeln!(self.out, "\n{}", world_file::to_toml(&world))?;
        Ok(())
    }

    /// Prints the verdict and returns the outcome.
    pub(super) fn verdict(self, elapsed: Duration) -> Result<Outcome, CliError> {
        let (outcome, verdict) = self.total.verdict();
        let Tally { starts, mapped, unknown, .. } = self.total.counts;
        if self.json {
            return Ok(outcome);
        }
        let mut verdict = verdict.to_owned();
        if starts > 0 {
            let (mapped, starts) = (grouped(mapped.into()), grouped(starts.into()));
            let _ = write!(verdict, ": {mapped} of {starts} starts mapped correctly, ");
            verdict += "each proved by a bijection";
        }
        if unknown > 0 {
            let _ = write!(verdict, "; on {}, a limit was reached", grouped(unknown.into()));
        }
        if let Some(ratio) = self.total.ratio() {
            let _ = write!(verdict, "; {ratio:.2} times the moves of the certificates");
        }
        writeln!(self.out)?;
        print_paragraph(self.out, &verdict)?;
        let processes = rayon::current_num_threads();
        remark!("{:.2} s with {processes} processes at once", elapsed.as_secs_f64());
        Ok(outcome)
    }
}

/// A line of `--json`, for one number of edges.
#[derive(Serialize)]
struct ExplorerLine<'a> {
    edges: usize,
    /// `None` if the worlds are from a file.
    class: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    from: Option<String>,
    marker: &'a str,
    explorer: &'a str,
    worlds: u64,
    starts: u64,
    mapped: u64,
    failed: u64,
    unknown: u64,
    moves_total: u64,
    moves_max: u64,
    #[serde(flatten)]
    certificates: Option<RatioLine>,
    causes: &'a BTreeMap<&'static str, u64>,
    stopped: bool,
    interrupted: bool,
    failure: Option<UnmappedLine>,
    limit: Option<UnmappedLine>,
    verdict: &'static str,
    holds: bool,
}

/// With a directional marker: the certificates of the starts that were mapped correctly.
#[derive(Serialize)]
struct RatioLine {
    certificate_total: u64,
    certificate_max: u64,
    ratio: Option<f64>,
}

/// A start that was not mapped.
#[derive(Serialize)]
struct UnmappedLine {
    cause: &'static str,
    message: String,
    moves: u64,
    last_actions: Vec<Value>,
    stderr: String,
    world: Value,
}

impl<'a> ExplorerLine<'a> {
    fn new(size: &ExplorerSize<'a>, explorer: &'a str, marker: &'static dyn Marker) -> Self {
        let &ExplorerSize { edges, class, from, tally } = size;
        let unmapped = |start: &UnmappedStart| UnmappedLine {
            cause: start.fault.name(),
            message: capital(&format!("the explorer {}", start.fault)),
            moves: start.moves,
            last_actions: start.actions.iter().map(|&action| action_json(action)).collect(),
            stderr: start.stderr.clone(),
            world: world_file::to_json(&failed_world(explorer, start)),
        };
        Self {
            edges,
            class: from.is_none().then(|| class.name()),
            from: from.map(|path| path.display().to_string()),
            marker: marker.name(),
            explorer,
            worlds: tally.counts.worlds,
            starts: tally.counts.starts,
            mapped: tally.counts.mapped,
            failed: tally.counts.failed(),
            unknown: tally.counts.unknown,
            moves_total: tally.counts.moves_total,
            moves_max: tally.counts.moves_max(),
            certificates: (marker.name() == Directional.name()).then(|| RatioLine {
                certificate_total: tally.counts.certificate_total,
                certificate_max: tally.counts.certificate_max,
                ratio: tally.ratio(),
            }),
            causes: &tally.causes,
            stopped: tally.stopped,
            interrupted: tally.counts.interrupted,
            failure: tally.counts.failure.as_ref().map(unmapped),
            limit: tally.limit.as_ref().map(unmapped),
            verdict: tally.verdict().0.verdict(),
            holds: tally.verdict().0 == Outcome::Holds,
        }
    }
}
