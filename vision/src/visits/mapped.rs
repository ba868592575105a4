//! Visits of a robot with a laser scanner, by its position on the local map and what several views of a place show.

use std::{
    collections::VecDeque,
    f64::consts::{FRAC_PI_3, PI, TAU},
};

use nalgebra::{Isometry2, Point2};
use toposlam_model::driving::scene::wrapped;

use super::{
    tracked_places::{TrackedArm, TrackedPlace, TrackedPlaces},
    visit::{UndecidedCause, Visit, VisitExit, VisitLog},
    way::{Bends, PassedBend, UnseenWay, distance_to_piece},
};
use crate::{
    geometry::{direction, distance, in_steps},
    laser::params::{CornerParams, LaserParams},
    place::{Certainty, PlaceArm, PlaceView, SeenPlace, nearest_direction},
};

/// How far one sees on the map of the last view, from a point in a direction and up to a limit, in metres.
type Sight<'a> = dyn Fn(Point2<f64>, f64, f64) -> f64 + 'a;

/// A place that so many views in turn do not show is no longer where it was.
const LATELY: usize = 3;

#[derive(Clone, Debug, Default)]
pub(super) struct MappedRule<S> {
    params: LaserParams,
    /// Junctions, and corners if they are vertices.
    junctions: TrackedPlaces,
    /// What are junctions if arms in doubt count.
    possible_junctions: TrackedPlaces,
    dead_ends: TrackedPlaces,
    bends: Bends<S>,
    unseen: UnseenWay,
    /// The stay at a junction that goes on, and at a possible one.
    stay: Option<Stay<S>>,
    possible_stay: Option<Stay<S>>,
    /// The last points of the way since the last stay at a possible junction, each with the length of the way
    /// to there. An arm in doubt may be noticed only behind the junction.
    passed: VecDeque<(f64, Point2<f64>, S)>,
    /// Stays that are over and not decided yet.
    waiting: VecDeque<Stay<S>>,
    /// The last points of the way, each with the length of the way to there.
    trail: VecDeque<(f64, Point2<f64>)>,
    /// The way since the last stay, or since the robot turned back after it.
    since: Vec<Point2<f64>>,
    /// Whether the robot has turned back since the last stay.
    turned_back: bool,
    /// The last visit that was decided, and whether the robot has turned back between it and the stays
    /// that were decided to be no visits.
    last: Option<(PastVisit, bool)>,
    /// The direction to what was behind the robot at first.
    behind: Option<f64>,
    now: Now<S>,
}

/// The last view.
#[derive(Clone, Copy, Debug, Default)]
struct Now<S> {
    at: S,
    robot: Point2<f64>,
    /// The length of the robot's way, in metres.
    way: f64,
    odometry_from_map: Isometry2<f64>,
}

/// A stay at what may be a vertex. Points and directions are those of the map.
#[derive(Clone, Copy, Debug)]
struct Stay<S> {
    kind: StayKind,
    at: S,
    centre: Point2<f64>,
    clearance: f64,
    /// The direction from the centre to where the robot came in; `None` if the log begins there.
    entry: Option<f64>,
    /// The direction to where it left, the length of its way then, and its last view.
    exit: Option<(f64, f64)>,
    /// How far apart the places are where it came in and left.
    apart: f64,
    came: Option<Point2<f64>>,
    left: S,
    /// Whether the robot turned back on its way there.
    turned_back: bool,
    odometry_from_map: Isometry2<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum StayKind {
    /// At a junction, or in a corner in which the log begins, ends, or the robot turns back.
    Junction,
    /// At a place that is a junction only if arms in doubt count.
    PossibleJunction,
    DeadEnd,
    /// In a corner that the robot passed: the length of its way to there, and the arms by which a corridor may go straight
    /// on.
    Bend {
        way: f64,
        possible: [Option<f64>; 2],
    },
    /// At no place: the robot drove in a direction in which the scanner does not look.
    UnseenWay,
}

#[derive(Clone, Copy, Debug)]
struct PastVisit {
    centre: Point2<f64>,
    extent: f64,
    exit: f64,
    /// The length of the robot's way when it left.
    left: f64,
    is_certain: bool,
}

/// What the views of a place show. Without arms and doubt it is no vertex.
#[derive(Clone, Debug)]
struct Estimate {
    arms: Vec<PlaceArm>,
    doubt: Option<UndecidedCause>,
    extent: f64,
}

impl Estimate {
    fn doors(&self) -> impl Iterator<Item = f64> + '_ {
        self.arms.iter().filter(|arm| arm.is_certain()).map(|arm| arm.direction)
    }

    fn is_vertex(&self) -> bool {
        self.doubt.is_some() || !self.arms.is_empty()
    }

    /// The same if each of its arms is only possible.
    fn in_doubt(mut self) -> Self {
        for arm in self.arms.iter_mut().filter(|arm| arm.is_certain()) {
            arm.certainty = Certainty::Possible;
        }
        self.doubt = self.doubt.or(Some(UndecidedCause::Unclear));
        self
    }
}

impl<S: Copy + Default> MappedRule<S> {
    pub(super) fn new(params: &LaserParams) -> Self {
        Self {
            params: *params,
            junctions: TrackedPlaces::new(params),
            possible_junctions: TrackedPlaces::new(params),
            dead_ends: TrackedPlaces::new(params),
            bends: Bends::new(params.corner),
            ..Self::default()
        }
    }

    /// Takes the next view.
    pub(super) fn add_view(
        &mut self,
        log: &mut VisitLog<S>,
        at: S,
        view: &PlaceView,
        sight: &Sight<'_>,
    ) {
        let robot = Point2::from(view.robot.position);
        self.behind.get_or_insert(wrapped(view.robot.heading + PI));
        let driven = self.since.last().map_or(0.0, |&last| in_steps(distance(last, robot)));
        let way = self.now.way + driven;
        self.now = Now { at, robot, way, odometry_from_map: view.odometry_from_map };
        let (dead_ends, junctions): (Vec<_>, Vec<_>) =
            view.places.iter().partition(|place| place.arms.len() == 1);
        self.junctions.add(junctions.into_iter(), robot, way);
        self.dead_ends.add(dead_ends.into_iter(), robot, way);
        let possible = view.possible_places.iter().filter(|place| place.arms.len() >= 3);
        self.possible_junctions.add(possible, robot, way);
        self.leave();
        self.turn();
        self.since.push(robot);
        self.trail.push_back((way, robot));
        let memory = self.params.visit.memory;
        while self.trail.front().is_some_and(|(before, _)| way - before > memory) {
            self.trail.pop_front();
        }
        if self.params.corner.corners {
            for bend in self.bends.add(robot, way, at) {
                self.pass_bend(&bend, sight);
            }
        }
        if self.unseen.add(view, &self.params.visit) {
            let stay = self.begin(StayKind::UnseenWay, robot, 0.0);
            self.waiting.push_back(Stay { turned_back: false, ..stay });
        }
        self.enter();
        while let Some(stay) = self.waiting.pop_front() {
            if stay.exit.is_some_and(|(_, left)| way - left < self.params.visit.settle) {
                self.waiting.push_front(stay);
                break;
            }
            self.decide(log, &stay);
        }
    }

    pub(super) fn status(&self) -> Option<SeenPlace> {
        let stay = self.stay.as_ref().or(self.possible_stay.as_ref())?;
        let arms = self.estimate(stay).map_or_else(Vec::new, |estimate| estimate.arms);
        Some(SeenPlace { centre: stay.centre, clearance: stay.clearance, arms })
    }

    pub(super) fn finish(mut self, log: &mut VisitLog<S>) {
        // Where both are at one junction, the stay that is not only possible is its visit.
        let stays = [self.possible_stay.take(), self.stay.take()];
        self.waiting.extend(stays.into_iter().flatten());
        while let Some(stay) = self.waiting.pop_front() {
            self.decide(log, &stay);
        }
    }

    fn begin(&self, kind: StayKind, centre: Point2<f64>, clearance: f64) -> Stay<S> {
        let Now { at, odometry_from_map, .. } = self.now;
        Stay {
            kind,
            at,
            centre,
            clearance,
            entry: None,
            exit: None,
            apart: 0.0,
            came: None,
            left: at,
            turned_back: self.turned_back,
            odometry_from_map,
        }
    }

    /// Ends the stays of a robot that is outside of their places.
    fn leave(&mut self) {
        let (now, visit) = (self.now, self.params.visit);
        if let Some(stay) = &mut self.stay
            && let Some(known) = self.junctions.at(stay.centre)
        {
            // Earlier views may have shown the junction beside where the last ones do, if odometry has drifted.
            let drifts = self.params.matching.rounds == 0;
            let is_gone = drifts && known.shown_by_last(LATELY) == Some(false);
            let within = |place: &TrackedPlace| {
                let is_there = is_gone
                    && place.shown_by_last(LATELY) == Some(true)
                    && distance(place.centre, known.centre) < 2.0 * visit.same;
                if is_there { visit.radius(place.clearance) } else { 0.0 }
            };
            let better = self.junctions.nearest(now.robot, within);
            let place = better.unwrap_or(known);
            (stay.centre, stay.clearance) = (place.centre, place.clearance);
            if better.is_some() {
                stay.entry = stay.came.map(|came| direction(stay.centre, came));
            }
        }
        let is_over = |stay: &mut Stay<S>| {
            let radius = visit.radius(stay.clearance) + visit.leave;
            let is_over = distance(stay.centre, now.robot) > radius;
            stay.odometry_from_map = now.odometry_from_map;
            stay.exit = is_over.then(|| (direction(stay.centre, now.robot), now.way));
            stay.apart = stay.came.map_or(0.0, |came| distance(came, now.robot));
            stay.left = now.at;
            is_over
        };
        if let Some(stay) = self.stay.take_if(is_over) {
            self.waiting.push_back(stay);
            self.since.clear();
            self.turned_back = false;
        }
        if let Some(stay) = self.possible_stay.take_if(is_over) {
            self.waiting.push_back(stay);
            self.passed.clear();
        }
    }

    /// Notices that the robot goes back along its way, and whether it was at a dead end.
    fn turn(&mut self) {
        let visit = self.params.visit;
        let robot = self.now.robot;
        let Some(&last) = self.since.last().filter(|_| self.stay.is_none()) else { return };
        let mut length = distance(last, robot);
        let ahead = direction(last, robot);
        for piece in self.since.windows(2).rev() {
            length += distance(piece[0], piece[1]);
            let opposite = wrapped(ahead - direction(piece[1], piece[0])).abs() < FRAC_PI_3;
            if opposite
                && length > visit.turned_back
                && distance_to_piece(robot, [piece[0], piece[1]]) < visit.retraced
            {
                if let Some(stay) = self.stay_at_dead_end() {
                    self.waiting.push_back(stay);
                    self.turned_back = false;
                } else {
                    self.turned_back ^= true;
                }
                self.since.clear();
                return;
            }
        }
    }

    /// The stay of a robot that has turned back at a dead end.
    fn stay_at_dead_end(&self) -> Option<Stay<S>> {
        let visit = &self.params.visit;
        let within = |end: &TrackedPlace| visit.radius(end.clearance).max(visit.dead_end);
        let ends = self.since.iter().filter_map(|point| {
            let end = self.dead_ends.nearest(*point, within)?;
            Some((distance(end.centre, *point), end))
        });
        let (_, end) = ends.min_by(|one, other| one.0.total_cmp(&other.0))?;
        let arm = direction(end.centre, *self.since.last()?);
        let stay = self.begin(StayKind::DeadEnd, end.centre, end.clearance);
        Some(Stay { entry: Some(arm), exit: Some((arm, self.now.way)), ..stay })
    }

    /// Adds the stay of a robot that has passed a corner.
    fn pass_bend(&mut self, bend: &PassedBend<S>, sight: &Sight<'_>) {
        let (corner, far) = (&self.params.corner, self.params.arm.sight);
        // The log may begin in a room.
        let is_at_junction =
            self.stay.is_some_and(|stay| distance(stay.centre, bend.point) < corner.arm);
        if bend.way < corner.min_way || is_at_junction {
            return;
        }
        // A corridor may go straight on there.
        let goes_on = |back: &f64| sight(bend.point, *back, far) >= far;
        let possible = bend.arms.map(|arm| Some(arm + PI).filter(goes_on));
        let [entry, exit] = bend.arms;
        self.waiting.push_back(Stay {
            at: bend.at,
            entry: Some(entry),
            exit: Some((exit, self.now.way)),
            ..self.begin(StayKind::Bend { way: bend.way, possible }, bend.point, 0.0)
        });
        self.turned_back = false;
    }

    /// Begins the stays of a robot that is within a junction, or was within a possible one a short way ago.
    fn enter(&mut self) {
        let Now { at, robot, way, .. } = self.now;
        if self.stay.is_none() {
            self.stay = self.stay_at(StayKind::Junction, robot, way);
        }
        self.passed.push_back((way, robot, at));
        let memory = 2.0 * self.params.visit.settle;
        while self.passed.front().is_some_and(|(before, ..)| way - before > memory) {
            self.passed.pop_front();
        }
        if self.possible_stay.is_none() {
            self.possible_stay = self.passed.iter().find_map(|&(way, point, at)| {
                Some(Stay { at, ..self.stay_at(StayKind::PossibleJunction, point, way)? })
            });
        }
    }

    /// The stay of a robot that is within a place, after this length of its way.
    fn stay_at(&self, kind: StayKind, robot: Point2<f64>, way: f64) -> Option<Stay<S>> {
        let visit = &self.params.visit;
        let places = match kind {
            StayKind::PossibleJunction => &self.possible_junctions,
            _ => &self.junctions,
        };
        let here = places.nearest(robot, |place| visit.radius(place.clearance))?;
        let is_outside = |&&(before, point): &&(f64, Point2<f64>)| {
            before <= way && distance(here.centre, point) > visit.radius(here.clearance)
        };
        // Where a log begins shows nothing of where the robot came from.
        let before = self.trail.iter().rev().find(is_outside);
        let came = before.filter(|_| way > visit.beginning).map(|&(_, point)| point);
        let entry = came.map(|point| direction(here.centre, point));
        Some(Stay { entry, came, ..self.begin(kind, here.centre, here.clearance) })
    }

    /// What the views show of a place; `None` if nothing. If there are more doors with the arms in doubt than without them,
    /// it is undecided.
    fn estimate(&self, stay: &Stay<S>) -> Option<Estimate> {
        let visit = &self.params.visit;
        let is_possible = stay.kind == StayKind::PossibleJunction;
        let seen = self.seen(stay);
        let is_settled = match stay.kind {
            StayKind::DeadEnd | StayKind::UnseenWay => true,
            StayKind::Bend { .. } => seen.as_ref().is_some_and(|seen| !seen.is_vertex()),
            StayKind::Junction | StayKind::PossibleJunction => false,
        };
        if is_settled {
            return seen;
        }
        let doors: Vec<f64> = seen.iter().flat_map(Estimate::doors).collect();
        let possible = self.possible_junctions.at(stay.centre);
        let possible = possible.filter(|known| known.shows_meet(visit));
        let in_doubt = possible.and_then(|known| {
            let stay = Stay { kind: StayKind::PossibleJunction, ..*stay };
            let mut estimate = self.judge(&stay, &known.arms_of_meet(visit), known.extent(visit));
            let is_more = estimate.doubt.is_some() || estimate.doors().count() > doors.len().max(2);
            let mut others = doors.clone();
            for arm in estimate.arms.iter_mut().filter(|arm| arm.is_certain()) {
                match nearest_direction(&others, arm.direction) {
                    Some(door) if self.is_same(others[door], arm.direction) => {
                        others.swap_remove(door);
                    }
                    _ => arm.certainty = Certainty::Possible,
                }
            }
            estimate.doubt = Some(UndecidedCause::UnseenArm);
            is_more.then_some(estimate)
        });
        if is_possible {
            // No view showed it as long as the robot was there.
            return in_doubt.or(seen.filter(Estimate::is_vertex).map(Estimate::in_doubt));
        }
        in_doubt.or(seen)
    }

    /// What the views show of a place without the arms in doubt.
    fn seen(&self, stay: &Stay<S>) -> Option<Estimate> {
        let visit = &self.params.visit;
        let places = match stay.kind {
            StayKind::Junction | StayKind::PossibleJunction => &self.junctions,
            StayKind::DeadEnd => &self.dead_ends,
            StayKind::UnseenWay => {
                let doubt = Some(UndecidedCause::UnseenWay);
                return Some(Estimate { arms: Vec::new(), doubt, extent: visit.same });
            }
            StayKind::Bend { way, possible } => {
                // A junction where the robot turned is no corner.
                let arm = self.params.corner.arm;
                let is_junction = self.last.is_some_and(|(last, _)| {
                    last.is_certain
                        && distance(last.centre, stay.centre) < arm
                        && way <= last.left + arm
                });
                let certain = stay.entry.into_iter().chain(stay.exit.map(|(exit, _)| exit));
                let possible = possible.into_iter().flatten();
                let possible = possible
                    .map(|direction| PlaceArm { direction, certainty: Certainty::Possible });
                let mut arms: Vec<_> = certain.map(PlaceArm::certain).chain(possible).collect();
                arms.retain(|_| !is_junction);
                let doubt = (arms.len() > 2).then_some(UndecidedCause::Unclear);
                return Some(Estimate { arms, doubt, extent: visit.same });
            }
        };
        let known = places.at(stay.centre)?;
        let extent = known.extent(visit);
        let meet = self.judge(stay, &known.arms_of_meet(visit), extent);
        Some(if meet.is_vertex() { meet } else { self.judge(stay, &known.arms(visit), extent) })
    }

    /// What several views of a place show.
    fn judge(&self, stay: &Stay<S>, arms: &[TrackedArm], extent: f64) -> Estimate {
        let (visit, corner) = (&self.params.visit, &self.params.corner);
        let ways = [stay.entry, stay.exit.map(|(exit, _)| exit)];
        // Where the robot went on, its own way shows whether there is a corner.
        let went_on = matches!(ways, [Some(entry), Some(exit)] if !self.is_same(entry, exit));
        let is_corner = |one: f64, other: f64| {
            corner.corners && !went_on && CornerParams::bend([one, other]) >= corner.min_turn
        };
        // What may be doors, and those that are.
        let (mut may, mut doors) = (0, Vec::new());
        let arm = |&TrackedArm { direction, part }: &TrackedArm| {
            let is_traversed = ways.into_iter().flatten().any(|way| self.is_same(way, direction));
            let counts = part >= visit.agree || is_traversed && part >= visit.traversed;
            let is_doubtful = !is_traversed && (part - visit.agree).abs() < visit.doubt;
            doors.extend(counts.then_some(direction));
            may += usize::from(counts || is_doubtful);
            let certainty = match (is_doubtful, counts) {
                (true, _) => Certainty::Possible,
                (false, true) => Certainty::Certain,
                (false, false) => Certainty::Excluded,
            };
            PlaceArm { direction, certainty }
        };
        let mut arms: Vec<PlaceArm> = arms.iter().map(arm).collect();
        let is_vertex = match (stay.kind, &doors[..]) {
            (StayKind::DeadEnd, [_]) => true,
            (StayKind::Junction | StayKind::PossibleJunction, _) if may >= 3 => true,
            // A corridor goes straight on where no arm of a junction is left.
            (StayKind::Junction, &[one, other]) => is_corner(one, other),
            _ => false,
        };
        arms.retain(|_| is_vertex);
        let is_doubtful = arms.iter().any(|arm| arm.certainty == Certainty::Possible);
        Estimate { arms, doubt: is_doubtful.then_some(UndecidedCause::Unclear), extent }
    }

    /// Adds the visit of a stay that is over, if it was one.
    fn decide(&mut self, log: &mut VisitLog<S>, stay: &Stay<S>) {
        if stay.kind == StayKind::PossibleJunction && self.is_visited_otherwise(stay) {
            return;
        }
        let Some(estimate) = self.estimate(stay) else { return };
        let exit = stay.exit.map(|(exit, _)| exit);
        if !estimate.is_vertex() {
            // It went on, or it turned back there.
            let back = stay.entry.zip(exit).is_some_and(|(entry, exit)| self.is_same(entry, exit));
            if let Some((_, turned)) = &mut self.last {
                *turned ^= stay.turned_back ^ back;
            }
            return;
        }
        let mut entry = stay.entry;
        let mut turned_back = false;
        if let Some((last, turned)) = &self.last {
            turned_back = turned ^ stay.turned_back;
            // A robot that comes in where it went out, with no junction on the way, has turned back.
            if distance(last.centre, stay.centre) < last.extent {
                turned_back |= entry.is_none_or(|entry| self.is_same(entry, last.exit));
                entry = entry.or(Some(last.exit));
            }
        }
        if let Some((exit, left)) = stay.exit {
            let is_certain = estimate.doubt.is_none();
            let (centre, extent) = (stay.centre, estimate.extent);
            let last = PastVisit { centre, extent, exit, left, is_certain };
            self.last = Some((last, false));
        }
        if stay.kind == StayKind::PossibleJunction {
            // The next stay does not report it again.
            self.turned_back &= !stay.turned_back;
        }
        log.turned_back.extend(turned_back.then_some(stay.at));
        self.push(log, stay, estimate, entry);
    }

    /// Whether a stay at a possible junction is also one at a junction, which is decided on its own.
    fn is_visited_otherwise(&self, stay: &Stay<S>) -> bool {
        let visit = &self.params.visit;
        let is_near = |centre: Point2<f64>, extent: f64| {
            distance(centre, stay.centre) < visit.radius(stay.clearance).max(extent)
        };
        let left = stay.exit.map_or(self.now.way, |(_, left)| left);
        let is_last = self.last.is_some_and(|(last, _)| {
            is_near(last.centre, last.extent) && (last.left - left).abs() < 2.0 * visit.settle
        });
        let mut others = self.waiting.iter().chain(&self.stay);
        is_last
            || others.any(|other| {
                other.kind != StayKind::PossibleJunction
                    && is_near(other.centre, visit.radius(other.clearance))
            })
    }

    /// Adds a visit, with its arms clockwise from the entry.
    fn push(&self, log: &mut VisitLog<S>, stay: &Stay<S>, estimate: Estimate, entry: Option<f64>) {
        let Estimate { mut arms, mut doubt, .. } = estimate;
        // A robot whose log begins at the junction has its back to where it came from.
        let entry = entry.or(self.behind).unwrap_or_default();
        let exit = stay.exit.map(|(exit, _)| exit);
        // The robot drove where it came in and where it left.
        let ways = [stay.entry, exit].into_iter().flatten();
        for way in ways.take(if arms.is_empty() { 0 } else { 2 }) {
            let near = arms.iter_mut().filter(|arm| arm.certainty != Certainty::Excluded);
            let off = |arm: &PlaceArm| wrapped(arm.direction - way).abs();
            let nearest = near.min_by(|one, other| off(one).total_cmp(&off(other)));
            match nearest.filter(|arm| self.is_same(arm.direction, way)) {
                Some(arm) => arm.certainty = Certainty::Certain,
                // No view shows the arm, or it is beside one of those that are shown.
                None => arms.push(PlaceArm { direction: way, certainty: Certainty::Possible }),
            }
        }
        if !arms.is_empty() {
            let is_open = arms.iter().any(|arm| arm.certainty == Certainty::Possible);
            doubt = is_open.then(|| doubt.unwrap_or(UndecidedCause::Unclear));
        }
        let clockwise = |arm: &PlaceArm| (entry - arm.direction).rem_euclid(TAU);
        arms.sort_by(|one, other| clockwise(one).total_cmp(&clockwise(other)));
        let off = |arm: &PlaceArm| wrapped(arm.direction - entry).abs();
        let counted = (0..arms.len()).filter(|&arm| arms[arm].certainty != Certainty::Excluded);
        let first = counted.min_by(|&one, &other| off(&arms[one]).total_cmp(&off(&arms[other])));
        arms.rotate_left(first.unwrap_or_default());
        let counted = arms.iter().filter(|arm| arm.certainty != Certainty::Excluded);
        let counted: Vec<f64> = counted.map(|arm| arm.direction).collect();
        let goes_back = exit.is_some_and(|exit| {
            let back = nearest_direction(&counted, entry);
            self.is_same(entry, exit)
                && nearest_direction(&counted, exit) == back
                && stay.apart < self.params.visit.apart
        });
        let turn = stay.odometry_from_map.rotation.angle();
        for arm in &mut arms {
            arm.direction = wrapped(arm.direction + turn);
        }
        let exit = stay.exit.map(|(exit, _)| VisitExit {
            at: stay.left,
            direction: wrapped(exit + turn),
            off: None,
        });
        let mut visit = Visit {
            at: stay.at,
            centre: stay.odometry_from_map * stay.centre,
            clearance: stay.clearance,
            extent: self.params.visit.radius(stay.clearance),
            arms,
            came: Some(wrapped(entry + turn)),
            least_bend: self.params.corner.corners.then_some(self.params.corner.min_turn),
            exit,
            goes_back,
            doubt,
            ..Visit::default()
        };
        if visit.doubt.is_none() && visit.alternatives().is_empty() {
            visit.doubt = Some(UndecidedCause::Unclear);
        }
        let centre = visit.centre;
        log.push(visit, |before| Some(distance(before.centre, centre)));
    }

    /// Whether two directions are of one arm.
    fn is_same(&self, one: f64, other: f64) -> bool {
        wrapped(one - other).abs() < self.params.visit.same_way
    }
}

#[cfg(test)]
mod tests;
