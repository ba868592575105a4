//! One case of a lemma, made from its choices.

use std::io::{self, Write};

use serde::Serialize;
use toposlam_proofs::{CaseReplay, Lemma, Stop, choose, lemma::Sampled, odometer::listed};

use super::{
    Engine,
    case_view::{CaseView, CaseViewLine},
};
use crate::cli::{
    CliError, Outcome,
    json::print_line,
    text::{print_command, print_hanging},
};

/// A case of a lemma.
pub(super) struct LemmaCase<'a> {
    lemma: &'a Lemma,
    engine: Engine,
    choices: &'a [u8],
    case: choose::CaseResult,
    pub(super) view: CaseView,
}

impl<'a> LemmaCase<'a> {
    /// Makes the case of these choices.
    pub(super) fn new(
        lemma: &'a Lemma,
        engine: Engine,
        choices: &'a [u8],
    ) -> Result<Self, CliError> {
        let replay = match (engine, lemma.sampled) {
            (Engine::Exhaustive, _) => lemma.exhaustive.replay,
            (Engine::Sampled, Some(Sampled { replay, .. })) => replay,
            (Engine::Sampled, None) => {
                return Err(CliError::at("--engine", format!("{} is not sampled", lemma.name)));
            }
        };
        let made = CaseReplay::show(replay, choices)
            .map_err(|misfit| CliError::at("--choices", format!("{}: {misfit}", lemma.name)))?;
        let view = CaseView::new(&format!("A case of {}", lemma.name), &made.exhibits);
        Ok(Self { lemma, engine, choices, case: made.case, view })
    }

    /// The claim that does not hold in it.
    pub(super) fn claim(&self) -> Option<&'static str> {
        match self.case {
            Err(Stop::Fails(claim)) => Some(claim),
            _ => None,
        }
    }

    /// Prints the case and returns the outcome. A case that the lemma excludes is incomplete.
    pub(super) fn print(&self, json: bool, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let (outcome, word) = match self.case {
            Ok(()) => (Outcome::Holds, "holds"),
            Err(Stop::Fails(_)) => (Outcome::Violated, "fails"),
            Err(Stop::Excluded) => (Outcome::Incomplete, "excluded"),
        };
        if json {
            let line = CaseLine {
                lemma: self.lemma.name,
                engine: self.engine.name(),
                choices: self.choices,
                verdict: word,
                holds: outcome == Outcome::Holds,
                claim: self.claim(),
                view: self.view.json(),
            };
            print_line(out, "case", &line)?;
            return Ok(outcome);
        }
        print_head(out, self.lemma, self.engine, self.choices, self.claim())?;
        self.view.print(out)?;
        let verdict = match outcome {
            Outcome::Holds => "holds: the lemma holds in this case",
            Outcome::Violated => "violated: the lemma fails in this case",
            Outcome::Incomplete => "incomplete: the lemma excludes this case",
        };
        writeln!(out, "\n{verdict}")?;
        Ok(outcome)
    }
}

/// Prints the head of a case: the lemma, the claim that fails, and the command that repeats the case.
pub(super) fn print_head(
    out: &mut dyn Write,
    lemma: &Lemma,
    engine: Engine,
    choices: &[u8],
    claim: Option<&str>,
) -> io::Result<()> {
    writeln!(out, "{}", lemma.name)?;
    print_hanging(out, "  ", lemma.sentence)?;
    if let Some(claim) = claim {
        print_hanging(out, "  fails: ", &format!("it is not true that {claim}"))?;
    }
    print_command(out, "  again: ", &command(lemma, engine, choices))
}

/// The command that prints a case.
fn command(lemma: &Lemma, engine: Engine, choices: &[u8]) -> String {
    let engine = match engine {
        Engine::Exhaustive => "",
        Engine::Sampled => " --engine sampled",
    };
    let choices = match listed(choices) {
        none if none.is_empty() => "''".to_owned(),
        choices => choices,
    };
    format!("toposlam proofs --run {}{engine} --choices {choices}", lemma.name)
}

/// The line of `--json` for a case.
#[derive(Serialize)]
struct CaseLine<'a> {
    lemma: &'a str,
    engine: &'a str,
    choices: &'a [u8],
    verdict: &'a str,
    holds: bool,
    claim: Option<&'a str>,
    #[serde(flatten)]
    view: CaseViewLine<'a>,
}
