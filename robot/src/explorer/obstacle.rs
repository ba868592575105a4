//! A robot at an obstacle that it cannot pass: it turns round, and drives back as from a dead end.

use std::f64::consts::PI;

use toposlam_logs::record::{Arrival, EventKind, FrameSensor, RunObserver};
use toposlam_model::{
    driving::{
        algorithm2::{Command, JunctionState, PathExecution},
        odometry::Odometry,
        scene::{Place, Scene, wrapped},
    },
    mapping::ArrivalMeasurement,
    percept::{Percept, Sighting},
};

use super::{ExplorerError, MappingRobot, RobotExplorer, Standpoint};
use crate::robot::Robot;

pub(super) const DEAD_END: Percept = Percept { degree: 1, sighting: Sighting::Nothing };

/// Where a robot was stopped by an obstacle, in the frame of odometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stall {
    /// The direction from which it came.
    pub(super) back: f64,
    /// The turning point of the junction to which it was about to come, if it saw one.
    pub(super) junction: Option<[f64; 2]>,
}

/// The turning point of the junction in a scene, in the frame of odometry; `None` if it shows none.
pub(super) fn turning_point(scene: &Scene, odometry: Odometry) -> Option<[f64; 2]> {
    let Place::Junction(view) = &scene.place else { return None };
    let [x, y] = view.turning_point;
    Some(odometry.moved(y.atan2(x), x.hypot(y)).position)
}

impl<R: Robot, S: FrameSensor, O: RunObserver> RobotExplorer<R, S, O> {
    /// Ends a move at an obstacle, where the robot perceives a dead end.
    pub(super) fn stand_at_obstacle(&mut self) {
        let heading = self.robot.odometry().odometry.heading;
        let back = self.stall.map_or(wrapped(heading + PI), |stall| stall.back);
        self.place = Some(Standpoint::Obstacle { back });
        self.moves += 1;
        self.allow_for(DEAD_END);
        (self.hallway, self.measured) = (None, ArrivalMeasurement::default());
        let number = Some(u32::try_from(self.last_move).unwrap_or(u32::MAX));
        let Percept { degree, sighting } = DEAD_END;
        let (sighting, shape, entry) = (Some(sighting), None, Some(back));
        self.emit(EventKind::Arrival(Arrival { number, degree, sighting, shape, entry }));
    }

    /// Turns to a direction in the frame of odometry, and drives to the next junction. A junction to which an
    /// obstacle does not let the robot come is not the next one if it lies behind.
    pub(super) fn go_in_direction(
        &mut self,
        direction: f64,
    ) -> Result<JunctionState, ExplorerError> {
        let here = self.robot.odometry().odometry;
        self.command(Command { turn: here.seen(direction), forward: 0.0 })?;
        let junction = self.stall.and_then(|stall| stall.junction);
        let behind = junction.map(|[x, y]| {
            let (sine, cosine) = direction.sin_cos();
            (here.position[0] - x) * cosine + (here.position[1] - y) * sine
        });
        self.drive(match behind {
            Some(behind) if behind > 0.0 => PathExecution::onwards_from_junction(direction, behind),
            _ => PathExecution::onwards_to_junction(direction),
        })
    }
}
