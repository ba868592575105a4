//! The report of a measurement: its text, and the same as JSON lines. Every command writes both into one report, and
//! the report prints the one that was asked for.

use std::{fmt::Display, io::Write, ops::Range, time::Instant};

use serde::Serialize;
use serde_json::{Map, Value, json};
use toposlam_model::enumerate::Watch;
use toposlam_simulator::evaluation::bound::upper_bound;
use toposlam_simulator::{
    LearningError,
    evaluation::{
        report::{Errors, Figures, Group, QUANTILES, Rate, TargetStatus},
        sampling::sample,
    },
};
use toposlam_terminal::{
    CliError, Outcome,
    json::print_line,
    progress::Progress,
    remark,
    text::{counted, grouped, print_hanging, print_indented, print_rows},
    thread_option::ThreadOption,
};

/// Options of every measurement.
#[derive(clap::Args)]
pub(super) struct ReportArguments {
    #[command(flatten)]
    threads: ThreadOption,
    /// Print JSON objects, one per line
    #[arg(long)]
    json: bool,
}

pub(super) struct EvaluationReport {
    json: bool,
    begun: Instant,
    pub(super) text: Vec<u8>,
    lines: Vec<u8>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum MeasurementEnd {
    Whole,
    /// No case was measured.
    Empty,
    Interrupted,
}

impl MeasurementEnd {
    /// The ending of a measurement of so many of the wanted cases.
    pub(super) fn from_counts(measured: usize, wanted: u64) -> Self {
        if measured == 0 { Self::Empty } else { Self::interrupted_if((measured as u64) < wanted) }
    }

    pub(super) fn interrupted_if(is_interrupted: bool) -> Self {
        if is_interrupted { Self::Interrupted } else { Self::Whole }
    }

    /// The outcome of a measurement with targets.
    pub(super) fn outcome(self, status: TargetStatus) -> Outcome {
        match (status, self) {
            (TargetStatus::Missed, _) => Outcome::Violated,
            (TargetStatus::Met, Self::Whole) => Outcome::Holds,
            _ => Outcome::Incomplete,
        }
    }

    /// The outcome of a measurement in which nothing may fail.
    pub(super) fn outcome_with(self, failures: u64) -> Outcome {
        self.outcome(if failures > 0 { TargetStatus::Missed } else { TargetStatus::Met })
    }

    /// The verdict in words: if it holds, if it is violated, and if it is not shown.
    pub(super) fn verdict(self, outcome: Outcome, [holds, violated, not_shown]: [&str; 3]) -> &str {
        match (outcome, self) {
            (Outcome::Holds, _) => holds,
            (Outcome::Violated, _) => violated,
            (_, Self::Empty) => "not known: nothing was measured",
            (_, Self::Interrupted) => "not known, interrupted",
            _ => not_shown,
        }
    }

    /// The verdict on targets, in words.
    pub(super) fn verdict_on_targets(self, outcome: Outcome, statuses: &[TargetStatus]) -> String {
        let count = |is| counted(statuses.iter().filter(|&&it| it == is).count(), "target");
        let violated = format!("violated: missed {}", count(TargetStatus::Missed));
        let not_shown = count(TargetStatus::NotShown);
        let not_shown = format!("not shown: the sample is too small for {not_shown}");
        self.verdict(outcome, ["holds: all targets are met", &violated, &not_shown]).to_owned()
    }
}

/// Takes samples on all threads, with a progress bar.
pub(super) fn measure<R: Send>(
    work: &str,
    unit: &'static str,
    numbers: Range<u64>,
    one: impl Fn(u64, &dyn Watch) -> Option<R> + Sync,
) -> Result<Vec<R>, CliError> {
    let progress = Progress::new(work, unit)?;
    let samples = sample(numbers, &progress, |number| one(number, &progress));
    progress.finish();
    Ok(samples)
}

impl ReportArguments {
    pub(super) fn begin(&self) -> Result<EvaluationReport, CliError> {
        self.threads.apply()?;
        let (text, lines) = (Vec::new(), Vec::new());
        Ok(EvaluationReport { json: self.json, begun: Instant::now(), text, lines })
    }
}

impl EvaluationReport {
    pub(super) fn line(
        &mut self,
        kind: &'static str,
        content: &impl Serialize,
    ) -> Result<(), CliError> {
        print_line(&mut self.lines, kind, content)
    }

    pub(super) fn failure(
        &mut self,
        what: impl Display,
        how: impl Display,
    ) -> Result<(), CliError> {
        Ok(print_indented(&mut self.text, "  ", 4, &format!("{what}: {how}"))?)
    }

    /// Adds a table. A column whose head begins with `>` is aligned to the right.
    pub(super) fn table<const COLUMNS: usize>(
        &mut self,
        heads: [&str; COLUMNS],
        rows: impl IntoIterator<Item = [String; COLUMNS]>,
    ) -> Result<(), CliError> {
        let mut heads = heads.map(str::to_owned);
        let mut rows: Vec<_> = rows.into_iter().collect();
        for column in 0..COLUMNS {
            if let Some(head) = heads[column].strip_prefix('>') {
                let head = head.to_owned();
                heads[column] = head;
                let cells = || [&heads].into_iter().chain(&rows).map(|row| &row[column]);
                let width = cells().map(|cell| cell.chars().count()).max().unwrap_or(0);
                for row in [&mut heads].into_iter().chain(&mut rows) {
                    row[column] = format!("{:>width$}", row[column]);
                }
            }
        }
        Ok(print_rows(&mut self.text, heads.each_ref().map(String::as_str), &rows)?)
    }

    /// Adds a count, its rate, and the upper bound of the rate with a confidence of 95 %.
    pub(super) fn share(&mut self, what: &str, seen: usize, cases: usize) -> Result<(), CliError> {
        let [rate, bound] =
            [seen as f64 / cases.max(1) as f64, upper_bound(seen, cases)].map(|part| 100.0 * part);
        let [seen_text, cases_text] = [seen, cases].map(number);
        writeln!(
            self.text,
            "  {what:<9}{seen_text} of {cases_text} ({rate:.2} %, at most {bound:.2} %)"
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

    /// Adds figures with their targets. Each JSON line has these keys before.
    pub(super) fn figures(
        &mut self,
        keys: &Map<String, Value>,
        figures: &Figures,
    ) -> Result<(), CliError> {
        let heads = ["of", ">seen", ">of", ">rate", ">at most", "what"];
        self.table(heads, figures.rates.iter().map(rate_row))?;
        for rate in &figures.rates {
            let line = json!({
                "of": rate.of, "what": rate.what, "seen": rate.seen, "cases": rate.cases,
                "rate": rate.rate(), "upper_bound": rate.upper_bound(), "limit": rate.limit,
                "target": rate.limit.map(|_| rate.status().name()),
                "cases_needed": rate.cases_needed(),
            });
            self.line("rate", &KeyedLine { keys, line })?;
        }
        if !figures.errors.is_empty() {
            writeln!(self.text)?;
            let heads = ["of", ">cases", ">median", ">95 %", ">99 %", ">most", "error of"];
            self.table(heads, figures.errors.iter().map(errors_row))?;
        }
        for errors in &figures.errors {
            let [median, p95, p99, most] = QUANTILES.map(|(part, _)| errors.quantile(part));
            let line = json!({
                "of": errors.of, "what": errors.what, "unit": errors.unit.name,
                "cases": errors.sample.count(),
                "median": median, "p95": p95, "p99": p99, "most": most, "limits": errors.limits,
                "target": (!errors.limits.is_empty()).then(|| errors.status().name()),
                "cases_needed": errors.cases_needed(),
            });
            self.line("errors", &KeyedLine { keys, line })?;
        }
        if !figures.confusion.is_empty() {
            writeln!(self.text, "\n  True class, and the reported classes with their counts:\n")?;
        }
        for (is, said) in &figures.confusion {
            let words =
                said.iter().map(|(class, &count)| unbroken(&format!("{class} {}", number(count))));
            let words: Vec<_> = words.collect();
            print_hanging(&mut self.text, &format!("  {is:<14}"), &words.join(", "))?;
            let said: Map<String, Value> =
                said.iter().map(|(class, &count)| (class.to_string(), json!(count))).collect();
            let line = json!({ "is": is.to_string(), "said": said });
            self.line("confusion", &KeyedLine { keys, line })?;
        }
        Ok(())
    }

    /// Adds what samples that are not right have in common. `counts` are the counts of a JSON line.
    pub(super) fn groups(
        &mut self,
        samples: &str,
        groups: &[Group],
        counts: impl Fn(&Group) -> Value,
    ) -> Result<(), CliError> {
        for group in groups {
            let keys = Map::from_iter([
                ("by".to_owned(), group.by.into()),
                ("what".to_owned(), group.what.clone().into()),
            ]);
            self.line("failures", &KeyedLine { keys: &keys, line: counts(group) })?;
        }
        if groups.iter().all(|group| group.tally.failed() == 0) {
            return Ok(());
        }
        writeln!(self.text, "\n  {samples} that are not right, by what they have in common:\n")?;
        let row = |group: &Group| {
            let [wrong, undecided, of] =
                [group.tally.wrong, group.tally.undecided, group.tally.all()].map(number);
            [group.by.to_owned(), group.what.clone(), wrong, undecided, of, percent(group.rate())]
        };
        let heads = ["by", "", ">wrong", ">undecided", ">of", ">rate"];
        self.table(heads, groups.iter().filter(|group| !group.is_half).map(row))?;
        let halves: Vec<_> = groups.iter().filter(|group| group.is_half).collect();
        let difference = |pair: &&[&Group]| (pair[1].rate() - pair[0].rate()).abs();
        let mut pairs: Vec<_> = halves.chunks_exact(2).collect();
        pairs.sort_by(|one, other| difference(other).total_cmp(&difference(one)));
        pairs.truncate(HALVES);
        if pairs.is_empty() {
            return Ok(());
        }
        writeln!(self.text)?;
        let rows = pairs.into_iter().map(|pair| {
            let [below, above] = [pair[0], pair[1]].map(|group| percent(group.rate()));
            [pair[0].by.to_owned(), pair[0].what.clone(), below, above]
        });
        self.table(["the most different by", "", ">up to it", ">above it"], rows)
    }

    /// Ends the report with its verdict, and prints it: the text, or the JSON lines, of which the last one has the
    /// verdict after its content.
    pub(super) fn finish(
        mut self,
        out: &mut dyn Write,
        (kind, mut content): (&'static str, Value),
        outcome: Outcome,
        verdict: &str,
    ) -> Result<Outcome, CliError> {
        content["verdict"] = outcome.verdict().into();
        content["holds"] = (outcome == Outcome::Holds).into();
        self.line(kind, &content)?;
        writeln!(self.text, "{verdict}")?;
        self.print(out, outcome)
    }

    pub(super) fn print(self, out: &mut dyn Write, outcome: Outcome) -> Result<Outcome, CliError> {
        out.write_all(if self.json { &self.lines } else { &self.text })?;
        let threads = counted(rayon::current_num_threads(), "thread");
        remark!("{:.1} s on {threads}", self.begun.elapsed().as_secs_f64());
        Ok(outcome)
    }
}

/// The number of pairs of halves that are printed.
const HALVES: usize = 10;

/// A JSON line with keys before its content.
#[derive(Serialize)]
struct KeyedLine<'k> {
    #[serde(flatten)]
    keys: &'k Map<String, Value>,
    #[serde(flatten)]
    line: Value,
}

fn rate_row(rate: &Rate) -> [String; 6] {
    let figure = |share: Option<f64>| share.map_or_else(|| "-".to_owned(), percent);
    let what = rate.limit.map_or_else(
        || rate.what.to_owned(),
        |limit| {
            let status = in_words(rate.status(), rate.cases_needed());
            format!("{}; target {}: {status}", rate.what, unbroken(&percent(limit)))
        },
    );
    let bound = Some(rate.upper_bound()).filter(|_| rate.cases > 0);
    let (seen, cases) = (number(rate.seen), number(rate.cases));
    [rate.of.to_owned(), seen, cases, figure(rate.rate()), figure(bound), what]
}

fn errors_row(errors: &Errors) -> [String; 7] {
    let [median, p95, p99, most] = QUANTILES.map(|(part, _)| {
        errors.quantile(part).map_or_else(|| "-".to_owned(), |error| format!("{error:.2}"))
    });
    let limits = errors.limits.iter().map(|(part, limit)| {
        let name = QUANTILES
            .iter()
            .find(|(known, _)| known.total_cmp(part).is_eq())
            .map_or("", |known| known.1);
        let limit = format!("{limit} {}", errors.unit.short);
        format!("{} {}", unbroken(name), unbroken(&limit))
    });
    let limits = limits.collect::<Vec<_>>().join(", ");
    let target = if limits.is_empty() {
        limits
    } else {
        format!("; target {limits}: {}", in_words(errors.status(), errors.cases_needed()))
    };
    let what = format!("{}, {}{target}", errors.what, errors.unit.name);
    [errors.of.to_owned(), number(errors.sample.count()), median, p95, p99, most, what]
}

pub(super) fn number(count: usize) -> String {
    grouped(count as u128)
}

fn percent(share: f64) -> String {
    format!("{:.3} %", 100.0 * share)
}

/// A number with its unit, on one line.
fn unbroken(text: &str) -> String {
    text.replace(' ', "\u{a0}")
}

/// The status of a target. If it is not shown, also the number of cases that could show it.
fn in_words(status: TargetStatus, needed: Option<usize>) -> String {
    match (status, needed) {
        (TargetStatus::NotShown, Some(needed)) => {
            format!("{}, {} cases needed", status.name(), number(needed))
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
