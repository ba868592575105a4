//! A report as text and as JSON.

use std::{collections::BTreeMap, io::Write};

use serde::Serialize;
use toposlam_conform::{
    CheckedEvent, CheckedKind, ConformVerdict, FaultClass, ReachedLimit, RunEvents,
};
use toposlam_model::folding::SearchLimit;

use super::{
    CliError, JudgedLog,
    divergence_fields::{DivergenceFields, EventFields, MarkerField},
    fact_fields::FactFields,
};
use crate::{
    cli::{
        json::print_line,
        text::{counted, grouped, print_command, print_hanging, since_start},
    },
    report::{ConformReports, CoveredCase, DivergenceReport, LogReport},
};

/// The number of steps shown before a divergence.
const BEFORE: usize = 6;
/// The number of events of a shorter log that are shown.
const SHORT: usize = 12;

/// What `--json` prints for a log.
#[derive(Serialize)]
struct Line<'r> {
    log: &'r str,
    verdict: &'static str,
    event: Option<usize>,
    class: Option<&'static str>,
    events: usize,
    /// The number of events before the divergence.
    matched: usize,
    candidates: usize,
    coverage: BTreeMap<&'r str, u64>,
    unreachable: Vec<&'r str>,
    cause: Option<&'static str>,
    condition: Option<&'r str>,
    allowed: &'r [String],
    time: Option<f64>,
    message: Option<u64>,
    offset: Option<u64>,
    offset_unit: Option<&'static str>,
    facts: BTreeMap<&'static str, &'r str>,
    remarks: &'r [String],
    limits: Vec<Limit>,
    tolerated: BTreeMap<&'r str, usize>,
    shorter: &'r [String],
    divergence: Option<DivergenceFields>,
    shorter_events: Vec<EventFields>,
    command: Option<&'r str>,
    #[serde(flatten)]
    fields: FactFields<'r>,
}

/// A limit that was reached, and the option that raises it.
#[derive(Clone, Copy, Serialize)]
struct Limit {
    option: Option<&'static str>,
    value: Option<u64>,
    /// Whether the verdict depends on it.
    decides: bool,
    /// The event at which the limit was reached.
    event: Option<usize>,
}

/// What `--json` prints for several logs together.
#[derive(Serialize)]
struct Together<'r> {
    logs: usize,
    conform: usize,
    diverged: usize,
    incomplete: usize,
    /// The number of logs that could not be read.
    unreadable: usize,
    coverage: BTreeMap<&'r str, u64>,
    classes: BTreeMap<&'static str, usize>,
}

/// What `--json` prints for a junction that the robot visited.
#[derive(Serialize)]
struct EventLine {
    index: usize,
    /// In seconds.
    stamp: f64,
    /// The number of doors; `None` if the visit is undecided.
    degree: Option<u32>,
    /// The door by which the robot left; `None` if the log ends there.
    door: Option<u32>,
    /// `None` if that is not recorded.
    marker: Option<MarkerField>,
    /// Whether the robot turned back on its way there.
    turned_back: bool,
    /// The length of the hallway by which it came, by odometry, in metres; `None` if it was not measured.
    length: Option<f64>,
}

/// Prints the junctions that the robot visited.
pub(super) fn events(out: &mut dyn Write, events: &RunEvents) -> Result<(), CliError> {
    let mut lines: Vec<EventLine> = Vec::new();
    let mut back = false;
    for event in &events.events {
        let mut visit = |degree, marker| EventLine {
            index: lines.len(),
            stamp: event.source.time as f64 / 1e9,
            degree,
            door: None,
            marker,
            turned_back: std::mem::take(&mut back),
            length: None,
        };
        match &event.kind {
            CheckedKind::Arrival { arrival, hallway, .. } => {
                let marker = arrival.sighting.and_then(MarkerField::of);
                let length = hallway.map(|hallway| hallway.length);
                let visit = visit(Some(arrival.degree), marker);
                lines.push(EventLine { length, ..visit });
            }
            CheckedKind::Undecided(_) => {
                let visit = visit(None, None);
                lines.push(visit);
            }
            CheckedKind::Door { door, .. } => {
                if let Some(visit) = lines.last_mut() {
                    visit.door = Some(door.0);
                }
            }
            CheckedKind::TurnedBack => back = true,
            CheckedKind::Aside { .. } => {}
        }
    }
    for line in &lines {
        print_line(out, "event", line)?;
    }
    Ok(())
}

pub(super) fn json(
    out: &mut dyn Write,
    report: &LogReport,
    shorter: &[CheckedEvent],
    judged: &JudgedLog,
) -> Result<(), CliError> {
    let divergence = report.divergence.as_ref();
    let place = divergence.and_then(|divergence| divergence.message);
    let unreachable = report.coverage.iter().filter(|covered| covered.reachable == Some(false));
    let line = Line {
        log: &report.log,
        verdict: report.verdict.name(),
        event: divergence.map(|divergence| divergence.event),
        class: divergence.map(|divergence| divergence.fault.name()),
        events: report.events.len(),
        matched: divergence
            .map(|divergence| divergence.event - 1)
            .or(judged.judgement.unrecognised)
            .unwrap_or(report.events.len()),
        candidates: judged.judgement.candidates(),
        coverage: counts(&report.coverage),
        unreachable: unreachable.map(|covered| &*covered.case).collect(),
        cause: divergence.map(|divergence| divergence.cause),
        condition: divergence.map(|divergence| &*divergence.why),
        allowed: divergence.map_or(&[], |divergence| &divergence.allowed),
        time: divergence.and_then(|divergence| divergence.time),
        message: place.map(|place| place.number),
        offset: place.map(|place| place.offset),
        offset_unit: place.map(|place| place.unit.name()),
        facts: report.facts.iter().map(|(name, fact)| (*name, &**fact)).collect(),
        remarks: &report.remarks,
        limits: judged
            .judgement
            .limits()
            .into_iter()
            .map(|reached| limit(reached, judged))
            .collect(),
        tolerated: report
            .tolerated
            .iter()
            .map(|(name, _, events)| (&**name, events.len()))
            .collect(),
        shorter: &report.shorter,
        divergence: DivergenceFields::of(judged),
        shorter_events: shorter.iter().map(EventFields::of).collect(),
        command: report.command.as_deref(),
        fields: FactFields::of(judged),
    };
    print_line(out, "log", &line)
}

fn limit(reached: ReachedLimit, judged: &JudgedLog) -> Limit {
    let none = Limit { option: None, value: None, decides: true, event: None };
    let of = |option, value| Limit { option: Some(option), value: Some(value), ..none };
    let search = |limit| match limit {
        SearchLimit::Edges => {
            let edges = judged.search.max_edges.unwrap_or_default();
            of("--max-edges", edges as u64)
        }
        SearchLimit::Steps => of("--max-steps", judged.search.steps),
        SearchLimit::Decisions | SearchLimit::Stopped => none,
    };
    match reached {
        ReachedLimit::SmallerWorld(limit) => Limit { decides: false, ..search(limit) },
        ReachedLimit::World(limit) => search(limit),
        ReachedLimit::Darts { event, bound, .. } => {
            let option = (bound == judged.dart_bound).then_some("--max-darts");
            let value = Some(bound as u64);
            Limit { option, value, event: Some(event + 1), ..none }
        }
    }
}

fn counts(coverage: &[CoveredCase]) -> BTreeMap<&str, u64> {
    coverage.iter().map(|covered| (&*covered.case, covered.count)).collect()
}

pub(super) fn text(out: &mut dyn Write, report: &LogReport) -> Result<(), CliError> {
    match &report.divergence {
        None => writeln!(out, "{}: {}", report.log, in_words(report.verdict))?,
        Some(divergence) => diverged(out, report, divergence)?,
    }
    for remark in &report.remarks {
        print_hanging(out, "  ", remark)?;
    }
    for (name, fact) in &report.facts {
        print_hanging(out, &format!("  {name:<10} "), fact)?;
    }
    let covered = covered(&report.coverage);
    print_hanging(out, &format!("  {:<10} ", "covered"), &covered)?;
    for (name, reason, events) in &report.tolerated {
        let times = match events.len() {
            1 => "once".to_owned(),
            times => format!("{} times", grouped(times as u128)),
        };
        print_hanging(
            out,
            &format!("  {:<10} ", "tolerated"),
            &format!("{name}, {times}: {reason}"),
        )?;
    }
    Ok(())
}

pub(super) fn in_words(verdict: ConformVerdict) -> &'static str {
    match verdict {
        ConformVerdict::Conforms => "conforms",
        ConformVerdict::Diverged => "diverges",
        ConformVerdict::Incomplete => "incomplete: no divergence so far",
    }
}

fn diverged(
    out: &mut dyn Write,
    report: &LogReport,
    divergence: &DivergenceReport,
) -> Result<(), CliError> {
    let DivergenceReport { event, time, message, fault, what, why, allowed, .. } = divergence;
    let [number, of] = [*event, report.events.len()].map(|number| grouped(number as u128));
    let time = time.map_or(String::new(), |time| format!(", at {}", since_start(time)));
    writeln!(out, "{}: diverges at event {number} of {of}{time}: {fault}", report.log)?;
    print_hanging(out, "  ", &format!("{what}: {why}"))?;
    if let Some(message) = message {
        writeln!(out, "  {message}")?;
    }
    if !allowed.is_empty() {
        writeln!(out, "  allowed instead:")?;
    }
    for allowed in allowed {
        print_hanging(out, "    ", allowed)?;
    }
    let first = event.saturating_sub(1 + BEFORE);
    let before = report.events.iter().skip(first).take(event.saturating_sub(1 + first));
    let before: Vec<_> = before.collect();
    if !before.is_empty() {
        writeln!(out, "  the last steps before it:")?;
    }
    for line in before {
        let then = if line.then.is_empty() { "" } else { " -> " };
        let step = format!("{}{then}{}", line.what, line.then);
        print_hanging(out, &format!("    {:>5}  ", line.number), &step)?;
    }
    if !report.shorter.is_empty() {
        let mut events: Vec<_> = report.shorter.iter().take(SHORT).cloned().collect();
        if let Some(more) = report.shorter.len().checked_sub(SHORT + 1) {
            events.push(format!("and {} more", grouped((more + 1) as u128)));
        }
        let count = counted(report.shorter.len(), "event");
        writeln!(out, "  shorter log with this divergence, {count}:")?;
        print_hanging(out, "    ", &events.join("; "))?;
    }
    if let Some(command) = &report.command {
        print_command(out, "  ", command)?;
    }
    Ok(())
}

/// The cases that are covered, and those that are not but can be.
fn covered(coverage: &[CoveredCase]) -> String {
    // A run that diverged may cover cases that its world does not have.
    let possible = |covered: &&CoveredCase| covered.count > 0 || covered.reachable != Some(false);
    let all = coverage.iter().filter(possible).count();
    let seen: Vec<_> = coverage.iter().filter(|covered| covered.count > 0).collect();
    let listed: Vec<_> = seen
        .iter()
        .map(|covered| format!("{} {}", covered.case, grouped(covered.count.into())))
        .collect();
    let missed: Vec<_> = coverage
        .iter()
        .filter(possible)
        .filter(|covered| covered.count == 0)
        .map(|covered| &*covered.case)
        .collect();
    let missed = match missed.len() {
        0 => String::new(),
        _ => format!("; not covered: {}", missed.join(", ")),
    };
    let listed = if listed.is_empty() { String::new() } else { format!(": {}", listed.join(", ")) };
    format!("{} of {all} cases{listed}{missed}", seen.len())
}

/// The summary of several logs.
pub(super) fn together(
    out: &mut dyn Write,
    reports: &ConformReports,
    as_json: bool,
) -> Result<(), CliError> {
    let unreadable = reports.unread.len();
    let reports = &reports.logs;
    let logs = reports.len() + unreadable;
    let count = |verdict| reports.iter().filter(|report| report.verdict == verdict).count();
    let [conform, diverged, incomplete] =
        [ConformVerdict::Conforms, ConformVerdict::Diverged, ConformVerdict::Incomplete].map(count);
    let coverage = LogReport::coverage_of(reports);
    let faults = reports.iter().filter_map(|report| Some(report.divergence.as_ref()?.fault));
    if as_json {
        let mut classes: BTreeMap<_, _> = FaultClass::ALL.map(|one| (one.name(), 0)).into();
        for fault in faults {
            *classes.entry(fault.name()).or_default() += 1;
        }
        let line = Together {
            logs,
            conform,
            diverged,
            incomplete,
            unreadable,
            coverage: counts(&coverage),
            classes,
        };
        return print_line(out, "logs", &line);
    }
    let unreadable = match unreadable {
        0 => String::new(),
        count => format!(", {count} unreadable"),
    };
    writeln!(
        out,
        "{}: {conform} conform, {diverged} diverge, {incomplete} incomplete{unreadable}",
        counted(logs, "log")
    )?;
    print_hanging(out, &format!("  {:<10} ", "covered"), &covered(&coverage))?;
    Ok(())
}
