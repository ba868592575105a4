//! What a check prints: a row, or a JSON object, for each number of edges, and a verdict.

use std::{io::Write, time::Duration};

use serde_json::json;
use toposlam_model::{
    check::{Choice, Failure as Failed, Shard, Tally},
    format::{named_world::NamedWorld, world_file},
};

use crate::cli::{Failure, Outcome};

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
    pub(super) fn size(
        &mut self,
        edges: usize,
        class: &str,
        shard: Option<Shard>,
        tally: &Tally,
    ) -> Result<(), Failure> {
        if self.json {
            self.json_line(edges, class, shard, tally)?;
        } else {
            self.row(edges, class, shard, tally)?;
        }
        self.out.flush()?;
        self.total.merge(tally.clone());
        Ok(())
    }

    fn json_line(
        &mut self,
        edges: usize,
        class: &str,
        shard: Option<Shard>,
        tally: &Tally,
    ) -> Result<(), Failure> {
        let mut line = json!({
            "schema": 1,
            "edges": edges,
            "class": class,
            "marker": "directional",
            "worlds": tally.worlds,
            "starts": tally.starts,
            "mapped": tally.mapped,
            "failed": tally.failed(),
            "moves_total": tally.moves_total,
            "moves_max": tally.moves_max(),
            "largest_ratio": tally.largest_ratio(edges),
            "holds": holds(tally),
        });
        if let Some(shard) = shard.filter(|&shard| shard != Shard::WHOLE) {
            line["shard"] = json!(shard.to_string());
        }
        if tally.interrupted {
            line["interrupted"] = json!(true);
        }
        if let (Choice::All, Some((least, most))) = (self.choice, tally.extremes) {
            line["states"] = json!(tally.states);
            // As in `explore --json`: more than a JSON number can be trusted with.
            line["runs"] = json!(tally.runs.to_string());
            line["every_run_moves_min"] = json!(least);
            line["every_run_moves_max"] = json!(most);
        }
        if let Some(failure) = &tally.failure {
            line["failure"] = json!({
                "cause": failure.flaw.to_string(),
                "step": step(failure),
                "moves": failure.moves,
                "world": world_file::to_json(&failed_world(failure)),
            });
        }
        writeln!(self.out, "{line}")?;
        Ok(())
    }

    fn row(
        &mut self,
        edges: usize,
        class: &str,
        shard: Option<Shard>,
        tally: &Tally,
    ) -> Result<(), Failure> {
        let all = self.choice == Choice::All;
        if !std::mem::replace(&mut self.header, true) {
            let share = shard.filter(|&shard| shard != Shard::WHOLE);
            let share = share.map_or(String::new(), |shard| format!(", shard {shard}"));
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

/// An empty check never holds, and one that was broken off does not either.
fn holds(tally: &Tally) -> bool {
    tally.failed() == 0 && tally.starts > 0 && !tally.interrupted
}

fn failed_world(failure: &Failed) -> NamedWorld {
    let about = format!("Algorithm 1 fails here: {}", failure.flaw);
    NamedWorld::discovered("failed", &about, &failure.graph, Some(failure.facing))
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
