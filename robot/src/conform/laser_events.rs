//! Infers events from what a laser scanner shows: visits to junctions, and the doors taken. A visit is decided
//! when several views agree, as those of a camera are.

use std::f64::consts::{FRAC_PI_3, TAU};

use toposlam_model::{
    driving::{odometry::Odometry, scene::wrapped},
    percept::Door,
};
use toposlam_vision::laser::{
    junctions::LaserJunction,
    params::{LaserParams, VisitParams},
    scan::Scan,
    sensor::LaserSensor,
};

use super::{
    events::{CheckedEvent, CheckedKind, EventSource},
    marked_visits::VisitedJunction,
};
use crate::record::Arrival;

/// Infers events from a sequence of scans.
#[derive(Clone, Debug)]
pub struct LaserEvents {
    sensor: LaserSensor,
    params: VisitParams,
    events: Vec<CheckedEvent>,
    /// The junctions of the events.
    junctions: Vec<VisitedJunction>,
    /// The junctions that were seen lately.
    seen: Vec<SeenJunction>,
    /// The visit that goes on.
    visit: Option<Visit>,
    /// Visits that are over and not decided yet.
    waiting: Vec<Visit>,
    /// The way since the last visit, or since the robot turned back after it.
    since: Vec<[f64; 2]>,
    /// Whether the robot has turned back since the last visit.
    turned_back: bool,
    /// The last visit that was a junction.
    last: Option<PastVisit>,
    /// The length of the robot's way, in metres.
    way: f64,
    source: EventSource,
}

/// A junction in several views.
#[derive(Clone, Debug)]
struct SeenJunction {
    centre: [f64; 2],
    clearance: f64,
    /// The arms in each view, the last one last; empty where it is no junction.
    views: Vec<Vec<f64>>,
    /// The length of the robot's way at the last view.
    way: f64,
}

/// A visit.
#[derive(Clone, Debug)]
struct Visit {
    source: EventSource,
    centre: [f64; 2],
    clearance: f64,
    /// The direction from the centre to where the robot came in; `None` if the log begins there.
    entry: Option<f64>,
    /// The direction to where it left, and the length of its way then.
    exit: Option<(f64, f64)>,
    /// Where and when it left.
    left: EventSource,
    /// Whether the robot turned back on its way to the junction.
    turned_back: bool,
}

/// What is known of a junction that was left.
#[derive(Clone, Copy, Debug)]
struct PastVisit {
    centre: [f64; 2],
    clearance: f64,
    exit: f64,
}

/// A robot within this distance of where it was before goes back, in metres.
const RETRACED: f64 = 0.6;
/// A robot has turned back once it has gone back for half of this length, in metres. Less is manoeuvring.
const TURN: f64 = 4.0;
/// A junction that was not seen on this length of the way is forgotten, in metres.
const FORGOTTEN: f64 = 30.0;
/// The entry and the exit of a visit are arms if they are as near to one that is seen, in radians.
const ARM: f64 = 0.8;
/// An arm by which the robot came or left counts if it is seen in this part of the views.
const TRAVERSED: f64 = 0.25;

impl LaserEvents {
    /// A robot that has seen nothing yet.
    #[must_use]
    pub fn new(params: LaserParams) -> Self {
        Self {
            sensor: LaserSensor::new(params),
            params: params.visit,
            events: Vec::new(),
            junctions: Vec::new(),
            seen: Vec::new(),
            visit: None,
            waiting: Vec::new(),
            since: Vec::new(),
            turned_back: false,
            last: None,
            way: 0.0,
            source: EventSource::default(),
        }
    }

    /// The next scan, and the odometry at its time.
    pub fn see(&mut self, source: EventSource, scan: &Scan, odometry: &Odometry) {
        let Some(view) = self.sensor.see(scan, odometry) else { return };
        self.source = source;
        let robot = odometry.position;
        if let Some(&last) = self.since.last() {
            self.way += distance(last, robot);
        }
        self.look(&view.junctions, robot);
        self.leave(robot);
        self.turn(robot);
        self.since.push(robot);
        self.enter(robot);
        while self.waiting.first().is_some_and(|visit| {
            visit.exit.is_some_and(|(_, left)| self.way - left >= self.params.settle)
        }) {
            let visit = self.waiting.remove(0);
            self.decide(&visit);
        }
        let way = self.way;
        self.seen.retain(|junction| way - junction.way < FORGOTTEN);
    }

    /// The events, after the last scan.
    #[must_use]
    pub fn finish(self) -> Vec<CheckedEvent> {
        self.finish_with_junctions().0
    }

    /// The events, and the junctions of those that are visits.
    #[must_use]
    pub fn finish_with_junctions(mut self) -> (Vec<CheckedEvent>, Vec<VisitedJunction>) {
        let visits = std::mem::take(&mut self.waiting).into_iter().chain(self.visit.take());
        for visit in visits.collect::<Vec<_>>() {
            self.decide(&visit);
        }
        (self.events, self.junctions)
    }

    /// Adds a view to the junctions that the robot is near.
    fn look(&mut self, junctions: &[LaserJunction], robot: [f64; 2]) {
        let range = self.params.range;
        for junction in junctions {
            if distance(junction.centre, robot) > range + junction.clearance {
                continue;
            }
            if let Some(known) = self.junction_at(junction.centre) {
                let known = &mut self.seen[known];
                let views = known.views.len().min(self.params.views) as f64;
                let mean = |old: f64, new: f64| (views * old + new) / (views + 1.0);
                known.centre = [0, 1].map(|axis| mean(known.centre[axis], junction.centre[axis]));
                known.clearance = mean(known.clearance, junction.clearance);
                known.views.push(junction.arms.clone());
                known.way = self.way;
            } else {
                self.seen.push(SeenJunction {
                    centre: junction.centre,
                    clearance: junction.clearance,
                    views: vec![junction.arms.clone()],
                    way: self.way,
                });
            }
        }
        for known in &mut self.seen {
            let near = distance(known.centre, robot) < range + known.clearance;
            if near && known.way < self.way {
                known.views.push(Vec::new());
            }
            let old = known.views.len().saturating_sub(self.params.views);
            known.views.drain(..old);
        }
    }

    /// The junction that was seen nearest to a point, if it can be one there.
    fn junction_at(&self, centre: [f64; 2]) -> Option<usize> {
        let off = |junction: &SeenJunction| distance(junction.centre, centre);
        let same = |junction: &SeenJunction| {
            off(junction) < self.params.same.max(0.6 * junction.clearance)
        };
        (0..self.seen.len())
            .filter(|&index| same(&self.seen[index]))
            .min_by(|&one, &other| off(&self.seen[one]).total_cmp(&off(&self.seen[other])))
    }

    /// Ends the visit of a robot that is outside of the junction.
    fn leave(&mut self, robot: [f64; 2]) {
        let Some(mut visit) = self.visit.take() else { return };
        if let Some(known) = self.junction_at(visit.centre) {
            (visit.centre, visit.clearance) = (self.seen[known].centre, self.seen[known].clearance);
        }
        if distance(visit.centre, robot) <= inside(visit.clearance) + self.params.leave {
            self.visit = Some(visit);
            return;
        }
        let exit = direction(visit.centre, robot);
        visit.exit = Some((exit, self.way));
        visit.left = self.source;
        self.last = Some(PastVisit { centre: visit.centre, clearance: visit.clearance, exit });
        self.waiting.push(visit);
        self.since.clear();
        self.turned_back = false;
    }

    /// Notices that the robot goes back along its way.
    fn turn(&mut self, robot: [f64; 2]) {
        if self.visit.is_some() {
            return;
        }
        let Some(&last) = self.since.last() else { return };
        let mut length = distance(last, robot);
        let ahead = direction(last, robot);
        for piece in self.since.windows(2).rev() {
            length += distance(piece[0], piece[1]);
            let opposite = wrapped(ahead - direction(piece[1], piece[0])).abs() < FRAC_PI_3;
            if opposite && length > TURN && distance_to_piece(robot, piece) < RETRACED {
                // Who has not been at a junction yet comes from anywhere.
                self.turned_back ^= self.last.is_some();
                self.since.clear();
                return;
            }
        }
    }

    /// Begins a visit of a robot that is within a junction.
    fn enter(&mut self, robot: [f64; 2]) {
        if self.visit.is_some() {
            return;
        }
        let is_here = |junction: &&SeenJunction| {
            distance(junction.centre, robot) < inside(junction.clearance)
                && junction.views.iter().any(|arms| arms.len() >= 3)
        };
        let near = |junction: &&SeenJunction| distance(junction.centre, robot);
        let here = self.seen.iter().filter(is_here);
        let Some(here) = here.min_by(|one, other| near(one).total_cmp(&near(other))) else {
            return;
        };
        let outside = |point: &&[f64; 2]| distance(here.centre, **point) > inside(here.clearance);
        let before = self.since.iter().rev().find(outside);
        let mut entry = before.map(|&point| direction(here.centre, point));
        let mut turned_back = self.turned_back;
        // Whoever comes in where he went out, with no junction on the way, has turned back.
        if let Some(last) = &self.last
            && distance(last.centre, here.centre) < self.params.same.max(0.6 * last.clearance)
        {
            let back = entry.is_none_or(|entry| wrapped(entry - last.exit).abs() < ARM);
            turned_back |= back;
            entry = entry.or(Some(last.exit));
        }
        self.visit = Some(Visit {
            source: self.source,
            centre: here.centre,
            clearance: here.clearance,
            entry,
            exit: None,
            left: self.source,
            turned_back,
        });
    }

    /// Adds the events of a visit that is over.
    fn decide(&mut self, visit: &Visit) {
        let Some(known) = self.junction_at(visit.centre) else { return };
        let VisitParams { same_arm, agree, doubt, .. } = self.params;
        let votes = votes(&self.seen[known].views, same_arm);
        let exit = visit.exit.map(|(exit, _)| exit);
        let traversed = |arm: f64| {
            let ways = [visit.entry, exit].into_iter().flatten();
            ways.map(|way| wrapped(way - arm).abs()).any(|off| off < ARM)
        };
        let counts =
            |&&(arm, part): &&(f64, f64)| part >= agree || traversed(arm) && part >= TRAVERSED;
        let doubtful = |&(arm, part): &(f64, f64)| (part - agree).abs() < doubt && !traversed(arm);
        let mut arms: Vec<f64> = votes.iter().filter(counts).map(|&(arm, _)| arm).collect();
        if arms.len() < 3 {
            return;
        }
        if visit.turned_back {
            self.push(visit.source, CheckedKind::TurnedBack);
        }
        if votes.iter().any(doubtful) {
            self.push_junction(visit, Vec::new());
            self.push(visit.source, CheckedKind::Undecided);
            return;
        }
        let nearest = |arms: &[f64], way: f64| {
            let off = |arm: f64| wrapped(arm - way).abs();
            (0..arms.len()).min_by(|&one, &other| off(arms[one]).total_cmp(&off(arms[other])))
        };
        // A robot whose log begins at the junction came in by any of its doors.
        let entry = visit.entry.and_then(|entry| nearest(&arms, entry)).unwrap_or_default();
        let entry = arms[entry];
        let clockwise = |arm: f64| (entry - arm).rem_euclid(TAU);
        arms.sort_by(|&one, &other| clockwise(one).total_cmp(&clockwise(other)));
        let arrival = Arrival {
            number: None,
            degree: arms.len() as u32,
            sighting: None,
            form: None,
            entry: Some(entry),
        };
        self.push_junction(visit, arms.clone());
        self.push(visit.source, CheckedKind::Arrival { arrival, entry_off: None });
        if let Some(exit) = exit
            && let Some(door) = nearest(&arms, exit)
        {
            let off = Some(wrapped(arms[door] - exit).abs());
            let door = Door(door as u32);
            self.push(visit.left, CheckedKind::Door { door, number: None, off });
        }
    }

    /// Adds the junction of the next event.
    fn push_junction(&mut self, visit: &Visit, doors: Vec<f64>) {
        let Visit { centre, clearance, .. } = *visit;
        self.junctions.push(VisitedJunction { event: self.events.len(), centre, clearance, doors });
    }

    fn push(&mut self, source: EventSource, kind: CheckedKind) {
        self.events.push(CheckedEvent { source, kind });
    }
}

/// A robot this near to the centre of a junction is inside, in metres.
fn inside(clearance: f64) -> f64 {
    clearance.max(1.0)
}

/// The directions of the arms that are seen, each with the part of the views that show it.
fn votes(views: &[Vec<f64>], same: f64) -> Vec<(f64, f64)> {
    // The mean direction, the number of views, and the last of them.
    let mut groups: Vec<(f64, u32, usize)> = Vec::new();
    for (number, view) in views.iter().enumerate() {
        for &arm in view {
            let off = |group: &(f64, u32, usize)| wrapped(group.0 - arm).abs();
            let near = groups.iter_mut().filter(|group| off(group) < same);
            if let Some(group) = near.min_by(|one, other| off(one).total_cmp(&off(other))) {
                group.0 = wrapped(group.0 + wrapped(arm - group.0) / f64::from(group.1 + 1));
                group.1 += u32::from(group.2 != number);
                group.2 = number;
            } else {
                groups.push((arm, 1, number));
            }
        }
    }
    let all = views.len().max(1) as f64;
    groups.into_iter().map(|(arm, seen, _)| (arm, f64::from(seen) / all)).collect()
}

fn distance([x, y]: [f64; 2], [u, v]: [f64; 2]) -> f64 {
    (x - u).hypot(y - v)
}

fn direction([x, y]: [f64; 2], [u, v]: [f64; 2]) -> f64 {
    (v - y).atan2(u - x)
}

/// The distance from a point to a piece of a way.
fn distance_to_piece(point: [f64; 2], piece: &[[f64; 2]]) -> f64 {
    let [from, to] = piece else { return f64::INFINITY };
    let along = [0, 1].map(|axis| to[axis] - from[axis]);
    let off = [0, 1].map(|axis| point[axis] - from[axis]);
    let square = along[0] * along[0] + along[1] * along[1];
    let part = if square > 0.0 { (off[0] * along[0] + off[1] * along[1]) / square } else { 0.0 };
    let part = part.clamp(0.0, 1.0);
    distance(point, [0, 1].map(|axis| from[axis] + part * along[axis]))
}
