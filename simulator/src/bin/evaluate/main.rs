//! `evaluate WHAT`: compares sensing, driving and whole runs with the ground truth.

mod control;
mod failed_runs;
mod failing;
mod laser;
mod lengths;
mod logs;
mod mistakes;
mod report;
mod robots;
mod runs;
mod vision;

use std::{
    io::{self, Write},
    process::ExitCode,
};

use clap::{Parser, Subcommand};
use toposlam_terminal::{
    exit_codes::help_end, progress::watch_for_interrupt, report_output::ReportOutput,
    terminal::TerminalOptions,
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
  evaluate logs                 the logs of whole runs, judged
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
    Logs(logs::EvaluateLogsArguments),
    Mistakes(mistakes::EvaluateMistakesArguments),
    Lengths(lengths::EvaluateLengthsArguments),
}

fn main() -> ExitCode {
    let arguments = EvaluateArguments::parse();
    arguments.terminal.apply();
    if let Err(failure) = watch_for_interrupt() {
        return failure.report();
    }
    let mut out = ReportOutput::new(io::stdout().lock());
    let result = match arguments.what {
        What::Vision(vision) => vision.run(&mut out),
        What::Control(control) => control.run(&mut out),
        What::Runs(runs) => runs.run(&mut out),
        What::Laser(laser) => laser.run(&mut out),
        What::Logs(logs) => logs.run(&mut out),
        What::Mistakes(mistakes) => mistakes.run(&mut out),
        What::Lengths(lengths) => lengths.run(&mut out),
    };
    match result.and_then(|outcome| Ok(out.flush().map(|()| outcome)?)) {
        Ok(outcome) => outcome.into(),
        Err(failure) => failure.report(),
    }
}
