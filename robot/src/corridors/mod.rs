//! A robot that maps a network of corridors by its laser scanner alone: at any angle, with up to eight doors at a junction.
//! It goes on with what it derives, right or wrong.
//!
//! It drives along the middle line of its local map until it is within what may be a junction. There it turns around once,
//! and drives into each arm of which it does not see enough, until it has driven as far as makes an arm, or cannot go on. If
//! its scanner does not see far enough for arms, it stops where any ways meet, and drives into each of them. A detector of
//! its own reports the marker. Bends are no vertices, and dead ends are.

mod params;
mod trail;

use std::{
    f64::consts::{PI, TAU},
    sync::Arc,
};

use nalgebra::{Isometry2, Point2};
use toposlam_logs::record::{Arrival, EventKind, Frame, RunObserver};
use toposlam_model::{
    driving::{
        algorithm2::FrameKind,
        odometry::Odometry,
        scene::{MarkerView, wrapped},
    },
    mapping::{MapWalk, MappedWorld, MappingError, MappingEvent, Relocate},
    percept::{Door, Percept, Sighting},
    world::World,
};
use toposlam_vision::{
    geometry::{direction, distance, from_robot, unit},
    laser::{
        local_map::LocalMap,
        navigation::{OpeningLimits, WayAhead, WayChoice, along},
        params::LaserParams,
        scan::Scan,
        sensor::LaserSensor,
    },
    params::ROBOT_RADIUS,
    place::{Certainty, PlaceArm, SeenPlace},
    visits::Visits,
};

use crate::{
    budget::{Allowance, Spent},
    capture::{RETAKES, Unusable, capture},
    event_log::EventLog,
    explorer::{CorridorFailure, ExplorerError, MappingRobot},
    robot::{Robot, RobotError},
    run_settings::RunSettings,
};
pub use params::CorridorParams;
use trail::Trail;

/// A robot that explores a network of corridors. Directions are those of the frame of odometry.
#[derive(Clone, Debug)]
pub struct CorridorExplorer<R, O = ()> {
    robot: R,
    log: EventLog<O>,
    params: LaserParams,
    visits: Visits<LaserSensor, ()>,
    trail: Trail,
    /// The length of the way, in metres.
    way: f64,
    /// The direction in which it drove last.
    heading: f64,
    /// Whether its scanner sees arms far enough, and all round; known after the first scan.
    sees_arms: bool,
    sees_all_round: bool,
    /// From the local map to the frame of odometry, in the last view.
    odometry_from_map: Isometry2<f64>,
    /// What may be junctions, in each view since it began to look around.
    seen: Vec<Vec<SeenPlace>>,
    /// Where any ways meet near the robot, in each of these views.
    openings: Vec<Option<SeenPlace>>,
    /// The place that it left last, while it is near, on the local map.
    left: Option<LeftPlace>,
    /// Where it turned around last, on the local map, and the length of its way then.
    looked: Option<(Point2<f64>, f64)>,
    /// Whether the last view shows an opening beside it into which its scanner may not have looked.
    is_at_opening: bool,
    /// What it has seen on a side trip while it was near the place where that began.
    side_trip: Option<SideTrip>,
    /// The marker where it was seen last, and the length of the way then.
    marker: Option<(Point2<f64>, f64)>,
    /// The place where it stands, with the directions of its doors, clockwise from the one by which it came in.
    place: Option<StoodAt>,
    last_move: u64,
    moves: u64,
    door: Option<Door>,
    allowance: Allowance,
    last: Option<Frame>,
}

#[derive(Clone, Debug)]
struct StoodAt {
    centre: Point2<f64>,
    extent: f64,
    doors: Vec<f64>,
}

#[derive(Clone, Copy, Debug)]
struct LeftPlace {
    centre: Point2<f64>,
    extent: f64,
    is_junction: bool,
}

#[derive(Clone, Debug)]
struct SideTrip {
    from: Point2<f64>,
    visits: Visits<LaserSensor, ()>,
    near: Vec<(Arc<Scan>, Odometry)>,
}

/// How a stretch of the way ended.
enum StretchEnd {
    /// It cannot go on. Up to the wall are so many metres.
    Blocked(f64),
    /// Beside an opening, where it has looked around.
    LookedAround,
    /// Within what may be a junction, and the direction from there to where it came in.
    AtPlace(SeenPlace, f64),
}

/// Why the robot stops: an error, or it does not know where it is.
enum Stop {
    Failure(CorridorFailure),
    Error(ExplorerError),
}

impl From<RobotError> for Stop {
    fn from(error: RobotError) -> Self {
        Self::Error(error.into())
    }
}

impl From<CorridorFailure> for Stop {
    fn from(failure: CorridorFailure) -> Self {
        Self::Failure(failure)
    }
}

const ROBOT: CorridorParams = CorridorParams::DEFAULT;
/// A robot that is stopped tries these directions to both sides of its way, in radians.
const BESIDE: [f64; 3] = [0.35, 0.7, 1.05];

impl<R: Robot, O: RunObserver> CorridorExplorer<R, O> {
    /// A robot in a corridor, which looks towards its first junction.
    pub fn new(robot: R, params: &LaserParams, observer: O) -> Self {
        let heading = robot.odometry().odometry.heading;
        Self {
            robot,
            log: EventLog::new(observer),
            params: *params,
            visits: Visits::by_laser(*params),
            trail: Trail::default(),
            way: 0.0,
            heading,
            sees_arms: false,
            sees_all_round: false,
            odometry_from_map: Isometry2::identity(),
            seen: Vec::new(),
            openings: Vec::new(),
            left: None,
            looked: None,
            is_at_opening: false,
            side_trip: None,
            marker: None,
            place: None,
            last_move: 0,
            moves: 0,
            door: None,
            allowance: Allowance::default(),
            last: None,
        }
    }

    /// The moves that ended at a junction or a dead end, with those of recoveries and audits.
    pub fn moves(&self) -> u64 {
        self.moves
    }

    /// The length of the way, in metres.
    pub fn way(&self) -> f64 {
        self.way
    }

    pub fn into_parts(self) -> (R, O) {
        (self.robot, self.log.observer)
    }

    /// Maps the building, from the first junction to which the robot comes. Returns the state of the algorithm, too.
    ///
    /// # Errors
    /// Returns an error if the run ended before the map was complete.
    pub fn map(
        &mut self,
        settings: &RunSettings,
    ) -> (MapWalk, Result<MappedWorld, MappingError<ExplorerError>>) {
        self.map_building(settings)
    }

    fn spent(&self) -> Spent {
        Spent::new(self.last_move as f64, self.robot.odometry().time, self.way)
    }

    fn error(&self, stop: Stop) -> ExplorerError {
        match stop {
            Stop::Error(ExplorerError::Robot(RobotError::Stopped)) => {
                ExplorerError::Stopped { moves: self.last_move }
            }
            Stop::Error(error) => error,
            Stop::Failure(cause) => {
                ExplorerError::NoJunction { moves: self.last_move, door: self.door, cause }
            }
        }
    }

    /// Where it is, in the frame of odometry.
    fn at(&self) -> Point2<f64> {
        self.robot.odometry().odometry.position.into()
    }

    /// Where it is on the local map.
    fn on_local_map(&self) -> Point2<f64> {
        self.odometry_from_map.inverse() * self.at()
    }

    /// The angle from the local map to the frame of odometry.
    fn turn_of_map(&self) -> f64 {
        self.odometry_from_map.rotation.angle()
    }

    fn local_map(&self) -> Option<&LocalMap> {
        self.visits.sensor().map()
    }

    /// Drives away in a direction until it is at a junction or a dead end.
    fn drive(&mut self, towards: f64) -> Result<(), Stop> {
        self.place = None;
        if self.trail.len() == 0 {
            self.sense()?;
        }
        self.heading = towards;
        let (first, mut begin) = (self.trail.len(), self.at());
        let mut is_leaving = true;
        let mut tried: Option<Point2<f64>> = None;
        // The way from there without what it drove to look into arms, in metres.
        let mut along = 0.0;
        loop {
            let end = self.drive_on(is_leaving)?;
            is_leaving = false;
            along += distance(begin, self.at());
            begin = self.at();
            match end {
                StretchEnd::AtPlace(place, entry) => {
                    if let Some(doors) = self.decide(&place, entry)? {
                        let centre = self.odometry_from_map * place.centre;
                        self.place = Some(StoodAt { centre, extent: place.clearance, doors });
                        return Ok(());
                    }
                    begin = self.at();
                }
                StretchEnd::LookedAround => {}
                StretchEnd::Blocked(to_wall) => {
                    let at = self.at();
                    let is_new = tried.is_none_or(|tried| distance(tried, at) > ROBOT.no_junction);
                    if is_new && along > ROBOT.bend_after && self.finds_bend()? {
                        tried = Some(at);
                        is_leaving = true;
                    } else {
                        along += to_wall;
                        break;
                    }
                }
            }
            if self.way > ROBOT.longest_way {
                return Err(CorridorFailure::TooFar.into());
            }
        }
        if along < self.params.arm.min_arm {
            self.drive_back(first)?;
            let centre = self.on_local_map();
            self.left = Some(LeftPlace { centre, extent: 1.0, is_junction: true });
            return Err(CorridorFailure::Alcove.into());
        }
        self.left = None;
        let at = self.at();
        // Its heading may be that of a short way to look at something.
        let before = self.trail.before_entering(at, ROBOT.near_place);
        let back = before.map_or(wrapped(self.heading + PI), |before| direction(at, before));
        self.place = Some(StoodAt { centre: at, extent: 1.0, doors: vec![back] });
        Ok(())
    }

    /// Whether a robot that cannot go straight on sees another way than the one back, once it has looked around. Then it
    /// looks there.
    fn finds_bend(&mut self) -> Result<bool, Stop> {
        let at = self.at();
        let before = self.trail.before_entering(at, ROBOT.look_ahead);
        let back = before.map_or(wrapped(self.heading + PI), |before| direction(at, before));
        self.look_around()?;
        let choice = WayChoice {
            towards: wrapped(back + PI - self.turn_of_map()),
            aside: PI - ROBOT.same_way,
            measured: ROBOT.bend_length,
        };
        let robot = self.on_local_map();
        let way = self.local_map().and_then(|map| map.way_ahead(robot, &choice));
        let to = way.and_then(|way| along(&way.line, ROBOT.bend_length));
        let to = to.filter(|to| distance(robot, *to) > ROBOT.bend_length / 2.0);
        if let Some(to) = to {
            self.heading = wrapped(direction(robot, to) + self.turn_of_map());
        }
        Ok(to.is_some())
    }

    /// Drives on until it is in the middle of what may be a junction, if it comes to one.
    fn drive_on(&mut self, mut is_leaving: bool) -> Result<StretchEnd, Stop> {
        let mut closest: Option<(f64, SeenPlace)> = None;
        let noticed = self.trail.len();
        loop {
            if let Some(to_wall) = self.step(is_leaving)? {
                match closest {
                    Some(_) => break,
                    None => return Ok(StretchEnd::Blocked(to_wall)),
                }
            }
            is_leaving = false;
            let place = if self.sees_arms {
                self.visits.status()
            } else {
                self.openings.last().cloned().flatten()
            };
            let place = place.filter(|place| !self.is_left(place));
            let place = place.map(|place| (distance(place.centre, self.on_local_map()), place));
            match (place, &closest) {
                (None, None) if self.is_at_opening && self.sees_arms => {
                    self.look_around()?;
                    return Ok(StretchEnd::LookedAround);
                }
                (None, None) => {}
                (Some(place), None) => closest = Some(place),
                (Some(place), Some((least, _))) if place.0 < *least => closest = Some(place),
                _ => break,
            }
            if self.way > ROBOT.longest_way {
                return Err(CorridorFailure::TooFar.into());
            }
        }
        let Some((_, mut place)) = closest else { return Err(CorridorFailure::Missed.into()) };
        if self.sees_arms {
            let entry = self.came_from(&place);
            self.go_to(&place)?;
            return Ok(StretchEnd::AtPlace(place, entry));
        }
        self.see_all_of(&mut place)?;
        // It drove past the step that is nearest to the centre, and goes back.
        let centre = self.odometry_from_map * place.centre;
        let past = self.trail.nearest(noticed, centre).map_or(noticed, |nearest| nearest + 1);
        let end = self.trail.len();
        self.trail.end_side_trip(past.min(end));
        let entry = self.came_from(&place);
        self.go_to(&place)?;
        self.trail.end_side_trip(past.min(end));
        Ok(StretchEnd::AtPlace(place, entry))
    }

    /// Goes a step along its way. Returns the distance to the wall in metres if it cannot go on.
    fn step(&mut self, is_leaving: bool) -> Result<Option<f64>, Stop> {
        let robot = self.on_local_map();
        let turn = self.turn_of_map();
        let Some(map) = self.local_map() else { return Ok(Some(0.0)) };
        let towards = wrapped(self.heading - turn);
        let choice = if is_leaving {
            WayChoice { towards, aside: ROBOT.leaving, measured: ROBOT.leaving_measured }
        } else {
            WayChoice { towards, aside: ROBOT.bend, measured: ROBOT.look_ahead }
        };
        let straight = || {
            let room = map.room_ahead(robot, towards, ROBOT.to_wall, ROBOT.look_ahead);
            WayAhead { line: vec![robot, robot + room * unit(towards)], clearance: ROBOT.to_wall }
        };
        let way = map.way_ahead(robot, &choice).unwrap_or_else(straight);
        let Some(target) = along(&way.line, ROBOT.look_ahead) else { return Ok(Some(0.0)) };
        let left = distance(robot, target);
        if left < ROBOT.at_end {
            return Ok(Some(left + way.clearance));
        }
        let beyond = along(&way.line, 2.0 * ROBOT.look_ahead).unwrap_or(target);
        let (target, beyond) = (self.odometry_from_map * target, self.odometry_from_map * beyond);
        let before = self.at();
        self.step_to(target)?;
        let driven = distance(before, self.at());
        if driven < ROBOT.stuck && !self.passes_beside(direction(before, target))? {
            return Ok(Some(way.clearance));
        }
        self.heading = if driven < ROBOT.stuck {
            direction(before, target)
        } else if distance(self.at(), beyond) > ROBOT.look_ahead / 2.0 {
            direction(self.at(), beyond)
        } else {
            direction(before, self.at())
        };
        Ok(None)
    }

    /// Whether a robot that is stopped where its map shows nothing, as by glass, passes a little beside it.
    fn passes_beside(&mut self, ahead: f64) -> Result<bool, Stop> {
        for aside in BESIDE.into_iter().flat_map(|aside| [aside, -aside]) {
            let before = self.at();
            self.step_to(before + ROBOT.look_ahead * unit(ahead + aside))?;
            if distance(before, self.at()) >= ROBOT.step / 2.0 {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Turns to a point, goes up to a step towards it, and takes a scan.
    fn step_to(&mut self, point: Point2<f64>) -> Result<(), Stop> {
        let at = self.robot.odometry().odometry;
        let length = distance(at.position, point);
        if length < 1e-3 {
            return Ok(());
        }
        let mut turn = at.seen(direction(at.position, point));
        // A scanner that does not see all round sees what it passes while it turns.
        while !self.sees_all_round && turn.abs() > ROBOT.turn {
            let part = ROBOT.turn.copysign(turn);
            self.robot.turn(part)?;
            self.sense()?;
            turn = self.robot.odometry().odometry.seen(direction(at.position, point));
        }
        if turn.abs() > ROBOT.straight {
            self.robot.turn(turn)?;
        }
        self.robot.forward(length.min(ROBOT.step))?;
        self.way += distance(at.position, self.at());
        self.heading = self.robot.odometry().odometry.heading;
        self.sense()
    }

    /// Drives to points, one after the other, as far as it can.
    fn drive_along(&mut self, points: impl IntoIterator<Item = Point2<f64>>) -> Result<(), Stop> {
        for point in points {
            loop {
                let before = self.at();
                if distance(before, point) < ROBOT.at_point {
                    break;
                }
                self.step_to(point)?;
                if distance(before, self.at()) < ROBOT.stuck {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Drives back to where it was when its trail had this number of points.
    fn drive_back(&mut self, begin: usize) -> Result<(), Stop> {
        let back = self.trail.back_to(begin.saturating_sub(1), ROBOT.step);
        self.drive_along(back)
    }

    /// Drives on past an opening, so that its other side is on the local map, too.
    fn see_all_of(&mut self, opening: &mut SeenPlace) -> Result<(), Stop> {
        let begin = self.way;
        while self.way - begin < ROBOT.past_opening && self.step(false)?.is_none() {}
        let within = ROBOT.past_opening + ROBOT.near_opening;
        if let Some(seen) = self.opening(within)
            && !self.is_left(&seen)
        {
            *opening = seen;
        }
        Ok(())
    }

    /// Where any ways of the local map meet this near to the robot.
    fn opening(&self, near: f64) -> Option<SeenPlace> {
        let limits = OpeningLimits { near, together: ROBOT.one_opening };
        self.local_map()?.opening(self.on_local_map(), limits)
    }

    /// Goes to the centre of a place, if it can stand there.
    fn go_to(&mut self, place: &SeenPlace) -> Result<(), Stop> {
        let has_space =
            self.local_map().is_some_and(|map| map.has_space_at(place.centre, 2.0 * ROBOT_RADIUS));
        let centre = self.odometry_from_map * place.centre;
        if has_space && distance(centre, self.at()) > 0.2 {
            self.drive_along([centre])?;
        }
        Ok(())
    }

    /// The directions of the doors of the place where it stands, clockwise from the entry; `None` if it is no junction.
    fn decide(&mut self, place: &SeenPlace, entry: f64) -> Result<Option<Vec<f64>>, Stop> {
        let mut place = place.clone();
        let doors = if self.sees_arms {
            self.doors_of(&mut place, entry)
        } else {
            self.driven_doors(&place, entry)
        };
        let is_junction = self.sees_arms || !matches!(doors, Ok(None));
        let SeenPlace { centre, clearance: extent, .. } = place;
        self.left = Some(LeftPlace { centre, extent, is_junction });
        // It goes on where it would have gone.
        self.heading = wrapped(entry + PI);
        doors
    }

    /// The same if the robot drives into each way that leaves an opening, the one straight on last.
    fn driven_doors(&mut self, opening: &SeenPlace, entry: f64) -> Result<Option<Vec<f64>>, Stop> {
        self.look_around()?;
        let mut doors = vec![entry];
        let mut tried: Vec<f64> = Vec::new();
        for _ in 0..ROBOT.looks {
            let is_old = |way: f64, old: f64| wrapped(way - old).abs() < ROBOT.same_way;
            let is_new = |way: &f64| !doors.iter().chain(&tried).any(|&old| is_old(*way, old));
            let mut ways: Vec<f64> =
                self.ways_of(opening).into_iter().filter(|way| is_new(way)).collect();
            if doors.len() + ways.len() < 3 {
                break;
            }
            let straight_on = |way: f64| wrapped(way - entry - PI).abs();
            ways.sort_by(|&one, &other| straight_on(other).total_cmp(&straight_on(one)));
            let Some(&way) = ways.first() else { break };
            let (driven, is_arm) = self.look_into(way, true)?;
            tried.push(way);
            if is_arm && !doors.iter().any(|&door| is_same(door, driven)) {
                doors.push(driven);
            }
        }
        Ok((doors.len() >= 3).then(|| in_order(doors, entry)))
    }

    /// The directions of the ways that leave an opening in at least two of the views there.
    fn ways_of(&self, opening: &SeenPlace) -> Vec<f64> {
        let mut ways: Vec<(f64, usize)> = Vec::new();
        let here = |seen: &&SeenPlace| distance(seen.centre, opening.centre) < ROBOT.same_place;
        for seen in self.openings.iter().flatten().filter(here) {
            for direction in seen.directions() {
                match ways.iter_mut().find(|way| wrapped(way.0 - direction).abs() < ROBOT.same_way)
                {
                    Some(way) => way.1 += 1,
                    None => ways.push((direction, 1)),
                }
            }
        }
        let turn = self.turn_of_map();
        ways.into_iter().filter(|way| way.1 > 1).map(|way| wrapped(way.0 + turn)).collect()
    }

    /// The same by what the robot sees. The place becomes the one that it has seen last.
    fn doors_of(&mut self, last: &mut SeenPlace, entry: f64) -> Result<Option<Vec<f64>>, Stop> {
        self.look_around()?;
        // The directions of the arms that it has looked into, and whether they are arms.
        let mut known: Vec<(f64, bool)> = Vec::new();
        let (mut has_moved, mut tries) = (false, 0);
        for _ in 0..ROBOT.looks {
            let Some(place) = self.visits.status() else {
                let robot = self.on_local_map();
                let off = |seen: &&SeenPlace| distance(seen.centre, robot);
                let near = nearest(self.seen.last().into_iter().flatten(), off)
                    .filter(|seen| off(seen) < ROBOT.same_place && !has_moved);
                let Some(seen) = near.cloned() else { return Ok(None) };
                has_moved = true;
                self.go_to(&seen)?;
                self.look_around()?;
                continue;
            };
            let turn = self.turn_of_map();
            last.clone_from(&place);
            let is_known = |arm: f64| known.iter().any(|known| is_same(known.0, arm));
            let uncertain = self.uncertain_arms(&place).into_iter().map(|arm| wrapped(arm + turn));
            let next = uncertain.into_iter().find(|&arm| !is_same(arm, entry) && !is_known(arm));
            if let Some(arm) = next {
                let (_, is_arm) = self.look_into(arm, false)?;
                known.push((arm, is_arm));
                continue;
            }
            let is_undecided = place.arms.iter().any(|arm| arm.certainty == Certainty::Possible);
            if is_undecided && known.is_empty() {
                if tries == 2 {
                    return Err(CorridorFailure::Undecided.into());
                }
                tries += 1;
                self.look_from_further(entry + PI * f64::from(tries))?;
                continue;
            }
            let doors: Vec<f64> = if is_undecided {
                let view = self.seen.last().map(Vec::as_slice).unwrap_or_default();
                seen_at(view, &place).into_iter().flat_map(SeenPlace::directions).collect()
            } else {
                place.arms.iter().filter(|arm| arm.is_certain()).map(|arm| arm.direction).collect()
            };
            let mut doors: Vec<f64> = doors.into_iter().map(|door| wrapped(door + turn)).collect();
            for &(arm, is_arm) in &known {
                if !is_arm {
                    doors.retain(|&door| !is_same(door, arm));
                } else if !doors.iter().any(|&door| is_same(door, arm)) {
                    doors.push(arm);
                }
            }
            return Ok((doors.len() >= 3).then(|| in_order(doors, entry)));
        }
        Err(CorridorFailure::Undecided.into())
    }

    /// Drives into an arm and back. Returns the direction in which it drove, and whether it could drive as far as makes an
    /// arm. If the place is to be seen from nearby only, what is seen from farther away is forgotten.
    fn look_into(&mut self, towards: f64, from_nearby: bool) -> Result<(f64, bool), Stop> {
        let (first, begin, way) = (self.trail.len(), self.at(), self.way);
        if from_nearby {
            let visits = self.visits.clone();
            self.side_trip = Some(SideTrip { from: begin, visits, near: Vec::new() });
        }
        self.heading = towards;
        let least = self.params.arm.min_arm;
        let mut is_arm = self.way - way >= least;
        let mut is_leaving = true;
        while !is_arm {
            let to_wall = self.step(is_leaving)?;
            is_leaving = false;
            is_arm = self.way - way + to_wall.unwrap_or_default() >= least;
            if to_wall.is_some() {
                break;
            }
        }
        let far = self.at();
        self.drive_back(first)?;
        self.drive_along([begin])?;
        self.trail.end_side_trip(first);
        if let Some(SideTrip { visits, near, .. }) = self.side_trip.take() {
            self.visits = visits;
            for (scan, odometry) in near {
                if let Some(view) = self.visits.add_frame((), &scan, &odometry) {
                    self.odometry_from_map = view.odometry_from_map;
                }
            }
        }
        self.look_around()?;
        // It may have gone through the middle of the place first.
        let driven =
            if distance(begin, far) > ROBOT.step { direction(begin, far) } else { towards };
        Ok((driven, is_arm))
    }

    /// Goes a little further, looks around there, and comes back.
    fn look_from_further(&mut self, towards: f64) -> Result<(), Stop> {
        let begin = self.at();
        let way = self.way;
        self.heading = towards;
        let mut is_leaving = true;
        while self.way - way < ROBOT.further && self.step(is_leaving)?.is_none() {
            is_leaving = false;
        }
        self.turn_around()?;
        self.drive_along([begin])?;
        self.look_around()
    }

    fn look_around(&mut self) -> Result<(), Stop> {
        self.looked = Some((self.on_local_map(), self.way));
        self.seen.clear();
        self.openings.clear();
        self.turn_around()?;
        self.is_at_opening = false;
        Ok(())
    }

    /// Turns around once where it is.
    fn turn_around(&mut self) -> Result<(), Stop> {
        let parts = if self.sees_all_round { ROBOT.round_views } else { ROBOT.sector_views };
        for _ in 0..parts {
            self.robot.turn(TAU / parts as f64)?;
            self.sense()?;
        }
        Ok(())
    }

    /// The directions of the arms of a place on the local map that are not certain in most of the last views.
    fn uncertain_arms(&self, place: &SeenPlace) -> Vec<f64> {
        let views = &self.seen[self.seen.len().saturating_sub(ROBOT.views)..];
        // The direction, the number of views that show the arm, and of those in which it is certain.
        let mut arms: Vec<(f64, usize, usize)> = Vec::new();
        for seen in views.iter().filter_map(|view| seen_at(view, place)) {
            for arm @ &PlaceArm { direction, .. } in &seen.arms {
                let certain = usize::from(arm.is_certain());
                match arms.iter_mut().find(|known| is_same(known.0, direction)) {
                    Some(known) => (known.1, known.2) = (known.1 + 1, known.2 + certain),
                    None => arms.push((direction, 1, certain)),
                }
            }
        }
        let enough = (ROBOT.certain * views.len() as f64).ceil() as usize;
        let uncertain = arms.iter().filter(|arm| arm.1 > 1 && arm.2 < enough);
        uncertain.map(|&(arm, ..)| arm).collect()
    }

    /// The direction from a place to where the robot was before.
    fn came_from(&self, place: &SeenPlace) -> f64 {
        let centre = self.odometry_from_map * place.centre;
        // It may have passed the place at a distance.
        let last = self.trail.without_side_trips().next().map_or(0.0, |at| distance(at, centre));
        let far = (place.clearance.max(1.0) + ROBOT.came_from).max(last + 0.1);
        let before = self.trail.before_entering(centre, far);
        before.map_or(wrapped(self.heading + PI), |point| direction(centre, point))
    }

    /// Whether a place is the one that it left last.
    fn is_left(&self, place: &SeenPlace) -> bool {
        self.left.is_some_and(|left| {
            let reach = if left.is_junction {
                ROBOT.left_behind.max(1.5 * left.extent)
            } else {
                ROBOT.no_junction
            };
            distance(left.centre, place.centre) < reach
        })
    }

    /// Takes a scan, and what it shows.
    fn sense(&mut self) -> Result<(), Stop> {
        if self.log.observer.stop() {
            return Err(RobotError::Stopped.into());
        }
        let (frame, scan) = self.look()?;
        let Frame { odometry, marker, .. } = frame;
        self.emit(EventKind::Frame(frame));
        self.sees_arms = scan.geometry().range_max >= ROBOT.sees_arms;
        self.sees_all_round = scan.field_of_view() > ROBOT.all_around;
        self.trail.push(odometry.position.into());
        if let Some(MarkerView { position, .. }) = marker {
            self.marker = Some((from_robot(&odometry) * Point2::from(position), self.way));
        }
        if let Some(view) = self.visits.add_frame((), &scan, &odometry) {
            self.odometry_from_map = view.odometry_from_map;
            // What is far from the place is not on its map.
            let is_near = self.side_trip.as_mut().is_none_or(|trip| {
                let is_near = distance(trip.from, odometry.position) <= ROBOT.near_place;
                if is_near {
                    trip.near.push((scan.clone(), odometry));
                }
                is_near
            });
            if is_near && self.sees_arms {
                self.is_at_opening = self.is_opening();
            } else if is_near {
                self.openings.push(self.opening(ROBOT.near_opening));
            }
            if is_near {
                self.seen.push(view.possible_places);
            }
        }
        let at = self.on_local_map();
        if self.left.is_some_and(|LeftPlace { centre, extent, .. }| {
            distance(centre, at) > extent + 2.0 * ROBOT.left_behind
        }) {
            self.left = None;
        }
        Ok(())
    }

    /// Whether the last view shows ways that meet where the robot is, if its scanner does not look behind it and it has not
    /// turned around nearby.
    fn is_opening(&self) -> bool {
        let robot = self.on_local_map();
        let has_looked = self.looked.is_some_and(|(at, way)| {
            distance(at, robot) < ROBOT.looked && self.way - way < ROBOT.look_memory
        });
        !has_looked
            && !self.sees_all_round
            && self.local_map().is_some_and(|map| map.meets_near(robot, ROBOT.opening))
    }

    /// A scan that was taken since the robot last moved.
    fn look(&mut self) -> Result<(Frame, Arc<Scan>), Stop> {
        let mut last = Unusable::Missing;
        for _ in 0..RETAKES {
            match capture(&mut self.robot, self.last.as_ref()) {
                Ok(frame) => {
                    if let Some(scan) = frame.scan.clone() {
                        self.last = Some(frame.clone());
                        return Ok((frame, scan));
                    }
                }
                Err(Unusable::Robot(error)) => return Err(error.into()),
                Err(unusable) => last = unusable,
            }
        }
        let cause = last.cause(FrameKind::Scan);
        let (moves, door, frame) = (self.last_move, self.door, FrameKind::Scan);
        Err(Stop::Error(ExplorerError::NoImage { moves, door, images: RETAKES, cause, frame }))
    }

    /// What the robot sees of the marker at the place where it stands.
    fn sighting(&self, StoodAt { centre, extent, doors }: &StoodAt) -> Sighting {
        let is_here = |(at, way): &(Point2<f64>, f64)| {
            distance(*at, *centre) < extent + ROBOT.marker_range
                && self.way - way < ROBOT.marker_memory
        };
        let Some((at, _)) = self.marker.filter(is_here) else { return Sighting::Nothing };
        let towards = direction(*centre, at);
        let door = nearest(0..doors.len(), |&door| wrapped(doors[door] - towards).abs());
        door.map_or(Sighting::Nothing, |door| Sighting::Pointing(Door(door as u32)))
    }

    /// Reports that it stands at a place, after the move with this number if it is known.
    fn report_arrival(&mut self, number: Option<u64>) {
        let Some(place) = self.place.clone() else { return };
        let percept = Percept { degree: place.doors.len() as u32, sighting: self.sighting(&place) };
        let spent = self.spent();
        self.allowance.perceive(percept, spent);
        self.emit(EventKind::Arrival(Arrival {
            number: number.and_then(|number| u32::try_from(number).ok()),
            degree: percept.degree,
            sighting: Some(percept.sighting),
            shape: None,
            entry: place.doors.first().copied(),
        }));
    }

    /// The place where it stands. At the very start, it drives to its first one.
    fn place(&mut self) -> Result<StoodAt, ExplorerError> {
        if self.place.is_none() && self.last_move == 0 {
            let heading = self.heading;
            self.drive(heading).map_err(|stop| self.error(stop))?;
            self.report_arrival(Some(0));
        }
        self.place.clone().ok_or_else(|| self.error(CorridorFailure::Missed.into()))
    }
}

impl<R: Robot, O: RunObserver> MappingRobot for CorridorExplorer<R, O> {
    fn allowance(&mut self) -> &mut Allowance {
        &mut self.allowance
    }

    fn moves_made(&self) -> [u64; 2] {
        [self.last_move, self.moves]
    }

    fn report(&mut self, journey: &MapWalk, event: MappingEvent) {
        self.log.mapping(&self.robot, journey, event);
    }

    fn emit(&mut self, kind: EventKind) {
        self.log.emit(&self.robot, kind);
    }
}

impl<R: Robot, O: RunObserver> World for CorridorExplorer<R, O> {
    type Error = ExplorerError;

    fn percept(&mut self) -> Result<Percept, ExplorerError> {
        let place = self.place()?;
        Ok(Percept { degree: place.doors.len() as u32, sighting: self.sighting(&place) })
    }

    fn traverse(&mut self, door: Door) -> Result<(), ExplorerError> {
        let place = self.place()?;
        let Some(&towards) = place.doors.get(door.0 as usize) else {
            return Err(self.error(CorridorFailure::Missed.into()));
        };
        let spent = self.spent();
        if let Some(limit) = self.allowance.forbids(door, spent) {
            let (moves, is_at_marker) = (self.last_move, false);
            return Err(ExplorerError::Budget { moves, limit, is_at_marker });
        }
        self.allowance.leave(door, spent);
        self.last_move += 1;
        self.door = Some(door);
        let number = u32::try_from(self.last_move).ok();
        self.emit(EventKind::Door { number, door });
        if let Err(stop) = self.drive(towards) {
            self.allowance.lose_way();
            return Err(self.error(stop));
        }
        self.moves += 1;
        self.report_arrival(Some(self.last_move));
        Ok(())
    }
}

impl<R: Robot, O: RunObserver> Relocate for CorridorExplorer<R, O> {
    /// Drives on, or back, until it derives a junction or comes to a dead end.
    fn relocate(&mut self, error: ExplorerError) -> Result<(), ExplorerError> {
        let can_go_on = match &error {
            ExplorerError::NoJunction { cause, .. } => *cause != CorridorFailure::TooFar,
            _ => false,
        };
        if !can_go_on {
            return Err(error);
        }
        for number in 0..ROBOT.tries {
            let towards = if number % 2 == 0 { self.heading } else { self.heading + PI };
            match self.drive(wrapped(towards)) {
                Ok(()) => {
                    // How many moves lead there is not known.
                    self.report_arrival(None);
                    return Ok(());
                }
                Err(Stop::Failure(cause)) if cause != CorridorFailure::TooFar => {}
                Err(stop) => return Err(self.error(stop)),
            }
        }
        Err(error)
    }
}

/// What may be a junction at a place, in a view.
fn seen_at<'v>(view: &'v [SeenPlace], place: &SeenPlace) -> Option<&'v SeenPlace> {
    let off = |seen: &&SeenPlace| distance(seen.centre, place.centre);
    nearest(view, off).filter(|seen| off(seen) < place.clearance.max(ROBOT.at_centre))
}

fn nearest<T>(all: impl IntoIterator<Item = T>, off: impl Fn(&T) -> f64) -> Option<T> {
    all.into_iter().min_by(|one, other| off(one).total_cmp(&off(other)))
}

fn is_same(one: f64, other: f64) -> bool {
    wrapped(one - other).abs() < ROBOT.same_arm
}

/// Directions clockwise from the one that is nearest to the entry.
fn in_order(mut doors: Vec<f64>, entry: f64) -> Vec<f64> {
    let first = nearest(doors.iter().copied(), |door| wrapped(door - entry).abs());
    let first = first.unwrap_or(entry);
    let turn = |door: f64| {
        let turn = (first - door).rem_euclid(TAU);
        if turn > TAU - 1e-9 { 0.0 } else { turn }
    };
    doors.sort_by(|&one, &other| turn(one).total_cmp(&turn(other)));
    doors
}
