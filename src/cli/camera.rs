//! `toposlam camera calibrate|train`: the mirror of a camera, and the colours of a building.

mod calibrate;
mod train;

use std::io::Write;

use clap::Subcommand;

use super::{CliError, Outcome};

/// Calibrate a camera's mirror, or learn the colours of a building
#[derive(clap::Args)]
#[command(after_help = super::exit_codes::help_end(
    "Example:\n  toposlam camera calibrate view-*.png --out camera.toml",
    &[(0, "the calibration or the colours are written"), (2, "bad usage or input"), (3, "interrupted")],
))]
pub(super) struct CameraArguments {
    #[command(subcommand)]
    command: CameraCommand,
}

#[derive(Subcommand)]
enum CameraCommand {
    Calibrate(calibrate::CalibrateArguments),
    Train(train::TrainArguments),
}

impl CameraArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        match self.command {
            CameraCommand::Calibrate(command) => command.run(out),
            CameraCommand::Train(command) => command.run(out),
        }
    }
}
