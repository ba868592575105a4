//! Differential drive: the speed of each wheel. Section 2.5.

use super::{SPEED, TURN_RATE, WHEEL_BASE};

/// The speed of the ground under each wheel, in metres a second.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WheelSpeeds {
    pub left: f64,
    pub right: f64,
}

impl WheelSpeeds {
    /// The robot stands.
    pub const STOP: Self = Self { left: 0.0, right: 0.0 };

    /// The wheel speeds for a speed ahead, in metres a second, and a turn rate counter-clockwise, in
    /// radians a second, within the robot's limits.
    pub fn from_motion(speed: f64, turn_rate: f64) -> Self {
        let speed = speed.clamp(-SPEED, SPEED);
        let half = turn_rate.clamp(-TURN_RATE, TURN_RATE) * WHEEL_BASE / 2.0;
        Self { left: speed - half, right: speed + half }
    }

    /// The robot's speed ahead, in metres a second.
    pub fn speed(self) -> f64 {
        f64::midpoint(self.left, self.right)
    }

    /// Its turn rate counter-clockwise, in radians a second.
    pub fn turn_rate(self) -> f64 {
        (self.right - self.left) / WHEEL_BASE
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    // paper: hardware.drive
    #[test]
    fn turning_on_the_spot_the_wheels_run_against_each_other() {
        let wheels = WheelSpeeds::from_motion(0.0, 0.2);
        assert!((wheels.left + 0.2 * 0.1726).abs() < 1e-12);
        assert!((wheels.right - 0.2 * 0.1726).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn no_command_is_beyond_the_limits(speed in -9.0..9.0, turn_rate in -9.0..9.0) {
            let wheels = WheelSpeeds::from_motion(speed, turn_rate);
            prop_assert!(wheels.speed().abs() <= SPEED + 1e-12);
            prop_assert!(wheels.turn_rate().abs() <= TURN_RATE + 1e-12);
        }

        #[test]
        fn what_is_within_them_is_done(speed in -0.2..0.2, turn_rate in -0.3..0.3) {
            let wheels = WheelSpeeds::from_motion(speed, turn_rate);
            prop_assert!((wheels.speed() - speed).abs() < 1e-12);
            prop_assert!((wheels.turn_rate() - turn_rate).abs() < 1e-12);
        }
    }
}
