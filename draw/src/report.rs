//! Conformance reports for people: the verdict, the first divergence, what was allowed there, the events
//! before it, the coverage. Sections 2 and 6.

use std::fmt;

use toposlam_conform::{ConformVerdict, FaultClass};
use toposlam_logs::error::OffsetUnit;

use crate::moment::grouped;

/// How reports were made.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReportOrigin {
    /// The version of the program.
    pub version: String,
    /// The command, as a shell reads it.
    pub command: String,
}

/// A file that was read for a report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceFile {
    /// What it is, for example `log`.
    pub role: &'static str,
    /// Its path.
    pub path: String,
    /// The SHA-256 hash of its bytes, in hexadecimal.
    pub sha256: String,
}

/// The reports on the logs of one command.
#[derive(Clone, Debug, Default)]
pub struct ConformReports {
    /// The logs that were checked.
    pub logs: Vec<LogReport>,
    /// The logs that were not.
    pub unread: Vec<UnreadLog>,
    /// The cases that the logs must cover together, if some are required.
    pub required: Option<RequiredCoverage>,
}

/// A log that could not be checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnreadLog {
    /// The file of the log.
    pub log: String,
    /// Why.
    pub cause: String,
}

/// The cases that logs must cover.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RequiredCoverage {
    /// Their names.
    pub required: Vec<String>,
    /// Those that are not covered.
    pub not_covered: Vec<String>,
    /// Those of them that the algorithm of the logs does not have.
    pub not_applicable: Vec<String>,
}

impl RequiredCoverage {
    /// Which cases are not covered, in words.
    #[must_use]
    pub fn in_words(&self) -> String {
        let Self { required, not_covered, not_applicable } = self;
        let not_covered = match &not_covered[..] {
            [] => "all are covered".to_owned(),
            not => format!("not covered: {}", not.join(", ")),
        };
        let foreign = match &not_applicable[..] {
            [] => String::new(),
            cases => format!(
                "; the folding explorer does not have these cases of Algorithm 1: {}",
                cases.join(", ")
            ),
        };
        let cases = if required.len() == 1 { "required case" } else { "required cases" };
        format!("{} {cases}: {not_covered}{foreign}", required.len())
    }
}

/// The report on a log.
#[derive(Clone, Debug)]
pub struct LogReport {
    /// The file of the log.
    pub log: String,
    /// The verdict.
    pub verdict: ConformVerdict,
    /// The reasons for the verdict, and further remarks, as sentences.
    pub remarks: Vec<String>,
    /// What was checked, and against what: lines of a name and a text.
    pub facts: Vec<(&'static str, String)>,
    /// The date of the first message; `None` if the log has none.
    pub begun: Option<String>,
    /// The files that were read, if their hashes are wanted.
    pub sources: Vec<SourceFile>,
    /// Every event.
    pub events: Vec<EventLine>,
    /// The first divergence.
    pub divergence: Option<DivergenceReport>,
    /// The specification cases, and how often the log covered each.
    pub coverage: Vec<CoveredCase>,
    /// The tolerated divergences: the name of the quirk, its reason, and the events, counted from 1.
    pub tolerated: Vec<(String, String, Vec<usize>)>,
    /// A shorter log that diverges in the same way, event by event.
    pub shorter: Vec<String>,
    /// The command that checks it, if it was written.
    pub command: Option<String>,
    /// The camera image at the divergence, or the last one before it, as a JPEG or PNG file.
    pub image: Option<Vec<u8>>,
    /// What the events before the divergence, or all events, prove about the world; `None` if this is not
    /// known, or if the log determines its world.
    pub folded: Option<FoldedReport>,
    /// The known world, or the smallest one that explains the log, as an SVG document.
    pub world: Option<String>,
    /// Another world that the marker does not distinguish from it, as an SVG document.
    pub twin: Option<String>,
}

/// A folded trail with open doors.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoldedReport {
    /// The number of vertices.
    pub vertices: usize,
    /// The number of doors that were never followed.
    pub open_doors: usize,
    /// The folded trail as an SVG document; `None` if it is too large.
    pub drawing: Option<String>,
}

impl LogReport {
    /// The text of a fact.
    pub(crate) fn fact(&self, name: &str) -> Option<&str> {
        self.facts.iter().find(|(known, _)| *known == name).map(|(_, fact)| &**fact)
    }

    /// The coverage of several logs together. A case is reachable if it is in the world of any log.
    #[must_use]
    pub fn coverage_of(reports: &[Self]) -> Vec<CoveredCase> {
        let mut together: Vec<CoveredCase> = Vec::new();
        for covered in reports.iter().flat_map(|report| &report.coverage) {
            match together.iter_mut().find(|known| known.case == covered.case) {
                None => together.push(covered.clone()),
                Some(known) => {
                    known.count = known.count.saturating_add(covered.count);
                    known.expected |= covered.expected;
                    known.reachable = match (known.reachable, covered.reachable) {
                        (Some(true), _) | (_, Some(true)) => Some(true),
                        (Some(false), Some(false)) => Some(false),
                        _ => None,
                    };
                }
            }
        }
        together
    }
}

/// An event, as a line of text.
#[derive(Clone, Debug, PartialEq)]
pub struct EventLine {
    /// The number of the event, from 1.
    pub number: usize,
    /// Seconds since the first message.
    pub time: f64,
    /// What happened.
    pub what: String,
    /// The state after it: where the robot is, or the number of poses that fit.
    pub then: String,
}

/// A divergence, in words.
#[derive(Clone, Debug, PartialEq)]
pub struct DivergenceReport {
    /// The number of the event, from 1; one more than there are if an event is missing at the end.
    pub event: usize,
    /// Seconds since the first message; `None` if the log has no times.
    pub time: Option<f64>,
    /// The message of the event; none at the end.
    pub message: Option<MessagePlace>,
    /// The class of the fault.
    pub fault: FaultClass,
    /// The cause, one word.
    pub cause: &'static str,
    /// What happened.
    pub what: String,
    /// The condition that is false.
    pub why: String,
    /// What was allowed, and in which pose.
    pub allowed: Vec<String>,
}

/// Where a message stands in a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MessagePlace {
    /// The number of the message in the log, from 1.
    pub number: u64,
    /// Its offset in its file.
    pub offset: u64,
    /// What the offset counts.
    pub unit: OffsetUnit,
}

impl fmt::Display for MessagePlace {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [number, offset] = [self.number, self.offset].map(|number| grouped(number.into()));
        write!(out, "message {number} of the log, at {} {offset}", self.unit.name())
    }
}

/// A specification case, and how often a log covered it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CoveredCase {
    /// Its name.
    pub case: String,
    /// The number of times.
    pub count: u64,
    /// Whether the known world can reach it; `None` if no world is known.
    pub reachable: Option<bool>,
    /// Whether a complete run from the log's start has it: Algorithm 1 with its default choices, in the
    /// known world.
    pub expected: bool,
}
