//! A walk, sensed with a laser scanner and compared with the truth: each view, and each visit.

use std::{f64::consts::TAU, sync::Arc};

use nalgebra::Point2;
use toposlam_model::{
    driving::{odometry::Odometry, pose::Pose, scene::wrapped},
    enumerate::Watch,
};
use toposlam_vision::{
    geometry::{distance, motion_between},
    laser::params::LaserParams,
    place::{PlaceView, SeenPlace},
    visits::{Visit, VisitPercept, Visits},
};

use super::{
    super::parallel::made_in_turn,
    corridor_world::{BuildingKind, CorridorWorld},
    walk::{LaserWalk, PassedPlace, clockwise},
};
use crate::{LaserScanner, ScannedBuilding, ScannerParams};

/// Random walks in random buildings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WalkSampler {
    /// Random seed.
    pub seed: u64,
    /// The kind of the buildings.
    pub buildings: BuildingKind,
    /// The number of places that a walk passes.
    pub places: usize,
    /// The greatest drift of the heading of the odometry, in radians a metre.
    pub drift: f64,
    /// The scanner; `None`: of 360 and of 180 degrees in turn.
    pub scanner: Option<ScannerParams>,
    /// How it is sensed.
    pub sensing: LaserParams,
}

/// A walk that was judged.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedWalk {
    /// Its number among the walks of the seed.
    pub number: u64,
    /// The field of view of its scanner, in degrees.
    pub field_of_view: f64,
    /// The visits of junctions with at least three doors.
    pub visits: Vec<JudgedLaserVisit>,
    /// The visits that were derived where there is no junction: their degrees, and the length of the way, in
    /// metres.
    pub invented: Vec<(u32, f64)>,
    /// The views near junctions, and in corridors.
    pub views: Vec<JunctionVerdict>,
    /// The views far from junctions, and how many of them show one nevertheless.
    pub corridor_views: [usize; 2],
}

/// A visit that was judged.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedLaserVisit {
    /// What is there.
    pub features: JunctionFeatures,
    /// The length of the way, in metres.
    pub way: f64,
    /// Its door, and the derived degree and door, if there are any.
    pub door: u32,
    /// What was derived.
    pub found: Option<(u32, Option<u32>)>,
    /// How they compare.
    pub verdict: LaserVerdict,
    /// Whether it was derived correctly that the robot had turned back; `None` without a visit.
    pub turning_right: Option<bool>,
}

/// What a junction is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JunctionFeatures {
    /// The number of its doors.
    pub degree: u32,
    /// Whether it is a round lobby.
    pub is_lobby: bool,
    /// The width of its narrowest and of its widest corridor, in metres.
    pub widths: [f64; 2],
    /// The least angle between two of its corridors, in radians.
    pub least_angle: f64,
    /// Whether the robot left by the door by which it came.
    pub goes_back: bool,
}

/// How a derived visit compares with the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LaserVerdict {
    /// Degree and door are right.
    Right,
    /// It is undecided.
    Undecided,
    /// There is no visit.
    Missed,
    /// Another degree.
    WrongDegree,
    /// Another door.
    WrongDoor,
}

/// How the junction in a view compares with the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum JunctionVerdict {
    /// Its arms are those that are there.
    Right,
    /// No junction is seen there.
    Unseen,
    /// It has other arms.
    Wrong,
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
    /// Judges walks by their numbers on all threads. If the watch stops, some are missing.
    #[must_use]
    pub fn judged(&self, numbers: std::ops::Range<u64>, watch: &dyn Watch) -> Vec<JudgedWalk> {
        made_in_turn(numbers, watch, Some, |number| self.walk(number, watch))
    }

    fn walk_seed(&self, number: u64) -> u64 {
        self.seed.wrapping_mul(1_000_003).wrapping_add(number)
    }

    /// The buildings of runs are others than those of walks.
    pub(super) fn run_seed(&self, number: u64) -> u64 {
        self.walk_seed(number).wrapping_add(500_000)
    }

    /// The parameters of the scanner of a walk or run.
    pub(super) fn scanner_of(&self, number: u64) -> ScannerParams {
        let field_of_view = if number.is_multiple_of(2) { 360.0 } else { 180.0 };
        self.scanner.unwrap_or(ScannerParams { field_of_view, ..ScannerParams::default() })
    }

    /// The walk with this number; `None` if the watch stops.
    fn walk(&self, number: u64, watch: &dyn Watch) -> Option<JudgedWalk> {
        let seed = self.walk_seed(number);
        let world = CorridorWorld::random(self.buildings, seed);
        let walk = LaserWalk::random(&world, self.places, self.drift, seed);
        let params = self.scanner_of(number);
        let building = Arc::new(ScannedBuilding::new(&world.plan, &params, seed));
        let scanner = LaserScanner::new(building, &params, seed);
        let mut visits = Visits::by_laser(self.sensing);
        let (mut views, mut corridor_views) = (Vec::new(), [0; 2]);
        for (number, step) in walk.steps.iter().enumerate() {
            if watch.stop() {
                return None;
            }
            let Ok(scan) = scanner.scan(step.pose, number as u64, step.time) else { continue };
            let Some(view) = visits.see(number, &scan, &step.odometry) else { continue };
            match self.judge_view(&world, step.pose, &view) {
                Some(SeenFrom::Junction(verdict)) => views.push(verdict),
                Some(SeenFrom::Corridor(is_wrong)) => {
                    corridor_views[0] += 1;
                    corridor_views[1] += usize::from(is_wrong);
                }
                None => {}
            }
        }
        let (visits, invented) = compared(&world, &walk, &visits.finish().visits);
        let field_of_view = params.field_of_view;
        Some(JudgedWalk { number, field_of_view, visits, invented, views, corridor_views })
    }

    /// Compares the junctions in a view with the nearest one that is there.
    fn judge_view(&self, world: &CorridorWorld, pose: Pose, view: &PlaceView) -> Option<SeenFrom> {
        let robot = pose.position;
        let junctions = (0..world.places.len()).filter(|&place| world.arms(place).len() >= 3);
        let near = |place: &usize| distance(world.places[*place], robot);
        let place = junctions.min_by(|one, other| near(one).total_cmp(&near(other)))?;
        let range = self.sensing.visit.range;
        let seen = &view.places;
        if near(&place) > FAR {
            let here = |junction: &SeenPlace| {
                distance(junction.centre, view.robot.position) < range + junction.clearance
            };
            return Some(SeenFrom::Corridor(seen.iter().any(here)));
        }
        if near(&place) > range + world.clearance(place) {
            return None;
        }
        let Pose { position, heading } = pose;
        let map_from_plan = motion_between(&Odometry { position, heading }, &view.robot);
        let centre = map_from_plan * Point2::from(world.places[place]);
        let off = |junction: &&SeenPlace| distance(junction.centre, centre);
        let found = seen.iter().filter(|junction| off(junction) < SAME.max(world.clearance(place)));
        let found = found.min_by(|one, other| off(one).total_cmp(&off(other)));
        let Some(found) = found else { return Some(SeenFrom::Junction(JunctionVerdict::Unseen)) };
        let arms = world.arms(place);
        let is_seen = |direction: f64| {
            let direction = direction + map_from_plan.rotation.angle();
            found.directions().any(|arm| wrapped(arm - direction).abs() < SAME_ARM)
        };
        let is_right =
            found.arms.len() == arms.len() && arms.iter().all(|arm| is_seen(arm.direction));
        let verdict = if is_right { JunctionVerdict::Right } else { JunctionVerdict::Wrong };
        Some(SeenFrom::Junction(verdict))
    }
}

/// Where a view was taken, and how it compares.
enum SeenFrom {
    Junction(JunctionVerdict),
    /// Whether it shows a junction.
    Corridor(bool),
}

/// Compares the derived events with the places that the robot passed.
fn compared(
    world: &CorridorWorld,
    walk: &LaserWalk,
    visits: &[Visit<usize>],
) -> (Vec<JudgedLaserVisit>, Vec<(u32, f64)>) {
    let junctions = || walk.passed.iter().filter(|place| place.arms.len() >= 3);
    let mut found: Vec<Vec<Derived>> = vec![Vec::new(); junctions().count()];
    let mut invented = Vec::new();
    for derived in visits.iter().map(|visit| derived(walk, visit)) {
        let off = |(_, place): &(usize, &PassedPlace)| (place.way - derived.way).abs();
        let nearest = junctions().enumerate().min_by(|one, other| off(one).total_cmp(&off(other)));
        match nearest.filter(|place| off(place) < NEAR) {
            Some((number, _)) => found[number].push(derived),
            // What is undecided is no visit.
            None => invented.extend(derived.degree.map(|degree| (degree, derived.way))),
        }
    }
    let mut judged = Vec::new();
    for (place, mut found) in junctions().zip(found) {
        let door = place.door as u32;
        let degree = place.arms.len() as u32;
        let off = |derived: &Derived| (place.way - derived.way).abs();
        let nearest = (0..found.len())
            .min_by(|&one, &other| off(&found[one]).total_cmp(&off(&found[other])))
            .map(|nearest| found.remove(nearest));
        let verdict = match &nearest {
            None => LaserVerdict::Missed,
            Some(Derived { degree: None, .. }) => LaserVerdict::Undecided,
            Some(found) if found.degree != Some(degree) => LaserVerdict::WrongDegree,
            Some(found) if found.door != Some(door) => LaserVerdict::WrongDoor,
            Some(_) => LaserVerdict::Right,
        };
        // A second visit of one junction is one that did not happen.
        invented.extend(found.iter().filter_map(|more| Some((more.degree?, more.way))));
        judged.push(JudgedLaserVisit {
            features: features(world, place),
            way: place.way,
            door,
            found: nearest.and_then(|found| Some((found.degree?, found.door))),
            verdict,
            turning_right: nearest.map(|found| found.turned_back == place.turned_back),
        });
    }
    (judged, invented)
}

/// A derived visit.
#[derive(Clone, Copy, Debug)]
struct Derived {
    /// The length of the way, in metres.
    way: f64,
    /// `None` if it is undecided.
    degree: Option<u32>,
    door: Option<u32>,
    turned_back: bool,
}

fn derived(walk: &LaserWalk, visit: &Visit<usize>) -> Derived {
    let way = walk.steps.get(visit.at).map_or(0.0, |step| step.way);
    let percept = visit.doubt.is_none().then(|| visit.percept());
    let degree = percept.map(|VisitPercept { degree, .. }| degree);
    let door = percept.and_then(|percept| percept.door);
    Derived { way, degree, door, turned_back: !visit.turned_back.is_empty() }
}

fn features(world: &CorridorWorld, passed: &PassedPlace) -> JunctionFeatures {
    let widths = passed.arms.iter().map(|arm| arm.width);
    let next = passed.arms.iter().cycle().skip(1);
    let angles = passed.arms.iter().zip(next);
    let angles = angles.map(|(one, other)| clockwise(one.direction, other.direction));
    JunctionFeatures {
        degree: passed.arms.len() as u32,
        is_lobby: world.is_lobby(passed.place),
        widths: [widths.clone().fold(f64::MAX, f64::min), widths.fold(0.0, f64::max)],
        least_angle: angles.fold(TAU, f64::min),
        goes_back: passed.door == 0,
    }
}

impl JudgedWalk {
    /// The worst of its visits; a junction that is not there is as bad as a missed one.
    #[must_use]
    pub fn verdict(&self) -> LaserVerdict {
        let worst = self.visits.iter().map(|visit| visit.verdict).max();
        let invented = (!self.invented.is_empty()).then_some(LaserVerdict::Missed);
        let turned = self.visits.iter().any(|visit| visit.turning_right == Some(false));
        let turned = turned.then_some(LaserVerdict::Missed);
        worst.max(invented).max(turned).unwrap_or(LaserVerdict::Right)
    }
}

impl LaserVerdict {
    /// Whether degree or door are wrong, or the visit is missing.
    #[must_use]
    pub fn is_wrong(self) -> bool {
        !matches!(self, Self::Right | Self::Undecided)
    }

    /// Its name.
    #[must_use]
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
