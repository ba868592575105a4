//! Geometry of the plane: distances, directions, and rigid motions from one frame to another.

use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

/// The distance of two points.
#[must_use]
pub fn distance([x, y]: [f64; 2], [u, v]: [f64; 2]) -> f64 {
    (x - u).hypot(y - v)
}

/// The direction from one point to another, in radians counter-clockwise from the x axis.
#[must_use]
pub fn direction([x, y]: [f64; 2], [u, v]: [f64; 2]) -> f64 {
    (v - y).atan2(u - x)
}

/// The scalar product of two vectors.
pub(super) fn dot([x, y]: [f64; 2], [u, v]: [f64; 2]) -> f64 {
    x * u + y * v
}

/// A turn about the origin, and a shift after it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Counter-clockwise, in radians.
    pub turn: f64,
    /// In metres.
    pub shift: [f64; 2],
}

impl Motion {
    /// From the frame of a robot to the one in which its pose is given.
    #[must_use]
    pub fn from_robot(pose: &Odometry) -> Self {
        Self { turn: pose.heading, shift: pose.position }
    }

    /// The motion after which a robot at the first pose is at the second.
    #[must_use]
    pub fn between(from: &Odometry, to: &Odometry) -> Self {
        Self::from_robot(to).after(&Self::from_robot(from).inverse())
    }

    /// The motion back.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let back = Self { turn: -self.turn, shift: [0.0; 2] };
        Self { shift: back.point(self.shift).map(|axis| -axis), ..back }
    }

    /// The motion that does another one first.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        Self { turn: wrapped(self.turn + first.turn), shift: self.point(first.shift) }
    }

    /// Where a point goes, in metres.
    #[must_use]
    pub fn point(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sine, cosine) = self.turn.sin_cos();
        let [east, north] = self.shift;
        [east + x * cosine - y * sine, north + x * sine + y * cosine]
    }

    /// Where a robot goes.
    #[must_use]
    pub fn pose(&self, pose: &Odometry) -> Odometry {
        Odometry { position: self.point(pose.position), heading: wrapped(self.turn + pose.heading) }
    }
}

/// The greatest whole number that is not above this one. `f64::floor` calls a function on older processors.
pub(super) fn floor(number: f64) -> i64 {
    let towards_zero = number as i64;
    towards_zero.saturating_sub(i64::from(number < towards_zero as f64))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    fn near(one: &Odometry, other: &Odometry) {
        assert!(one.distance(other) < 1e-12, "{one:?} and {other:?}");
        assert!(wrapped(one.heading - other.heading).abs() < 1e-12, "{one:?} and {other:?}");
    }

    #[test]
    fn a_motion_between_poses_moves_one_to_the_other_and_its_inverse_moves_it_back() {
        let from = Odometry { position: [1.0, -2.0], heading: 2.5 };
        let to = Odometry { position: [-3.0, 0.5], heading: -2.0 };
        let motion = Motion::between(&from, &to);
        near(&motion.pose(&from), &to);
        near(&motion.inverse().pose(&to), &from);
    }

    #[test]
    fn what_is_ahead_of_a_robot_that_looks_north_is_north_of_it() {
        let pose = Odometry { position: [1.0, 2.0], heading: FRAC_PI_2 };
        let [x, y] = Motion::from_robot(&pose).point([3.0, 0.0]);
        assert!((x - 1.0).abs() < 1e-12 && (y - 5.0).abs() < 1e-12, "{x} {y}");
    }
}
