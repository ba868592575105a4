//! Odometry: the pose estimated from the wheels. Sections 2.5 and 4.

use super::scene::wrapped;

/// Where the robot is and where it looks, in a frame of its own that drifts; no map is made of it, and
/// only short stretches of it are ever compared.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Odometry {
    /// In metres, x ahead and y to the left of where it began.
    pub position: [f64; 2],
    /// Radians counter-clockwise from where it looked at first.
    pub heading: f64,
}

impl Odometry {
    pub fn distance(&self, other: &Self) -> f64 {
        let [x, y] = [0, 1].map(|axis| self.position[axis] - other.position[axis]);
        x.hypot(y)
    }

    /// The direction of this frame that the robot sees in a direction relative to its heading.
    pub fn whither(&self, seen: f64) -> f64 {
        wrapped(self.heading + seen)
    }

    /// Where the robot sees a direction of this frame, relative to its heading.
    pub fn seen(&self, direction: f64) -> f64 {
        wrapped(direction - self.heading)
    }

    /// Where it is after a turn and a stretch straight ahead.
    #[must_use]
    pub fn moved(&self, turn: f64, forward: f64) -> Self {
        let heading = wrapped(self.heading + turn);
        let (sine, cosine) = heading.sin_cos();
        let [x, y] = self.position;
        Self { position: [x + forward * cosine, y + forward * sine], heading }
    }
}

/// The length of a way by odometry, in steps of at least half a metre: shorter ones are manoeuvres, or errors of
/// single readings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WayLength {
    /// Of the whole steps, in metres.
    steps: f64,
    /// Where the last step ended, and the last reading.
    ends: Option<[Odometry; 2]>,
}

/// The least length of a step, in metres.
const STEP: f64 = 0.5;

impl WayLength {
    pub fn add(&mut self, reading: Odometry) {
        let [from, _] = self.ends.unwrap_or([reading; 2]);
        let step = reading.distance(&from);
        if step >= STEP {
            self.steps += step;
            self.ends = Some([reading; 2]);
        } else {
            self.ends = Some([from, reading]);
        }
    }

    /// The length up to the last reading, in metres; `None` without a reading, or if one is not a number.
    pub fn length(&self) -> Option<f64> {
        let [from, last] = self.ends?;
        Some(self.steps + last.distance(&from)).filter(|length| length.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    #[test]
    fn four_sides_of_a_square_end_where_they_began() {
        let begun = Odometry { position: [1.0, 2.0], heading: 3.0 };
        let end = (0..4).fold(begun, |at, _| at.moved(FRAC_PI_2, 0.5));
        assert!(end.distance(&begun) < 1e-12 && (end.heading - 3.0).abs() < 1e-12, "{end:?}");
    }

    #[test]
    fn what_is_seen_behind_stays_where_it_is_while_the_robot_turns() {
        let before = Odometry { position: [0.0; 2], heading: 2.0 };
        let entry = before.whither(PI);
        let after = before.moved(-FRAC_PI_2, 0.0);
        assert!((after.seen(entry) + FRAC_PI_2).abs() < 1e-12);
    }

    #[test]
    fn a_way_is_as_long_as_its_steps() {
        let at = |x: f64, y: f64| Odometry { position: [x, y], heading: 0.0 };
        let length = |readings: &[Odometry]| {
            let mut way = WayLength::default();
            for &reading in readings {
                way.add(reading);
            }
            way.length()
        };
        assert_eq!(length(&[]), None);
        assert_eq!(length(&[at(3.0, 4.0)]), Some(0.0));
        assert_eq!(length(&[at(0.0, 0.0), at(3.0, 0.0), at(3.0, 4.0), at(3.0, 4.25)]), Some(7.25));
        // To and fro by less than a step.
        let idle = [0.0, 0.25, 0.0, 0.25, 0.0, 0.25].map(|x| at(x, 0.0));
        assert_eq!(length(&idle), Some(0.25));
        assert_eq!(length(&[at(0.0, 0.0), at(f64::NAN, 0.0)]), None);
    }
}
