//! The verbs of the command line, and what they share: exit codes, errors, text output.

mod camera;
mod certificate_cost;
mod check;
mod ci_report;
mod cluster;
mod compare;
mod conform;
mod counterexample;
mod draw;
mod drive;
mod earlier_logs;
mod explore;
mod explorer;
mod info;
mod laser_options;
mod mapping_marker;
mod old_names;
mod open_log;
mod play;
mod proofs;
mod ros_options;
mod run_capture;
mod run_options;
mod run_report;
mod sense;
mod simulate;
mod verdict_proof;
mod version;
mod walk_page;

use std::{
    env,
    ffi::{OsStr, OsString},
    io::{self, Write},
    path::Path,
    process::ExitCode,
};

use clap::{
    Command, CommandFactory, FromArgMatches, Parser, Subcommand,
    builder::{PossibleValue, PossibleValuesParser, TypedValueParser},
};
use toposlam_model::{
    aid::{self, AIDS, AidKind},
    check::{DEFAULT_STATE_BUDGET, RunChoices},
    format::named_world::NamedWorld,
};
use toposlam_simulator::options::{appearance, noise, robot_sensor};
use toposlam_terminal::{
    CliError, Outcome, children, edge_range, exit_codes, input, json, method_options, outcome,
    output, picture_file, progress,
    report_output::ReportOutput,
    scene,
    terminal::{self, TerminalOptions},
    text,
    thread_option::{self, ThreadOption},
};

use crate::picture::{self, WorldPicture};

/// Deterministic topological SLAM that can be trusted: an executable specification of the mapping
/// algorithm, and a checker that runs it on every small world
#[derive(Parser)]
#[command(
    name = "toposlam",
    version = version::version(),
    max_term_width = 80,
    after_help = exit_codes::help_end(
        "Example:\n  toposlam check  run the algorithm on every world with up to 6 edges\n\n\
         Where a command reads a file, - is standard input.",
        &[
            (0, "it holds, or the work is done"),
            (1, "it is violated"),
            (2, "bad usage or input"),
            (3, "it is not known: a limit was reached, a log is truncated, a sample is too small, or \
                 the work was stopped"),
        ],
    )
)]
struct CommandLine {
    #[command(subcommand)]
    verb: Option<Verb>,
    #[command(flatten)]
    terminal: TerminalOptions,
}

#[derive(Subcommand)]
enum Verb {
    Check(check::CheckArguments),
    Explore(explore::ExploreArguments),
    Compare(compare::CompareArguments),
    Counterexample(counterexample::CounterexampleArguments),
    Draw(draw::DrawArguments),
    Play(play::PlayArguments),
    Proofs(proofs::ProofsArguments),
    Simulate(simulate::SimulateArguments),
    Drive(drive::DriveArguments),
    Camera(camera::CameraArguments),
    Sense(sense::SenseArguments),
    Info(info::InfoArguments),
    Conform(conform::ConformArguments),
}

/// Parses how the open choices of Algorithm 1 are made: by default, or in every way with at most so many states.
fn run_choices(text: &str) -> Result<RunChoices, String> {
    let budget = match text {
        "default" => return Ok(RunChoices::Default),
        "all" => Some(DEFAULT_STATE_BUDGET),
        _ => text.strip_prefix("all=").and_then(|budget| budget.parse().ok()),
    };
    let budget = budget.filter(|&budget| budget > 0);
    budget
        .map(|budget| RunChoices::All { budget })
        .ok_or_else(|| "write default, all, or all=N with a number of states".to_owned())
}

/// Parses the name of an aid. `--help` and errors list all of them.
fn aid_kinds() -> impl TypedValueParser<Value = AidKind> {
    one_of(AIDS)
}

/// Parses the name of an aid that marks places. `--help` and errors list all of them.
fn marking_aids() -> impl TypedValueParser<Value = AidKind> {
    one_of(AIDS.into_iter().filter(|aid| aid.marks()))
}

fn one_of(aids: impl IntoIterator<Item = AidKind>) -> impl TypedValueParser<Value = AidKind> {
    let named = |aid: AidKind| PossibleValue::new(aid.name()).help(aid.about());
    let names: Vec<_> = aids.into_iter().map(named).collect();
    PossibleValuesParser::new(names).try_map(|name| aid::named(&name))
}

/// Writes a drawing as PNG or SVG, by the ending of the file.
fn write_drawing(path: &Path, svg: &str) -> Result<(), CliError> {
    if path.extension().is_some_and(|ending| ending == "png") {
        let bytes = picture::png(svg).map_err(|error| CliError::in_file(path, error))?;
        return output::write_whole(path, &bytes);
    }
    output::write_whole(path, svg.as_bytes())
}

/// Writes a world, or a picture of it, by the ending of the file.
fn write_world_or_picture(
    path: &Path,
    world: &NamedWorld,
    picture: &WorldPicture,
) -> Result<(), CliError> {
    match path.extension().and_then(OsStr::to_str) {
        Some("svg" | "png") => write_drawing(path, &picture::svg(picture)),
        _ => output::write_world(path, world),
    }
}

/// Runs the verb on the command line, and returns the exit code of the program. The revision of its sources is
/// part of its version.
pub fn run(revision: Option<&str>) -> ExitCode {
    version::set_revision(revision);
    let renamed = match old_names::with_new_names(env::args_os().collect()) {
        Ok(renamed) => renamed,
        Err(gone) => return gone.report(),
    };
    let arguments = parse(&renamed.arguments);
    arguments.terminal.apply();
    for remark in renamed.remarks {
        remark!("{remark}");
    }
    let threads = match &arguments.verb {
        Some(Verb::Check(verb)) => verb.threads,
        Some(Verb::Counterexample(verb)) => verb.threads,
        _ => ThreadOption::default(),
    };
    if let Err(failure) = progress::watch_for_interrupt().and_then(|()| threads.apply()) {
        return failure.report();
    }
    let mut out = ReportOutput::new(io::stdout().lock());
    let result = match arguments.verb {
        Some(Verb::Check(verb)) => verb.run(&mut out),
        Some(Verb::Explore(verb)) => verb.run(&mut out),
        Some(Verb::Compare(verb)) => verb.run(&mut out),
        Some(Verb::Counterexample(verb)) => verb.run(&mut out),
        Some(Verb::Draw(verb)) => verb.run(&mut out),
        Some(Verb::Play(verb)) => verb.run(&mut out),
        Some(Verb::Proofs(verb)) => verb.run(&mut out),
        Some(Verb::Simulate(verb)) => verb.run(&mut out),
        Some(Verb::Drive(verb)) => verb.run(&mut out),
        Some(Verb::Camera(verb)) => verb.run(&mut out),
        Some(Verb::Sense(verb)) => verb.run(&mut out),
        Some(Verb::Info(verb)) => verb.run(&mut out),
        Some(Verb::Conform(verb)) => verb.run(&mut out),
        None => write!(out, "{}", CommandLine::command().render_help())
            .map_or_else(|error| Err(error.into()), |()| Ok(Outcome::Holds)),
    };
    match result.and_then(|outcome| out.flush().map(|()| outcome).map_err(CliError::from)) {
        Ok(outcome) => outcome.into(),
        Err(failure) => failure.report(),
    }
}

/// The command line, for what is made of it: manual pages, completions.
pub fn command() -> Command {
    CommandLine::command()
}

/// Parses the command line. Prints help, the version or an error, and ends the program, if that is asked
/// for or due.
fn parse(arguments: &[OsString]) -> CommandLine {
    let mut command = old_names::with_old_options(command());
    let parsed = command.try_get_matches_from_mut(arguments);
    let parsed = parsed.and_then(|matches| CommandLine::from_arg_matches(&matches));
    parsed.unwrap_or_else(|error| error.format(&mut command).exit())
}
