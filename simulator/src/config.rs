//! The configuration of a simulated robot: its start, its noise and its faults.

use std::sync::Arc;

use toposlam_model::{
    driving::pose::Pose,
    embedded_graph::Dart,
    floor_plan::{FloorPlan, JunctionKind},
};

use super::faults::RobotFault;
use crate::truth::angle;

/// The start, the noise and the faults of a simulated robot.
#[derive(Clone, Debug)]
pub struct SimulationConfig {
    pub plan: Arc<FloorPlan>,
    pub marker: Dart,
    pub pose: Pose,
    /// Noise of the wheels as a multiple of [`MotionNoise::DEFAULT`](crate::MotionNoise). Without images, it also
    /// multiplies the measured errors of sensing.
    pub noise: f64,
    pub faults: Vec<RobotFault>,
    /// Whether wheel speeds are recorded for [`Robot::track`](toposlam_robot::robot::Robot::track).
    pub keeps_track: bool,
    pub seed: u64,
}

impl SimulationConfig {
    /// A robot at the start of its exploration: at the turning point of the facing dart's junction,
    /// its back to the dart's hallway, the marker along the dart.
    pub fn at_start(plan: Arc<FloorPlan>, facing: Dart, seed: u64) -> Self {
        let pose = start_pose(&plan, facing);
        Self {
            plan,
            marker: facing,
            pose,
            noise: 1.0,
            faults: Vec::new(),
            keeps_track: false,
            seed,
        }
    }
}

/// The pose at a start: at the turning point of the dart's junction, the back to the dart's
/// hallway.
pub fn start_pose(plan: &FloorPlan, facing: Dart) -> Pose {
    let position = plan.junction(plan.graph().vertex(facing)).position;
    Pose { position, heading: angle(plan.direction(facing).reversed()) }
}

/// The possible starts in a plan: the darts of its Ls.
pub fn starts_of(plan: &FloorPlan) -> Vec<Dart> {
    let graph = plan.graph();
    let is_l = |dart: &Dart| plan.junction(graph.vertex(*dart)).kind == JunctionKind::L;
    graph.darts().filter(is_l).collect()
}
