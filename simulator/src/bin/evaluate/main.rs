//! `evaluate WHAT`: compares sensing, driving and whole runs with the ground truth.

mod control;
mod failing;
mod laser;
mod lengths;
mod mistakes;
mod report;
mod robots;
mod runs;
mod vision;

use std::{
    env,
    io::{self, Write},
    process::ExitCode,
};

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use toposlam_terminal::{
    exit_codes::help_end,
    report_output::ReportOutput,
    terminal::{self, TerminalOptions},
};

/// Measure sensing, driving, whole runs and single mistakes against the ground truth
#[derive(Parser)]
#[command(name = "evaluate", max_term_width = 80, after_help = help_end(
    "\
Examples:
  evaluate vision --views 200   sensing on rendered views
  evaluate control              every door of every junction
  evaluate runs                 mapping of whole buildings
  evaluate laser                junctions by a laser scanner
  evaluate mistakes --audit     what one mistake does
  evaluate lengths              false alarms of measured hallways",
    &[
        (0, "all targets are met, everything is right"),
        (1, "a target is missed, or something is wrong"),
        (2, "bad usage or input"),
        (3, "a target is not shown, or not everything was measured"),
    ],
))]
struct EvaluateArguments {
    #[command(subcommand)]
    what: What,
    #[command(flatten)]
    terminal: TerminalOptions,
}

#[derive(Subcommand)]
enum What {
    Vision(vision::EvaluateVisionArguments),
    Control(control::EvaluateControlArguments),
    Runs(runs::EvaluateRunsArguments),
    Laser(laser::EvaluateLaserArguments),
    Mistakes(mistakes::EvaluateMistakesArguments),
    Lengths(lengths::EvaluateLengthsArguments),
}

fn main() -> ExitCode {
    let mut command = EvaluateArguments::command().color(terminal::color_choice(env::args_os()));
    let parsed = command.try_get_matches_from_mut(env::args_os());
    let parsed = parsed.and_then(|matches| EvaluateArguments::from_arg_matches(&matches));
    let arguments = parsed.unwrap_or_else(|error| error.format(&mut command).exit());
    arguments.terminal.apply();
    let mut out = ReportOutput::new(io::stdout().lock());
    let result = match arguments.what {
        What::Vision(vision) => vision.run(&mut out),
        What::Control(control) => control.run(&mut out),
        What::Runs(runs) => runs.run(&mut out),
        What::Laser(laser) => laser.run(&mut out),
        What::Mistakes(mistakes) => mistakes.run(&mut out),
        What::Lengths(lengths) => lengths.run(&mut out),
    };
    match result.and_then(|outcome| Ok(out.flush().map(|()| outcome)?)) {
        Ok(outcome) => outcome.into(),
        Err(failure) => failure.report(),
    }
}
