//! Driving: compares, for each door of each junction, the junction that the robot reaches and its
//! entry door with the specification. Sections 4.2 and 4.3.

use std::{f64::consts::FRAC_PI_2, fmt, sync::Arc};

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
use toposlam_robot::{
    explorer::{ExplorerError, RobotExplorer},
    robot::Robot,
};

use super::parallel::made_in_turn;
use crate::{
    RobotEquipment, SimulationConfig,
    ground_truth_monitor::{GroundTruthMonitor, TruthDivergence},
    start_pose, starts_of,
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
    plans: Vec<(String, Arc<FloorPlan>)>,
    /// The index of the plan, the entry dart, the door.
    cases: Vec<(usize, Dart, Door)>,
    seed: u64,
    noise: f64,
}

/// A traversal to make.
#[derive(Clone, Debug)]
pub struct Traversal {
    /// Its number among the traversals of the seed.
    pub number: u64,
    /// The plan's name.
    pub plan_name: String,
    /// The dart by which the robot entered its junction.
    pub entry: Dart,
    /// The door that it takes.
    pub door: Door,
    /// The robot and its surroundings.
    pub config: SimulationConfig,
}

/// A finished traversal.
#[derive(Clone, Debug)]
pub struct JudgedTraversal {
    /// The traversal.
    pub traversal: Traversal,
    /// Its outcome.
    pub outcome: TraversalOutcome,
    /// Simulated time, in seconds.
    pub seconds: f64,
    /// The number of images that were requested.
    pub frames: u64,
}

/// The outcome of a traversal.
#[derive(Clone, Debug, PartialEq)]
pub enum TraversalOutcome {
    /// The robot is at the specified pose and has the specified percept.
    Right,
    /// The pose or the percept is wrong.
    Wrong(TruthDivergence),
    /// The robot gave up, with this reason.
    GaveUp(ExplorerError),
}

impl fmt::Display for TraversalOutcome {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Right => out.write_str("as specified"),
            Self::Wrong(divergence) => divergence.fmt(out),
            Self::GaveUp(error) => error.fmt(out),
        }
    }
}

impl TraversalSampler {
    /// The traversals of a seed in these plans. Plans without an L are left out, because the marker
    /// needs one. `noise` is a multiple of the default noise.
    #[must_use]
    pub fn new(plans: Vec<(String, Arc<FloorPlan>)>, seed: u64, noise: f64) -> Self {
        let plans: Vec<_> =
            plans.into_iter().filter(|(_, plan)| !starts_of(plan).is_empty()).collect();
        let cases = plans.iter().enumerate().flat_map(|(number, (_, plan))| {
            let graph = plan.graph();
            graph.darts().flat_map(move |entry| {
                (0..graph.degree_around(entry)).map(move |door| (number, entry, Door(door)))
            })
        });
        Self { cases: cases.collect(), plans, seed, noise }
    }

    /// The number of pairs of entry door and exit door.
    #[must_use]
    pub fn cases(&self) -> usize {
        self.cases.len()
    }

    /// The number of plans.
    #[must_use]
    pub fn plans(&self) -> usize {
        self.plans.len()
    }

    /// The traversal with this number; `None` without plans.
    #[must_use]
    pub fn traversal(&self, number: u64) -> Option<Traversal> {
        let case = number.checked_rem(self.cases.len() as u64)?;
        let (plan, entry, door) = self.cases[case as usize];
        let (plan_name, plan) = self.plans[plan].clone();
        let mut chance = Xoshiro256PlusPlus::seed_from_u64(self.seed.wrapping_add(number));
        let pose = about(start_pose(&plan, entry), &mut chance);
        let marker = marker(&plan, entry, door, &mut chance)?;
        let config = SimulationConfig {
            pose,
            noise: self.noise,
            ..SimulationConfig::at_start(plan, marker, chance.next_u64())
        };
        Some(Traversal { number, plan_name, entry, door, config })
    }

    /// Makes traversals by their numbers on all threads, with these sensors. If the watch stops, some
    /// are missing.
    #[must_use]
    pub fn judged(
        &self,
        numbers: std::ops::Range<u64>,
        equipment: &RobotEquipment,
        watch: &dyn Watch,
    ) -> Vec<JudgedTraversal> {
        made_in_turn(
            numbers,
            watch,
            |number| self.traversal(number),
            |case| judged(case, equipment, watch),
        )
    }
}

/// Makes a traversal. Returns `None` if the watch stops.
fn judged(
    case: Traversal,
    equipment: &RobotEquipment,
    watch: &dyn Watch,
) -> Option<JudgedTraversal> {
    let (robot, sensor) = equipment.robot(&case.config, case.number);
    let plan = case.config.plan.clone();
    let monitor = GroundTruthMonitor::at(&plan, case.config.marker, case.entry);
    let standing = monitor.standing(case.config.pose);
    let mut explorer = RobotExplorer::new(robot, sensor, (monitor, StoppedBy(watch)));
    if let Some(standing) = standing {
        explorer = explorer.standing_at(standing);
    }
    let error = explorer.traverse(case.door).err();
    let (robot, (monitor, _)) = explorer.into_parts();
    let outcome = match (error, monitor.divergence()) {
        (Some(ExplorerError::Stopped { .. }), _) => return None,
        (Some(error), _) => TraversalOutcome::GaveUp(error),
        (None, Some(divergence)) => TraversalOutcome::Wrong(divergence),
        (None, None) => TraversalOutcome::Right,
    };
    Some(JudgedTraversal {
        traversal: case,
        outcome,
        seconds: robot.odometry().time,
        frames: robot.frames(),
    })
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

/// A random pose near another one.
fn about(pose: Pose, chance: &mut impl Rng) -> Pose {
    let [along, aside] = [(); 2].map(|()| chance.random_range(-OFF..=OFF));
    let turned = chance.random_range(-TURNED..=TURNED).to_radians();
    let (ahead, left) = (pose.heading.sin_cos(), (pose.heading + FRAC_PI_2).sin_cos());
    let position = [
        pose.position[0] + along * ahead.1 + aside * left.1,
        pose.position[1] + along * ahead.0 + aside * left.0,
    ];
    Pose { position, heading: pose.heading + turned }
}

#[cfg(test)]
mod tests {
    use toposlam_model::mapping::MappingAlgorithm;

    use super::*;
    use crate::{
        evaluation::run_sampler::{Faults, RunSampler},
        plans,
        question_limit::QuestionLimit,
    };

    type Count<'a> = &'a dyn Fn(&QuestionLimit) -> usize;

    /// The watch is asked before a case, and then before each image.
    #[test]
    fn a_traversal_and_a_run_that_are_stopped_on_the_way_are_not_judged() {
        let plans = plans().unwrap();
        let traversals = TraversalSampler::new(plans.clone(), 1, 1.0);
        let algorithm = MappingAlgorithm::Algorithm1;
        let runs = RunSampler::new(plans, 1, Faults::None, 1, 1.0, algorithm);
        let counts: [Count<'_>; 2] =
            [&|watch| traversals.judged(0..1, &RobotEquipment::Scenes, watch).len(), &|watch| {
                runs.judged(0..1, &RobotEquipment::Scenes, watch).len()
            }];
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
