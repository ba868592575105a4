//! A robot that got lost waits until it sees where it is, and drives until it is at a junction.

use std::f64::consts::{FRAC_PI_2, PI};

use toposlam_logs::record::{Arrival, EventKind, Frame, FrameSensor, RunObserver};
use toposlam_model::{
    driving::{
        algorithm2::{Command, JunctionState, PathState, UNIT},
        scene::{JunctionView, Place, wrapped},
    },
    mapping::{ArrivalMeasurement, Relocate},
};

use super::{ExplorerError, MappingRobot, RobotExplorer};
use crate::{capture::UnusableFrame, robot::Robot};

/// A robot that got lost tries these directions, relative to its heading, until it comes to a junction.
const DIRECTIONS: [f64; 4] = [0.0, PI, FRAC_PI_2, -FRAC_PI_2];
/// How often it tries them.
const TRIES: usize = 4;

/// A robot this near to a turning point is there, in metres.
const AT_TURNING_POINT: f64 = 0.2;
/// The most commands to a turning point.
const TO_TURNING_POINT: usize = 6;
/// The commands of [`UNIT`] along a door that lead out of a junction.
const OUT: usize = 3;

/// A robot that sees nothing waits for this number of images.
const PATIENCE: usize = 600;

impl<R: Robot, S: FrameSensor, O: RunObserver> RobotExplorer<R, S, O> {
    /// Waits until an image shows a place, without moving.
    fn wait_for_sight(&mut self) -> Result<(), ExplorerError> {
        for _ in 0..PATIENCE {
            if self.log.observer.stop() {
                return Err(ExplorerError::Stopped { moves: self.last_move });
            }
            match self.frame() {
                Ok((frame, scene)) => {
                    let sees = !matches!(scene.place, Place::Unknown(_));
                    self.emit(EventKind::Frame(Frame { scene: Some(scene), ..frame }));
                    if sees {
                        return Ok(());
                    }
                }
                Err(UnusableFrame::Robot(error)) => return Err(self.robot_error(error)),
                Err(_) => {}
            }
        }
        Ok(())
    }

    /// Leaves a junction that the robot sees by one of its doors. A robot that has come to it from nowhere has not
    /// seen it from all the distances that decide a visit. Returns the direction of the door in the frame of odometry;
    /// `None` if no junction is seen.
    fn leave_by_door(&mut self, number: usize) -> Result<Option<f64>, ExplorerError> {
        for _ in 0..TO_TURNING_POINT {
            let Some(junction) = self.seen_junction()? else { return Ok(None) };
            let [x, y] = junction.turning_point;
            let distance = x.hypot(y);
            if distance > AT_TURNING_POINT {
                let turn = y.atan2(x);
                self.command(Command { turn, forward: distance.min(UNIT) })?;
                continue;
            }
            let nth = number % junction.doors.len().max(1);
            let Some(door) = junction.doors.get(nth) else { return Ok(None) };
            let direction = self.robot.odometry().odometry.whither(door.direction);
            self.command(Command { turn: door.direction, forward: UNIT })?;
            for _ in 1..OUT {
                self.command(Command { turn: 0.0, forward: UNIT })?;
            }
            return Ok(Some(direction));
        }
        Ok(None)
    }

    /// The junction in the next image, if it shows one.
    fn seen_junction(&mut self) -> Result<Option<JunctionView>, ExplorerError> {
        let (frame, scene) = match self.look() {
            Ok(seen) => seen,
            Err(ExplorerError::NoImage { .. }) => return Ok(None),
            Err(error) => return Err(error),
        };
        self.last = Some(frame.clone());
        self.emit(EventKind::Frame(Frame { scene: Some(scene.clone()), ..frame }));
        Ok(match scene.place {
            Place::Junction(junction) => Some(junction),
            Place::Hallway(_) | Place::Unknown(_) => None,
        })
    }

    /// Reports a command of a robot that does not know where it is, and carries it out.
    pub(super) fn command(&mut self, command: Command) -> Result<(), ExplorerError> {
        self.emit(EventKind::Command { state: PathState::Unknown, command: Some(command) });
        self.carry_out(command)
    }

    /// Drives until the robot is at a junction, wherever it stands.
    pub(super) fn find_junction(&mut self) -> Result<JunctionState, ExplorerError> {
        self.wait_for_sight()?;
        let heading = self.robot.odometry().odometry.heading;
        let mut directions = DIRECTIONS.repeat(TRIES).into_iter();
        loop {
            let is_last = directions.len() == 1;
            let tries = directions.len();
            let relative = directions.next().unwrap_or_default();
            let left =
                if tries < DIRECTIONS.len() * TRIES { self.leave_by_door(tries)? } else { None };
            let direction = left.unwrap_or_else(|| wrapped(heading + relative));
            match self.go_in_direction(direction) {
                Ok(state) => {
                    // How many moves lead there is not known.
                    self.hallway = None;
                    let arrival = Arrival::new(self.last_move, &state);
                    self.arrive(state, Arrival { number: None, ..arrival });
                    return Ok(state);
                }
                Err(ExplorerError::Lost { .. } | ExplorerError::NoImage { .. }) if !is_last => {}
                Err(error) => return Err(error),
            }
        }
    }
}

impl<R: Robot, S: FrameSensor, O: RunObserver> Relocate for RobotExplorer<R, S, O> {
    fn relocate(&mut self, error: ExplorerError) -> Result<(), ExplorerError> {
        match error {
            error @ (ExplorerError::Stopped { .. }
            | ExplorerError::Robot(_)
            | ExplorerError::Budget { .. }) => Err(error),
            _ => self.find_junction().map(|_| ()),
        }
    }

    fn measured(&self) -> ArrivalMeasurement {
        self.measured
    }

    fn is_blocked(&self) -> bool {
        self.is_at_obstacle()
    }
}
