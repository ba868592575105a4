//! The page of `conform`: for each log its verdict, the first divergence with what is allowed there
//! instead, the events before it, and the coverage. Sections 2 and 6.
//!
//! The page can be read without scripts.

mod coverage;
mod events;
mod log;
mod summary;
mod wording;

#[cfg(test)]
mod tests;

use toposlam_conform::ConformReports;

use super::{PAGE_STYLE, template::filled};
use crate::{moment::grouped, picture::escaped};

/// How reports were made.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReportOrigin {
    /// The version of the program.
    pub version: String,
    /// The command, as a shell reads it.
    pub command: String,
}

const PAGE: &str = include_str!("../browser/conform.html");
const SCRIPT: &str = include_str!("../browser/conform.js");

/// The page of these reports as an HTML document; several, and those with required cases, have a summary above. The
/// same reports give the same bytes.
#[must_use]
pub fn conform_page(reports: &ConformReports, origin: &ReportOrigin) -> String {
    let alone = reports.logs.len() == 1 && reports.unread.is_empty() && reports.required.is_none();
    let numbered: Vec<_> = reports.logs.iter().zip(1..).collect();
    filled(PAGE, |place| match place {
        "title" => escaped(&wording::title(reports)),
        "icon" => wording::icon(wording::worst(reports)),
        "style" => PAGE_STYLE.to_owned(),
        "together" if !alone => summary::section(reports),
        "logs" => each(&numbered, |(report, number)| {
            log::section(report, *number, if alone { Level::First } else { Level::Second })
        }),
        "version" => escaped(&origin.version),
        "command" => command(&origin.command),
        "script" => SCRIPT.to_owned(),
        _ => String::new(),
    })
}

/// The level of a heading.
#[derive(Clone, Copy)]
enum Level {
    First,
    Second,
    Third,
}

impl Level {
    fn beneath(self) -> Self {
        match self {
            Self::First => Self::Second,
            Self::Second | Self::Third => Self::Third,
        }
    }

    /// A heading; its content is HTML.
    fn heading(self, content: &str) -> String {
        let name = match self {
            Self::First => "h1",
            Self::Second => "h2",
            Self::Third => "h3",
        };
        format!("<{name}>{content}</{name}>\n")
    }
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

/// A panel with a heading.
fn panel(level: Level, class: &str, name: &str, content: &str) -> String {
    format!("<section class=\"panel {class}\">\n{}{content}</section>\n", level.heading(name))
}
