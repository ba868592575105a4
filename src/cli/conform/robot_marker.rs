//! The robot's marker: its kind, and how its sightings came into the events of a log.

use std::path::Path;

use clap::{ValueEnum, builder::PossibleValue};
use serde::Serialize;
use toposlam_conform::{Evidence, ExtractedRun, assume_marker, mark_visits, marker_at_start};
use toposlam_logs::topic_map::{MarkerPlace, Role};
use toposlam_model::marker::{Directional, Marker, NoMarker, Undirected};

use super::{CliError, ConformArguments, Who, required_coverage};
use crate::cli::{open_log::OpenLog, text::counted};

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

/// Where a marker lay when the run began, as far as it is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MarkerStart {
    /// At the robot's start, along its entry door.
    Robot,
    /// Anywhere.
    Anywhere,
}

/// Sightings that the log itself does not record as percepts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum AddedMarker {
    /// A marker that was not there.
    Assumed {
        place: MarkerPlace,
        /// The number of visits at which it would have been seen.
        seen: usize,
    },
    /// A fiducial.
    Fiducial {
        /// The number of its sightings.
        sightings: usize,
        /// The number of them at no junction that the robot visited.
        elsewhere: usize,
    },
}

/// A marker that was assumed, in JSON.
#[derive(Serialize)]
pub(super) struct AssumedMarkerFields {
    /// In the frame of odometry, in metres.
    position: [f64; 2],
    /// In radians.
    heading: Option<f64>,
    /// The number of visits at which it would have been seen.
    seen: usize,
}

impl AddedMarker {
    /// What it is, as a fact of the report.
    pub(super) fn in_words(self) -> String {
        match self {
            Self::Assumed { place: MarkerPlace { position: [x, y], heading }, seen } => {
                let towards = heading.map_or(String::new(), |heading| {
                    format!(", heading {:.0} degrees", heading.to_degrees())
                });
                format!(
                    "assumed, not in the log: at x {x:.1} m, y {y:.1} m of odometry{towards}; seen at {}",
                    counted(seen, "visit")
                )
            }
            Self::Fiducial { sightings, elsewhere } => {
                let elsewhere = match elsewhere {
                    0 => String::new(),
                    count => format!(", {count} of them at no junction that was visited"),
                };
                format!("a fiducial with {}{elsewhere}", counted(sightings, "sighting"))
            }
        }
    }

    /// The fields of a marker that was assumed.
    pub(super) fn assumed(self) -> Option<AssumedMarkerFields> {
        let Self::Assumed { place: MarkerPlace { position, heading }, seen } = self else {
            return None;
        };
        Some(AssumedMarkerFields { position, heading, seen })
    }
}

impl ConformArguments {
    /// Checks the options about the marker.
    pub(super) fn check_marker(&self) -> Result<(), CliError> {
        let directional = self.marker.is_none_or(|marker| marker == RobotMarker::Directional);
        if !directional && self.driver == Who::Algorithm {
            let marker = self.marker.map_or("", |marker| marker.marker().name());
            let cause = "the algorithms need the directional marker; add --driver anyone";
            return Err(CliError::at(format!("--marker {marker}"), cause));
        }
        if self.assume_marker && self.marker == Some(RobotMarker::None) {
            return Err(CliError::at("--assume-marker", "this needs another marker than none"));
        }
        if self.driver == Who::Anyone {
            let cause = "with --driver anyone the doors are compared with no algorithm";
            if self.algorithm.is_some() {
                return Err(CliError::at("--algorithm", cause));
            }
            if self.max_darts.is_some() {
                return Err(CliError::at("--max-darts", cause));
            }
            if let Some(case) =
                self.require_coverage.iter().find(|case| required_coverage::is_of_algorithm1(case))
            {
                let cause = format!("{cause}, so that {case} is never covered");
                return Err(CliError::at("--require-coverage", cause));
            }
        }
        Ok(())
    }

    /// Where the marker of a log may lie, and whether its mapping file fits the options.
    pub(super) fn marker_start(
        &self,
        opened: &OpenLog,
        evidence: Evidence,
    ) -> Result<MarkerStart, CliError> {
        let place = opened.mapping.assumed_marker();
        let has_fiducial = opened.mapping.carrier(Role::Marker).is_some();
        if evidence != Evidence::Laser {
            let cause = "this is for events that are inferred from laser scans";
            return match (self.assume_marker, place.is_some() || has_fiducial) {
                (true, _) => Err(CliError::at("--assume-marker", cause)),
                (false, true) => Err(CliError::at("[marker] of --mapping", cause)),
                (false, false) => Ok(MarkerStart::Robot),
            };
        }
        if self.assume_marker && has_fiducial {
            let cause = "the log has sightings of a marker: [marker] of --mapping";
            return Err(CliError::at("--assume-marker", cause));
        }
        if !self.assume_marker && place.is_some() {
            let cause = "the log has no marker there; to assume one, add --assume-marker";
            return Err(CliError::at("[marker] at of --mapping", cause));
        }
        Ok(match place {
            None if !has_fiducial => MarkerStart::Robot,
            _ => MarkerStart::Anywhere,
        })
    }

    /// Completes the visits of a laser log with its marker.
    pub(super) fn add_marker(
        &self,
        path: &Path,
        opened: &OpenLog,
        gathered: &mut ExtractedRun,
        marker: &dyn Marker,
    ) -> Result<Option<AddedMarker>, CliError> {
        let ExtractedRun { events, junctions, sightings, .. } = gathered;
        let events = &mut events.events;
        if self.assume_marker {
            let place = opened.mapping.assumed_marker().or_else(|| marker_at_start(junctions));
            // Without a visit there is nothing to judge.
            let Some(place) = place else { return Ok(None) };
            let seen = assume_marker(events, junctions, marker, place)
                .map_err(|error| CliError::at("[marker] at of --mapping", error))?;
            // The direction of an undirected marker does not matter.
            let heading = place.heading.filter(|_| marker.name() == Directional.name());
            let place = MarkerPlace { heading, ..place };
            return Ok(Some(AddedMarker::Assumed { place, seen }));
        }
        if opened.mapping.carrier(Role::Marker).is_none() || gathered.evidence != Evidence::Laser {
            return Ok(None);
        }
        if marker.name() == NoMarker.name() {
            let cause = "the robot has no marker: --marker none";
            return Err(CliError::at("[marker] of --mapping", cause));
        }
        let elsewhere = mark_visits(events, junctions, marker, sightings)
            .map_err(|error| CliError::in_file(path, error))?;
        Ok(Some(AddedMarker::Fiducial { sightings: sightings.len(), elsewhere }))
    }
}
