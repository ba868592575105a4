//! `toposlam evaluate WHAT`: what a robot senses, held against the truth.

mod failing;
mod report;
mod vision;

use std::io::Write;

use clap::Subcommand;

use super::{Failure, Outcome};

/// Measure sensing against the truth, on many cases
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  toposlam evaluate vision --views 200 --out failing    rendered views, \
                  and pictures of those on which sensing fails"
)]
pub(super) struct Arguments {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    Vision(vision::Arguments),
}

impl Arguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        match self.what {
            What::Vision(vision) => vision.run(out),
        }
    }
}
