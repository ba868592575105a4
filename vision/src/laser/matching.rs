//! Scan matching: where a scan was taken, by the walls that earlier scans have shown. Odometry drifts; the
//! local map would be blurred by it. Points are matched with lines (Censi, *An ICP variant using a
//! point-to-line metric*, 2008). The odometry between two scans is an observation like any other: it decides
//! what the walls leave open, as the way along a corridor.

use std::collections::BTreeMap;

use nalgebra::{Isometry2, Point2, Vector2};
use toposlam_model::driving::odometry::Odometry;

use super::{grid::floor, params::MatchingParams, scan::Scan};
use crate::{
    geometry::{distance, from_robot, motion_between, moved},
    least_squares::{NormalEquations, PrincipalAxis},
};

/// Matches scans with the walls of earlier ones.
#[derive(Clone, Debug, Default)]
pub(super) struct ScanMatcher {
    params: MatchingParams,
    /// Points of walls, by the square metre where they are.
    walls: BTreeMap<[i64; 2], Vec<WallPoint>>,
    /// The last pose, by odometry and in the frame of the local map.
    last: Option<[Odometry; 2]>,
}

/// A point of a scan on a straight wall.
#[derive(Clone, Copy, Debug)]
pub(super) struct WallPoint {
    pub(super) point: Point2<f64>,
    /// The unit vector across the wall, to the side from which it was seen.
    normal: Vector2<f64>,
    /// The length of the robot's way when it was seen, in metres.
    way: f64,
}

impl WallPoint {
    /// The same point in another frame.
    pub(super) fn moved(&self, motion: &Isometry2<f64>) -> Self {
        Self { point: motion * self.point, normal: motion * self.normal, ..*self }
    }
}

impl ScanMatcher {
    pub(super) fn new(params: MatchingParams) -> Self {
        Self { params, ..Self::default() }
    }

    /// The motion from the frame in which scans are placed to that of the local map, at the last scan. They are the same
    /// at first.
    pub(super) fn correction(&self) -> Isometry2<f64> {
        self.last
            .map_or_else(Isometry2::identity, |[odometry, pose]| motion_between(&odometry, &pose))
    }

    /// Takes the next scan, the odometry at its time, and the length of the robot's way until then, in
    /// metres. Walls that were last seen before `forgotten` on that way are forgotten. Returns the pose in
    /// the frame of the local map.
    pub(super) fn add_scan(
        &mut self,
        scan: &Scan,
        odometry: &Odometry,
        way: f64,
        forgotten: f64,
    ) -> Odometry {
        if self.params.rounds == 0 {
            return *odometry;
        }
        let points = self.wall_points(scan, way);
        let predicted = moved(&self.correction(), odometry);
        let pose = self.last.and_then(|[last, _]| {
            self.matched(&points, &predicted, self.deviation(&last, odometry))
        });
        let pose = pose.unwrap_or(predicted);
        self.last = Some([*odometry, pose]);
        self.forget(forgotten);
        self.add(&points, &pose);
        pose
    }

    /// The points of a scan on straight walls, in the robot's frame, with the length of the robot's way until then, in
    /// metres.
    pub(super) fn wall_points(&self, scan: &Scan, way: f64) -> Vec<WallPoint> {
        wall_points(scan, &self.params, way)
    }

    /// Forgets walls that were last seen before a length of the robot's way, in metres.
    pub(super) fn forget(&mut self, forgotten: f64) {
        for points in self.walls.values_mut() {
            points.retain(|point| point.way >= forgotten);
        }
        self.walls.retain(|_, points| !points.is_empty());
    }

    /// The standard deviation of odometry between two scans, in metres and in radians.
    fn deviation(&self, last: &Odometry, odometry: &Odometry) -> [f64; 2] {
        let params = &self.params;
        let driven = last.distance(odometry);
        let turned = last.seen(odometry.heading).abs();
        [
            params.shift + params.shift_per_metre * driven,
            params.turn + params.turn_per_metre * driven + params.turn_per_radian * turned,
        ]
    }

    /// The pose at which the points of a scan lie on the walls that are known, near a predicted one with a standard
    /// deviation in metres and in radians; `None` if they match too few, or far off.
    pub(super) fn matched(
        &self,
        points: &[WallPoint],
        predicted: &Odometry,
        deviation: [f64; 2],
    ) -> Option<Odometry> {
        let params = &self.params;
        let mut pose = *predicted;
        let mut search = WallSearch::new(self);
        for round in 0..params.rounds {
            let part = (round + 1) as f64 / params.rounds as f64;
            let gate = params.gate + (1.0 - part) * (params.first_gate - params.gate);
            let mut equations = NormalEquations::<3>::with_pull(0.0);
            let off = [0, 1].map(|axis| predicted.position[axis] - pose.position[axis]);
            let back = pose.seen(predicted.heading);
            let [shift, turn] = deviation.map(|deviation| deviation.powi(-2));
            equations.add(shift, [1.0, 0.0, 0.0], off[0]);
            equations.add(shift, [0.0, 1.0, 0.0], off[1]);
            equations.add(turn, [0.0, 0.0, 1.0], back);
            let map_from_robot = from_robot(&pose);
            let mut matches = 0;
            for point in points {
                let at = map_from_robot * point.point;
                let normal = map_from_robot * point.normal;
                let Some((wall, across)) = search.nearest(at, normal, gate) else { continue };
                matches += 1;
                // Tukey's biweight: what is far off does not count.
                let weight = (1.0 - (across / gate).powi(2)).powi(2) / params.deviation.powi(2);
                let lever = (at - Point2::from(pose.position)).perp(&wall);
                equations.add(weight, [wall.x, wall.y, lever], across);
            }
            if matches < params.min_matches {
                return None;
            }
            let [east, north, turn] = equations.solve()?;
            pose = Odometry {
                position: [pose.position[0] + east, pose.position[1] + north],
                heading: pose.whither(turn),
            };
        }
        let [shift, turn] = deviation.map(|deviation| params.max_deviations * deviation);
        let is_near = predicted.distance(&pose) <= shift
            && predicted.seen(pose.heading).abs() <= turn
            && pose.heading.is_finite();
        is_near.then_some(pose)
    }

    /// The part of the points of a scan that lie on walls that are known, for a robot at a pose.
    pub(super) fn part_on_walls(&self, points: &[WallPoint], pose: &Odometry) -> f64 {
        let map_from_robot = from_robot(pose);
        let mut search = WallSearch::new(self);
        let on_wall = |point: &&WallPoint| {
            let (at, normal) = (map_from_robot * point.point, map_from_robot * point.normal);
            search.nearest(at, normal, self.params.gate).is_some()
        };
        points.iter().filter(on_wall).count() as f64 / points.len().max(1) as f64
    }

    /// Adds points of walls, in the robot's frame, where there are none yet.
    pub(super) fn add(&mut self, points: &[WallPoint], pose: &Odometry) {
        let map_from_robot = from_robot(pose);
        for added in points.iter().map(|point| point.moved(&map_from_robot)) {
            let near = self.walls.entry(square(added.point)).or_default();
            let is_known = near.iter().any(|known| {
                distance(known.point, added.point) < self.params.spacing
                    && known.normal.dot(&added.normal) > self.params.same_direction
            });
            if !is_known {
                near.push(added);
            }
        }
    }
}

/// Looks for the walls near points. Successive points of a scan mostly lie in the same square metre.
struct WallSearch<'a> {
    matcher: &'a ScanMatcher,
    /// The square of the last point, ...
    square: Option<[i64; 2]>,
    /// ... and the walls there and in the squares around it.
    walls: Vec<&'a [WallPoint]>,
}

impl<'a> WallSearch<'a> {
    fn new(matcher: &'a ScanMatcher) -> Self {
        Self { matcher, square: None, walls: Vec::new() }
    }

    /// The normal of the wall on which a point lies, seen from the same side, and the distance to it along
    /// the normal, in metres, which is at most the gate.
    fn nearest(
        &mut self,
        at: Point2<f64>,
        normal: Vector2<f64>,
        gate: f64,
    ) -> Option<(Vector2<f64>, f64)> {
        let here = square(at);
        let ScanMatcher { params, walls, .. } = self.matcher;
        if self.square != Some(here) {
            self.square = Some(here);
            let [column, row] = here;
            let columns = (column - 1..=column + 1)
                .flat_map(|column| walls.range([column, row - 1]..=[column, row + 1]));
            self.walls.clear();
            self.walls.extend(columns.map(|(_, points)| &points[..]));
        }
        let matched = self.walls.iter().copied().flatten().filter_map(|wall| {
            let off = wall.point - at;
            let across = off.dot(&wall.normal);
            let is_beside =
                across.abs() <= gate && normal.dot(&wall.normal) > params.same_direction;
            // Few are beside the point: the length is calculated for them alone.
            let apart = is_beside.then(|| off.norm()).filter(|&apart| apart < params.reach)?;
            Some((apart, wall.normal, across))
        });
        let nearest = matched.min_by(|one, other| one.0.total_cmp(&other.0));
        nearest.map(|(_, normal, across)| (normal, across))
    }
}

/// The points of a scan that lie on straight walls, in the robot's frame.
fn wall_points(scan: &Scan, params: &MatchingParams, way: f64) -> Vec<WallPoint> {
    let scanner = scan.scanner();
    let is_near = |hit: &Point2<f64>| distance(scanner, *hit) <= params.range;
    let hits: Vec<Point2<f64>> = scan.hits().filter(is_near).collect();
    let joined = |one: usize| {
        let two = hits.get(one).zip(hits.get(one + 1));
        two.is_some_and(|(one, other)| distance(*one, *other) <= params.max_step)
    };
    let mut points = Vec::new();
    for (at, &point) in hits.iter().enumerate() {
        // As many neighbours on either side as make a line long enough.
        let mut reach = 0;
        let line = loop {
            reach += 1;
            let first = at.checked_sub(reach);
            let first = first.filter(|&first| joined(first) && joined(at + reach - 1));
            let Some(first) = first else { break None };
            if distance(hits[first], hits[at + reach]) >= params.line {
                break Some(&hits[first..=at + reach]);
            }
        };
        let Some(normal) = line.and_then(|line| normal(line, params.straight)) else { continue };
        let side = normal.dot(&(scanner - point)).signum();
        points.push(WallPoint { point, normal: side * normal, way });
    }
    points
}

/// The unit vector across a line of points, if it is straight: if their deviation from it is at most this
/// many metres.
fn normal(line: &[Point2<f64>], straight: f64) -> Option<Vector2<f64>> {
    let PrincipalAxis { along, minor, .. } = PrincipalAxis::fit(line);
    (minor <= straight * straight).then_some(Vector2::new(-along.y, along.x))
}

/// The square metre of a point.
fn square(point: Point2<f64>) -> [i64; 2] {
    [floor(point.x), floor(point.y)]
}
