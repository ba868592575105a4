//! Geometry of the plane, besides what nalgebra has: directions as angles, and a robot's pose as a motion.
//!
//! Points, vectors and rigid motions are nalgebra's. A motion is named after its frames: `map_from_robot` takes a point
//! of the robot's frame to the map's. Directions are radians counter-clockwise from the x axis of their frame. The types
//! of the model, which does without nalgebra, are converted where they enter and leave.

use std::f64::consts::TAU;

use nalgebra::{Isometry2, Point2, Vector2};
use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

#[inline]
pub fn unit(direction: f64) -> Vector2<f64> {
    let (sine, cosine) = direction.sin_cos();
    Vector2::new(cosine, sine)
}

/// The direction of a vector, from -pi to pi.
#[inline]
pub fn angle(vector: Vector2<f64>) -> f64 {
    vector.y.atan2(vector.x)
}

/// The direction from one point to another, from -pi to pi.
pub fn direction(from: impl Into<Point2<f64>>, to: impl Into<Point2<f64>>) -> f64 {
    angle(to.into() - from.into())
}

pub fn distance(one: impl Into<Point2<f64>>, other: impl Into<Point2<f64>>) -> f64 {
    (other.into() - one.into()).norm()
}

/// The clockwise angle from one direction to another, in radians, from 0 to a full turn.
pub fn clockwise(from: f64, to: f64) -> f64 {
    (from - to).rem_euclid(TAU)
}

/// The item with the least distance; the first one of several.
pub fn nearest<T>(items: impl IntoIterator<Item = T>, off: impl Fn(&T) -> f64) -> Option<T> {
    items.into_iter().min_by(|one, other| off(one).total_cmp(&off(other)))
}

/// A length in whole steps of 2^-10 m: sums of such lengths are exact, so the length between two places of a way does not
/// depend on where the way begins.
pub fn in_steps(length: f64) -> f64 {
    (length * 1024.0).round() / 1024.0
}

/// The motion from the robot's frame to the one in which its pose is given.
pub fn from_robot(pose: &Odometry) -> Isometry2<f64> {
    Isometry2::new(Vector2::from(pose.position), pose.heading)
}

/// The motion after which a robot at the first pose is at the second.
pub fn motion_between(from: &Odometry, to: &Odometry) -> Isometry2<f64> {
    from_robot(to) * from_robot(from).inverse()
}

pub fn moved(motion: &Isometry2<f64>, pose: &Odometry) -> Odometry {
    Odometry {
        position: (motion * Point2::from(pose.position)).into(),
        heading: wrapped(motion.rotation.angle() + pose.heading),
    }
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
        let motion = motion_between(&from, &to);
        near(&moved(&motion, &from), &to);
        near(&moved(&motion.inverse(), &to), &from);
    }

    #[test]
    fn what_is_ahead_of_a_robot_that_looks_north_is_north_of_it() {
        let pose = Odometry { position: [1.0, 2.0], heading: FRAC_PI_2 };
        let ahead = from_robot(&pose) * Point2::new(3.0, 0.0);
        assert!(distance(ahead, [1.0, 5.0]) < 1e-12, "{ahead}");
    }

    #[test]
    fn the_length_of_a_way_in_steps_does_not_depend_on_where_it_begins() {
        let steps: Vec<f64> =
            (0..1000).map(|step| in_steps(f64::from(step % 13) * 0.137)).collect();
        let from = |begin: usize, end: usize| steps[begin..end].iter().sum::<f64>();
        for begin in [0, 1, 17, 400] {
            let length = from(begin, 900) - from(begin, 500);
            assert_eq!(length.to_bits(), from(500, 900).to_bits());
        }
    }
}
