//! How a robot in corridors drives: along its way, back, and around.

use std::f64::consts::{PI, TAU};

use nalgebra::Point2;
use toposlam_logs::record::RunObserver;
use toposlam_model::driving::scene::wrapped;
use toposlam_vision::{
    geometry::{direction, distance, unit},
    laser::navigation::{LineEnd, WayChoice, along},
    place::SeenPlace,
};

use super::{CorridorExplorer, CorridorFailure, LeftPlace, ROBOT, Stop, trail::Turn};
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

/// How a stretch of the way ended.
enum StretchEnd {
    NoWay(NoWay),
    /// Beside an opening, where it has looked around.
    LookedAround,
    /// Within what may be a junction, and the direction from there to where it came in.
    AtPlace(SeenPlace, f64),
}

impl<R: Robot, O: RunObserver> CorridorExplorer<R, O> {
    /// Drives away in a direction until it is at a junction or a dead end.
    pub(super) fn drive(&mut self, towards: f64) -> Result<(), Stop> {
        (self.place, self.is_blocked) = (None, false);
        if self.trail.is_empty() {
            self.sense()?;
        }
        self.heading = towards;
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
                    self.heading = wrapped(self.back(ROBOT.leaving_measured) + PI);
                }
                StretchEnd::NoWay(no_way) => {
                    let at = self.at();
                    let is_new = tried.is_none_or(|tried| distance(tried, at) > ROBOT.no_junction);
                    if is_new && along > ROBOT.bend_after && self.finds_bend()? {
                        tried = Some(at);
                    } else if let Some((turn, before)) = self.turn_before_end(first, start, along)
                        && tried_turn
                            .is_none_or(|tried| distance(tried, turn.at) > ROBOT.same_place)
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
            let (centre, extent) = (self.on_local_map(), ROBOT.end_extent);
            self.left = Some(LeftPlace { centre, extent, is_junction: true });
            return Err(CorridorFailure::Alcove.into());
        }
        self.stand_at_end()
    }

    /// Where it turned less than an arm before an end, and the length of its way to there: what ends may be an alcove, and the
    /// corridor goes straight on.
    fn turn_before_end(&self, first: usize, start: Point2<f64>, along: f64) -> Option<(Turn, f64)> {
        let turn = self.trail.last_turn(first, self.params.arm.min_arm, ROBOT.turned)?;
        let before = (along - distance(turn.at, self.at())).max(distance(start, turn.at));
        (before > ROBOT.bend_after).then_some((turn, before))
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

    /// It stands where there is no way but the one back.
    fn stand_at_end(&mut self) -> Result<(), Stop> {
        self.left = None;
        let at = self.at();
        self.stand(at, ROBOT.end_extent, vec![self.back(ROBOT.near_place)])
    }

    /// The direction to where it was when it was last this far from here. Its heading may be that of a short way to look at
    /// something.
    fn back(&self, far: f64) -> f64 {
        let at = self.at();
        let before = self.trail.before_entering(at, far);
        before.map_or(wrapped(self.heading + PI), |before| direction(at, before))
    }

    /// Whether a robot that cannot go straight on sees another way than the one back, once it has looked around. Then it
    /// looks there.
    fn finds_bend(&mut self) -> Result<bool, Stop> {
        let back = self.back(ROBOT.look_ahead);
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
            WayChoice { towards, aside: ROBOT.leaving, measured: ROBOT.leaving_measured }
        } else {
            WayChoice { towards, aside: ROBOT.bend, measured: ROBOT.look_ahead }
        };
        let way = map.way_ahead(robot, &choice).unwrap_or_else(|| {
            map.straight_ahead(robot, towards, ROBOT.before_wall, ROBOT.look_ahead)
        });
        let Some(target) = along(&way.line, ROBOT.look_ahead) else {
            return Ok(Some(NoWay::Unseen));
        };
        let left = distance(robot, target);
        if left < ROBOT.at_end {
            return Ok(Some(match way.end {
                LineEnd::Wall(beyond) => NoWay::Wall(left + beyond),
                LineEnd::Unknown => NoWay::Unseen,
            }));
        }
        let beyond = along(&way.line, 2.0 * ROBOT.look_ahead).unwrap_or(target);
        let (target, beyond) = (self.odometry_from_map * target, self.odometry_from_map * beyond);
        let before = self.at();
        self.step_to(target)?;
        self.heading = if distance(before, self.at()) < ROBOT.stuck {
            let ahead = direction(before, target);
            if !self.passes_beside(ahead)? {
                return Ok(Some(NoWay::Obstacle));
            }
            ahead
        } else if distance(self.at(), beyond) > ROBOT.look_ahead / 2.0 {
            direction(self.at(), beyond)
        } else {
            direction(before, self.at())
        };
        Ok(None)
    }

    /// Whether a robot that is stopped where its map shows nothing, as by glass, passes a little beside it.
    fn passes_beside(&mut self, ahead: f64) -> Result<bool, Stop> {
        let turns = (1..=ROBOT.beside).map(|turn| ROBOT.beside_turn * turn as f64);
        for aside in turns.flat_map(|turn| [turn, -turn]) {
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
        for _ in 0..ROBOT.turns {
            if self.scanner.sees_all_round || turn.abs() <= ROBOT.turn {
                break;
            }
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
    pub(super) fn drive_along(
        &mut self,
        points: impl IntoIterator<Item = Point2<f64>>,
    ) -> Result<(), Stop> {
        for point in points {
            let mut left = distance(self.at(), point);
            while left >= ROBOT.at_point {
                self.step_to(point)?;
                let now = distance(self.at(), point);
                if now > left - ROBOT.stuck {
                    break;
                }
                left = now;
            }
        }
        Ok(())
    }

    /// Drives back to a place where it was when its trail had this number of points.
    pub(super) fn drive_back(&mut self, begin: usize, place: Point2<f64>) -> Result<(), Stop> {
        let back = self.trail.back_to(begin.saturating_sub(1), ROBOT.step);
        self.drive_along(back.into_iter().chain([place]))?;
        let is_there = distance(self.at(), place) < ROBOT.at_centre;
        if is_there { Ok(()) } else { Err(CorridorFailure::Missed.into()) }
    }

    /// Drives on past an opening, so that its other side is on the local map, too.
    fn see_all_of(&mut self, opening: &mut SeenPlace) -> Result<(), Stop> {
        let begin = self.way;
        while self.way - begin < ROBOT.past_opening && self.step(false)?.is_none() {}
        // There may be another one where it is now.
        if let Some(seen) = self.opening_at(opening.centre) {
            *opening = seen;
        }
        Ok(())
    }

    /// Goes to the centre of a place, if it can stand there.
    pub(super) fn go_to(&mut self, place: &SeenPlace) -> Result<(), Stop> {
        let map = self.local_map();
        let has_space = map.is_some_and(|map| map.has_space_at(place.centre, ROBOT.room));
        let centre = self.odometry_from_map * place.centre;
        if has_space && distance(centre, self.at()) > ROBOT.is_there {
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
        let parts =
            if self.scanner.sees_all_round { ROBOT.round_views } else { ROBOT.sector_views };
        for _ in 0..parts {
            self.robot.turn(TAU / parts as f64)?;
            self.sense()?;
        }
        Ok(())
    }
}
