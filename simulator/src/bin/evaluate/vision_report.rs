//! The output of `evaluate vision`: figures with targets, a confusion matrix, and groups of failures.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::{Map, Value, json};
use toposlam_terminal::{
    CliError,
    text::{counted, grouped, print_hanging, print_rows},
};

use super::evaluation_report::{EvaluationReport, in_words, percent, unbroken};

use toposlam_simulator::{
    evaluation::{
        calibration::Calibration,
        failure_groups::FailureGroup,
        quantile::Quantile,
        report::{ErrorUnit, Errors, VisionReport},
    },
    rendered_view::WhichEffects,
    view_sampler::ViewSampler,
};

/// The number of pairs of groups that are printed.
const HALVES: usize = 10;

/// Adds what is measured: the numbers of views and visits, and where they come from.
pub(super) fn add_source(
    sheet: &mut EvaluationReport,
    [views, visits]: [u64; 2],
    source: &ViewSampler,
) -> Result<(), CliError> {
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
    let line = json!({
        "views": views, "visits": visits, "seed": seed,
        "sizes": sizes, "plans": plans, "looks": looks, "effects": effects,
    });
    sheet.line("source", &line)?;
    let [views, visits] =
        [(views, "view"), (visits, "visit")].map(|(count, noun)| counted(count as usize, noun));
    let text = sheet.text();
    writeln!(text, "Sensing on {views} and {visits}, seed {seed}")?;
    print_hanging(text, "  floor plans  ", &plans.join(", "))?;
    print_hanging(text, "  looks        ", &looks.join(", "))?;
    writeln!(text, "  image sizes  {}", sizes.join(", "))?;
    Ok(writeln!(text, "  effects      {effects}")?)
}

/// Adds the figures with a calibration.
pub(super) fn add(sheet: &mut EvaluationReport, report: &VisionReport) -> Result<(), CliError> {
    let title = match report.calibration {
        Calibration::Right => "With a right calibration",
        Calibration::Wrong => "With a camera 5 pixels, 2 cm and 1 degree off its calibration",
    };
    writeln!(sheet.text(), "\n{title}\n")?;
    sheet.rate_rows(&report.rates)?;
    let calibration = name(report.calibration);
    let key = Map::from_iter([("calibration".to_owned(), calibration.into())]);
    sheet.rate_lines(&key, &report.rates)?;
    if !report.errors.is_empty() {
        let errors: Vec<_> = report.errors.iter().map(errors_row).collect();
        let [median, p95, p99, most] =
            Quantile::ALL.map(|quantile| format!("{:>6}", called(quantile)));
        let heads = ["of", "  cases", &median, &p95, &p99, &most, "error of"];
        writeln!(sheet.text())?;
        print_rows(sheet.text(), heads, &errors)?;
    }
    for errors in &report.errors {
        sheet.line("errors", &errors_line(calibration, errors))?;
    }
    let text = sheet.text();
    writeln!(text, "\n  True class, and the reported classes with their counts:\n")?;
    confusion(text, report)?;
    for (is, said) in &report.confusion {
        let said: Map<String, Value> =
            said.iter().map(|(class, &count)| (class.to_string(), json!(count))).collect();
        let line = json!({ "calibration": calibration, "is": is.to_string(), "said": said });
        sheet.line("confusion", &line)?;
    }
    Ok(())
}

/// Adds what views that are not right have in common.
pub(super) fn add_groups(
    sheet: &mut EvaluationReport,
    groups: &[FailureGroup],
) -> Result<(), CliError> {
    for FailureGroup { by, what, failed, of, .. } in groups {
        sheet.line("failures", &json!({ "by": by, "what": what, "failed": failed, "of": of }))?;
    }
    if groups.iter().all(|group| group.failed == 0) {
        return Ok(());
    }
    let text = sheet.text();
    writeln!(text, "\n  Views that are not right, by what they have in common:\n")?;
    let rows: Vec<_> = groups.iter().filter(|group| !group.is_half).map(group_row).collect();
    print_rows(text, ["by", "", "failed", "     of", "    rate"], &rows)?;
    let halves: Vec<_> = groups.iter().filter(|group| group.is_half).collect();
    let mut pairs: Vec<_> = halves.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
    pairs.sort_by(|one, other| difference(other).total_cmp(&difference(one)));
    pairs.truncate(HALVES);
    writeln!(text)?;
    let rows: Vec<_> = pairs.into_iter().map(pair_row).collect();
    Ok(print_rows(text, ["the most different by", "", " up to it", " above it"], &rows)?)
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

fn errors_line<'a>(calibration: &'a str, errors: &Errors) -> ErrorsLine<'a> {
    let [median, p95, p99, most] = Quantile::ALL.map(|quantile| errors.quantile(quantile));
    let limits = errors.limits.iter().map(|&(quantile, limit)| json!([quantile.part(), limit]));
    ErrorsLine {
        calibration,
        of: errors.subject.name(),
        what: errors.what,
        unit: unit(errors.unit).0,
        cases: errors.sample.count(),
        median,
        p95,
        p99,
        most,
        limits: limits.collect(),
        target: (!errors.limits.is_empty()).then(|| errors.standing().name()),
        cases_needed: errors.cases_needed(),
    }
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
        what.push_str(&in_words(errors.standing(), errors.cases_needed()));
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
