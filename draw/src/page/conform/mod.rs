//! The page of `conform`: for each log its verdict, the first divergence with what is allowed there
//! instead, the events before it, and the coverage. Sections 2 and 6.
//!
//! The page can be read without scripts.

mod coverage;
mod events;
mod log;

use base64::{Engine, engine::general_purpose::STANDARD};
use toposlam_conform::{
    ConformReports, ConformVerdict, DivergenceReport, LogReport, UnreadLog, words,
};

use super::{PAGE_STYLE, template::filled};
use crate::{moment::grouped, picture::escaped, text::counted};

/// How reports were made.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReportOrigin {
    pub version: String,
    /// The command, as a shell reads it.
    pub command: String,
}

const PAGE: &str = include_str!("../browser/conform.html");
const SCRIPT: &str = include_str!("../browser/conform.js");

/// The page of these reports as an HTML document; several, and those with required cases, have a summary above. The
/// same reports give the same bytes.
pub fn conform_page(reports: &ConformReports, origin: &ReportOrigin) -> String {
    let alone = match &reports.logs[..] {
        [report] if reports.unread.is_empty() && reports.required.is_none() => Some(report),
        _ => None,
    };
    let level = if alone.is_some() { Level::First } else { Level::Second };
    let title = alone.map(|report| format!("{}: {}", report.log, report.verdict.in_words()));
    let together = if alone.is_some() { String::new() } else { summary(reports) };
    let logs = reports.logs.iter().zip(1..);
    let logs = each(logs, |(report, number)| log::section(report, number, level));
    filled(
        PAGE,
        &[
            ("title", &escaped(&title.unwrap_or_else(|| tally(reports)))),
            ("icon", &icon(worst(reports))),
            ("style", PAGE_STYLE),
            ("together", &together),
            ("logs", &logs),
            ("version", &escaped(&origin.version)),
            ("command", &command(&origin.command)),
            ("script", SCRIPT),
        ],
    )
}

#[derive(Clone, Copy)]
enum Level {
    First = 1,
    Second,
    Third,
}

/// A heading; its content is HTML.
fn heading(level: Level, content: &str) -> String {
    let level = level as u8;
    format!("<h{level}>{content}</h{level}>\n")
}

/// The concatenated text of all items.
fn each<T>(items: impl IntoIterator<Item = T>, of: impl Fn(T) -> String) -> String {
    items.into_iter().map(of).collect()
}

/// A list whose items beyond the first few are folded.
fn short_list<T>(items: &[T], few: usize, of: impl Fn(&T) -> String) -> String {
    let list = |items: &[T]| format!("<ul>\n{}</ul>\n", each(items, &of));
    // One more item is as short as the note that would replace it.
    if items.len() <= few + 1 {
        return list(items);
    }
    let (first, rest) = items.split_at(few);
    let count = grouped(rest.len() as u128);
    let more = format!("<details><summary>{count} more</summary>\n{}</details>\n", list(rest));
    list(first) + &more
}

/// A command that can be copied.
fn command(command: &str) -> String {
    format!(
        "<div class=\"command\"><pre><code>{}</code></pre>\
         <button type=\"button\" class=\"copy\" hidden>Copy</button></div>\n",
        escaped(command)
    )
}

/// A paragraph of one sentence: with a capital letter and a full stop.
fn paragraph(words: &str) -> String {
    format!("<p>{}</p>\n", escaped(&sentence(words)))
}

/// A panel with a heading; nothing without a content.
fn panel(level: Level, class: &str, name: &str, content: &str) -> String {
    if content.is_empty() {
        return String::new();
    }
    format!("<section class=\"panel {class}\">\n{}{content}</section>\n", heading(level, name))
}

/// The verdicts of several logs with links to them, and the coverage of all logs.
fn summary(reports: &ConformReports) -> String {
    let worst = worst(reports);
    let heading = heading(
        Level::First,
        &format!(
            "{}<strong>{}</strong>",
            sign(worst),
            sentence(&tally(reports)).trim_end_matches('.')
        ),
    );
    let required = reports.required.as_ref().map(|it| paragraph(&words::required(it)));
    let required = required.unwrap_or_default();
    let rows = each(reports.logs.iter().zip(1..), |(report, number)| row(report, number))
        + &each(&reports.unread, unread_row);
    let table = if rows.is_empty() {
        String::new()
    } else {
        format!(
            "<div class=\"because\"><table class=\"logs\">\n<thead><tr><th scope=\"col\">Log</th>\
             <th scope=\"col\">Verdict</th><th scope=\"col\">Why</th>\
             <th scope=\"col\" class=\"right\">Events</th></tr></thead>\n<tbody>\n{rows}</tbody>\n</table>\
             {required}</div>\n"
        )
    };
    let covered = coverage::content(&LogReport::coverage_of(&reports.logs));
    let covered = panel(Level::Second, "", "Coverage of all logs", &covered);
    let covered = if covered.is_empty() {
        covered
    } else {
        format!("<div class=\"columns\">\n<div>{covered}</div>\n<div></div>\n</div>\n")
    };
    format!(
        "<section id=\"together\">\n<div class=\"verdict {}\">\n{heading}{table}</div>\n{covered}\
         </section>\n",
        worst.name()
    )
}

/// A log that could not be checked.
fn unread_row(UnreadLog { log, cause }: &UnreadLog) -> String {
    let verdict = ConformVerdict::NotKnown;
    format!(
        "<tr><th scope=\"row\">{}</th><td class=\"is {}\">{}not checked</td><td>{}</td><td></td></tr>\n",
        escaped(log),
        verdict.name(),
        sign(verdict),
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
        let remark = remark.map(|remark| escaped(&remark));
        remark.or_else(|| words::fits(report)).unwrap_or_default()
    };
    format!(
        "<tr><th scope=\"row\"><a href=\"#log-{number}\">{}</a></th>\
         <td class=\"is {verdict}\">{}{}</td><td>{why}</td>\
         <td class=\"right number\">{}</td></tr>\n",
        escaped(&report.log),
        sign(report.verdict),
        report.verdict.in_words(),
        grouped(report.events.len() as u128),
    )
}

/// The worst verdict; not known without any log, with an unreadable one, or without a required case.
fn worst(reports: &ConformReports) -> ConformVerdict {
    let any = |verdict| reports.count(verdict) > 0;
    let is_missing = reports.logs.is_empty() || !reports.unread.is_empty();
    let is_uncovered =
        reports.required.as_ref().is_some_and(|required| !required.not_covered.is_empty());
    if any(ConformVerdict::Diverged) {
        ConformVerdict::Diverged
    } else if any(ConformVerdict::NotKnown) || is_missing || is_uncovered {
        ConformVerdict::NotKnown
    } else {
        ConformVerdict::Conforms
    }
}

/// The number of logs with each verdict, the worst first.
fn tally(reports: &ConformReports) -> String {
    let ConformReports { logs, unread, required } = reports;
    if logs.is_empty() && unread.is_empty() {
        return "no log was checked".to_owned();
    }
    let many = if reports.count(ConformVerdict::Conforms) > 1 { "conform" } else { "conforms" };
    let parts: Vec<_> = [
        (reports.count(ConformVerdict::Diverged), "diverged"),
        (reports.count(ConformVerdict::NotKnown), "not known"),
        (reports.count(ConformVerdict::Conforms), many),
        (unread.len(), "not checked"),
    ]
    .into_iter()
    .filter(|(count, _)| *count > 0)
    .map(|(count, what)| format!("{} {what}", grouped(count as u128)))
    .collect();
    let required = match required.as_ref().map(|required| &required.not_covered[..]) {
        None => String::new(),
        Some([]) => "; all required cases are covered".to_owned(),
        Some([case]) => format!("; {case} is not covered"),
        Some(cases) => format!("; {} required cases are not covered", cases.len()),
    };
    let count = counted(logs.len() + unread.len(), "log");
    format!("{count}: {}{required}", parts.join(", "))
}

/// A sentence with a capital letter and a full stop.
fn sentence(words: &str) -> String {
    let mut letters = words.trim().chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string());
    let sentence = first.unwrap_or_default() + letters.as_str();
    let ended = sentence.is_empty() || sentence.ends_with(['.', '!', '?', ':']);
    if ended { sentence } else { sentence + "." }
}

/// The lines of a verdict's sign: a tick, a cross, three dots.
fn strokes(verdict: ConformVerdict) -> &'static str {
    match verdict {
        ConformVerdict::Conforms => "M4 13l5.5 5.5L20 6",
        ConformVerdict::Diverged => "M5.5 5.5l13 13m0-13l-13 13",
        ConformVerdict::NotKnown => "M4.5 12h.01M12 12h.01M19.5 12h.01",
    }
}

/// A verdict's sign, as an element of the page.
fn sign(verdict: ConformVerdict) -> String {
    let strokes = strokes(verdict);
    format!(
        "<svg class=\"sign\" viewBox=\"0 0 24 24\" aria-hidden=\"true\"><path d=\"{strokes}\"/></svg>"
    )
}

/// A verdict's sign, as the address of an image.
fn icon(verdict: ConformVerdict) -> String {
    let (ground, ink) = match verdict {
        ConformVerdict::Conforms => ("#00684f", "#fff"),
        ConformVerdict::Diverged => ("#b23a00", "#fff"),
        ConformVerdict::NotKnown => ("#ffcf33", "#2b2100"),
    };
    let svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-4 -4 32 32\">\
         <circle cx=\"12\" cy=\"12\" r=\"16\" fill=\"{ground}\"/><path d=\"{}\" fill=\"none\" \
         stroke=\"{ink}\" stroke-width=\"4\" stroke-linecap=\"round\"/></svg>",
        strokes(verdict)
    );
    data_address("svg+xml", svg.as_bytes())
}

/// An image as an address. It cannot run scripts or share names with the page.
fn data_address(kind: &str, file: &[u8]) -> String {
    format!("data:image/{kind};base64,{}", STANDARD.encode(file))
}
