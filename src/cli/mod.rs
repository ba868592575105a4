//! The verbs of the command line, and what they share: exit codes, failures, files written whole.

mod appearance;
mod calibrate;
mod check;
mod compare;
mod completions;
mod conform;
mod counterexample;
mod draw;
mod drive;
mod evaluate;
mod explore;
mod info;
mod input;
mod json;
mod mapping_marker;
mod open_log;
mod outcome;
mod output;
mod paper;
mod picture_file;
mod progress;
mod proofs;
mod render;
mod replay;
mod scene;
mod sense;
mod simulate;
mod story_lines;
mod text;
mod train;
mod walk_page;

use std::{
    io::{self, Write},
    process::ExitCode,
};

use clap::{
    CommandFactory, Parser, Subcommand, ValueEnum,
    builder::{PossibleValue, PossibleValuesParser, TypedValueParser},
};
use toposlam_model::check::DEFAULT_STATE_BUDGET;
use toposlam_model::marker::{self, MARKERS, Marker};
use toposlam_robot::simulator::MotionNoise;

use outcome::{Failure, Outcome};

/// Deterministic topological SLAM that can be trusted: an executable specification of embedded
/// graphs, percepts and Algorithm 1, and a checker that runs it on every small world.
#[derive(Parser)]
#[command(
    name = "toposlam",
    version,
    max_term_width = 80,
    after_help = "Example:\n  toposlam check        every start of every world with up to 6 edges"
)]
struct CommandLine {
    #[command(subcommand)]
    verb: Option<Verb>,
}

#[derive(Subcommand)]
enum Verb {
    Check(check::CheckArguments),
    Explore(explore::ExploreArguments),
    Compare(compare::CompareArguments),
    Counterexample(counterexample::CounterexampleArguments),
    Draw(draw::DrawArguments),
    Paper(paper::PaperArguments),
    Proofs(proofs::ProofsArguments),
    Simulate(simulate::Arguments),
    Drive(drive::Arguments),
    Render(render::RenderArguments),
    Calibrate(calibrate::CalibrateArguments),
    Train(train::TrainArguments),
    Sense(sense::SenseArguments),
    Evaluate(evaluate::EvaluateArguments),
    Info(info::InfoArguments),
    Conform(conform::ConformArguments),
    Replay(replay::Arguments),
    Completions(completions::CompletionsArguments),
}

/// How what Algorithm 1 leaves open is resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ChoicesOption {
    /// By the default choices.
    Default,
    /// In every way.
    All,
}

/// Which runs of a start are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RunChoices {
    /// That of the default choices.
    Default,
    /// That, and every other resolution of what Algorithm 1 leaves open.
    All {
        /// How many states of one start may be explored.
        budget: u64,
    },
}

impl ChoicesOption {
    /// The choice, with a budget of states, which only all choices have.
    fn with_budget(self, max_states: Option<u64>) -> Result<RunChoices, Failure> {
        match (self, max_states) {
            (Self::Default, None) => Ok(RunChoices::Default),
            (Self::Default, Some(_)) => {
                Err(Failure::at("--max-states", "this goes with --choices all"))
            }
            (Self::All, budget) => {
                Ok(RunChoices::All { budget: budget.unwrap_or(DEFAULT_STATE_BUDGET) })
            }
        }
    }
}

/// Reads the name of a kind of marker; tells in `--help` and in refusals which there are.
fn marker_kinds() -> impl TypedValueParser<Value = &'static dyn Marker> {
    let kinds = MARKERS.map(|marker| PossibleValue::new(marker.name()).help(marker.about()));
    PossibleValuesParser::new(kinds).try_map(|name| marker::named(&name))
}

/// Reads how many times as inexact as by default a simulated robot is.
fn noise(text: &str) -> Result<f64, String> {
    let most = MotionNoise::MOST;
    match text.parse() {
        Ok(times) if (0.0..=most).contains(&times) => Ok(times),
        Ok(times) if times > most => {
            Err(format!("with more than {most} times the default a robot cannot find its way"))
        }
        _ => Err(format!("write a number from 0 to {most}")),
    }
}

/// Works with so many threads, where somebody says so.
fn use_threads(threads: Option<u16>) -> Result<(), Failure> {
    let Some(threads) = threads else { return Ok(()) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into());
    pool.build_global().map_err(|error| Failure::at("--threads", error))
}

/// What a program says that was built without ROS 1.
#[cfg(not(feature = "ros1"))]
fn without_ros() -> Failure {
    let cause = "this program was built without ROS 1; build it with it: \
                 cargo build --release --features ros1";
    Failure::at("--ros", cause)
}

/// Runs the verb that the command line names.
pub(crate) fn run() -> ExitCode {
    let arguments = CommandLine::parse();
    let mut out = io::stdout().lock();
    let result = match arguments.verb {
        Some(Verb::Check(verb)) => verb.run(&mut out),
        Some(Verb::Explore(verb)) => verb.run(&mut out),
        Some(Verb::Compare(verb)) => verb.run(&mut out),
        Some(Verb::Counterexample(verb)) => verb.run(&mut out),
        Some(Verb::Draw(verb)) => verb.run(&mut out),
        Some(Verb::Paper(verb)) => verb.run(&mut out),
        Some(Verb::Proofs(verb)) => verb.run(&mut out),
        Some(Verb::Simulate(verb)) => verb.run(&mut out),
        Some(Verb::Drive(verb)) => verb.run(&mut out),
        Some(Verb::Render(verb)) => verb.run(&mut out),
        Some(Verb::Calibrate(verb)) => verb.run(&mut out),
        Some(Verb::Train(verb)) => verb.run(&mut out),
        Some(Verb::Sense(verb)) => verb.run(&mut out),
        Some(Verb::Evaluate(verb)) => verb.run(&mut out),
        Some(Verb::Info(verb)) => verb.run(&mut out),
        Some(Verb::Conform(verb)) => verb.run(&mut out),
        Some(Verb::Replay(verb)) => verb.run(&mut out),
        Some(Verb::Completions(verb)) => verb.run(&mut out),
        None => help(&mut out),
    };
    match result.and_then(|outcome| out.flush().map(|()| outcome).map_err(Failure::from)) {
        Ok(outcome) => outcome.into(),
        Err(failure) => failure.report(),
    }
}

/// What `toposlam` alone prints: what it is, and its verbs.
fn help(out: &mut dyn Write) -> Result<Outcome, Failure> {
    write!(out, "{}", CommandLine::command().render_help())?;
    Ok(Outcome::Holds)
}
