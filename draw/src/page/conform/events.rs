//! The events of a log: the last ones before the divergence, and all of them.

use std::collections::BTreeSet;

use toposlam_conform::{ConformVerdict, LogReport, ReportedEvent, words};

use super::{each, wording};
use crate::{
    moment::{clock, grouped},
    picture::escaped,
};

/// The number of events shown before a divergence.
const BEFORE: usize = 3;
/// The number of events in a table. The browser lays out only the tables on the screen.
const LEAF: usize = 100;

/// The events before the divergence, and the diverging one.
pub(super) fn before(report: &LogReport) -> Option<String> {
    let divergence = report.divergence.as_ref()?;
    let earlier = report.events.partition_point(|line| line.number < divergence.event);
    let last = report.events.get(earlier.saturating_sub(BEFORE)..earlier)?;
    let here = report.events.get(earlier).filter(|line| line.number == divergence.event);
    let rows = each(last, |line| row(line, "", ""));
    let time = here.map_or(divergence.time.unwrap_or(0.0), |line| line.time);
    let what = words::found(divergence);
    Some(table(&(rows + &diverging(divergence.event, time, &what, ""))))
}

/// All events, folded.
pub(super) fn all(report: &LogReport, log: usize) -> String {
    let off = report.divergence.as_ref().map(|divergence| divergence.event);
    let let_pass: BTreeSet<_> =
        report.tolerated.iter().flat_map(|quirk| &quirk.events).copied().collect();
    let row = |line: &ReportedEvent| {
        if off == Some(line.number) {
            let id = id(log, line.number);
            return diverging(line.number, line.time, &words::event(&line.kind), &id);
        }
        if let_pass.contains(&line.number) {
            return row(line, " class=let", &id(log, line.number));
        }
        row(line, "", "")
    };
    let leaf = |lines: &[ReportedEvent]| {
        format!("<div class=\"leaf\">{}</div>\n", table(&each(lines, row)))
    };
    // An event that is missing at the end has no line.
    let missing = report.divergence.as_ref().filter(|_| !has_divergence(report));
    let missing = missing.map_or_else(String::new, |divergence| {
        table(&diverging(
            divergence.event,
            divergence.time.unwrap_or(0.0),
            &words::found(divergence),
            &id(log, divergence.event),
        ))
    });
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

fn has_divergence(report: &LogReport) -> bool {
    let off = report.divergence.as_ref().map(|divergence| divergence.event);
    report.events.iter().any(|line| off == Some(line.number))
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

fn diverging(event: usize, time: f64, what: &str, id: &str) -> String {
    format!(
        "<tr class=off{id}><td>{event}<td>{}<td>{}<td>{} does not fit\n",
        clock(time),
        escaped(what),
        wording::sign(ConformVerdict::Diverged),
    )
}
