//! The words and signs of the page.

use base64::{Engine, engine::general_purpose::STANDARD};
use toposlam_conform::{ConformReports, ConformVerdict};

use crate::{moment::grouped, text::counted};

/// The worst verdict; incomplete without any log, with an unreadable one, or without a required case.
pub(super) fn worst(reports: &ConformReports) -> ConformVerdict {
    let any = |verdict| reports.count(verdict) > 0;
    let is_missing = reports.logs.is_empty() || !reports.unread.is_empty();
    let is_uncovered =
        reports.required.as_ref().is_some_and(|required| !required.not_covered.is_empty());
    if any(ConformVerdict::Diverged) {
        ConformVerdict::Diverged
    } else if any(ConformVerdict::Incomplete) || is_missing || is_uncovered {
        ConformVerdict::Incomplete
    } else {
        ConformVerdict::Conforms
    }
}

/// The title of the window.
pub(super) fn title(reports: &ConformReports) -> String {
    match &reports.logs[..] {
        [report] if reports.unread.is_empty() && reports.required.is_none() => {
            format!("{}: {}", report.log, report.verdict.name())
        }
        _ => tally(reports),
    }
}

/// The number of logs with each verdict, the worst first.
pub(super) fn tally(reports: &ConformReports) -> String {
    let ConformReports { logs, unread, required } = reports;
    if logs.is_empty() && unread.is_empty() {
        return "no log was checked".to_owned();
    }
    let counts = [ConformVerdict::Diverged, ConformVerdict::Incomplete, ConformVerdict::Conforms]
        .map(|verdict| (reports.count(verdict), verdict));
    let unreadable =
        Some(unread.len()).filter(|&count| count > 0).map(|count| format!("{count} not checked"));
    let verdicts = counts.iter().filter(|(count, _)| *count > 0);
    let parts: Vec<_> = verdicts
        .map(|(count, verdict)| match (verdict, count) {
            (ConformVerdict::Conforms, 2..) => format!("{} conform", grouped(*count as u128)),
            _ => format!("{} {}", grouped(*count as u128), verdict.name()),
        })
        .chain(unreadable)
        .collect();
    let required =
        required.as_ref().map_or(String::new(), |required| match &required.not_covered[..] {
            [] => "; all required cases are covered".to_owned(),
            [case] => format!("; {case} is not covered"),
            cases => format!("; {} required cases are not covered", cases.len()),
        });
    let count = counted(logs.len() + unread.len(), "log");
    format!("{count}: {}{required}", parts.join(", "))
}

/// A sentence with a capital letter and a full stop.
pub(super) fn sentence(words: &str) -> String {
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
        ConformVerdict::Incomplete => "M4.5 12h.01M12 12h.01M19.5 12h.01",
    }
}

/// A verdict's sign, as an element of the page.
pub(super) fn sign(verdict: ConformVerdict) -> String {
    let strokes = strokes(verdict);
    format!(
        "<svg class=\"sign\" viewBox=\"0 0 24 24\" aria-hidden=\"true\"><path d=\"{strokes}\"/></svg>"
    )
}

/// A verdict's sign, as the address of an image.
pub(super) fn icon(verdict: ConformVerdict) -> String {
    let (ground, ink) = match verdict {
        ConformVerdict::Conforms => ("#00684f", "#fff"),
        ConformVerdict::Diverged => ("#b23a00", "#fff"),
        ConformVerdict::Incomplete => ("#ffcf33", "#2b2100"),
    };
    svg_address(&format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-4 -4 32 32\">\
         <circle cx=\"12\" cy=\"12\" r=\"16\" fill=\"{ground}\"/><path d=\"{}\" fill=\"none\" \
         stroke=\"{ink}\" stroke-width=\"4\" stroke-linecap=\"round\"/></svg>",
        strokes(verdict)
    ))
}

/// A drawing as the address of an image, so that it cannot run scripts or share names with the page.
pub(super) fn svg_address(svg: &str) -> String {
    format!("data:image/svg+xml;base64,{}", STANDARD.encode(svg))
}

/// The width of a drawing in its own size, in pixels.
pub(super) fn svg_width(svg: &str) -> Option<u32> {
    let (_, width) = svg.split_once(" width=\"")?;
    width.split_once('"')?.0.parse().ok()
}

/// A JPEG or PNG file as the address of an image; `None` if it is neither.
pub(super) fn image_address(file: &[u8]) -> Option<String> {
    let kind = if file.starts_with(b"\xff\xd8\xff") {
        "jpeg"
    } else if file.starts_with(b"\x89PNG\r\n\x1a\n") {
        "png"
    } else {
        return None;
    };
    Some(format!("data:image/{kind};base64,{}", STANDARD.encode(file)))
}
