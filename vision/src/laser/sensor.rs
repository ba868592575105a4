//! From scans to junctions: the local map of the last scans, the middle lines of its ways, and where they
//! meet.

use std::collections::VecDeque;

use nalgebra::{Isometry2, Point2, Vector2};
use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use super::{
    clearances::Clearances,
    grid::Grid,
    junctions::LaserJunction,
    matching::ScanMatcher,
    params::{LaserParams, LocalMapParams},
    ray_counts::{RayCounts, Rays},
    scan::{Reading, Scan},
    skeleton::Skeleton,
    viewpoint::Viewpoint,
    wall_frame::to_walls,
    way_graph::{ArmJudge, CountedArms, WayGraph},
};
use crate::geometry::{distance, from_robot, moved};

/// Senses junctions with a laser scanner.
#[derive(Clone, Debug)]
pub struct LaserSensor {
    params: LaserParams,
    matcher: ScanMatcher,
    /// From the frame of odometry to the one in which scans are placed; `None` before the first scan.
    frame: Option<Isometry2<f64>>,
    /// Where rays passed and ended, once for each place of the corners of cells; empty before the first scan.
    counts: Vec<RayCounts>,
    /// The number of views so far.
    views: usize,
    /// The scans in the local map, each with the length of the robot's way until then, in metres.
    scans: VecDeque<(f64, Rays)>,
    /// Where they were taken, in the same order.
    viewpoints: VecDeque<Viewpoint>,
    /// The length of the robot's way, in metres.
    way: f64,
    /// Where the last scan was taken that was used.
    last: Option<Odometry>,
}

/// What the last scans show.
#[derive(Clone, Debug)]
pub struct LaserView {
    /// Where the robot is, in the frame of the local map.
    pub robot: Odometry,
    /// The motion from the frame of the local map to that of odometry. It is right near the robot.
    pub odometry_from_map: Isometry2<f64>,
    /// The local map.
    pub grid: Grid,
    /// The distances on it.
    pub clearances: Clearances,
    /// The middle lines of its ways; `None` if the robot has no way.
    pub skeleton: Option<Skeleton>,
    /// Those that count.
    pub graph: WayGraph,
    /// Where they meet.
    pub junctions: Vec<LaserJunction>,
    /// Where they meet if the arms in doubt are arms, too: those that the scanner did not look into.
    pub possible_junctions: Vec<LaserJunction>,
}

/// Odometry beyond this is wrong, in metres; cells near it would have no place.
const FARTHEST: f64 = 1e7;
/// Corners of cells, in cells from the origin. Successive views take them in turn: what several views agree on must not
/// depend on how the walls lie in the cells.
const CORNERS: [Vector2<f64>; 2] = [Vector2::new(0.0, 0.0), Vector2::new(0.5, 0.5)];
/// The counts reach this many times as far as a window of the local map.
const MARGIN: usize = 3;

impl LaserSensor {
    /// A sensor that has seen nothing yet.
    #[must_use]
    pub fn new(params: LaserParams) -> Self {
        let matcher = ScanMatcher::new(params.matching);
        Self {
            params,
            matcher,
            frame: None,
            counts: Vec::new(),
            views: 0,
            scans: VecDeque::new(),
            viewpoints: VecDeque::new(),
            way: 0.0,
            last: None,
        }
    }

    /// Takes the next scan, and the odometry at its time. Returns what is seen now, or `None` if the robot
    /// has hardly moved since the last view, or if the odometry is more than 10,000 km from its origin.
    pub fn see(&mut self, scan: &Scan, odometry: &Odometry) -> Option<LaserView> {
        let params = self.params.map;
        let pose = odometry.position.into_iter().chain([odometry.heading]);
        if pose.into_iter().any(|number| !(-FARTHEST..=FARTHEST).contains(&number)) {
            return None;
        }
        if let Some(last) = self.last {
            let driven = last.distance(odometry);
            let turned = wrapped(odometry.heading - last.heading).abs();
            if driven < params.every && turned < params.every_turn {
                return None;
            }
            self.way += driven;
        }
        self.last = Some(*odometry);
        let frame = *self.frame.get_or_insert_with(|| to_walls(scan, odometry));
        let placed = moved(&frame, odometry);
        let robot = self.matcher.see(scan, &placed, self.way, self.way - params.memory);
        let position = Point2::from(robot.position);
        let side = 2 * (params.reach / params.cell).ceil() as usize + 1;
        self.add(rays(scan, &robot, &params), position, side);
        self.viewpoints.push_back(Viewpoint::new(scan, &robot));
        let counts = self.counts.get(self.views % self.counts.len().max(1))?;
        self.views += 1;
        let mut grid = counts.window(position, side, &params);
        grid.clean(&params);
        let clearances = Clearances::new(&grid);
        let skeleton = Skeleton::new(&grid, &clearances, position, &self.params);
        let ways = skeleton.as_ref().map(|ways| WayGraph::new(ways, &grid, &clearances));
        let ways = ways.unwrap_or_default();
        let judge = ArmJudge {
            robot: position,
            grid: &grid,
            clearances: &clearances,
            viewpoints: self.viewpoints.make_contiguous(),
            params: &self.params.arm,
        };
        let (graph, any_in_doubt) = ways.clone().pruned(&judge, CountedArms::Seen);
        let junctions = graph.junctions(&self.params);
        let possible_junctions = if any_in_doubt {
            ways.pruned(&judge, CountedArms::SeenOrInDoubt).0.junctions(&self.params)
        } else {
            junctions.clone()
        };
        let odometry_from_map = (self.matcher.correction() * frame).inverse();
        Some(LaserView {
            robot,
            odometry_from_map,
            grid,
            clearances,
            skeleton,
            graph,
            junctions,
            possible_junctions,
        })
    }

    /// Adds the rays of a scan, and forgets those of old ones.
    fn add(&mut self, rays: Rays, robot: Point2<f64>, side: usize) {
        let covers = |counts: &RayCounts| counts.covers(robot, side);
        let moved = self.counts.is_empty() || !self.counts.iter().all(covers);
        let forgotten = self.way - self.params.map.memory;
        while let Some((_, old)) = self.scans.front().filter(|(way, _)| *way < forgotten) {
            for counts in self.counts.iter_mut().filter(|_| !moved) {
                counts.remove(old);
            }
            self.scans.pop_front();
            self.viewpoints.pop_front();
        }
        self.scans.push_back((self.way, rays));
        if moved {
            let around = |corner| {
                let cell = self.params.map.cell;
                let mut counts = RayCounts::around(robot, MARGIN * side, cell, corner);
                self.scans.iter().for_each(|(_, rays)| counts.add(rays));
                counts
            };
            self.counts = CORNERS.into_iter().map(around).collect();
        } else if let Some((_, rays)) = self.scans.back() {
            self.counts.iter_mut().for_each(|counts| counts.add(rays));
        }
    }
}

/// The rays of a scan. A reading without a return shows nothing: glass and black surfaces give none.
fn rays(scan: &Scan, robot: &Odometry, params: &LocalMapParams) -> Rays {
    let map_from_robot = from_robot(robot);
    let mut rays = Rays { from: map_from_robot * scan.scanner(), ..Rays::default() };
    let readings: Vec<(f64, Option<f64>)> = scan
        .readings()
        .map(|(bearing, reading)| match reading {
            Reading::Hit(range) => (bearing, Some(range)),
            Reading::NoReturn | Reading::Invalid => (bearing, None),
        })
        .collect();
    // Nothing beyond is on the map while the scan is remembered.
    let farthest = 2.0 * params.reach + params.memory;
    let point = |bearing: f64, range: f64| map_from_robot * scan.point(bearing, range);
    let ends: Vec<Option<Point2<f64>>> =
        readings.iter().map(|&(bearing, range)| Some(point(bearing, range?))).collect();
    let end = |index: usize| *ends.get(index)?;
    // The next reading with a return, if those without one in between cover a small angle only.
    let next = |index: usize| {
        let (bearing, _) = readings[index];
        let mut others = (index + 1..readings.len()).chain(0..index);
        let (at, next, range) =
            others.find_map(|at| readings[at].1.map(|range| (at, readings[at].0, range)))?;
        let step = wrapped(next - bearing);
        let is_near = at == index + 1 || (0.0..=params.max_silence).contains(&step);
        is_near.then_some((at, step, range))
    };
    for (index, &(bearing, range)) in readings.iter().enumerate() {
        let Some(range) = range else { continue };
        if range > farthest {
            rays.between.push(point(bearing, farthest));
            continue;
        }
        rays.hits.push(point(bearing, range));
        let Some((at, step, other)) = next(index) else { continue };
        // Rays closer than cells, up to where the map ends.
        let parts = (step.abs() * params.reach / params.cell).ceil() as u32;
        for part in 1..parts {
            let bearing = bearing + step * f64::from(part) / f64::from(parts);
            rays.between.push(point(bearing, range.min(other).min(farthest)));
        }
        if at != index + 1 {
            continue;
        }
        let four = [index.checked_sub(1).and_then(end), end(index), end(index + 1), end(index + 2)];
        let [before, Some(one), Some(two), after] = four else { continue };
        let gap = distance(one, two);
        let on_line = |line: Option<Point2<f64>>, from, to, range: f64| {
            let met = met(rays.from, to, line?, from)?;
            Some((met - range).abs() < 0.3 * gap.max(0.3))
        };
        let straight = on_line(before, one, two, other).unwrap_or(false)
            || on_line(after, two, one, range).unwrap_or(false);
        if (params.cell..=params.bridge).contains(&gap)
            && before.is_some()
            && after.is_some()
            && straight
        {
            rays.walls.push([one, two]);
        }
    }
    rays
}

/// The range at which the ray from one point towards another meets the line through two points.
fn met(
    from: Point2<f64>,
    towards: Point2<f64>,
    one: Point2<f64>,
    other: Point2<f64>,
) -> Option<f64> {
    let (ray, line) = ((towards - from).normalize(), other - one);
    let met = (one - from).perp(&line) / ray.perp(&line);
    (met.is_finite() && met > 0.0).then_some(met)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::{
        geometry::unit,
        laser::{grid::Cell, scan::ScanGeometry},
    };

    /// A scan all around from the middle of an endless corridor, 2 m wide, along the x axis. Nothing
    /// comes back from beyond 30 m.
    fn along_corridor(is_silent: impl Fn(f64) -> bool) -> Scan {
        let step = PI / 180.0;
        let geometry =
            ScanGeometry { angle_min: -PI, angle_increment: step, range_min: 0.1, range_max: 30.0 };
        let range = |index: u32| {
            let bearing = -PI + f64::from(index) * step;
            let range = 1.0 / bearing.sin().abs();
            if range > 30.0 || is_silent(bearing) { f32::INFINITY } else { range as f32 }
        };
        Scan::new(geometry, (0..360).map(range).collect(), Isometry2::identity()).unwrap()
    }

    fn cells(scan: &Scan, points: &[Point2<f64>]) -> Vec<Cell> {
        let view = LaserSensor::new(LaserParams::default()).see(scan, &Odometry::default());
        let grid = view.unwrap().grid;
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
}
