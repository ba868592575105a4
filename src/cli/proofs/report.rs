//! What a check prints: a row, or a JSON object, for each lemma; below the rows each case in which one
//! fails; and a verdict.

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
use crate::cli::{Failure, Outcome, json::print_object, text::print_hanging};

/// Prints as it goes.
pub(super) struct ProofsReport<'o> {
    out: &'o mut dyn Write,
    json: bool,
    /// How wide the names are, and the numbers of cases.
    widths: [usize; 2],
    lemmas: usize,
    held: usize,
    cases: u64,
    seconds: f64,
    interrupted: bool,
    /// What does not hold, to be told below the rows.
    failed: Vec<(&'o Lemma, CheckEnd)>,
}

impl<'o> ProofsReport<'o> {
    /// On the check of these lemmas.
    pub(super) fn new(out: &'o mut dyn Write, json: bool, lemmas: &[&Lemma]) -> Self {
        let names = lemmas.iter().map(|lemma| lemma.name.len());
        let numbers = lemmas.iter().map(|lemma| cases(lemma.exhaustive.cases).len());
        Self {
            out,
            json,
            widths: [names.max().unwrap_or_default(), numbers.max().unwrap_or_default()],
            lemmas: lemmas.len(),
            held: 0,
            cases: 0,
            seconds: 0.0,
            interrupted: false,
            failed: Vec::new(),
        }
    }

    /// One lemma.
    pub(super) fn lemma(&mut self, lemma: &'o Lemma, checked: LemmaCheck) -> Result<(), Failure> {
        if self.json {
            print_line(self.out, lemma, &checked)?;
        } else {
            self.row(lemma, &checked)?;
        }
        self.out.flush()?;
        self.seconds += checked.seconds;
        match checked.ending {
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
        let LemmaCheck { ending, seconds } = checked;
        let word = match ending {
            CheckEnd::Holds { .. } => "holds",
            CheckEnd::Fails(_) | CheckEnd::Miscounted { .. } => "fails",
            CheckEnd::Interrupted { .. } => "interrupted",
        };
        let cases = cases(ending.cases());
        let [name, width] = self.widths;
        writeln!(self.out, "{:name$}  {cases:>width$}  {seconds:>6.2} s  {word}", lemma.name)
    }

    /// What does not hold, and the last line, and the outcome. An empty check does not hold, nor one
    /// that was broken off.
    pub(super) fn verdict(self) -> Result<Outcome, Failure> {
        let Self { lemmas, held, .. } = self;
        let (outcome, verdict) = match () {
            () if !self.failed.is_empty() => (Outcome::Violated, "violated"),
            () if self.interrupted => (Outcome::Incomplete, "incomplete, interrupted"),
            () if lemmas == 0 => (Outcome::Incomplete, "incomplete: there was nothing to check"),
            () => (Outcome::Holds, "holds"),
        };
        if self.json {
            let totals = TotalsLine {
                schema: 1,
                lemmas,
                held,
                cases: self.cases,
                seconds: self.seconds,
                interrupted: self.interrupted,
                holds: outcome == Outcome::Holds,
            };
            print_object(self.out, &totals)?;
            return Ok(outcome);
        }
        for (lemma, ending) in &self.failed {
            writeln!(self.out)?;
            print_failure(self.out, lemma, ending)?;
        }
        write!(self.out, "\n{verdict}")?;
        if lemmas > 0 {
            let hold = if outcome == Outcome::Holds { "" } else { " hold" };
            write!(self.out, ": {held} of {lemmas} lemmas{hold}, {}", cases(self.cases))?;
        }
        writeln!(self.out)?;
        Ok(outcome)
    }
}

/// Tells why a lemma does not hold.
fn print_failure(out: &mut dyn Write, lemma: &Lemma, ending: &CheckEnd) -> io::Result<()> {
    match ending {
        CheckEnd::Fails(failed) => {
            let Counterexample { choices, claim, .. } = failed;
            print_head(out, lemma, Engine::Exhaustive, choices, Some(claim))?;
            match again(lemma, failed) {
                Some(again) => again.shown.tell(out),
                None => writeln!(out, "\nIt comes out otherwise when it is made again."),
            }
        }
        CheckEnd::Miscounted { pinned, found } => {
            writeln!(out, "{}", lemma.name)?;
            print_hanging(out, "  ", lemma.sentence)?;
            let [found, pinned] = [cases(*found), cases(*pinned)];
            let cause = format!("there must be {pinned} within its bound, and it has {found}");
            print_hanging(out, "  fails: ", &cause)
        }
        CheckEnd::Holds { .. } | CheckEnd::Interrupted { .. } => Ok(()),
    }
}

/// The case in which a lemma failed, if it fails in the same way when it is made again.
fn again<'a>(lemma: &'a Lemma, failed: &'a Counterexample) -> Option<LemmaCase<'a>> {
    let again = LemmaCase::new(lemma, Engine::Exhaustive, &failed.choices).ok()?;
    (again.claim() == Some(failed.claim)).then_some(again)
}

/// What `--json` prints of a lemma.
#[derive(Serialize)]
struct Line<'a> {
    schema: u32,
    lemma: &'a str,
    /// Where it fails in one, those before that.
    cases: u64,
    seconds: f64,
    holds: bool,
    choices: Option<&'a [u8]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    claim: Option<&'a str>,
    #[serde(flatten)]
    shown: Option<CaseViewLine<'a>>,
    /// How many cases there must be, where there are not as many.
    #[serde(skip_serializing_if = "Option::is_none")]
    pinned: Option<u64>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    interrupted: bool,
}

fn print_line(out: &mut dyn Write, lemma: &Lemma, checked: &LemmaCheck) -> Result<(), Failure> {
    let LemmaCheck { ending, seconds } = checked;
    let failed = match ending {
        CheckEnd::Fails(failed) => Some(failed),
        _ => None,
    };
    let again = failed.and_then(|failed| again(lemma, failed));
    let line = Line {
        schema: 1,
        lemma: lemma.name,
        cases: ending.cases(),
        seconds: *seconds,
        holds: matches!(ending, CheckEnd::Holds { .. }),
        choices: failed.map(|failed| failed.choices.as_slice()),
        claim: failed.map(|failed| failed.claim),
        shown: again.as_ref().map(|again| again.shown.json()),
        pinned: match ending {
            CheckEnd::Miscounted { pinned, .. } => Some(*pinned),
            _ => None,
        },
        interrupted: matches!(ending, CheckEnd::Interrupted { .. }),
    };
    print_object(out, &line)
}

/// The last line of `--json`.
#[derive(Serialize)]
struct TotalsLine {
    schema: u32,
    lemmas: usize,
    held: usize,
    /// In which a lemma was seen to hold.
    cases: u64,
    seconds: f64,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    interrupted: bool,
    holds: bool,
}
