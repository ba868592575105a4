//! The output of `evaluate vision`: figures with targets, a confusion matrix, and groups of failures.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::{Map, Value, json};
use toposlam_terminal::{
    CliError, Outcome,
    json::print_line,
    text::{counted, grouped, print_hanging, print_rows},
};

use toposlam_simulator::{
    evaluation::{
        calibration::Calibration,
        failure_groups::FailureGroup,
        quantile::Quantile,
        report::{ErrorUnit, Errors, Rate, TargetStatus, VisionReport},
    },
    rendered_view::WhichEffects,
    view_sampler::ViewSampler,
};

/// The views and visits that are measured.
pub(super) struct EvaluationHeader<'a> {
    pub(super) views: u64,
    pub(super) visits: u64,
    pub(super) source: &'a ViewSampler,
}

/// Prints results as they come, and counts the targets that are not met.
pub(super) struct Printer<'o> {
    out: &'o mut dyn Write,
    json: bool,
    missed: usize,
    not_shown: usize,
}

/// The number of pairs of groups that are printed.
const HALVES: usize = 10;

impl<'o> Printer<'o> {
    pub(super) fn new(out: &'o mut dyn Write, json: bool) -> Self {
        Self { out, json, missed: 0, not_shown: 0 }
    }

    pub(super) fn header(&mut self, header: &EvaluationHeader) -> Result<(), CliError> {
        let EvaluationHeader { views, visits, source } = header;
        let sizes: Vec<_> =
            source.sizes.iter().map(|[width, height]| format!("{width}x{height}")).collect();
        let mut plans: Vec<_> = source.plans.iter().map(|(name, _)| name.as_str()).collect();
        if source.random_plans {
            plans.push("random plans");
        }
        let looks: Vec<_> = source.looks.iter().map(|look| look.name).collect();
        let effects = match source.effects {
            WhichEffects::Default => "default",
            WhichEffects::None => "none",
        };
        let seed = source.seed;
        if self.json {
            return print_line(
                self.out,
                "source",
                &json!({
                    "views": views, "visits": visits, "seed": seed,
                    "sizes": sizes, "plans": plans, "looks": looks, "effects": effects,
                }),
            );
        }
        let views = counted(*views as usize, "view");
        let visits = counted(*visits as usize, "visit");
        writeln!(self.out, "Sensing on {views} and {visits}, seed {seed}")?;
        print_hanging(self.out, "  floor plans  ", &plans.join(", "))?;
        print_hanging(self.out, "  looks        ", &looks.join(", "))?;
        writeln!(self.out, "  image sizes  {}", sizes.join(", "))?;
        writeln!(self.out, "  effects      {effects}")?;
        Ok(())
    }

    pub(super) fn report(&mut self, report: &VisionReport) -> Result<(), CliError> {
        let standings = report.rates.iter().map(Rate::standing);
        for standing in standings.chain(report.errors.iter().map(Errors::standing)) {
            self.missed += usize::from(standing == TargetStatus::Missed);
            self.not_shown += usize::from(standing == TargetStatus::NotShown);
        }
        if self.json {
            return self.report_lines(report);
        }
        let title = match report.calibration {
            Calibration::Right => "With a right calibration",
            Calibration::Wrong => "With a camera 5 pixels, 2 cm and 1 degree off its calibration",
        };
        writeln!(self.out, "\n{title}\n")?;
        let rates: Vec<_> = report.rates.iter().map(rate_row).collect();
        let heads = ["of", "  seen", "     of", "     rate", "  at most", "what"];
        print_rows(self.out, heads, &rates)?;
        if !report.errors.is_empty() {
            writeln!(self.out)?;
            let errors: Vec<_> = report.errors.iter().map(errors_row).collect();
            let [median, p95, p99, most] =
                Quantile::ALL.map(|quantile| format!("{:>6}", called(quantile)));
            let heads = ["of", "  cases", &median, &p95, &p99, &most, "error of"];
            print_rows(self.out, heads, &errors)?;
        }
        writeln!(self.out, "\n  True class, and the reported classes with their counts:\n")?;
        confusion(self.out, report)?;
        Ok(())
    }

    fn report_lines(&mut self, report: &VisionReport) -> Result<(), CliError> {
        let calibration = name(report.calibration);
        for rate in &report.rates {
            let line = RateLine {
                calibration,
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
            print_line(self.out, "rate", &line)?;
        }
        for errors in &report.errors {
            let (unit, _) = unit(errors.unit);
            let [median, p95, p99, most] = Quantile::ALL.map(|quantile| errors.quantile(quantile));
            let limits =
                errors.limits.iter().map(|&(quantile, limit)| json!([quantile.part(), limit]));
            let target = (!errors.limits.is_empty()).then(|| errors.standing().name());
            let line = ErrorsLine {
                calibration,
                of: errors.subject.name(),
                what: errors.what,
                unit,
                cases: errors.sample.count(),
                median,
                p95,
                p99,
                most,
                limits: limits.collect(),
                target,
                cases_needed: errors.cases_needed(),
            };
            print_line(self.out, "errors", &line)?;
        }
        for (is, said) in &report.confusion {
            let said: Map<String, Value> =
                said.iter().map(|(class, &count)| (class.to_string(), json!(count))).collect();
            let is = is.to_string();
            let line = json!({
                "calibration": calibration, "is": is, "said": said,
            });
            print_line(self.out, "confusion", &line)?;
        }
        Ok(())
    }

    pub(super) fn groups(&mut self, groups: &[FailureGroup]) -> Result<(), CliError> {
        if self.json {
            for FailureGroup { by, what, failed, of, .. } in groups {
                let line = json!({
                    "by": by, "what": what, "failed": failed, "of": of,
                });
                print_line(self.out, "failures", &line)?;
            }
            return Ok(());
        }
        if groups.iter().all(|group| group.failed == 0) {
            return Ok(());
        }
        writeln!(self.out, "\n  Views that are not right, by what they have in common:\n")?;
        let rows: Vec<_> = groups.iter().filter(|group| !group.is_half).map(group_row).collect();
        print_rows(self.out, ["by", "", "failed", "     of", "    rate"], &rows)?;
        let halves: Vec<_> = groups.iter().filter(|group| group.is_half).collect();
        let mut pairs: Vec<_> = halves.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
        pairs.sort_by(|one, other| difference(other).total_cmp(&difference(one)));
        pairs.truncate(HALVES);
        writeln!(self.out)?;
        let rows: Vec<_> = pairs.into_iter().map(pair_row).collect();
        let heads = ["the most different by", "", " up to it", " above it"];
        print_rows(self.out, heads, &rows)?;
        Ok(())
    }

    pub(super) fn verdict(&mut self, outcome: Outcome, interrupted: bool) -> Result<(), CliError> {
        let (missed, not_shown) = (self.missed, self.not_shown);
        if self.json {
            let holds = outcome == Outcome::Holds;
            let line = json!({
                "missed": missed, "not_shown": not_shown,
                "interrupted": interrupted, "verdict": outcome.verdict(), "holds": holds,
            });
            return print_line(self.out, "verdict", &line);
        }
        let verdict = match outcome {
            Outcome::Holds => "holds: all targets are met".to_owned(),
            Outcome::Violated if missed == 1 => "violated: a target is missed".to_owned(),
            Outcome::Violated => format!("violated: {} are missed", counted(missed, "target")),
            Outcome::Incomplete if interrupted => "incomplete, interrupted".to_owned(),
            Outcome::Incomplete => {
                format!("not shown: the sample is too small for {}", counted(not_shown, "target"))
            }
        };
        writeln!(self.out, "\n{verdict}")?;
        Ok(())
    }
}

#[derive(Serialize)]
struct RateLine<'a> {
    calibration: &'a str,
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

#[derive(Serialize)]
struct ErrorsLine<'a> {
    calibration: &'a str,
    of: &'a str,
    what: &'a str,
    unit: &'a str,
    cases: usize,
    median: Option<f64>,
    p95: Option<f64>,
    p99: Option<f64>,
    most: Option<f64>,
    limits: Vec<Value>,
    target: Option<&'a str>,
    cases_needed: Option<usize>,
}

fn group_row(group: &FailureGroup) -> [String; 5] {
    let FailureGroup { by, what, failed, of, .. } = group;
    let name = (*by).to_owned();
    let [failed, of] = [*failed, *of].map(|count| grouped(count as u128));
    [name, what.clone(), format!("{failed:>6}"), format!("{of:>7}"), percent(group.rate())]
}

/// The difference of the rates of two groups.
fn difference([below, above]: &[&FailureGroup; 2]) -> f64 {
    (above.rate() - below.rate()).abs()
}

fn pair_row([below, above]: [&FailureGroup; 2]) -> [String; 4] {
    let rates = [below, above].map(|group| percent(group.rate()));
    let [below_rate, above_rate] = rates;
    [below.by.to_owned(), below.what.clone(), below_rate, above_rate]
}

pub(super) fn rate_row(rate: &Rate) -> [String; 6] {
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
                    (percent(limit), status(rate.standing(), rate.cases_needed()));
                format!("{}; target {}: {status}", rate.what, unbroken(target.trim_start()))
            }
        },
    ]
}

fn errors_row(errors: &Errors) -> [String; 7] {
    let [median, p95, p99, most] = Quantile::ALL.map(|quantile| {
        let error = errors.quantile(quantile).map(|error| format!("{error:.2}"));
        format!("{:>6}", error.as_deref().unwrap_or("-"))
    });
    let (unit, short) = unit(errors.unit);
    let mut what = format!("{}, {unit}", errors.what);
    let limits = errors.limits.iter();
    let limits = limits.map(|&(quantile, limit)| {
        let [quantile, limit] = [called(quantile).to_owned(), format!("{limit} {short}")];
        format!("{} {}", unbroken(&quantile), unbroken(&limit))
    });
    let targets: Vec<_> = limits.collect();
    if !targets.is_empty() {
        what.push_str("; target ");
        what.push_str(&targets.join(", "));
        what.push_str(": ");
        what.push_str(&status(errors.standing(), errors.cases_needed()));
    }
    let cases = format!("{:>7}", grouped(errors.sample.count() as u128));
    [errors.subject.name().to_owned(), cases, median, p95, p99, most, what]
}

/// Prints the reported classes for each true class.
fn confusion(out: &mut dyn Write, report: &VisionReport) -> io::Result<()> {
    for (is, said) in &report.confusion {
        let said = said
            .iter()
            .map(|(class, &count)| format!("{class}{NO_BREAK}{}", grouped(count as u128)));
        print_hanging(out, &format!("  {is:<14}"), &said.collect::<Vec<_>>().join(", "))?;
    }
    Ok(())
}

/// A space at which no line ends.
const NO_BREAK: char = '\u{a0}';

/// A number with its unit, on one line.
fn unbroken(text: &str) -> String {
    text.replace(' ', "\u{a0}")
}

/// The status of a target. If it is not shown, also the number of cases that could show it.
fn status(status: TargetStatus, needed: Option<usize>) -> String {
    match (status, needed) {
        (TargetStatus::NotShown, Some(needed)) => {
            format!("{}, {} cases needed", status.name(), grouped(needed as u128))
        }
        _ => status.name().to_owned(),
    }
}

/// A share in percent.
pub(super) fn percent(share: f64) -> String {
    format!("{:>9}", format!("{:.3} %", 100.0 * share))
}

/// The name of a quantile.
fn called(quantile: Quantile) -> &'static str {
    match quantile {
        Quantile::Median => "median",
        Quantile::P95 => "95 %",
        Quantile::P99 => "99 %",
        Quantile::Most => "most",
    }
}

/// A unit's name and abbreviation.
fn unit(unit: ErrorUnit) -> (&'static str, &'static str) {
    match unit {
        ErrorUnit::Degrees => ("degrees", "deg"),
        ErrorUnit::Centimetres => ("centimetres", "cm"),
    }
}

fn name(calibration: Calibration) -> &'static str {
    match calibration {
        Calibration::Right => "right",
        Calibration::Wrong => "wrong",
    }
}
