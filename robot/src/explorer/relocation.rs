//! A robot that got lost waits until it sees where it is, and drives until it is at a junction.

use std::f64::consts::{FRAC_PI_2, PI};

use toposlam_model::{
    driving::{
        algorithm2::{PathExecution, Standing},
        scene::{Place as ScenePlace, wrapped},
    },
    mapping::{Measured, Relocate},
};

use super::{ExplorerError, RobotExplorer, Unusable};
use crate::{
    record::{EventKind, Frame, FrameSensor, RunObserver},
    robot::Robot,
};

/// A robot that got lost tries these directions, relative to its heading, until it comes to a junction.
const DIRECTIONS: [f64; 4] = [0.0, PI, FRAC_PI_2, -FRAC_PI_2];
/// How often it tries them.
const TRIES: usize = 4;

/// A robot that sees nothing waits for this number of images.
const PATIENCE: usize = 600;

impl<R: Robot, S: FrameSensor, O: RunObserver> RobotExplorer<R, S, O> {
    /// Waits until an image shows a place, without moving.
    fn wait_for_sight(&mut self) -> Result<(), ExplorerError> {
        for _ in 0..PATIENCE {
            if self.observer.stop() {
                return Err(ExplorerError::Stopped { moves: self.moves });
            }
            match self.frame() {
                Ok((frame, scene)) => {
                    let sees = !matches!(scene.place, ScenePlace::Unknown(_));
                    self.emit(EventKind::Frame(Frame { scene: Some(scene), ..frame }));
                    if sees {
                        return Ok(());
                    }
                }
                Err(Unusable::Robot(error)) => return Err(self.robot_error(error)),
                Err(_) => {}
            }
        }
        Ok(())
    }

    /// Drives until the robot is at a junction, wherever it stands.
    pub(super) fn find_junction(&mut self) -> Result<Standing, ExplorerError> {
        self.wait_for_sight()?;
        let heading = self.robot.odometry().odometry.heading;
        let mut directions = DIRECTIONS.repeat(TRIES).into_iter();
        loop {
            let direction = wrapped(heading + directions.next().unwrap_or_default());
            let is_last = directions.len() == 0;
            match self.drive(PathExecution::onwards_to_junction(direction)) {
                Ok(standing) => {
                    self.arrive_from_nowhere(standing);
                    return Ok(standing);
                }
                Err(ExplorerError::Lost { .. } | ExplorerError::NoPicture { .. }) if !is_last => {}
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

    fn measured(&self) -> Measured {
        self.measured
    }

    fn is_blocked(&self) -> bool {
        self.is_at_obstacle()
    }
}
