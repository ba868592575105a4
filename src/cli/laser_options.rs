//! The options of sensing with a laser scanner.

use std::path::PathBuf;

use clap::ValueEnum;
use toposlam_conform::Evidence;
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
    /// Whether bends and dead ends of corridors are vertices, for laser scans [default: no]
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

    /// The parameters.
    pub(super) fn params(&self) -> Result<LaserParams, CliError> {
        let Some(path) = &self.laser_params else { return Ok(LaserParams::default()) };
        let text = String::from_utf8(input::read(path)?)
            .map_err(|error| CliError::in_file(path, error))?;
        params::read(&text).map_err(|error| CliError::in_file(path, error))
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

    /// The parameters.
    pub(super) fn params(&self) -> Result<LaserParams, CliError> {
        let mut params = self.laser.params()?;
        if let Some(corners) = self.corners {
            params.corner.corners = corners == Corners::Yes;
        }
        Ok(params)
    }
}
