//! The summary of several logs.

use toposlam_conform::{
    ConformReports, ConformVerdict, DivergenceReport, LogReport, UnreadLog, words,
};

use super::{Level, coverage, each, panel, wording};
use crate::{moment::grouped, picture::escaped};

/// The verdicts with links to the logs, and the coverage of all logs.
pub(super) fn section(reports: &ConformReports) -> String {
    let worst = wording::worst(reports);
    let heading = Level::First.heading(&format!(
        "{}<strong>{}</strong>",
        wording::sign(worst),
        wording::sentence(&wording::tally(reports)).trim_end_matches('.'),
    ));
    let verdict = worst.name();
    let required = reports.required.as_ref().map(|required| {
        format!("<p>{}</p>\n", escaped(&wording::sentence(&words::required(required))))
    });
    let required = required.unwrap_or_default();
    let ConformReports { logs: reports, unread, .. } = reports;
    let numbered: Vec<_> = reports.iter().zip(1..).collect();
    let table = if reports.is_empty() && unread.is_empty() {
        String::new()
    } else {
        format!(
            "<div class=\"because\"><table class=\"logs\">\n<thead><tr><th scope=\"col\">Log</th>\
             <th scope=\"col\">Verdict</th><th scope=\"col\">Why</th>\
             <th scope=\"col\" class=\"right\">Events</th></tr></thead>\n<tbody>\n{}{}</tbody>\n</table>\
             {required}</div>\n",
            each(&numbered, |(report, number)| row(report, *number)),
            each(unread, unread_row),
        )
    };
    let cases = LogReport::coverage_of(reports);
    let covered = if cases.is_empty() {
        String::new()
    } else {
        let content = coverage::summary(&cases) + &coverage::table(&cases);
        let panel = panel(Level::Second, "", "Coverage of all logs", &content);
        format!("<div class=\"columns\">\n<div>{panel}</div>\n<div></div>\n</div>\n")
    };
    format!(
        "<section id=\"together\">\n<div class=\"verdict {verdict}\">\n{heading}{table}</div>\n{covered}\
         </section>\n"
    )
}

/// A log that could not be checked.
fn unread_row(UnreadLog { log, cause }: &UnreadLog) -> String {
    let verdict = ConformVerdict::Incomplete;
    format!(
        "<tr><th scope=\"row\">{}</th><td class=\"is {}\">{}not checked</td><td>{}</td><td></td></tr>\n",
        escaped(log),
        verdict.name(),
        wording::sign(verdict),
        escaped(cause),
    )
}

fn row(report: &LogReport, number: usize) -> String {
    let verdict = report.verdict.name();
    let why = if let Some(divergence) = &report.divergence {
        let DivergenceReport { event, fault, .. } = divergence;
        let what = escaped(&words::found(divergence));
        format!("<span class=\"chip\">{fault}</span> event {event}: {what}")
    } else {
        let remark = words::remarks(report).into_iter().next();
        remark.map_or_else(|| words::fits(report), |remark| escaped(&remark))
    };
    format!(
        "<tr><th scope=\"row\"><a href=\"#log-{number}\">{}</a></th>\
         <td class=\"is {verdict}\">{}{verdict}</td><td>{why}</td>\
         <td class=\"right number\">{}</td></tr>\n",
        escaped(&report.log),
        wording::sign(report.verdict),
        grouped(report.events.len() as u128),
    )
}
