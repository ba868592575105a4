//! The report of a measurement: its text, and the same as JSON lines. Every command writes both into one report, and
//! the report prints the one that was asked for.

use std::{fmt::Display, io::Write, time::Instant};

use serde::Serialize;
use serde_json::{Map, Value, json};
use toposlam_simulator::evaluation::bound::upper_bound;
use toposlam_simulator::{
    LearningError,
    evaluation::report::{Rate, TargetStatus},
};
use toposlam_terminal::{
    CliError, Outcome,
    json::print_line,
    remark,
    text::{counted, grouped, print_indented, print_rows},
    use_threads,
};

/// Options of every measurement.
#[derive(clap::Args)]
pub(super) struct ReportArguments {
    /// Number of threads, up to 1024; the result is the same for any number [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Print JSON objects, one per line
    #[arg(long)]
    json: bool,
}

/// The report of a measurement.
pub(super) struct EvaluationReport {
    json: bool,
    begun: Instant,
    text: Vec<u8>,
    lines: Vec<u8>,
}

/// How a measurement ended.
#[derive(Clone, Copy)]
pub(super) enum MeasurementEnd {
    /// All cases were measured.
    Whole,
    /// No case was measured.
    Empty,
    /// The work was stopped.
    Interrupted,
}

impl MeasurementEnd {
    /// The ending of a measurement of so many of the wanted cases.
    pub(super) fn of(measured: usize, wanted: u64) -> Self {
        if measured == 0 {
            Self::Empty
        } else if (measured as u64) < wanted {
            Self::Interrupted
        } else {
            Self::Whole
        }
    }
}

/// The outcome of a measurement with targets.
pub(super) fn outcome(status: TargetStatus, ending: MeasurementEnd) -> Outcome {
    match (status, ending) {
        (TargetStatus::Missed, _) => Outcome::Violated,
        (TargetStatus::Met, MeasurementEnd::Whole) => Outcome::Holds,
        _ => Outcome::Incomplete,
    }
}

impl ReportArguments {
    /// Begins the report.
    ///
    /// # Errors
    /// Returns an error if the threads cannot be started.
    pub(super) fn begin(&self) -> Result<EvaluationReport, CliError> {
        use_threads(self.threads)?;
        let (text, lines) = (Vec::new(), Vec::new());
        Ok(EvaluationReport { json: self.json, begun: Instant::now(), text, lines })
    }
}

impl EvaluationReport {
    /// The text, to write into.
    pub(super) fn text(&mut self) -> &mut dyn Write {
        &mut self.text
    }

    /// Adds a JSON line.
    pub(super) fn line(
        &mut self,
        kind: &'static str,
        content: &impl Serialize,
    ) -> Result<(), CliError> {
        print_line(&mut self.lines, kind, content)
    }

    /// Adds the text of a case that failed.
    pub(super) fn failure(
        &mut self,
        what: impl Display,
        how: impl Display,
    ) -> Result<(), CliError> {
        Ok(print_indented(&mut self.text, "  ", 4, &format!("{what}: {how}"))?)
    }

    /// Adds a count, its rate, and the upper bound of the rate with a confidence of 95 %.
    pub(super) fn share(&mut self, what: &str, seen: usize, cases: usize) -> Result<(), CliError> {
        let percent = |part: f64| 100.0 * part;
        let (rate, bound) = (seen as f64 / cases.max(1) as f64, upper_bound(seen, cases));
        writeln!(
            self.text,
            "  {what:<9}{} of {} ({:.2} %, at most {:.2} %)",
            grouped(seen as u128),
            grouped(cases as u128),
            percent(rate),
            percent(bound),
        )?;
        self.share_line(what, [seen, cases])
    }

    /// Adds a count, its rate and its bound to the JSON lines only.
    pub(super) fn share_line(
        &mut self,
        what: &str,
        [seen, cases]: [usize; 2],
    ) -> Result<(), CliError> {
        let line = json!({
            "what": what, "seen": seen, "cases": cases,
            "rate": seen as f64 / cases.max(1) as f64, "upper_bound": upper_bound(seen, cases),
        });
        self.line("rate", &line)
    }

    /// Adds a table of rates with their targets to the text.
    pub(super) fn rate_rows(&mut self, rates: &[Rate]) -> Result<(), CliError> {
        let rows: Vec<_> = rates.iter().map(rate_row).collect();
        let heads = ["of", "  seen", "     of", "     rate", "  at most", "what"];
        Ok(print_rows(&mut self.text, heads, &rows)?)
    }

    /// Adds rates with their targets to the JSON lines, each with these keys before.
    pub(super) fn rate_lines(
        &mut self,
        keys: &Map<String, Value>,
        rates: &[Rate],
    ) -> Result<(), CliError> {
        for rate in rates {
            let line = RateLine {
                keys,
                of: rate.subject.name(),
                what: rate.what,
                seen: rate.seen,
                cases: rate.cases,
                rate: rate.rate(),
                upper_bound: rate.upper_bound(),
                limit: rate.limit,
                target: rate.limit.map(|_| rate.standing().name()),
                cases_needed: rate.cases_needed(),
            };
            self.line("rate", &line)?;
        }
        Ok(())
    }

    /// Ends the report with its verdict, and prints it: the text, or the JSON lines, of which the last one has the
    /// verdict after its content.
    pub(super) fn finish(
        mut self,
        out: &mut dyn Write,
        (kind, content): (&'static str, &Value),
        outcome: Outcome,
        verdict: &str,
    ) -> Result<Outcome, CliError> {
        let mut content = content.clone();
        content["verdict"] = outcome.verdict().into();
        content["holds"] = (outcome == Outcome::Holds).into();
        self.line(kind, &content)?;
        writeln!(self.text, "{verdict}")?;
        self.print(out, outcome)
    }

    /// Prints the report as it is.
    pub(super) fn print(self, out: &mut dyn Write, outcome: Outcome) -> Result<Outcome, CliError> {
        out.write_all(if self.json { &self.lines } else { &self.text })?;
        let threads = counted(rayon::current_num_threads(), "thread");
        remark!("{:.1} s on {threads}", self.begun.elapsed().as_secs_f64());
        Ok(outcome)
    }
}

/// The verdict of a measurement with targets, in words.
pub(super) fn verdict_on_targets(
    outcome: Outcome,
    ending: MeasurementEnd,
    statuses: impl IntoIterator<Item = TargetStatus>,
) -> String {
    let [mut missed, mut not_shown] = [0; 2];
    for status in statuses {
        missed += usize::from(status == TargetStatus::Missed);
        not_shown += usize::from(status == TargetStatus::NotShown);
    }
    match (outcome, ending) {
        (Outcome::Holds, _) => "holds: all targets are met".to_owned(),
        (Outcome::Violated, _) => format!("violated: missed {}", counted(missed, "target")),
        (_, MeasurementEnd::Interrupted) => "incomplete, interrupted".to_owned(),
        _ => format!("not shown: the sample is too small for {}", counted(not_shown, "target")),
    }
}

#[derive(Serialize)]
struct RateLine<'a> {
    #[serde(flatten)]
    keys: &'a Map<String, Value>,
    of: &'a str,
    what: &'a str,
    seen: usize,
    cases: usize,
    rate: Option<f64>,
    upper_bound: f64,
    limit: Option<f64>,
    target: Option<&'a str>,
    /// The least number of cases that can meet the target.
    cases_needed: Option<usize>,
}

fn rate_row(rate: &Rate) -> [String; 6] {
    let figure = |share: Option<f64>| share.map_or_else(|| format!("{:>9}", "-"), percent);
    [
        rate.subject.name().to_owned(),
        format!("{:>6}", grouped(rate.seen as u128)),
        format!("{:>7}", grouped(rate.cases as u128)),
        figure(rate.rate()),
        figure(Some(rate.upper_bound()).filter(|_| rate.cases > 0)),
        match rate.limit {
            None => rate.what.to_owned(),
            Some(limit) => {
                let (target, status) =
                    (percent(limit), in_words(rate.standing(), rate.cases_needed()));
                format!("{}; target {}: {status}", rate.what, unbroken(target.trim_start()))
            }
        },
    ]
}

/// A share in percent.
pub(super) fn percent(share: f64) -> String {
    format!("{:>9}", format!("{:.3} %", 100.0 * share))
}

/// A number with its unit, on one line.
pub(super) fn unbroken(text: &str) -> String {
    text.replace(' ', "\u{a0}")
}

/// The status of a target. If it is not shown, also the number of cases that could show it.
pub(super) fn in_words(status: TargetStatus, needed: Option<usize>) -> String {
    match (status, needed) {
        (TargetStatus::NotShown, Some(needed)) => {
            format!("{}, {} cases needed", status.name(), grouped(needed as u128))
        }
        _ => status.name().to_owned(),
    }
}

/// The failure if the colours were not learned.
pub(super) fn unlearned(error: LearningError) -> CliError {
    match error {
        LearningError::Interrupted(stopped) => stopped.into(),
        error => unmeasured(error),
    }
}

/// A failure that is not the user's.
pub(super) fn unmeasured(error: impl Display) -> CliError {
    CliError::at("evaluate", error)
}
