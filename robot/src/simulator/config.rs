//! A simulated robot to be: where it stands, how exact it is, and what goes wrong with it.

use std::sync::Arc;

use toposlam_model::{embedded_graph::Dart, floor_plan::FloorPlan};

use super::{faults::RobotFault, motion::MotionNoise};
use crate::{pose::Pose, truth::angle};

/// How long a picture takes unless something else is said, in seconds.
pub const PICTURE_TIME: f64 = 0.3;

/// A simulated robot to be.
#[derive(Clone, Debug)]
pub struct SimulationConfig {
    /// The plan of its building.
    pub plan: Arc<FloorPlan>,
    /// The dart along which the marker lies.
    pub marker: Dart,
    /// Where it stands at first.
    pub pose: Pose,
    /// How far its wheels are from ideal ones, as a multiple of [`MotionNoise::DEFAULT`]; and without
    /// images, sensing from what was measured.
    pub noise: f64,
    /// How long a picture takes, in seconds.
    pub picture_time: f64,
    /// What goes wrong.
    pub faults: Vec<RobotFault>,
    /// Whether it keeps what its wheels were told, for [`Robot::track`](crate::robot::Robot::track).
    pub keeps_track: bool,
    /// From which everything follows that is left to chance.
    pub seed: u64,
}

impl SimulationConfig {
    /// A robot that begins to explore: at the turning point of the facing dart's junction, its back to
    /// the dart's hallway, the marker along it.
    #[must_use]
    pub fn at_start(plan: Arc<FloorPlan>, facing: Dart, seed: u64) -> Self {
        let pose = start_pose(&plan, facing);
        Self {
            plan,
            marker: facing,
            pose,
            noise: 1.0,
            picture_time: PICTURE_TIME,
            faults: Vec::new(),
            keeps_track: false,
            seed,
        }
    }

    pub(super) fn motion_noise(&self) -> MotionNoise {
        MotionNoise::DEFAULT.times(self.noise)
    }
}

/// Where a robot stands that begins at a dart: at its junction's turning point, its back to the dart's
/// hallway.
#[must_use]
pub fn start_pose(plan: &FloorPlan, facing: Dart) -> Pose {
    let position = plan.junction(plan.graph().vertex(facing)).position;
    Pose { position, heading: angle(plan.direction(facing).reversed()) }
}
