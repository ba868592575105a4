//! The report of a check: a row or a JSON object for each lemma, each case in which a lemma fails, and
//! the verdict.

use std::io::{self, Write};

use serde::Serialize;
use toposlam_proofs::{Counterexample, Lemma};

use super::{
    Engine,
    case_view::CaseViewLine,
    cases,
    check::{CheckEnd, LemmaCheck},
    lemma_case::{LemmaCase, print_head},
};
use crate::cli::{
    CliError, Outcome,
    json::print_line,
    text::{counted, print_hanging},
};

/// Prints the result of each lemma when it is there.
pub(super) struct ProofsReport<'o> {
    out: &'o mut dyn Write,
    json: bool,
    /// The widths of the names and of the numbers of cases.
    widths: [usize; 2],
    lemmas: usize,
    checked: usize,
    held: usize,
    cases: u64,
    seconds: f64,
    interrupted: bool,
    /// The lemmas that fail, to be printed below the rows.
    failed: Vec<(&'o Lemma, CheckEnd)>,
}

impl<'o> ProofsReport<'o> {
    /// A report on these lemmas.
    pub(super) fn new(out: &'o mut dyn Write, json: bool, lemmas: &[&Lemma]) -> Self {
        let names = lemmas.iter().map(|lemma| lemma.name.len());
        let numbers = lemmas.iter().map(|lemma| cases(lemma.exhaustive.cases).len());
        Self {
            out,
            json,
            widths: [names.max().unwrap_or_default(), numbers.max().unwrap_or_default()],
            lemmas: lemmas.len(),
            checked: 0,
            held: 0,
            cases: 0,
            seconds: 0.0,
            interrupted: false,
            failed: Vec::new(),
        }
    }

    /// Prints the result of one lemma.
    pub(super) fn lemma(&mut self, lemma: &'o Lemma, checked: LemmaCheck) -> Result<(), CliError> {
        if self.json {
            print_check(self.out, lemma, &checked)?;
        } else {
            self.row(lemma, &checked)?;
        }
        self.out.flush()?;
        self.checked += 1;
        self.seconds += checked.seconds;
        match checked.end {
            CheckEnd::Holds { cases } => {
                self.held += 1;
                self.cases += cases;
            }
            CheckEnd::Interrupted { cases } => {
                self.interrupted = true;
                self.cases += cases;
            }
            failed => self.failed.push((lemma, failed)),
        }
        Ok(())
    }

    fn row(&mut self, lemma: &Lemma, checked: &LemmaCheck) -> io::Result<()> {
        let LemmaCheck { end, seconds } = checked;
        let word = match end {
            CheckEnd::Holds { .. } => "holds",
            CheckEnd::Fails(_) | CheckEnd::Miscounted { .. } => "fails",
            CheckEnd::Interrupted { .. } => "interrupted",
        };
        let cases = cases(end.cases());
        let [name, width] = self.widths;
        writeln!(self.out, "{:name$}  {cases:>width$}  {seconds:>6.2} s  {word}", lemma.name)
    }

    /// Prints the lemmas that fail and the verdict, and returns the outcome. A check does not hold if it is
    /// empty or interrupted.
    pub(super) fn verdict(self) -> Result<Outcome, CliError> {
        let Self { lemmas, held, .. } = self;
        let not_checked = lemmas - self.checked;
        let (outcome, verdict) = match () {
            () if !self.failed.is_empty() => (Outcome::Violated, "violated"),
            () if self.interrupted => (Outcome::Incomplete, "incomplete, interrupted"),
            () if lemmas == 0 => (Outcome::Incomplete, "incomplete: there is nothing to check"),
            () => (Outcome::Holds, "holds"),
        };
        if self.json {
            let totals = TotalsLine {
                lemmas,
                held,
                not_checked,
                cases: self.cases,
                seconds: self.seconds,
                interrupted: self.interrupted,
                verdict: outcome.verdict(),
                holds: outcome == Outcome::Holds,
            };
            print_line(self.out, "checks", &totals)?;
            return Ok(outcome);
        }
        for (lemma, end) in &self.failed {
            writeln!(self.out)?;
            print_failure(self.out, lemma, end)?;
        }
        write!(self.out, "\n{verdict}")?;
        if lemmas > 0 {
            let hold = match (outcome, lemmas) {
                (Outcome::Holds, _) => "",
                (_, 1) => " holds",
                _ => " hold",
            };
            let lemmas = counted(lemmas, "lemma");
            write!(self.out, ": {held} of {lemmas}{hold}, {}", cases(self.cases))?;
        }
        if not_checked > 0 {
            write!(self.out, "; {not_checked} not checked")?;
            if outcome == Outcome::Violated {
                write!(self.out, " (--keep-going checks them)")?;
            }
        }
        writeln!(self.out)?;
        Ok(outcome)
    }
}

/// Prints why a lemma does not hold.
fn print_failure(out: &mut dyn Write, lemma: &Lemma, end: &CheckEnd) -> io::Result<()> {
    match end {
        CheckEnd::Fails(failed) => {
            let Counterexample { choices, claim, .. } = failed;
            print_head(out, lemma, Engine::Exhaustive, choices, Some(claim))?;
            match failed_case(lemma, failed) {
                Some(again) => again.view.print(out),
                None => writeln!(
                    out,
                    "\nThe failure is not repeatable: the same choices give another result."
                ),
            }
        }
        CheckEnd::Miscounted { pinned, found } => {
            writeln!(out, "{}", lemma.name)?;
            print_hanging(out, "  ", lemma.sentence)?;
            let [found, pinned] = [cases(*found), cases(*pinned)];
            let cause = format!("expected {pinned} within its bound, found {found}");
            print_hanging(out, "  fails: ", &cause)
        }
        CheckEnd::Holds { .. } | CheckEnd::Interrupted { .. } => Ok(()),
    }
}

/// The case in which a lemma failed, if the same choices fail with the same claim.
fn failed_case<'a>(lemma: &'a Lemma, failed: &'a Counterexample) -> Option<LemmaCase<'a>> {
    let again = LemmaCase::new(lemma, Engine::Exhaustive, &failed.choices).ok()?;
    (again.claim() == Some(failed.claim)).then_some(again)
}

/// The line of `--json` for a lemma.
#[derive(Serialize)]
struct CheckLine<'a> {
    lemma: &'a str,
    /// The number of cases before the first one in which it fails.
    cases: u64,
    seconds: f64,
    verdict: &'static str,
    holds: bool,
    choices: Option<&'a [u8]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    claim: Option<&'a str>,
    #[serde(flatten)]
    view: Option<CaseViewLine<'a>>,
    /// The expected number of cases, if another number was found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pinned: Option<u64>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    interrupted: bool,
}

fn print_check(out: &mut dyn Write, lemma: &Lemma, checked: &LemmaCheck) -> Result<(), CliError> {
    let LemmaCheck { end, seconds } = checked;
    let failed = match end {
        CheckEnd::Fails(failed) => Some(failed),
        _ => None,
    };
    let again = failed.and_then(|failed| failed_case(lemma, failed));
    let outcome = match end {
        CheckEnd::Holds { .. } => Outcome::Holds,
        CheckEnd::Fails(_) | CheckEnd::Miscounted { .. } => Outcome::Violated,
        CheckEnd::Interrupted { .. } => Outcome::Incomplete,
    };
    let line = CheckLine {
        lemma: lemma.name,
        cases: end.cases(),
        seconds: *seconds,
        verdict: outcome.verdict(),
        holds: outcome == Outcome::Holds,
        choices: failed.map(|failed| failed.choices.as_slice()),
        claim: failed.map(|failed| failed.claim),
        view: again.as_ref().map(|again| again.view.json()),
        pinned: match end {
            CheckEnd::Miscounted { pinned, .. } => Some(*pinned),
            _ => None,
        },
        interrupted: matches!(end, CheckEnd::Interrupted { .. }),
    };
    print_line(out, "check", &line)
}

/// The last line of `--json`.
#[derive(Serialize)]
struct TotalsLine {
    lemmas: usize,
    held: usize,
    not_checked: usize,
    /// The cases in which a lemma holds.
    cases: u64,
    seconds: f64,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    interrupted: bool,
    verdict: &'static str,
    holds: bool,
}
