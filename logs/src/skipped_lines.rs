//! The lines of a log that are not read.

use std::{collections::BTreeMap, fmt};

use serde::Serialize;
use toposlam_model::counts::grouped;

/// The number of lines of a log that are skipped, by the reason. Comments do not count.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SkippedLines {
    /// Of each kind that is not known, by their first word or `kind`.
    pub unknown: BTreeMap<String, u64>,
    /// Of further kinds that are not known.
    #[serde(rename = "other_kinds")]
    pub others: u64,
}

/// The largest number of kinds that are counted apart.
const KINDS: usize = 16;

impl SkippedLines {
    pub fn is_empty(&self) -> bool {
        self.unknown.is_empty()
    }

    pub(super) fn add_unknown(&mut self, kind: String) {
        if self.unknown.contains_key(&kind) || self.unknown.len() < KINDS {
            *self.unknown.entry(kind).or_default() += 1;
        } else {
            self.others += 1;
        }
    }
}

impl fmt::Display for SkippedLines {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = |lines: u64| grouped(lines.into());
        let kinds = self.unknown.iter();
        let mut parts: Vec<_> = kinds
            .map(|(kind, lines)| format!("{} {}", count(*lines), kind.escape_debug()))
            .collect();
        if self.others > 0 {
            parts.push(format!("{} of other kinds", count(self.others)));
        }
        write!(out, "lines: {}", parts.join(", "))
    }
}
