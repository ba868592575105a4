//! From scans to junctions: the local map of the last scans, the middle lines of its ways, and where they
//! meet.

use std::collections::VecDeque;

use nalgebra::{Isometry2, Point2, Vector2};
use toposlam_model::driving::odometry::Odometry;

use super::{
    local_map::{FeltWall, LocalMap, LocalScans, LocalView, LocalWays, is_near_origin, rays},
    matching::ScanMatcher,
    params::LaserParams,
    ray_counts::{RayCounts, Rays},
    scan::Scan,
    viewpoint::Viewpoint,
};
use crate::{
    geometry::{from_robot, moved},
    place::{PlaceSensor, PlaceView},
};

/// Senses junctions with a laser scanner.
#[derive(Clone, Debug, Default)]
pub struct LaserSensor {
    params: LaserParams,
    matcher: ScanMatcher,
    /// From the frame of odometry to the one in which scans are placed; `None` before the first scan.
    frame: Option<Isometry2<f64>>,
    /// Where rays passed and ended, once for each place of the corners of cells; empty before the first scan.
    counts: Vec<RayCounts>,
    views: usize,
    /// The scans in the local map.
    scans: VecDeque<MappedScan>,
    /// The length of the robot's way, in metres.
    way: f64,
    /// Where the last scan was taken that was used.
    last: Option<Odometry>,
    /// That of the last view.
    map: Option<LocalMap>,
    /// What stopped the robot, and the length of its way then, in metres.
    felt: Vec<(FeltWall, f64)>,
}

#[derive(Clone, Debug)]
struct MappedScan {
    /// The length of the robot's way until then, in metres.
    way: f64,
    map_from_robot: Isometry2<f64>,
    rays: Rays,
    viewpoint: Viewpoint,
}

/// Corners of cells, in cells from the origin. Successive views take them in turn: what several views agree on must not
/// depend on how the walls lie in the cells.
const CORNERS: [Vector2<f64>; 2] = [Vector2::new(0.0, 0.0), Vector2::new(0.5, 0.5)];
/// The counts reach this many times as far as a window of the local map.
const MARGIN: usize = 3;

impl LaserSensor {
    pub fn new(params: LaserParams) -> Self {
        Self { params, matcher: ScanMatcher::new(params.matching), ..Self::default() }
    }

    pub fn map(&self) -> Option<&LocalMap> {
        self.map.as_ref()
    }

    /// A piece of wall stopped the robot, on the map, and no scan shows it, as if it is of glass or black.
    pub fn feel(&mut self, felt: FeltWall) {
        self.felt.push((felt, self.way));
    }

    /// Adds the rays of a scan, and forgets those of old ones.
    fn add(&mut self, scan: MappedScan, robot: Point2<f64>, side: usize) {
        let covers = |counts: &RayCounts| counts.covers(robot, side);
        let moved = self.counts.is_empty() || !self.counts.iter().all(covers);
        let forgotten = self.way - self.params.map.memory;
        while let Some(old) = self.scans.front().filter(|old| old.way < forgotten) {
            for counts in self.counts.iter_mut().filter(|_| !moved) {
                counts.remove(&old.rays, &old.map_from_robot);
            }
            self.scans.pop_front();
        }
        self.felt.retain(|&(_, way)| way >= forgotten);
        let add = |counts: &mut RayCounts, scan: &MappedScan| {
            counts.add(&scan.rays, &scan.map_from_robot);
        };
        if moved {
            let around = |corner| {
                let cell = self.params.map.cell;
                let mut counts = RayCounts::around(robot, MARGIN * side, cell, corner);
                self.scans.iter().for_each(|scan| add(&mut counts, scan));
                counts
            };
            self.counts = CORNERS.into_iter().map(around).collect();
        }
        self.counts.iter_mut().for_each(|counts| add(counts, &scan));
        self.scans.push_back(scan);
    }
}

impl PlaceSensor for LaserSensor {
    type Frame = Scan;

    /// `None` if the robot has hardly moved since the last view, or if the odometry is more than 10,000 km from its origin.
    fn view(&mut self, scan: &Scan, odometry: &Odometry) -> Option<PlaceView> {
        if self.frame.is_none() {
            self.params = self.params.for_range(scan.geometry().range_max);
        }
        let params = self.params.map;
        if !is_near_origin(odometry) {
            return None;
        }
        self.way += params.driven(&mut self.last, odometry)?;
        // Where the robot was at first, with the axes along the walls: what is seen in cells depends a little on how walls
        // lie in them, and must not depend on the frame of odometry.
        let frame = *self.frame.get_or_insert_with(|| {
            let heading = odometry.heading + scan.direction_of_walls();
            from_robot(&Odometry { heading, ..*odometry }).inverse()
        });
        let placed = moved(&frame, odometry);
        let robot = self.matcher.add_scan(scan, &placed, self.way, self.way - params.memory);
        let position = Point2::from(robot.position);
        let side = params.window();
        let mapped = MappedScan {
            way: self.way,
            map_from_robot: from_robot(&robot),
            rays: rays(scan, &params),
            viewpoint: Viewpoint::new(scan, &robot),
        };
        self.add(mapped, position, side);
        let counts = self.counts.get(self.views % self.counts.len().max(1))?;
        self.views += 1;
        let grid = counts.window(position, side, &params);
        let viewpoints: Vec<Viewpoint> =
            self.scans.iter().map(|scan| scan.viewpoint.clone()).collect();
        let driven = viewpoints.iter().map(Viewpoint::point).collect();
        let felt = self.felt.iter().map(|&(felt, _)| felt).collect();
        let scans = LocalScans { robot: position, viewpoints, driven, felt, params: &self.params };
        let LocalView { map, places, possible_places, width } = LocalWays::new(grid, scans).view();
        self.map = Some(map);
        Some(PlaceView {
            robot,
            odometry_from_map: (self.matcher.correction() * frame).inverse(),
            places,
            possible_places,
            facts: None,
            sector: scan.sector(),
            width,
            scene: None,
        })
    }

    fn sight(&self, from: Point2<f64>, direction: f64, limit: f64) -> f64 {
        let map = self.map.as_ref();
        map.map_or(0.0, |map| map.clearances.sight(from, direction, limit).0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        geometry::unit,
        laser::{ends::WayEnd, grid::Cell},
    };

    /// A scan all around from the middle of an endless corridor, 2 m wide, along the x axis. Nothing
    /// comes back from beyond 30 m.
    fn along_corridor(is_silent: impl Fn(f64) -> bool) -> Scan {
        Scan::each_degree(-180, 360, |bearing| {
            let range = 1.0 / bearing.sin().abs();
            if range > 30.0 || is_silent(bearing) { f64::INFINITY } else { range }
        })
    }

    fn cells(scan: &Scan, points: &[Point2<f64>]) -> Vec<Cell> {
        let mut sensor = LaserSensor::new(LaserParams::default());
        assert!(sensor.view(scan, &Odometry::default()).is_some());
        let grid = &sensor.map().unwrap().clearances.grid;
        points.iter().map(|&point| grid.cells[grid.index(point).unwrap()]).collect()
    }

    #[test]
    fn the_middle_of_a_corridor_is_free_beyond_the_range_of_the_scanner() {
        let points = [-14.0, -8.0, 8.0, 14.0].map(|x| Point2::new(x, 0.0));
        assert_eq!(cells(&along_corridor(|_| false), &points), [Cell::Free; 4]);
    }

    #[test]
    fn what_a_wide_angle_without_returns_hides_is_unknown() {
        let is_silent = |bearing: f64| (bearing - 0.3).abs() < 0.2;
        let beside = Point2::from(2.0 * unit(0.3));
        let seen = cells(&along_corridor(is_silent), &[beside, Point2::new(8.0, 0.0)]);
        assert_eq!(seen, [Cell::Unknown, Cell::Free]);
    }

    /// The corridor ends at x = 4, and nothing comes back from the middle 1.5 m of that wall.
    #[test]
    fn a_way_whose_end_is_hidden_has_ended_once_a_wall_was_felt_there() {
        let view = |sensor: &mut LaserSensor, x: f64| {
            let range = |bearing: f64| {
                let ahead = if bearing.cos() > 0.0 { (4.0 - x) / bearing.cos() } else { 99.0 };
                let aside = 1.0 / bearing.sin().abs();
                let is_silent = ahead < aside && (4.0 - x) * bearing.tan().abs() < 0.75;
                if is_silent { f64::INFINITY } else { ahead.min(aside) }
            };
            let robot = Odometry { position: [x, 0.0], heading: 0.0 };
            assert!(sensor.view(&Scan::each_degree(-180, 360, range), &robot).is_some());
            let map = sensor.map().unwrap();
            let ends = map.ways.nodes.iter().filter_map(|node| Some((node.point, node.end?.kind)));
            ends.filter(|end| end.0.x > x).map(|end| end.1).collect::<Vec<WayEnd>>()
        };
        let mut sensor = LaserSensor::new(LaserParams::default());
        for x in [0.0, 1.0, 2.0, 3.0, 3.7] {
            view(&mut sensor, x);
        }
        assert_eq!(view(&mut sensor, 0.0), [WayEnd::Open]);
        let robot = Point2::new(3.7, 0.0);
        sensor.feel(FeltWall { robot, wall: [-0.25, 0.25].map(|y| Point2::new(4.0, y)) });
        assert_eq!(view(&mut sensor, 1.0), [WayEnd::Closed]);
    }

    #[test]
    fn a_wall_that_was_felt_is_forgotten_when_scans_are() {
        let mut sensor = LaserSensor::new(LaserParams::default());
        let mut is_wall = |x: f64, felt: bool| {
            let robot = Odometry { position: [x, 0.0], heading: 0.0 };
            assert!(sensor.view(&along_corridor(|_| false), &robot).is_some());
            if felt {
                let robot = Point2::new(4.5, 0.0);
                sensor.feel(FeltWall { robot, wall: [-0.4, 0.4].map(|y| Point2::new(5.0, y)) });
            }
            let grid = &sensor.map().unwrap().clearances.grid;
            grid.cells[grid.index(Point2::new(5.0, 0.0)).unwrap()] == Cell::Occupied
        };
        assert!(!is_wall(0.0, true), "it was felt after this view");
        assert!(is_wall(1.0, false) && is_wall(18.0, false));
        assert!(!is_wall(19.0, false));
    }
}
