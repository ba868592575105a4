//! The other robot of a simulated team, which one sends through doors.

use std::{f64::consts::PI, sync::Arc};

use toposlam_model::{driving::WAITING, floor_plan::FloorPlan, percept::Door, world::World};
use toposlam_robot::{
    any_explorer::{AnyExplorer, RobotSensor},
    explorer::ExplorerError,
    robot::{Robot, RobotError},
};

use crate::{SimulatedRobot, truth::LyingMarker};

/// A robot that waits, with its back to the junction. On top it has the plate by which the first one sees it: that is the
/// marker of the building.
#[derive(Debug)]
pub(crate) struct SentRobot {
    plan: Arc<FloorPlan>,
    explorer: AnyExplorer<SimulatedRobot>,
    /// The number of doors where it stands, once it has gone anywhere.
    degree: Option<u32>,
}

impl SentRobot {
    pub(crate) fn waiting(
        plan: Arc<FloorPlan>,
        robot: SimulatedRobot,
        sensor: RobotSensor,
    ) -> Self {
        Self { plan, explorer: AnyExplorer::new(robot, sensor, ()).sent(), degree: None }
    }

    pub(crate) fn degree(&self) -> Option<u32> {
        self.degree
    }

    /// The time since it was switched on, in seconds.
    pub(crate) fn time(&mut self) -> f64 {
        self.robot().odometry().time
    }

    fn robot(&mut self) -> &mut SimulatedRobot {
        self.explorer.robot_mut()
    }

    /// It turns round, and goes to the turning point or away from it.
    fn turn_and_go(&mut self) -> Result<(), RobotError> {
        self.robot().turn(PI)?;
        self.robot().forward(WAITING)
    }

    /// It goes through a door, and waits there. Returns where its plate is.
    pub(crate) fn go(&mut self, door: Door) -> Result<LyingMarker, ExplorerError> {
        self.turn_and_go()?;
        self.explorer.traverse(door)?;
        self.degree = Some(self.explorer.percept()?.degree);
        let pose = self.robot().base.pose();
        let at_turning_point = LyingMarker::below(&self.plan, pose);
        let at_turning_point = at_turning_point.ok_or(RobotError::NotAtJunction)?;
        self.turn_and_go()?;
        let centre_in_plan = self.robot().base.pose().position.into();
        Ok(LyingMarker { centre_in_plan, ..at_turning_point })
    }
}
