//! Whole runs on many plans, from several starts, with and without faults. Section 6.

use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_logs::{
    messages,
    record::{RunObserver, StoppedBy},
    recorder::Recorder,
    writer::LogWriteError,
};
use toposlam_model::{
    embedded_graph::Dart,
    enumerate::Watch,
    floor_plan::FloorPlan,
    folding::certificate_length,
    mapping::{DEFAULT_DART_BOUND, MappedWorld, MappingError, MappingMethod},
};
use toposlam_robot::{
    explorer::ExplorerError,
    run_settings::{RecordedSettings, RunSettings},
};

use crate::{
    FAULTS, FaultKind, NamedPlan, RobotEquipment, RobotFault, SimulationConfig,
    run::{Run, RunOutcome, WayToMarker, explored, run},
    starts_of,
};

/// All runs of a seed: the same number of starts in each plan.
#[derive(Clone, Debug)]
pub struct RunSampler {
    plans: Vec<NamedPlan>,
    /// The index of the plan, and the facing dart.
    pub starts: Vec<(usize, Dart)>,
    seed: u64,
    noise: f64,
    /// The number of faults in each run. The kinds take turns.
    faults: u32,
    method: MappingMethod,
}

/// A robot in a plan.
#[derive(Clone, Debug)]
pub struct RobotCase {
    /// Its number among the samples of the seed.
    pub number: u64,
    pub plan_name: String,
    /// The robot and its surroundings.
    pub config: SimulationConfig,
}

impl RobotCase {
    /// Makes the run of the robot.
    pub(super) fn run(
        &self,
        equipment: &RobotEquipment,
        method: impl Into<MappingMethod>,
        observer: impl RunObserver,
    ) -> Run<'_> {
        let SimulationConfig { plan, marker, .. } = &self.config;
        let (robot, sensor) = equipment.robot(&self.config, self.number);
        run(plan, *marker, robot, sensor, observer, &run_settings(method, plan))
    }
}

#[derive(Clone, Debug)]
pub struct JudgedRun {
    pub case: RobotCase,
    pub ending: RunOutcome,
    /// Whether at the end the robot can come to its marker.
    pub way_to_marker: WayToMarker,
    /// The robot's moves, and the moves of the algorithm in the plan's embedded graph.
    pub moves: [u64; 2],
    /// The moves of the certificate of the plan.
    pub certificate_moves: u64,
    /// What the map took, if the robot has one.
    pub mapped: Option<MappedWorld>,
    /// Simulated time, in seconds.
    pub seconds: f64,
    /// The number of images that were requested.
    pub frames: u64,
}

impl JudgedRun {
    pub fn has_fault(&self, kind: FaultKind) -> bool {
        self.case.config.faults.iter().any(|fault| fault.kind == kind)
    }

    pub fn blocked(&self) -> &[Dart] {
        self.mapped.as_ref().map_or(&[], |mapped| &mapped.blocked)
    }

    pub fn audit_moves(&self) -> u64 {
        self.mapped.as_ref().map_or(0, |mapped| mapped.audit_moves)
    }

    /// Whether the map or the pose is wrong, and the robot could have detected it and did not. Without an audit, a
    /// robot cannot detect that it was carried to a place that looks the same.
    pub fn is_violation(&self) -> bool {
        matches!(self.ending, RunOutcome::Wrong(_))
            && (self.audit_moves() > 0 || !self.has_fault(FaultKind::Carried))
    }
}

/// The robot gives up if it knows more than twice the plan's darts and this many.
const SPARE_DARTS: usize = 20;
/// The approximate number of images per move, to place faults within a run.
const FRAMES_A_MOVE: u64 = 16;

impl RunSampler {
    /// The runs of a seed in these plans. Plans without an L are left out, because the marker needs
    /// one. A plan with fewer starts than `starts` is mapped from all of them.
    pub fn new(
        plans: Vec<NamedPlan>,
        starts: usize,
        faults: u32,
        seed: u64,
        noise: f64,
        method: impl Into<MappingMethod>,
    ) -> Self {
        let some = |(number, (_, plan)): (usize, &NamedPlan)| {
            let all = starts_of(plan);
            let wanted = starts.min(all.len());
            // Evenly spread starts, with another first one in each plan.
            let nth = move |n: usize| (number, all[(number + n * all.len() / wanted) % all.len()]);
            (0..wanted).map(nth).collect::<Vec<_>>()
        };
        let starts = plans.iter().enumerate().flat_map(some).collect();
        Self { plans, starts, seed, noise, faults, method: method.into() }
    }

    /// The run with this number, before it is made; `None` without starts.
    pub fn case(&self, number: u64) -> Option<RobotCase> {
        let start = number.checked_rem(self.starts.len() as u64)?;
        let (plan, facing) = self.starts[start as usize];
        let (plan_name, plan) = self.plans[plan].clone();
        let mut chance = Xoshiro256PlusPlus::seed_from_u64(self.seed.wrapping_add(number));
        let mut config = SimulationConfig::at_start(plan, facing, chance.next_u64());
        config.noise = self.noise;
        if self.faults > 0 {
            let moves = explored(&config.plan, facing, self.method.algorithm(), DEFAULT_DART_BOUND);
            for nth in 0..u64::from(self.faults) {
                let (kind, ..) = FAULTS[((number + nth * nth) % FAULTS.len() as u64) as usize];
                let frame = chance.random_range(2..=FRAMES_A_MOVE * moves.max(1));
                config.faults.push(RobotFault::at(kind, frame));
            }
        }
        Some(RobotCase { number, plan_name, config })
    }

    /// How the robot of a run maps.
    pub fn settings(&self, case: &RobotCase) -> RecordedSettings {
        run_settings(self.method, &case.config.plan).recorded()
    }

    /// Makes a run once more. Returns its log, which begins with this head.
    pub fn log(
        &self,
        case: &RobotCase,
        equipment: &RobotEquipment,
        head: &messages::Run,
    ) -> Result<Vec<u8>, LogWriteError> {
        let mut case = case.clone();
        case.config.keeps_track = true;
        let camera = equipment.sensors().map(|sensors| sensors.camera().clone());
        let mut recorder = Recorder::new(Vec::new(), head, camera)?;
        case.run(equipment, self.method, &mut recorder);
        recorder.finish()
    }

    /// Makes the run with this number. Returns `None` without starts, or if the watch stops.
    pub fn run(
        &self,
        number: u64,
        equipment: &RobotEquipment,
        watch: &dyn Watch,
    ) -> Option<JudgedRun> {
        let case = self.case(number)?;
        let run = case.run(equipment, self.method, StoppedBy(watch));
        let ending = run.outcome();
        if let RunOutcome::GaveUp(MappingError::World(ExplorerError::Stopped { .. })) = ending {
            return None;
        }
        let SimulationConfig { plan, marker, .. } = &case.config;
        Some(JudgedRun {
            ending,
            way_to_marker: run.way_to_marker,
            moves: [run.moves, run.explore_moves],
            certificate_moves: certificate_length(plan.graph(), *marker) as u64,
            mapped: run.mapped,
            seconds: run.seconds,
            frames: run.frames,
            case,
        })
    }
}

/// How a robot maps a plan.
fn run_settings(method: impl Into<MappingMethod>, plan: &FloorPlan) -> RunSettings {
    RunSettings::new(method, dart_bound(plan))
}

/// The bound on the darts of a map, which stops a robot that maps places that do not exist.
pub(super) fn dart_bound(plan: &FloorPlan) -> usize {
    2 * plan.graph().dart_count() + SPARE_DARTS
}
