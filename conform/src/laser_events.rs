//! Infers events from what a laser scanner shows: visits to junctions, and the doors taken. A visit is decided
//! when several views agree, as those of a camera are.

use std::{
    collections::VecDeque,
    f64::consts::{FRAC_PI_3, PI, TAU},
};

use nalgebra::{Isometry2, Point2};
use toposlam_logs::record::Arrival;
use toposlam_model::{
    driving::{odometry::Odometry, scene::wrapped},
    measurement::HallwayMeasurement,
    percept::Door,
};
use toposlam_robot::measured_hallway::turn;
use toposlam_vision::{
    geometry::{direction, distance},
    laser::{
        params::{CornerParams, LaserParams},
        scan::Scan,
        sensor::{LaserSensor, LaserView},
    },
};

use super::{
    bends::{Bends, PassedBend},
    events::{CheckedEvent, CheckedKind, EventSource, UndecidedCause},
    laser_visit::{PlaceEstimate, Visit, VisitKind, is_same_arm},
    marked_visits::VisitedJunction,
    params::LASER,
    seen_junctions::{SeenJunction, SeenJunctions},
    unseen_way::UnseenWay,
};

/// Infers events from a sequence of scans.
#[derive(Clone, Debug)]
pub struct LaserEvents {
    sensor: LaserSensor,
    params: LaserParams,
    events: Vec<CheckedEvent>,
    /// The junctions of the events.
    visited: Vec<VisitedJunction>,
    /// Junctions, and corners if they are vertices.
    junctions: SeenJunctions,
    /// What are junctions if arms in doubt count.
    possible_junctions: SeenJunctions,
    dead_ends: SeenJunctions,
    /// Bends of the robot's way, which are corners.
    bends: Bends,
    /// The robot's way where the scanner does not look.
    unseen: UnseenWay,
    /// The visit that goes on.
    visit: Option<Visit>,
    /// The visit that goes on of a possible junction.
    possible_visit: Option<Visit>,
    /// The last points of the way since the last visit of a possible junction, each with the length of the way
    /// to there. An arm in doubt may be noticed only behind the junction.
    passed: VecDeque<(f64, Point2<f64>, EventSource)>,
    /// Visits that are over and not decided yet.
    waiting: VecDeque<Visit>,
    /// The way since the last visit, or since the robot turned back after it.
    since: Vec<Point2<f64>>,
    /// Whether the robot has turned back since the last visit.
    turned_back: bool,
    /// The last visit that was decided, and whether the robot has turned back between it and the visits
    /// that were decided to be none.
    last: Option<(PastVisit, bool)>,
    /// The direction to what was behind the robot at first.
    behind: Option<f64>,
    /// The length of the robot's way, in metres.
    way: f64,
    source: EventSource,
    odometry_from_map: Isometry2<f64>,
    /// The centre of the last junction with an event, and the direction in which the robot left, in the frame of
    /// odometry.
    left: Option<(Point2<f64>, Option<f64>)>,
}

/// The place in which a robot is, as the views up to now show it. Points and directions are those of the local map.
#[derive(Clone, Debug, PartialEq)]
pub struct StandingPlace {
    /// Its centre, in metres.
    pub centre: Point2<f64>,
    /// The distance from there to the nearest wall, in metres.
    pub clearance: f64,
    /// What it is.
    pub percept: StandingPercept,
}

/// What the views of a place show.
#[derive(Clone, Debug, PartialEq)]
pub enum StandingPercept {
    /// It is in a corridor.
    Corridor,
    /// The views do not decide what it is.
    Undecided,
    /// A junction with doors in these directions, in radians.
    Junction(Vec<f64>),
}

/// What is known of a junction that was left.
#[derive(Clone, Copy, Debug)]
struct PastVisit {
    centre: Point2<f64>,
    extent: f64,
    exit: f64,
    /// The length of the robot's way when it left.
    left: f64,
}

impl LaserEvents {
    /// A robot that has seen nothing yet.
    #[must_use]
    pub fn new(params: LaserParams) -> Self {
        Self {
            sensor: LaserSensor::new(params),
            params,
            events: Vec::new(),
            visited: Vec::new(),
            junctions: SeenJunctions::new(params.visit),
            possible_junctions: SeenJunctions::new(params.visit),
            dead_ends: SeenJunctions::new(params.visit),
            bends: Bends::new(params.corner),
            unseen: UnseenWay::default(),
            visit: None,
            possible_visit: None,
            passed: VecDeque::new(),
            waiting: VecDeque::new(),
            since: Vec::new(),
            turned_back: false,
            last: None,
            behind: None,
            way: 0.0,
            source: EventSource::default(),
            odometry_from_map: Isometry2::identity(),
            left: None,
        }
    }

    /// Takes the next scan, and the odometry at its time. Returns what the last scans show, as
    /// [`LaserSensor::see`] does.
    pub fn see(
        &mut self,
        source: EventSource,
        scan: &Scan,
        odometry: &Odometry,
    ) -> Option<LaserView> {
        let view = self.sensor.see(scan, odometry)?;
        self.source = source;
        self.odometry_from_map = view.odometry_from_map;
        self.behind.get_or_insert(wrapped(view.robot.heading + PI));
        let robot = Point2::from(view.robot.position);
        if let Some(&last) = self.since.last() {
            self.way += distance(last, robot);
        }
        let (dead_ends, junctions): (Vec<_>, Vec<_>) =
            view.junctions.iter().partition(|junction| junction.arms.len() == 1);
        self.junctions.look(junctions.into_iter(), robot, self.way);
        self.dead_ends.look(dead_ends.into_iter(), robot, self.way);
        let possible = view.possible_junctions.iter();
        let possible = possible.filter(|junction| junction.arms.len() >= 3);
        self.possible_junctions.look(possible, robot, self.way);
        self.leave(robot);
        self.leave_possible_junction(robot);
        self.turn(robot);
        self.since.push(robot);
        if self.params.corner.corners {
            for bend in self.bends.go(robot, self.way, source) {
                self.bend(&bend, &view);
            }
        }
        if self.unseen.go(scan, &view.robot) {
            self.drive_unseen(robot);
        }
        self.enter(robot);
        self.enter_possible_junction(robot);
        while let Some(visit) = self.waiting.pop_front() {
            if visit.exit.is_some_and(|(_, left)| self.way - left < self.params.visit.settle) {
                self.waiting.push_front(visit);
                break;
            }
            self.decide(&visit);
        }
        Some(view)
    }

    /// The place in which the robot is now: a junction, or what looked like one in some view; `None` within a corridor.
    #[must_use]
    pub fn standing(&self) -> Option<StandingPlace> {
        let visit = self.visit.as_ref().or(self.possible_visit.as_ref())?;
        let percept = match self.estimate(visit) {
            Some((PlaceEstimate::Doors(doors), _)) => StandingPercept::Junction(doors),
            Some((PlaceEstimate::Undecided(_), _)) => StandingPercept::Undecided,
            Some((PlaceEstimate::NoVertex, _)) | None => StandingPercept::Corridor,
        };
        Some(StandingPlace { centre: visit.centre, clearance: visit.clearance, percept })
    }

    /// The events, after the last scan.
    #[must_use]
    pub fn finish(self) -> Vec<CheckedEvent> {
        self.finish_with_junctions().0
    }

    /// The events, and the junctions of those that are visits.
    #[must_use]
    pub fn finish_with_junctions(mut self) -> (Vec<CheckedEvent>, Vec<VisitedJunction>) {
        let visits = [self.visit.take(), self.possible_visit.take()];
        self.waiting.extend(visits.into_iter().flatten());
        while let Some(visit) = self.waiting.pop_front() {
            self.decide(&visit);
        }
        (self.events, self.visited)
    }

    /// Ends the visit of a robot that is outside of the junction.
    fn leave(&mut self, robot: Point2<f64>) {
        let Some(mut visit) = self.visit.take() else { return };
        if let Some(known) = self.junctions.at(visit.centre) {
            (visit.centre, visit.clearance) = (known.centre, known.clearance);
        }
        visit.odometry_from_map = self.odometry_from_map;
        if distance(visit.centre, robot) <= inside(visit.clearance) + self.params.visit.leave {
            self.visit = Some(visit);
            return;
        }
        visit.exit = Some((direction(visit.centre, robot), self.way));
        visit.left = self.source;
        self.waiting.push_back(visit);
        self.since.clear();
        self.turned_back = false;
    }

    /// Ends the visit of a robot that is outside of a possible junction.
    fn leave_possible_junction(&mut self, robot: Point2<f64>) {
        let Some(mut visit) = self.possible_visit.take() else { return };
        visit.odometry_from_map = self.odometry_from_map;
        if distance(visit.centre, robot) <= inside(visit.clearance) + self.params.visit.leave {
            self.possible_visit = Some(visit);
            return;
        }
        visit.exit = Some((direction(visit.centre, robot), self.way));
        visit.left = self.source;
        self.waiting.push_back(visit);
        self.passed.clear();
    }

    /// Notices that the robot goes back along its way, and whether it was at a dead end.
    fn turn(&mut self, robot: Point2<f64>) {
        if self.visit.is_some() {
            return;
        }
        let Some(&last) = self.since.last() else { return };
        let mut length = distance(last, robot);
        let ahead = direction(last, robot);
        for piece in self.since.windows(2).rev() {
            length += distance(piece[0], piece[1]);
            let opposite = wrapped(ahead - direction(piece[1], piece[0])).abs() < FRAC_PI_3;
            if opposite
                && length > LASER.turned_back
                && distance_to_piece(robot, piece) < LASER.retraced
            {
                if let Some(visit) = self.visit_of_dead_end() {
                    self.waiting.push_back(visit);
                    self.turned_back = false;
                } else {
                    self.turned_back ^= true;
                }
                self.since.clear();
                return;
            }
        }
    }

    /// The visit of a robot that has turned back at a dead end.
    fn visit_of_dead_end(&self) -> Option<Visit> {
        let within = |end: &SeenJunction| inside(end.clearance).max(self.params.visit.dead_end);
        let off = |end: &SeenJunction, point: &Point2<f64>| distance(end.centre, *point);
        let ends = self
            .since
            .iter()
            .filter_map(|point| self.dead_ends.nearest(*point, within).map(|end| (end, point)));
        let (end, _) =
            ends.min_by(|one, other| off(one.0, one.1).total_cmp(&off(other.0, other.1)))?;
        let arm = direction(end.centre, *self.since.last()?);
        Some(Visit {
            kind: VisitKind::DeadEnd,
            source: self.source,
            centre: end.centre,
            clearance: end.clearance,
            entry: Some(arm),
            exit: Some((arm, self.way)),
            left: self.source,
            turned_back: self.turned_back,
            odometry_from_map: self.odometry_from_map,
        })
    }

    /// Adds what is no visit: the robot may have passed a junction that the scans do not show.
    fn drive_unseen(&mut self, robot: Point2<f64>) {
        self.waiting.push_back(Visit {
            kind: VisitKind::UnseenWay,
            source: self.source,
            centre: robot,
            clearance: 0.0,
            entry: None,
            exit: None,
            left: self.source,
            turned_back: false,
            odometry_from_map: self.odometry_from_map,
        });
    }

    /// Adds the visit of a robot that has passed a corner.
    fn bend(&mut self, bend: &PassedBend, view: &LaserView) {
        let CornerParams { arm, min_way, .. } = self.params.corner;
        let sight = self.params.arm.sight;
        // The log may begin in a room.
        if bend.way < min_way {
            return;
        }
        if self.visit.as_ref().is_some_and(|visit| distance(visit.centre, bend.point) < arm) {
            return;
        }
        let [entry, exit] = bend.arms;
        let in_doubt = bend.arms.iter().any(|back| {
            // A corridor may go straight on there.
            view.clearances.sight(&view.grid, bend.point, back + PI, sight).0 >= sight
        });
        self.waiting.push_back(Visit {
            kind: VisitKind::Bend { way: bend.way, in_doubt },
            source: bend.source,
            centre: bend.point,
            clearance: 0.0,
            entry: Some(entry),
            exit: Some((exit, self.way)),
            left: self.source,
            turned_back: self.turned_back,
            odometry_from_map: self.odometry_from_map,
        });
        self.turned_back = false;
    }

    /// Begins a visit of a robot that is within a junction.
    fn enter(&mut self, robot: Point2<f64>) {
        if self.visit.is_some() {
            return;
        }
        self.visit = self.visit_at(VisitKind::Junction, &self.junctions, robot);
    }

    /// Begins a visit of a robot that is within a possible junction, or was there a short way ago.
    fn enter_possible_junction(&mut self, robot: Point2<f64>) {
        self.passed.push_back((self.way, robot, self.source));
        let memory = 2.0 * self.params.visit.settle;
        while self.passed.front().is_some_and(|(way, ..)| self.way - way > memory) {
            self.passed.pop_front();
        }
        if self.possible_visit.is_some() {
            return;
        }
        let kind = VisitKind::PossibleJunction;
        self.possible_visit = self.passed.iter().find_map(|&(_, point, source)| {
            let visit = self.visit_at(kind, &self.possible_junctions, point)?;
            Some(Visit { source, ..visit })
        });
    }

    /// The visit of a robot that is within one of these places.
    fn visit_at(
        &self,
        kind: VisitKind,
        places: &SeenJunctions,
        robot: Point2<f64>,
    ) -> Option<Visit> {
        let here = places.nearest(robot, |place| inside(place.clearance))?;
        let outside =
            |point: &&Point2<f64>| distance(here.centre, **point) > inside(here.clearance);
        // Where a log begins shows nothing of where the robot came from.
        let before = self.since.iter().rev().find(outside).filter(|_| self.way > LASER.beginning);
        Some(Visit {
            kind,
            source: self.source,
            centre: here.centre,
            clearance: here.clearance,
            entry: before.map(|&point| direction(here.centre, point)),
            exit: None,
            left: self.source,
            turned_back: self.turned_back,
            odometry_from_map: self.odometry_from_map,
        })
    }

    /// What the views show of a visited place, and its extent in metres. If there are more doors with the arms
    /// in doubt than without them, the visit is undecided.
    fn estimate(&self, visit: &Visit) -> Option<(PlaceEstimate, f64)> {
        let seen = self.seen(visit);
        let doors = match (visit.kind, &seen) {
            (VisitKind::PossibleJunction, Some((PlaceEstimate::Undecided(_), _))) => return None,
            (VisitKind::DeadEnd | VisitKind::UnseenWay, _)
            | (_, Some((PlaceEstimate::Undecided(_), _))) => return seen,
            (_, Some((PlaceEstimate::Doors(doors), _))) => doors.len(),
            (VisitKind::Bend { .. }, _) => return seen,
            (_, Some((PlaceEstimate::NoVertex, _)) | None) => 0,
        };
        let possible = self.possible_junctions.at(visit.centre);
        let possible = possible.filter(|known| known.views_of_meet() >= LASER.doubted_views);
        // Without an arm in doubt a possible junction is no visit of its own.
        let seen = seen.filter(|_| visit.kind != VisitKind::PossibleJunction);
        let visit = Visit { kind: VisitKind::PossibleJunction, ..visit.clone() };
        let in_doubt = possible.and_then(|known| {
            let is_more =
                match visit.estimate(&known.arms_of_meet(&self.params.visit), &self.params) {
                    PlaceEstimate::NoVertex => false,
                    PlaceEstimate::Undecided(_) => true,
                    PlaceEstimate::Doors(possible) => possible.len() > doors.max(2),
                };
            let doubt = PlaceEstimate::Undecided(UndecidedCause::UnseenArm);
            is_more.then(|| (doubt, known.extent(&self.params.visit)))
        });
        in_doubt.or(seen)
    }

    /// What the views show of a visited place without the arms in doubt, and its extent in metres.
    fn seen(&self, visit: &Visit) -> Option<(PlaceEstimate, f64)> {
        let params = &self.params.visit;
        let places = match visit.kind {
            VisitKind::Junction | VisitKind::PossibleJunction => &self.junctions,
            VisitKind::DeadEnd => &self.dead_ends,
            VisitKind::UnseenWay => {
                let cause = UndecidedCause::UnseenWay;
                return Some((PlaceEstimate::Undecided(cause), params.same));
            }
            VisitKind::Bend { way, in_doubt } => {
                // A junction where the robot turned is no corner.
                let arm = self.params.corner.arm;
                let is_junction = self.last.is_some_and(|(last, _)| {
                    distance(last.centre, visit.centre) < arm && way <= last.left + arm
                });
                let exit = visit.exit.map(|(exit, _)| exit);
                let estimate = match (is_junction, in_doubt) {
                    (true, _) => PlaceEstimate::NoVertex,
                    (_, true) => PlaceEstimate::Undecided(UndecidedCause::Unclear),
                    _ => PlaceEstimate::Doors(visit.entry.into_iter().chain(exit).collect()),
                };
                return Some((estimate, params.same));
            }
        };
        let known = places.at(visit.centre)?;
        let estimate = match visit.estimate(&known.arms_of_meet(params), &self.params) {
            PlaceEstimate::NoVertex => visit.estimate(&known.arms(params), &self.params),
            estimate => estimate,
        };
        Some((estimate, known.extent(params)))
    }

    /// Adds the events of a visit that is over.
    fn decide(&mut self, visit: &Visit) {
        let exit = visit.exit.map(|(exit, _)| exit);
        if visit.kind == VisitKind::PossibleJunction && self.is_visited_otherwise(visit) {
            return;
        }
        let Some((estimate, extent)) = self.estimate(visit) else { return };
        if matches!(estimate, PlaceEstimate::NoVertex) {
            // It went on, or it turned back there.
            let back = visit.entry.zip(exit).is_some_and(|(entry, exit)| is_same_arm(entry, exit));
            if let Some((_, turned)) = &mut self.last {
                *turned ^= visit.turned_back ^ back;
            }
            return;
        }
        let mut entry = visit.entry;
        let mut turned_back = false;
        if let Some((last, turned)) = &self.last {
            turned_back = turned ^ visit.turned_back;
            // A robot that comes in where it went out, with no junction on the way, has turned back.
            if distance(last.centre, visit.centre) < last.extent {
                turned_back |= entry.is_none_or(|entry| is_same_arm(entry, last.exit));
                entry = entry.or(Some(last.exit));
            }
        }
        let past = |(exit, left)| (PastVisit { centre: visit.centre, extent, exit, left }, false);
        self.last = visit.exit.map(past).or(self.last);
        if visit.kind == VisitKind::PossibleJunction {
            // The next visit does not report it again.
            self.turned_back &= !visit.turned_back;
        }
        if turned_back {
            self.push(visit.source, CheckedKind::TurnedBack);
        }
        match estimate {
            PlaceEstimate::Doors(doors) => self.arrive(visit, doors, entry),
            PlaceEstimate::Undecided(cause) => {
                self.push_junction(visit, &[]);
                self.push(visit.source, CheckedKind::Undecided(cause));
            }
            PlaceEstimate::NoVertex => {}
        }
    }

    /// Whether a visit of a possible junction is also one of a junction, which is decided on its own.
    fn is_visited_otherwise(&self, visit: &Visit) -> bool {
        let reach = 2.0 * self.params.visit.settle;
        let is_near = |centre: Point2<f64>, extent: f64| {
            distance(centre, visit.centre) < inside(visit.clearance).max(extent)
        };
        let left = visit.exit.map_or(self.way, |(_, left)| left);
        let others = self.waiting.iter().chain(&self.visit);
        let is_last = self.last.is_some_and(|(last, _)| {
            is_near(last.centre, last.extent) && (last.left - left).abs() < reach
        });
        let mut others = others.filter(|other| other.kind != VisitKind::PossibleJunction);
        is_last || others.any(|other| is_near(other.centre, inside(other.clearance)))
    }

    /// Adds an arrival at a junction with doors in these directions, and the door taken.
    fn arrive(&mut self, visit: &Visit, mut doors: Vec<f64>, entry: Option<f64>) {
        let nearest = |doors: &[f64], way: f64| {
            let off = |door: f64| wrapped(door - way).abs();
            (0..doors.len()).min_by(|&one, &other| off(doors[one]).total_cmp(&off(doors[other])))
        };
        // A robot whose log begins at the junction has its back to where it came from.
        let Some(entry) = nearest(&doors, entry.or(self.behind).unwrap_or_default()) else {
            return;
        };
        let entry = doors[entry];
        let clockwise = |door: f64| (entry - door).rem_euclid(TAU);
        doors.sort_by(|&one, &other| clockwise(one).total_cmp(&clockwise(other)));
        let arrival = Arrival {
            number: None,
            degree: doors.len() as u32,
            sighting: None,
            form: None,
            entry: Some(wrapped(entry + visit.odometry_from_map.rotation.angle())),
        };
        self.push_junction(visit, &doors);
        let centre = visit.odometry_from_map * visit.centre;
        let hallway = self.left.take().map(|(before, exit)| HallwayMeasurement {
            length: distance(before, centre),
            turn: turn(exit, arrival.entry),
        });
        self.left = Some((centre, None));
        self.push(visit.source, CheckedKind::Arrival { arrival, entry_off: None, hallway });
        if let Some((exit, _)) = visit.exit
            && let Some(door) = nearest(&doors, exit)
        {
            self.left =
                Some((centre, Some(doors[door] + visit.odometry_from_map.rotation.angle())));
            let off = Some(wrapped(doors[door] - exit).abs());
            let door = Door(door as u32);
            self.push(visit.left, CheckedKind::Door { door, number: None, off });
        }
    }

    /// Adds the junction of the next event.
    fn push_junction(&mut self, visit: &Visit, doors: &[f64]) {
        let turn = visit.odometry_from_map.rotation.angle();
        self.visited.push(VisitedJunction {
            event: self.events.len(),
            centre: (visit.odometry_from_map * visit.centre).into(),
            clearance: visit.clearance,
            doors: doors.iter().map(|door| wrapped(door + turn)).collect(),
        });
    }

    fn push(&mut self, source: EventSource, kind: CheckedKind) {
        if matches!(kind, CheckedKind::TurnedBack | CheckedKind::Undecided(_)) {
            self.left = None;
        }
        self.events.push(CheckedEvent { source, kind });
    }
}

/// A robot this near to the centre of a junction is inside, in metres.
fn inside(clearance: f64) -> f64 {
    clearance.max(LASER.inside)
}

/// The distance from a point to a piece of a way.
fn distance_to_piece(point: Point2<f64>, piece: &[Point2<f64>]) -> f64 {
    let [from, to] = piece else { return f64::INFINITY };
    let along = to - from;
    let square = along.norm_squared();
    let part = if square > 0.0 { (point - from).dot(&along) / square } else { 0.0 };
    distance(point, from + part.clamp(0.0, 1.0) * along)
}
