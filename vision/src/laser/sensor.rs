//! From scans to junctions: the local map of the last scans, the middle lines of its ways, and where they
//! meet.

use std::collections::VecDeque;

use nalgebra::{Isometry2, Point2, Vector2};
use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use super::{
    clearances::Clearances,
    grid::Grid,
    matching::ScanMatcher,
    params::{LaserParams, LocalMapParams},
    ray_counts::{RayCounts, Rays},
    scan::Scan,
    scan_log::is_near_origin,
    skeleton::Skeleton,
    viewpoint::Viewpoint,
    way_graph::{ArmJudge, CountedArms, WayGraph},
};
use crate::{
    geometry::{distance, from_robot, moved},
    place::{PlaceSensor, PlaceView, SeenPlace},
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
    /// The scans in the local map, each with the length of the robot's way until then, in metres.
    scans: VecDeque<(f64, Rays)>,
    viewpoints: VecDeque<Viewpoint>,
    /// The length of the robot's way, in metres.
    way: f64,
    /// Where the last scan was taken that was used.
    last: Option<Odometry>,
    /// That of the last view.
    map: Option<LocalMap>,
}

/// The local map, and the ways on it.
#[derive(Clone, Debug)]
pub struct LocalMap {
    pub clearances: Clearances,
    /// The middle lines of its ways; `None` if the robot has no way.
    pub skeleton: Option<Skeleton>,
    /// Those that count.
    pub graph: WayGraph,
}

/// What a local map shows, on that map.
#[derive(Clone, Debug)]
pub(super) struct LocalView {
    pub map: LocalMap,
    pub places: Vec<SeenPlace>,
    /// The same if arms in doubt are arms, too.
    pub possible_places: Vec<SeenPlace>,
    /// See [`PlaceView::width`].
    pub width: Option<f64>,
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

impl PlaceSensor for LaserSensor {
    type Frame = Scan;

    /// `None` if the robot has hardly moved since the last view, or if the odometry is more than 10,000 km from its origin.
    fn view(&mut self, scan: &Scan, odometry: &Odometry) -> Option<PlaceView> {
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
        self.add(rays(scan, &robot, &params), position, side);
        self.viewpoints.push_back(Viewpoint::new(scan, &robot));
        let counts = self.counts.get(self.views % self.counts.len().max(1))?;
        self.views += 1;
        let grid = counts.window(position, side, &params);
        let viewpoints = self.viewpoints.make_contiguous();
        let driven: Vec<_> = viewpoints.iter().map(Viewpoint::point).collect();
        let LocalView { map, places, possible_places, width } =
            LocalView::new(grid, position, viewpoints, &driven, &self.params);
        self.map = Some(map);
        Some(PlaceView {
            robot,
            odometry_from_map: (self.matcher.correction() * frame).inverse(),
            places,
            possible_places,
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

impl LocalView {
    /// What a map shows around the robot. It was at the points that were `driven`.
    pub(super) fn new(
        mut grid: Grid,
        robot: Point2<f64>,
        viewpoints: &[Viewpoint],
        driven: &[Point2<f64>],
        params: &LaserParams,
    ) -> Self {
        grid.clean(&params.map);
        let clearances = Clearances::new(grid);
        let skeleton = Skeleton::new(&clearances, robot, params);
        let ways = skeleton.as_ref().map(|ways| WayGraph::new(ways, &clearances));
        let ways = ways.unwrap_or_default();
        let judge = ArmJudge { map: &clearances, viewpoints, driven, params: &params.arm };
        let (graph, any_in_doubt) = ways.clone().pruned(&judge, CountedArms::Seen);
        let places = graph.places(params);
        let possible_places = if any_in_doubt {
            ways.pruned(&judge, CountedArms::SeenOrInDoubt).0.places(params)
        } else {
            places.clone()
        };
        let width =
            skeleton.as_ref().and_then(|ways| ways.width_at(robot, &clearances, &params.map));
        Self { map: LocalMap { clearances, skeleton, graph }, places, possible_places, width }
    }
}

pub(super) fn rays(scan: &Scan, robot: &Odometry, params: &LocalMapParams) -> Rays {
    let map_from_robot = from_robot(robot);
    let mut rays = Rays { from: map_from_robot * scan.scanner(), ..Rays::default() };
    let readings: Vec<(f64, Option<f64>)> = scan.ranges_hit().collect();
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
        let [Some(before), Some(one), Some(two), Some(after)] = four else { continue };
        let gap = distance(one, two);
        let on_line = |line: [Point2<f64>; 2], towards: Point2<f64>, range: f64| {
            met(rays.from, towards, line)
                .is_some_and(|met| (met - range).abs() < 0.3 * gap.max(0.3))
        };
        let is_straight = on_line([before, one], two, other) || on_line([after, two], one, range);
        if (params.cell..=params.bridge).contains(&gap) && is_straight {
            rays.walls.push([one, two]);
        }
    }
    rays
}

/// The range at which the ray from one point towards another meets the line through two points.
fn met(from: Point2<f64>, towards: Point2<f64>, [one, other]: [Point2<f64>; 2]) -> Option<f64> {
    let (ray, line) = ((towards - from).normalize(), other - one);
    let met = (one - from).perp(&line) / ray.perp(&line);
    (met.is_finite() && met > 0.0).then_some(met)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{geometry::unit, laser::grid::Cell};

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
}
