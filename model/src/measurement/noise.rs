//! A measurement of a hallway, and its uncertainty.

/// What odometry measures of a hallway in one traversal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HallwayMeasurement {
    /// The length of the robot's way from one junction to the next, in metres.
    pub length: f64,
    /// From the direction in which the robot leaves a junction to the direction in which it enters the next one,
    /// in radians counter-clockwise, in (-pi, pi]; `None` if the directions of the doors are not known.
    pub turn: Option<f64>,
}

/// The uncertainty of measurements by odometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasurementNoise {
    /// Standard deviation of the place where the robot stands at a junction, along its way, in metres.
    pub standing: f64,
    /// Standard deviation of a length, in metres after 1 m; it grows with the square root of the way.
    pub wandering: f64,
    /// Standard deviation of a length, as a share of it. An error that is the same in each traversal does not count.
    pub scale: f64,
    /// Standard deviation of the direction of a door, in radians.
    pub door: f64,
    /// Standard deviation of a turn, in radians after 1 m; it grows with the square root of the way.
    pub turning: f64,
    /// Standard deviation of a turn, in radians per metre. It is the same in each traversal: one wheel is larger
    /// than the other.
    pub drift: f64,
}

impl Default for MeasurementNoise {
    /// [`MeasurementNoise::UNKNOWN`].
    fn default() -> Self {
        Self::UNKNOWN
    }
}

impl MeasurementNoise {
    /// For a robot of unknown calibration, whose events may be some way off the junctions: of two lengths of
    /// about 10 m, a difference of 5 m contradicts.
    pub const UNKNOWN: Self =
        Self { standing: 0.4, wandering: 0.1, scale: 0.05, door: 0.2, turning: 0.05, drift: 0.03 };

    /// The noise with these multiples of the deviations of lengths and of turns.
    #[must_use]
    pub fn times(self, length: f64, turn: f64) -> Self {
        Self {
            standing: self.standing * length,
            wandering: self.wandering * length,
            scale: self.scale * length,
            door: self.door * turn,
            turning: self.turning * turn,
            drift: self.drift * turn,
        }
    }

    /// The variance of a measured length, in square metres.
    pub(super) fn length_variance(&self, length: f64) -> f64 {
        let Self { standing, wandering, scale, .. } = self;
        2.0 * standing.powi(2) + wandering.powi(2) * length + (scale * length).powi(2)
    }

    /// The variance of the difference of two turns, in square radians. In opposite directions the drift has
    /// opposite signs.
    pub(super) fn turn_variance(&self, lengths: [f64; 2], same_direction: bool) -> f64 {
        let Self { door, turning, drift, .. } = self;
        let [one, other] = lengths;
        let drifting = if same_direction { one - other } else { one + other };
        4.0 * door.powi(2) + turning.powi(2) * (one + other) + (drift * drifting).powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_uncertainty_grows_with_the_way() {
        let noise = MeasurementNoise::UNKNOWN;
        let variances: Vec<_> =
            (0..50).map(|metres| noise.length_variance(f64::from(metres))).collect();
        assert!(variances.is_sorted_by(|one, other| one < other));
        assert!((variances[0] - 2.0 * 0.16).abs() < 1e-12);
    }

    #[test]
    fn a_drift_that_never_changes_cancels_in_the_same_direction() {
        let noise = MeasurementNoise { door: 0.0, turning: 0.0, ..MeasurementNoise::UNKNOWN };
        assert!(noise.turn_variance([8.0, 8.0], true).abs() < 1e-12);
        let opposite = noise.turn_variance([8.0, 8.0], false);
        assert!((opposite.sqrt() - 16.0 * noise.drift).abs() < 1e-12);
    }
}
