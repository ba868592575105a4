//! A simulated robot with a laser scanner: which options have an effect.

use toposlam_simulator::ScannerParams;

use super::{CliError, SimulateArguments};
use crate::cli::robot_sensor::{SensorChoice, needs_camera};

impl SimulateArguments {
    /// The parameters of the laser scanner, if there is one. Rejects options without an effect.
    pub(super) fn scanner_params(&self) -> Result<Option<ScannerParams>, CliError> {
        let scanner = self.sensor.scanner(self.scanner.as_deref())?;
        if self.sensor == SensorChoice::Laser {
            let of_images = [
                ("--by-scene", self.by_scene),
                ("--calibration", self.calibration.is_some()),
                ("--size", self.size.is_some()),
                ("--colours", self.colours.is_some()),
                ("--frames", self.frames.is_some()),
            ];
            let given = of_images.into_iter().find(|(_, given)| *given).map(|(name, _)| name);
            let appearance = self.appearance.arguments().into_iter().map(|(name, _)| name).next();
            if let Some(option) = given.or(appearance) {
                return Err(needs_camera(option));
            }
        }
        Ok(scanner)
    }
}
