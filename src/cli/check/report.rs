//! The report of a check: a row or a JSON object for each number of edges, and the verdict.

use std::{
    fmt::{Display, Write as _},
    io::Write,
    time::Duration,
};

use toposlam_model::{format::world_file, mapping::MappingAlgorithm};

use serde::Serialize;

use super::line::{AlgorithmInfo, SizeLine, SizeResult};
use crate::cli::{
    CliError, Outcome, RunChoices,
    ci_report::CiCase,
    cluster::ClusterSession,
    json::print_line,
    text::{counted, grouped, print_hanging, print_paragraph},
};

/// The worlds of a file or of a class, in words.
pub(super) fn worlds_in_words(from: Option<impl Display>, class: &str) -> String {
    match from {
        Some(path) => format!("the worlds of {path}"),
        None => format!("class {class}"),
    }
}

/// The mean over some starts, and the largest value.
pub(super) fn mean_and_most(total: u64, starts: u64, most: u64) -> String {
    format!("{:.1}/{}", total as f64 / starts.max(1) as f64, grouped(most.into()))
}

/// A line of `--json`: the counts, and the verdict that follows from them.
#[derive(Serialize)]
struct PrintedSize<'l> {
    #[serde(flatten)]
    line: &'l SizeLine,
    verdict: &'static str,
}

impl SizeLine {
    /// The worlds, in words.
    fn worlds_in_words(&self) -> String {
        let class = self.class.as_deref().unwrap_or_default();
        let worlds = worlds_in_words(self.from.as_ref(), class);
        match &self.shard {
            None => worlds,
            Some(shard) => format!("{worlds}, shard {shard}"),
        }
    }

    /// The result for CI systems.
    pub(in crate::cli) fn ci_case(&self) -> CiCase {
        let (mapped, starts) = (grouped(self.mapped.into()), grouped(self.starts.into()));
        let mut message = format!("{mapped} of {starts} starts mapped correctly");
        if let Some(failure) = &self.failure {
            let _ = write!(message, "; the first wrong one: {}", failure.cause);
        } else if self.interrupted {
            message += "; interrupted";
        } else if self.gave_up.unwrap_or_default() > 0 {
            message += "; the other runs of some starts reached a limit";
        }
        let file = self.from.as_ref().map(Into::into);
        CiCase { name: self.name(), outcome: self.verdict().0, message, file }
    }

    /// What is checked.
    pub(in crate::cli) fn name(&self) -> String {
        format!("{}, {}", counted(self.edges, "edge"), self.worlds_in_words())
    }
}

/// Prints each result when it is there.
pub(in crate::cli) struct CheckReport<'o> {
    out: &'o mut dyn Write,
    json: bool,
    subject: AlgorithmInfo,
    choice: RunChoices,
    header: bool,
    total: SizeLine,
}

impl<'o> CheckReport<'o> {
    pub(in crate::cli) fn new(
        out: &'o mut dyn Write,
        json: bool,
        subject: AlgorithmInfo,
        choice: RunChoices,
    ) -> Self {
        Self { out, json, subject, choice, header: false, total: SizeLine::default() }
    }

    /// The line of a result.
    pub(super) fn line(&self, size: &SizeResult) -> SizeLine {
        SizeLine::new(size, self.subject, self.choice)
    }

    /// Prints the result for one number of edges.
    pub(in crate::cli) fn size(&mut self, line: SizeLine) -> Result<(), CliError> {
        if self.json {
            let verdict = line.verdict().0.verdict();
            print_line(self.out, "size", &PrintedSize { line: &line, verdict })?;
        } else {
            self.row(&line)?;
        }
        self.out.flush()?;
        Ok(self.total.add(line)?)
    }

    /// Reports how busy the threads of a cluster were.
    pub(super) fn threads(
        &mut self,
        cluster: &mut ClusterSession,
        work: &str,
    ) -> Result<(), CliError> {
        cluster.report(self.out, self.json, work)
    }

    fn header(&mut self, line: &SizeLine) -> Result<(), CliError> {
        let AlgorithmInfo { algorithm, marker, certificates, order } = self.subject;
        let head = format!("{algorithm}, {marker} marker, {}", line.worlds_in_words());
        print_paragraph(self.out, &head)?;
        let cost = if certificates {
            "  certificate  ratio".to_owned()
        } else {
            format!("  {:>11}", format!("max/({order})"))
        };
        writeln!(
            self.out,
            "\n{:>5} {:>10}  {:>12}  {:>6}  {:>14}{cost}",
            "edges", "worlds", "starts", "failed", "mean/max moves",
        )?;
        Ok(())
    }

    fn row(&mut self, line: &SizeLine) -> Result<(), CliError> {
        if !std::mem::replace(&mut self.header, true) {
            self.header(line)?;
        }
        let cost = match (line.certificate_total, line.certificate_max) {
            (Some(total), Some(most)) => {
                let certificate = mean_and_most(total, line.starts, most);
                let ratio =
                    line.ratio.map_or_else(|| "-".to_owned(), |ratio| format!("{ratio:.2}"));
                format!("  {certificate:>11}  {ratio:>5}")
            }
            _ => format!("  {:>11.3}", line.largest_ratio),
        };
        writeln!(
            self.out,
            "{:>5} {:>10}  {:>12}  {:>6}  {:>14}{cost}",
            line.edges,
            grouped(line.worlds.into()),
            grouped(line.starts.into()),
            grouped(line.failed.into()),
            mean_and_most(line.moves_total, line.starts, line.moves_max),
        )?;
        if let Some(runs) = line.runs {
            let some = runs == u128::MAX || line.gave_up.unwrap_or_default() > 0;
            let all = format!(
                "{} states, {}{} runs of {} to {} moves",
                grouped(line.states.unwrap_or_default().into()),
                if some { "at least " } else { "" },
                grouped(runs),
                grouped(line.moves_least.unwrap_or_default().into()),
                grouped(line.moves_most.unwrap_or_default().into()),
            );
            print_hanging(self.out, "       all choices: ", &all)?;
        }
        if line.interrupted {
            writeln!(self.out, "       interrupted")?;
        }
        if let Some(failure) = &line.failure {
            let step = failure.step.as_ref().map_or(String::new(), |step| format!(" {step}"));
            writeln!(self.out)?;
            print_paragraph(self.out, &format!("Wrong{step}: {}", failure.cause))?;
            let is_folding = self.subject.algorithm == MappingAlgorithm::Folding.info().title;
            let algorithm = if is_folding { " --algorithm folding" } else { "" };
            let explore = format!("toposlam explore --marker {}{algorithm}", self.subject.marker);
            print_paragraph(self.out, &format!("The start, as a world file for `{explore}`:"))?;
            if let Some(world) = failure.named_world() {
                writeln!(self.out, "\n{}", world_file::to_toml(&world))?;
            }
        }
        Ok(())
    }

    /// Prints the verdict and returns the outcome.
    pub(in crate::cli) fn verdict(self, elapsed: Option<Duration>) -> Result<Outcome, CliError> {
        let (outcome, verdict) = self.total.verdict();
        if self.json {
            return Ok(outcome);
        }
        let SizeLine { starts, mapped, below_certificate, .. } = self.total;
        let mut verdict = verdict.to_owned();
        if starts > 0 {
            let (mapped, starts) = (grouped(mapped.into()), grouped(starts.into()));
            let _ = write!(verdict, ": {mapped} of {starts} starts mapped correctly, ");
            verdict += "each proved by a bijection";
        }
        if let Some(below @ 1..) = below_certificate {
            let starts = grouped(below.into());
            let _ = write!(verdict, "; {starts} in fewer moves than their certificates have");
        }
        if let over @ 1.. = self.total.reached("max-states") {
            let starts = grouped(over.into());
            let _ = write!(verdict, "; {starts} have more states than --max-states");
        }
        if let over @ 1.. = self.total.reached("memory") {
            let starts = grouped(over.into());
            let _ = write!(verdict, "; the states of {starts} need more than 1 GiB of memory");
        }
        writeln!(self.out)?;
        print_paragraph(self.out, &verdict)?;
        if let Some(elapsed) = elapsed {
            let threads = counted(rayon::current_num_threads(), "thread");
            remark!("{:.2} s on {threads}", elapsed.as_secs_f64());
        }
        Ok(outcome)
    }
}

#[cfg(test)]
mod tests {
    use toposlam_model::{
        check::{Shard, Tally},
        enumerate::Class,
    };

    use super::*;

    #[test]
    fn more_runs_than_64_bits_hold_are_printed_and_read_exactly() {
        let tally = Tally { runs: u128::MAX, extremes: Some((1, 2)), ..Tally::default() };
        let (class, shard) = (Class::Simple, Shard::WHOLE);
        let size =
            SizeResult { edges: 1, class, from: None, shard, tally: &tally, moves_made: None };
        let subject = AlgorithmInfo::of(MappingAlgorithm::Algorithm1);
        let mut line = Vec::new();
        print_line(
            &mut line,
            "size",
            &SizeLine::new(&size, subject, RunChoices::All { budget: 9 }),
        )
        .unwrap();
        let line = String::from_utf8(line).unwrap();
        assert!(line.contains(r#""runs":340282366920938463463374607431768211455,"#), "{line}");
        let read: SizeLine = serde_json::from_str(&line).unwrap();
        assert_eq!(read.runs, Some(u128::MAX));
    }
}
