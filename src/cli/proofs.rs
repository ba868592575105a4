//! `toposlam proofs`: lists and checks the lemmas behind the mapping algorithms, and prints single cases.

mod case;
#[cfg(test)]
mod tests;

use std::{
    collections::BTreeSet,
    io::{self, Write},
    ops::ControlFlow,
    time::Instant,
};

use serde_json::{Value, json};
use toposlam_model::enumerate::Watch;
use toposlam_proofs::{
    Lemma, Theorem,
    lemma::LemmaFailure,
    lemmas,
    theorems::{self, FILE},
};

use super::{
    CliError, Outcome,
    ci_report::{CiCase, CiOptions},
    exit_codes::help_end,
    json::print_line,
    progress::Progress,
    text::{counted, grouped, print_hanging, print_paragraph},
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

impl ProofsArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
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
        let mut chosen: Vec<&Lemma> = Vec::new();
        match (&self.choices, self.run.as_slice()) {
            (None, []) => return self.list(lemmas, theorems, out).map(|()| Outcome::Holds),
            (Some(choices), [name]) if name != ALL => {
                return case::print(find_lemma(name, lemmas, theorems)?, choices, self.json, out);
            }
            (Some(_), _) => {
                let cause = "choices make a case of one lemma; choose it with one --run";
                return Err(CliError::at("--choices", cause));
            }
            (None, names) => {
                for name in names {
                    let lemma = find_lemma(name, lemmas, theorems);
                    let named = if name == ALL { lemmas.to_vec() } else { vec![lemma?] };
                    chosen.extend(named);
                }
            }
        }
        let mut names = BTreeSet::new();
        chosen.retain(|lemma| names.insert(lemma.name));
        self.check(&chosen, out)
    }

    /// Checks lemmas, each in every case within its bound. Prints the cases in which lemmas fail, and the totals.
    fn check(&self, lemmas: &[&Lemma], out: &mut dyn Write) -> Result<Outcome, CliError> {
        let names = lemmas.iter().map(|lemma| lemma.name.len()).max().unwrap_or_default();
        let numbers = lemmas.iter().map(|lemma| in_cases(lemma.exhaustive.cases).len());
        let numbers = numbers.max().unwrap_or_default();
        let mut checked = Vec::new();
        for lemma in lemmas {
            let progress = Progress::new(lemma.name, "cases")?;
            let result = CheckedLemma::new(lemma, &progress);
            progress.finish();
            if self.json {
                print_line(out, "check", &result.json())?;
            } else {
                let (name, seconds, number) = (lemma.name, result.seconds, in_cases(result.cases));
                let word = result.in_words();
                writeln!(out, "{name:names$}  {number:>numbers$}  {seconds:>6.2} s  {word}")?;
            }
            out.flush()?;
            let is_stopped = result.outcome == Outcome::Incomplete;
            checked.push(result);
            if is_stopped {
                break;
            }
        }
        for result in checked.iter().filter(|it| it.outcome == Outcome::Violated) {
            result.print_failure(self.json, out)?;
        }
        let outcome = self.print_totals(lemmas.len(), &checked, out)?;
        let cases: Vec<_> = checked.iter().map(CheckedLemma::ci_case).collect();
        self.ci.write("proofs", &cases)?;
        Ok(outcome)
    }

    fn print_totals(
        &self,
        lemmas: usize,
        checked: &[CheckedLemma],
        out: &mut dyn Write,
    ) -> Result<Outcome, CliError> {
        let count = |outcome| checked.iter().filter(|it| it.outcome == outcome).count();
        let sound = checked.iter().filter(|it| it.outcome != Outcome::Violated);
        let cases: u64 = sound.map(|result| result.cases).sum();
        let (outcome, verdict, word) = match [Outcome::Violated, Outcome::Incomplete].map(count) {
            [0, 0] => (Outcome::Holds, "holds", ""),
            [0, _] => (Outcome::Incomplete, "incomplete, interrupted", " held"),
            [_, _] => (Outcome::Violated, "violated", " held"),
        };
        let (held, not_checked) = (count(Outcome::Holds), lemmas - checked.len());
        if self.json {
            let line = json!({
                "lemmas": lemmas, "held": held, "not_checked": not_checked, "cases": cases,
                "seconds": checked.iter().map(|result| result.seconds).sum::<f64>(),
                "interrupted": outcome == Outcome::Incomplete, "verdict": outcome.verdict(),
                "holds": outcome == Outcome::Holds,
            });
            print_line(out, "checks", &line)?;
            return Ok(outcome);
        }
        let left =
            if not_checked > 0 { format!("; {not_checked} not checked") } else { String::new() };
        let (lemmas, cases) = (counted(lemmas, "lemma"), in_cases(cases));
        writeln!(out, "\n{verdict}: {held} of {lemmas}{word}, {cases}{left}")?;
        Ok(outcome)
    }

    /// Prints the lemmas and the theorems, and their numbers.
    fn list(
        &self,
        lemmas: &[&Lemma],
        theorems: &[Theorem],
        out: &mut dyn Write,
    ) -> Result<(), CliError> {
        let cases = lemmas.iter().map(|lemma| lemma.exhaustive.cases).sum();
        if self.json {
            lemmas.iter().try_for_each(|lemma| print_line(out, "lemma", lemma))?;
            for Theorem { name, sentence, paper } in theorems {
                let line = json!({
                    "theorem": name, "sentence": sentence, "paper": paper, "file": FILE,
                    "coq": { "bound": EVERY_WORLD },
                });
                print_line(out, "theorem", &line)?;
            }
            let totals = json!({
                "lemmas": lemmas.len(), "theorems": theorems.len(), "cases": cases,
                "sampled": lemmas.iter().filter(|lemma| lemma.sampled.is_some()).count(),
                "kani": lemmas.iter().filter(|lemma| lemma.kani.is_some()).count(),
            });
            return print_line(out, "lemmas", &totals);
        }
        for Lemma { name, sentence, paper, file, exhaustive, sampled, kani } in lemmas {
            let every = format!("{}: {}", exhaustive.bound, in_cases(exhaustive.cases));
            let kani = kani.map(|kani| format!("{}; unwind {}", kani.bound, kani.unwind));
            print_head(out, name, sentence, None)?;
            print_labelled(out, [("paper", *paper), ("file", *file), ("exhaustive", &every)])?;
            print_labelled(out, sampled.map(|sampled| ("sampled", sampled.bound)))?;
            print_labelled(out, kani.as_deref().map(|kani| ("Kani", kani)))?;
            writeln!(out)?;
        }
        for Theorem { name, sentence, paper } in theorems {
            print_head(out, name, sentence, None)?;
            print_labelled(out, [("paper", paper.as_str()), ("file", FILE), ("Coq", EVERY_WORLD)])?;
            writeln!(out)?;
        }
        print_labelled(out, ENGINES)?;
        let (lemmas, theorems) =
            (counted(lemmas.len(), "lemma"), counted(theorems.len(), "theorem"));
        let totals =
            format!("{lemmas}, {} within bounds; {theorems} for {EVERY_WORLD}", in_cases(cases));
        writeln!(out)?;
        Ok(print_paragraph(out, &totals)?)
    }
}

/// The lemma of this name, or else the only one whose name contains it.
fn find_lemma<'l>(
    name: &str,
    lemmas: &[&'l Lemma],
    theorems: &[Theorem],
) -> Result<&'l Lemma, CliError> {
    if let Some(lemma) = lemmas.iter().find(|lemma| lemma.name == name) {
        return Ok(lemma);
    }
    let fitting: Vec<_> = lemmas.iter().copied().filter(|l| l.name.contains(name)).collect();
    let (cause, listed) = match fitting.as_slice() {
        _ if theorems.iter().any(|theorem| theorem.name == name) => {
            let how = "is proved in Coq, for every world; run proofs/coq/check to check it";
            return Err(CliError::at("--run", format!("{name} {how}")));
        }
        [lemma] => return Ok(lemma),
        [] => (format!("there is no lemma `{name}`; there are"), lemmas),
        several => (format!("`{name}` is part of several names"), several),
    };
    let lines: Vec<_> = listed.iter().map(|lemma| lemma.name).collect();
    Err(CliError::at("--run", format!("{cause}:\n  {}", lines.join("\n  "))))
}

/// The result of the check of a lemma.
struct CheckedLemma<'l> {
    lemma: &'l Lemma,
    /// Those in which it holds, before the first one in which it fails.
    cases: u64,
    outcome: Outcome,
    failure: Option<LemmaFailure>,
    seconds: f64,
}

impl<'l> CheckedLemma<'l> {
    fn new(lemma: &'l Lemma, watch: &dyn Watch) -> Self {
        let start = Instant::now();
        let mut before = 0;
        let end = lemma.check(&mut |so_far| {
            if before == 0 {
                watch.parts((lemma.exhaustive.cases / so_far) as usize);
            }
            watch.part_done(so_far - before);
            before = so_far;
            if watch.stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let (cases, outcome) = match &end {
            Ok(all) => (*all, Outcome::Holds),
            Err(LemmaFailure::Case(case)) => (case.cases, Outcome::Violated),
            Err(LemmaFailure::Cases { found, .. }) => (*found, Outcome::Violated),
            Err(LemmaFailure::Stopped(so_far)) => (*so_far, Outcome::Incomplete),
        };
        let seconds = start.elapsed().as_secs_f64();
        Self { lemma, cases, outcome, failure: end.err(), seconds }
    }

    fn in_words(&self) -> &'static str {
        match self.outcome {
            Outcome::Holds => "holds",
            Outcome::Violated => "fails",
            Outcome::Incomplete => "interrupted",
        }
    }

    fn json(&self) -> Value {
        let Self { lemma, cases, outcome, failure, seconds } = self;
        let mut line = json!({
            "lemma": lemma.name, "cases": cases, "seconds": seconds, "verdict": outcome.verdict(),
            "holds": *outcome == Outcome::Holds, "choices": null,
        });
        match failure {
            Some(LemmaFailure::Case(case)) => {
                line["choices"] = json!(case.choices);
                line["claim"] = json!(case.claim);
            }
            Some(LemmaFailure::Cases { pinned, .. }) => line["pinned"] = json!(pinned),
            Some(LemmaFailure::Stopped(_)) | None => {}
        }
        line["interrupted"] = json!(*outcome == Outcome::Incomplete);
        line
    }

    /// Prints the case in which it fails, or that there is another number of cases.
    fn print_failure(&self, json: bool, out: &mut dyn Write) -> Result<(), CliError> {
        if !json {
            writeln!(out)?;
        }
        match &self.failure {
            Some(LemmaFailure::Case(case)) => {
                case::print(self.lemma, &case.choices, json, out)?;
            }
            Some(LemmaFailure::Cases { pinned, found }) if !json => {
                let [found, pinned] = [*found, *pinned].map(in_cases);
                let cause = format!("expected {pinned} within its bound, found {found}");
                print_head(out, self.lemma.name, self.lemma.sentence, Some(&cause))?;
            }
            _ => {}
        }
        Ok(())
    }

    /// The result for CI systems.
    fn ci_case(&self) -> CiCase {
        let message = format!("{} after {}", self.in_words(), in_cases(self.cases));
        CiCase { name: self.lemma.name.to_owned(), outcome: self.outcome, message, file: None }
    }
}

/// Prints a lemma or a theorem, and why it fails.
fn print_head(
    out: &mut dyn Write,
    name: &str,
    sentence: &str,
    fails: Option<&str>,
) -> io::Result<()> {
    writeln!(out, "{name}")?;
    print_hanging(out, "  ", sentence)?;
    fails.map_or(Ok(()), |cause| print_hanging(out, "  fails: ", cause))
}

fn print_labelled<'t>(
    out: &mut dyn Write,
    rows: impl IntoIterator<Item = (&'t str, &'t str)>,
) -> io::Result<()> {
    let print = |(label, text)| print_hanging(out, &format!("  {label:10}  "), text);
    rows.into_iter().try_for_each(print)
}

/// A number of cases.
fn in_cases(number: u64) -> String {
    format!("{} case{}", grouped(number.into()), if number == 1 { "" } else { "s" })
}

const EVERY_WORLD: &str = "every world";

/// How to run each engine; printed below the list.
const ENGINES: [(&str, &str); 4] = [
    ("exhaustive", "every case within the bound: toposlam proofs --run NAME, or --run all"),
    ("sampled", "random cases within the bound: cargo test -p toposlam-proofs"),
    (
        "Kani",
        "every case within the bound, symbolically: proofs/kani/verify, if Kani is installed; \
         neither this program nor cargo test runs it, and this list does not contain its results",
    ),
    (
        "Coq",
        "every world, without a bound: proofs/coq/check, if Coq is installed; cargo test -p \
         toposlam-proofs runs it too, this program does not",
    ),
];
