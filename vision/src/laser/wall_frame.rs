//! A frame for the local map that the odometry's own frame has no part in: where the robot was at the first scan,
//! with the axes along the walls. What is seen in cells depends a little on how walls lie in them.

use nalgebra::{Isometry2, Point2, Vector2};
use toposlam_model::driving::odometry::Odometry;

use super::scan::{Reading, Scan};
use crate::geometry::{angle, from_robot, unit};

/// Hits of successive readings that are farther apart are on different surfaces, in metres.
const ONE_WALL: f64 = 1.0;

/// The motion from the frame of odometry to the one whose origin is where the robot was when this scan was taken, and
/// whose axes are along the walls that it shows.
pub(super) fn to_walls(scan: &Scan, odometry: &Odometry) -> Isometry2<f64> {
    let heading = odometry.heading + direction_of_walls(scan);
    from_robot(&Odometry { heading, ..*odometry }).inverse()
}

/// The direction along or across most of the walls in a scan, relative to the robot, in radians from -pi/4 to pi/4:
/// the mean over their lengths. It is 0 if there are none.
fn direction_of_walls(scan: &Scan) -> f64 {
    let hits = scan.readings().map(|(bearing, reading)| match reading {
        Reading::Hit(range) => Some(scan.point(bearing, range)),
        Reading::NoReturn | Reading::Invalid => None,
    });
    let hits: Vec<Option<Point2<f64>>> = hits.collect();
    let mut sum = Vector2::zeros();
    for pair in hits.windows(2) {
        let [Some(one), Some(other)] = *pair else { continue };
        let along = other - one;
        if along.norm() < ONE_WALL {
            // Four times the direction is the same along a wall and across it.
            sum += along.norm() * unit(4.0 * angle(along));
        }
    }
    angle(sum) / 4.0
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    use toposlam_model::driving::scene::wrapped;

    use super::*;
    use crate::{geometry::moved, laser::scan::ScanGeometry};

    /// A scan from the middle of a corridor, 2 m wide, by a robot that is turned to its left.
    fn in_corridor(turned: f64) -> Scan {
        let angle_increment = PI / 180.0;
        let geometry =
            ScanGeometry { angle_min: -PI, angle_increment, range_min: 0.1, range_max: 30.0 };
        let range = |index: u32| {
            let bearing = -PI + f64::from(index) * angle_increment + turned;
            (1.0 / bearing.sin().abs()).min(1e6) as f32
        };
        Scan::new(geometry, (0..360).map(range).collect(), Isometry2::identity()).unwrap()
    }

    #[test]
    fn the_walls_of_a_corridor_are_along_an_axis_whatever_the_robots_heading() {
        for degrees in [-80.0, -30.0, 0.0, 10.0, 44.0, 135.0_f64] {
            let turned = degrees.to_radians();
            let odometry = Odometry { position: [3.0, -2.0], heading: 1.0 + turned };
            let motion = to_walls(&in_corridor(turned), &odometry);
            let walls = wrapped(1.0 + motion.rotation.angle());
            let off = (walls + FRAC_PI_4).rem_euclid(FRAC_PI_2) - FRAC_PI_4;
            assert!(off.abs() < 1e-3, "{degrees}: {walls}");
            assert!(moved(&motion, &odometry).distance(&Odometry::default()) < 1e-9);
        }
    }
}
