//! `toposlam proofs`: lists and checks the lemmas behind the mapping algorithms, and prints single cases.

mod case;
#[cfg(test)]
mod tests;

use std::{
    io::{self, Write},
    sync::mpsc::{self, RecvTimeoutError},
    thread,
    time::{Duration, Instant},
};

use clap::ValueEnum;
use serde::Serialize;
use serde_json::json;
use toposlam_model::enumerate::Watch;
use toposlam_proofs::{
    CaseReplay, Lemma, Stop, Theorem,
    lemma::LemmaFailure,
    lemmas,
    odometer::listed,
    theorems::{self, FILE},
};

use super::{
    CliError, Outcome,
    ci_report::{CiCase, CiOptions},
    exit_codes::help_end,
    json::print_line,
    progress::Progress,
    text::{counted, grouped, print_command, print_hanging, print_paragraph},
};
use case::CaseView;

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
    /// The engine whose bound applies to --choices: exhaustive or sampled
    #[arg(long, default_value = "exhaustive", hide_possible_values = true, requires = "choices")]
    engine: Engine,
    /// Print one JSON object a line; a list or a check ends with the totals
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    ci: CiOptions,
}

/// An engine, with its bound.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
enum Engine {
    /// Every case within a bound
    Exhaustive,
    /// Random cases within a larger bound
    Sampled,
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
        let find = |name: &String| find_lemma(name, lemmas, theorems);
        match (&self.choices, self.run.as_slice()) {
            (None, []) => self.list(lemmas, theorems, out).map(|()| Outcome::Holds),
            (None, names) => {
                let mut chosen: Vec<&Lemma> = Vec::new();
                for name in names {
                    let named = if name == ALL { lemmas.to_vec() } else { vec![find(name)?] };
                    let is_new = |lemma: &&Lemma| chosen.iter().all(|one| one.name != lemma.name);
                    let new: Vec<_> = named.into_iter().filter(is_new).collect();
                    chosen.extend(new);
                }
                self.check(&chosen, out)
            }
            (Some(choices), [name]) if name != ALL => self.print_case(find(name)?, choices, out),
            (Some(_), _) => {
                let cause = "choices make a case of one lemma; choose it with one --run";
                Err(CliError::at("--choices", cause))
            }
        }
    }

    /// Checks lemmas, each in every case within its bound.
    fn check(&self, lemmas: &[&Lemma], out: &mut dyn Write) -> Result<Outcome, CliError> {
        let longest = |texts: Vec<String>| texts.iter().map(String::len).max().unwrap_or_default();
        let names = longest(lemmas.iter().map(|lemma| lemma.name.to_owned()).collect());
        let numbers = longest(lemmas.iter().map(|l| in_cases(l.exhaustive.cases)).collect());
        let mut checked = Vec::new();
        for &lemma in lemmas {
            let progress = Progress::new(lemma.name, "cases")?;
            let result = CheckedLemma::new(lemma, &progress)?;
            progress.finish();
            if self.json {
                print_line(out, "check", &result)?;
            } else {
                let (name, seconds, number) = (lemma.name, result.seconds, in_cases(result.cases));
                let word = match result.outcome {
                    Outcome::Holds => "holds",
                    Outcome::Violated => "fails",
                    Outcome::Incomplete => "interrupted",
                };
                writeln!(out, "{name:names$}  {number:>numbers$}  {seconds:>6.2} s  {word}")?;
            }
            out.flush()?;
            let interrupted = result.interrupted;
            checked.push((lemma, result));
            if interrupted {
                break;
            }
        }
        let outcome = self.print_end(lemmas.len(), &checked, out)?;
        let cases: Vec<_> = checked.iter().map(|(lemma, result)| result.ci_case(lemma)).collect();
        self.ci.write("proofs", &cases)?;
        Ok(outcome)
    }

    /// Prints the cases in which lemmas fail, and the totals.
    fn print_end(
        &self,
        lemmas: usize,
        checked: &[(&Lemma, CheckedLemma)],
        out: &mut dyn Write,
    ) -> Result<Outcome, CliError> {
        for (lemma, result) in checked {
            if !self.json && result.outcome == Outcome::Violated {
                writeln!(out)?;
            }
            if let Some(choices) = &result.choices {
                self.print_case(lemma, choices, out)?;
            }
            if let (Some(pinned), false) = (result.pinned, self.json) {
                let [found, pinned] = [result.cases, pinned].map(in_cases);
                let cause = format!("expected {pinned} within its bound, found {found}");
                print_head(out, lemma.name, lemma.sentence, Some(&cause))?;
            }
        }
        let with = |outcome| checked.iter().filter(move |(_, result)| result.outcome == outcome);
        let cases = with(Outcome::Holds).chain(with(Outcome::Incomplete));
        let cases: u64 = cases.map(|(_, result)| result.cases).sum();
        let worst = [Outcome::Violated, Outcome::Incomplete];
        let worst = worst.into_iter().find(|&outcome| with(outcome).next().is_some());
        let (outcome, verdict) = match worst {
            Some(Outcome::Violated) => (Outcome::Violated, "violated"),
            Some(_) => (Outcome::Incomplete, "incomplete, interrupted"),
            None => (Outcome::Holds, "holds"),
        };
        let (held, not_checked) = (with(Outcome::Holds).count(), lemmas - checked.len());
        if self.json {
            let line = json!({
                "lemmas": lemmas, "held": held, "not_checked": not_checked, "cases": cases,
                "seconds": checked.iter().map(|(_, result)| result.seconds).sum::<f64>(),
                "interrupted": outcome == Outcome::Incomplete, "verdict": outcome.verdict(),
                "holds": outcome == Outcome::Holds,
            });
            print_line(out, "checks", &line)?;
            return Ok(outcome);
        }
        let hold = if outcome == Outcome::Holds { "" } else { " held" };
        let left =
            if not_checked > 0 { format!("; {not_checked} not checked") } else { String::new() };
        let (lemmas, cases) = (counted(lemmas, "lemma"), in_cases(cases));
        writeln!(out, "\n{verdict}: {held} of {lemmas}{hold}, {cases}{left}")?;
        Ok(outcome)
    }

    /// Prints the case of these choices, and returns the outcome. A case that the lemma excludes is incomplete.
    fn print_case(
        &self,
        lemma: &Lemma,
        choices: &[u8],
        out: &mut dyn Write,
    ) -> Result<Outcome, CliError> {
        let refused =
            |option, cause: String| CliError::at(option, format!("{}{cause}", lemma.name));
        let (replay, engine) = match (self.engine, lemma.sampled) {
            (Engine::Exhaustive, _) => (lemma.exhaustive.replay, ""),
            (Engine::Sampled, Some(sampled)) => (sampled.replay, " --engine sampled"),
            (Engine::Sampled, None) => {
                return Err(refused("--engine", " is not sampled".to_owned()));
            }
        };
        let made = CaseReplay::show(replay, choices)
            .map_err(|misfit| refused("--choices", format!(": {misfit}")))?;
        let (outcome, word, verdict, claim) = match made.case {
            Ok(()) => (Outcome::Holds, "holds", "holds: the lemma holds in this case", None),
            Err(Stop::Fails(claim)) => {
                (Outcome::Violated, "fails", "violated: the lemma fails in this case", Some(claim))
            }
            Err(Stop::Excluded) => {
                (Outcome::Incomplete, "excluded", "incomplete: the lemma excludes this case", None)
            }
        };
        let view = CaseView::new(lemma.name, &made.exhibits)?;
        if self.json {
            let line = json!({
                "lemma": lemma.name, "engine": self.engine, "choices": choices, "verdict": word,
                "holds": outcome == Outcome::Holds, "claim": claim, "worlds": view.worlds,
                "walks": view.walks, "values": view.values,
            });
            print_line(out, "case", &line)?;
            return Ok(outcome);
        }
        let cause = claim.map(|claim| format!("it is not true that {claim}"));
        print_head(out, lemma.name, lemma.sentence, cause.as_deref())?;
        let (name, choices) = (lemma.name, listed(choices));
        let again = format!("toposlam proofs --run {name}{engine} --choices {choices}");
        print_command(out, "  again: ", again.trim_end())?;
        out.write_all(&view.text)?;
        writeln!(out, "\n{verdict}")?;
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
        let [lemmas, theorems] =
            [counted(lemmas.len(), "lemma"), counted(theorems.len(), "theorem")];
        writeln!(out)?;
        let totals =
            format!("{lemmas}, {} within bounds; {theorems} for {EVERY_WORLD}", in_cases(cases));
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

/// The result of the check of a lemma: a line of `--json`.
#[derive(Serialize)]
struct CheckedLemma {
    #[serde(skip)]
    outcome: Outcome,
    lemma: &'static str,
    /// Those in which it holds, before the first one in which it fails.
    cases: u64,
    seconds: f64,
    verdict: &'static str,
    holds: bool,
    choices: Option<Vec<u8>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    claim: Option<&'static str>,
    /// The expected number of cases, if another number was found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pinned: Option<u64>,
    interrupted: bool,
}

impl CheckedLemma {
    /// The result for CI systems.
    fn ci_case(&self, lemma: &Lemma) -> CiCase {
        let ended = match self.outcome {
            Outcome::Holds => "holds",
            Outcome::Violated => "fails",
            Outcome::Incomplete => "interrupted",
        };
        let message = format!("{ended} after {}", in_cases(self.cases));
        CiCase { name: lemma.name.to_owned(), outcome: self.outcome, message, file: None }
    }

    /// Checks a lemma on a thread of its own, so that an interrupt need not wait for the next case.
    fn new(lemma: &Lemma, watch: &dyn Watch) -> Result<Self, CliError> {
        const INTERVAL: Duration = Duration::from_millis(50);
        let (start, copy) = (Instant::now(), *lemma);
        let (so_far, number) = mpsc::channel();
        // After an interrupt there is no receiver.
        let work = move || copy.check(&mut |cases| so_far.send(cases).unwrap_or_default());
        let checking = thread::Builder::new().spawn(work);
        let checking = checking.map_err(|error| CliError::at(lemma.name, error))?;
        let mut cases = 0;
        let mut end = None;
        while end.is_none() && !watch.stop() {
            match number.recv_timeout(INTERVAL) {
                Ok(more) => {
                    if cases == 0 {
                        watch.parts((lemma.exhaustive.cases / more.max(1)) as usize);
                    }
                    watch.part_done(more - cases);
                    cases = more;
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => end = Some(()),
            }
        }
        let end = end.map(|()| checking.join()).transpose();
        let end = end.map_err(|_| CliError::at(lemma.name, "the check ended without a result"))?;
        let (outcome, cases, failed, pinned) = match end {
            None => (Outcome::Incomplete, cases, None, None),
            Some(Ok(all)) => (Outcome::Holds, all, None, None),
            Some(Err(LemmaFailure::Case(it))) => (Outcome::Violated, it.cases, Some(it), None),
            Some(Err(LemmaFailure::Cases { pinned, found })) => {
                (Outcome::Violated, found, None, Some(pinned))
            }
        };
        Ok(Self {
            outcome,
            lemma: lemma.name,
            cases,
            seconds: start.elapsed().as_secs_f64(),
            verdict: outcome.verdict(),
            holds: outcome == Outcome::Holds,
            claim: failed.as_ref().map(|failed| failed.claim),
            choices: failed.map(|failed| failed.choices),
            pinned,
            interrupted: outcome == Outcome::Incomplete,
        })
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
