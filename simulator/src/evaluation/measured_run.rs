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
use toposlam_robot::{measured_hallway::log_noise, superscout::MEASUREMENT_NOISE};

use super::run_sampler::{RobotCase, RunSampler, dart_bound};
use crate::{
    RobotEquipment,
    run::{RunOutcome, explored},
};

/// The changes of a length that are to be found, in metres.
pub const LENGTH_CHANGES: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

/// The measurements of a run in which nothing happened.
#[derive(Clone, Debug)]
pub struct MeasuredRun {
    pub case: RobotCase,
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
    pub alarms: Vec<MeasurementContradiction>,
    /// For each of [`LENGTH_CHANGES`], whether a traversal is found if its length is changed by as much; `None`
    /// without a traversal. It is any of the run.
    pub found: [Option<bool>; 4],
}

const ALGORITHM: MappingAlgorithm = MappingAlgorithm::Algorithm1;

impl RunSampler {
    /// The least number of runs with as many traversals as this.
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

    /// Makes the run with this number, and measures its hallways. Returns `None` if it does not end right, or if the
    /// watch stops.
    pub fn measured(
        &self,
        number: u64,
        equipment: &RobotEquipment,
        watch: &dyn Watch,
    ) -> Option<MeasuredRun> {
        let case = self.case(number)?;
        let mut recorder = Recorder::default();
        let run = case.run(equipment, ALGORITHM, (&mut recorder, StoppedBy(watch)));
        if run.outcome() != RunOutcome::Right {
            return None;
        }
        let events = RunEvents { events: recorder.0.finish(), ..RunEvents::default() };
        let visits = events.measured_visits()?;
        let factor = case.config.noise;
        let tests = [MEASUREMENT_NOISE.times(factor, factor), log_noise()]
            .map(|noise| MeasuredTest::new(&visits, &noise, case.config.seed));
        let check = MeasurementCheck::new(&visits, &MEASUREMENT_NOISE);
        Some(MeasuredRun { case, measured: check.measured, compared: check.compared, tests })
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
    use crate::{evaluation::sampling::sample, plans};

    fn sampler() -> RunSampler {
        RunSampler::new(plans().unwrap(), 2, 0, 1, 1.0, ALGORITHM)
    }

    fn measured(runs: u64) -> Vec<MeasuredRun> {
        let sampler = sampler();
        sample(0..runs, &(), |number| sampler.measured(number, &RobotEquipment::Scenes, &()))
    }

    #[test]
    fn a_change_by_4_m_is_found_and_one_by_nothing_is_not() {
        let runs = measured(20);
        assert_eq!(runs.len(), 20);
        for test in [0, 1] {
            let tests = || runs.iter().map(move |run| &run.tests[test]);
            assert_eq!(tests().map(|test| test.alarms.len()).sum::<usize>(), 0);
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
        let traversals = |runs: u64| measured(runs).iter().map(|run| run.measured).sum::<usize>();
        assert!(traversals(runs) >= 300 && traversals(runs - 1) < 300, "{runs}");
    }
}
