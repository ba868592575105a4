//! The list of the lemmas, and of the theorems that Coq proves.

use std::io::{self, Write};

use serde::Serialize;
use toposlam_proofs::{Lemma, Theorem, theorems::FILE};

use super::cases;
use crate::cli::{
    CliError,
    json::print_line,
    text::{counted, print_hanging, print_paragraph},
};

const EXHAUSTIVE: &str = "exhaustive";
const SAMPLED: &str = "sampled";
const KANI: &str = "Kani";
const COQ: &str = "Coq";
const EVERY_WORLD: &str = "every world";

/// How to run each engine; printed below the list.
const ENGINES: [(&str, &str); 4] = [
    (EXHAUSTIVE, "every case within the bound: toposlam proofs --run NAME, or --run all"),
    (SAMPLED, "random cases within the bound: cargo test -p toposlam-proofs"),
    (
        KANI,
        "every case within the bound, symbolically: proofs/kani/verify, if Kani is installed; \
         neither this program nor cargo test runs it, and this list does not contain its results",
    ),
    (
        COQ,
        "every world, without a bound: proofs/coq/check, if Coq is installed; cargo test -p \
         toposlam-proofs runs it too, this program does not",
    ),
];

/// Prints the lemmas and the theorems, and their numbers.
pub(super) fn list(
    lemmas: &[&Lemma],
    theorems: &[Theorem],
    json: bool,
    out: &mut dyn Write,
) -> Result<(), CliError> {
    if json { print_json(out, lemmas, theorems) } else { Ok(print_list(out, lemmas, theorems)?) }
}

fn print_list(out: &mut dyn Write, lemmas: &[&Lemma], theorems: &[Theorem]) -> io::Result<()> {
    for lemma in lemmas {
        let Lemma { name, sentence, paper, file, exhaustive, sampled, kani } = lemma;
        print_head(out, [name, sentence, paper, file])?;
        let cases = cases(exhaustive.cases);
        print_entry(out, EXHAUSTIVE, &format!("{}: {cases}", exhaustive.bound))?;
        if let Some(sampled) = sampled {
            print_entry(out, SAMPLED, sampled.bound)?;
        }
        if let Some(kani) = kani {
            print_entry(out, KANI, &format!("{}; unwind {}", kani.bound, kani.unwind))?;
        }
        writeln!(out)?;
    }
    for Theorem { name, sentence, paper } in theorems {
        print_head(out, [name, sentence, paper, FILE])?;
        print_entry(out, COQ, EVERY_WORLD)?;
        writeln!(out)?;
    }
    for (engine, how) in ENGINES {
        print_entry(out, engine, how)?;
    }
    let cases = cases(total(lemmas));
    let [lemmas, theorems] =
        [(lemmas.len(), "lemma"), (theorems.len(), "theorem")].map(|(n, word)| counted(n, word));
    writeln!(out)?;
    let totals = format!("{lemmas}, {cases} within bounds; {theorems} for {EVERY_WORLD}");
    print_paragraph(out, &totals)
}

fn print_head(out: &mut dyn Write, [name, sentence, paper, file]: [&str; 4]) -> io::Result<()> {
    writeln!(out, "{name}")?;
    print_hanging(out, "  ", sentence)?;
    print_entry(out, "paper", paper)?;
    print_entry(out, "file", file)
}

fn print_entry(out: &mut dyn Write, label: &str, text: &str) -> io::Result<()> {
    let width = EXHAUSTIVE.len();
    print_hanging(out, &format!("  {label:width$}  "), text)
}

/// The line of `--json` for a theorem.
#[derive(Serialize)]
struct TheoremLine<'a> {
    theorem: &'a str,
    sentence: &'a str,
    paper: &'a str,
    file: &'a str,
    coq: CoqLine<'a>,
}

#[derive(Serialize)]
struct CoqLine<'a> {
    bound: &'a str,
}

/// The last line of `--json`.
#[derive(Serialize)]
struct TotalsLine {
    lemmas: usize,
    theorems: usize,
    cases: u64,
    sampled: usize,
    kani: usize,
}

fn print_json(
    out: &mut dyn Write,
    lemmas: &[&Lemma],
    theorems: &[Theorem],
) -> Result<(), CliError> {
    for lemma in lemmas {
        print_line(out, "lemma", lemma)?;
    }
    for Theorem { name, sentence, paper } in theorems {
        let coq = CoqLine { bound: EVERY_WORLD };
        let line = TheoremLine { theorem: name, sentence, paper, file: FILE, coq };
        print_line(out, "theorem", &line)?;
    }
    let totals = TotalsLine {
        lemmas: lemmas.len(),
        theorems: theorems.len(),
        cases: total(lemmas),
        sampled: lemmas.iter().filter(|lemma| lemma.sampled.is_some()).count(),
        kani: lemmas.iter().filter(|lemma| lemma.kani.is_some()).count(),
    };
    print_line(out, "lemmas", &totals)
}

/// The number of cases within the exhaustive bounds.
fn total(lemmas: &[&Lemma]) -> u64 {
    lemmas.iter().map(|lemma| lemma.exhaustive.cases).sum()
}
