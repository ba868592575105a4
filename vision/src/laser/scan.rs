//! One sweep of a laser scanner: ranges at equal steps of the angle, as `sensor_msgs/LaserScan` and CARMEN
//! record them.

use std::f64::consts::{PI, TAU};

use nalgebra::{Isometry2, Point2, Vector2};
use thiserror::Error;
use toposlam_model::driving::scene::wrapped;

use crate::{
    geometry::{angle, distance, unit},
    place::ViewSector,
};

/// The angles and the limits of a scan, as they are recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanGeometry {
    /// Of the first reading, in radians counter-clockwise from the scanner's x axis.
    pub angle_min: f64,
    /// In radians; negative if the scanner turns clockwise.
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
    Invalid,
}

/// Why numbers are not a scan.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ScanError {
    #[error("the scan has no readings")]
    NoReadings,
    #[error("the angle increment of the scan is {0}")]
    Increment(f64),
    #[error("the first angle of the scan, or the pose of its scanner, is not a number")]
    NotFinite,
    /// No range lies between the limits.
    #[error("the ranges of the scan go from {min} m to {max} m")]
    Limits { min: f64, max: f64 },
}

/// Hits of successive readings that are farther apart are on different surfaces, in metres.
const ONE_WALL: f64 = 1.0;

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

    pub fn geometry(&self) -> ScanGeometry {
        self.geometry
    }

    /// The angle between the first and the last reading, in radians.
    pub fn field_of_view(&self) -> f64 {
        self.ranges.len().saturating_sub(1) as f64 * self.geometry.angle_increment
    }

    pub(super) fn sector(&self) -> ViewSector {
        let first = self.heading() + self.geometry.angle_min;
        ViewSector { first, angle: self.field_of_view() }
    }

    pub fn ranges(&self) -> &[f32] {
        &self.ranges
    }

    /// The pose of the scanner on the robot, whose x axis points ahead.
    pub fn robot_from_scanner(&self) -> Isometry2<f64> {
        self.robot_from_scanner
    }

    /// Where the scanner is, in metres in the robot's frame.
    pub fn scanner(&self) -> Point2<f64> {
        self.robot_from_scanner.translation.vector.into()
    }

    /// The direction of the scanner's x axis, in radians counter-clockwise from the robot's heading.
    pub fn heading(&self) -> f64 {
        self.robot_from_scanner.rotation.angle()
    }

    /// The readings in counter-clockwise order, each with its bearing: the direction in which it was taken
    /// from the scanner, in radians counter-clockwise from the robot's heading, above -pi and up to pi.
    pub fn readings(&self) -> impl ExactSizeIterator<Item = (f64, Reading)> + '_ {
        let first = self.heading() + self.geometry.angle_min;
        self.ranges.iter().enumerate().map(move |(index, &range)| {
            let bearing = wrapped(first + index as f64 * self.geometry.angle_increment);
            (bearing, self.reading(range.into()))
        })
    }

    /// The same with the range of each hit, in metres. A reading without a return shows nothing: glass and black
    /// surfaces give none.
    pub(super) fn ranges_hit(&self) -> impl Iterator<Item = (f64, Option<f64>)> + '_ {
        self.readings().map(|(bearing, reading)| match reading {
            Reading::Hit(range) => (bearing, Some(range)),
            Reading::NoReturn | Reading::Invalid => (bearing, None),
        })
    }

    /// The points that were hit, in metres in the robot's frame, in counter-clockwise order.
    pub fn hits(&self) -> impl Iterator<Item = Point2<f64>> + '_ {
        self.ranges_hit().filter_map(|(bearing, range)| Some(self.point(bearing, range?)))
    }

    /// The point at a bearing and a range from the scanner, in metres in the robot's frame.
    pub fn point(&self, bearing: f64, range: f64) -> Point2<f64> {
        self.scanner() + range * unit(bearing)
    }

    /// The gaps between neighbouring hits that are at least this far apart, in metres, with readings between them, of which none
    /// is a hit: the two hits of each, in metres in the robot's frame, in counter-clockwise order.
    pub fn silent_gaps(&self, least: f64) -> Vec<[Point2<f64>; 2]> {
        let increment = self.geometry.angle_increment;
        let hits: Vec<(f64, Point2<f64>)> = self
            .ranges_hit()
            .filter_map(|(bearing, range)| Some((bearing, self.point(bearing, range?))))
            .collect();
        let is_all_round = self.field_of_view() + 1.5 * increment > TAU;
        // From the last one to the first, too, if the scanner looks there.
        let after = hits.iter().skip(1).chain(hits.first().filter(|_| is_all_round));
        let gaps = hits.iter().zip(after).filter_map(|(&(bearing, one), &(next, other))| {
            let angle = (next - bearing).rem_euclid(TAU);
            let is_gap = (1.5 * increment..PI).contains(&angle) && distance(one, other) >= least;
            is_gap.then_some([one, other])
        });
        gaps.collect()
    }

    /// The direction along or across most of the walls, relative to the robot, in radians from -pi/4 to pi/4: the mean over
    /// their lengths. It is 0 if there are none.
    pub(super) fn direction_of_walls(&self) -> f64 {
        let point = |(bearing, range): (f64, Option<f64>)| Some(self.point(bearing, range?));
        let hits: Vec<Option<Point2<f64>>> = self.ranges_hit().map(point).collect();
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
impl Scan {
    /// A scan with a reading each degree, from this one on; a function returns the range at a bearing.
    pub(super) fn each_degree(first: i32, count: u16, range: impl Fn(f64) -> f64) -> Self {
        let angle_min = f64::from(first).to_radians();
        let angle_increment = 1_f64.to_radians();
        let geometry = ScanGeometry { angle_min, angle_increment, range_min: 0.1, range_max: 30.0 };
        let range = |index| range(angle_min + f64::from(index) * angle_increment) as f32;
        Self::new(geometry, (0..count).map(range).collect(), Isometry2::identity()).unwrap()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    use super::*;

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
    fn a_gap_lies_between_two_hits_without_one_between_them() {
        // A wall 2 m ahead, black between 10 and 20 degrees to the left, and a dropout 30 degrees to the right.
        let silent = [10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, -30];
        let range = |bearing: f64| {
            let is_silent = silent.contains(&(bearing.to_degrees().round() as i32));
            if is_silent { 0.0 } else { 2.0 / bearing.cos() }
        };
        let left = |degrees: f64| Point2::new(2.0, 2.0 * degrees.to_radians().tan());
        let ahead = Scan::each_degree(-60, 121, range);
        let gaps = ahead.silent_gaps(0.2);
        let [[right, other]] = gaps[..] else { panic!("{gaps:?}") };
        assert!(distance(right, left(9.0)) < 1e-6 && distance(other, left(21.0)) < 1e-6);
        assert!(ahead.silent_gaps(0.5).is_empty(), "it is 0.45 m wide");
        assert_eq!(ahead.silent_gaps(0.05).len(), 2, "the dropout");
        // A scanner that looks all round sees what is behind it between its last reading and its first one.
        let behind = |bearing: f64| if bearing.cos() > -0.9 { 1.0 } else { f64::INFINITY };
        assert_eq!(Scan::each_degree(-180, 360, behind).silent_gaps(0.5).len(), 1);
        assert!(Scan::each_degree(-150, 300, behind).silent_gaps(0.5).is_empty());
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
    fn the_walls_of_a_corridor_are_along_an_axis_whatever_the_robots_heading() {
        for degrees in [-80.0, -30.0, 0.0, 10.0, 44.0, 135.0_f64] {
            let turned = degrees.to_radians();
            let corridor = |bearing: f64| (1.0 / (bearing + turned).sin().abs()).min(1e6);
            let walls = turned + Scan::each_degree(-180, 360, corridor).direction_of_walls();
            let off = (walls + FRAC_PI_4).rem_euclid(FRAC_PI_2) - FRAC_PI_4;
            assert!(off.abs() < 1e-3, "{degrees}: {walls}");
        }
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
        let (nan, inf) = (f64::NAN, f64::INFINITY);
        for ([angle_min, angle_increment, range_min, range_max], message) in [
            ([0.0, 0.0, 0.1, 50.0], "the angle increment of the scan is 0"),
            ([0.0, nan, 0.1, 50.0], "the angle increment of the scan is NaN"),
            ([0.0, inf, 0.1, 50.0], "the angle increment of the scan is inf"),
            ([nan, 1.0, 0.1, 50.0], "the first angle of the scan, or "),
            ([0.0, 1.0, 0.1, 0.1], "the ranges of the scan go from 0.1 m to 0.1 m"),
            ([0.0, 1.0, 0.1, 0.05], "the ranges of the scan go from 0.1 m to 0.05 m"),
            ([0.0, 1.0, -2.0, -1.0], "the ranges of the scan go from -2 m to -1 m"),
            ([0.0, 1.0, nan, 50.0], "the ranges of the scan go from NaN m"),
            ([0.0, 1.0, 0.1, nan], "the ranges of the scan go from 0.1 m to NaN m"),
        ] {
            let geometry = ScanGeometry { angle_min, angle_increment, range_min, range_max };
            let error = scan(geometry, &[1.0]).unwrap_err().to_string();
            assert!(error.starts_with(message), "{error}");
        }
        let empty = scan(HALF_CIRCLE, &[]).unwrap_err().to_string();
        assert_eq!(empty, "the scan has no readings");
        let nowhere = Isometry2::translation(0.0, f64::NAN);
        assert_eq!(Scan::new(HALF_CIRCLE, vec![1.0], nowhere), Err(ScanError::NotFinite));
    }
}
