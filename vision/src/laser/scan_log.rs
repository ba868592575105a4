//! The scans of a whole log, and what they show around each place of the robot's way.
//!
//! A view of a log is not a view of a robot that drives: the local map holds the scans before it *and* after it, and an arm
//! is certain if the robot drove it on any pass whose scans agree with the map. What is seen at a place depends on the scans
//! near it alone, whatever the log shows before, wherever it begins, and however the frame of its odometry lies:
//!
//! * which scans are used is decided in the order of a hash of their readings, not from the first one on;
//! * the cells of each local map begin at the robot, along the walls that its scan shows.

use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

use nalgebra::{Isometry2, Point2, Vector2};
use toposlam_model::driving::odometry::Odometry;

use super::{
    drift::{DriftMeter, ROUNDS},
    grid::floor,
    local_map::{LocalMap, LocalView, rays},
    matching::ScanMatcher,
    params::{LaserParams, LocalMapParams},
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
}

/// A scan on a local map.
struct PlacedScan {
    robot: Point2<f64>,
    viewpoint: Viewpoint,
    rays: Rays,
}

impl LoggedScan {
    fn placed(&self, map_from_log: &Isometry2<f64>) -> PlacedScan {
        let placed = moved(map_from_log, &self.pose);
        PlacedScan {
            robot: placed.position.into(),
            viewpoint: Viewpoint::new(&self.scan, &placed),
            rays: self.rays.moved(&from_robot(&placed)),
        }
    }
}

/// The side of a square, in metres.
const SQUARE: f64 = 8.0;
/// Another pass agrees with a local map if at least this part of the hits of its scans, where the map is known, lies ...
/// Logs: of passes that are a metre off along a corridor, less does; people and doors that were opened are the rest.
const AGREES: f64 = 0.85;
/// The same where odometry drifts, and passes lie elsewhere. Logs.
const AGREES_IN_DRIFT: f64 = 0.9;
/// ... this near to a wall, in cells.
const NEAR_WALL: i64 = 2;
/// With fewer hits where the map is known it is not known whether it agrees.
const LEAST_HITS: usize = 200;
/// The scans of another pass are this far apart at least, in metres. Geometry: half of a corridor.
const APART: f64 = 0.9;
/// The number of other passes that a map may have: the nearest ones along the way.
const PASSES: usize = 12;

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
            params.matching.rounds = ROUNDS;
        }
        let chosen = choice.finish();
        // Where scans are matched must not depend on the frame of odometry: the axes are along the walls of the first scan.
        let first = chosen.first().filter(|_| params.matching.rounds > 0);
        let frame =
            first.map_or_else(Isometry2::identity, |ChosenScan { scan, odometry, .. }| {
                let heading = odometry.heading + scan.direction_of_walls();
                from_robot(&Odometry { heading, ..*odometry }).inverse()
            });
        let mut matcher = ScanMatcher::new(params.matching);
        let mut log = ScanLog { params, drift, scans: Vec::new(), squares: BTreeMap::new() };
        let mut way = 0.0;
        for ChosenScan { number, scan, odometry, hash } in chosen {
            way += log.scans.last().map_or(0.0, |last| in_steps(last.odometry.distance(&odometry)));
            let placed = moved(&frame, &odometry);
            let pose = matcher.add_scan(&scan, &placed, way, way - params.map.memory);
            let rays = rays(&scan, &Odometry::default(), &params.map);
            log.squares.entry(square(&pose)).or_default().push(log.scans.len());
            log.scans.push(LoggedScan { number, scan, hash, odometry, pose, way, rays });
        }
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
        let LocalView { places, possible_places, width, facts, .. } =
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
        let LocalMap { clearances, .. } = self.local_view(view, false).map;
        clearances.sight(map_from_log * from, direction, limit).0
    }

    /// From the local map of a view to the frame of the log. The robot is at the origin of the map.
    fn log_from_map(&self, view: usize) -> Isometry2<f64> {
        let LoggedScan { scan, pose, .. } = &self.scans[view];
        from_robot(&Odometry { heading: pose.heading + scan.direction_of_walls(), ..*pose })
    }

    fn local_view(&self, view: usize, with_facts: bool) -> LocalView {
        let params = &self.params.map;
        let here = &self.scans[view];
        let map_from_log = self.log_from_map(view).inverse();
        let side = params.window();
        let robot = Point2::origin();
        // What several views agree on must not depend on how the walls lie in the cells.
        let corner = Vector2::repeat(if here.hash.is_multiple_of(2) { 0.0 } else { 0.5 });
        let mut counts = RayCounts::around(robot, side + 2, params.cell, corner);
        let on_map = |scan: &LoggedScan| scan.placed(&map_from_log);
        let on_pass = |other: &&LoggedScan| (other.way - here.way).abs() <= params.memory;
        let mut placed: Vec<PlacedScan> = self.scans.iter().filter(on_pass).map(on_map).collect();
        for scan in &placed {
            counts.add(&scan.rays);
        }
        // Passes are compared with what this one shows, and not with each other.
        let passes = self.other_passes(here).into_iter();
        let passes = passes.map(|pass| pass.into_iter().map(on_map).collect::<Vec<_>>());
        let least = if self.params.matching.rounds > 0 { AGREES_IN_DRIFT } else { AGREES };
        let compared = passes.map(|pass| (Agreement::new(&pass, &counts), pass));
        let (sure, unsure): (Vec<_>, Vec<_>) = compared
            .filter(|(agreement, _)| agreement.part >= least)
            .partition(|(agreement, _)| agreement.widest < params.min_width);
        let local = |counts: &RayCounts, placed: &[PlacedScan]| {
            let grid = counts.window(robot, side, params);
            let (viewpoints, driven): (Vec<_>, Vec<_>) =
                placed.iter().map(|scan| (scan.viewpoint.clone(), scan.robot)).unzip();
            LocalView::new(grid, robot, &viewpoints, &driven, &self.params, with_facts)
        };
        let scans = |passes: Vec<(Agreement, Vec<PlacedScan>)>| {
            passes.into_iter().flat_map(|(_, pass)| pass)
        };
        for scan in scans(sure) {
            counts.add(&scan.rays);
            placed.push(scan);
        }
        // Facts are those of passes that lie on each other beyond doubt.
        let facts = (with_facts && !unsure.is_empty()).then(|| local(&counts, &placed).facts);
        for scan in scans(unsure) {
            counts.add(&scan.rays);
            placed.push(scan);
        }
        let view = local(&counts, &placed);
        LocalView { facts: facts.unwrap_or(view.facts), ..view }
    }

    /// The scans of other passes within the reach of a local map, the nearest pass along the way first: for each pass the
    /// scans without those that are close behind another one.
    fn other_passes(&self, here: &LoggedScan) -> Vec<Vec<&LoggedScan>> {
        let LocalMapParams { reach, memory, .. } = self.params.map;
        let steps = (reach / SQUARE).ceil() as i64;
        let [column, row] = square(&here.pose);
        let squares = (-steps..=steps)
            .flat_map(move |x| (-steps..=steps).map(move |y| [column + x, row + y]));
        let is_other = |other: &LoggedScan| {
            (other.way - here.way).abs() > memory && other.pose.distance(&here.pose) <= reach
        };
        let mut near: Vec<usize> = squares
            .filter_map(|square| self.squares.get(&square))
            .flatten()
            .copied()
            .filter(|&index| is_other(&self.scans[index]))
            .collect();
        near.sort_unstable();
        let passes = near.chunk_by(|one, next| next - one == 1);
        let sparse = |pass: &[usize]| {
            let mut sparse: Vec<&LoggedScan> = Vec::new();
            for scan in pass.iter().map(|&index| &self.scans[index]) {
                if sparse.last().is_none_or(|last| scan.way - last.way >= APART) {
                    sparse.push(scan);
                }
            }
            sparse
        };
        let mut passes: Vec<Vec<&LoggedScan>> = passes.map(sparse).collect();
        let away = |pass: &[&LoggedScan]| {
            pass.iter().map(|scan| (scan.way - here.way).abs()).fold(f64::MAX, f64::min)
        };
        passes.sort_by(|one, other| away(one).total_cmp(&away(other)));
        passes.truncate(PASSES);
        passes
    }
}

/// How far another pass agrees with a map.
struct Agreement {
    /// The part of the hits of its scans that lie on walls, where the map is known.
    part: f64,
    /// The widest wall that it sees in free space, in metres. A pass that lies elsewhere along a corridor sees some where ways
    /// leave it.
    widest: f64,
}

impl Agreement {
    fn new(pass: &[PlacedScan], counts: &RayCounts) -> Self {
        let (mut known, mut on_wall) = (0, 0);
        let mut astray = BTreeSet::new();
        for &hit in pass.iter().flat_map(|scan| &scan.rays.hits) {
            if let Some(is_wall) = counts.is_near_hit(hit, NEAR_WALL) {
                known += 1;
                on_wall += usize::from(is_wall);
                if !is_wall {
                    astray.insert(counts.cell_at(hit));
                }
            }
        }
        let part = if known < LEAST_HITS { 0.0 } else { on_wall as f64 / known as f64 };
        let widths = groups(astray).into_iter().map(|sides| sides.norm());
        Self { part, widest: counts.cell * widths.fold(0.0, f64::max) }
    }
}

/// The sides of the rectangles around the groups of these cells, in cells. Cells of a group are at most [`NEAR_WALL`] apart.
fn groups(mut cells: BTreeSet<[i64; 2]>) -> Vec<Vector2<f64>> {
    let mut groups = Vec::new();
    while let Some(first) = cells.pop_first() {
        let (mut low, mut high) = (first, first);
        let mut open = vec![first];
        while let Some([column, row]) = open.pop() {
            for near in (-NEAR_WALL..=NEAR_WALL)
                .flat_map(|x| (-NEAR_WALL..=NEAR_WALL).map(move |y| [column + x, row + y]))
            {
                if cells.remove(&near) {
                    low = [0, 1].map(|axis| low[axis].min(near[axis]));
                    high = [0, 1].map(|axis| high[axis].max(near[axis]));
                    open.push(near);
                }
            }
        }
        groups.push(Vector2::from([0, 1].map(|axis| (high[axis] - low[axis] + 1) as f64)));
    }
    groups
}

fn square(pose: &Odometry) -> [i64; 2] {
    pose.position.map(|at| floor(at / SQUARE))
}
