//! What the specification says of a log, as a person reads it: the verdict, where the run first diverged
//! and what would have been allowed there, what led there, what was covered. Sections 2 and 6.

use toposlam_robot::conform::{ConformVerdict, FaultClass};

/// What is said of a log.
#[derive(Clone, Debug)]
pub struct LogReport {
    /// The log's file.
    pub log: String,
    /// The verdict.
    pub verdict: ConformVerdict,
    /// Why the verdict is no better, or what is said besides; in sentences.
    pub remarks: Vec<String>,
    /// What was judged, and against what, line by line: a name and what is said.
    pub facts: Vec<(&'static str, String)>,
    /// Every event.
    pub events: Vec<EventLine>,
    /// Where the run first diverged.
    pub divergence: Option<DivergenceReport>,
    /// How often each case was gone through, and whether it can be in the known world.
    pub coverage: Vec<CoveredCase>,
    /// What was tolerated: the quirk's name, its reason, and at which events, counted from 1.
    pub tolerated: Vec<(String, String, Vec<usize>)>,
    /// A shorter log that diverges in the same way, event by event.
    pub shorter: Vec<String>,
    /// The command that judges it, where it was written.
    pub command: Option<String>,
    /// What the camera saw when the run diverged, or last before it, as the bytes of a JPEG or PNG file.
    pub picture: Option<Vec<u8>>,
    /// The known world, or the smallest that explains the log, as an SVG document.
    pub world: Option<String>,
}

impl LogReport {
    /// How often each case was gone through in several logs together; one that can be in any of their
    /// worlds can be.
    #[must_use]
    pub fn coverage_of(reports: &[Self]) -> Vec<CoveredCase> {
        let mut together: Vec<CoveredCase> = Vec::new();
        for covered in reports.iter().flat_map(|report| &report.coverage) {
            match together.iter_mut().find(|known| known.case == covered.case) {
                None => together.push(covered.clone()),
                Some(known) => {
                    known.count = known.count.saturating_add(covered.count);
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

/// An event, as a line.
#[derive(Clone, Debug, PartialEq)]
pub struct EventLine {
    /// Which event, counted from 1.
    pub number: usize,
    /// When, in seconds since the first message.
    pub time: f64,
    /// What happened.
    pub what: String,
    /// What is different after it: where the robot is, or in how many ways it may stand.
    pub then: String,
}

/// A divergence, as a person reads it.
#[derive(Clone, Debug, PartialEq)]
pub struct DivergenceReport {
    /// Which event, counted from 1; one more than there are, where one is missing at the end.
    pub event: usize,
    /// When, in seconds since the first message.
    pub time: f64,
    /// Which message of the log, counted from 1, and where it begins in the file; none at the end.
    pub message: Option<(u64, u64)>,
    /// Whose fault it is.
    pub culprit: FaultClass,
    /// A word for what does not fit.
    pub cause: &'static str,
    /// What happened.
    pub what: String,
    /// Which condition is false.
    pub why: String,
    /// What would have been allowed, and for whom.
    pub allowed: Vec<String>,
}

/// A case and how often it was gone through.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CoveredCase {
    /// Its name.
    pub case: String,
    /// How often.
    pub count: u64,
    /// Whether it can be gone through in the known world; `None` where none is known.
    pub reachable: Option<bool>,
}
