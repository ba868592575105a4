//! Lengths and turns of hallways, measured by simulated robots: false alarms of the tests, and how many changes of
//! a length they find.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_conform::{EventSource, RecordedEvents, RunEvents};
use toposlam_logs::record::{Event, EventKind, RunObserver, StoppedBy};
use toposlam_model::{
    enumerate::Watch,
    mapping::MappingAlgorithm,
    measurement::{MeasuredVisit, MeasurementCheck, MeasurementContradiction, MeasurementNoise},
};
use toposlam_robot::{
    measured_hallway::log_noise, run_settings::RunSettings, superscout::MEASUREMENT_NOISE,
};

use super::{
    parallel::made_in_turn,
    run_sampler::{RunCase, RunSampler, dart_bound},
};
use crate::{
    RobotEquipment,
    run::{RunOutcome, explored, run},
};

/// The changes of a length that are to be found, in metres.
pub const LENGTH_CHANGES: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

/// The measurements of a run in which nothing happened.
#[derive(Clone, Debug)]
pub struct MeasuredRun {
    /// The run.
    pub case: RunCase,
    /// The number of measured traversals.
    pub measured: usize,
    /// The number of those whose hallway was measured before.
    pub compared: usize,
    /// With the calibration of the base, and with the uncertainty of a [log](log_noise).
    pub tests: [MeasuredTest; 2],
}

/// The result of the tests with some uncertainty.
#[derive(Clone, Debug)]
pub struct MeasuredTest {
    /// The false alarms.
    pub alarms: Vec<MeasurementContradiction>,
    /// For each of [`LENGTH_CHANGES`], whether a traversal is found if its length is changed by as much; `None`
    /// without a traversal. It is any of the run.
    pub found: [Option<bool>; 4],
}

/// The algorithm of the runs.
const ALGORITHM: MappingAlgorithm = MappingAlgorithm::Algorithm1;

impl RunSampler {
    /// The least number of runs with as many traversals as this.
    #[must_use]
    pub fn runs_with(&self, traversals: u64) -> u64 {
        let mut moves = 0;
        let mut runs = 0;
        while moves < traversals
            && let Some(case) = self.case(runs)
        {
            let plan = &case.config.plan;
            moves += explored(plan, case.config.marker, ALGORITHM, dart_bound(plan)).max(1);
            runs += 1;
        }
        runs
    }

    /// Measures the hallways in runs by their numbers on all threads, with these sensors. Runs that do not end right
    /// are missing, and some if the watch stops.
    #[must_use]
    pub fn measured(
        &self,
        numbers: std::ops::Range<u64>,
        equipment: &RobotEquipment,
        watch: &dyn Watch,
    ) -> Vec<MeasuredRun> {
        let case = |number| self.case(number);
        made_in_turn(numbers, watch, case, |case| measured(case, equipment, watch))
    }
}

/// Records arrivals, doors, and the odometry of each frame.
#[derive(Default)]
struct Recorder(RecordedEvents);

impl RunObserver for Recorder {
    fn event(&mut self, event: &Event) {
        let source = EventSource { time: event.time, id: event.id, offset: 0 };
        match &event.kind {
            EventKind::Frame(frame) => {
                self.0.observe(source, &EventKind::Odometry(frame.odometry));
            }
            kind => self.0.observe(source, kind),
        }
    }
}

/// Makes a run. Returns `None` if it does not end right.
fn measured(case: RunCase, equipment: &RobotEquipment, watch: &dyn Watch) -> Option<MeasuredRun> {
    let (plan, marker) = (case.config.plan.clone(), case.config.marker);
    let (robot, sensor) = equipment.robot(&case.config, case.number);
    let mut recorder = Recorder::default();
    let observer = (&mut recorder, StoppedBy(watch));
    let settings = RunSettings::new(ALGORITHM, dart_bound(&plan));
    let run = run(&plan, marker, robot, sensor, observer, &settings);
    if run.outcome() != RunOutcome::Right {
        return None;
    }
    let events = RunEvents { events: recorder.0.finish(), ..RunEvents::default() };
    let visits = events.measured_visits()?;
    let factor = case.config.noise;
    let tests = [MEASUREMENT_NOISE.times(factor, factor), log_noise()]
        .map(|noise| MeasuredTest::new(&visits, &noise, case.config.seed));
    let MeasurementCheck { measured, compared, .. } =
        MeasurementCheck::new(&visits, &MEASUREMENT_NOISE);
    Some(MeasuredRun { case, measured, compared, tests })
}

impl MeasuredTest {
    fn new(visits: &[MeasuredVisit], noise: &MeasurementNoise, seed: u64) -> Self {
        let mut chance = Xoshiro256PlusPlus::seed_from_u64(seed);
        let found = LENGTH_CHANGES.map(|metres| {
            let visit = chance.random_range(0..visits.len());
            let shorter = chance.random::<bool>();
            is_found(visits, visit, if shorter { -metres } else { metres }, noise)
        });
        Self { alarms: MeasurementCheck::new(visits, noise).contradictions, found }
    }
}

/// Whether a contradiction shows that the length of the hallway before a visit is changed by this, in metres.
fn is_found(
    visits: &[MeasuredVisit],
    visit: usize,
    metres: f64,
    noise: &MeasurementNoise,
) -> Option<bool> {
    let mut changed = visits.to_vec();
    let hallway = changed.get_mut(visit)?.arrived.as_mut()?;
    let shorter = hallway.length + metres;
    hallway.length = if shorter > 0.0 { shorter } else { hallway.length - metres };
    let check = MeasurementCheck::new(&changed, noise);
    Some(check.contradictions.iter().any(|found| found.visit >= visit))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{evaluation::run_sampler::Faults, plans, question_limit::QuestionLimit};

    fn sampler() -> RunSampler {
        RunSampler::new(plans().unwrap(), 2, Faults::None, 1, 1.0, ALGORITHM)
    }

    #[test]
    fn a_change_by_4_m_is_found_and_one_by_nothing_is_not() {
        let runs = sampler().measured(0..20, &RobotEquipment::Scenes, &());
        assert_eq!(runs.len(), 20);
        for test in [0, 1] {
            let tests = || runs.iter().map(move |run| &run.tests[test]);
            let alarms: usize = tests().map(|test| test.alarms.len()).sum();
            assert_eq!(alarms, 0);
            let found =
                |change: usize| tests().filter(|test| test.found[change] == Some(true)).count();
            let cases = tests().filter(|test| test.found[3].is_some()).count();
            // A hallway that is traversed once, on no closed walk, has no second measurement.
            assert!(10 * found(3) >= 9 * cases && cases > 10, "{} of {cases}", found(3));
            assert!(found(0) <= found(3) + 3, "{} {}", found(0), found(3));
        }
    }

    #[test]
    fn as_many_runs_are_made_as_have_the_traversals() {
        let sampler = sampler();
        assert_eq!((sampler.runs_with(0), sampler.runs_with(1)), (0, 1));
        let runs = sampler.runs_with(300);
        let measured = |runs: u64| {
            let runs = sampler.measured(0..runs, &RobotEquipment::Scenes, &());
            runs.iter().map(|run| run.measured as u64).sum::<u64>()
        };
        assert!(measured(runs) >= 300 && measured(runs - 1) < 300, "{runs}");
    }

    #[test]
    fn a_run_that_is_stopped_is_not_measured() {
        let limited = QuestionLimit::at(3);
        assert!(sampler().measured(0..1, &RobotEquipment::Scenes, &limited).is_empty());
    }
}
