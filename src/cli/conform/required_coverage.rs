//! The cases that the logs must cover: `--require-coverage`.

use std::io::Write;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use serde::Serialize;
use toposlam_conform::{FORMS, RunCoverage};
use toposlam_model::trace::AlgorithmCase;

use super::{CliError, Outcome};
use crate::{
    cli::{json::print_line, text::print_hanging},
    report::RequiredCoverage,
};

/// What `--json` prints.
#[derive(Serialize)]
struct Line<'r> {
    required: &'r [String],
    not_covered: &'r [String],
    /// The cases of Algorithm 1, if all logs are compared with the folding explorer.
    not_applicable: &'r [String],
}

/// Parses the name of a case.
pub(super) fn cases() -> impl TypedValueParser<Value = String> {
    let algorithm = AlgorithmCase::ALL.into_iter().map(AlgorithmCase::name);
    let junctions = FORMS.into_iter().map(|(_, name)| name);
    PossibleValuesParser::new(algorithm.chain(junctions))
}

/// Whether a case is one of Algorithm 1, and not a junction.
pub(super) fn is_of_algorithm1(case: &str) -> bool {
    AlgorithmCase::ALL.iter().any(|one| one.name() == case)
}

/// Which required cases are not covered. If all logs are compared with the folding explorer, the cases of
/// Algorithm 1 do not apply.
pub(super) fn required_coverage(
    required: &[String],
    coverage: &RunCoverage,
    any_algorithm1: bool,
) -> RequiredCoverage {
    let not_covered: Vec<_> =
        required.iter().filter(|case| !covers(coverage, case)).cloned().collect();
    let foreign = not_covered.iter().filter(|case| !any_algorithm1 && is_of_algorithm1(case));
    let not_applicable = foreign.cloned().collect();
    RequiredCoverage { required: required.to_vec(), not_covered, not_applicable }
}

/// Prints which required cases are not covered.
pub(super) fn print(
    out: &mut dyn Write,
    found: &RequiredCoverage,
    as_json: bool,
) -> Result<(), CliError> {
    let RequiredCoverage { required, not_covered, not_applicable } = found;
    if as_json {
        return print_line(
            out,
            "required-coverage",
            &Line { required, not_covered, not_applicable },
        );
    }
    Ok(print_hanging(out, "", &found.in_words())?)
}

/// The result.
pub(super) fn outcome(found: &RequiredCoverage) -> Outcome {
    if found.not_covered.is_empty() { Outcome::Holds } else { Outcome::Incomplete }
}

fn covers(coverage: &RunCoverage, name: &str) -> bool {
    let count = |case| coverage.algorithm.count(case) > 0;
    let mut algorithm = AlgorithmCase::ALL.into_iter().filter(|case| case.name() == name);
    let mut junctions = FORMS.into_iter().filter(|(_, form)| *form == name);
    algorithm.any(count) || junctions.any(|(form, _)| coverage.junctions.contains_key(&form))
}
