//! The options of sensing with a laser scanner.

use std::path::PathBuf;

use clap::ValueEnum;
use toposlam_conform::Evidence;
use toposlam_robot::run_settings::LaserVertices;
use toposlam_vision::{laser::params::LaserParams, params};

use super::{CliError, input};

/// How laser scans are sensed.
#[derive(clap::Args)]
pub(super) struct LaserOptions {
    /// Parameters of sensing with a laser scanner (TOML) [default: for buildings with corridors]
    #[arg(long, value_name = "FILE")]
    laser_params: Option<PathBuf>,
}

/// How laser scans of a robot in a world are sensed.
#[derive(clap::Args)]
pub(super) struct WorldLaserOptions {
    #[command(flatten)]
    laser: LaserOptions,
    /// Whether bends and dead ends of corridors are vertices, for laser scans
    /// [default: from the log, or else no]
    #[arg(long, value_enum, value_name = "WHETHER")]
    corners: Option<Corners>,
}

/// Whether bends of corridors are vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Corners {
    /// Bends by 60 to 126 degrees have degree 2, dead ends degree 1
    Yes,
    /// They are parts of their corridors
    No,
}

impl LaserOptions {
    pub(super) fn given(&self) -> Option<&'static str> {
        self.laser_params.as_ref().map(|_| "--laser-params")
    }

    /// The parameters. What a log records of its robot's vertices holds where the file does not set it.
    pub(super) fn params(&self, recorded: Option<LaserVertices>) -> Result<LaserParams, CliError> {
        let params = recorded.map_or(LaserParams::DEFAULT, LaserVertices::params);
        let Some(path) = &self.laser_params else { return Ok(params) };
        let wrong = |error: &dyn std::fmt::Display| CliError::in_file(path, error.to_string());
        let text = String::from_utf8(input::read(path)?).map_err(|error| wrong(&error))?;
        params::read_over(&params, &text).map_err(|error| wrong(&error))
    }
}

impl WorldLaserOptions {
    /// Returns an error if an option is given for events from something else.
    pub(super) fn check_used(&self, evidence: Evidence) -> Result<(), CliError> {
        let given = self.laser.given().or(self.corners.map(|_| "--corners"));
        match given.filter(|_| evidence != Evidence::Laser) {
            Some(option) => {
                let cause = "the events are not from laser scans; add --events laser";
                Err(CliError::at(option, cause))
            }
            None => Ok(()),
        }
    }

    /// The parameters, for a log that records this of its robot's vertices.
    pub(super) fn params(&self, recorded: Option<LaserVertices>) -> Result<LaserParams, CliError> {
        let mut params = self.laser.params(recorded)?;
        if let Some(corners) = self.corners {
            params.corner.corners = corners == Corners::Yes;
        }
        Ok(params)
    }
}
