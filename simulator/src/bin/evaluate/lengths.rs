//! `evaluate lengths`: the lengths and turns of hallways by odometry, false alarms, and changes that are
//! detected.

use std::{io::Write, time::Instant};

use serde_json::json;
use toposlam_model::{
    enumerate::Watch, mapping::MappingAlgorithm, measurement::MeasurementContradiction,
};
use toposlam_robot::bound::upper_bound;
use toposlam_terminal::{
    CliError, Outcome,
    exit_codes::help_end,
    json::print_line,
    progress::Progress,
    remark,
    text::{counted, grouped, print_rows},
    use_threads,
};

use super::robots::{RandomPlans, RobotArguments, print_failure, share_json};
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
        use_threads(self.robots.threads)?;
        let plans = self.robots.plans(RandomPlans::Large(self.plans), usize::MAX)?;
        let RobotArguments { seed, noise, .. } = self.robots;
        let algorithm = MappingAlgorithm::Algorithm1;
        let sampler = RunSampler::new(plans, usize::MAX, Faults::None, seed, noise, algorithm);
        let equipment = self.robots.equipment()?;
        let begun = Instant::now();
        let numbers = 0..sampler.runs_with(self.traversals);
        let progress = Progress::new("runs", "runs")?;
        let runs = sampler.measured(numbers, &equipment, &progress);
        let interrupted = progress.stop();
        progress.finish();
        let tally = Tally::of(&runs);
        let outcome = match tally.status() {
            TargetStatus::Missed => Outcome::Violated,
            _ if interrupted => Outcome::Incomplete,
            TargetStatus::Met => Outcome::Holds,
            TargetStatus::NotShown => Outcome::Incomplete,
        };
        if self.robots.json {
            self.print_json(&runs, &tally, outcome, out)?;
        } else {
            self.print(&runs, &tally, (outcome, interrupted), out)?;
        }
        remark!("{:.1} s", begun.elapsed().as_secs_f64());
        Ok(outcome)
    }

    fn print(
        &self,
        runs: &[MeasuredRun],
        tally: &Tally,
        (outcome, interrupted): (Outcome, bool),
        out: &mut dyn Write,
    ) -> Result<(), CliError> {
        let RobotArguments { seed, .. } = self.robots;
        writeln!(out, "Lengths of hallways, by {}, seed {seed}", self.robots.sensing())?;
        let [measured, compared] =
            [tally.measured, tally.compared].map(|count| grouped(count as u128));
        let count = counted(runs.len(), "run");
        writeln!(out, "  {measured} traversals in {count}")?;
        writeln!(out, "  {compared} of them in hallways that were measured before")?;
        for (run, alarm) in alarms(runs) {
            let what = format!("run {} in {}", run.case.number, run.case.plan_name);
            print_failure(out, what, alarm.measurement)?;
        }
        let [robot, log] = tally.tests.each_ref().map(|test| {
            let most = 100.0 * upper_bound(test.alarms, test.measured);
            format!("{}, at most {most:.3} %", grouped(test.alarms as u128))
        });
        let mut rows = vec![["false alarms".to_owned(), robot, log]];
        for (index, metres) in LENGTH_CHANGES.into_iter().enumerate() {
            let [robot, log] = tally.tests.each_ref().map(|test| {
                let [found, of] = test.found[index];
                let [found, of] = [found, of].map(|count| grouped(count as u128));
                format!("{found} of {of}")
            });
            rows.push([format!("{metres:.1} m found"), robot, log]);
        }
        print_rows(out, ["", "calibrated base", "log"], &rows)?;
        let verdict = match outcome {
            Outcome::Holds => "holds: at most 1 false alarm in 10,000 traversals",
            Outcome::Violated => "violated: more than 1 false alarm in 10,000 traversals",
            Outcome::Incomplete if interrupted => "incomplete, interrupted",
            Outcome::Incomplete => "not shown: there are too few traversals",
        };
        Ok(writeln!(out, "{verdict}")?)
    }

    fn print_json(
        &self,
        runs: &[MeasuredRun],
        tally: &Tally,
        outcome: Outcome,
        out: &mut dyn Write,
    ) -> Result<(), CliError> {
        for (noise, test) in ["calibrated", "log"].into_iter().zip(&tally.tests) {
            let line = |what: &str, [seen, cases]: [usize; 2]| {
                share_json(&format!("{what}, {noise}"), seen, cases)
            };
            print_line(out, "rate", &line("false alarms", [test.alarms, test.measured]))?;
            for (metres, found) in LENGTH_CHANGES.into_iter().zip(test.found) {
                print_line(out, "rate", &line(&format!("{metres:.1} m found"), found))?;
            }
        }
        let first_alarm = alarms(runs).next().map(|(run, alarm)| {
            json!({
                "run": run.case.number, "plan": run.case.plan_name, "visit": alarm.visit,
                "earlier": alarm.earlier, "what": alarm.measurement.to_string(),
            })
        });
        let line = json!({
            "runs": runs.len(), "traversals": tally.measured, "compared": tally.compared,
            "seed": self.robots.seed, "target": TARGET, "first_alarm": first_alarm,
            "verdict": outcome.verdict(), "holds": outcome == Outcome::Holds,
        });
        print_line(out, "lengths", &line)
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

    /// Whether the target is met by both.
    fn status(&self) -> TargetStatus {
        let status = |test: &TestTally| TargetStatus::of(test.alarms, test.measured, TARGET);
        self.tests.iter().map(status).max().unwrap_or(TargetStatus::NotShown)
    }
}
