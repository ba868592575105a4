//! `toposlam proofs`: lists and checks the lemmas behind the mapping algorithms, and prints single cases.

mod case;
#[cfg(test)]
mod tests;

use std::{
    io::{self, Write},
    mem,
};

use serde_json::{Value, json};
use toposlam_proofs::{
    CheckTotals, ENGINES, Lemma, LemmaCheck, LemmaFailure, Statements, lemma::in_cases,
    statements::ALL,
};

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
#[command(mut_arg("report", |report| report.requires("run").conflicts_with("choices")))]
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

impl ProofsArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        self.ci.check_places()?;
        self.run_with(&Statements::all(), out)
    }

    fn run_with(&self, all: &Statements, out: &mut dyn Write) -> Result<Outcome, CliError> {
        if self.choices.is_some() && !matches!(self.run.as_slice(), [name] if name != ALL) {
            let cause = "choices make a case of one lemma; choose it with one --run";
            return Err(CliError::at("--choices", cause));
        }
        let lemmas = all.named(&self.run).map_err(|cause| CliError::at("--run", cause))?;
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
            let file = Some(lemma.file.into());
            let (name, seconds) = (name.to_owned(), Some(seconds));
            results.push(CiCase { name, outcome, message, file, seconds });
            checked.push(check);
            if outcome == Outcome::Incomplete {
                break;
            }
        }
        for LemmaCheck { lemma, failure, .. } in &checked {
            match failure {
                Some(LemmaFailure::Case(case)) => {
                    writeln!(report.text)?;
                    report.case(lemma, &case.choices)?;
                }
                Some(failure @ LemmaFailure::Cases { .. }) => {
                    writeln!(report.text)?;
                    report.statement(lemma.name, lemma.sentence)?;
                    print_hanging(report.text, "  fails: ", &failure.to_string())?;
                }
                Some(LemmaFailure::Stopped) | None => {}
            }
        }
        let outcome = report.totals(&CheckTotals::new(lemmas.len(), &checked))?;
        self.ci.write("proofs", &results, None)?;
        Ok(outcome)
    }
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
        "verdict": outcome.verdict(), "holds": outcome == Outcome::Holds,
        "choices": check.failure.as_ref().and_then(LemmaFailure::choices),
    });
    match &check.failure {
        Some(LemmaFailure::Case(case)) => line["claim"] = json!(case.claim),
        Some(LemmaFailure::Cases { pinned, .. }) => line["pinned"] = json!(pinned),
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
    fn list(&mut self, all: &Statements) -> Result<Outcome, CliError> {
        for lemma in &all.lemmas {
            self.entry(lemma.name, lemma.sentence, &lemma.details())?;
            print_line(self.json, "lemma", lemma)?;
        }
        for theorem in &all.theorems {
            self.entry(theorem.name, &theorem.sentence, &theorem.details())?;
            print_line(self.json, "theorem", theorem)?;
        }
        for (engine, how_to_run_it) in ENGINES {
            self.row(engine, how_to_run_it)?;
        }
        let counts = all.counts();
        let (lemmas, cases) = (counted(counts.lemmas, "lemma"), in_cases(counts.cases));
        let theorems = counted(counts.theorems, "theorem");
        writeln!(self.text)?;
        let text = format!("{lemmas}, {cases} within bounds; {theorems} for every world");
        print_paragraph(self.text, &text)?;
        print_line(self.json, "lemmas", &counts)?;
        Ok(Outcome::Holds)
    }

    fn totals(&mut self, totals: &CheckTotals) -> Result<Outcome, CliError> {
        let CheckTotals { lemmas, held, failed, not_checked, cases, interrupted, .. } = *totals;
        let (outcome, word, end) = match failed {
            0 if interrupted => (Outcome::Incomplete, "incomplete, interrupted", " held"),
            0 => (Outcome::Holds, "holds", ""),
            _ => (Outcome::Violated, "violated", " held"),
        };
        let mut line = json!(totals);
        line["verdict"] = json!(outcome.verdict());
        line["holds"] = json!(outcome == Outcome::Holds);
        print_line(self.json, "checks", &line)?;
        let left =
            if not_checked > 0 { format!("; {not_checked} not checked") } else { String::new() };
        let (lemmas, cases) = (counted(lemmas, "lemma"), in_cases(cases));
        writeln!(self.text, "\n{word}: {held} of {lemmas}{end}, {cases}{left}")?;
        Ok(outcome)
    }

    fn entry(&mut self, name: &str, sentence: &str, details: &[(&str, String)]) -> io::Result<()> {
        self.statement(name, sentence)?;
        details.iter().try_for_each(|(label, text)| self.row(label, text))?;
        writeln!(self.text)
    }

    fn statement(&mut self, name: &str, sentence: &str) -> io::Result<()> {
        writeln!(self.text, "{name}")?;
        print_hanging(self.text, "  ", sentence)
    }

    fn row(&mut self, label: &str, text: &str) -> io::Result<()> {
        print_hanging(self.text, &format!("  {label:10}  "), text)
    }
}
