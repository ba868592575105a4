//! Which sensors a simulated robot has, and the parameters of its laser scanner.

use std::path::Path;

use crate::ScannerParams;
use clap::{
    ValueEnum,
    builder::{PossibleValuesParser, TypedValueParser},
};

use toposlam_terminal::{CliError, input};

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SensorChoice {
    /// A camera
    Camera,
    /// A laser scanner, and a detector of the marker
    Laser,
    /// Both; the robot drives by its camera
    Both,
}

impl SensorChoice {
    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Camera => "camera",
            Self::Laser => "laser",
            Self::Both => "both",
        }
    }

    /// The parameters of the laser scanner, if there is one.
    pub fn scanner(self, path: Option<&Path>) -> Result<Option<ScannerParams>, CliError> {
        match (self, path) {
            (Self::Camera, Some(_)) => {
                Err(CliError::at("--scanner", "the robot has no laser scanner; add --sensor laser"))
            }
            (Self::Camera, None) => Ok(None),
            (_, None) => Ok(Some(ScannerParams::default())),
            (_, Some(path)) => read_scanner(path).map(Some),
        }
    }
}

pub fn one_sensor() -> impl TypedValueParser<Value = SensorChoice> {
    let choices = [SensorChoice::Camera, SensorChoice::Laser];
    PossibleValuesParser::new(choices.map(SensorChoice::name)).map(|name| match name.as_str() {
        "laser" => SensorChoice::Laser,
        _ => SensorChoice::Camera,
    })
}

pub fn needs_camera(option: &str) -> CliError {
    CliError::at(option, "has no effect with --sensor laser: the robot has no camera")
}

/// Reads the parameters of a simulated laser scanner.
pub fn read_scanner(path: &Path) -> Result<ScannerParams, CliError> {
    let bytes = input::read(path)?;
    let text = std::str::from_utf8(&bytes).map_err(|error| CliError::in_file(path, error))?;
    toposlam_vision::params::read(text).map_err(|error| CliError::in_file(path, error))
}
