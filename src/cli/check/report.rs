//! The report of a check: a row or a JSON object for each number of edges, and the verdict.

use std::{fmt::Write as _, io::Write, time::Duration};

use serde::Serialize;
use serde_json::{Value, json};
use toposlam_model::{
    format::world_file,
    mapping::{CostOrder, MappingAlgorithm},
    marker::named,
};

use super::line::{FailedRun, FailureLine, SizeLine};
use crate::cli::{
    CliError, Outcome,
    cluster::ClusterSession,
    json::print_line,
    text::{counted, grouped, print_hanging, print_paragraph},
};

/// A line of `--json`: the counts, and the verdict that follows from them.
#[derive(Serialize)]
struct PrintedSize<'l> {
    #[serde(flatten)]
    line: &'l SizeLine,
    verdict: &'static str,
}

pub(super) struct CheckReport<'o> {
    out: &'o mut dyn Write,
    json: bool,
    /// That of the algorithm's cost; `None` if an explorer is checked.
    order: Option<CostOrder>,
    total: SizeLine,
    has_head: bool,
}

/// The head of a column, its width and its cell.
type Cell = (String, usize, String);

impl<'o> CheckReport<'o> {
    pub(super) fn new(out: &'o mut dyn Write, json: bool, order: Option<CostOrder>) -> Self {
        Self { out, json, order, total: SizeLine::default(), has_head: false }
    }

    /// Prints the result for one number of edges.
    pub(super) fn size(&mut self, line: SizeLine) -> Result<(), CliError> {
        if self.json {
            self.print_object(&line)?;
        } else {
            self.row(&line)?;
        }
        self.out.flush()?;
        Ok(self.total.add(line)?)
    }

    pub(super) fn threads(
        &mut self,
        cluster: &mut Box<dyn ClusterSession>,
        work: &str,
    ) -> Result<(), CliError> {
        cluster.report(self.out, self.json, work)
    }

    fn print_object(&mut self, line: &SizeLine) -> Result<(), CliError> {
        let printed = PrintedSize { line, verdict: line.verdict().0.verdict() };
        if line.explorer.is_none() {
            return print_line(self.out, "size", &printed);
        }
        // A line of an explorer has all its keys.
        let mut object = json!(printed);
        let keys =
            [("failure", Value::Null), ("limit", Value::Null), ("interrupted", false.into())];
        let ratio = line.certificate_total.map(|_| ("ratio", Value::Null));
        if let Value::Object(fields) = &mut object {
            for (key, absent) in keys.into_iter().chain(ratio) {
                fields.entry(key).or_insert(absent);
            }
        }
        print_line(self.out, "explorer-size", &object)
    }

    fn cells(&self, line: &SizeLine) -> Vec<Cell> {
        let is_explorer = line.explorer.is_some();
        let count = |head: &str, width, number: u64| -> Cell {
            (head.to_owned(), width, grouped(number.into()))
        };
        let of = if is_explorer { line.mapped } else { line.starts };
        let mean_and_most = |total: u64, most: u64| {
            format!("{:.1}/{}", total as f64 / of.max(1) as f64, grouped(most.into()))
        };
        let moves = mean_and_most(line.moves_total, line.moves_max);
        let [worlds, starts] = if is_explorer { [10, 12] } else { [11, 14] };
        let mut cells = vec![
            count("edges", 5, line.edges as u64),
            count("worlds", worlds, line.worlds),
            count("starts", starts, line.starts),
            count("failed", 8, line.failed),
        ];
        cells.extend(line.unknown.map(|unknown| count("unknown", 9, unknown)));
        cells.push(("mean/max moves".to_owned(), 16, moves));
        if let (Some(total), Some(most)) = (line.certificate_total, line.certificate_max) {
            let cell = match line.ratio {
                None if is_explorer => [String::new(), String::new()],
                None => [mean_and_most(total, most), "-".to_owned()],
                Some(ratio) => [mean_and_most(total, most), format!("{ratio:.2}")],
            };
            let [certificate, ratio] = cell;
            cells.push(("certificate".to_owned(), 13, certificate));
            cells.push(("ratio".to_owned(), 7, ratio));
        } else if let (Some(order), Some(ratio)) = (self.order, line.largest_ratio) {
            cells.push((format!("max/({order})"), 13, format!("{ratio:.3}")));
        }
        cells
    }

    fn row(&mut self, line: &SizeLine) -> Result<(), CliError> {
        let cells = self.cells(line);
        if !std::mem::replace(&mut self.has_head, true) {
            let mapper = match (&line.algorithm, &line.explorer) {
                (Some(algorithm), _) => algorithm.clone(),
                (None, explorer) => format!("Explorer {}", explorer.as_deref().unwrap_or_default()),
            };
            let worlds = line.worlds_in_words();
            print_paragraph(self.out, &format!("{mapper}, {} marker, {worlds}", line.marker))?;
            let heads = cells.iter().map(|(head, width, _)| format!("{head:>width$}"));
            writeln!(self.out, "\n{}", heads.collect::<String>())?;
        }
        writeln!(self.out, "{}", row_text(&cells).trim_end())?;
        if let Some(runs) = line.runs {
            let some = runs == u128::MAX || line.gave_up.unwrap_or_default() > 0;
            let number = |count: Option<u64>| grouped(count.unwrap_or_default().into());
            let all = format!(
                "{} states, {}{} runs of {} to {} moves",
                number(line.states),
                if some { "at least " } else { "" },
                grouped(runs),
                number(line.moves_least),
                number(line.moves_most),
            );
            print_hanging(self.out, "       all choices: ", &all)?;
        }
        let causes = line.causes.iter().flatten();
        let causes: Vec<_> =
            causes.map(|(cause, &count)| format!("{cause} {}", grouped(count.into()))).collect();
        if !causes.is_empty() {
            print_hanging(self.out, "       causes: ", &causes.join(", "))?;
        }
        if line.stopped == Some(true) {
            writeln!(
                self.out,
                "       stopped: too many runs ended their process (--limit Nrestarts)"
            )?;
        }
        if line.interrupted {
            writeln!(self.out, "       interrupted")?;
        }
        match (&line.failure, &line.limit) {
            (Some(failure), _) => self.print_failure(line, failure, "failed"),
            (None, Some(limit)) => self.print_failure(line, limit, "reached a limit"),
            (None, None) => Ok(()),
        }
    }

    /// Prints the first start that was not mapped, and what happened there.
    fn print_failure(
        &mut self,
        line: &SizeLine,
        failure: &FailureLine,
        what: &str,
    ) -> Result<(), CliError> {
        let FailureLine { cause, moves, run, .. } = failure;
        writeln!(self.out)?;
        match run {
            FailedRun::Algorithm { step } => {
                let step = step.as_ref().map_or(String::new(), |step| format!(" {step}"));
                print_paragraph(self.out, &format!("Wrong{step}: {cause}"))?;
                let is_folding =
                    line.algorithm.as_deref() == Some(MappingAlgorithm::Folding.info().title);
                let algorithm = if is_folding { " --algorithm folding" } else { "" };
                let explore = format!("toposlam explore --marker {}{algorithm}", line.marker);
                print_paragraph(self.out, &format!("The start, as a world file for `{explore}`:"))?;
            }
            FailedRun::Explorer(run) => {
                let moves = moves.unwrap_or_default();
                let clause = run.clause(moves).unwrap_or_default();
                let end = if clause.ends_with('?') { "" } else { "." };
                let moves = counted(moves as usize, "move");
                let text = format!(
                    "The first start on which the explorer {what}. After {moves}, it {clause}{end}"
                );
                print_paragraph(self.out, &text)?;
                writeln!(self.out)?;
                if let (Some(world), Ok(marker)) = (failure.named_world(), named(&line.marker)) {
                    run.print(&world, marker.into(), self.out)?;
                }
                writeln!(self.out)?;
                print_paragraph(self.out, "The start, as a world file:")?;
            }
        }
        if let Some(world) = failure.named_world() {
            writeln!(self.out, "\n{}", world_file::to_toml(&world))?;
        }
        Ok(())
    }

    /// Prints the verdict and the time that it took, and returns the outcome.
    pub(super) fn verdict(self, elapsed: Option<Duration>) -> Result<Outcome, CliError> {
        let (outcome, verdict) = self.total.verdict();
        if self.json {
            return Ok(outcome);
        }
        let SizeLine { starts, mapped, below_certificate, unknown, ratio, .. } = self.total;
        let is_explorer = unknown.is_some();
        let mut text = verdict.to_owned();
        if starts > 0 {
            let (mapped, starts) = (grouped(mapped.into()), grouped(starts.into()));
            let _ = write!(text, ": {mapped} of {starts} starts mapped correctly, ");
            text += "each proved by a bijection";
        }
        for (count, before, after) in [
            (
                below_certificate.unwrap_or_default(),
                "",
                " in fewer moves than their certificates have",
            ),
            (self.total.reached("max-states"), "", " have more states than --choices allows"),
            (self.total.reached("memory"), "the states of ", " need more than 1 GiB of memory"),
            (unknown.unwrap_or_default(), "on ", ", a limit was reached"),
        ] {
            if count > 0 {
                let _ = write!(text, "; {before}{}{after}", grouped(count.into()));
            }
        }
        if let Some(ratio) = ratio.filter(|_| is_explorer) {
            let _ = write!(text, "; {ratio:.2} times the moves of the certificates");
        }
        writeln!(self.out)?;
        print_paragraph(self.out, &text)?;
        let threads = rayon::current_num_threads();
        match elapsed.map(|elapsed| elapsed.as_secs_f64()) {
            None => {}
            Some(seconds) if is_explorer => {
                remark!("{seconds:.2} s with {threads} processes at once");
            }
            Some(seconds) => remark!("{seconds:.2} s on {}", counted(threads, "thread")),
        }
        Ok(outcome)
    }
}

/// A row of the table. The numbers of the largest checks are wider than their columns, and do not run into each other.
fn row_text(cells: &[Cell]) -> String {
    let cell =
        |(_, width, cell): &Cell| format!("  {cell:>width$}", width = width.saturating_sub(2));
    cells.iter().map(cell).collect()
}

#[cfg(test)]
mod tests {
    use toposlam_model::check::Tally;

    use super::*;
    use crate::cli::RunChoices;

    #[test]
    fn numbers_that_are_wider_than_their_columns_do_not_run_into_each_other() {
        let cells = [("edges", 5, "10"), ("worlds", 11, "613,981,447"), ("starts", 14, "12")];
        let cells = cells.map(|(head, width, cell)| (head.to_owned(), width, cell.to_owned()));
        assert_eq!(row_text(&cells), "   10  613,981,447            12");
    }

    #[test]
    fn more_runs_than_64_bits_hold_are_printed_and_read_exactly() {
        let tally = Tally { runs: u128::MAX, extremes: Some((1, 2)), ..Tally::default() };
        let all = (MappingAlgorithm::Algorithm1, RunChoices::All { budget: 9 });
        let line = SizeLine::default().of_algorithm(all, &tally, None);
        let mut out = Vec::new();
        CheckReport::new(&mut out, true, None).size(line).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert!(text.contains(r#""runs":340282366920938463463374607431768211455,"#), "{text}");
        let read: SizeLine = serde_json::from_str(&text).unwrap();
        assert_eq!(read.runs, Some(u128::MAX));
    }
}
