//! What a robot in corridors sees of its marker, or of the other robot of its team, and what it does with it.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Point2;
use toposlam_logs::record::{EventKind, RunObserver};
use toposlam_model::{
    aid::{AidAction, AidKind},
    driving::scene::{undirected, wrapped},
    percept::{Door, OtherRobot, Sighting, TeamView},
    world::AidHandler,
};
use toposlam_vision::geometry::{direction, distance, nearest};

use super::{CorridorExplorer, CorridorFailure, SeenMarker, StoodAt, Stop, params::CorridorParams};
use crate::{
    explorer::{ExplorerError, MappingRobot},
    robot::{Robot, RobotError},
};

/// For what a robot looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Sought {
    /// A marker that points along a door.
    #[default]
    Pointing,
    /// Markers that point along no door.
    Lying,
    /// The other robot of its team.
    Team,
    /// Nothing: another robot sends it.
    Nothing,
}

impl Sought {
    /// That of a robot with this marking aid.
    pub(super) fn of(aid: AidKind) -> Self {
        match aid {
            AidKind::Markers(_) => Self::Lying,
            AidKind::Team(_) => Self::Team,
            _ => Self::Pointing,
        }
    }
}

/// The other robot is not there if so many scans in a row do not show it.
const LOOKS: u32 = 3;

impl<R: Robot, O: RunObserver> CorridorExplorer<R, O> {
    /// What it sees at a place of this extent, with doors in these directions.
    pub(super) fn sighting(
        &mut self,
        centre: Point2<f64>,
        extent: f64,
        doors: &[f64],
    ) -> Result<Sighting, Stop> {
        match (self.sought, self.marker_at(centre, extent)) {
            (Sought::Team, _) => self.sighting_of_team(centre, extent, doors),
            (Sought::Nothing, _) | (_, None) => Ok(Sighting::Nothing),
            (Sought::Lying, Some(_)) => Ok(Sighting::Lying(1)),
            (Sought::Pointing, Some(marker)) => {
                let door = door_of(&marker, centre, doors, self.driving);
                Ok(Sighting::Pointing(door.ok_or(CorridorFailure::Undecided)?))
            }
        }
    }

    /// The marker, if it was seen at a place on the last piece of the way.
    fn marker_at(&self, centre: Point2<f64>, extent: f64) -> Option<SeenMarker> {
        self.marker.filter(|marker| {
            distance(marker.at, centre) < extent + self.driving.marker_range
                && self.way - marker.way < self.driving.marker_memory
        })
    }

    /// The other robot waits in the corridor of one of these doors, or reports where it is.
    fn sighting_of_team(
        &mut self,
        centre: Point2<f64>,
        extent: f64,
        doors: &[f64],
    ) -> Result<Sighting, Stop> {
        self.marker = None;
        for _ in 0..LOOKS {
            self.sense()?;
            if self.marker.is_some() {
                break;
            }
        }
        let here = self.marker_at(centre, extent);
        let here = here.and_then(|seen| door_along(&seen, centre, doors, self.driving));
        let other = match here {
            Some(door) => OtherRobot::HereAlong(door),
            None => OtherRobot::Elsewhere {
                degree: self.robot.reported_degree().ok_or(RobotError::NoReport)?,
            },
        };
        Ok(Sighting::Team(TeamView([other, OtherRobot::Absent])))
    }

    /// The same robot, if another one sends it, so that it looks for no marker. Someone else moves it between two doors.
    #[must_use]
    pub fn sent(mut self) -> Self {
        self.sought = Sought::Nothing;
        self
    }
}

impl<R: Robot, O: RunObserver> AidHandler for CorridorExplorer<R, O> {
    type Error = ExplorerError;

    /// Picks the marker up or drops it, where the robot stands: the gripper feels whether it holds it. Or sends the other
    /// robot, which is a move, and looks whether that has come here.
    fn handle(&mut self, action: AidAction) -> Result<(), ExplorerError> {
        let StoodAt { centre, extent, doors, .. } = self.place()?;
        self.robot.handle(action).map_err(|error| self.error(error.into()))?;
        let number = u32::try_from(self.last_move).ok();
        self.emit(EventKind::Action { number, action });
        if matches!(action, AidAction::Send { .. }) {
            self.last_move += 1;
            self.moves += 1;
            self.stand(centre, extent, doors).map_err(|stop| self.error(stop))?;
            self.report_arrival(Some(self.last_move));
            return Ok(());
        }
        let (at, way) = (self.at(), self.way);
        let is_dropped = action == AidAction::Drop;
        self.marker = is_dropped.then_some(SeenMarker { at, axis: self.heading, way });
        let sighting = if is_dropped { Sighting::Lying(1) } else { Sighting::Nothing };
        self.place = Some(StoodAt { centre, extent, doors, sighting });
        Ok(())
    }
}

/// The door in about a direction.
fn door_towards(towards: f64, doors: &[f64], driving: &CorridorParams) -> Option<Door> {
    let off = |door: &usize| wrapped(doors[*door] - towards).abs();
    let door = nearest(0..doors.len(), off);
    door.filter(|door| off(door) < driving.same_arm).map(|door| Door(door as u32))
}

/// The door along the longer side of what is seen, on the side where it lies.
fn door_along(
    seen: &SeenMarker,
    centre: Point2<f64>,
    doors: &[f64],
    driving: &CorridorParams,
) -> Option<Door> {
    let towards = direction(centre, seen.at);
    let is_along = |door: &usize| {
        undirected(doors[*door] - seen.axis).abs() < driving.same_arm
            && wrapped(doors[*door] - towards).abs() < FRAC_PI_2
    };
    let off = |door: &usize| wrapped(doors[*door] - towards).abs();
    nearest((0..doors.len()).filter(is_along), off).map(|door| Door(door as u32))
}

/// The door that a marker shows: the one in whose direction it lies, or if it lies near the centre, the only one along its
/// longer side.
fn door_of(
    marker: &SeenMarker,
    centre: Point2<f64>,
    doors: &[f64],
    driving: &CorridorParams,
) -> Option<Door> {
    if distance(marker.at, centre) > driving.marker_off {
        return door_towards(direction(centre, marker.at), doors, driving);
    }
    let off = |door: &usize| undirected(doors[*door] - marker.axis).abs();
    let mut along = (0..doors.len()).filter(|door| off(door) < driving.same_arm);
    let door = along.next()?;
    along.next().is_none().then_some(Door(door as u32))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    #[test]
    fn a_marker_beside_a_place_shows_the_door_where_it_lies_and_one_within_a_corner_that_along_it()
    {
        let shown = |at: [f64; 2], axis: f64, doors: &[f64]| {
            let marker = SeenMarker { at: at.into(), axis, way: 0.0 };
            door_of(&marker, Point2::origin(), doors, &CorridorParams::DEFAULT)
        };
        let tee = [PI, FRAC_PI_2, 0.0];
        assert_eq!(shown([0.1, 1.2], 0.0, &tee), Some(Door(1)));
        assert_eq!(shown([0.1, -1.2], 0.0, &tee), None, "there is a wall");
        let corner = [PI, FRAC_PI_2];
        assert_eq!(shown([0.1, 0.2], 0.1, &corner), Some(Door(0)));
        assert_eq!(shown([0.1, 0.2], -1.5, &corner), Some(Door(1)));
        assert_eq!(shown([0.1, 0.2], 0.0, &tee), None, "two doors are along it");
    }

    #[test]
    fn a_robot_that_waits_is_seen_in_its_hallway_though_it_is_off_the_middle() {
        let seen = |at: [f64; 2], axis: f64| {
            let seen = SeenMarker { at: at.into(), axis, way: 0.0 };
            door_along(&seen, Point2::origin(), &[PI, FRAC_PI_2, 0.0], &CorridorParams::DEFAULT)
        };
        assert_eq!(seen([0.3, 0.4], 0.1), Some(Door(2)), "in the hallway ahead, to its left");
        assert_eq!(seen([0.3, 0.4], 1.5), Some(Door(1)));
        assert_eq!(seen([0.1, -0.5], 1.5), None, "there is a wall");
    }
}
