//! A hallway that is measured by odometry while the robot drives through it: its length, and its turn.

use std::f64::consts::{FRAC_PI_2, PI};

use toposlam_model::{
    driving::{
        odometry::{Odometry, WayLength},
        scene::wrapped,
        visit::JunctionShape,
    },
    measurement::{HallwayMeasurement, MeasurementNoise},
    percept::Door,
};

use crate::superscout::MEASUREMENT_NOISE;

/// The uncertainty of the hallways in a log of this project. It does not record the calibration of its base, which
/// may be several times worse than that of a SuperScout on tiles.
pub fn log_noise() -> MeasurementNoise {
    MEASUREMENT_NOISE.times(3.0, 5.0)
}

/// A hallway since the robot arrived at a junction.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeasuredHallway {
    way: WayLength,
    /// The direction in which the robot left, if it is known.
    exit: Option<f64>,
    /// Whether there was odometry since the arrival.
    moved: bool,
}

impl MeasuredHallway {
    /// The robot stands at a junction, perhaps at this odometry.
    pub fn from(odometry: Option<Odometry>) -> Self {
        let mut hallway = Self::default();
        if let Some(odometry) = odometry {
            hallway.way.add(odometry);
        }
        hallway
    }

    pub fn leave(&mut self, direction: Option<f64>) {
        self.exit = direction;
    }

    pub fn add(&mut self, odometry: Odometry) {
        self.way.add(odometry);
        self.moved = true;
    }

    /// The measurement up to an arrival with this direction of the entry door.
    pub fn measured(self, entry: Option<f64>) -> Option<HallwayMeasurement> {
        let length = self.way.length().filter(|_| self.moved)?;
        // From the direction of the door by which it left to that in which it comes in.
        let turn = self.exit.zip(entry).map(|(exit, entry)| wrapped(entry + PI - exit));
        Some(HallwayMeasurement { length, turn })
    }
}

/// The direction of a door of a junction, in the frame of odometry.
pub fn direction(shape: JunctionShape, entry: f64, door: Door) -> Option<f64> {
    let mut doors = (0..4).filter(|&quarter| shape.0[quarter]);
    let quarter = doors.nth(door.0 as usize)?;
    Some(wrapped(entry - quarter as f64 * FRAC_PI_2))
}
