//! Where scans were taken, without odometry: each scan is matched with the walls that the scans before it have shown.
//!
//! First the turn and the motion since the last scan are searched on a raster of these walls (Olson, *Real-time correlative
//! scan matching*, 2009), then the pose is improved as with odometry. What the walls leave open, as the way along a corridor
//! without doors, is as between the two scans before: the robot is taken to drive on as fast.

use std::{
    collections::VecDeque,
    f64::consts::{FRAC_PI_2, PI},
};

use nalgebra::{Isometry2, Point2, Vector2};
use toposlam_model::driving::odometry::Odometry;

use super::{
    grid::floor,
    matching::{ScanMatcher, WallPoint},
    params::MatchingParams,
    scan::Scan,
};
use crate::geometry::{angle, distance, from_robot, in_steps, moved, unit};

/// Places scans in the frame of the first one.
#[derive(Clone, Debug)]
pub struct ScanMotion {
    matcher: ScanMatcher,
    last: Option<Odometry>,
    /// The motion between the last two scans, in the frame of the robot.
    step: Isometry2<f64>,
    /// How far the robot drives ahead between two scans where it does not turn, in metres.
    speed: f64,
    /// The length of the robot's way, in metres.
    way: f64,
    /// What scans along the way have hit.
    seen: VecDeque<SeenScan>,
}

/// A scan that is kept.
#[derive(Clone, Debug)]
struct SeenScan {
    pose: Odometry,
    /// The length of the robot's way until then, in metres.
    way: f64,
    /// Points on the surfaces that were hit, at most half a cell apart where they are on one.
    surfaces: Vec<Point2<f64>>,
}

/// With fewer points of walls the first scan shows too little. Geometry.
const FEWEST: usize = 30;
/// The rounds of matching. Geometry: 8 are enough.
const ROUNDS: usize = 8;
/// Walls that were last seen this far back on the robot's way are forgotten, in metres. Geometry: as in a local map.
const MEMORY: f64 = 18.0;
/// A scan is matched if this part of its points lies on walls that are known. Geometry: a robot that turns around a corner
/// sees a new corridor with most of its rays.
const LEAST_MATCHED: f64 = 0.25;
/// If so many do, and the robot is slow, nothing is searched. Geometry.
const WELL_MATCHED: f64 = 0.7;
/// A robot is slow if it moves less between two scans, in metres and radians. Geometry: as far as matching reaches.
const SLOW: [f64; 2] = [0.2, 0.1];
/// The standard deviation of a searched pose, in metres and radians. Geometry: a step of the search.
const DEVIATION: [f64; 2] = [0.2, 0.05];

/// The motions that are searched, in the frame of the robot at the last scan: back and ahead, and to both sides, ...
/// Geometry: a scan at each metre.
const AHEAD: std::ops::RangeInclusive<i32> = -4..=9;
const ASIDE: std::ops::RangeInclusive<i32> = -3..=3;
/// ... in steps of this many metres, ...
const STEP: f64 = 0.2;
/// ... and turns by up to this many steps, of this many radians.
const TURNS: i32 = 40;
const TURN: f64 = 0.04;
/// The side of a cell of the raster, in metres.
const CELL: f64 = 0.25;
/// How far the raster reaches, in cells.
const REACH: i64 = 72;
/// A surface is in the cells of these points around it, in cells.
const BLUR: [[f64; 2]; 5] = [[0.0, 0.0], [-0.5, 0.0], [0.5, 0.0], [0.0, -0.5], [0.0, 0.5]];
/// Hits farther from the scanner are not searched, in metres. Geometry: as far as the raster reaches.
const FAR: f64 = 15.0;
/// Neighbouring hits that are nearer to each other are on one surface, in metres. Geometry.
const ONE_SURFACE: f64 = 1.2;
/// A scan is kept if the robot has moved so far since the last one, in metres and radians. Geometry.
const KEPT: [f64; 2] = [0.3, 0.2];
/// Of two motions with as many points on walls the one counts that is nearer to that between the two scans before: so much
/// less of the points is worth a metre, ...
const METRE: f64 = 0.1;
/// ... and a radian. Geometry.
const RADIAN: f64 = 0.05;
/// At most so many hits are searched with.
const SEARCHED: usize = 180;
/// So many rays of a kept scan show free space.
const RAYS: usize = 360;
/// A pose fits so much less well if all hits are in unknown cells. Geometry.
const UNKNOWN: f64 = 0.3;
/// A robot that turns less between two scans drives on as fast, in radians. Geometry.
const STRAIGHT: f64 = 0.35;

impl ScanMotion {
    pub fn new(params: &MatchingParams) -> Self {
        let matcher = ScanMatcher::new(MatchingParams { rounds: ROUNDS, ..*params });
        let step = Isometry2::identity();
        Self { matcher, last: None, step, speed: 0.0, way: 0.0, seen: VecDeque::new() }
    }

    /// Takes the next scan. Returns the robot's pose in the frame of the first scan; `None` if it is not known, because
    /// the scan does not match the walls of earlier ones, or shows none.
    pub fn add_scan(&mut self, scan: &Scan) -> Option<Odometry> {
        let points = self.matcher.wall_points(scan, self.way);
        let pose = match &self.last {
            Some(last) => self.matched(scan, &points, last)?,
            None if points.len() < FEWEST => return None,
            None => Odometry::default(),
        };
        if let Some(last) = self.last.replace(pose) {
            self.step = from_robot(&last).inverse() * from_robot(&pose);
            if self.step.rotation.angle().abs() < STRAIGHT {
                self.speed += (self.step.translation.x - self.speed) / 2.0;
            }
            self.way += in_steps(last.distance(&pose));
        }
        self.matcher.forget(self.way - MEMORY);
        self.matcher.add(&points, &pose);
        self.keep(scan, &pose);
        Some(pose)
    }

    /// Keeps a scan, if the robot has moved since the last one that was, and forgets old ones.
    fn keep(&mut self, scan: &Scan, pose: &Odometry) {
        let [metres, radians] = KEPT;
        let is_near = |seen: &SeenScan| {
            seen.pose.distance(pose) < metres && seen.pose.seen(pose.heading).abs() < radians
        };
        if self.seen.back().is_some_and(is_near) {
            return;
        }
        while self.seen.front().is_some_and(|seen| seen.way < self.way - MEMORY) {
            self.seen.pop_front();
        }
        let map_from_robot = from_robot(pose);
        let surfaces = surfaces(scan).map(|point| map_from_robot * point).collect();
        self.seen.push_back(SeenScan { pose: *pose, way: self.way, surfaces });
    }

    /// Where points are seen, by a robot that was at a pose before.
    fn matched(&self, scan: &Scan, points: &[WallPoint], last: &Odometry) -> Option<Odometry> {
        let predicted = driven(last, &self.step);
        let placed = |guess: &Odometry| {
            let pose = self.matcher.matched(points, guess, DEVIATION)?;
            Some((pose, self.matcher.part_on_walls(points, &pose)))
        };
        let direct = placed(&predicted);
        let [metres, radians] = SLOW;
        let is_slow = self.step.translation.vector.norm() < metres
            && self.step.rotation.angle().abs() < radians;
        let is_sure = is_slow && direct.is_some_and(|(_, part)| part >= WELL_MATCHED);
        let searched = || placed(&self.searched(scan, last, &predicted));
        let found = if is_sure { direct } else { searched().or(direct) };
        found.filter(|(_, part)| *part >= LEAST_MATCHED).map(|(pose, _)| pose)
    }

    /// The pose from which most hits lie on surfaces that are known, of those that are searched.
    fn searched(&self, scan: &Scan, last: &Odometry, predicted: &Odometry) -> Odometry {
        let raster = SeenCells::new(last.position.into(), &self.seen);
        let hits = weighted_hits(scan);
        // To drive on as fast is one of the motions: where walls leave the way open, it is the one that is found.
        let rest = self.speed % STEP;
        let mut best = (f64::NEG_INFINITY, *predicted);
        for turn in -TURNS..=TURNS {
            let turn = f64::from(turn) * TURN;
            for (ahead, aside) in AHEAD.flat_map(|ahead| ASIDE.map(move |aside| (ahead, aside))) {
                let shift = Vector2::new(rest + STEP * f64::from(ahead), STEP * f64::from(aside));
                let pose = driven(last, &Isometry2::new(shift, turn));
                let map_from_robot = from_robot(&pose);
                let fit = raster.fit(&hits, &map_from_robot);
                let off =
                    METRE * (shift - self.speed * unit(turn / 2.0)).norm() + RADIAN * turn.abs();
                let score = fit - off;
                if score > best.0 {
                    best = (score, pose);
                }
            }
        }
        best.1
    }
}

/// Where a robot is after a motion in its own frame.
fn driven(pose: &Odometry, step: &Isometry2<f64>) -> Odometry {
    let map_from_robot = from_robot(pose);
    moved(&(map_from_robot * step * map_from_robot.inverse()), pose)
}

/// The pieces of surfaces that a scan hits, each between two hits that are near to each other, in the frame of the robot. Of a
/// wall that rays meet far apart it is not known where it goes on.
fn pieces(scan: &Scan) -> Vec<[Point2<f64>; 2]> {
    let is_near = |hit: &Point2<f64>| distance(scan.scanner(), *hit) <= FAR;
    let hits: Vec<_> = scan.hits().filter(is_near).collect();
    let pieces = hits.windows(2).map(|two| [two[0], two[1]]);
    pieces.filter(|[from, to]| distance(*from, *to) <= ONE_SURFACE).collect()
}

/// Points on the surfaces that a scan hits, in the frame of the robot.
fn surfaces(scan: &Scan) -> impl Iterator<Item = Point2<f64>> {
    pieces(scan).into_iter().flat_map(move |[from, to]| {
        let parts = (2.0 * distance(from, to) / CELL).ceil().max(1.0);
        (0..=parts as usize).map(move |part| from + part as f64 / parts * (to - from))
    })
}

/// The hits of a scan that are searched with, and their weights, whose sum is 1. Those on a wall along a corridor are many, and
/// do not show how far the robot drove: the fewer hits are on surfaces of a direction, the more one of them weighs.
fn weighted_hits(scan: &Scan) -> Vec<(Point2<f64>, f64)> {
    let pieces = pieces(scan);
    let every = pieces.len().div_ceil(SEARCHED).max(1);
    let along = scan.direction_of_walls();
    // Along the walls, across them, or neither.
    let class = |[from, to]: [Point2<f64>; 2]| {
        let off = (angle(to - from) - along).rem_euclid(PI) / FRAC_PI_2;
        let is_near = |direction: f64| (off - direction).abs() < 0.25;
        if is_near(0.0) || is_near(2.0) {
            0
        } else if is_near(1.0) {
            1
        } else {
            2
        }
    };
    let hits: Vec<_> =
        pieces.into_iter().step_by(every).map(|piece| (piece[0], class(piece))).collect();
    let mut counts = [0_usize; 3];
    for &(_, class) in &hits {
        counts[class] += 1;
    }
    let total: f64 = counts.iter().map(|&count| (count as f64).sqrt()).sum();
    let weight = |class: usize| 1.0 / ((counts[class] as f64).sqrt() * total);
    hits.into_iter().map(|(hit, class)| (hit, weight(class))).collect()
}

/// What kept scans show of the cells around a place.
struct SeenCells {
    corner: Point2<f64>,
    cells: Vec<SeenCell>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SeenCell {
    Unknown,
    Free,
    Surface,
}

impl SeenCells {
    const SIDE: i64 = 2 * REACH + 1;

    fn new(centre: Point2<f64>, seen: &VecDeque<SeenScan>) -> Self {
        let corner = centre - Vector2::repeat(REACH as f64 * CELL);
        let cells = vec![SeenCell::Unknown; (Self::SIDE * Self::SIDE) as usize];
        let mut raster = Self { corner, cells };
        for SeenScan { pose, surfaces, .. } in seen {
            let robot = Point2::from(pose.position);
            let every = surfaces.len().div_ceil(RAYS).max(1);
            for hit in surfaces.iter().step_by(every) {
                let steps = (distance(robot, *hit) / CELL) as usize;
                for step in 0..steps {
                    let part = step as f64 / steps as f64;
                    raster.mark(robot + part * (hit - robot), SeenCell::Free);
                }
            }
        }
        for surface in seen.iter().flat_map(|seen| &seen.surfaces) {
            for [x, y] in BLUR {
                raster.mark(surface + CELL * Vector2::new(x, y), SeenCell::Surface);
            }
        }
        raster
    }

    fn mark(&mut self, point: Point2<f64>, cell: SeenCell) {
        if let Some(index) = self.index(point) {
            self.cells[index] = cell;
        }
    }

    /// How well hits fit with what is known, for a robot at a pose: at most 1. Hits in unknown cells fit as well as the others,
    /// nearly.
    fn fit(&self, hits: &[(Point2<f64>, f64)], map_from_robot: &Isometry2<f64>) -> f64 {
        let (mut known, mut surface) = (0.0, 0.0);
        for (hit, weight) in hits {
            match self.index(map_from_robot * hit).map_or(SeenCell::Unknown, |at| self.cells[at]) {
                SeenCell::Unknown => {}
                SeenCell::Free => known += weight,
                SeenCell::Surface => {
                    known += weight;
                    surface += weight;
                }
            }
        }
        if known > 0.0 { surface / known - UNKNOWN * (1.0 - known) } else { -UNKNOWN }
    }

    fn index(&self, point: Point2<f64>) -> Option<usize> {
        let [column, row] = ((point - self.corner) / CELL).map(floor).into();
        let is_in = |at: i64| (0..Self::SIDE).contains(&at);
        (is_in(column) && is_in(row)).then(|| (row * Self::SIDE + column) as usize)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    /// The walls of a corridor with two bends and a side corridor, as pieces along the axes.
    const WALLS: [[f64; 4]; 10] = [
        [0.0, 0.0, 12.0, 0.0],
        [14.0, 0.0, 14.0, 8.0],
        [12.0, 0.0, 12.0, -6.0],
        [14.0, 0.0, 14.0, -6.0],
        [12.0, -6.0, 14.0, -6.0],
        [0.0, 2.0, 12.0, 2.0],
        [12.0, 2.0, 12.0, 10.0],
        [14.0, 8.0, 20.0, 8.0],
        [12.0, 10.0, 20.0, 10.0],
        [0.0, 0.0, 0.0, 2.0],
    ];

    /// The scan of a robot at a pose, half a circle.
    fn scan(pose: &Odometry) -> Scan {
        let [x, y] = pose.position;
        Scan::each_degree(-90, 181, |bearing| {
            let along = unit(pose.heading + bearing);
            let range = |&[x0, y0, x1, y1]: &[f64; 4]| {
                let [across, from, to, at, step] = if x0 == x1 {
                    [(x0 - x) / along.x, y0, y1, y, along.y]
                } else {
                    [(y0 - y) / along.y, x0, x1, x, along.x]
                };
                let hit = at + across * step;
                let is_hit = across > 0.0 && hit >= from.min(to) && hit <= from.max(to);
                if is_hit { across } else { f64::INFINITY }
            };
            WALLS.iter().map(range).fold(f64::INFINITY, f64::min)
        })
    }

    /// A robot that drives to the bend, turns and drives on, so far and with such turns between two scans.
    fn drive(step: f64, turn: f64) -> Vec<Odometry> {
        let mut poses = vec![Odometry { position: [2.0, 1.0], heading: 0.0 }];
        let mut go = |turn: f64, forward: f64, times: usize| {
            for _ in 0..times {
                let last = poses.last().copied().unwrap_or_default();
                poses.push(last.moved(turn, forward));
            }
        };
        go(0.0, step, (11.0 / step).round() as usize);
        go(turn, 0.0, (FRAC_PI_2 / turn).round() as usize);
        go(0.0, step, (8.0 / step).round() as usize);
        poses
    }

    #[test]
    fn scans_show_where_the_robot_drove() {
        for (step, turn) in [(0.05, 0.05), (0.25, 0.1), (0.5, 0.4)] {
            let poses = drive(step, turn);
            let mut motion = ScanMotion::new(&MatchingParams::DEFAULT);
            let map_from_first = from_robot(&poses[0]).inverse();
            let mut worst: [f64; 2] = [0.0; 2];
            for pose in &poses {
                let found = motion.add_scan(&scan(pose)).unwrap();
                let expected = moved(&map_from_first, pose);
                worst[0] = worst[0].max(expected.distance(&found));
                worst[1] = worst[1].max(expected.seen(found.heading).abs());
            }
            assert!(worst[0] < 0.3 && worst[1] < 0.03, "{step}, {turn}: {worst:?}");
        }
    }

    /// From 15 m behind its beginning on, the walls of a corridor do not show how far a robot drives.
    #[test]
    fn along_a_plain_corridor_a_robot_drives_on_as_fast() {
        for speed in [0.3, 0.5, 0.7] {
            let mut motion = ScanMotion::new(&MatchingParams::DEFAULT);
            let driven = (0..60).map(|step| {
                let x = 2.0 + speed * f64::from(step);
                let scan = Scan::each_degree(-180, 360, |bearing| {
                    let (ahead, aside) = (bearing.cos(), bearing.sin());
                    let walls = [(90.0 - x) / ahead, -x / ahead, 1.0 / aside.abs()];
                    walls.into_iter().filter(|range| *range > 0.0).fold(f64::INFINITY, f64::min)
                });
                (speed * f64::from(step), motion.add_scan(&scan).unwrap().position[0])
            });
            let off = driven.map(|(true_way, way)| (true_way - way).abs()).fold(0.0, f64::max);
            assert!(off < 0.02 * 60.0 * speed, "{speed}: {off}");
        }
    }

    #[test]
    fn a_scan_that_shows_no_walls_or_other_ones_has_no_pose() {
        let nothing = Scan::each_degree(-90, 181, |_| f64::INFINITY);
        let mut motion = ScanMotion::new(&MatchingParams::DEFAULT);
        assert_eq!(motion.add_scan(&nothing), None);
        let first = Odometry { position: [2.0, 1.0], heading: 0.0 };
        assert_eq!(motion.add_scan(&scan(&first)), Some(Odometry::default()));
        assert_eq!(motion.add_scan(&nothing), None);
        // Chairs and people all around.
        let clutter =
            Scan::each_degree(-90, 181, |bearing| 1.0 + 9.0 * (77.7 * bearing).fract().abs());
        assert_eq!(motion.add_scan(&clutter), None);
        assert!(motion.add_scan(&scan(&first.moved(0.1, 0.1))).is_some());
    }
}
