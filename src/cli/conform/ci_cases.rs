//! The results of `toposlam conform` for CI systems.

use std::path::Path;

use super::{outcome, report_lines};
use crate::{
    cli::{Outcome, ci_report::CiCase},
    report::{DivergenceReport, LogReport},
};

/// The result of a log, for CI systems.
pub(super) fn ci_case(path: &Path, report: &LogReport) -> CiCase {
    let result = outcome(report.verdict);
    let message = match (&report.divergence, report.remarks.first()) {
        (Some(DivergenceReport { event, fault, what, why, .. }), _) => {
            format!("diverges at event {event} ({fault}): {what}; {why}")
        }
        (None, Some(remark)) => remark.clone(),
        (None, None) => report_lines::in_words(report.verdict).to_owned(),
    };
    let name = path.display().to_string();
    CiCase { name, outcome: result, message, file: Some(path.to_owned()) }
}

/// The result of the required coverage, for CI systems.
pub(super) fn required_case(outcome: Outcome) -> CiCase {
    let message = match outcome {
        Outcome::Holds => "all required cases are covered",
        _ => "a required case is not covered",
    };
    let name = "required coverage".to_owned();
    CiCase { name, outcome, message: message.to_owned(), file: None }
}

/// The result of a log that cannot be read, for CI systems.
pub(super) fn unread_case(path: &Path) -> CiCase {
    let message = "the log cannot be read".to_owned();
    let name = path.display().to_string();
    CiCase { name, outcome: Outcome::Incomplete, message, file: Some(path.to_owned()) }
}
