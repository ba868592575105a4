//! Odometry in the SuperScout's own units. Section 2.5.

use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use super::WheelSpeeds;

/// The unit of length, a tenth of an inch, in metres.
const LENGTH: f64 = 0.002_54;
/// The unit of angle, a tenth of a degree, in radians.
const ANGLE: f64 = std::f64::consts::PI / 1800.0;

/// Integrates the turning of the wheels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Odometer {
    sum: Odometry,
}

impl Odometer {
    /// Adds the motion of the wheels over a time in seconds.
    pub fn add(&mut self, wheels: WheelSpeeds, seconds: f64) {
        self.sum = along_arc(&self.sum, wheels, seconds);
    }

    /// The odometry that the robot reports, in whole units of length and angle.
    pub fn reading(&self) -> Odometry {
        let whole = |value: f64, unit: f64| (value / unit).round() * unit;
        Odometry {
            position: self.sum.position.map(|coordinate| whole(coordinate, LENGTH)),
            heading: wrapped(whole(self.sum.heading, ANGLE)),
        }
    }
}

/// The pose after driving for a time in seconds: on an arc, whose chord lies halfway between the headings
/// before and after.
pub fn along_arc(from: &Odometry, wheels: WheelSpeeds, seconds: f64) -> Odometry {
    let half = wheels.turn_rate() * seconds / 2.0;
    let chord = wheels.speed() * seconds * if half == 0.0 { 1.0 } else { half.sin() / half };
    let middle = from.moved(half, chord);
    Odometry { heading: middle.heading + half, ..middle }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    #[test]
    fn a_quarter_of_a_circle_ends_as_far_ahead_as_aside() {
        // A radius of 1 m, at 0.1 m/s: a quarter in 5 pi seconds.
        let wheels = WheelSpeeds::from_motion(0.1, 0.1);
        let steps = 63;
        let mut odometer = Odometer::default();
        for _ in 0..steps {
            odometer.add(wheels, 5.0 * PI / f64::from(steps));
        }
        let Odometry { position: [x, y], heading } = odometer.reading();
        assert!((x - 1.0).abs() < LENGTH && (y - 1.0).abs() < LENGTH, "{x} {y}");
        assert!((heading - FRAC_PI_2).abs() < ANGLE, "{heading}");
    }

    #[test]
    fn a_reading_is_in_tenths_of_an_inch_and_of_a_degree() {
        let mut odometer = Odometer::default();
        odometer.add(WheelSpeeds::from_motion(0.1, 0.0), 1.0);
        // 0.1 m are 39.37 tenths of an inch.
        assert!((odometer.reading().position[0] - 39.0 * 0.00254).abs() < 1e-12);
        odometer.add(WheelSpeeds::from_motion(0.0, 0.1), 1.0);
        // 0.1 radians are 57.3 tenths of a degree.
        assert!((odometer.reading().heading.to_degrees() - 5.7).abs() < 1e-9);
    }
}
