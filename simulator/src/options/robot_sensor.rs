//! Which sensors a simulated robot has, and the parameters of its laser scanner.

use std::path::{Path, PathBuf};

use crate::{SCANNERS, ScannerParams};
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

/// The laser scanner of a simulated robot.
#[derive(clap::Args)]
pub struct ScannerOption {
    /// The laser scanner: lds-01, lds-02, rplidar-a1, rplidar-c1, ust-10lx, utm-30lx, lms-200, lms-291, urg-04lx; or a
    /// file with its parameters and those of what makes scans harder to read, .toml
    #[arg(long = "scanner", id = "scanner", value_name = "NAME|FILE")]
    pub given: Option<PathBuf>,
}

/// The parameters of a simulated laser scanner: of one with a name, or those in a file.
pub fn read_scanner(given: &Path) -> Result<ScannerParams, CliError> {
    let name = given.to_str().filter(|text| *text != "-" && !text.contains(['/', '\\', '.']));
    if let Some(name) = name {
        if let Some(params) = ScannerParams::named(name) {
            return Ok(params);
        }
        if !given.exists() {
            let names = SCANNERS.map(|scanner| scanner.name).join(", ");
            let error = format!("there is no scanner `{name}`; expected one of {names}, or a file");
            return Err(CliError::at("--scanner", error));
        }
    }
    let bytes = input::read(given)?;
    let text = std::str::from_utf8(&bytes).map_err(|error| CliError::in_file(given, error))?;
    toposlam_vision::params::read(text).map_err(|error| CliError::in_file(given, error))
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[derive(clap::Parser)]
    struct Line {
        #[command(flatten)]
        scanner: ScannerOption,
    }

    #[test]
    fn the_help_lists_the_scanners_and_an_unknown_name_is_an_error_that_does() {
        let help = Line::command().render_long_help().to_string();
        let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
        let error = read_scanner(Path::new("lds-03")).unwrap_err().cause_in(Path::new(""));
        assert!(error.starts_with("--scanner: there is no scanner `lds-03`"), "{error}");
        let names = SCANNERS.map(|scanner| scanner.name).join(", ");
        assert!(help.contains(&names) && error.contains(&names), "{help}{error}");
        assert_eq!(read_scanner(Path::new("lds-01")).unwrap().range, 3.5);
        assert!(read_scanner(Path::new("./lds-01")).is_err(), "a file that does not exist");
    }
}
