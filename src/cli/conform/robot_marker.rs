//! The kind of the robot's marker.

use clap::{ValueEnum, builder::PossibleValue};
use toposlam_model::{
    marker::{Directional, Marker, NoMarker, Undirected},
    trace::AlgorithmCase,
};

use super::{CliError, ConformArguments, DriverOption};

/// A marker of a robot whose log is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RobotMarker {
    Directional,
    Undirected,
    None,
}

impl RobotMarker {
    pub(super) fn marker(self) -> &'static dyn Marker {
        match self {
            Self::Directional => &Directional,
            Self::Undirected => &Undirected,
            Self::None => &NoMarker,
        }
    }
}

impl ValueEnum for RobotMarker {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Directional, Self::Undirected, Self::None]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let marker = self.marker();
        Some(PossibleValue::new(marker.name()).help(marker.about()))
    }
}

impl ConformArguments {
    /// Checks the options about the marker and the driver.
    pub(super) fn check_marker(&self) -> Result<(), CliError> {
        let directional = self.marker.is_none_or(|marker| marker == RobotMarker::Directional);
        if !directional && self.driver == DriverOption::Algorithm {
            let marker = self.marker.map_or("", |marker| marker.marker().name());
            let cause = "the algorithms need the directional marker; add --driver anyone";
            return Err(CliError::at(format!("--marker {marker}"), cause));
        }
        if self.assume_marker && self.marker == Some(RobotMarker::None) {
            return Err(CliError::at("--assume-marker", "this needs another marker than none"));
        }
        if self.driver == DriverOption::Anyone {
            let cause = "with --driver anyone the doors are compared with no algorithm";
            if self.algorithm.is_some() {
                return Err(CliError::at("--algorithm", cause));
            }
            if self.max_darts.is_some() {
                return Err(CliError::at("--max-darts", cause));
            }
            let is_of_algorithm =
                |name: &&String| AlgorithmCase::ALL.iter().any(|case| case.name() == name.as_str());
            if let Some(case) = self.require_coverage.iter().find(is_of_algorithm) {
                let cause = format!("{cause}, so that {case} is never covered");
                return Err(CliError::at("--require-coverage", cause));
            }
        }
        Ok(())
    }
}
