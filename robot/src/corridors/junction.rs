//! What a robot in corridors takes for a junction: by what it sees there, and by driving into its arms.

use std::f64::consts::{PI, TAU};

use nalgebra::Point2;
use toposlam_logs::record::RunObserver;
use toposlam_model::driving::scene::wrapped;
use toposlam_vision::{
    geometry::{clockwise, direction, distance, nearest},
    laser::{navigation::OpeningLimits, params::CornerParams},
    place::{Certainty, PlaceArm, SeenPlace},
};

use super::{
    CorridorExplorer, CorridorFailure, LeftPlace, SideTrip, Stop, motion::NoWay,
    params::CorridorParams,
};
use crate::robot::Robot;

/// Whether a way is an arm; `None` if that is undecided.
type IsArm = Option<bool>;

impl<R: Robot, O: RunObserver> CorridorExplorer<R, O> {
    /// Where any ways of the local map meet near a point.
    pub(super) fn opening_at(&self, point: Point2<f64>) -> Option<SeenPlace> {
        let limits =
            OpeningLimits { near: self.driving.near_opening, together: self.driving.one_opening };
        self.local_map()?.opening(point, limits)
    }

    /// Decides which doors a place has, and stands there; false if it is no junction.
    pub(super) fn decide(&mut self, mut place: SeenPlace, entry: f64) -> Result<bool, Stop> {
        let doors = if self.scanner.sees_arms {
            self.doors_of(&mut place, entry)
        } else {
            self.driven_doors(&place, entry)
        };
        // A robot that stops at corners may have seen one beside the next place.
        let is_junction =
            self.scanner.sees_arms && !self.params.corner.corners || !matches!(doors, Ok(None));
        let SeenPlace { centre, clearance: extent, .. } = place;
        self.left = Some(LeftPlace { centre, extent, is_junction });
        // It goes on where it would have gone.
        self.heading = wrapped(entry + PI);
        let Some(doors) = doors? else { return Ok(false) };
        self.stand(self.odometry_from_map * centre, extent, doors)?;
        Ok(true)
    }

    /// The directions of the doors of the place where it stands, clockwise from the entry, if the robot drives into each way that
    /// leaves an opening, the one straight on last; `None` if it is no junction.
    fn driven_doors(&mut self, opening: &SeenPlace, entry: f64) -> Result<Option<Vec<f64>>, Stop> {
        self.look_around()?;
        let mut doors = vec![entry];
        let mut tried: Vec<f64> = Vec::new();
        for _ in 0..self.driving.looks {
            let is_old = |way: f64, old: f64| wrapped(way - old).abs() < self.driving.same_way;
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
            let is_arm = is_arm.ok_or(CorridorFailure::Undecided)?;
            if is_arm && !doors.iter().any(|&door| self.driving.is_same_arm(door, driven)) {
                doors.push(driven);
            }
        }
        in_order(doors, entry, self.driving, &self.params.corner)
    }

    /// The directions of the ways that leave an opening in at least two of the views there.
    fn ways_of(&self, opening: &SeenPlace) -> Vec<f64> {
        let mut ways: Vec<(f64, usize)> = Vec::new();
        let here =
            |seen: &&SeenPlace| distance(seen.centre, opening.centre) < self.driving.same_place;
        for seen in self.openings.iter().flatten().filter(here) {
            for direction in seen.directions() {
                match ways
                    .iter_mut()
                    .find(|way| wrapped(way.0 - direction).abs() < self.driving.same_way)
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
        let mut doubted = DoubtedArms::new(entry, self.driving);
        self.look_around()?;
        let least_doors = if self.params.corner.corners { 2 } else { 3 };
        let (mut has_moved, mut tries, mut centred) = (false, 0, 0);
        for _ in 0..self.driving.looks {
            let status = self.visits.status().map(|place| self.unless_mistaken(place));
            // Where it has driven into an arm is a place, whatever the views show.
            let Some(place) = status.or_else(|| doubted.has_arm().then(|| last.clone())) else {
                let robot = self.on_local_map();
                let off = |seen: &&SeenPlace| distance(seen.centre, robot);
                let near = nearest(self.seen.last().into_iter().flatten(), off)
                    .filter(|seen| off(seen) < self.driving.same_place && !has_moved);
                let Some(seen) = near.cloned() else { return Ok(None) };
                has_moved = true;
                self.go_to(&seen)?;
                self.look_around()?;
                continue;
            };
            if centred < self.driving.centred && self.goes_to_centre_of(&place)? {
                centred += 1;
                continue;
            }
            last.clone_from(self.in_last_view(&place).unwrap_or(&place));
            let seen = self.seen_arms(&place);
            doubted.add(seen.iter().filter(|arm| !arm.is_certain).map(|arm| arm.direction));
            if !self.scanner.sees_beyond_arms {
                doubted.add_silent(self.silent_ways().into_iter());
            }
            let certain = seen.iter().filter(|arm| arm.is_certain).map(|arm| arm.direction);
            let certain: Vec<f64> = certain.collect();
            if let Some(arm) = doubted.next(&certain, least_doors) {
                let (driven, is_arm) = self.look_into(arm, false)?;
                doubted.decide(arm, driven, is_arm, &certain)?;
                continue;
            }
            let is_undecided = place.arms.iter().any(|arm| arm.certainty == Certainty::Possible);
            if is_undecided && !doubted.is_decided() {
                if tries == 2 {
                    return Err(CorridorFailure::Undecided.into());
                }
                tries += 1;
                self.look_from_further(entry + PI * f64::from(tries))?;
                continue;
            }
            let turn = self.turn_of_map();
            let doors = if is_undecided || place.arms.is_empty() && doubted.has_arm() {
                let is_door = |arm: &&SeenArm| is_undecided || arm.is_certain;
                seen.iter().filter(is_door).map(|arm| arm.direction).collect()
            } else {
                place.directions().map(|door| wrapped(door + turn)).collect()
            };
            return in_order(doubted.doors(doors), entry, self.driving, &self.params.corner);
        }
        Err(CorridorFailure::Undecided.into())
    }

    /// A place without arms looked like one in earlier views alone. Then the junction is the one that the last view shows beside
    /// it, if each of its arms is certain.
    fn unless_mistaken(&self, place: SeenPlace) -> SeenPlace {
        if !place.arms.is_empty() {
            return place;
        }
        let view = self.seen.last().map(Vec::as_slice).unwrap_or_default();
        let beside = seen_at(view, &place, self.driving.same_place);
        let is_certain =
            |seen: &&SeenPlace| seen.arms.len() >= 3 && seen.arms.iter().all(PlaceArm::is_certain);
        beside.filter(is_certain).cloned().unwrap_or(place)
    }

    /// The same place, as the last view shows it.
    fn in_last_view(&self, place: &SeenPlace) -> Option<&SeenPlace> {
        seen_at(self.seen.last()?, place, self.driving.at_centre)
    }

    /// Goes to the centre of a place, as the last view shows it, and looks around there. Returns whether it was farther away.
    fn goes_to_centre_of(&mut self, place: &SeenPlace) -> Result<bool, Stop> {
        let seen = self.in_last_view(place).unwrap_or(place).clone();
        let is_off = distance(seen.centre, self.on_local_map()) > self.driving.off_centre;
        if is_off {
            self.go_to(&seen)?;
            self.look_around()?;
        }
        Ok(is_off)
    }

    /// Drives into an arm and back. Returns the direction in which it drove, and whether it could drive as far as makes an
    /// arm. If the place is to be seen from nearby only, what is seen from farther away is forgotten.
    fn look_into(&mut self, towards: f64, from_nearby: bool) -> Result<(f64, IsArm), Stop> {
        let (first, begin, felt) = (self.trail.len(), self.at(), self.felt.len());
        if from_nearby {
            let visits = self.visits.clone();
            self.side_trip = Some(SideTrip { from: begin, visits, near: Vec::new() });
        }
        self.heading = towards;
        let least = self.params.arm.min_arm;
        let (mut length, mut is_leaving) = (0.0, true);
        let mut left: Option<Point2<f64>> = None;
        let is_arm = loop {
            let before = self.at();
            let no_way = self.step(is_leaving)?;
            is_leaving = false;
            length += distance(before, self.at());
            if distance(begin, self.at()) >= self.driving.leaving_measured {
                left.get_or_insert(self.at());
            }
            match no_way {
                _ if length >= least => break Some(true),
                None => {}
                Some(NoWay::Wall(left)) => break Some(length + left >= least),
                Some(NoWay::Unseen | NoWay::Obstacle) => break None,
            }
        };
        let far = left.unwrap_or(self.at());
        self.drive_back(first, begin)?;
        self.trail.end_side_trip(first);
        if let Some(SideTrip { visits, near, .. }) = self.side_trip.take() {
            self.visits = visits;
            for (scan, odometry) in near {
                if let Some(view) = self.visits.add_frame((), &scan, &odometry) {
                    self.odometry_from_map = view.odometry_from_map;
                }
            }
            self.remember_walls(felt);
        }
        self.look_around()?;
        // It may have gone through the middle of the place first.
        let driven =
            if distance(begin, far) > self.driving.step { direction(begin, far) } else { towards };
        Ok((driven, is_arm))
    }

    /// Goes a little further, looks around there, and comes back.
    pub(super) fn look_from_further(&mut self, towards: f64) -> Result<(), Stop> {
        let begin = self.at();
        let way = self.way;
        self.heading = towards;
        let mut is_leaving = true;
        while self.way - way < self.driving.further && self.step(is_leaving)?.is_none() {
            is_leaving = false;
        }
        self.turn_around()?;
        self.drive_along([begin])?;
        self.look_around()
    }

    /// The arms of a place on the local map that at least two of the last views show.
    fn seen_arms(&self, place: &SeenPlace) -> Vec<SeenArm> {
        let views = &self.seen[self.seen.len().saturating_sub(self.driving.views)..];
        // The direction, the number of views that show the arm, and of those in which it is certain.
        let mut arms: Vec<(f64, usize, usize)> = Vec::new();
        for seen in views.iter().filter_map(|view| seen_at(view, place, self.driving.at_centre)) {
            for arm @ &PlaceArm { direction, .. } in &seen.arms {
                let certain = usize::from(arm.is_certain());
                match arms.iter_mut().find(|known| self.driving.is_same_arm(known.0, direction)) {
                    Some(known) => (known.1, known.2) = (known.1 + 1, known.2 + certain),
                    None => arms.push((direction, 1, certain)),
                }
            }
        }
        let enough = (self.driving.certain * views.len() as f64).ceil() as usize;
        let turn = self.turn_of_map();
        let seen = |(direction, _, certain)| SeenArm {
            direction: wrapped(direction + turn),
            is_certain: certain >= enough,
        };
        arms.into_iter().filter(|arm| arm.1 > 1).map(seen).collect()
    }

    /// The direction from a place to where the robot was before.
    pub(super) fn came_from(&self, place: &SeenPlace) -> f64 {
        let centre = self.odometry_from_map * place.centre;
        // It may have passed the place at a distance.
        let last = self.trail.without_side_trips().next().map_or(0.0, |at| distance(at, centre));
        let far = (place.clearance.max(1.0) + self.driving.came_from).max(last + 0.1);
        let before = self.trail.before_entering(centre, far);
        before.map_or(wrapped(self.heading + PI), |point| direction(centre, point))
    }

    /// Whether a place is the one that it left last.
    pub(super) fn is_left(&self, place: &SeenPlace) -> bool {
        self.left.is_some_and(|left| {
            let reach = if left.is_junction {
                self.driving.left_behind.max(1.5 * left.extent)
            } else {
                self.driving.no_junction
            };
            distance(left.centre, place.centre) < reach
        })
    }
}

/// An arm that several views show.
struct SeenArm {
    direction: f64,
    /// Whether it is certain in most of the views.
    is_certain: bool,
}

/// The arms of a place of which a robot does not see enough, and what it found out when it drove into them. Views that follow
/// may not show an arm that is there: the robot has looked from elsewhere, and what is possible is often so by a hair.
struct DoubtedArms<'d> {
    /// The direction in which the robot came in: an arm.
    entry: f64,
    driving: &'d CorridorParams,
    /// The directions, and whether they are arms; `None` if the robot has not driven into them.
    arms: Vec<(f64, IsArm)>,
    /// The directions from which nothing came back: an arm may be there if the robot can drive there.
    silent: Vec<f64>,
}

impl<'d> DoubtedArms<'d> {
    fn new(entry: f64, driving: &'d CorridorParams) -> Self {
        Self { entry, driving, arms: Vec::new(), silent: Vec::new() }
    }

    fn is_old(&self, direction: f64) -> bool {
        let mut old = self.arms.iter().map(|arm| arm.0).chain([self.entry]);
        old.any(|old| self.driving.is_same_arm(old, direction))
    }

    fn add(&mut self, directions: impl Iterator<Item = f64>) {
        for direction in directions {
            if !self.is_old(direction) {
                self.arms.push((direction, None));
            }
        }
    }

    /// Adds directions from which nothing comes back, each once.
    fn add_silent(&mut self, directions: impl Iterator<Item = f64>) {
        for direction in directions {
            let is_tried = self.silent.iter().any(|&old| self.driving.is_same_arm(old, direction));
            if !is_tried && !self.is_old(direction) {
                self.silent.push(direction);
                self.arms.push((direction, None));
            }
        }
    }

    /// The robot has looked for an arm, and drove in the second direction. If it turned into another way, as into one of these
    /// certain arms, nothing is known of this one. That is an error if it was seen.
    fn decide(
        &mut self,
        direction: f64,
        driven: f64,
        is_arm: IsArm,
        certain: &[f64],
    ) -> Result<(), CorridorFailure> {
        let Self { entry, driving, arms, silent } = self;
        let off = |arm: f64| wrapped(arm - driven).abs();
        let others = certain.iter().copied().chain([*entry]).chain(arms.iter().map(|arm| arm.0));
        let is_nearest = others.into_iter().all(|other| off(other) >= off(direction));
        let is_arm = is_arm.filter(|_| is_nearest && driving.is_same_arm(driven, direction));
        let is_this = |other: f64| driving.is_same_arm(other, direction);
        if is_arm.is_none() {
            if !silent.iter().any(|&silent| is_this(silent)) {
                return Err(CorridorFailure::Undecided);
            }
            arms.retain(|arm| !is_this(arm.0));
        } else if let Some(arm) = arms.iter_mut().find(|arm| is_this(arm.0)) {
            arm.1 = is_arm;
        }
        Ok(())
    }

    /// Whether the robot has driven into an arm.
    fn has_arm(&self) -> bool {
        self.arms.iter().any(|arm| arm.1 == Some(true))
    }

    /// Whether it has driven into anything.
    fn is_decided(&self) -> bool {
        self.arms.iter().any(|arm| arm.1.is_some())
    }

    /// The arm into which to drive next, if with all those in doubt and these certain ones there are enough doors.
    fn next(&self, certain: &[f64], least_doors: usize) -> Option<f64> {
        let is_certain =
            |arm: f64| certain.iter().any(|&known| self.driving.is_same_arm(known, arm));
        let is_open = |arm: &&(f64, IsArm)| arm.1.is_none() && !is_certain(arm.0);
        let is_door = |arm: &&(f64, IsArm)| arm.1 != Some(false) && !is_certain(arm.0);
        let is_other = |arm: &&f64| !self.driving.is_same_arm(**arm, self.entry);
        let certain_doors = certain.iter().filter(is_other).count();
        let doors = 1 + certain_doors + self.arms.iter().filter(is_door).count();
        let next = self.arms.iter().find(is_open);
        next.filter(|_| doors >= least_doors).map(|arm| arm.0)
    }

    /// These doors without what is no arm, and with what is one.
    fn doors(&self, mut doors: Vec<f64>) -> Vec<f64> {
        let is_in =
            |doors: &[f64], arm| doors.iter().any(|&door| self.driving.is_same_arm(door, arm));
        for &(arm, is_arm) in &self.arms {
            match is_arm {
                Some(false) => doors.retain(|&door| !self.driving.is_same_arm(door, arm)),
                Some(true) if !is_in(&doors, arm) => doors.push(arm),
                _ => {}
            }
        }
        if self.has_arm() && !is_in(&doors, self.entry) {
            doors.push(self.entry);
        }
        doors
    }
}

/// What may be a junction at a place, in a view.
fn seen_at<'v>(view: &'v [SeenPlace], place: &SeenPlace, near: f64) -> Option<&'v SeenPlace> {
    let off = |seen: &&SeenPlace| distance(seen.centre, place.centre);
    nearest(view, off).filter(|seen| off(seen) < place.clearance.max(near))
}

/// The directions of doors, clockwise from the one by which the robot came in, from about this direction; `None` if they are
/// not those of a vertex: a junction with at least three, or a corner.
fn in_order(
    mut doors: Vec<f64>,
    entry: f64,
    driving: &CorridorParams,
    corner: &CornerParams,
) -> Result<Option<Vec<f64>>, Stop> {
    let is_vertex = match doors[..] {
        [one, other] => corner.is_corner([one, other]),
        _ => doors.len() >= 3,
    };
    if !is_vertex {
        return Ok(None);
    }
    let off = |door: &f64| wrapped(door - entry).abs();
    let first = nearest(doors.iter().copied(), off).filter(|door| off(door) < driving.entry);
    let first = first.ok_or(CorridorFailure::Undecided)?;
    let turn = |door: f64| {
        let turn = clockwise(first, door);
        if turn > TAU - 1e-9 { 0.0 } else { turn }
    };
    doors.sort_by(|&one, &other| turn(one).total_cmp(&turn(other)));
    Ok(Some(doors))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The doors in order; empty if the robot does not know which of them it drove.
    fn order(doors: &[f64], entry: f64, corner: &CornerParams) -> Option<Vec<f64>> {
        match in_order(doors.to_vec(), entry, &CorridorParams::DEFAULT, corner) {
            Ok(doors) => doors,
            Err(Stop::Failure(CorridorFailure::Undecided)) => Some(Vec::new()),
            Err(Stop::Failure(_) | Stop::Error(_)) => panic!(),
        }
    }

    #[test]
    fn a_robot_drives_into_each_arm_that_was_in_doubt_and_believes_that_whatever_it_sees_later() {
        let mut doubted = DoubtedArms::new(PI, &CorridorParams::DEFAULT);
        doubted.add([1.5, -1.4, -3.1].into_iter());
        assert_eq!(doubted.next(&[-1.5], 3), Some(1.5), "the other one is certain");
        assert_eq!(doubted.next(&[0.0], 5), None, "there are at most four doors");
        doubted.decide(1.5, 1.6, Some(true), &[]).unwrap();
        doubted.add([1.3].into_iter());
        assert_eq!(doubted.next(&[], 3), Some(-1.4), "no view shows any of them now");
        doubted.decide(-1.4, -1.4, Some(true), &[]).unwrap();
        assert_eq!(doubted.next(&[], 3), None);
        assert_eq!(doubted.doors(Vec::new()), [1.5, -1.4, PI], "it came in somewhere, too");
        assert_eq!(doubted.doors(vec![3.0, 1.6]), [3.0, 1.6, -1.4]);
    }

    #[test]
    fn an_arm_is_undecided_if_the_robot_turned_into_another_way_or_could_not_go_on() {
        let mut doubted = DoubtedArms::new(PI, &CorridorParams::DEFAULT);
        doubted.add([1.5].into_iter());
        for (driven, is_arm) in [(0.2, Some(true)), (0.2, Some(false)), (1.5, None)] {
            let decided = doubted.decide(1.5, driven, is_arm, &[]);
            assert_eq!(decided, Err(CorridorFailure::Undecided), "{driven} {is_arm:?}");
        }
        // It drove nearer to the direction of another arm.
        for (driven, certain) in [(1.1, vec![0.0, 0.95]), (2.0, vec![2.3])] {
            let decided = doubted.decide(1.5, driven, Some(true), &certain);
            assert_eq!(decided, Err(CorridorFailure::Undecided), "{driven} {certain:?}");
        }
        assert!(!doubted.is_decided());
        assert_eq!(doubted.next(&[0.0], 3), Some(1.5));
        doubted.decide(1.5, 1.2, Some(true), &[0.0, 0.8]).unwrap();
    }

    #[test]
    fn what_is_silent_is_an_arm_only_if_the_robot_drove_there_and_is_tried_once() {
        let mut doubted = DoubtedArms::new(PI, &CorridorParams::DEFAULT);
        let silent = || [1.5, -1.4, -3.1].into_iter();
        doubted.add_silent(silent());
        assert_eq!(doubted.next(&[0.0], 3), Some(1.5));
        doubted.decide(1.5, 0.2, Some(true), &[]).unwrap();
        doubted.add_silent(silent());
        assert_eq!(doubted.next(&[0.0], 3), Some(-1.4));
        assert_eq!(doubted.doors(vec![1.6, 0.0]), [1.6, 0.0], "nothing was found out");
        doubted.decide(-1.4, -1.4, Some(true), &[]).unwrap();
        assert_eq!(doubted.doors(vec![0.0]), [0.0, -1.4, PI]);
        // It is seen now.
        doubted.add([1.5].into_iter());
        assert_eq!(doubted.next(&[0.0], 3), Some(1.5));
    }

    #[test]
    fn what_is_no_arm_is_no_door_and_the_last_one_in_doubt_may_not_matter() {
        let mut doubted = DoubtedArms::new(PI, &CorridorParams::DEFAULT);
        doubted.add([1.5, -1.4].into_iter());
        doubted.decide(1.5, 1.5, Some(false), &[]).unwrap();
        assert_eq!(doubted.next(&[], 3), None, "two doors are no junction");
        assert_eq!(doubted.next(&[], 2), Some(-1.4), "but perhaps a corner");
        assert_eq!(doubted.next(&[0.0], 3), Some(-1.4));
        assert_eq!(doubted.doors(vec![1.6, 0.0]), [0.0]);
    }

    #[test]
    fn doors_are_clockwise_from_the_one_by_which_the_robot_came() {
        let corner = CornerParams::DEFAULT;
        let doors = [0.1, 1.7, -3.0];
        assert_eq!(order(&doors, -3.1, &corner), Some(vec![-3.0, 1.7, 0.1]));
        assert_eq!(order(&doors, 1.5, &corner), Some(vec![1.7, 0.1, -3.0]));
        // Nobody knows which door is the one that the robot drove.
        assert_eq!(order(&doors, -1.4, &corner), Some(Vec::new()));
    }

    #[test]
    fn two_doors_are_those_of_a_vertex_if_corners_are_vertices_and_the_way_bends_enough() {
        let corners = CornerParams { corners: true, ..CornerParams::DEFAULT };
        assert_eq!(order(&[1.5, 0.0], 0.1, &corners), Some(vec![0.0, 1.5]));
        assert_eq!(order(&[1.5, 0.0], 0.1, &CornerParams::DEFAULT), None);
        assert_eq!(order(&[3.0, 0.0], 0.1, &corners), None, "a hallway that goes straight on");
        assert_eq!(order(&[0.5, 0.0], 0.1, &corners), None, "both doors lead back");
    }
}
