//! The results of `toposlam conform` for CI systems.

use std::path::Path;

use super::{outcome, report_lines, required_coverage};
use crate::{
    cli::{Outcome, ci_report::CiCase},
    report::{DivergenceReport, LogReport, RequiredCoverage, UnreadLog},
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
pub(super) fn required_case(required: &RequiredCoverage) -> CiCase {
    let name = "required coverage".to_owned();
    let message = required.in_words();
    CiCase { name, outcome: required_coverage::outcome(required), message, file: None }
}

/// The result of a log that cannot be checked, for CI systems.
pub(super) fn unread_case(path: &Path, unread: &UnreadLog) -> CiCase {
    let UnreadLog { log, cause } = unread;
    let message = format!("the log cannot be checked: {cause}");
    let (name, file) = (log.clone(), Some(path.to_owned()));
    CiCase { name, outcome: Outcome::Incomplete, message, file }
}
