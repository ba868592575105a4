//! The lines of a log of lines that are not read, as fields.

use std::collections::BTreeMap;

use serde::Serialize;
use toposlam_logs::SkippedLines;

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
