//! One case of a lemma, made again and shown.

use std::io::{self, Write};

use serde::Serialize;
use toposlam_proofs::{CaseReplay, Lemma, Stop, choose, lemma::Sampled, odometer::listed};

use super::{
    Engine,
    case_view::{CaseView, CaseViewLine},
};
use crate::cli::{Failure, Outcome, json::print_object, text::print_hanging};

/// A case as it was made.
pub(super) struct LemmaCase<'a> {
    lemma: &'a Lemma,
    engine: Engine,
    choices: &'a [u8],
    case: choose::CaseResult,
    pub(super) shown: CaseView,
}

impl<'a> LemmaCase<'a> {
    /// Makes the case of these choices.
    pub(super) fn new(
        lemma: &'a Lemma,
        engine: Engine,
        choices: &'a [u8],
    ) -> Result<Self, Failure> {
        let replay = match (engine, lemma.sampled) {
            (Engine::Exhaustive, _) => lemma.exhaustive.replay,
            (Engine::Sampled, Some(Sampled { replay, .. })) => replay,
            (Engine::Sampled, None) => {
                return Err(Failure::at("--engine", format!("{} is not sampled", lemma.name)));
            }
        };
        let made = CaseReplay::show(replay, choices)
            .map_err(|misfit| Failure::at("--choices", format!("{}: {misfit}", lemma.name)))?;
        let shown = CaseView::new(&command(lemma, engine, choices), &made.exhibits);
        Ok(Self { lemma, engine, choices, case: made.case, shown })
    }

    /// What does not hold in it.
    pub(super) fn claim(&self) -> Option<&'static str> {
        match self.case {
            Err(Stop::Fails(claim)) => Some(claim),
            _ => None,
        }
    }

    /// Prints it, and answers what it comes to. A case that the lemma excludes proves nothing.
    pub(super) fn tell(&self, json: bool, out: &mut dyn Write) -> Result<Outcome, Failure> {
        let (outcome, word) = match self.case {
            Ok(()) => (Outcome::Holds, "holds"),
            Err(Stop::Fails(_)) => (Outcome::Violated, "fails"),
            Err(Stop::Excluded) => (Outcome::Incomplete, "excluded"),
        };
        if json {
            let line = Line {
                schema: 1,
                lemma: self.lemma.name,
                engine: self.engine.name(),
                choices: self.choices,
                verdict: word,
                holds: outcome == Outcome::Holds,
                claim: self.claim(),
                shown: self.shown.json(),
            };
            print_object(out, &line)?;
            return Ok(outcome);
        }
        print_head(out, self.lemma, self.engine, self.choices, self.claim())?;
        self.shown.tell(out)?;
        let verdict = match outcome {
            Outcome::Holds => "holds: the lemma holds in this case",
            Outcome::Violated => "violated: the lemma fails in this case",
            Outcome::Incomplete => "incomplete: the lemma says nothing about this case",
        };
        writeln!(out, "\n{verdict}")?;
        Ok(outcome)
    }
}

/// What is printed above a case: the lemma, what does not hold, and how the case is made again.
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
        print_hanging(out, "  fails: ", &format!("it does not hold that {claim}"))?;
    }
    writeln!(out, "  again: {}", command(lemma, engine, choices))
}

/// The command that makes a case again.
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

/// What `--json` prints of a case.
#[derive(Serialize)]
struct Line<'a> {
    schema: u32,
    lemma: &'a str,
    engine: &'a str,
    choices: &'a [u8],
    verdict: &'a str,
    holds: bool,
    claim: Option<&'a str>,
    #[serde(flatten)]
    shown: CaseViewLine<'a>,
}
