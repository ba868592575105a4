//! The other robot of a team, as Bender and Slonim (1994) have two: where it waits, and how the robot sees it there.

use std::{f64::consts::FRAC_PI_2, ops::RangeInclusive};

use toposlam_logs::record::{Arrival, EventKind, Frame, FrameSensor, RunObserver};
use toposlam_model::{
    driving::{
        algorithm2::{Command, JunctionState, PathState},
        odometry::Odometry,
        scene::{MarkerView, wrapped},
        visit::SoughtMarker,
    },
    percept::{Door, OtherRobot, Percept, Sighting, TeamView},
};

use super::{ExplorerError, MappingRobot, RobotExplorer, Standpoint};
use crate::robot::{Robot, RobotError};

/// From the turning point a robot that waits is seen at such a distance, in metres.
const SEEN: RangeInclusive<f64> = 0.25..=0.8;
/// It is not there if so many frames in a row do not show it.
const LOOKS: u32 = 3;

impl<R: Robot, S: FrameSensor, O: RunObserver> RobotExplorer<R, S, O> {
    /// The same robot, if another one sends it, so that it looks for no marker.
    #[must_use]
    pub fn sent(mut self) -> Self {
        self.sought = SoughtMarker::Nothing;
        self
    }

    pub fn robot_mut(&mut self) -> &mut R {
        &mut self.robot
    }

    /// The same state with what the robot now sees of its team. Without a team it is that.
    pub(super) fn with_team(
        &mut self,
        state: JunctionState,
    ) -> Result<JunctionState, ExplorerError> {
        if !self.has_team {
            return Ok(state);
        }
        let other = if let Some(door) = self.door_of_other(&state)? {
            OtherRobot::HereAlong(door)
        } else {
            let degree = self.robot.reported_degree().ok_or(RobotError::NoReport)?;
            OtherRobot::Elsewhere { degree }
        };
        let sighting = Sighting::Team(TeamView([other, OtherRobot::Absent]));
        Ok(JunctionState { percept: Percept { sighting, ..state.percept }, ..state })
    }

    /// The door along which the other robot waits; `None` if it is not here.
    fn door_of_other(&mut self, state: &JunctionState) -> Result<Option<Door>, ExplorerError> {
        for _ in 0..LOOKS {
            let (frame, scene) = self.look()?;
            let seen = scene.marker.as_ref();
            let door = seen.and_then(|marker| door_towards(state, &frame.odometry, marker));
            self.last = Some(frame.clone());
            self.emit(EventKind::Frame(Frame { scene: Some(scene), ..frame }));
            let command = Some(Command::default());
            self.emit(EventKind::Command { state: PathState::Junction, command });
            if door.is_some() {
                return Ok(door);
            }
        }
        Ok(None)
    }

    /// The robot has sent the other one, which is a move, and looks whether that has come here.
    pub(super) fn see_sent(&mut self, state: JunctionState) -> Result<(), ExplorerError> {
        self.last_move += 1;
        self.moves += 1;
        let state = self.with_team(state)?;
        self.place = Some(Standpoint::Junction(state));
        self.emit(EventKind::Arrival(Arrival::new(self.last_move, &state)));
        Ok(())
    }
}

/// The door of the hallway in which something is seen from the turning point.
fn door_towards(state: &JunctionState, odometry: &Odometry, seen: &MarkerView) -> Option<Door> {
    let [ahead, left] = seen.position;
    if !SEEN.contains(&ahead.hypot(left)) {
        return None;
    }
    let from_entry = wrapped(odometry.seen(state.entry) - left.atan2(ahead));
    let quarter = (from_entry / FRAC_PI_2).round().rem_euclid(4.0) as u32;
    let door = state.shape.quarters().into_iter().position(|known| known == quarter);
    door.map(|door| Door(door as u32))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use toposlam_model::driving::visit::JunctionShape;

    use super::*;

    #[test]
    fn a_robot_that_waits_is_seen_along_the_door_of_its_hallway() {
        // The robot came from the west, and has turned a little to the left since.
        let odometry = Odometry { position: [3.0, 1.0], heading: 0.3 };
        let shape = JunctionShape([true, false, true, true]);
        let percept = Percept { degree: 3, sighting: Sighting::Nothing };
        let state = JunctionState { shape, percept, entry: PI };
        let door = |direction: f64, distance: f64| {
            let seen = direction - odometry.heading;
            let position = [distance * seen.cos(), distance * seen.sin()];
            door_towards(&state, &odometry, &MarkerView { position, axis: 0.0, door: None })
        };
        let [west, east, south, north] = [PI, 0.0, -FRAC_PI_2, FRAC_PI_2];
        assert_eq!([west, east, south].map(|door_at| door(door_at, 0.5).unwrap().0), [0, 1, 2]);
        assert_eq!(door(west - 0.4, 0.4), Some(Door(0)));
        // There is no hallway, or it is the robot itself, or another junction.
        assert_eq!([door(north, 0.5), door(west, 0.1), door(west, 1.2)], [None; 3]);
    }
}
