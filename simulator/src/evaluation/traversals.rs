//! Driving: compares, for each door of each junction, the junction that the robot reaches and its
//! entry door with the specification. Sections 4.2 and 4.3.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Vector2;
use rand::{Rng, RngExt, SeedableRng, seq::IndexedRandom};
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_logs::record::StoppedBy;
use toposlam_model::{
    driving::pose::Pose,
    embedded_graph::{Dart, Vertex},
    enumerate::Watch,
    floor_plan::FloorPlan,
    percept::Door,
    world::World,
};
use toposlam_robot::{any_explorer::AnyExplorer, explorer::ExplorerError, robot::Robot};
use toposlam_vision::geometry::unit;

use super::run_sampler::RobotCase;
use crate::{
    NamedPlan, RobotEquipment, SimulationConfig, ground_truth_monitor::GroundTruthMonitor,
    run::RobotOutcome, start_pose, starts_of,
};

/// The greatest distance of the robot from the turning point at the start, along and across the
/// entry hallway, in metres.
const OFF: f64 = 0.10;
/// The greatest angle between the robot's heading at the start and straight on, in degrees.
const TURNED: f64 = 15.0;

/// All traversals of a seed: each door of each junction, entered by each of its doors, repeatedly
/// and from different poses.
#[derive(Clone, Debug)]
pub struct TraversalSampler {
    pub plans: Vec<NamedPlan>,
    /// The pairs of entry door and exit door: the index of the plan, the entry dart, the door.
    pub cases: Vec<(usize, Dart, Door)>,
    seed: u64,
    noise: f64,
}

#[derive(Clone, Debug)]
pub struct JudgedTraversal {
    pub case: RobotCase,
    /// The dart by which the robot entered its junction.
    pub entry: Dart,
    pub door: Door,
    pub outcome: RobotOutcome<ExplorerError>,
    /// Simulated time, in seconds.
    pub seconds: f64,
    /// The number of images that were requested.
    pub frames: u64,
}

impl TraversalSampler {
    /// The traversals of a seed in these plans. Plans without an L are left out, because the marker
    /// needs one. `noise` is a multiple of the default noise.
    pub fn new(mut plans: Vec<NamedPlan>, seed: u64, noise: f64) -> Self {
        plans.retain(|(_, plan)| !starts_of(plan).is_empty());
        let cases = plans.iter().enumerate().flat_map(|(number, (_, plan))| {
            let graph = plan.graph();
            graph.darts().flat_map(move |entry| {
                (0..graph.degree_around(entry)).map(move |door| (number, entry, Door(door)))
            })
        });
        Self { cases: cases.collect(), plans, seed, noise }
    }

    /// Makes the traversal with this number. Returns `None` without plans, or if the watch stops.
    pub fn traversal(
        &self,
        number: u64,
        equipment: &RobotEquipment,
        watch: &dyn Watch,
    ) -> Option<JudgedTraversal> {
        let case = number.checked_rem(self.cases.len() as u64)?;
        let (plan, entry, door) = self.cases[case as usize];
        let (plan_name, plan) = self.plans[plan].clone();
        let mut chance = Xoshiro256PlusPlus::seed_from_u64(self.seed.wrapping_add(number));
        let pose = about(start_pose(&plan, entry), &mut chance);
        let marker = marker(&plan, entry, door, &mut chance)?;
        let config = SimulationConfig::at_start(plan.clone(), marker, chance.next_u64());
        let config = SimulationConfig { pose, noise: self.noise, ..config };

        let (robot, sensor) = equipment.robot(&config, number);
        let monitor = GroundTruthMonitor::at(&plan, marker, entry).by(&sensor);
        let state = monitor.junction_state(pose);
        let mut explorer = AnyExplorer::new(robot, sensor, (monitor, StoppedBy(watch)));
        if let Some(state) = state {
            explorer = explorer.at_junction(state);
        }
        let error = explorer.traverse(door).err();
        let (robot, (monitor, _)) = explorer.into_parts();
        let outcome = match (error, monitor.divergence()) {
            (Some(ExplorerError::Stopped { .. }), _) => return None,
            (Some(error), _) => RobotOutcome::GaveUp(error),
            (None, Some(divergence)) => RobotOutcome::Wrong(divergence.to_string()),
            (None, None) => RobotOutcome::Right,
        };
        let (seconds, frames) = (robot.odometry().time, robot.frames());
        let case = RobotCase { number, plan_name, config };
        Some(JudgedTraversal { case, entry, door, outcome, seconds, frames })
    }
}

/// The marker's dart: at every other traversal to an L it lies there, else at any L.
fn marker(plan: &FloorPlan, entry: Dart, door: Door, chance: &mut impl Rng) -> Option<Dart> {
    let graph = plan.graph();
    let there: Vertex = graph.vertex(graph.after(entry, door));
    let ls = starts_of(plan);
    let at_end: Vec<Dart> = ls.iter().copied().filter(|&l| graph.vertex(l) == there).collect();
    let candidates = if at_end.is_empty() || chance.random() { &ls } else { &at_end };
    candidates.choose(chance).copied()
}

fn about(Pose { position, heading }: Pose, chance: &mut impl Rng) -> Pose {
    let [along, aside] = [(); 2].map(|()| chance.random_range(-OFF..=OFF));
    let turned = chance.random_range(-TURNED..=TURNED).to_radians();
    let (ahead, left) = (unit(heading), unit(heading + FRAC_PI_2));
    let position = Vector2::from(position) + along * ahead + aside * left;
    Pose { position: position.into(), heading: heading + turned }
}

#[cfg(test)]
mod tests {
    use toposlam_model::mapping::MappingAlgorithm;

    use super::*;
    use crate::{
        evaluation::{run_sampler::RunSampler, sampling::sample},
        plans,
        question_limit::QuestionLimit,
    };

    type Count<'a> = &'a dyn Fn(&QuestionLimit) -> usize;

    /// The watch is asked before a case, and then before each image.
    #[test]
    fn a_traversal_and_a_run_that_are_stopped_on_the_way_are_not_judged_nor_measured() {
        let plans = plans().unwrap();
        let traversals = TraversalSampler::new(plans.clone(), 1, 1.0);
        let runs = RunSampler::new(plans, 1, 0, 1, 1.0, MappingAlgorithm::Algorithm1);
        let scenes = RobotEquipment::Scenes;
        let counts: [Count<'_>; 3] = [
            &|watch| sample(0..1, watch, |n| traversals.traversal(n, &scenes, watch)).len(),
            &|watch| sample(0..1, watch, |n| runs.run(n, &scenes, watch)).len(),
            &|watch| sample(0..1, watch, |n| runs.measured(n, &scenes, watch)).len(),
        ];
        for count in counts {
            let unlimited = QuestionLimit::never();
            assert_eq!(count(&unlimited), 1);
            let asked = unlimited.asked();
            assert!(asked > 4, "{asked}");
            for at in [1, 2, 3, asked] {
                let limited = QuestionLimit::at(at);
                assert_eq!(count(&limited), 0);
                assert_eq!(limited.asked(), at);
            }
        }
    }
}
