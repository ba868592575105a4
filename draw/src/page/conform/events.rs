//! The events of a log: the last ones before the divergence, and all of them.

use std::collections::BTreeSet;

use toposlam_conform::{ConformVerdict, DivergenceReport, LogReport, ReportedEvent, words};

use super::{each, sign};
use crate::{
    moment::{clock, grouped},
    picture::escaped,
};

/// The number of events shown before a divergence.
const BEFORE: usize = 3;
/// The number of events in a table. The browser lays out only the tables on the screen.
const LEAF: usize = 100;

/// The events before the divergence, and the diverging one; nothing without a divergence.
pub(super) fn before(report: &LogReport, log: usize) -> String {
    let Some(divergence) = &report.divergence else { return String::new() };
    let earlier = report.events.partition_point(|line| line.number < divergence.event);
    let last = &report.events[earlier.saturating_sub(BEFORE)..earlier];
    let rows = each(last, |line| row(line, "", "")) + &diverging(divergence, report, "");
    let all = link(log, divergence.event, "among all events");
    format!("{}<p class=\"faint\">{all}</p>\n", table(&rows))
}

/// All events, folded.
pub(super) fn all(report: &LogReport, log: usize) -> String {
    let divergence = report.divergence.as_ref();
    let tolerated: BTreeSet<_> =
        report.tolerated.iter().flat_map(|quirk| &quirk.events).copied().collect();
    let row = |line: &ReportedEvent| match divergence {
        Some(divergence) if divergence.event == line.number => {
            diverging(divergence, report, &id(log, line.number))
        }
        _ if tolerated.contains(&line.number) => row(line, " class=let", &id(log, line.number)),
        _ => row(line, "", ""),
    };
    let leaf = |lines: &[ReportedEvent]| {
        format!("<div class=\"leaf\">{}</div>\n", table(&each(lines, row)))
    };
    // An event that is missing at the end has no line.
    let missing = divergence.filter(|found| line_of(found, report).is_none());
    let missing = each(missing, |found| table(&diverging(found, report, &id(log, found.event))));
    let summary = match report.events.len() {
        0 => "No event".to_owned(),
        1 => "The only event".to_owned(),
        count => format!("All {} events", grouped(count as u128)),
    };
    format!(
        "<details class=\"all\">\n<summary>{summary}</summary>\n{}{missing}</details>\n",
        each(report.events.chunks(LEAF), leaf),
    )
}

/// A link to an event among all.
pub(super) fn link(log: usize, event: usize, words: &str) -> String {
    format!("<a href=\"#event-{log}-{event}\">{words}</a>")
}

fn id(log: usize, event: usize) -> String {
    format!(" id=event-{log}-{event}")
}

/// The line of the event that diverges; none if it is missing at the end.
fn line_of<'r>(divergence: &DivergenceReport, report: &'r LogReport) -> Option<&'r ReportedEvent> {
    report.events.iter().find(|line| line.number == divergence.event)
}

fn table(rows: &str) -> String {
    format!(
        "<table class=\"events\">\n<thead><tr><th scope=\"col\">Event</th><th scope=\"col\">Time</th>\
         <th scope=\"col\">What happened</th><th scope=\"col\">Change</th></tr></thead>\n\
         <tbody>\n{rows}</tbody>\n</table>\n"
    )
}

/// A line. Optional end tags are left out, since there are many.
fn row(line: &ReportedEvent, class: &str, id: &str) -> String {
    format!(
        "<tr{class}{id}><td>{}<td>{}<td>{}<td>{}\n",
        line.number,
        clock(line.time),
        escaped(&words::event(&line.kind)),
        escaped(&line.then.as_ref().map(words::event_pose).unwrap_or_default()),
    )
}

fn diverging(divergence: &DivergenceReport, report: &LogReport, id: &str) -> String {
    let line = line_of(divergence, report);
    let time = line.map_or(divergence.time.unwrap_or(0.0), |line| line.time);
    format!(
        "<tr class=off{id}><td>{}<td>{}<td>{}<td>{} does not fit\n",
        divergence.event,
        clock(time),
        escaped(&words::found(divergence)),
        sign(ConformVerdict::Diverged),
    )
}
