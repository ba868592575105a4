//! `toposlam proofs`: lists and checks the lemmas behind the mapping algorithms, and prints single cases.

mod case;
#[cfg(test)]
mod tests;

use std::{
    collections::BTreeSet,
    io::{self, Write},
    mem,
};

use serde_json::{Value, json};
use toposlam_proofs::{ENGINES, Lemma, LemmaCheck, LemmaFailure, Theorem, lemmas, theorems};

use super::{
    CliError, Outcome,
    ci_report::{CiCase, CiOptions},
    exit_codes::help_end,
    json::print_line,
    progress::Progress,
    text::{counted, print_hanging, print_paragraph},
};

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
#[command(mut_arg("junit", |junit| junit.requires("run").conflicts_with("choices")))]
#[command(mut_arg("sarif", |sarif| sarif.requires("run").conflicts_with("choices")))]
pub(super) struct ProofsArguments {
    /// Check the lemma of this name, or all lemmas (repeatable)
    #[arg(long, value_name = "NAME")]
    run: Vec<String>,
    /// Print the one case that these choices make: numbers, separated by commas
    #[arg(long, value_name = "NUMBERS", requires = "run", num_args = 0..=1, value_delimiter = ',')]
    choices: Option<Vec<u8>>,
    /// Print one JSON object a line; a list or a check ends with the totals
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    ci: CiOptions,
}

/// The name for every lemma.
const ALL: &str = "all";

/// The lemmas and the theorems that there are.
type Statements<'s> = (&'s [&'s Lemma], &'s [Theorem]);

impl ProofsArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        self.ci.check_places()?;
        let (lemmas, theorems): (Vec<_>, Vec<_>) =
            (lemmas::all().collect(), theorems::all().collect());
        self.run_with((&lemmas, &theorems), out)
    }

    fn run_with(&self, all: Statements, out: &mut dyn Write) -> Result<Outcome, CliError> {
        if self.choices.is_some() && !matches!(self.run.as_slice(), [name] if name != ALL) {
            let cause = "choices make a case of one lemma; choose it with one --run";
            return Err(CliError::at("--choices", cause));
        }
        let named: Result<Vec<_>, _> = self.run.iter().map(|name| named(name, all)).collect();
        let (mut lemmas, mut names) = (named?.concat(), BTreeSet::new());
        lemmas.retain(|lemma| names.insert(lemma.name));
        let mut report = Report { text: out, json: &mut io::sink() };
        if self.json {
            mem::swap(&mut report.text, &mut report.json);
        }
        match (&self.choices, lemmas.as_slice()) {
            (None, []) => report.list(all),
            (Some(choices), [lemma]) => report.case(lemma, choices),
            (_, lemmas) => self.check(lemmas, &mut report),
        }
    }

    /// Checks lemmas, each in every case within its bound. Prints the cases in which lemmas fail, and the totals.
    fn check(&self, lemmas: &[&Lemma], report: &mut Report) -> Result<Outcome, CliError> {
        let names = lemmas.iter().map(|lemma| lemma.name.len()).max().unwrap_or_default();
        let numbers = lemmas.iter().map(|lemma| in_cases(lemma.exhaustive.cases).len());
        let numbers = numbers.max().unwrap_or_default();
        let (mut checked, mut results) = (Vec::new(), Vec::new());
        for lemma in lemmas {
            let progress = Progress::new(lemma.name, "cases")?;
            let check = lemma.check(&progress);
            progress.finish();
            let (outcome, word) = verdict(&check);
            let (name, number, seconds) = (lemma.name, in_cases(check.cases), check.seconds);
            writeln!(report.text, "{name:names$}  {number:>numbers$}  {seconds:>6.2} s  {word}")?;
            print_line(report.json, "check", &check_json(&check, outcome))?;
            report.text.flush()?;
            report.json.flush()?;
            let message = format!("{word} after {number}");
            results.push(CiCase { name: name.to_owned(), outcome, message, file: None });
            checked.push(check);
            if outcome == Outcome::Incomplete {
                break;
            }
        }
        for LemmaCheck { lemma, cases, failure, .. } in &checked {
            match failure {
                Some(LemmaFailure::Case(case)) => {
                    writeln!(report.text)?;
                    report.case(lemma, &case.choices)?;
                }
                Some(LemmaFailure::Cases { pinned }) => {
                    let [pinned, found] = [*pinned, *cases].map(in_cases);
                    writeln!(report.text)?;
                    report.statement(lemma.name, lemma.sentence)?;
                    let cause = format!("expected {pinned} within its bound, found {found}");
                    print_hanging(report.text, "  fails: ", &cause)?;
                }
                Some(LemmaFailure::Stopped) | None => {}
            }
        }
        let outcome = report.totals(lemmas.len(), &checked)?;
        self.ci.write("proofs", &results)?;
        Ok(outcome)
    }
}

/// The lemma of this name, or else the only one whose name contains it; or all lemmas.
fn named<'l>(name: &str, (lemmas, theorems): Statements<'l>) -> Result<Vec<&'l Lemma>, CliError> {
    let exact: Vec<_> = lemmas.iter().copied().filter(|l| name == ALL || l.name == name).collect();
    let fitting: Vec<_> = lemmas.iter().copied().filter(|l| l.name.contains(name)).collect();
    let (cause, listed) = match fitting.as_slice() {
        _ if !exact.is_empty() => return Ok(exact),
        _ if theorems.iter().any(|theorem| theorem.name == name) => {
            let how = "is proved in Coq, for every world; run proofs/coq/check to check it";
            return Err(CliError::at("--run", format!("{name} {how}")));
        }
        [_] => return Ok(fitting),
        [] => (format!("there is no lemma `{name}`; there are"), lemmas),
        several => (format!("`{name}` is part of several names"), several),
    };
    let names: Vec<_> = listed.iter().map(|lemma| lemma.name).collect();
    Err(CliError::at("--run", format!("{cause}:\n  {}", names.join("\n  "))))
}

fn verdict(check: &LemmaCheck) -> (Outcome, &'static str) {
    match check.failure {
        None => (Outcome::Holds, "holds"),
        Some(LemmaFailure::Stopped) => (Outcome::Incomplete, "interrupted"),
        Some(_) => (Outcome::Violated, "fails"),
    }
}

fn check_json(check: &LemmaCheck, outcome: Outcome) -> Value {
    let mut line = json!({
        "lemma": check.lemma.name, "cases": check.cases, "seconds": check.seconds,
        "verdict": outcome.verdict(), "holds": outcome == Outcome::Holds, "choices": null,
    });
    match &check.failure {
        Some(LemmaFailure::Case(case)) => {
            line["choices"] = json!(case.choices);
            line["claim"] = json!(case.claim);
        }
        Some(LemmaFailure::Cases { pinned }) => line["pinned"] = json!(pinned),
        Some(LemmaFailure::Stopped) | None => {}
    }
    line["interrupted"] = json!(outcome == Outcome::Incomplete);
    line
}

/// The output as text and as JSON; one of the two goes nowhere.
struct Report<'o> {
    text: &'o mut dyn Write,
    json: &'o mut dyn Write,
}

impl Report<'_> {
    /// Prints the lemmas and the theorems, and their numbers.
    fn list(&mut self, (lemmas, theorems): Statements) -> Result<Outcome, CliError> {
        for lemma in lemmas {
            let Lemma { name, sentence, paper, file, exhaustive, sampled, kani } = lemma;
            let every = format!("{}: {}", exhaustive.bound, in_cases(exhaustive.cases));
            let kani = kani.map(|kani| format!("{}; unwind {}", kani.bound, kani.unwind));
            self.statement(name, sentence)?;
            self.rows([("paper", *paper), ("file", *file), ("exhaustive", &every)])?;
            self.rows(sampled.map(|sampled| ("sampled", sampled.bound)))?;
            self.rows(kani.as_deref().map(|kani| ("Kani", kani)))?;
            writeln!(self.text)?;
            print_line(self.json, "lemma", lemma)?;
        }
        for theorem in theorems {
            let Theorem { name, sentence, paper, file, coq } = theorem;
            self.statement(name, sentence)?;
            self.rows([("paper", paper.as_str()), ("file", *file), ("Coq", coq.bound)])?;
            writeln!(self.text)?;
            print_line(self.json, "theorem", theorem)?;
        }
        self.rows(ENGINES)?;
        let cases: u64 = lemmas.iter().map(|lemma| lemma.exhaustive.cases).sum();
        let bounded =
            format!("{}, {} within bounds", counted(lemmas.len(), "lemma"), in_cases(cases));
        let proved = format!("{} for every world", counted(theorems.len(), "theorem"));
        writeln!(self.text)?;
        print_paragraph(self.text, &format!("{bounded}; {proved}"))?;
        let totals = json!({
            "lemmas": lemmas.len(), "theorems": theorems.len(), "cases": cases,
            "sampled": lemmas.iter().filter(|lemma| lemma.sampled.is_some()).count(),
            "kani": lemmas.iter().filter(|lemma| lemma.kani.is_some()).count(),
        });
        print_line(self.json, "lemmas", &totals)?;
        Ok(Outcome::Holds)
    }

    fn totals(&mut self, lemmas: usize, checked: &[LemmaCheck]) -> Result<Outcome, CliError> {
        let count = |outcome| checked.iter().filter(|check| verdict(check).0 == outcome).count();
        let sound = checked.iter().filter(|check| verdict(check).0 != Outcome::Violated);
        let cases: u64 = sound.map(|check| check.cases).sum();
        let (outcome, word, end) = match [Outcome::Violated, Outcome::Incomplete].map(count) {
            [0, 0] => (Outcome::Holds, "holds", ""),
            [0, _] => (Outcome::Incomplete, "incomplete, interrupted", " held"),
            [_, _] => (Outcome::Violated, "violated", " held"),
        };
        let (held, not_checked) = (count(Outcome::Holds), lemmas - checked.len());
        let line = json!({
            "lemmas": lemmas, "held": held, "not_checked": not_checked, "cases": cases,
            "seconds": checked.iter().map(|check| check.seconds).sum::<f64>(),
            "interrupted": outcome == Outcome::Incomplete, "verdict": outcome.verdict(),
            "holds": outcome == Outcome::Holds,
        });
        print_line(self.json, "checks", &line)?;
        let left =
            if not_checked > 0 { format!("; {not_checked} not checked") } else { String::new() };
        let (lemmas, cases) = (counted(lemmas, "lemma"), in_cases(cases));
        writeln!(self.text, "\n{word}: {held} of {lemmas}{end}, {cases}{left}")?;
        Ok(outcome)
    }

    fn statement(&mut self, name: &str, sentence: &str) -> io::Result<()> {
        writeln!(self.text, "{name}")?;
        print_hanging(self.text, "  ", sentence)
    }

    fn rows<'t>(&mut self, rows: impl IntoIterator<Item = (&'t str, &'t str)>) -> io::Result<()> {
        let print = |(label, text)| print_hanging(self.text, &format!("  {label:10}  "), text);
        rows.into_iter().try_for_each(print)
    }
}

/// A number of cases.
fn in_cases(number: u64) -> String {
    counted(number as usize, "case")
}
