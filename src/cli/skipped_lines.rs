//! The lines of a log of lines that are not read, in words and as fields.

use std::collections::BTreeMap;

use serde::Serialize;
use toposlam_robot::log::SkippedLines;

use super::text::grouped;

/// The lines of a log of lines that are not read, in JSON.
#[derive(Serialize)]
pub(super) struct SkippedLinesFields<'l> {
    unknown: &'l BTreeMap<String, u64>,
    other_kinds: u64,
    off_clock: u64,
}

impl<'l> From<&'l SkippedLines> for SkippedLinesFields<'l> {
    fn from(skipped: &'l SkippedLines) -> Self {
        Self {
            unknown: skipped.unknown(),
            other_kinds: skipped.others(),
            off_clock: skipped.off_clock(),
        }
    }
}

/// The lines that are skipped, in words.
pub(super) fn in_words(skipped: &SkippedLines) -> String {
    let kinds = skipped.unknown().iter();
    let mut parts: Vec<_> = kinds
        .map(|(kind, count)| format!("{} {}", grouped((*count).into()), kind.escape_debug()))
        .collect();
    if skipped.others() > 0 {
        parts.push(format!("{} of other kinds", grouped(skipped.others().into())));
    }
    if skipped.off_clock() > 0 {
        let count = grouped(skipped.off_clock().into());
        parts.push(format!("{count} whose time is far from that of their neighbours"));
    }
    format!("lines: {}", parts.join(", "))
}
