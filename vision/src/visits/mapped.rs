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
            junctions: TrackedPlaces::new(params.visit),
            possible_junctions: TrackedPlaces::new(params.visit),
            dead_ends: TrackedPlaces::new(params.visit),
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
            (stay.centre, stay.clearance) = (known.centre, known.clearance);
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
            StayKind::Bend { .. } if seen.as_ref().is_some_and(|seen| !seen.is_vertex()) => true,
            _ => seen.as_ref().is_some_and(|seen| seen.doubt.is_some()),
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
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use toposlam_model::driving::odometry::Odometry;

    use super::*;
    use crate::{geometry::unit, place::ViewSector, visits::VisitPercept};

    /// The visits of a robot that comes from the west to a junction at the origin and leaves in a direction, where one view
    /// in `every` shows arms in these directions.
    fn visits(arms: &[f64], leaves: f64, every: usize) -> Vec<Visit<usize>> {
        let come = (0..24).map(|step| Point2::new(-12.0 + 0.5 * f64::from(step), 0.0));
        let leave = (0..24).map(|step| Point2::from(0.5 * f64::from(step) * unit(leaves)));
        let place = place(Point2::origin(), 1.0, arms);
        visits_by(come.chain(leave).enumerate().map(|(at, robot)| {
            (robot, if at % every == 0 { vec![place.clone()] } else { Vec::new() }, Vec::new())
        }))
    }

    fn place(centre: Point2<f64>, clearance: f64, arms: &[f64]) -> SeenPlace {
        let arms = arms.iter().map(|&direction| PlaceArm::certain(direction)).collect();
        SeenPlace { centre, clearance, arms }
    }

    /// What a robot sees: places, and others if arms in doubt are arms.
    type Seen = (Point2<f64>, Vec<SeenPlace>, Vec<SeenPlace>);

    /// A robot whose odometry begins with its map, and which looks ahead and to both sides.
    struct Robot {
        params: LaserParams,
        odometry_from_map: Isometry2<f64>,
        sector: ViewSector,
        /// How far it sees.
        sight: f64,
    }

    impl Default for Robot {
        fn default() -> Self {
            let params = LaserParams::default();
            let (odometry_from_map, sector) = (Isometry2::identity(), ViewSector::ALL_AROUND);
            Self { params, odometry_from_map, sector, sight: 0.0 }
        }
    }

    impl Robot {
        /// A robot for which corners and dead ends are vertices.
        fn with_corners() -> Self {
            let mut robot = Self::default();
            robot.params.corner.corners = true;
            robot
        }

        fn visits(&self, views: impl Iterator<Item = Seen>) -> Vec<Visit<usize>> {
            let (log, _) = self.statuses(views);
            log.visits
        }

        /// The visits, and where the robot is at each view.
        fn statuses(
            &self,
            views: impl Iterator<Item = Seen>,
        ) -> (VisitLog<usize>, Vec<Option<SeenPlace>>) {
            let mut rule = MappedRule::new(&self.params);
            let (mut log, mut statuses) = (VisitLog::default(), Vec::new());
            for (at, (robot, places, in_doubt)) in views.enumerate() {
                let view = PlaceView {
                    robot: Odometry { position: robot.into(), heading: 0.0 },
                    odometry_from_map: self.odometry_from_map,
                    possible_places: places.iter().cloned().chain(in_doubt).collect(),
                    facts: None,
                    places,
                    sector: self.sector,
                    width: None,
                    scene: None,
                };
                rule.add_view(&mut log, at, &view, &|_, _, limit| self.sight.min(limit));
                statuses.push(rule.status());
            }
            rule.finish(&mut log);
            (log, statuses)
        }
    }

    fn visits_by(views: impl Iterator<Item = Seen>) -> Vec<Visit<usize>> {
        Robot::default().visits(views)
    }

    /// A way along these points, in steps of half a metre, on which all of these places are seen.
    fn along(points: &[[f64; 2]], places: &[SeenPlace]) -> impl Iterator<Item = Seen> + use<> {
        let mut way = vec![Point2::from(points[0])];
        for leg in points.windows(2) {
            let [from, to] = [leg[0], leg[1]].map(Point2::from);
            let steps = (distance(from, to) / 0.5).round() as u32;
            way.extend(
                (1..=steps).map(|step| from + f64::from(step) / f64::from(steps) * (to - from)),
            );
        }
        let places = places.to_vec();
        way.into_iter().map(move |robot| (robot, places.clone(), Vec::new()))
    }

    fn fork_at(x: f64) -> SeenPlace {
        place(Point2::new(x, 0.0), 1.0, &[PI, FRAC_PI_2, 0.0])
    }

    fn percepts(visits: &[Visit<usize>]) -> Vec<(u32, Option<u32>)> {
        visits.iter().map(|visit| (visit.percept().degree, visit.percept().door)).collect()
    }

    /// A way from the west to the east through the origin, in steps of half a metre.
    fn eastwards() -> impl Iterator<Item = Point2<f64>> {
        (-24..24).map(|step| Point2::new(0.5 * f64::from(step), 0.0))
    }

    /// The views of the way to it show that it may be a junction, and some or all of the later ones that it is one.
    #[test]
    fn a_junction_that_is_certain_only_once_the_robot_has_left_it_is_a_possible_visit() {
        let fork = place(Point2::origin(), 1.0, &[PI, FRAC_PI_2, 0.0]);
        for every in 1..4 {
            let views = eastwards().enumerate().map(|(number, robot)| {
                let is_certain = robot.x > 1.6 && number % every == 0;
                let (certain, possible) = if is_certain { (1, 0) } else { (0, 1) };
                (robot, vec![fork.clone(); certain], vec![fork.clone(); possible])
            });
            let visits = visits_by(views);
            let [visit] = &visits[..] else { panic!("{every}: {visits:?}") };
            let straight_on = Some(VisitPercept { degree: 3, door: Some(2) });
            assert_eq!(visit.alternatives(), [None, straight_on], "{every}");
        }
    }

    #[test]
    fn an_arm_in_some_of_the_views_is_possible() {
        let fork = [PI, FRAC_PI_2, 0.0];
        let seen = |every| {
            let visits = visits(&fork, 0.0, every);
            visits.iter().map(Visit::alternatives).collect::<Vec<_>>()
        };
        // Clockwise from the west, the north is door 1.
        let straight_on = Some(VisitPercept { degree: 3, door: Some(2) });
        assert_eq!(seen(1), [vec![straight_on]]);
        assert_eq!(seen(3), [vec![None, straight_on]], "in a third of the views");
        assert!(seen(100).is_empty());
    }

    #[test]
    fn a_robot_that_leaves_by_an_arm_beside_its_own_has_not_turned_back() {
        let beside = PI - 0.75;
        let went_back = |leaves| {
            let visits = visits(&[PI, beside, 0.0], leaves, 1);
            visits.iter().map(|visit| visit.goes_back).collect::<Vec<_>>()
        };
        assert_eq!(went_back(PI), [true]);
        assert_eq!(went_back(beside), [false]);
        assert_eq!(went_back(0.0), [false]);
    }

    #[test]
    fn a_robot_that_passes_beside_the_centre_of_a_place_has_not_gone_back() {
        // Seen from the centre it came from the south and left to the south, 3 m farther on.
        let lobby = place(Point2::new(0.0, 5.0), 5.15, &[-FRAC_PI_2, FRAC_PI_2, 0.0]);
        let visits = visits_by(eastwards().map(|robot| (robot, vec![lobby.clone()], Vec::new())));
        let [visit] = &visits[..] else { panic!("{visits:?}") };
        assert!(!visit.goes_back);
        assert_eq!(visit.alternatives(), [], "by which doors it went is not known");
    }

    #[test]
    fn a_possible_junction_that_is_noticed_late_was_entered_where_the_robot_came_from() {
        let fork = place(Point2::origin(), 1.0, &[PI, FRAC_PI_2, 0.0, -FRAC_PI_2]);
        let late = |robot: Point2<f64>| {
            let is_noticed = robot.x > 3.0;
            (robot, Vec::new(), if is_noticed { vec![fork.clone()] } else { Vec::new() })
        };
        let visits = visits_by(eastwards().map(late));
        let [visit] = &visits[..] else { panic!("{visits:?}") };
        assert!(!visit.goes_back);
        // It drove two of the arms.
        assert_eq!(visit.doors(), [PI, 0.0]);
        let percept = |degree, door| Some(VisitPercept { degree, door: Some(door) });
        assert_eq!(visit.alternatives(), [None, percept(3, 1), percept(3, 2), percept(4, 2)]);
    }

    #[test]
    fn a_visit_is_in_the_frame_of_odometry() {
        let odometry_from_map = Isometry2::new(nalgebra::Vector2::new(3.0, -2.0), 0.7);
        let robot = Robot { odometry_from_map, ..Robot::default() };
        let visits = robot.visits(along(&[[-12.0, 0.0], [12.0, 0.0]], &[fork_at(0.0)]));
        let [visit] = &visits[..] else { panic!("{visits:?}") };
        assert!(distance(visit.centre, [3.0, -2.0]) < 1e-9, "{visit:?}");
        let directions = [PI, FRAC_PI_2, 0.0].map(|direction| wrapped(direction + 0.7));
        let seen =
            visit.doors().into_iter().chain(visit.came).chain([visit.exit.unwrap().direction]);
        for (seen, expected) in
            seen.zip(directions.into_iter().chain([directions[0], directions[2]]))
        {
            assert!(wrapped(seen - expected).abs() < 1e-9, "{visit:?}");
        }
        assert_eq!(percepts(&visits), [(3, Some(2))]);
    }

    #[test]
    fn a_robot_that_goes_back_to_a_junction_has_turned_back_unless_it_turned_twice() {
        let turned = |way: &[f64]| {
            let way: Vec<_> = way.iter().map(|&x| [x, 0.0]).collect();
            let visits = visits_by(along(&way, &[fork_at(0.0), fork_at(20.0)]));
            visits.iter().map(|visit| (visit.centre.x, visit.turned_back.len())).collect::<Vec<_>>()
        };
        assert_eq!(turned(&[-12.0, 32.0]), [(0.0, 0), (20.0, 0)]);
        assert_eq!(turned(&[-12.0, 8.0, -12.0]), [(0.0, 0), (0.0, 1)]);
        assert_eq!(turned(&[-12.0, 10.0, 5.0, 32.0]), [(0.0, 0), (20.0, 0)]);
        assert_eq!(turned(&[-12.0, 10.0, 5.0, 12.0, -12.0]), [(0.0, 0), (0.0, 1)]);
        // Manoeuvring is no turning back.
        assert_eq!(turned(&[-12.0, 8.0, 7.0, 32.0]), [(0.0, 0), (20.0, 0)]);
    }

    #[test]
    fn a_robot_that_begins_at_a_junction_has_its_back_to_where_it_came_from() {
        let fork = [fork_at(0.0)];
        let north = visits_by(along(&[[0.0, 0.0], [0.0, 12.0]], &fork));
        assert_eq!(percepts(&north), [(3, Some(1))]);
        let east = visits_by(along(&[[0.0, 0.0], [12.0, 0.0]], &fork));
        assert_eq!(percepts(&east), [(3, Some(2))]);
        // Its log ends at the second junction, which is visited once.
        let both = [fork_at(0.0), fork_at(20.0)];
        let visits = visits_by(along(&[[0.0, 0.0], [20.0, 0.0]], &both));
        assert_eq!(percepts(&visits), [(3, Some(2)), (3, None)]);
    }

    #[test]
    fn a_dead_end_is_visited_by_a_robot_that_turns_back_there() {
        let end = place(Point2::new(10.0, 0.0), 1.0, &[PI]);
        let places = [fork_at(0.0), end];
        let there = along(&[[-12.0, 0.0], [8.5, 0.0], [-12.0, 0.0]], &places);
        let visits = Robot::with_corners().visits(there);
        assert_eq!(percepts(&visits), [(3, Some(2)), (1, Some(0)), (3, Some(1))], "{visits:?}");
        assert!(visits.iter().all(|visit| visit.turned_back.is_empty()));
        assert!(visits[1].goes_back && !visits[0].goes_back && !visits[2].goes_back);
        // Farther away it turns back in the corridor.
        let before = along(&[[-12.0, 0.0], [6.0, 0.0], [-12.0, 0.0]], &places);
        let visits = Robot::with_corners().visits(before);
        assert_eq!(percepts(&visits), [(3, Some(2)), (3, Some(1))]);
        assert_eq!(visits[1].turned_back.len(), 1);
    }

    #[test]
    fn a_robot_that_turns_in_a_corner_visits_it_and_a_corridor_may_go_straight_on_there() {
        let corner = [[-12.0, 0.0], [0.0, 0.0], [0.0, 12.0]];
        let visits = Robot::with_corners().visits(along(&corner, &[]));
        assert_eq!(percepts(&visits), [(2, Some(1))]);
        assert!(distance(visits[0].centre, [0.0; 2]) < 0.6 && visits[0].doubt.is_none());
        // Where it sees far, from the west to the east and from the north to the south.
        let seen = Robot { sight: f64::INFINITY, ..Robot::with_corners() };
        let visits = seen.visits(along(&corner, &[]));
        let percept = |degree, door| Some(VisitPercept { degree, door: Some(door) });
        let all = [percept(2, 1), percept(3, 1), percept(4, 1)];
        assert_eq!(visits[0].alternatives(), all);
        let arms = visits[0].arms.iter().map(|arm| arm.direction.to_degrees().round().abs());
        assert_eq!(arms.collect::<Vec<_>>(), [180.0, 90.0, 0.0, 90.0]);
        assert_eq!(visits[0].doubt, Some(UndecidedCause::Unclear));
        // Bends are no vertices, or the way to it is too short.
        assert!(visits_by(along(&corner, &[])).is_empty());
        let short = [[-3.0, 0.0], [0.0, 0.0], [0.0, 12.0]];
        assert!(Robot::with_corners().visits(along(&short, &[])).is_empty());
        // At a junction it is that of the junction.
        let visits = Robot::with_corners().visits(along(&corner, &[fork_at(0.0)]));
        assert_eq!(percepts(&visits), [(3, Some(1))]);
    }

    #[test]
    fn where_the_scanner_does_not_look_a_way_is_undecided() {
        let sector = ViewSector { first: -FRAC_PI_2, angle: PI };
        let robot = Robot { sector, ..Robot::default() };
        let visits = robot.visits(along(&[[0.0, 0.0], [-5.0, 0.0]], &[]));
        let [visit] = &visits[..] else { panic!("{visits:?}") };
        assert_eq!(visit.doubt, Some(UndecidedCause::UnseenWay));
        assert!(visit.alternatives().is_empty());
        assert!(robot.visits(along(&[[0.0, 0.0], [5.0, 0.0]], &[])).is_empty());
    }

    #[test]
    fn a_robot_is_at_a_junction_from_its_walls_on() {
        let views = along(&[[-6.0, 0.0], [6.0, 0.0]], &[fork_at(0.0)]);
        let (_, statuses) = Robot::default().statuses(views);
        let at: Vec<f64> = (-12..)
            .map(|step| 0.5 * f64::from(step))
            .zip(&statuses)
            .filter(|(_, status)| status.is_some())
            .map(|(x, _)| x)
            .collect();
        assert_eq!((at[0], at[at.len() - 1]), (-0.5, 1.0), "{at:?}");
        let here = statuses.iter().flatten().last().unwrap();
        assert_eq!((here.centre, here.arms.len()), (Point2::origin(), 3));
    }

    #[test]
    fn a_junction_far_along_a_bent_way_is_entered_from_where_the_robot_came() {
        let north = place(Point2::new(0.0, 20.0), 1.0, &[-FRAC_PI_2, FRAC_PI_2, 0.0]);
        let way = along(&[[-12.0, 0.0], [0.0, 0.0], [0.0, 32.0]], &[fork_at(0.0), north]);
        let visits = visits_by(way);
        assert_eq!(percepts(&visits), [(3, Some(1)), (3, Some(1))]);
        assert_eq!(visits[1].entry(), Some(-FRAC_PI_2));
    }

    #[test]
    fn an_arm_that_shows_only_behind_a_junction_is_one_of_its_arms() {
        let straight = place(Point2::origin(), 1.0, &[PI, 0.0]);
        let views = eastwards().map(|robot| {
            let seen = if robot.x < 1.6 { straight.clone() } else { fork_at(0.0) };
            (robot, vec![seen], Vec::new())
        });
        let visits = visits_by(views);
        assert_eq!(percepts(&visits), [(3, Some(2))]);
        assert_eq!(visits[0].doubt, None);
    }

    #[test]
    fn a_way_that_goes_straight_on_is_no_vertex_and_turning_back_there_is_turning_back() {
        let straight = place(Point2::new(10.0, 0.0), 1.0, &[PI, 0.0]);
        let alone = along(&[[-2.0, 0.0], [22.0, 0.0]], std::slice::from_ref(&straight));
        assert!(visits_by(alone).is_empty());
        let places = [fork_at(0.0), straight];
        // Within it, behind it, and so near to the fork that it is noticed only there.
        for turn in [10.0, 16.0, 2.0] {
            let way = along(&[[-12.0, 0.0], [turn, 0.0], [-12.0, 0.0]], &places);
            let visits = visits_by(way);
            let turned: Vec<_> =
                visits.iter().map(|visit| (visit.centre.x, visit.turned_back.len())).collect();
            assert_eq!(turned, [(0.0, 0), (0.0, 1)], "{turn}");
        }
        // Twice, once within it.
        let way = [[-12.0, 0.0], [16.0, 0.0], [10.0, 0.0], [32.0, 0.0]];
        let visits = visits_by(along(&way, &[places[0].clone(), places[1].clone(), fork_at(24.0)]));
        assert_eq!(percepts(&visits), [(3, Some(2)), (3, Some(2))]);
        assert!(visits[1].turned_back.is_empty());
    }

    #[test]
    fn a_corner_is_visited_where_a_log_ends_in_it_or_the_robot_turns_back() {
        let corner = place(Point2::new(10.0, 0.0), 1.0, &[PI, FRAC_PI_2]);
        let straight = place(Point2::new(10.0, 0.0), 1.0, &[PI, 0.0]);
        let visits = |way: &[[f64; 2]], place: &SeenPlace| {
            percepts(&Robot::with_corners().visits(along(way, std::slice::from_ref(place))))
        };
        let [begin, middle, end] = [[-2.0, 0.0], [10.0, 0.0], [10.0, 12.0]];
        assert_eq!(visits(&[begin, middle], &corner), [(2, None)]);
        assert_eq!(visits(&[begin, middle], &straight), []);
        assert_eq!(visits(&[begin, middle, begin], &corner), [(2, Some(0))]);
        // What it passes is visited once.
        assert_eq!(visits(&[begin, middle, end], &corner), [(2, Some(1))]);
        assert!(visits_by(along(&[begin, middle], &[corner])).is_empty());
    }

    #[test]
    fn a_bend_within_a_junction_is_that_of_the_junction_and_one_far_from_it_is_a_corner() {
        let lobby = place(Point2::origin(), 5.0, &[PI, FRAC_PI_2, 0.0]);
        let robot = Robot::with_corners();
        let within = robot.visits(along(&[[-16.0, 0.0], [0.0, 0.0], [0.0, 16.0]], &[lobby]));
        assert_eq!(percepts(&within), [(3, Some(1))]);
        let after = [[-12.0, 0.0], [12.0, 0.0], [12.0, 12.0]];
        let visits = robot.visits(along(&after, &[fork_at(0.0)]));
        assert_eq!(percepts(&visits), [(3, Some(2)), (2, Some(1))]);
    }
}
