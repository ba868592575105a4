//! Odometry: where the robot says that it is, by its wheels alone. Sections 2.5 and 4.

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
    /// How far it is from another place, in metres.
    #[must_use]
    pub fn distance(&self, other: &Self) -> f64 {
        let [x, y] = [0, 1].map(|axis| self.position[axis] - other.position[axis]);
        x.hypot(y)
    }

    /// The direction of this frame that the robot sees in a direction relative to its heading.
    #[must_use]
    pub fn whither(&self, seen: f64) -> f64 {
        wrapped(self.heading + seen)
    }

    /// Where the robot sees a direction of this frame, relative to its heading.
    #[must_use]
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
}
