//! `toposlam evaluate WHAT`: what a robot senses and where it gets, held against the truth.

mod control;
mod failing;
mod report;
mod robots;
mod runs;
mod vision;

use std::io::Write;

use clap::Subcommand;

use super::{Failure, Outcome};

/// Measure sensing, driving or whole runs against the truth, on many cases
#[derive(clap::Args)]
#[command(after_help = "Examples:
  toposlam evaluate vision --views 200 --out failing    sensing, on rendered views
  toposlam evaluate control                             each door of each junction
  toposlam evaluate runs                                whole buildings, mapped")]
pub(super) struct EvaluateArguments {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    Vision(vision::EvaluateVisionArguments),
    Control(control::EvaluateControlArguments),
    Runs(runs::EvaluateRunsArguments),
}

impl EvaluateArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        match self.what {
            What::Vision(vision) => vision.run(out),
            What::Control(control) => control.run(out),
            What::Runs(runs) => runs.run(out),
        }
    }
}
