//! The scans of a whole log, and what they show around each place of the robot's way.
//!
//! A view of a log is not a view of a robot that drives: the local map holds the scans before it *and* after it, and an arm
//! is certain if the robot drove it on any pass whose scans agree with the map. What is seen at a place depends on the scans
//! near it alone, whatever the log shows before, wherever it begins, and however the frame of its odometry lies:
//!
//! * which scans are used is decided in the order of a hash of their readings, not from the first one on, and so is which of
//!   them are keyframes;
//! * the cells of each local map begin at the robot, along the walls that its scan shows.
//!
//! Whether another pass is of the same place, and how it lies there, is found once for each keyframe.

use std::{
    cell::LazyCell,
    collections::BTreeMap,
    ops::Range,
    sync::{Arc, OnceLock},
};

use nalgebra::{Isometry2, Point2, Vector2};
use toposlam_model::driving::odometry::Odometry;

use super::{
    drift::{DriftMeter, ROUNDS},
    grid::floor,
    local_map::{LocalScans, LocalView, LocalWays, rays},
    matching::{ScanMatcher, WallPoint},
    params::{LaserParams, LocalMapParams},
    passes::{OwnPass, own_walls},
    ray_counts::{RayCounts, Rays},
    scan::Scan,
    scan_choice::{ChosenScan, ScanChoice},
    viewpoint::Viewpoint,
};
use crate::{
    geometry::{from_robot, in_steps, motion_between, moved},
    place::{PlaceFacts, PlaceView, SeenPlace},
};

/// All scans of a log that are used. Points are in metres in the frame in which they were placed: that of odometry, or of
/// scan matching if odometry drifts.
#[derive(Clone, Debug)]
pub struct ScanLog {
    params: LaserParams,
    drift: Option<f64>,
    scans: Vec<LoggedScan>,
    /// The scans that were taken in a square, by its column and row.
    squares: BTreeMap<[i64; 2], Vec<usize>>,
    /// In the order of the scans.
    keyframes: Vec<Keyframe>,
}

#[derive(Clone, Debug)]
struct LoggedScan {
    /// Its number among all scans of the log.
    number: usize,
    scan: Arc<Scan>,
    hash: u64,
    odometry: Odometry,
    /// Where the robot was.
    pose: Odometry,
    /// The length of the robot's way until then, in metres.
    way: f64,
    /// In the robot's frame.
    rays: Rays,
    /// In the robot's frame.
    walls: Vec<WallPoint>,
}

/// A scan at which other passes are looked for.
#[derive(Clone, Debug)]
struct Keyframe {
    /// The index of the scan.
    scan: usize,
    /// The other passes that agree with its own one, once they are asked for.
    passes: OnceLock<Vec<Pass>>,
}

/// Another pass by the place of a keyframe whose scans agree with the scans around that keyframe.
#[derive(Clone, Debug)]
struct Pass {
    /// The indices of its scans.
    scans: Vec<usize>,
    /// The small motion that lays its walls on those around the keyframe.
    correction: Isometry2<f64>,
    /// Whether it agrees beyond doubt.
    is_sure: bool,
}

/// A scan on a local map.
struct PlacedScan<'a> {
    map_from_robot: Isometry2<f64>,
    viewpoint: Viewpoint,
    rays: &'a Rays,
}

impl LoggedScan {
    fn placed(&self, map_from_log: &Isometry2<f64>) -> PlacedScan<'_> {
        let placed = moved(map_from_log, &self.pose);
        PlacedScan {
            map_from_robot: from_robot(&placed),
            viewpoint: Viewpoint::new(&self.scan, &placed),
            rays: &self.rays,
        }
    }
}

impl PlacedScan<'_> {
    fn robot(&self) -> Point2<f64> {
        self.map_from_robot.translation.vector.into()
    }
}

/// The side of a square, in metres.
const SQUARE: f64 = 8.0;
/// Another pass agrees with a local map if at least this part of the hits of its scans, where the map is known, lies near
/// walls. Logs: people and doors that were opened are the rest.
const AGREES: f64 = 0.85;
/// The same where odometry drifts, and passes lie elsewhere. Logs.
const AGREES_IN_DRIFT: f64 = 0.9;
/// A pass of which so many hits do is left where odometry lays it. Logs.
const AGREES_WELL: f64 = 0.95;
/// The scans of another pass are this far apart at least, in metres. Geometry: half of a corridor.
const APART: f64 = 0.9;
/// The number of other passes that a map may have: the nearest ones along the way.
const PASSES: usize = 12;
/// A scan is a keyframe if its hash is the least of those within this length of the way, in metres. Geometry: a corridor's width.
const KEYFRAME: f64 = 2.0;

/// Takes the scans of a log. It keeps only those that are used, and the last ones.
#[derive(Clone, Debug)]
pub struct ScanLogBuilder {
    params: LaserParams,
    meter: DriftMeter,
    choice: ScanChoice,
}

impl ScanLogBuilder {
    pub fn new(params: LaserParams) -> Self {
        let choice = ScanChoice::new(&params.map);
        Self { params, meter: DriftMeter::new(params), choice }
    }

    /// Takes the next scan, and the odometry at its time.
    pub fn add(&mut self, scan: Arc<Scan>, odometry: Odometry) {
        if self.params.matching.rounds == 0 {
            self.meter.add_scan(&scan, &odometry);
        }
        self.choice.add(scan, odometry);
    }

    /// The log of all scans. They are matched with each other if the heading of odometry drifts by more than
    /// [`MatchingParams::max_drift`](super::params::MatchingParams::max_drift).
    #[must_use]
    pub fn finish(self) -> ScanLog {
        let Self { mut params, meter, choice } = self;
        let drift = meter.finish().filter(|&drift| drift > params.matching.max_drift);
        if drift.is_some() {
            params = params.for_matched_scans();
            params.matching.rounds = ROUNDS;
        }
        let chosen = choice.finish();
        if let Some(first) = chosen.first() {
            params = params.for_range(first.scan.geometry().range_max);
        }
        // Where scans are matched must not depend on the frame of odometry: the axes are along the walls of the first scan.
        let first = chosen.first().filter(|_| params.matching.rounds > 0);
        let frame =
            first.map_or_else(Isometry2::identity, |ChosenScan { scan, odometry, .. }| {
                let heading = odometry.heading + scan.direction_of_walls();
                from_robot(&Odometry { heading, ..*odometry }).inverse()
            });
        let mut matcher = ScanMatcher::new(params.matching);
        let (squares, keyframes) = (BTreeMap::new(), Vec::new());
        let mut log = ScanLog { params, drift, scans: Vec::new(), squares, keyframes };
        let mut way = 0.0;
        for ChosenScan { number, scan, odometry, hash } in chosen {
            way += log.scans.last().map_or(0.0, |last| in_steps(last.odometry.distance(&odometry)));
            let placed = moved(&frame, &odometry);
            let pose = matcher.add_scan(&scan, &placed, way, way - params.map.memory);
            let rays = rays(&scan, &params.map);
            let walls = matcher.wall_points(&scan, way);
            log.squares.entry(square(&pose)).or_default().push(log.scans.len());
            log.scans.push(LoggedScan { number, scan, hash, odometry, pose, way, rays, walls });
        }
        log.keyframes = log.chosen_keyframes();
        log
    }
}

impl ScanLog {
    /// The scans of a log in their order, each with the odometry at its time: see [`ScanLogBuilder`].
    pub fn new(
        scans: impl IntoIterator<Item = (Arc<Scan>, Odometry)>,
        params: LaserParams,
    ) -> Self {
        let mut builder = ScanLogBuilder::new(params);
        for (scan, odometry) in scans {
            builder.add(scan, odometry);
        }
        builder.finish()
    }

    pub fn params(&self) -> &LaserParams {
        &self.params
    }

    /// The drift of the heading of odometry in 10 m, in radians, if scans are matched because of it.
    pub fn drift(&self) -> Option<f64> {
        self.drift
    }

    /// The number of views: of scans that are used.
    pub fn len(&self) -> usize {
        self.scans.len()
    }

    pub fn is_empty(&self) -> bool {
        self.scans.is_empty()
    }

    /// The number of a view's scan among all scans of the log. The view must exist.
    pub fn scan(&self, view: usize) -> usize {
        self.scans[view].number
    }

    /// What the log shows around the place of a view, which must exist; with [`PlaceView::facts`] or without them, which take a
    /// quarter of the time.
    pub fn view(&self, view: usize, with_facts: bool) -> PlaceView {
        let LoggedScan { scan, odometry, pose, .. } = &self.scans[view];
        let log_from_map = self.log_from_map(view);
        let (LocalView { places, possible_places, width, .. }, facts) =
            self.local_view(view, with_facts);
        let on_log = |places: Vec<SeenPlace>| {
            places.into_iter().map(|place| place.moved(&log_from_map)).collect()
        };
        let facts = facts.map(|PlaceFacts { driven, not_ended }| PlaceFacts {
            driven: on_log(driven),
            not_ended: on_log(not_ended),
        });
        PlaceView {
            robot: *pose,
            odometry_from_map: motion_between(pose, odometry),
            places: on_log(places),
            possible_places: on_log(possible_places),
            facts,
            sector: scan.sector(),
            width,
            scene: None,
        }
    }

    /// How far one sees around the place of a view, which must exist, from a point in a direction and up to a limit, in metres.
    pub fn sight(&self, view: usize, from: Point2<f64>, direction: f64, limit: f64) -> f64 {
        let map_from_log = self.log_from_map(view).inverse();
        let direction = direction + map_from_log.rotation.angle();
        let (LocalView { map, .. }, _) = self.local_view(view, false);
        map.clearances.sight(map_from_log * from, direction, limit).0
    }

    /// From the local map of a view to the frame of the log. The robot is at the origin of the map.
    fn log_from_map(&self, view: usize) -> Isometry2<f64> {
        let LoggedScan { scan, pose, .. } = &self.scans[view];
        from_robot(&Odometry { heading: pose.heading + scan.direction_of_walls(), ..*pose })
    }

    /// The local map of a view by the scans of its own pass.
    fn own_map(
        &self,
        view: usize,
        map_from_log: &Isometry2<f64>,
    ) -> (RayCounts, Vec<PlacedScan<'_>>) {
        let params = &self.params.map;
        // What several views agree on must not depend on how the walls lie in the cells.
        let corner = if self.scans[view].hash.is_multiple_of(2) { 0.0 } else { 0.5 };
        let (side, corner) = (params.window() + 2, Vector2::repeat(corner));
        let mut counts = RayCounts::around(Point2::origin(), side, params.cell, corner);
        let own = self.scans[self.own_pass(view)].iter();
        let placed: Vec<PlacedScan<'_>> = own.map(|scan| scan.placed(map_from_log)).collect();
        for scan in &placed {
            counts.add(scan.rays, &scan.map_from_robot);
        }
        (counts, placed)
    }

    fn local_view(&self, view: usize, with_facts: bool) -> (LocalView, Option<PlaceFacts>) {
        let params = &self.params.map;
        let map_from_log = self.log_from_map(view).inverse();
        let (mut counts, mut placed) = self.own_map(view, &map_from_log);
        let own = self.own_pass(view);
        let (sure, unsure): (Vec<&Pass>, Vec<&Pass>) =
            self.passes_beside(view).iter().partition(|pass| pass.is_sure);
        let is_split = !unsure.is_empty();
        let add = |counts: &mut RayCounts, placed: &mut Vec<_>, passes: Vec<&Pass>| {
            for Pass { scans, correction, .. } in passes {
                let map_from_log = map_from_log * correction;
                // Some may be of another pass for the keyframe, and of this one here.
                let others = scans.iter().filter(|scan| !own.contains(scan));
                let others = others.map(|&scan| self.scans[scan].placed(&map_from_log));
                for scan in others {
                    counts.add(scan.rays, &scan.map_from_robot);
                    placed.push(scan);
                }
            }
        };
        let local = |counts: &RayCounts, placed: &[PlacedScan<'_>]| {
            let robot = Point2::origin();
            let grid = counts.window(robot, params.window(), params);
            let (viewpoints, driven) =
                placed.iter().map(|scan| (scan.viewpoint.clone(), scan.robot())).unzip();
            let (felt, params) = (Vec::new(), &self.params);
            LocalWays::new(grid, LocalScans { robot, viewpoints, driven, felt, params })
        };
        add(&mut counts, &mut placed, sure);
        // Facts are those of passes that lie on each other beyond doubt.
        let facts = (with_facts && is_split).then(|| local(&counts, &placed).facts());
        add(&mut counts, &mut placed, unsure);
        let ways = local(&counts, &placed);
        let facts = facts.or_else(|| with_facts.then(|| ways.facts()));
        (ways.view(), facts)
    }

    /// The scans of the pass of a view that are in its local map.
    fn own_pass(&self, view: usize) -> Range<usize> {
        // The scans are in the order of the robot's way.
        self.along_way(self.scans[view].way, self.params.map.memory)
    }

    /// The scans that are at most so far from a place along the robot's way.
    fn along_way(&self, way: f64, within: f64) -> Range<usize> {
        let first = self.scans.partition_point(|scan| way - scan.way > within);
        first..self.scans.partition_point(|scan| scan.way - way <= within)
    }

    fn chosen_keyframes(&self) -> Vec<Keyframe> {
        let rank = |scan: usize| (self.scans[scan].hash, scan);
        let is_least = |&scan: &usize| {
            let near = self.along_way(self.scans[scan].way, KEYFRAME);
            near.map(rank).min() == Some(rank(scan))
        };
        let chosen = (0..self.scans.len()).filter(is_least);
        chosen.map(|scan| Keyframe { scan, passes: OnceLock::new() }).collect()
    }

    /// The other passes that agree with the pass of the nearest keyframe along the way.
    fn passes_beside(&self, view: usize) -> &[Pass] {
        let way = |scan: usize| self.scans[scan].way;
        let away = |keyframe: &Keyframe| (way(keyframe.scan) - way(view)).abs();
        let after = self.keyframes.partition_point(|keyframe| keyframe.scan < view);
        let beside = self.keyframes[after.saturating_sub(1)..].iter().take(2);
        let nearest = beside.min_by(|one, other| away(one).total_cmp(&away(other)));
        nearest.map_or(&[], |Keyframe { scan, passes }| {
            passes.get_or_init(|| self.agreeing_passes(*scan))
        })
    }

    fn agreeing_passes(&self, keyframe: usize) -> Vec<Pass> {
        let passes = self.other_passes(&self.scans[keyframe]);
        if passes.is_empty() {
            return Vec::new();
        }
        let LaserParams { map, matching, .. } = &self.params;
        let least = if matching.rounds > 0 { AGREES_IN_DRIFT } else { AGREES };
        let log_from_map = self.log_from_map(keyframe);
        let map_from_log = log_from_map.inverse();
        let (counts, _) = self.own_map(keyframe, &map_from_log);
        // Passes are compared with what this one shows, and not with each other.
        let own_pass = OwnPass::new(&counts, map);
        let on_map = |scan: usize| moved(&map_from_log, &self.scans[scan].pose);
        let walls = LazyCell::new(|| {
            let own = self.apart(self.own_pass(keyframe));
            let walls = own.into_iter().map(|scan| (&self.scans[scan].walls[..], on_map(scan)));
            own_walls(walls, matching)
        });
        let mut agreeing = Vec::new();
        for scans in passes {
            let hits = |map_from_log: &Isometry2<f64>| -> Vec<[i64; 2]> {
                let placed = scans.iter().map(|&scan| &self.scans[scan]);
                let motion = |scan: &LoggedScan| from_robot(&moved(map_from_log, &scan.pose));
                own_pass.hits(placed.map(|scan| (&scan.rays, motion(scan))))
            };
            let (mut correction, mut on_walls) = (Isometry2::identity(), hits(&map_from_log));
            if own_pass.part_on_walls(&on_walls).is_none_or(|part| part < AGREES_WELL) {
                let points = scans.iter().flat_map(|&scan| {
                    let map_from_robot = from_robot(&on_map(scan));
                    self.scans[scan].walls.iter().map(move |wall| wall.moved(&map_from_robot))
                });
                let moved = own_pass.correction(&walls, points) * map_from_log;
                (correction, on_walls) = (log_from_map * moved, hits(&moved));
            }
            if let Some(widest) = own_pass.widest_astray(&on_walls, least) {
                agreeing.push(Pass { scans, correction, is_sure: widest < map.min_width });
            }
        }
        agreeing
    }

    /// The scans of other passes within the reach of a local map, the nearest pass along the way first: for each pass the
    /// scans without those that are close behind another one.
    fn other_passes(&self, here: &LoggedScan) -> Vec<Vec<usize>> {
        let LocalMapParams { reach, memory, .. } = self.params.map;
        let steps = (reach / SQUARE).ceil() as i64;
        let [column, row] = square(&here.pose);
        let squares = (-steps..=steps)
            .flat_map(move |x| (-steps..=steps).map(move |y| [column + x, row + y]));
        let away = |scan: usize| (self.scans[scan].way - here.way).abs();
        let is_other = |&scan: &usize| {
            away(scan) > memory && self.scans[scan].pose.distance(&here.pose) <= reach
        };
        let mut near: Vec<usize> = squares
            .filter_map(|square| self.squares.get(&square))
            .flatten()
            .copied()
            .filter(is_other)
            .collect();
        near.sort_unstable();
        let passes = near.chunk_by(|one, next| next - one == 1);
        let mut passes: Vec<Vec<usize>> =
            passes.map(|pass| self.apart(pass.iter().copied())).collect();
        let nearest = |pass: &[usize]| pass.iter().map(|&scan| away(scan)).fold(f64::MAX, f64::min);
        passes.sort_by(|one, other| nearest(one).total_cmp(&nearest(other)));
        passes.truncate(PASSES);
        passes
    }

    /// The scans of a pass without those that are close behind another one.
    fn apart(&self, pass: impl IntoIterator<Item = usize>) -> Vec<usize> {
        let mut some: Vec<usize> = Vec::new();
        for scan in pass {
            let behind = |&last: &usize| self.scans[scan].way - self.scans[last].way;
            if some.last().is_none_or(|last| behind(last) >= APART) {
                some.push(scan);
            }
        }
        some
    }
}

fn square(pose: &Odometry) -> [i64; 2] {
    pose.position.map(|at| floor(at / SQUARE))
}
