//! A robot that maps a building by its laser scanner alone: it goes on with what it derives, right or wrong.
//!
//! It drives along a corridor until it is within what may be a junction. There it turns around once, and drives into
//! each arm of which it does not see enough, until it has driven as far as makes an arm, or cannot go on. If its scanner
//! does not see far enough for arms, it stops where any ways meet, and drives into each of them. A pilot keeps it on the
//! floor, and a detector of its own reports the marker.

use std::{
    f64::consts::{PI, TAU},
    ops::Range,
    sync::Arc,
};

use nalgebra::{Isometry2, Point2, Vector2};
use thiserror::Error;
use toposlam_logs::record::{
    Arrival, Event, EventId, EventKind, Frame, RunEnd, RunEnding, RunObserver, nanoseconds,
};
use toposlam_model::{
    driving::{odometry::Odometry, pose::Pose, scene::wrapped},
    embedded_graph::Dart,
    mapping::Relocate,
    percept::{Door, Percept, Sighting},
    world::World,
};
use toposlam_vision::{
    geometry::{direction, distance, motion_between},
    laser::{
        params::LaserParams,
        scan::Scan,
        sensor::LaserSensor,
        way_graph::{WayGraph, WayNode},
    },
    place::{Certainty, PlaceArm, PlaceView, SeenPlace},
    visits::Visits,
};

use super::{
    corridor_pilot::{CorridorPilot, PilotLeg},
    corridor_world::{CorridorWorld, SmoothedWorld},
    nearest,
    robot_params::LaserRobotParams,
    walk::{WalkDriver, WalkStep, clockwise},
};
use crate::LaserScanner;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub(super) enum ScanFailure {
    #[error("no junction is seen")]
    Missed,
    #[error("the number of doors is undecided")]
    Undecided,
    #[error("the door is that of an alcove")]
    Alcove,
    #[error("the run takes too long")]
    TooFar,
    #[error("the run was ended")]
    Stopped,
}

/// What the robot has derived, compared with the truth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PerceptTally {
    pub percepts: u64,
    /// Those whose number of doors is wrong, or that are of no junction.
    pub wrong: u64,
    /// The junctions that it passed without noticing them.
    pub passed: u64,
}

/// A robot that maps a building by its scans.
pub(super) struct LaserRobot<'w> {
    world: &'w CorridorWorld,
    smoothed: &'w SmoothedWorld,
    pilot: CorridorPilot<'w>,
    scanner: LaserScanner,
    visits: Visits<LaserSensor, ()>,
    pub(super) driver: WalkDriver,
    params: LaserParams,
    /// The facing dart: where the marker lies.
    facing: Dart,
    observer: &'w mut dyn RunObserver,
    /// The number of events that were observed, and of moves.
    events: u64,
    moves: u64,
    sensed: usize,
    /// Whether its scanner sees arms far enough.
    sees_arms: bool,
    /// Where it stands if it drives into an arm from there only to see how far it leads.
    drives_from: Option<Point2<f64>>,
    /// The steps in which it drove into arms, or past an opening, and came back.
    side_trips: Vec<Range<usize>>,
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
    /// The directions on the plan of the doors of the place where it stands, clockwise from the one by which it came in.
    doors: Option<Vec<f64>>,
    pub(super) tally: PerceptTally,
}

#[derive(Clone, Copy, Debug)]
struct LeftPlace {
    centre: Point2<f64>,
    extent: f64,
    is_junction: bool,
}

enum LegResult {
    /// At the leg's end.
    Driven,
    /// Beside an opening, where it has looked around.
    LookedAround,
    /// Within what may be a junction, and the direction on the plan from there to where it came in.
    AtPlace(SeenPlace, f64),
}

const ROBOT: LaserRobotParams = LaserRobotParams::DEFAULT;

impl<'w> LaserRobot<'w> {
    /// A robot that stands where its driver does.
    pub(super) fn new(
        world: &'w CorridorWorld,
        smoothed: &'w SmoothedWorld,
        scanner: LaserScanner,
        params: &LaserParams,
        driver: WalkDriver,
        facing: Dart,
        observer: &'w mut dyn RunObserver,
    ) -> Self {
        let sees_arms = scanner.params.range >= ROBOT.sees_arms;
        Self {
            world,
            smoothed,
            pilot: CorridorPilot::new(world),
            scanner,
            visits: Visits::by_laser(*params),
            driver,
            params: *params,
            facing,
            observer,
            events: 0,
            moves: 0,
            sensed: 0,
            sees_arms,
            drives_from: None,
            side_trips: Vec::new(),
            odometry_from_map: Isometry2::identity(),
            seen: Vec::new(),
            openings: Vec::new(),
            left: None,
            looked: None,
            is_at_opening: false,
            doors: None,
            tally: PerceptTally::default(),
        }
    }

    /// Drives away in a direction on the plan until it is at a junction, or cannot go on.
    fn drive(&mut self, towards: f64) -> Result<(), ScanFailure> {
        self.doors = None;
        let begin = self.driver.at;
        let mut leg = self.pilot.leave(begin, towards);
        // The way from there without what it drove to look into arms, in metres.
        let (mut along, mut before) = (0.0, begin);
        let mut points = vec![begin];
        loop {
            match self.drive_leg(&leg)? {
                LegResult::AtPlace(place, entry) => {
                    if let Some(doors) = self.decide(place, entry)? {
                        self.arrive(doors);
                        return Ok(());
                    }
                }
                LegResult::LookedAround => {}
                LegResult::Driven => {
                    let is_other = distance(begin, leg.to) > 2.0 * ROBOT.left_behind;
                    let is_junction = leg.ends_at_junction(self.world);
                    self.tally.passed += u64::from(is_other && is_junction);
                    points.push(leg.to);
                    let Some(next) = self.pilot.after(&leg) else {
                        along += distance(before, self.driver.at);
                        break;
                    };
                    leg = next;
                }
            }
            along += distance(before, self.driver.at);
            before = self.driver.at;
            if self.driver.way > ROBOT.longest_way {
                return Err(ScanFailure::TooFar);
            }
        }
        if along < self.params.arm.min_arm {
            self.drive_along(points.into_iter().rev())?;
            self.left =
                Some(LeftPlace { centre: self.on_local_map(), extent: 1.0, is_junction: true });
            return Err(ScanFailure::Alcove);
        }
        self.left = None;
        // Its heading may be that of a short way to look at something.
        let before =
            self.driver.before_entering(self.driver.at, ROBOT.near_place, &self.side_trips);
        let back = before.map_or_else(
            || wrapped(self.driver.heading.unwrap_or_default() + PI),
            |before| direction(self.driver.at, before),
        );
        self.arrive(vec![back]);
        Ok(())
    }

    /// Stands at a place with doors in these directions.
    fn arrive(&mut self, doors: Vec<f64>) {
        self.tally.percepts += 1;
        let is_true = self
            .truly_at(&doors)
            .is_some_and(|dart| self.smoothed.graph.degree_around(dart) as usize == doors.len());
        self.tally.wrong += u64::from(!is_true);
        self.doors = Some(doors);
    }

    fn drive_along(
        &mut self,
        points: impl IntoIterator<Item = Point2<f64>>,
    ) -> Result<(), ScanFailure> {
        for point in points {
            self.driver.drive_to(point);
            self.sense()?;
        }
        Ok(())
    }

    /// Drives along a leg until it is in the middle of what may be a junction, if it comes to one.
    fn drive_leg(&mut self, leg: &PilotLeg) -> Result<LegResult, ScanFailure> {
        self.driver.drive_near(leg.to);
        let mut closest: Option<(f64, SeenPlace)> = None;
        while self.sensed < self.driver.steps.len() {
            self.sense_step()?;
            let place = if self.sees_arms {
                self.visits.status()
            } else {
                self.openings.last().cloned().flatten()
            };
            let place = place.filter(|place| !self.is_left(place));
            let place = place.map(|place| (distance(place.centre, self.on_local_map()), place));
            match (place, &closest) {
                (None, None) if self.is_at_opening && self.sees_arms => {
                    self.driver.stop_after(self.sensed);
                    self.look_around()?;
                    return Ok(LegResult::LookedAround);
                }
                (None, None) => {}
                (Some(place), None) => closest = Some(place),
                (Some(place), Some((least, _))) if place.0 < *least => closest = Some(place),
                _ => break,
            }
        }
        let Some((_, mut place)) = closest else { return Ok(LegResult::Driven) };
        if self.sees_arms {
            self.driver.stop_after(self.sensed);
            let entry = self.came_from(&place);
            self.go_to(&place)?;
            return Ok(LegResult::AtPlace(place, entry));
        }
        let noticed = self.sensed;
        self.see_all_of(&mut place)?;
        self.driver.stop_after(self.sensed);
        // It drove past the step that is nearest to the centre, and goes back.
        let centre = self.plan_from_map() * place.centre;
        let steps = &self.driver.steps;
        let off = |&step: &usize| distance(centre, Point2::from(steps[step].pose.position));
        let nearest_step = nearest(noticed.saturating_sub(1)..steps.len(), off);
        let past = nearest_step.map_or(noticed, |step| step + 1);
        self.side_trips.push(past..steps.len());
        let entry = self.came_from(&place);
        self.go_to(&place)?;
        self.side_trips.push(past..self.sensed);
        Ok(LegResult::AtPlace(place, entry))
    }

    /// Drives on past an opening, so that its other side is on the local map, too.
    fn see_all_of(&mut self, opening: &mut SeenPlace) -> Result<(), ScanFailure> {
        let begin = self.driver_way();
        while self.sensed < self.driver.steps.len()
            && self.driver_way() - begin < ROBOT.past_opening
        {
            self.sense_step()?;
        }
        let within = ROBOT.past_opening + ROBOT.near_opening;
        if let Some(seen) = self.opening(self.on_local_map(), within)
            && !self.is_left(&seen)
        {
            *opening = seen;
        }
        Ok(())
    }

    /// The length of the way to the last scan, in metres.
    fn driver_way(&self) -> f64 {
        self.last_step().map_or(0.0, |step| step.way)
    }

    /// Goes to the centre of a place, if it can stand there.
    fn go_to(&mut self, place: &SeenPlace) -> Result<(), ScanFailure> {
        let centre = self.plan_from_map() * place.centre;
        if self.pilot.has_space_at(centre) && distance(centre, self.driver.at) > 0.2 {
            self.drive_along([centre])?;
        }
        Ok(())
    }

    /// The directions on the plan of the doors of the place where it stands, clockwise from the entry; `None` if it is no
    /// junction.
    fn decide(
        &mut self,
        mut place: SeenPlace,
        entry: f64,
    ) -> Result<Option<Vec<f64>>, ScanFailure> {
        let doors = if self.sees_arms {
            self.doors_of(&mut place, entry)
        } else {
            self.driven_doors(&place, entry)
        };
        let is_junction = self.sees_arms || !matches!(doors, Ok(None));
        let SeenPlace { centre, clearance: extent, .. } = place;
        self.left = Some(LeftPlace { centre, extent, is_junction });
        doors
    }

    /// The same if the robot drives into each way that leaves an opening, the one straight on last.
    fn driven_doors(
        &mut self,
        opening: &SeenPlace,
        entry: f64,
    ) -> Result<Option<Vec<f64>>, ScanFailure> {
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
            self.drives_from = Some(self.driver.at);
            let (driven, is_arm) = self.look_into(way)?;
            tried.push(way);
            if is_arm && !doors.iter().any(|&door| is_same(door, driven)) {
                doors.push(driven);
            }
        }
        Ok((doors.len() >= 3).then(|| in_order(doors, entry)))
    }

    /// The directions on the plan of the ways that leave an opening in at least two of the views there.
    fn ways_of(&self, opening: &SeenPlace) -> Vec<f64> {
        let turn = self.plan_from_map().rotation.angle();
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
        ways.into_iter().filter(|way| way.1 > 1).map(|way| wrapped(way.0 + turn)).collect()
    }

    /// The same. The place becomes the one that it has seen last.
    fn doors_of(
        &mut self,
        last: &mut SeenPlace,
        entry: f64,
    ) -> Result<Option<Vec<f64>>, ScanFailure> {
        self.look_around()?;
        // The directions of the arms that it has looked into, and whether they are arms.
        let mut known: Vec<(f64, bool)> = Vec::new();
        let (mut has_moved, mut tries) = (false, 0);
        for _ in 0..ROBOT.looks {
            let Some(place) = self.visits.status() else {
                let off = |seen: &&SeenPlace| distance(seen.centre, self.on_local_map());
                let near = nearest(self.seen.last().into_iter().flatten(), off)
                    .filter(|seen| off(seen) < ROBOT.same_place && !has_moved);
                let Some(seen) = near.cloned() else { return Ok(None) };
                has_moved = true;
                self.go_to(&seen)?;
                self.look_around()?;
                continue;
            };
            let turn = self.plan_from_map().rotation.angle();
            last.clone_from(&place);
            let is_known = |arm: f64| known.iter().any(|known| is_same(known.0, arm));
            let uncertain = self.uncertain_arms(&place).into_iter().map(|arm| wrapped(arm + turn));
            let next = uncertain.into_iter().find(|&arm| !is_same(arm, entry) && !is_known(arm));
            if let Some(arm) = next {
                let (_, is_arm) = self.look_into(arm)?;
                known.push((arm, is_arm));
                continue;
            }
            let is_undecided = place.arms.iter().any(|arm| arm.certainty == Certainty::Possible);
            if is_undecided && known.is_empty() {
                if tries == 2 {
                    return Err(ScanFailure::Undecided);
                }
                tries += 1;
                self.look_from_further(entry + PI * f64::from(tries))?;
                continue;
            }
            let doors: Vec<f64> = if is_undecided {
                let view = self.seen.last().map(Vec::as_slice).unwrap_or_default();
                Self::seen_at(view, &place).into_iter().flat_map(SeenPlace::directions).collect()
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
        Err(ScanFailure::Undecided)
    }

    /// Drives into an arm and back. Returns the direction in which it drove, and whether it could drive as far as makes an
    /// arm.
    fn look_into(&mut self, towards: f64) -> Result<(f64, bool), ScanFailure> {
        let (begin, first) = (self.driver.at, self.driver.steps.len());
        let mut points = vec![begin];
        let mut leg = Some(self.pilot.leave(begin, towards));
        let (mut left, mut at) = (self.params.arm.min_arm, begin);
        while let Some(next) = leg {
            let length = distance(at, next.to);
            let to = at + (left / length.max(1e-9)).min(1.0) * (next.to - at);
            self.drive_along([to])?;
            points.push(to);
            left -= length;
            at = next.to;
            if left <= 0.0 {
                break;
            }
            leg = self.pilot.after(&next);
        }
        // It may have gone through the middle of the place first.
        let driven = direction(begin, self.driver.at);
        self.drive_along(points.into_iter().rev().skip(1))?;
        self.drives_from = None;
        self.side_trips.push(first..self.driver.steps.len());
        self.look_around()?;
        Ok((driven, left <= 0.0))
    }

    /// Goes a little further, looks around there, and comes back.
    fn look_from_further(&mut self, towards: f64) -> Result<(), ScanFailure> {
        let begin = self.driver.at;
        let leg = self.pilot.leave(begin, towards);
        let share = (ROBOT.further / distance(begin, leg.to).max(1e-9)).min(1.0);
        self.driver.drive_to(begin + share * (leg.to - begin));
        self.driver.look_around();
        self.drive_along([begin])?;
        self.look_around()
    }

    fn look_around(&mut self) -> Result<(), ScanFailure> {
        self.looked = Some((self.on_local_map(), self.driver.way));
        self.seen.clear();
        self.openings.clear();
        self.driver.look_around();
        self.sense()?;
        self.is_at_opening = false;
        Ok(())
    }

    /// Whether a view shows ways that meet where the robot is, if its scanner does not look behind it and it has not
    /// turned around nearby.
    fn is_opening(&self, view: &PlaceView, scan: &Scan) -> bool {
        let robot = view.robot.position;
        let driven = self.last_step().map_or(0.0, |step| step.way);
        let has_looked = self.looked.is_some_and(|(at, way)| {
            distance(at, robot) < ROBOT.looked && driven - way < ROBOT.look_memory
        });
        if has_looked || scan.field_of_view() > ROBOT.all_around {
            return false;
        }
        let Some(map) = self.visits.sensor().map() else { return false };
        let Some(skeleton) = &map.skeleton else { return false };
        let ways = WayGraph::new(skeleton, &map.clearances);
        let is_near = |node: usize| distance(ways.nodes[node].point, robot) < ROBOT.opening;
        (0..ways.nodes.len()).any(|node| is_near(node) && ways.at(node).len() >= 3)
    }

    /// Where any ways of the local map meet within a distance of the robot, and the directions in which they leave.
    fn opening(&self, robot: Point2<f64>, within: f64) -> Option<SeenPlace> {
        let map = self.visits.sensor().map()?;
        let ways = WayGraph::new(map.skeleton.as_ref()?, &map.clearances);
        let meets: Vec<usize> =
            (0..ways.nodes.len()).filter(|&node| ways.at(node).len() >= 3).collect();
        let off = |&node: &usize| distance(ways.nodes[node].point, robot);
        let meet = nearest(meets.iter().copied(), off).filter(|node| off(node) < within)?;
        let WayNode { point, clearance, .. } = ways.nodes[meet];
        // Corridors that cross at an angle meet in several points.
        let is_of_group =
            |&node: &usize| distance(ways.nodes[node].point, point) < clearance + ROBOT.one_opening;
        let group: Vec<usize> = meets.into_iter().filter(is_of_group).collect();
        let points = || group.iter().map(|&node| ways.nodes[node].point);
        let centre = Point2::from(
            points().map(|point| point.coords).sum::<Vector2<f64>>() / group.len() as f64,
        );
        let spread = points().map(|point| distance(point, centre)).fold(0.0, f64::max);
        let is_outside = |point: &Point2<f64>| {
            distance(*point, centre) >= spread + clearance + ROBOT.one_opening
        };
        let mut arms: Vec<PlaceArm> = Vec::new();
        for way in &ways.ways {
            for node in way.nodes.into_iter().filter(|node| group.contains(node)) {
                let line = way.clone().from_node(node).line;
                let outside = line.iter().map(|(point, _)| *point).find(is_outside);
                let is_inner = way.nodes.iter().all(|node| group.contains(node));
                let end = line.last().map(|(point, _)| *point).filter(|_| !is_inner);
                arms.extend(outside.or(end).map(|point| PlaceArm {
                    direction: direction(centre, point),
                    certainty: Certainty::Possible,
                }));
            }
        }
        (arms.len() >= 3).then_some(SeenPlace { centre, clearance, arms })
    }

    /// What may be a junction at a place, in a view.
    fn seen_at<'v>(view: &'v [SeenPlace], place: &SeenPlace) -> Option<&'v SeenPlace> {
        let off = |seen: &&SeenPlace| distance(seen.centre, place.centre);
        nearest(view, off).filter(|seen| off(seen) < place.clearance.max(ROBOT.at_centre))
    }

    /// The directions of the arms of a place that are not certain in most of the last views.
    fn uncertain_arms(&self, place: &SeenPlace) -> Vec<f64> {
        let views = &self.seen[self.seen.len().saturating_sub(ROBOT.views)..];
        // The direction, the number of views that show the arm, and of those in which it is certain.
        let mut arms: Vec<(f64, usize, usize)> = Vec::new();
        for seen in views.iter().filter_map(|view| Self::seen_at(view, place)) {
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

    /// The direction on the plan from a place to where the robot was before.
    fn came_from(&self, place: &SeenPlace) -> f64 {
        let centre = self.plan_from_map() * place.centre;
        // It may have passed the place at a distance.
        let last =
            self.driver.last_without(&self.side_trips).map_or(0.0, |at| distance(at, centre));
        let far = (place.clearance.max(1.0) + ROBOT.came_from).max(last + 0.1);
        self.driver.before_entering(centre, far, &self.side_trips).map_or_else(
            || self.driver.heading.unwrap_or_default() + PI,
            |point| direction(centre, point),
        )
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

    fn sense(&mut self) -> Result<(), ScanFailure> {
        while self.sensed < self.driver.steps.len() {
            self.sense_step()?;
        }
        Ok(())
    }

    /// Takes the scan of the next step.
    fn sense_step(&mut self) -> Result<(), ScanFailure> {
        if self.observer.stop() {
            return Err(ScanFailure::Stopped);
        }
        let number = self.sensed;
        self.sensed += 1;
        let Some(&step) = self.driver.steps.get(number) else { return Ok(()) };
        let Ok(scan) = self.scanner.scan(step.pose, number as u64, step.time) else {
            return Ok(());
        };
        let scan = Arc::new(scan);
        let WalkStep { odometry, time: taken, .. } = step;
        self.emit(EventKind::Odometry(odometry));
        let frame = Frame { taken, odometry, scan: Some(scan.clone()), ..Frame::default() };
        self.emit(EventKind::Frame(Frame { id: self.sensed as u64, ..frame }));
        // What is far from the place is not on its map.
        let is_far = |from| distance(from, Point2::from(step.pose.position)) > ROBOT.near_place;
        if self.drives_from.is_some_and(is_far) {
            return Ok(());
        }
        if let Some(view) = self.visits.add_frame((), &scan, &odometry) {
            self.odometry_from_map = view.odometry_from_map;
            if self.sees_arms {
                self.is_at_opening = self.is_opening(&view, &scan);
            } else {
                let opening = self.opening(view.robot.position.into(), ROBOT.near_opening);
                self.openings.push(opening);
            }
            self.seen.push(view.possible_places);
        }
        let at = self.on_local_map();
        if self.left.is_some_and(|LeftPlace { centre, extent, .. }| {
            distance(centre, at) > extent + 2.0 * ROBOT.left_behind
        }) {
            self.left = None;
        }
        Ok(())
    }

    /// Reports an event that happens at the last step.
    fn emit(&mut self, kind: EventKind) {
        let Some(step) = self.last_step() else { return };
        let (time, truth) = (nanoseconds(step.time), Some(step.pose));
        self.events += 1;
        let id = EventId(self.events);
        self.observer.event(&Event { id, time, truth, kind });
    }

    /// Reports how the run ended.
    pub(super) fn end(&mut self, ending: RunEnding) {
        self.emit(EventKind::End(RunEnd { moves: self.moves, ending }));
    }

    /// Reports that it stands at a place with these doors, after the move with this number if it is known.
    fn report_arrival(&mut self, number: Option<u32>) {
        let Some(doors) = self.doors.clone() else { return };
        let turn = self.last_step().map_or(0.0, |step| step.odometry.heading - step.pose.heading);
        self.emit(EventKind::Arrival(Arrival {
            number,
            degree: doors.len() as u32,
            sighting: Some(self.sighting(&doors)),
            shape: None,
            entry: doors.first().map(|door| wrapped(door + turn)),
        }));
    }

    /// Drives to its first place.
    pub(super) fn begin(&mut self, towards: f64) -> Result<(), ScanFailure> {
        self.drive(towards)?;
        self.report_arrival(Some(0));
        Ok(())
    }

    /// Where it is on the local map.
    fn on_local_map(&self) -> Point2<f64> {
        let at = self.last_step().map_or(self.driver.at, |step| step.odometry.position.into());
        self.odometry_from_map.inverse() * at
    }

    /// From the local map to the plan, which is right near the robot.
    fn plan_from_map(&self) -> Isometry2<f64> {
        let plan_from_odometry = self.last_step().map_or_else(Isometry2::identity, |step| {
            let Pose { position, heading } = step.pose;
            motion_between(&step.odometry, &Odometry { position, heading })
        });
        plan_from_odometry * self.odometry_from_map
    }

    /// The step of the last scan.
    fn last_step(&self) -> Option<&WalkStep> {
        self.driver.steps.get(self.sensed.checked_sub(1)?)
    }

    /// The dart by which a robot has truly come in that stands at a place with these doors.
    fn truly_at(&self, doors: &[f64]) -> Option<Dart> {
        let entry = *doors.first()?;
        let darts = self.smoothed.graph.darts().filter(|dart| self.is_near_place_of(*dart));
        nearest(darts, |dart| wrapped(self.direction_of(*dart) - entry).abs())
    }

    /// Whether the robot is at the place of a dart's vertex.
    fn is_near_place_of(&self, dart: Dart) -> bool {
        let [place, _] = self.smoothed.corridors[dart.at()];
        distance(self.world.places[place], self.driver.at)
            < self.world.clearance(place) + ROBOT.marker_range
    }

    /// The dart by which the robot has truly come in.
    pub(super) fn truth(&self) -> Option<Dart> {
        self.truly_at(self.doors.as_ref()?)
    }

    /// The direction on the plan in which a dart leaves its vertex.
    fn direction_of(&self, dart: Dart) -> f64 {
        let [from, to] = self.smoothed.corridors[dart.at()].map(|place| self.world.places[place]);
        direction(from, to)
    }

    /// What the robot sees of the marker at a place with these doors.
    fn sighting(&self, doors: &[f64]) -> Sighting {
        if !self.is_near_place_of(self.facing) {
            return Sighting::Nothing;
        }
        let towards = self.direction_of(self.facing);
        let door = nearest(0..doors.len(), |&door| wrapped(doors[door] - towards).abs());
        door.map_or(Sighting::Nothing, |door| Sighting::Pointing(Door(door as u32)))
    }
}

impl World for LaserRobot<'_> {
    type Error = ScanFailure;

    fn percept(&mut self) -> Result<Percept, ScanFailure> {
        let doors = self.doors.as_ref().ok_or(ScanFailure::Missed)?;
        Ok(Percept { degree: doors.len() as u32, sighting: self.sighting(doors) })
    }

    fn traverse(&mut self, door: Door) -> Result<(), ScanFailure> {
        let doors = self.doors.as_ref().ok_or(ScanFailure::Missed)?;
        let &towards = doors.get(door.0 as usize).ok_or(ScanFailure::Missed)?;
        let number = u32::try_from(self.moves + 1).ok();
        self.emit(EventKind::Door { number, door });
        self.drive(towards)?;
        self.moves += 1;
        self.report_arrival(number);
        Ok(())
    }
}

impl Relocate for LaserRobot<'_> {
    /// Drives on, or back, until it derives a junction or comes to a dead end.
    fn relocate(&mut self, error: ScanFailure) -> Result<(), ScanFailure> {
        if matches!(error, ScanFailure::Stopped | ScanFailure::TooFar) {
            return Err(error);
        }
        for number in 0..ROBOT.tries {
            let ahead = self.driver.heading.unwrap_or_default();
            let towards = if number % 2 == 0 { ahead } else { ahead + PI };
            match self.drive(towards) {
                Ok(()) => {
                    // How many moves lead there is not known.
                    self.report_arrival(None);
                    return Ok(());
                }
                Err(failure @ (ScanFailure::Stopped | ScanFailure::TooFar)) => return Err(failure),
                Err(_) => {}
            }
        }
        Err(error)
    }
}

fn is_same(one: f64, other: f64) -> bool {
    wrapped(one - other).abs() < ROBOT.same_arm
}

/// Directions clockwise from the one that is nearest to the entry.
fn in_order(mut doors: Vec<f64>, entry: f64) -> Vec<f64> {
    let first = nearest(doors.iter().copied(), |door| wrapped(door - entry).abs());
    let first = first.unwrap_or(entry);
    let turn = |door: f64| {
        let turn = clockwise(first, door);
        if turn > TAU - 1e-9 { 0.0 } else { turn }
    };
    doors.sort_by(|&one, &other| turn(one).total_cmp(&turn(other)));
    doors
}
