//! One sweep of a laser scanner: ranges at equal steps of the angle, as `sensor_msgs/LaserScan` and CARMEN
//! record them.

use std::f64::consts::TAU;

use nalgebra::{Isometry2, Point2};
use thiserror::Error;
use toposlam_model::driving::scene::wrapped;

use crate::geometry::unit;

/// The angles and the limits of a scan, as they are recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanGeometry {
    /// The angle of the first reading, in radians counter-clockwise from the scanner's x axis.
    pub angle_min: f64,
    /// The angle from one reading to the next, in radians; negative if the scanner turns clockwise.
    pub angle_increment: f64,
    /// Shorter readings are invalid, in metres.
    pub range_min: f64,
    /// At this range and beyond there is no return, in metres; may be infinite.
    pub range_max: f64,
}

/// A scan. Its readings are in counter-clockwise order.
#[derive(Clone, Debug, PartialEq)]
pub struct Scan {
    geometry: ScanGeometry,
    ranges: Vec<f32>,
    robot_from_scanner: Isometry2<f64>,
}

/// What the scanner measured in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reading {
    /// A surface at this range, in metres.
    Hit(f64),
    /// No surface up to the scanner's range.
    NoReturn,
    /// No measurement.
    Invalid,
}

/// Why numbers are not a scan.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ScanError {
    /// It has no readings.
    #[error("the scan has no readings")]
    NoReadings,
    /// The angle from one reading to the next is 0 or not finite.
    #[error("the angle increment of the scan is {0}")]
    Increment(f64),
    /// The angle of the first reading, or the pose of the scanner, is not finite.
    #[error("the first angle of the scan, or the pose of its scanner, is not a number")]
    NotFinite,
    /// No range lies between the limits.
    #[error("the ranges of the scan go from {min} m to {max} m")]
    Limits {
        /// The shortest range.
        min: f64,
        /// The longest range.
        max: f64,
    },
}

impl Scan {
    /// A scan. Readings in clockwise order are reversed.
    ///
    /// # Errors
    /// Returns an error if there are no readings, or if a number of the geometry or of the scanner's pose is
    /// impossible. Any range is accepted: see [`Reading`].
    pub fn new(
        mut geometry: ScanGeometry,
        mut ranges: Vec<f32>,
        robot_from_scanner: Isometry2<f64>,
    ) -> Result<Self, ScanError> {
        let ScanGeometry { angle_min, angle_increment, range_min, range_max } = geometry;
        let last = ranges.len().checked_sub(1).ok_or(ScanError::NoReadings)?;
        if angle_increment == 0.0 || !angle_increment.is_finite() {
            return Err(ScanError::Increment(angle_increment));
        }
        let angle_max = angle_min + last as f64 * angle_increment;
        let [x, y] = robot_from_scanner.translation.vector.into();
        let heading = robot_from_scanner.rotation.angle();
        if ![angle_max, x, y, heading].iter().all(|number| number.is_finite()) {
            return Err(ScanError::NotFinite);
        }
        // Not a number is not in order either.
        if !(range_min < range_max && range_max > 0.0) {
            return Err(ScanError::Limits { min: range_min, max: range_max });
        }
        if angle_increment < 0.0 {
            ranges.reverse();
            geometry.angle_min = angle_max;
            geometry.angle_increment = -angle_increment;
        }
        Ok(Self { geometry, ranges, robot_from_scanner })
    }

    /// The angles and the limits; the increment is positive.
    #[must_use]
    pub fn geometry(&self) -> ScanGeometry {
        self.geometry
    }

    /// The angle between the first and the last reading, in radians.
    #[must_use]
    pub fn field_of_view(&self) -> f64 {
        self.ranges.len().saturating_sub(1) as f64 * self.geometry.angle_increment
    }

    /// The angle between a direction and the nearest one in which the scanner looks, in radians; 0 if it looks there.
    /// Directions are counter-clockwise from the robot's heading.
    #[must_use]
    pub fn angle_off(&self, bearing: f64) -> f64 {
        let from_first = (bearing - self.heading() - self.geometry.angle_min).rem_euclid(TAU);
        (from_first - self.field_of_view()).max(0.0).min(TAU - from_first)
    }

    /// The ranges as they are recorded, in counter-clockwise order, in metres.
    #[must_use]
    pub fn ranges(&self) -> &[f32] {
        &self.ranges
    }

    /// The pose of the scanner on the robot, whose x axis points ahead.
    #[must_use]
    pub fn robot_from_scanner(&self) -> Isometry2<f64> {
        self.robot_from_scanner
    }

    /// Where the scanner is, in metres in the robot's frame.
    #[must_use]
    pub fn scanner(&self) -> Point2<f64> {
        self.robot_from_scanner.translation.vector.into()
    }

    /// The direction of the scanner's x axis, in radians counter-clockwise from the robot's heading.
    #[must_use]
    pub fn heading(&self) -> f64 {
        self.robot_from_scanner.rotation.angle()
    }

    /// The readings in counter-clockwise order, each with its bearing: the direction in which it was taken
    /// from the scanner, in radians counter-clockwise from the robot's heading, above -pi and up to pi.
    #[must_use]
    pub fn readings(&self) -> impl ExactSizeIterator<Item = (f64, Reading)> + '_ {
        let first = self.heading() + self.geometry.angle_min;
        self.ranges.iter().enumerate().map(move |(index, &range)| {
            let bearing = wrapped(first + index as f64 * self.geometry.angle_increment);
            (bearing, self.reading(range.into()))
        })
    }

    /// The points that were hit, in metres in the robot's frame, in counter-clockwise order.
    pub fn hits(&self) -> impl Iterator<Item = Point2<f64>> + '_ {
        self.readings().filter_map(|(bearing, reading)| match reading {
            Reading::Hit(range) => Some(self.point(bearing, range)),
            Reading::NoReturn | Reading::Invalid => None,
        })
    }

    /// The point at a bearing and a range from the scanner, in metres in the robot's frame.
    #[must_use]
    pub fn point(&self, bearing: f64, range: f64) -> Point2<f64> {
        self.scanner() + range * unit(bearing)
    }

    fn reading(&self, range: f64) -> Reading {
        if range.is_nan() || range <= 0.0 || range < self.geometry.range_min {
            Reading::Invalid
        } else if range.is_infinite() || range >= self.geometry.range_max {
            Reading::NoReturn
        } else {
            Reading::Hit(range)
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use nalgebra::Vector2;

    use super::*;
    use crate::geometry::distance;

    const HALF_CIRCLE: ScanGeometry = ScanGeometry {
        angle_min: -FRAC_PI_2,
        angle_increment: FRAC_PI_2,
        range_min: 0.1,
        range_max: 50.0,
    };

    fn scan(geometry: ScanGeometry, ranges: &[f32]) -> Result<Scan, ScanError> {
        Scan::new(geometry, ranges.to_vec(), Isometry2::identity())
    }

    #[test]
    fn a_reading_is_a_hit_between_the_limits() {
        use Reading::{Hit, Invalid, NoReturn};
        for (range, reading) in [
            (f32::NAN, Invalid),
            (f32::NEG_INFINITY, Invalid),
            (-1.0, Invalid),
            (0.0, Invalid),
            (0.0625, Invalid),
            (0.125, Hit(0.125)),
            (49.5, Hit(49.5)),
            (50.0, NoReturn),
            (81.9, NoReturn),
            (f32::INFINITY, NoReturn),
        ] {
            let scan = scan(HALF_CIRCLE, &[range]).unwrap();
            assert_eq!(scan.readings().collect::<Vec<_>>(), [(-FRAC_PI_2, reading)], "{range}");
        }
    }

    #[test]
    fn a_scan_clockwise_is_the_same_scan_reversed() {
        let counter = scan(HALF_CIRCLE, &[1.0, 2.0, 3.0]).unwrap();
        let clockwise =
            ScanGeometry { angle_min: FRAC_PI_2, angle_increment: -FRAC_PI_2, ..HALF_CIRCLE };
        assert_eq!(scan(clockwise, &[3.0, 2.0, 1.0]).unwrap(), counter);
    }

    #[test]
    fn bearings_and_points_are_those_of_the_robot() {
        // A scanner 0.2 m behind the centre that looks back.
        let behind = Isometry2::new(Vector2::new(-0.2, 0.0), PI);
        let scan = Scan::new(HALF_CIRCLE, vec![1.0, 2.0, f32::INFINITY], behind).unwrap();
        let bearings: Vec<_> = scan.readings().map(|(bearing, _)| bearing).collect();
        for (bearing, expected) in bearings.iter().zip([FRAC_PI_2, PI, -FRAC_PI_2]) {
            assert!((bearing - expected).abs() < 1e-12, "{bearings:?}");
        }
        let hits: Vec<_> = scan.hits().collect();
        for (hit, expected) in hits.iter().zip([[-0.2, 1.0], [-2.2, 0.0]]) {
            assert!(distance(*hit, expected) < 1e-12, "{hits:?}");
        }
        assert_eq!(hits.len(), 2);
    }

    #[test]
    fn impossible_numbers_are_errors() {
        assert_eq!(scan(HALF_CIRCLE, &[]), Err(ScanError::NoReadings));
        for increment in [0.0, f64::NAN, f64::INFINITY] {
            let geometry = ScanGeometry { angle_increment: increment, ..HALF_CIRCLE };
            assert!(matches!(scan(geometry, &[1.0]), Err(ScanError::Increment(_))), "{increment}");
        }
        let geometry = ScanGeometry { angle_min: f64::NAN, ..HALF_CIRCLE };
        assert_eq!(scan(geometry, &[1.0]), Err(ScanError::NotFinite));
        for (min, max) in [(2.0, 1.0), (1.0, 1.0), (-2.0, -1.0), (f64::NAN, 1.0), (0.0, f64::NAN)] {
            let geometry = ScanGeometry { range_min: min, range_max: max, ..HALF_CIRCLE };
            assert!(matches!(scan(geometry, &[1.0]), Err(ScanError::Limits { .. })), "{min} {max}");
        }
        let nowhere = Isometry2::translation(0.0, f64::NAN);
        assert_eq!(Scan::new(HALF_CIRCLE, vec![1.0], nowhere), Err(ScanError::NotFinite));
    }
}
