//! `toposlam proofs`: lists and checks the lemmas behind the mapping algorithms, and prints single cases.

mod case_view;
mod check;
mod lemma_case;
mod listing;
mod report;
#[cfg(test)]
mod tests;

use std::{io::Write, num::ParseIntError, str::FromStr};

use clap::ValueEnum;
use toposlam_proofs::{Lemma, Theorem, lemmas, theorems};

use super::{
    CliError, Outcome,
    ci_report::{CiCase, CiOptions},
    exit_codes::help_end,
    progress::Progress,
    text::grouped,
};
use check::{CheckEnd, check_lemma};
use lemma_case::LemmaCase;
use report::ProofsReport;

/// List the lemmas behind the mapping algorithms, or check them in every case within a bound
///
/// The list shows each lemma, its place in the paper and the engines that check it. It also shows the
/// theorems that Coq proves for every world; proofs/coq/check checks those.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  toposlam proofs            list the lemmas and how each one is checked
  toposlam proofs --run all  check every lemma in every case within its bound
  toposlam proofs --run the_way_back --choices 2,2,1,1,1,0,0,1,2,1,1,0

The last one prints a single case: its worlds, as world files, and its walks, step by step. A robot at \
v2:1 has entered v2 by the dart 1 place clockwise from the first one in the file. For a lemma that \
fails, the report contains such a command.

A part of a lemma's name is enough if it is unique. Ctrl-C stops a check and prints the results so far.",
    &[
        (0, "everything holds, or the list is printed"),
        (1, "a lemma fails"),
        (2, "bad usage or input"),
        (3, "not everything was checked, or the lemma excludes the case of --choices"),
    ],
))]
pub(super) struct ProofsArguments {
    /// Check the lemma of this name, or all lemmas (repeatable)
    #[arg(long, value_name = "NAME")]
    run: Vec<String>,

    /// Print the one case that these choices make: numbers, separated by commas
    #[arg(long, value_name = "NUMBERS", requires = "run", allow_hyphen_values = true)]
    choices: Option<CaseChoices>,

    /// The engine whose bound applies to --choices: exhaustive or sampled
    #[arg(long, default_value = "exhaustive", hide_possible_values = true, requires = "choices")]
    engine: Engine,

    /// Print one JSON object a line; a list or a check ends with the totals
    #[arg(long)]
    json: bool,

    /// Check the other lemmas also after one fails
    #[arg(long, requires = "run", conflicts_with = "choices")]
    keep_going: bool,

    #[command(flatten)]
    ci: CiOptions,
}

/// The choices that make a case.
#[derive(Clone, Debug)]
struct CaseChoices(Vec<u8>);

impl FromStr for CaseChoices {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let words = text.split(',').map(str::trim).filter(|_| !text.trim().is_empty());
        let choice = |word: &str| {
            let refusal = |_: ParseIntError| {
                format!("`{word}` is not a choice; write numbers from 0 to 255, as in 2,0,1")
            };
            word.parse().map_err(refusal)
        };
        words.map(choice).collect::<Result<_, _>>().map(Self)
    }
}

/// An engine, with its bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Engine {
    /// Every case within a bound
    Exhaustive,
    /// Random cases within a larger bound
    Sampled,
}

impl Engine {
    fn name(self) -> &'static str {
        match self {
            Self::Exhaustive => "exhaustive",
            Self::Sampled => "sampled",
        }
    }
}

impl ProofsArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        if self.run.is_empty() || self.choices.is_some() {
            self.ci.check_unused("this needs --run, without --choices")?;
        }
        self.ci.check_places()?;
        let theorems: Vec<_> = theorems::all().collect();
        self.run_with(&lemmas::all().collect::<Vec<_>>(), &theorems, out)
    }

    fn run_with(
        &self,
        lemmas: &[&Lemma],
        theorems: &[Theorem],
        out: &mut dyn Write,
    ) -> Result<Outcome, CliError> {
        let is_wanted = |theorem: &&Theorem| self.run.iter().any(|name| name == theorem.name);
        if let Some(Theorem { name, .. }) = theorems.iter().find(is_wanted) {
            let cause = "is proved in Coq, for every world; run proofs/coq/check to check it";
            return Err(CliError::at("--run", format!("{name} {cause}")));
        }
        match (&self.choices, self.run.as_slice()) {
            (Some(choices), [name]) if name != ALL => {
                let CaseChoices(choices) = choices;
                LemmaCase::new(find_lemma(lemmas, name)?, self.engine, choices)?
                    .print(self.json, out)
            }
            (Some(_), _) => {
                let cause = "choices make a case of one lemma; choose it with one --run";
                Err(CliError::at("--choices", cause))
            }
            (None, []) => {
                listing::list(lemmas, theorems, self.json, out)?;
                Ok(Outcome::Holds)
            }
            (None, names) => self.check(&find_lemmas(lemmas, names)?, out),
        }
    }

    /// Checks lemmas, each in every case within its bound.
    fn check(&self, lemmas: &[&Lemma], out: &mut dyn Write) -> Result<Outcome, CliError> {
        let mut report = ProofsReport::new(out, self.json, lemmas);
        let mut results = Vec::new();
        let mut left = lemmas.iter();
        for &lemma in left.by_ref() {
            let progress = Progress::new(lemma.name, "cases")?;
            let checked = check_lemma(lemma, &progress)?;
            progress.finish();
            let interrupted = matches!(checked.end, CheckEnd::Interrupted { .. });
            let result = ci_case(lemma, &checked.end);
            let failed = result.outcome == Outcome::Violated;
            results.push(result);
            report.lemma(lemma, checked)?;
            if interrupted || (failed && !self.keep_going) {
                break;
            }
        }
        let outcome = report.verdict()?;
        if outcome == Outcome::Violated {
            let after = results.last().map(|case| case.name.clone()).unwrap_or_default();
            let names = left.map(|lemma| lemma.name.to_owned());
            results.extend(names.map(|name| CiCase::not_checked(name, &after, None)));
        }
        self.ci.write("proofs", &results)?;
        Ok(outcome)
    }
}

/// The result of a lemma, for CI systems.
fn ci_case(lemma: &Lemma, end: &CheckEnd) -> CiCase {
    let (outcome, ended) = match end {
        CheckEnd::Holds { .. } => (Outcome::Holds, "holds"),
        CheckEnd::Interrupted { .. } => (Outcome::Incomplete, "interrupted"),
        CheckEnd::Fails(_) | CheckEnd::Miscounted { .. } => (Outcome::Violated, "fails"),
    };
    let message = format!("{ended} after {}", cases(end.cases()));
    CiCase { name: lemma.name.to_owned(), outcome, message, file: None }
}

/// The name for every lemma.
const ALL: &str = "all";

/// The lemmas of these names or parts of names, each once.
fn find_lemmas<'l>(lemmas: &[&'l Lemma], names: &[String]) -> Result<Vec<&'l Lemma>, CliError> {
    let mut selected: Vec<&Lemma> = Vec::new();
    for name in names {
        let found = if name == ALL { lemmas.to_vec() } else { vec![find_lemma(lemmas, name)?] };
        for lemma in found {
            if selected.iter().all(|known| known.name != lemma.name) {
                selected.push(lemma);
            }
        }
    }
    Ok(selected)
}

/// The lemma of this name, or else the only one whose name contains it.
fn find_lemma<'l>(lemmas: &[&'l Lemma], name: &str) -> Result<&'l Lemma, CliError> {
    if let Some(lemma) = lemmas.iter().find(|lemma| lemma.name == name) {
        return Ok(lemma);
    }
    if name.is_empty() {
        return Err(CliError::at("--run", "the name is empty"));
    }
    let fitting: Vec<_> = lemmas.iter().copied().filter(|l| l.name.contains(name)).collect();
    let (cause, listed) = match fitting.as_slice() {
        [lemma] => return Ok(lemma),
        [] => (format!("there is no lemma `{name}`; there are"), lemmas),
        several => (format!("`{name}` is part of several names"), several),
    };
    let lines: Vec<_> = listed.iter().map(|lemma| lemma.name).collect();
    Err(CliError::at("--run", format!("{cause}:\n  {}", lines.join("\n  "))))
}

/// A number of cases.
fn cases(number: u64) -> String {
    format!("{} case{}", grouped(number.into()), if number == 1 { "" } else { "s" })
}
