//! A report as text.

use std::io::{self, Write};

use toposlam_conform::{
    ConformReports, DivergenceReport, LogReport, ReportedEvent, ToleratedQuirk, words,
};

use crate::cli::text::{counted, grouped, print_command, print_hanging, printable, since_start};

/// The number of steps shown before a divergence.
const BEFORE: usize = 6;
/// The number of events of a shorter log that are shown.
const SHORT: usize = 12;

pub(super) fn print(out: &mut dyn Write, report: &LogReport) -> io::Result<()> {
    match &report.divergence {
        None => {
            writeln!(out, "{}: {}", printable(&report.log), words::verdict(report.verdict))?;
        }
        Some(divergence) => print_divergence(out, report, divergence)?,
    }
    for remark in words::remarks(report) {
        print_hanging(out, "  ", &remark)?;
    }
    for (name, fact) in words::facts(report) {
        print_fact(out, name, &fact)?;
    }
    if report.has_coverage() {
        print_fact(out, "covered", &words::covered(&report.coverage))?;
    }
    for ToleratedQuirk { name, reason, events } in &report.tolerated {
        let times = words::times(events.len());
        print_fact(out, "tolerated", &format!("{name}, {times}: {reason}"))?;
    }
    Ok(())
}

/// Prints the summary of several logs.
pub(super) fn print_together(out: &mut dyn Write, reports: &ConformReports) -> io::Result<()> {
    writeln!(out, "{}", words::together(reports))?;
    print_fact(out, "covered", &words::covered(&LogReport::coverage_of(&reports.logs)))
}

fn print_fact(out: &mut dyn Write, name: &str, fact: &str) -> io::Result<()> {
    print_hanging(out, &format!("  {name:<10} "), fact)
}

fn print_divergence(
    out: &mut dyn Write,
    report: &LogReport,
    divergence: &DivergenceReport,
) -> io::Result<()> {
    let DivergenceReport { event, time, message, fault, cause, .. } = divergence;
    let [number, of] = [*event, report.events.len()].map(|number| grouped(number as u128));
    let time = time.map_or(String::new(), |time| format!(", at {}", since_start(time)));
    let log = printable(&report.log);
    writeln!(out, "{log}: diverges at event {number} of {of}{time}: {fault}")?;
    print_hanging(out, "  ", &format!("{}: {cause}", words::found(divergence)))?;
    if let Some(message) = message {
        writeln!(out, "  {}", words::message_place(message))?;
    }
    let allowed = words::allowed(divergence);
    if !allowed.is_empty() {
        writeln!(out, "  allowed instead:")?;
    }
    for allowed in allowed {
        print_hanging(out, "    ", &allowed)?;
    }
    let before = &report.events[..report.events.len().min(event - 1)];
    let before = &before[before.len().min((event - 1).saturating_sub(BEFORE))..];
    if !before.is_empty() {
        writeln!(out, "  the last steps before it:")?;
    }
    for ReportedEvent { number, kind, then, .. } in before {
        let then = then.as_ref().map(|then| format!(" -> {}", words::event_pose(then)));
        let step = words::event(kind) + &then.unwrap_or_default();
        print_hanging(out, &format!("    {number:>5}  "), &step)?;
    }
    if !report.shorter.is_empty() {
        let mut events: Vec<_> = report.shorter.iter().take(SHORT).map(words::event).collect();
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
