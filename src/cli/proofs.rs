//! `toposlam proofs`: the lemmas on which the correctness of the mapping rests; check them, and look
//! at single cases.

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

use super::{Failure, Outcome, progress::Progress, text::grouped};
use check::{CheckEnd, check_lemma};
use lemma_case::LemmaCase;
use report::ProofsReport;

/// List the lemmas on which the mapping rests; check them in every case within a bound
///
/// The list tells what each lemma says, where it is in the paper, and which engines check it; and so
/// for the theorems that are proved in Coq, for every world. Those are checked by proofs/coq/check.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  toposlam proofs              what each lemma says, and how it is checked
  toposlam proofs --run all    check every lemma in every case within its bound
  toposlam proofs --run the_way_back_retraces_the_path --choices 2,2,1,1,1,0,0,1,2,1,1,0

The last makes one case again and shows it: its worlds, as world files, and its walks, step by step.
A robot at v2:1 has come in by the dart 1 place clockwise from the first that the file lists at v2.
A lemma that fails prints such a command for the case in which it does.

The name of a lemma may be shortened to a part of it that no other has.

Ctrl-C ends a check early, and prints what was checked.

Exit codes: 0 all that was run holds, 1 a lemma fails, 2 bad usage or input,
3 not all was checked, or the lemma says nothing about the case that --choices makes.")]
pub(super) struct ProofsArguments {
    /// Check the lemma of this name, or all, in every case within its bound; may be repeated
    #[arg(long, value_name = "NAME")]
    run: Vec<String>,

    /// Make one case of the lemma again and show it: numbers with commas between them
    #[arg(long, value_name = "NUMBERS", requires = "run", allow_hyphen_values = true)]
    choices: Option<CaseChoices>,

    /// The bound within which --choices makes its case: exhaustive or sampled
    #[arg(long, default_value = "exhaustive", hide_possible_values = true, requires = "choices")]
    engine: Engine,

    /// Print one JSON object a line; of a list and a check, the totals last
    #[arg(long)]
    json: bool,
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
                format!("`{word}` is no choice; write numbers from 0 to 255, as in 2,0,1")
            };
            word.parse().map_err(refusal)
        };
        words.map(choice).collect::<Result<_, _>>().map(Self)
    }
}

/// Whose bound it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Engine {
    /// That of the check in every case
    Exhaustive,
    /// That of the check in cases drawn at random
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
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        let theorems: Vec<_> = theorems::all().collect();
        self.run_with(&lemmas::all().collect::<Vec<_>>(), &theorems, out)
    }

    fn run_with(
        &self,
        lemmas: &[&Lemma],
        theorems: &[Theorem],
        out: &mut dyn Write,
    ) -> Result<Outcome, Failure> {
        if let Some(theorem) = theorems.iter().find(|it| self.run.iter().any(|n| n == it.name)) {
            let Theorem { name, .. } = theorem;
            let cause = "is proved in Coq, for every world; to check it, run proofs/coq/check";
            return Err(Failure::at("--run", format!("{name} {cause}")));
        }
        match (&self.choices, self.run.as_slice()) {
            (Some(choices), [name]) if name != ALL => {
                let CaseChoices(choices) = choices;
                LemmaCase::new(named(lemmas, name)?, self.engine, choices)?.tell(self.json, out)
            }
            (Some(_), _) => {
                let cause = "these make a case of one lemma; name it with one --run";
                Err(Failure::at("--choices", cause))
            }
            (None, []) => {
                listing::list(lemmas, theorems, self.json, out)?;
                Ok(Outcome::Holds)
            }
            (None, names) => self.check(&wanted(lemmas, names)?, out),
        }
    }

    /// Checks lemmas, each in every case within its bound.
    fn check(&self, lemmas: &[&Lemma], out: &mut dyn Write) -> Result<Outcome, Failure> {
        let mut report = ProofsReport::new(out, self.json, lemmas);
        for &lemma in lemmas {
            let progress = Progress::new(lemma.name, "cases")?;
            let checked = check_lemma(lemma, &progress)?;
            progress.finish();
            let interrupted = matches!(checked.ending, CheckEnd::Interrupted { .. });
            report.lemma(lemma, checked)?;
            if interrupted {
                break;
            }
        }
        report.verdict()
    }
}

/// What --run says to name every lemma.
const ALL: &str = "all";

/// The lemmas of these names, or parts of names, each once.
fn wanted<'l>(lemmas: &[&'l Lemma], names: &[String]) -> Result<Vec<&'l Lemma>, Failure> {
    let mut wanted: Vec<&Lemma> = Vec::new();
    for name in names {
        let found = if name == ALL { lemmas.to_vec() } else { vec![named(lemmas, name)?] };
        for lemma in found {
            if wanted.iter().all(|known| known.name != lemma.name) {
                wanted.push(lemma);
            }
        }
    }
    Ok(wanted)
}

/// The lemma of this name, or else the only one that has it in its name.
fn named<'l>(lemmas: &[&'l Lemma], name: &str) -> Result<&'l Lemma, Failure> {
    if let Some(lemma) = lemmas.iter().find(|lemma| lemma.name == name) {
        return Ok(lemma);
    }
    if name.is_empty() {
        return Err(Failure::at("--run", "the name of a lemma is missing"));
    }
    let fitting: Vec<_> = lemmas.iter().copied().filter(|l| l.name.contains(name)).collect();
    let (cause, listed) = match fitting.as_slice() {
        [lemma] => return Ok(lemma),
        [] => (format!("there is no lemma `{name}`; there are"), lemmas),
        several => (format!("`{name}` is part of several names"), several),
    };
    let lines: Vec<_> = listed.iter().map(|lemma| lemma.name).collect();
    Err(Failure::at("--run", format!("{cause}:\n  {}", lines.join("\n  "))))
}

/// So many cases.
fn cases(number: u64) -> String {
    format!("{} case{}", grouped(number.into()), if number == 1 { "" } else { "s" })
}
