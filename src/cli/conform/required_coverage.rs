//! The cases that the logs must cover: `--require-coverage`.

use std::io::Write;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use serde::Serialize;
use toposlam_model::trace::AlgorithmCase;
use toposlam_robot::{conform::RunCoverage, evaluation::scene_class::FORMS};

use super::{CliError, Outcome};
use crate::cli::{
    json::print_line,
    text::{counted, print_hanging},
};

/// What `--json` prints.
#[derive(Serialize)]
struct Line<'r> {
    required: &'r [String],
    not_covered: Vec<&'r str>,
    /// The cases of Algorithm 1, if all logs are compared with the folding explorer.
    not_applicable: Vec<&'r str>,
}

/// Parses the name of a case.
pub(super) fn cases() -> impl TypedValueParser<Value = String> {
    let algorithm = AlgorithmCase::ALL.into_iter().map(AlgorithmCase::name);
    let junctions = FORMS.into_iter().map(|(_, name)| name);
    PossibleValuesParser::new(algorithm.chain(junctions))
}

/// Prints which required cases are not covered. If all logs are compared with the folding explorer, the cases
/// of Algorithm 1 do not apply.
pub(super) fn report(
    out: &mut dyn Write,
    required: &[String],
    coverage: &RunCoverage,
    any_algorithm1: bool,
    as_json: bool,
) -> Result<Outcome, CliError> {
    let not_covered: Vec<_> =
        required.iter().map(String::as_str).filter(|case| !covers(coverage, case)).collect();
    let of_algorithm1 = |case: &&str| AlgorithmCase::ALL.iter().any(|one| one.name() == *case);
    let foreign = not_covered.iter().copied().filter(|case| !any_algorithm1 && of_algorithm1(case));
    let not_applicable: Vec<_> = foreign.collect();
    let outcome = if not_covered.is_empty() { Outcome::Holds } else { Outcome::Incomplete };
    if as_json {
        print_line(out, "required-coverage", &Line { required, not_covered, not_applicable })?;
    } else {
        let cases = counted(required.len(), "required case");
        let mut text = match &not_covered[..] {
            [] => "all are covered".to_owned(),
            not => format!("not covered: {}", not.join(", ")),
        };
        if !not_applicable.is_empty() {
            let cases = not_applicable.join(", ");
            text += "; the folding explorer does not have these cases of Algorithm 1: ";
            text += &cases;
        }
        print_hanging(out, &format!("{cases}: "), &text)?;
    }
    Ok(outcome)
}

fn covers(coverage: &RunCoverage, name: &str) -> bool {
    let count = |case| coverage.algorithm.count(case) > 0;
    let mut algorithm = AlgorithmCase::ALL.into_iter().filter(|case| case.name() == name);
    let mut junctions = FORMS.into_iter().filter(|(_, form)| *form == name);
    algorithm.any(count) || junctions.any(|(form, _)| coverage.junctions.contains_key(&form))
}
