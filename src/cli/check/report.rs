//! What a check prints: a row, or a JSON object, for each number of edges, and a verdict.

use std::{
    io::{self, Write},
    time::Duration,
};

use serde::Serialize;
use toposlam_model::{
    check::{Choice, Failure as Failed, Shard, Tally},
    format::{named_world::NamedWorld, world_file},
};

use crate::cli::{Failure, Outcome};

/// What was checked of one number of edges.
pub(super) struct Size<'a> {
    pub(super) edges: usize,
    /// The class of worlds, or the file that they are from.
    pub(super) class: &'a str,
    /// The share of them.
    pub(super) shard: Shard,
    pub(super) tally: &'a Tally,
}

/// Prints as it goes.
pub(super) struct Report<'o> {
    out: &'o mut dyn Write,
    json: bool,
    choice: Choice,
    header: bool,
    total: Tally,
}

impl<'o> Report<'o> {
    pub(super) fn new(out: &'o mut dyn Write, json: bool, choice: Choice) -> Self {
        Self { out, json, choice, header: false, total: Tally::default() }
    }

    /// One number of edges.
    pub(super) fn size(&mut self, size: &Size) -> Result<(), Failure> {
        if self.json {
            self.json_line(size)?;
        } else {
            self.row(size)?;
        }
        self.out.flush()?;
        self.total.merge(size.tally.clone());
        Ok(())
    }

    fn json_line(&mut self, size: &Size) -> Result<(), Failure> {
        let &Size { edges, class, shard, tally } = size;
        let extremes = tally.extremes.filter(|_| self.choice == Choice::All);
        let line = Line {
            schema: 1,
            edges,
            class,
            marker: "directional",
            worlds: tally.worlds,
            starts: tally.starts,
            mapped: tally.mapped,
            failed: tally.failed(),
            moves_total: tally.moves_total,
            moves_max: tally.moves_max(),
            largest_ratio: tally.largest_ratio(edges),
            every_way: extremes.map(|(moves_least, moves_most)| EveryWayLine {
                states: tally.states,
                runs: tally.runs,
                moves_least,
                moves_most,
            }),
            shard: (shard != Shard::WHOLE).then(|| shard.to_string()),
            interrupted: tally.interrupted,
            failure: tally.failure.as_ref().map(|failure| FailureLine {
                cause: failure.flaw.to_string(),
                step: step(failure),
                moves: failure.moves,
                world: world_file::to_json(&failed_world(failure)),
            }),
            holds: holds(tally),
        };
        serde_json::to_writer(&mut self.out, &line).map_err(io::Error::from)?;
        writeln!(self.out)?;
        Ok(())
    }

    fn row(&mut self, size: &Size) -> Result<(), Failure> {
        let &Size { edges, class, shard, tally } = size;
        let all = self.choice == Choice::All;
        if !std::mem::replace(&mut self.header, true) {
            let share = match shard {
                Shard::WHOLE => String::new(),
                shard => format!(", shard {shard}"),
            };
            writeln!(self.out, "Algorithm 1, directional marker, class {class}{share}\n")?;
            write!(
                self.out,
                "{:>5}  {:>11}  {:>12}  {:>12}  {:>6}  {:>6}  {:>5}  {:>12}",
                "edges", "worlds", "starts", "mapped", "failed", "mean", "most", "most/(m^2 n)"
            )?;
            if all {
                write!(self.out, "  {:>11}  {:>20}  {:>11}", "states", "runs", "any run")?;
            }
            writeln!(self.out)?;
        }
        write!(
            self.out,
            "{edges:>5}  {:>11}  {:>12}  {:>12}  {:>6}  {:>6.1}  {:>5}  {:>12.3}",
            grouped(tally.worlds.into()),
            grouped(tally.starts.into()),
            grouped(tally.mapped.into()),
            grouped(tally.failed().into()),
            tally.moves_total as f64 / tally.starts.max(1) as f64,
            tally.moves_max(),
            tally.largest_ratio(edges),
        )?;
        if all {
            let (least, most) = tally.extremes.unwrap_or_default();
            write!(
                self.out,
                "  {:>11}  {:>20}  {:>11}",
                grouped(tally.states.into()),
                grouped(tally.runs),
                format!("{least} to {most}"),
            )?;
        }
        writeln!(self.out, "{}", if tally.interrupted { "  (interrupted)" } else { "" })?;
        if let Some(failure) = &tally.failure {
            writeln!(self.out, "\nWrong {}: {}", step(failure), failure.flaw)?;
            writeln!(self.out, "The start, as a world file for `toposlam explore`:\n")?;
            writeln!(self.out, "{}", world_file::to_toml(&failed_world(failure)))?;
        }
        Ok(())
    }

    /// The last line, and the outcome.
    pub(super) fn verdict(self, elapsed: Duration) -> Result<Outcome, Failure> {
        let total = self.total;
        let outcome = match () {
            () if total.failed() > 0 => Outcome::Violated,
            () if total.interrupted || total.starts == 0 => Outcome::Incomplete,
            () => Outcome::Holds,
        };
        let verdict = match outcome {
            Outcome::Holds => "holds",
            Outcome::Violated => "violated",
            Outcome::Incomplete if total.interrupted => "incomplete, interrupted",
            Outcome::Incomplete => "incomplete, there was nothing to check",
        };
        if !self.json {
            writeln!(
                self.out,
                "\n{verdict}: {} of {} starts mapped right, each map proved by a bijection",
                grouped(total.mapped.into()),
                grouped(total.starts.into()),
            )?;
        }
        eprintln!("{:.2} s on {} threads", elapsed.as_secs_f64(), rayon::current_num_threads());
        Ok(outcome)
    }
}

/// What `--json` prints for a number of edges.
#[derive(Serialize)]
struct Line<'a> {
    schema: u32,
    edges: usize,
    class: &'a str,
    marker: &'a str,
    worlds: u64,
    starts: u64,
    mapped: u64,
    failed: u64,
    moves_total: u64,
    moves_max: u64,
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

/// With all choices: distinct states, runs, and the fewest and most moves of any run.
#[derive(Serialize)]
struct EveryWayLine {
    states: u64,
    runs: u128,
    moves_least: u64,
    moves_most: u64,
}

/// The first start that was mapped wrongly.
#[derive(Serialize)]
struct FailureLine {
    cause: String,
    step: String,
    moves: u64,
    world: serde_json::Value,
}

/// An empty check never holds, and one that was broken off does not either.
fn holds(tally: &Tally) -> bool {
    tally.failed() == 0 && tally.starts > 0 && !tally.interrupted
}

fn failed_world(failure: &Failed) -> NamedWorld {
    let about = format!("Algorithm 1 fails here: {}", failure.flaw);
    NamedWorld::discovered("failed", &about, &failure.graph, failure.facing)
}

/// The step at which it went wrong.
fn step(failure: &Failed) -> String {
    failure.false_step.map_or_else(|| format!("after {} moves", failure.moves), |s| s.to_string())
}

/// A number with a comma between thousands.
fn grouped(number: u128) -> String {
    let digits = number.to_string();
    let mut out = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_grouped() {
        let texts = [0, 12, 123, 1234, 123_456, 1_234_567].map(grouped);
        assert_eq!(texts, ["0", "12", "123", "1,234", "123,456", "1,234,567"]);
    }

    #[test]
    fn runs_beyond_64_bits_are_printed_whole() {
        let mut out = Vec::new();
        let mut report = Report::new(&mut out, true, Choice::All);
        let tally = Tally { runs: u128::MAX, extremes: Some((1, 2)), ..Tally::default() };
        report.size(&Size { edges: 1, class: "file", shard: Shard::WHOLE, tally: &tally }).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert!(text.contains(r#""runs":340282366920938463463374607431768211455,"#), "{text}");
    }
}
