//! Whole runs: on many plans, from several starts, with and without things that go wrong. Section 6.

use std::sync::Arc;

use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_model::{
    embedded_graph::Dart,
    enumerate::Watch,
    floor_plan::{FloorPlan, JunctionKind},
    mapping::DEFAULT_DART_BOUND,
};

use super::{LearnedSensors, parallel::made_in_turn};
use crate::{
    run::{RunOutcome, explored, run},
    simulator::{Effects, FAULTS, FaultKind, RobotFault, SimulationConfig},
};

/// All runs of a seed: in each plan from as many starts.
#[derive(Clone, Debug)]
pub struct RunSampler {
    plans: Vec<(String, Arc<FloorPlan>)>,
    /// The number of the plan, and the facing dart.
    starts: Vec<(usize, Dart)>,
    seed: u64,
    noise: f64,
    faults: Faults,
}

/// Whether things go wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Faults {
    /// Nothing does.
    None,
    /// In each run one thing does, each kind in turn, at some picture.
    Each,
}

/// A run to be.
#[derive(Clone, Debug)]
pub struct RunCase {
    /// Its number among those of its seed.
    pub number: u64,
    /// The plan's name.
    pub plan_name: String,
    /// Where the robot starts and what is around it.
    pub config: SimulationConfig,
}

/// A run that was made.
#[derive(Clone, Debug)]
pub struct JudgedRun {
    /// Which.
    pub case: RunCase,
    /// How it ended.
    pub ending: RunOutcome,
    /// Moves that the robot made, those that Algorithm 1 makes in the plan's embedded graph.
    pub moves: [u64; 2],
    /// Seconds of simulated time.
    pub seconds: f64,
    /// How many pictures the robot asked for.
    pub pictures: u64,
}

impl JudgedRun {
    /// What went wrong, on purpose.
    #[must_use]
    pub fn fault(&self) -> Option<FaultKind> {
        self.case.config.faults.first().map(|fault| fault.kind)
    }

    /// Whether the robot has a wrong map, or a wrong pose, and does not know; but a robot that was
    /// carried, unseen, to a place that looks and goes on alike cannot know.
    #[must_use]
    pub fn is_violation(&self) -> bool {
        matches!(self.ending, RunOutcome::Wrong(_)) && self.fault() != Some(FaultKind::Carried)
    }
}

/// A run is given up with so many more than twice the darts that there are.
const SPARE_DARTS: usize = 20;
/// So many pictures a robot takes on one move, about: a fault comes up somewhere in a run.
const PICTURES_A_MOVE: u64 = 16;

impl RunSampler {
    /// The runs of a seed in these plans, from so many starts each; those without an L are left out,
    /// where a robot cannot put its marker down. Where it has fewer starts than that, from all of them.
    #[must_use]
    pub fn new(
        plans: Vec<(String, Arc<FloorPlan>)>,
        starts: usize,
        faults: Faults,
        seed: u64,
        noise: f64,
    ) -> Self {
        let some = |(number, (_, plan)): (usize, &(String, Arc<FloorPlan>))| {
            let all = starts_of(plan);
            let wanted = starts.min(all.len());
            // Evenly spread, beginning with another one in each plan.
            let nth = move |n: usize| (number, all[(number + n * all.len() / wanted) % all.len()]);
            (0..wanted).map(nth).collect::<Vec<_>>()
        };
        let starts = plans.iter().enumerate().flat_map(some).collect();
        Self { plans, starts, seed, noise, faults }
    }

    /// The number of starts.
    #[must_use]
    pub fn starts(&self) -> usize {
        self.starts.len()
    }

    /// The run of a number; `None` where there is no start.
    #[must_use]
    pub fn case(&self, number: u64) -> Option<RunCase> {
        let start = number.checked_rem(self.starts.len() as u64)?;
        let (plan, facing) = self.starts[start as usize];
        let (plan_name, plan) = self.plans[plan].clone();
        let mut chance = Xoshiro256PlusPlus::seed_from_u64(self.seed.wrapping_add(number));
        let mut config = SimulationConfig::at_start(plan, facing, chance.next_u64());
        config.noise = self.noise;
        if self.faults == Faults::Each {
            let (kind, ..) = FAULTS[(number % FAULTS.len() as u64) as usize];
            let moves = explored(&config.plan, facing, DEFAULT_DART_BOUND);
            let picture = chance.random_range(2..=PICTURES_A_MOVE * moves.max(1));
            config.faults.push(RobotFault::at(kind, picture));
        }
        Some(RunCase { number, plan_name, config })
    }

    /// Makes runs by their numbers, on all threads; with pictures where there are eyes for them. Where
    /// the watch breaks off, some are missing.
    #[must_use]
    pub fn judged(
        &self,
        numbers: std::ops::Range<u64>,
        eyes: Option<&LearnedSensors>,
        watch: &impl Watch,
    ) -> Vec<JudgedRun> {
        made_in_turn(numbers, watch, |number| self.case(number), |case| judged(case, eyes))
    }
}

/// A run, made.
fn judged(case: RunCase, eyes: Option<&LearnedSensors>) -> JudgedRun {
    let SimulationConfig { plan, marker, seed, .. } = case.config.clone();
    // A robot that has gone astray would go on mapping what is not there.
    let bound = 2 * plan.graph().dart_count() + SPARE_DARTS;
    let (robot, sensor) = match eyes {
        None => (case.config.by_scene(), None),
        Some(eyes) => {
            let look = eyes.look(case.number);
            let effects = Effects::drawn(&mut Xoshiro256PlusPlus::seed_from_u64(seed));
            let robot = case.config.with_images(eyes.rig(), look, &effects);
            (robot, Some(eyes.sensor(look)))
        }
    };
    let run = run(&plan, marker, robot, sensor, (), bound);
    JudgedRun {
        case,
        ending: run.outcome(),
        moves: [run.exploration.moves(), run.explore_moves],
        seconds: run.seconds,
        pictures: run.pictures,
    }
}

/// Where a robot can start to explore a plan: the darts of its Ls.
#[must_use]
pub fn starts_of(plan: &FloorPlan) -> Vec<Dart> {
    let graph = plan.graph();
    let is_l = |dart: &Dart| plan.junction(graph.vertex(*dart)).kind == JunctionKind::L;
    graph.darts().filter(is_l).collect()
}
