//! The configuration of a simulated robot: its start, its noise and its faults.

use std::sync::Arc;

use nalgebra::Point2;
use toposlam_model::{
    driving::{WAITING, pose::Pose},
    embedded_graph::Dart,
    floor_plan::{FloorPlan, JunctionKind},
};

use super::faults::RobotFault;
use crate::truth::angle;

/// A robot in a network of corridors begins this far from its first junction, or in the middle of the corridor, in metres.
const BEFORE: f64 = 9.0;
/// There the marker lies this far from the walls of its junction, in metres.
const MARKER_BESIDE: f64 = 0.2;

/// The start, the noise and the faults of a simulated robot.
#[derive(Clone, Debug)]
pub struct SimulationConfig {
    pub plan: Arc<FloorPlan>,
    pub marker: Dart,
    /// How far the marker lies from the turning point, along its dart, in metres.
    pub marker_off: f64,
    pub pose: Pose,
    /// Noise of the wheels as a multiple of [`MotionNoise::DEFAULT`](crate::MotionNoise). Without images, it also
    /// multiplies the measured errors of sensing.
    pub noise: f64,
    pub faults: Vec<RobotFault>,
    /// Whether wheel speeds are recorded for [`Robot::track`](toposlam_robot::robot::Robot::track).
    pub keeps_track: bool,
    pub seed: u64,
    /// The number of the robot in its team, from 0.
    pub robot: usize,
}

impl SimulationConfig {
    /// A robot at the start of its exploration: at the turning point of the facing dart's junction,
    /// its back to the dart's hallway, the marker along the dart.
    pub fn at_start(plan: Arc<FloorPlan>, facing: Dart, seed: u64) -> Self {
        let pose = start_pose(&plan, facing);
        Self {
            plan,
            marker: facing,
            marker_off: 0.0,
            pose,
            noise: 1.0,
            faults: Vec::new(),
            keeps_track: false,
            seed,
            robot: 0,
        }
    }

    /// A team of two at this start. The other robot waits where another one sees along which dart it stands.
    #[must_use]
    pub fn with_team(self) -> Self {
        Self { marker_off: WAITING, ..self }
    }

    /// The other robot of its team. It waits at the start, with its back to the junction.
    #[must_use]
    pub fn other(&self) -> Self {
        let position = self.lying_marker().centre_in_plan.into();
        let heading = angle(self.plan.direction(self.marker));
        let pose = Pose { position, heading };
        let (faults, keeps_track) = (Vec::new(), false);
        Self { pose, faults, keeps_track, robot: 1, ..self.clone() }
    }

    /// A robot in a network of corridors: within a dart's corridor, on its way to the dart's junction. The marker lies in that
    /// corridor, beside the junction.
    pub fn in_corridor(plan: Arc<FloorPlan>, facing: Dart, seed: u64) -> Self {
        let graph = plan.graph();
        let [from, to] = [facing, graph.opposite(facing)]
            .map(|dart| Point2::from(plan.junction(graph.vertex(dart)).position));
        let off = to - from;
        let position = from + (BEFORE / off.norm()).min(0.5) * off;
        let marker_off = plan.hallway_width() / 2.0 + MARKER_BESIDE;
        let at_start = Self::at_start(plan, facing, seed);
        let pose = Pose { position: position.into(), ..at_start.pose };
        Self { marker_off, pose, ..at_start }
    }
}

/// The pose at a start: at the turning point of the dart's junction, the back to the dart's
/// hallway.
pub fn start_pose(plan: &FloorPlan, facing: Dart) -> Pose {
    let position = plan.junction(plan.graph().vertex(facing)).position;
    Pose { position, heading: angle(plan.direction(facing).reversed()) }
}

/// The possible starts in a plan for a robot in a network of corridors: the darts of its junctions with three doors.
pub fn corridor_starts_of(plan: &FloorPlan) -> Vec<Dart> {
    plan.graph().darts().filter(|dart| plan.graph().degree_around(*dart) >= 3).collect()
}

/// The possible starts in a plan: the darts of its Ls.
pub fn starts_of(plan: &FloorPlan) -> Vec<Dart> {
    let graph = plan.graph();
    let is_l = |dart: &Dart| plan.junction(graph.vertex(*dart)).kind == JunctionKind::L;
    graph.darts().filter(is_l).collect()
}

#[cfg(test)]
mod tests {
    use toposlam_model::{
        format::{named_world::NamedWorld, world_file},
        isomorphism::Candidate,
        mapping::{FACING, MappingAlgorithm, MappingMethod},
    };
    use toposlam_robot::{
        any_explorer::{AnyExplorer, RobotSensor},
        run_settings::RunSettings,
    };
    use toposlam_vision::laser::params::LaserParams;

    use super::*;
    use crate::ScannerParams;

    fn world(text: &[u8]) -> NamedWorld {
        world_file::read(text).unwrap()
    }

    /// From the junction of a ring one sees 7 m to each side, up to a bend, and odometry turns by up to 20 degrees on the way
    /// into one of them and back: whether views show an arm there is decided by a hair.
    #[test]
    fn a_robot_drives_into_arms_that_bend_out_of_sight_and_maps_the_corridors_of_a_real_building() {
        let plan = world(include_bytes!("../../worlds/laser/seattle.toml"));
        let real = world(include_bytes!("../../worlds/real/seattle.toml"));
        let scanner = ScannerParams { noise: 0.01, ..ScannerParams::PLAIN };
        let [facing, real_facing] = [&plan, &real].map(|world| world.start.unwrap());
        let plan = Arc::new(plan.plan.unwrap());
        // With seed 23 a place lies half a metre from where earlier views showed it.
        for seed in (1..=10).chain([23]) {
            let config = SimulationConfig {
                noise: 0.1,
                ..SimulationConfig::in_corridor(plan.clone(), facing, seed)
            };
            let sensor = RobotSensor::from(LaserParams::default());
            let mut explorer = AnyExplorer::new(config.by_laser(&scanner), sensor, ());
            let method = MappingMethod::from(MappingAlgorithm::Folding);
            let (mapping, mapped) = explorer.map(&RunSettings::new(method, 20));
            assert!(mapped.is_ok(), "{seed}: {mapped:?}");
            let map = mapping.map().complete().unwrap();
            let mut candidate = Candidate::default();
            let bijection = candidate.of_starts((map, FACING), (&real.graph, real_facing));
            assert!(bijection.verify(map, &real.graph), "{seed}: {map:?}");
        }
    }
}
