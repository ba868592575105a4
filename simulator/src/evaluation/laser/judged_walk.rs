//! A walk, sensed with a laser scanner and compared with the truth: each view, and each visit.

use std::{f64::consts::TAU, sync::Arc};

use toposlam_model::{
    driving::{odometry::Odometry, pose::Pose, scene::wrapped},
    enumerate::Watch,
};
use toposlam_vision::{
    geometry::{clockwise, distance, motion_between, nearest},
    laser::{params::LaserParams, scan_log::ScanLog},
    place::{PlaceView, SeenPlace},
    visits::{Visit, VisitPercept, logged_visits},
};

use super::{
    corridor_world::{BuildingKind, CorridorWorld},
    walk::{LaserWalk, PassedPlace},
};
use crate::{
    LaserScanner, ScannerParams,
    sample_verdict::{SampleTally, SampleVerdict},
};

/// Random walks in random buildings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WalkSampler {
    pub seed: u64,
    pub buildings: BuildingKind,
    /// The number of places that a walk passes.
    pub places: usize,
    /// The greatest drift of the heading of the odometry, in radians a metre.
    pub drift: f64,
    /// The scanner; `None`: of 360 and of 180 degrees in turn.
    pub scanner: Option<ScannerParams>,
    pub sensing: LaserParams,
}

#[derive(Clone, Debug, PartialEq)]
pub struct JudgedWalk {
    pub number: u64,
    /// The field of view of its scanner, in degrees.
    pub field_of_view: f64,
    /// The visits of junctions with at least three doors.
    pub visits: Vec<JudgedLaserVisit>,
    /// The visits that were derived where there is no junction: their degrees, and the length of the way, in
    /// metres.
    pub invented: Vec<(u32, f64)>,
    /// The number of visits that are only possible where there is no junction.
    pub only_possible: usize,
    /// The views near junctions: undecided if no junction is seen there, wrong if it has other arms.
    pub junction_views: SampleTally,
    /// The views far from junctions: wrong if they show one nevertheless.
    pub corridor_views: SampleTally,
}

#[derive(Clone, Debug, PartialEq)]
pub struct JudgedLaserVisit {
    /// The number of doors of the junction.
    pub degree: u32,
    pub is_lobby: bool,
    /// The width of its narrowest and of its widest corridor, in metres.
    pub widths: [f64; 2],
    /// The least angle between two of its corridors, in radians.
    pub least_angle: f64,
    /// The length of the way, in metres.
    pub way: f64,
    /// The door by which the robot left.
    pub door: u32,
    /// The derived degree and door, if there are any.
    pub found: Option<(u32, Option<u32>)>,
    pub verdict: LaserVerdict,
    /// Whether the percept is among those that the scans leave; `None` without a visit.
    pub in_set: Option<bool>,
    /// The number of percepts that the scans leave, no junction among them; 0 if they leave any.
    pub alternatives: usize,
    /// Whether it was derived correctly that the robot had turned back; `None` without a visit.
    pub turning_right: Option<bool>,
}

/// How a derived visit compares with the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LaserVerdict {
    Right,
    Undecided,
    /// There is no visit.
    Missed,
    WrongDegree,
    WrongDoor,
}

/// A derived visit is of the junction that the robot passes within this length of its way, in metres.
const NEAR: f64 = 7.0;
/// Views from farther away than this from all junctions are in corridors, in metres.
const FAR: f64 = 9.0;
/// A junction in a view is one that is at most this far away, in metres.
const SAME: f64 = 2.0;
/// An arm is the true one if their directions differ by less than this, in radians.
const SAME_ARM: f64 = 0.5;

impl WalkSampler {
    fn walk_seed(&self, number: u64) -> u64 {
        self.seed.wrapping_mul(1_000_003).wrapping_add(number)
    }

    /// The buildings of runs are others than those of walks.
    pub(super) fn run_seed(&self, number: u64) -> u64 {
        self.walk_seed(number).wrapping_add(500_000)
    }

    /// The scanner of the walk or run with this number.
    pub(super) fn scanner(&self, world: &CorridorWorld, number: u64, seed: u64) -> LaserScanner {
        let field_of_view = if number.is_multiple_of(2) { 360.0 } else { 180.0 };
        let params =
            self.scanner.unwrap_or(ScannerParams { field_of_view, ..ScannerParams::default() });
        LaserScanner::new(&world.plan, &params, seed)
    }

    /// Makes the walk with this number; `None` if the watch stops.
    pub fn walk(&self, number: u64, watch: &dyn Watch) -> Option<JudgedWalk> {
        let seed = self.walk_seed(number);
        let world = CorridorWorld::random(self.buildings, seed);
        let walk = LaserWalk::random(&world, self.places, self.drift, seed);
        let scanner = self.scanner(&world, number, seed);
        let mut judged = JudgedWalk {
            number,
            field_of_view: scanner.params.field_of_view,
            visits: Vec::new(),
            invented: Vec::new(),
            only_possible: 0,
            junction_views: SampleTally::default(),
            corridor_views: SampleTally::default(),
        };
        let mut steps = Vec::new();
        let mut scans = Vec::new();
        for (number, step) in walk.steps.iter().enumerate() {
            if watch.stop() {
                return None;
            }
            let Ok(scan) = scanner.scan(step.pose, number as u64, step.time) else { continue };
            scans.push((Arc::new(scan), step.odometry));
            steps.push(number);
        }
        let log = ScanLog::new(scans, self.sensing);
        let mut views = Vec::new();
        for number in 0..log.len() {
            if watch.stop() {
                return None;
            }
            let view = log.view(number, false);
            let step = &walk.steps[steps[log.scan(number)]];
            judged.add_view(&world, step.pose, &view, self.sensing.visit.range);
            views.push(view);
        }
        let visits = logged_visits(&log, &views, |scan| steps[scan]).visits;
        judged.compare(&world, &walk, &visits);
        Some(judged)
    }
}

impl JudgedWalk {
    /// Compares the derived visits with the places that the robot passed.
    fn compare(&mut self, world: &CorridorWorld, walk: &LaserWalk, visits: &[Visit<usize>]) {
        let junctions = || walk.passed.iter().filter(|place| place.arms.len() >= 3);
        let way = |visit: &Visit<usize>| walk.steps.get(visit.at).map_or(0.0, |step| step.way);
        let percept = |visit: &Visit<usize>| visit.doubt.is_none().then(|| visit.percept());
        let mut found: Vec<Vec<&Visit<usize>>> = vec![Vec::new(); junctions().count()];
        let mut others = Vec::new();
        for visit in visits {
            let off = |(_, place): &(usize, &PassedPlace)| (place.way - way(visit)).abs();
            match nearest(junctions().enumerate(), off).filter(|place| off(place) < NEAR) {
                Some((number, _)) => found[number].push(visit),
                None => others.push(visit),
            }
        }
        for (place, mut found) in junctions().zip(found) {
            let (door, degree) = (place.door as u32, place.arms.len() as u32);
            let first = nearest(0..found.len(), |&index| (place.way - way(found[index])).abs());
            let first = first.map(|index| found.remove(index));
            let derived = first.and_then(percept);
            let verdict = match derived {
                None if first.is_none() => LaserVerdict::Missed,
                None => LaserVerdict::Undecided,
                Some(derived) if derived.degree != degree => LaserVerdict::WrongDegree,
                Some(derived) if derived.door != Some(door) => LaserVerdict::WrongDoor,
                Some(_) => LaserVerdict::Right,
            };
            // A second visit of one junction is one that did not happen.
            others.append(&mut found);
            let alternatives = first.map(Visit::alternatives);
            let is_true = |seen: &Option<VisitPercept>| {
                let is_door = |seen: VisitPercept| seen.door.is_none_or(|left| left == door);
                seen.is_some_and(|seen| seen.degree == degree && is_door(seen))
            };
            let in_set = alternatives.as_ref().map(|all| all.is_empty() || all.iter().any(is_true));
            let widths = place.arms.iter().map(|arm| arm.width);
            let next = place.arms.iter().cycle().skip(1);
            let angles = place.arms.iter().zip(next);
            let angles = angles.map(|(one, other)| clockwise(one.direction, other.direction));
            self.visits.push(JudgedLaserVisit {
                degree,
                is_lobby: world.is_lobby(place.place),
                widths: [widths.clone().fold(f64::MAX, f64::min), widths.fold(0.0, f64::max)],
                least_angle: angles.fold(TAU, f64::min),
                way: place.way,
                door,
                found: derived.map(|derived| (derived.degree, derived.door)),
                verdict,
                in_set,
                alternatives: alternatives.map_or(0, |all| all.len()),
                turning_right: first.map(|visit| visit.turned_back.is_empty() != place.turned_back),
            });
        }
        for visit in others {
            match percept(visit) {
                Some(percept) => self.invented.push((percept.degree, way(visit))),
                None => self.only_possible += 1,
            }
        }
    }

    /// Compares the junctions in a view, within a range of the robot, with the nearest one that is there.
    fn add_view(&mut self, world: &CorridorWorld, pose: Pose, view: &PlaceView, range: f64) {
        let junctions = (0..world.places.len()).filter(|&place| world.is_junction(place));
        let away = |place: &usize| distance(world.places[*place], pose.position);
        let Some(place) = nearest(junctions, away) else { return };
        let seen = &view.places;
        if away(&place) > FAR {
            let here = |junction: &SeenPlace| {
                distance(junction.centre, view.robot.position) < range + junction.clearance
            };
            self.corridor_views.add(SampleVerdict::right_if(!seen.iter().any(here)));
            return;
        }
        let clearance = world.clearance(place);
        if away(&place) > range + clearance {
            return;
        }
        let Pose { position, heading } = pose;
        let map_from_plan = motion_between(&Odometry { position, heading }, &view.robot);
        let centre = map_from_plan * world.places[place];
        let off = |junction: &&SeenPlace| distance(junction.centre, centre);
        let found = seen.iter().filter(|junction| off(junction) < SAME.max(clearance));
        let verdict = nearest(found, off).map_or(SampleVerdict::Undecided, |found| {
            let arms = world.arms(place);
            let is_seen = |direction: f64| {
                let direction = direction + map_from_plan.rotation.angle();
                found.directions().any(|arm| wrapped(arm - direction).abs() < SAME_ARM)
            };
            let are_seen = arms.iter().all(|arm| is_seen(arm.direction));
            SampleVerdict::right_if(found.arms.len() == arms.len() && are_seen)
        });
        self.junction_views.add(verdict);
    }

    /// The worst of its visits; a junction that is not there is as bad as a missed one.
    pub fn verdict(&self) -> SampleVerdict {
        let worst = self.visits.iter().map(|visit| visit.verdict.verdict()).max();
        let turned = self.visits.iter().any(|visit| visit.turning_right == Some(false));
        let is_wrong = turned || !self.invented.is_empty();
        if is_wrong { SampleVerdict::Wrong } else { worst.unwrap_or(SampleVerdict::Right) }
    }
}

impl LaserVerdict {
    pub fn verdict(self) -> SampleVerdict {
        match self {
            Self::Right => SampleVerdict::Right,
            Self::Undecided => SampleVerdict::Undecided,
            _ => SampleVerdict::Wrong,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Undecided => "undecided",
            Self::Missed => "missed",
            Self::WrongDegree => "wrong degree",
            Self::WrongDoor => "wrong door",
        }
    }
}
