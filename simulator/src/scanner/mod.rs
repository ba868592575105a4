//! A simulated laser scanner: rays that are cast on the walls of a plan. A [`CorridorPlan`] is floor plan with
//! corridors at any angle; its walls, and what makes scans harder to read, are in `scanned_building`.

mod corridors;
mod data_sheets;
mod params;
mod polygon;
mod scanned_building;

use std::f64::consts::TAU;

use nalgebra::{Isometry2, Point2};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use toposlam_model::driving::{pose::Pose, scene::wrapped};
use toposlam_vision::{
    geometry::{angle, unit},
    laser::scan::{Scan, ScanError, ScanGeometry},
};

use crate::render::{StreamPurpose, stream};

pub use corridors::{Corridor, CorridorPlan, Lobby};
pub use data_sheets::{NamedScanner, SCANNERS};
pub use params::{ScannerParams, ShortRangeError};
pub use polygon::{ConvexPolygon, Segment};
use scanned_building::{ScannedBuilding, ScannedWall, WallSurface};

/// A laser scanner in a building, in the robot's centre.
#[derive(Clone, Debug)]
pub struct LaserScanner {
    building: ScannedBuilding,
    pub(crate) params: ScannerParams,
    seed: u64,
}

/// What a ray meets first.
#[derive(Clone, Copy, Debug)]
struct Met {
    range: f64,
    surface: WallSurface,
    /// The angle between the ray and the normal of the surface, in radians.
    slant: f64,
}

/// Glass reflects a ray up to this angle from its normal, in radians.
const MIRRORING: f64 = 0.15;
/// A black surface reflects from up to this range, in metres.
const DARK: f64 = 3.0;
/// Two walls that meet have this much of their bearings in common, in radians, so that no ray passes between them.
const OVERLAP: f64 = 1e-9;

impl LaserScanner {
    /// A scanner in the building of a plan. Its rooms, furniture and people, and the noise of the scans, follow from
    /// the seed.
    pub fn new(plan: &CorridorPlan, params: &ScannerParams, seed: u64) -> Self {
        Self { building: ScannedBuilding::new(plan, params, seed), params: *params, seed }
    }

    /// The scan with this number, from a pose, at a time in seconds.
    pub fn scan(&self, pose: Pose, number: u64, time: f64) -> Result<Scan, ScanError> {
        let params = &self.params;
        let step = params.angular_step.to_radians();
        let angle_min = -params.field_of_view.to_radians() / 2.0;
        let all = (params.field_of_view / params.angular_step + 1e-6).floor() as usize + 1;
        // The last reading of a full circle is the first one.
        let count = if params.field_of_view >= 360.0 { all - 1 } else { all };
        let mut chance = stream(self.seed, StreamPurpose::Ranges, number as usize);
        let met = self.sweep(pose, angle_min, step, count, time);
        let ranges = met.into_iter().map(|met| {
            // Each reading takes the same random numbers, whatever it meets.
            let (spoilt, noise) = (chance.random::<f64>(), StandardNormal.sample(&mut chance));
            let noise: f64 = noise;
            let range = met.and_then(|met| met.returned(params));
            match range {
                _ if spoilt < params.dropouts => f32::NAN,
                Some(range) => {
                    let deviation = params.noise.hypot(params.range_noise * range);
                    (range + deviation * noise).max(0.0) as f32
                }
                None => f32::INFINITY,
            }
        });
        let geometry = ScanGeometry {
            angle_min,
            angle_increment: step,
            range_min: params.least_range,
            range_max: params.range,
        };
        Scan::new(geometry, ranges.collect(), Isometry2::identity())
    }

    /// What each of a number of rays meets, from an angle on, counter-clockwise.
    fn sweep(
        &self,
        Pose { position, heading }: Pose,
        angle_min: f64,
        step: f64,
        count: usize,
        time: f64,
    ) -> Vec<Option<Met>> {
        let first = heading + angle_min;
        let rays: Vec<_> = (0..count).map(|index| unit(first + index as f64 * step)).collect();
        let mut nearest: Vec<Option<Met>> = vec![None; count];
        for ScannedWall { ends, surface } in self.building.surfaces(time) {
            let [one, other] = ends.map(|end| end - Point2::from(position));
            let wall = other - one;
            let [from, to] = [one, other].map(angle);
            let turn = wrapped(to - from);
            let begin = (if turn < 0.0 { to } else { from }) - first;
            let begin = begin.rem_euclid(TAU) - OVERLAP;
            let span = turn.abs() + 2.0 * OVERLAP;
            // The bearings of a wall may pass the first ray.
            for begin in [begin, begin - TAU] {
                let low = (begin / step).ceil().max(0.0) as usize;
                let high = ((begin + span) / step).floor();
                if high < 0.0 {
                    continue;
                }
                for index in low..=(high as usize).min(count.saturating_sub(1)) {
                    let steepness = rays[index].perp(&wall);
                    let range = one.perp(&wall) / steepness;
                    let known = nearest[index].map_or(f64::INFINITY, |met| met.range);
                    if range > 0.0 && range < known {
                        let slant = (steepness.abs() / wall.x.hypot(wall.y)).min(1.0).acos();
                        nearest[index] = Some(Met { range, surface, slant });
                    }
                }
            }
        }
        nearest
    }
}

impl Met {
    /// The range that comes back.
    fn returned(self, params: &ScannerParams) -> Option<f64> {
        let reflects = match self.surface {
            WallSurface::Plain => true,
            WallSurface::Glass => self.slant < MIRRORING,
            WallSurface::Black => self.range < DARK,
        };
        (reflects && self.range < params.range).then_some(self.range)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use toposlam_vision::laser::scan::Reading;

    use super::*;

    fn plan(corridors: &[([[f64; 2]; 2], f64)]) -> CorridorPlan {
        let corridor = |&(ends, width): &([[f64; 2]; 2], f64)| Corridor {
            ends: ends.map(Point2::from),
            width,
        };
        CorridorPlan { corridors: corridors.iter().map(corridor).collect(), lobbies: Vec::new() }
    }

    /// A corridor 2 m wide, from x = -1 to x = 21.
    fn straight() -> CorridorPlan {
        plan(&[([[0.0, 0.0], [20.0, 0.0]], 2.0)])
    }

    /// The reading at a bearing, in degrees.
    fn reading(scan: &Scan, degrees: f64) -> Reading {
        let off = |bearing: f64| wrapped(bearing - degrees.to_radians()).abs();
        scan.readings().min_by(|one, other| off(one.0).total_cmp(&off(other.0))).unwrap().1
    }

    #[test]
    fn a_range_is_the_distance_at_which_the_ray_leaves_the_floor() {
        let corridors = [
            ([[-20.0, 1.0], [20.0, 1.0]], 2.0),
            ([[3.0, 1.0], [14.0, 19.0]], 1.7),
            ([[-9.0, 1.0], [-4.0, -16.0]], 2.4),
            ([[14.0, 19.0], [-6.0, 23.0]], 2.0),
            // It goes on straight, but is narrower.
            ([[20.0, 1.0], [28.0, 1.0]], 1.6),
        ];
        let lobbies = vec![Lobby { middle: Point2::new(-15.0, 1.0), radius: 2.5 }];
        let plan = CorridorPlan { lobbies, ..plan(&corridors) };
        let params = ScannerParams { range: 80.0, ..ScannerParams::PLAIN };
        let (floor, scanner) = (plan.floor(), LaserScanner::new(&plan, &params, 1));
        for position in
            [[-15.0, 0.4], [2.7, 1.3], [8.0, 9.3], [-6.5, -7.5], [13.6, 18.6], [24.0, 1.2]]
        {
            let heading = 0.1 * position[0];
            let scan = scanner.scan(Pose { position, heading }, 1, 0.0).unwrap();
            let mut wrong = 0;
            for (bearing, reading) in scan.readings() {
                let Reading::Hit(range) = reading else { panic!("{bearing}: {reading:?}") };
                let is_floor = |length: f64| {
                    let point = Point2::from(position) + length * unit(heading + bearing);
                    floor.iter().any(|piece| piece.holds(point))
                };
                let steps = (0_u32..).map(|step| 0.05 * f64::from(step));
                let is_free = steps.take_while(|&length| length < range - 1e-3).all(is_floor);
                // A ray that passes a corner by a hair is right on either side of it.
                wrong += usize::from(!is_free || is_floor(range + 1e-3));
            }
            assert!(wrong <= 1, "{wrong} of 360 rays from {position:?}");
        }
    }

    #[test]
    fn a_scan_has_a_reading_for_each_step_of_its_field_of_view() {
        let pose = Pose { position: [5.0, 0.0], heading: 0.0 };
        for (field_of_view, angular_step, count) in
            [(360.0, 1.0, 360), (180.0, 1.0, 181), (180.0, 0.5, 361), (270.0, 0.25, 1081)]
        {
            let params = ScannerParams { field_of_view, angular_step, ..ScannerParams::PLAIN };
            let scan = LaserScanner::new(&straight(), &params, 1).scan(pose, 1, 0.0).unwrap();
            assert_eq!(scan.ranges().len(), count, "{field_of_view}");
            assert!((scan.geometry().angle_min + field_of_view.to_radians() / 2.0).abs() < 1e-12);
        }
        // Beyond its range there is no return.
        let params = ScannerParams { range: 10.0, ..ScannerParams::PLAIN };
        let scan = LaserScanner::new(&straight(), &params, 1).scan(pose, 1, 0.0).unwrap();
        assert_eq!(reading(&scan, 0.0), Reading::NoReturn);
        let behind = reading(&scan, PI.to_degrees());
        assert!(matches!(behind, Reading::Hit(range) if (range - 6.0).abs() < 1e-4));
    }

    #[test]
    fn named_scanners_have_the_readings_and_the_range_of_their_data_sheets() {
        let facts = [
            ("lds-01", 360.0, 360, 3.5),
            ("lds-02", 360.0, 360, 8.0),
            ("rplidar-a1", 360.0, 360, 12.0),
            ("rplidar-c1", 360.0, 500, 12.0),
            ("ust-10lx", 270.0, 1081, 10.0),
            ("utm-30lx", 270.0, 1081, 30.0),
            ("lms-200", 180.0, 181, 30.0),
            ("lms-291", 180.0, 361, 30.0),
            // Its data sheet has 682 steps, from the 44th to the 725th.
            ("urg-04lx", 240.0, 683, 4.0),
        ];
        assert_eq!(SCANNERS.map(|scanner| scanner.name), facts.map(|fact| fact.0));
        let plan = plan(&[([[-60.0, 0.0], [60.0, 0.0]], 2.0)]);
        for (name, field_of_view, count, range) in facts {
            let params = ScannerParams::named(name).unwrap();
            let empty = ScannerParams {
                field_of_view: params.field_of_view,
                angular_step: params.angular_step,
                least_range: params.least_range,
                range: params.range,
                ..ScannerParams::PLAIN
            };
            assert_eq!(params.doors, ScannerParams::DEFAULT.doors, "{name}: the usual building");
            let pose = Pose { position: [0.0; 2], heading: 0.3 };
            let scan = LaserScanner::new(&plan, &empty, 1).scan(pose, 1, 0.0).unwrap();
            assert_eq!(scan.ranges().len(), count, "{name}");
            // The last reading of a full circle would be the first one.
            let off = field_of_view - scan.field_of_view().to_degrees();
            assert!((-1e-6..params.angular_step + 1e-6).contains(&off), "{name}: {off}");
            // From the middle of a corridor 120 m long it sees the walls up to its range, and nothing beyond.
            let farthest = scan.readings().filter_map(|(_, reading)| match reading {
                Reading::Hit(range) => Some(range),
                _ => None,
            });
            let farthest = farthest.fold(0.0, f64::max);
            assert!((0.6 * range..range).contains(&farthest), "{name}: {farthest}");
            assert_eq!(reading(&scan, -0.3_f64.to_degrees()), Reading::NoReturn, "{name}");
        }
        assert_eq!(ScannerParams::named("UTM-30LX"), ScannerParams::named("utm-30lx"));
        assert_eq!(ScannerParams::named("vlp-16"), None);
    }

    #[test]
    fn a_range_of_3_5_m_is_enough_for_corridors_of_3_m() {
        let scanner = ScannerParams::named("lds-01").unwrap();
        assert_eq!(scanner.check_range(3.0), Ok(()));
        let error = scanner.check_range(3.2).unwrap_err().to_string();
        assert!(error.contains("3.5 m") && error.contains("needs 3.6 m"), "{error}");
    }

    #[test]
    fn noise_that_is_a_part_of_the_range_grows_with_it() {
        let params = ScannerParams { range_noise: 0.01, ..ScannerParams::PLAIN };
        let (noisy, plain) = (scans(params), scans(ScannerParams::PLAIN));
        let pairs = noisy.iter().zip(&plain);
        let pairs = pairs.flat_map(|(noisy, plain)| noisy.ranges().iter().zip(plain.ranges()));
        let parts: Vec<f64> =
            pairs.map(|(&noisy, &plain)| f64::from(noisy / plain) - 1.0).collect();
        let squares: f64 = parts.iter().map(|part| part * part).sum();
        let deviation = (squares / parts.len() as f64).sqrt();
        assert!((deviation - 0.01).abs() < 0.0001, "{deviation}");
    }

    /// Scans from many places in a corridor.
    fn scans(params: ScannerParams) -> Vec<Scan> {
        let scanner = LaserScanner::new(&straight(), &params, 1);
        let pose = |number: u64| Pose { position: [2.0 + 0.03 * number as f64, 0.0], heading: 0.3 };
        (0..400).map(|number| scanner.scan(pose(number), number, 0.0).unwrap()).collect()
    }

    #[test]
    fn noise_and_dropouts_are_as_frequent_and_as_large_as_asked() {
        let params = ScannerParams { noise: 0.02, dropouts: 0.05, ..ScannerParams::PLAIN };
        let (noisy, plain) = (scans(params), scans(ScannerParams::PLAIN));
        let pairs = noisy.iter().zip(&plain);
        let pairs = pairs.flat_map(|(noisy, plain)| noisy.ranges().iter().zip(plain.ranges()));
        let (mut invalid, mut squares, mut count) = (0, 0.0, 0);
        for (noisy, plain) in pairs {
            count += 1;
            if noisy.is_nan() {
                invalid += 1;
            } else {
                squares += f64::from(noisy - plain).powi(2);
            }
        }
        let share = f64::from(invalid) / f64::from(count);
        let deviation = (squares / f64::from(count - invalid)).sqrt();
        // Of 144,000 readings: five standard deviations of the estimates.
        assert!((share - 0.05).abs() < 0.003, "{share}");
        assert!((deviation - 0.02).abs() < 0.0002, "{deviation}");
    }

    #[test]
    fn glass_reflects_at_a_right_angle_and_black_surfaces_from_nearby() {
        let params = ScannerParams::PLAIN;
        for (surface, range, slant, returned) in [
            (WallSurface::Plain, 9.0, 1.0, true),
            (WallSurface::Glass, 9.0, 0.1, true),
            (WallSurface::Glass, 1.0, 0.3, false),
            (WallSurface::Black, 2.9, 1.0, true),
            (WallSurface::Black, 3.1, 0.0, false),
        ] {
            let found = Met { range, surface, slant }.returned(&params);
            assert_eq!(found, returned.then_some(range), "{surface:?}");
        }
        let without = |params| {
            let readings = scans(params).into_iter().flat_map(|scan| scan.ranges().to_vec());
            readings.filter(|range| range.is_infinite()).count()
        };
        assert_eq!(without(params), 0);
        assert!(without(ScannerParams { glass: 1.0, ..params }) > 5000);
        assert!(without(ScannerParams { black: 1.0, ..params }) > 1000);
    }

    #[test]
    fn a_person_who_walks_by_is_seen_and_is_gone_later() {
        let with_people = ScannerParams { people: 5.0, ..ScannerParams::PLAIN };
        let [scanner, empty] = [with_people, ScannerParams::PLAIN]
            .map(|params| LaserScanner::new(&straight(), &params, 1));
        let pose = Pose { position: [10.0, -0.8], heading: 0.0 };
        let empty = empty.scan(pose, 1, 0.0).unwrap();
        let counts: Vec<usize> = (0..40)
            .map(|second| {
                let scan = scanner.scan(pose, 1, f64::from(second)).unwrap();
                let pairs = scan.ranges().iter().zip(empty.ranges());
                pairs.filter(|(range, empty)| **range < **empty - 0.05).count()
            })
            .collect();
        assert!(counts.iter().all(|&count| count < 120), "{counts:?}");
        assert!(counts.iter().any(|&count| count > 8), "{counts:?}");
        assert!(counts.iter().any(|&count| count < 4), "{counts:?}");
    }
}
