//! `toposlam evaluate WHAT`: compares sensing, driving and whole runs with the ground truth.

mod clutter;
mod control;
mod failing;
mod laser;
mod lengths;
mod mistakes;
mod report;
mod robots;
mod runs;
mod vision;

use std::io::Write;

use clap::Subcommand;

use super::{CliError, Outcome, exit_codes::help_end};

/// Measure sensing, driving, whole runs and single mistakes against the ground truth
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  toposlam evaluate vision --views 200   sensing on rendered views
  toposlam evaluate control              every door of every junction
  toposlam evaluate runs                 mapping of whole buildings
  toposlam evaluate laser                junctions by a laser scanner
  toposlam evaluate mistakes --audit     what one mistake does
  toposlam evaluate lengths              false alarms of measured hallways",
    &[
        (0, "all targets are met, everything is right"),
        (1, "a target is missed, or something is wrong"),
        (2, "bad usage or input"),
        (3, "a target is not shown, or not everything was measured"),
    ],
))]
pub(super) struct EvaluateArguments {
    #[command(subcommand)]
    what: What,
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

impl EvaluateArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        match self.what {
            What::Vision(vision) => vision.run(out),
            What::Control(control) => control.run(out),
            What::Runs(runs) => runs.run(out),
            What::Laser(laser) => laser.run(out),
            What::Mistakes(mistakes) => mistakes.run(out),
            What::Lengths(lengths) => lengths.run(out),
        }
    }
}
