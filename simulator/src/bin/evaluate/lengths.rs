//! `evaluate lengths`: the lengths and turns of hallways by odometry, false alarms, and changes that are
//! detected.

use std::io::Write;

use serde_json::json;
use toposlam_model::{
    enumerate::Watch, mapping::MappingAlgorithm, measurement::MeasurementContradiction,
};
use toposlam_simulator::evaluation::bound::upper_bound;
use toposlam_terminal::{
    CliError, Outcome,
    exit_codes::help_end,
    progress::Progress,
    text::{counted, grouped, print_rows},
};

use super::{
    evaluation_report::{MeasurementEnd, outcome},
    robots::{RandomPlans, RobotArguments},
};
use toposlam_simulator::evaluation::{
    measured_run::{LENGTH_CHANGES, MeasuredRun},
    report::TargetStatus,
    run_sampler::{Faults, RunSampler},
};

/// Measure the lengths of hallways by odometry: how often do they contradict each other, and how many changes
/// are detected?
///
/// Robots map whole buildings by Algorithm 1, and measure the length and the turn of each traversed hallway. A
/// contradiction between measurements is a false alarm, because nothing happened in these runs. The target is at
/// most one false alarm in 10,000 traversals. Then the length of one traversal of each run is changed, and the
/// command reports how many changes the measurements find. A hallway that is traversed only once, on no closed
/// walk, shows no change.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  evaluate lengths                       takes about half a minute
  evaluate lengths --sensor laser --traversals 2000
  evaluate lengths --plan worlds/shape-6.toml --traversals 500 --json",
    &[
        (0, "the target is met"),
        (1, "the target is missed"),
        (2, "bad usage or input"),
        (3, "the target is not shown, or not everything was measured"),
    ],
))]
pub(super) struct EvaluateLengthsArguments {
    /// Least number of traversals
    #[arg(long, default_value_t = 100_000, value_name = "N")]
    traversals: u64,
    /// Number of random plans, if no plan is given
    #[arg(long, default_value_t = 200, value_name = "N", conflicts_with = "plan")]
    plans: u64,
    #[command(flatten)]
    robots: RobotArguments,
}

/// The greatest rate of false alarms.
const TARGET: f64 = 1e-4;

impl EvaluateLengthsArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let mut sheet = self.robots.report.begin()?;
        let plans = self.robots.plans(RandomPlans::Large(self.plans), usize::MAX)?;
        let RobotArguments { seed, noise, .. } = self.robots;
        let algorithm = MappingAlgorithm::Algorithm1;
        let sampler = RunSampler::new(plans, usize::MAX, Faults::None, seed, noise, algorithm);
        let equipment = self.robots.equipment()?;
        let numbers = 0..sampler.runs_with(self.traversals);
        let progress = Progress::new("runs", "runs")?;
        let runs = sampler.measured(numbers, &equipment, &progress);
        let ending =
            if progress.stop() { MeasurementEnd::Interrupted } else { MeasurementEnd::Whole };
        progress.finish();
        let tally = Tally::of(&runs);
        let outcome = outcome(tally.status(), ending);

        let [measured, compared] =
            [tally.measured, tally.compared].map(|count| grouped(count as u128));
        let count = counted(runs.len(), "run");
        let text = sheet.text();
        writeln!(text, "Lengths of hallways, by {}, seed {seed}", self.robots.sensing())?;
        writeln!(text, "  {measured} traversals in {count}")?;
        writeln!(text, "  {compared} of them in hallways that were measured before")?;
        for (run, alarm) in alarms(&runs) {
            let what = format!("run {} in {}", run.case.number, run.case.plan_name);
            sheet.failure(what, alarm.measurement)?;
        }
        print_rows(sheet.text(), ["", "calibrated base", "log"], &tally.rows())?;
        for (noise, test) in ["calibrated", "log"].into_iter().zip(&tally.tests) {
            let alarms = [test.alarms, test.measured];
            sheet.share_line(&format!("false alarms, {noise}"), alarms)?;
            for (metres, found) in LENGTH_CHANGES.into_iter().zip(test.found) {
                sheet.share_line(&format!("{metres:.1} m found, {noise}"), found)?;
            }
        }
        let first_alarm = alarms(&runs).next().map(|(run, alarm)| {
            json!({
                "run": run.case.number, "plan": run.case.plan_name, "visit": alarm.visit,
                "earlier": alarm.earlier, "what": alarm.measurement.to_string(),
            })
        });
        let line = json!({
            "runs": runs.len(), "traversals": tally.measured, "compared": tally.compared,
            "seed": seed, "target": TARGET, "first_alarm": first_alarm,
        });
        let verdict = match (outcome, ending) {
            (Outcome::Holds, _) => "holds: at most 1 false alarm in 10,000 traversals",
            (Outcome::Violated, _) => "violated: more than 1 false alarm in 10,000 traversals",
            (_, MeasurementEnd::Interrupted) => "incomplete, interrupted",
            _ => "not shown: there are too few traversals",
        };
        sheet.finish(out, ("lengths", &line), outcome, verdict)
    }
}

/// The false alarms with a calibrated base, with their runs.
fn alarms(
    runs: &[MeasuredRun],
) -> impl Iterator<Item = (&MeasuredRun, &MeasurementContradiction)> + '_ {
    runs.iter().flat_map(|run| run.tests[0].alarms.iter().map(move |alarm| (run, alarm)))
}

/// The sums over all runs.
struct Tally {
    measured: usize,
    compared: usize,
    /// With the calibration of the base, and with the uncertainty of a log.
    tests: [TestTally; 2],
}

/// The results of the tests with some uncertainty.
struct TestTally {
    measured: usize,
    alarms: usize,
    /// For each of the changes, how many were found, and how many were made.
    found: [[usize; 2]; 4],
}

impl Tally {
    fn of(runs: &[MeasuredRun]) -> Self {
        let sum = |of: fn(&MeasuredRun) -> usize| runs.iter().map(of).sum();
        let measured = sum(|run| run.measured);
        let tests = [0, 1].map(|test: usize| {
            let tests = || runs.iter().map(move |run| &run.tests[test]);
            let found = [0, 1, 2, 3].map(|change: usize| {
                let made = || tests().filter_map(move |test| test.found[change]);
                [made().filter(|&found| found).count(), made().count()]
            });
            TestTally { measured, alarms: tests().map(|test| test.alarms.len()).sum(), found }
        });
        Self { measured, compared: sum(|run| run.compared), tests }
    }

    /// The rows of the table, one column for each of the tests.
    fn rows(&self) -> Vec<[String; 3]> {
        let [robot, log] = self.tests.each_ref().map(|test| {
            let most = 100.0 * upper_bound(test.alarms, test.measured);
            format!("{}, at most {most:.3} %", grouped(test.alarms as u128))
        });
        let mut rows = vec![["false alarms".to_owned(), robot, log]];
        for (index, metres) in LENGTH_CHANGES.into_iter().enumerate() {
            let [robot, log] = self.tests.each_ref().map(|test| {
                let [found, of] = test.found[index].map(|count| grouped(count as u128));
                format!("{found} of {of}")
            });
            rows.push([format!("{metres:.1} m found"), robot, log]);
        }
        rows
    }

    /// Whether the target is met by both.
    fn status(&self) -> TargetStatus {
        let status = |test: &TestTally| TargetStatus::of(test.alarms, test.measured, TARGET);
        self.tests.iter().map(status).max().unwrap_or(TargetStatus::NotShown)
    }
}
