//! How a robot in corridors drives: along its way, back, and around.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::Point2;
use toposlam_logs::record::{Frame, RunObserver};
use toposlam_model::{driving::scene::wrapped, percept::Sighting};
use toposlam_vision::{
    geometry::{direction, distance, unit},
    laser::{
        navigation::{LineEnd, WayAhead, WayChoice, along},
        scan::Reading,
    },
    place::SeenPlace,
};

use super::{
    CorridorExplorer, CorridorFailure, LeftPlace, StoodAt, Stop, marking::Sought, trail::Turn,
};
use crate::robot::Robot;

/// Why a robot does not go on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum NoWay {
    /// There is a wall, so many metres ahead.
    Wall(f64),
    /// What is there was not seen.
    Unseen,
    /// Something stops it where its map shows a way.
    Obstacle,
}

/// Parts of the length that the robot looks ahead on its way, the longest first.
const NEARER: [f64; 5] = [1.0, 0.75, 0.5, 0.25, 0.0];

/// How a stretch of the way ended.
enum StretchEnd {
    NoWay(NoWay),
    /// Beside an opening, where it has looked around.
    LookedAround,
    /// Within what may be a junction, and the direction from there to where it came in.
    AtPlace(SeenPlace, f64),
}

impl<R: Robot, O: RunObserver> CorridorExplorer<R, O> {
    /// Where the robot begins. If corners are vertices, it stands at one, with its back to a door, and else in a corridor.
    pub(super) fn begin(&mut self) -> Result<(), Stop> {
        self.sense()?;
        let heading = self.odometry().heading;
        self.heading = heading;
        if self.params.corner.corners {
            self.look_around()?;
            let entry = wrapped(heading + PI);
            if let Some(place) = self.visits.status()
                && self.decide(place, entry)?
            {
                return self.look_for_marker();
            }
        }
        self.drive(heading)
    }

    /// Looks for the marker from beside the place where the robot begins: it may lie below the robot.
    fn look_for_marker(&mut self) -> Result<(), Stop> {
        let Some(StoodAt { centre, extent, doors, .. }) = self.place.clone() else {
            return Ok(());
        };
        for door in doors.iter().rev() {
            let is_seen = self.place.as_ref().is_some_and(|at| at.sighting != Sighting::Nothing);
            if is_seen || self.sought == Sought::Nothing {
                break;
            }
            self.look_from_further(*door)?;
            self.stand(centre, extent, doors.clone())?;
        }
        Ok(())
    }

    /// A robot that another one sends waits with its back to the door by which it came.
    pub(super) fn turn_away_from_entry(&mut self) -> Result<(), Stop> {
        let entry = self.place.as_ref().and_then(|place| place.doors.first());
        if let Some(&entry) = entry.filter(|_| self.sought == Sought::Nothing) {
            self.robot.turn(self.odometry().seen(wrapped(entry + PI)))?;
        }
        Ok(())
    }

    /// Drives away in a direction until it is at a junction or a dead end.
    pub(super) fn drive(&mut self, towards: f64) -> Result<(), Stop> {
        (self.place, self.is_blocked) = (None, false);
        self.felt.clear();
        if self.trail.is_empty() {
            self.sense()?;
            self.look_around()?;
            let (centre, extent) = (self.on_local_map(), self.driving.end_extent);
            self.left = Some(LeftPlace { centre, extent, is_junction: true });
        } else if self.sought == Sought::Nothing {
            // Another robot has moved it.
            self.sense()?;
        }
        self.heading = towards;
        self.trail.leave();
        let (first, start) = (self.trail.len(), self.at());
        let mut begin = start;
        let mut is_leaving = true;
        let mut tried: Option<Point2<f64>> = None;
        let mut tried_turn: Option<Point2<f64>> = None;
        // The way from there without what it drove to look into arms, in metres.
        let mut along = 0.0;
        let no_way = loop {
            let end = self.drive_on(is_leaving)?;
            is_leaving = false;
            along += distance(begin, self.at());
            begin = self.at();
            match end {
                StretchEnd::AtPlace(place, entry) => {
                    if self.decide(place, entry)? {
                        return Ok(());
                    }
                    begin = self.at();
                }
                // What it saw before may have led it aside.
                StretchEnd::LookedAround => {
                    self.heading = wrapped(self.back(self.driving.leaving_measured) + PI);
                }
                StretchEnd::NoWay(no_way) => {
                    let at = self.at();
                    let is_new =
                        tried.is_none_or(|tried| distance(tried, at) > self.driving.no_junction);
                    let back = self.back(self.driving.bend_back);
                    if is_new && along > self.driving.bend_after && self.finds_bend(back)? {
                        tried = Some(at);
                        // No view shows a corner whose walls are hidden.
                        if self.params.corner.is_corner([back, self.heading]) {
                            return self.stand_at_corner([back, self.heading]);
                        }
                    } else if let Some((turn, before)) = self.turn_before_end(first, start, along)
                        && tried_turn
                            .is_none_or(|tried| distance(tried, turn.at) > self.driving.same_place)
                    {
                        self.go_straight_on(turn)?;
                        along = before;
                        (tried, tried_turn, begin) = (None, Some(turn.at), self.at());
                    } else {
                        break no_way;
                    }
                    is_leaving = true;
                }
            }
        };
        let left = match no_way {
            NoWay::Wall(left) => left,
            NoWay::Unseen | NoWay::Obstacle if self.returns_at_obstacles => {
                self.is_blocked = true;
                return self.stand_at_end();
            }
            NoWay::Unseen => return Err(CorridorFailure::Unseen.into()),
            NoWay::Obstacle => return Err(CorridorFailure::Stopped.into()),
        };
        if along + left < self.params.arm.min_arm {
            self.drive_back(first, start)?;
            let (centre, extent) = (self.on_local_map(), self.driving.end_extent);
            self.left = Some(LeftPlace { centre, extent, is_junction: true });
            return Err(CorridorFailure::Alcove.into());
        }
        self.stand_at_end()
    }

    /// Where it turned less than an arm before an end, and the length of its way to there: what ends may be an alcove, and the
    /// corridor goes straight on.
    fn turn_before_end(&self, first: usize, start: Point2<f64>, along: f64) -> Option<(Turn, f64)> {
        let turn = self.trail.last_turn(first, self.params.arm.min_arm, self.driving.turned)?;
        let before = (along - distance(turn.at, self.at())).max(distance(start, turn.at));
        (before > self.driving.bend_after).then_some((turn, before))
    }

    /// Drives back to where it turned, and looks straight on.
    fn go_straight_on(&mut self, turn: Turn) -> Result<(), Stop> {
        let Turn { number, at, before } = turn;
        self.drive_back(number, at)?;
        self.trail.end_side_trip(number);
        self.look_around()?;
        self.heading = direction(before, at);
        Ok(())
    }

    /// It stands in a corner, with the way back and another one.
    fn stand_at_corner(&mut self, ways: [f64; 2]) -> Result<(), Stop> {
        let (centre, extent) = (self.on_local_map(), self.driving.end_extent);
        self.left = Some(LeftPlace { centre, extent, is_junction: true });
        self.stand(self.at(), extent, ways.to_vec())
    }

    /// It stands where there is no way but the one back.
    fn stand_at_end(&mut self) -> Result<(), Stop> {
        self.left = None;
        let at = self.at();
        self.stand(at, self.driving.end_extent, vec![self.back(self.driving.near_place)])
    }

    /// The direction to where it was when it was last this far from here. Its heading may be that of a short way to look at
    /// something.
    pub(super) fn back(&self, far: f64) -> f64 {
        let at = self.at();
        let before = self.trail.before_entering(at, far);
        before.map_or(wrapped(self.heading + PI), |before| direction(at, before))
    }

    /// Whether a robot that cannot go straight on sees another way than the one back, in this direction, once it has looked
    /// around. Then it looks there.
    fn finds_bend(&mut self, back: f64) -> Result<bool, Stop> {
        self.look_around()?;
        let corner = &self.params.corner;
        let most = if corner.corners { corner.max_turn } else { PI - self.driving.same_way };
        let choice = WayChoice {
            towards: wrapped(back + PI - self.turn_of_map()),
            aside: most,
            measured: self.driving.bend_length,
        };
        let robot = self.on_local_map();
        let way = self.local_map().and_then(|map| map.way_ahead(robot, &choice));
        let to = way.and_then(|way| along(&way.line, self.driving.bend_length));
        let to = to.filter(|to| distance(robot, *to) > self.driving.bend_length / 2.0);
        if let Some(to) = to {
            self.heading = wrapped(direction(robot, to) + self.turn_of_map());
        }
        Ok(to.is_some())
    }

    /// Drives on until it is in the middle of what may be a junction, if it comes to one.
    fn drive_on(&mut self, mut is_leaving: bool) -> Result<StretchEnd, Stop> {
        let mut closest: Option<(f64, SeenPlace)> = None;
        let mut noticed = self.trail.len();
        loop {
            if let Some(no_way) = self.step(is_leaving)? {
                match closest {
                    Some(_) => break,
                    None => return Ok(StretchEnd::NoWay(no_way)),
                }
            }
            is_leaving = false;
            let place = if self.scanner.sees_arms {
                self.visits.status()
            } else {
                self.openings.last().cloned().flatten()
            };
            let place = place.filter(|place| !self.is_left(place));
            let place = place.map(|place| (distance(place.centre, self.on_local_map()), place));
            match (place, &closest) {
                (None, None) if self.is_at_opening && self.scanner.sees_arms => {
                    self.look_around()?;
                    return Ok(StretchEnd::LookedAround);
                }
                (None, None) => {}
                (Some(place), None) => {
                    noticed = self.trail.len().saturating_sub(2);
                    closest = Some(place);
                }
                (Some(place), Some((least, _))) if place.0 < *least => closest = Some(place),
                _ => break,
            }
        }
        let Some((_, mut place)) = closest else { return Err(CorridorFailure::Missed.into()) };
        if self.scanner.sees_arms {
            let entry = self.came_from(&place);
            self.go_to(&place)?;
            return Ok(StretchEnd::AtPlace(place, entry));
        }
        self.see_all_of(&mut place)?;
        // It drove past the step that is nearest to the centre, and goes back.
        let centre = self.odometry_from_map * place.centre;
        let past = self.trail.nearest(noticed, centre).map_or(noticed, |nearest| nearest + 1);
        self.trail.end_side_trip(past);
        let entry = self.came_from(&place);
        self.go_to(&place)?;
        self.trail.end_side_trip(past);
        Ok(StretchEnd::AtPlace(place, entry))
    }

    /// Goes a step along its way. Returns why, if it cannot.
    pub(super) fn step(&mut self, is_leaving: bool) -> Result<Option<NoWay>, Stop> {
        let robot = self.on_local_map();
        let Some(map) = self.local_map() else { return Ok(Some(NoWay::Unseen)) };
        let towards = wrapped(self.heading - self.turn_of_map());
        let choice = if is_leaving {
            WayChoice {
                towards,
                aside: self.driving.leaving,
                measured: self.driving.leaving_measured,
            }
        } else {
            WayChoice { towards, aside: self.driving.bend, measured: self.driving.look_ahead }
        };
        let look_ahead = self.driving.look_ahead;
        let straight = || map.straight_ahead(robot, towards, self.driving.before_wall, look_ahead);
        let mut way = map.way_ahead(robot, &choice).unwrap_or_else(straight);
        let left_of = |way: &WayAhead| along(&way.line, look_ahead).map(|to| distance(robot, to));
        let has_ended = |left: Option<f64>| left.is_none_or(|left| left < self.driving.at_end);
        if has_ended(left_of(&way)) && way.end == LineEnd::Unknown {
            let closer = straight();
            if left_of(&closer).is_some_and(|left| left > self.driving.look_closer) {
                way = closer;
            } else if !self.scanner.sees_arms && self.is_silent(towards) {
                let line = vec![robot, robot + look_ahead * unit(towards)];
                way = WayAhead { line, end: LineEnd::Unknown };
            }
        }
        let Some(target) = along(&way.line, look_ahead) else { return Ok(Some(NoWay::Unseen)) };
        let left = distance(robot, target);
        if left < self.driving.at_end {
            return match way.end {
                LineEnd::Wall(beyond) => Ok(Some(NoWay::Wall(left + beyond))),
                LineEnd::Unknown => Ok((!self.feels_for_wall()?).then_some(NoWay::Unseen)),
            };
        }
        // A wall may be between it and what is ahead on its way, as at a corner.
        let mut nearer = NEARER.iter().filter_map(|part| along(&way.line, part * look_ahead));
        let in_sight = nearer.find(|to| map.is_clear_between(robot, *to));
        let beyond = along(&way.line, 2.0 * look_ahead).unwrap_or(target);
        let target = in_sight.unwrap_or(target);
        let (target, beyond) = (self.odometry_from_map * target, self.odometry_from_map * beyond);
        let before = self.at();
        self.step_to(target)?;
        self.heading = if distance(before, self.at()) < self.driving.stuck {
            let ahead = direction(before, target);
            if !self.passes_beside(ahead)? {
                return Ok(Some(NoWay::Obstacle));
            }
            ahead
        } else if distance(self.at(), beyond) > self.driving.look_ahead / 2.0 {
            direction(self.at(), beyond)
        } else {
            direction(before, self.at())
        };
        Ok(None)
    }

    /// Whether nothing comes back from a direction on the local map, and nothing else is in the way there: what is ahead may
    /// be farther than a short range, as in a lobby.
    fn is_silent(&self, towards: f64) -> bool {
        let Some(Frame { odometry, scan: Some(scan), .. }) = &self.last else { return false };
        let ahead = odometry.seen(wrapped(towards + self.turn_of_map()));
        let (along, across) = (unit(ahead), unit(ahead + FRAC_PI_2));
        let reach = self.driving.look_ahead + self.driving.before_wall;
        let is_in_way = |hit: Point2<f64>| {
            (0.0..reach).contains(&hit.coords.dot(&along))
                && hit.coords.dot(&across).abs() < self.driving.room
        };
        let is_ahead = |bearing: f64| wrapped(bearing - ahead).abs() < self.driving.silent;
        let mut readings = scan.readings();
        readings.any(|(bearing, reading)| reading == Reading::NoReturn && is_ahead(bearing))
            && !scan.hits().any(is_in_way)
    }

    /// Whether a robot that is stopped where its map shows nothing, as by glass, passes a little beside it.
    fn passes_beside(&mut self, ahead: f64) -> Result<bool, Stop> {
        let turns = (1..=self.driving.beside).map(|turn| self.driving.beside_turn * turn as f64);
        for aside in turns.flat_map(|turn| [turn, -turn]) {
            let before = self.at();
            self.step_to(before + self.driving.look_ahead * unit(ahead + aside))?;
            if distance(before, self.at()) >= self.driving.step / 2.0 {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Turns to a point, goes up to a step towards it, and takes a scan.
    pub(super) fn step_to(&mut self, point: Point2<f64>) -> Result<(), Stop> {
        let at = self.odometry();
        let length = distance(at.position, point);
        if length < 1e-3 {
            return Ok(());
        }
        let mut turn = at.seen(direction(at.position, point));
        // A scanner that does not see all round sees what it passes while it turns.
        for _ in 0..self.driving.turns {
            if self.scanner.sees_all_round || turn.abs() <= self.driving.turn {
                break;
            }
            let part = self.driving.turn.copysign(turn);
            self.robot.turn(part)?;
            self.sense()?;
            turn = self.odometry().seen(direction(at.position, point));
        }
        if turn.abs() > self.driving.straight {
            self.robot.turn(turn)?;
        }
        self.robot.forward(length.min(self.driving.step))?;
        self.sense()?;
        self.heading = self.odometry().heading;
        Ok(())
    }

    /// Drives to points, one after the other, as far as it can.
    pub(super) fn drive_along(
        &mut self,
        points: impl IntoIterator<Item = Point2<f64>>,
    ) -> Result<(), Stop> {
        for point in points {
            let mut left = distance(self.at(), point);
            while left >= self.driving.at_point {
                self.step_to(point)?;
                let now = distance(self.at(), point);
                if now > left - self.driving.stuck {
                    break;
                }
                left = now;
            }
        }
        Ok(())
    }

    /// Drives back to a place where it was when its trail had this number of points.
    pub(super) fn drive_back(&mut self, begin: usize, place: Point2<f64>) -> Result<(), Stop> {
        let back = self.trail.back_to(begin.saturating_sub(1), self.driving.step);
        self.drive_along(back.into_iter().chain([place]))?;
        let is_there = distance(self.at(), place) < self.driving.at_centre;
        if is_there { Ok(()) } else { Err(CorridorFailure::Missed.into()) }
    }

    /// Drives on past an opening, so that its other side is on the local map, too.
    fn see_all_of(&mut self, opening: &mut SeenPlace) -> Result<(), Stop> {
        let begin = self.way;
        while self.way - begin < self.driving.past_opening && self.step(false)?.is_none() {}
        // There may be another one where it is now.
        if let Some(seen) = self.opening_at(opening.centre) {
            *opening = seen;
        }
        Ok(())
    }

    /// Goes to the centre of a place, if it can stand there.
    pub(super) fn go_to(&mut self, place: &SeenPlace) -> Result<(), Stop> {
        let map = self.local_map();
        let has_space = map.is_some_and(|map| map.has_space_at(place.centre, self.driving.room));
        let centre = self.odometry_from_map * place.centre;
        if has_space && distance(centre, self.at()) > self.driving.is_there {
            self.drive_along([centre])?;
        }
        Ok(())
    }

    pub(super) fn look_around(&mut self) -> Result<(), Stop> {
        self.looked = Some((self.on_local_map(), self.way));
        self.seen.clear();
        self.openings.clear();
        self.turn_around()?;
        self.is_at_opening = false;
        Ok(())
    }

    /// Turns around once where it is.
    pub(super) fn turn_around(&mut self) -> Result<(), Stop> {
        let parts = if self.scanner.sees_all_round {
            self.driving.round_views
        } else {
            self.driving.sector_views
        };
        for _ in 0..parts {
            self.robot.turn(TAU / parts as f64)?;
            self.sense()?;
        }
        Ok(())
    }
}
