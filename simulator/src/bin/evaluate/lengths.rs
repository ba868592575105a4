//! `evaluate lengths`: the lengths and turns of hallways by odometry, false alarms, and changes that are
//! detected.

use std::{io::Write, iter};

use serde_json::json;
use toposlam_model::{mapping::MappingAlgorithm, measurement::MeasurementContradiction};
use toposlam_simulator::{RobotEquipment, evaluation::bound::upper_bound};
use toposlam_terminal::{
    CliError, Outcome, exit_codes::help_end, progress::must_stop, text::counted,
};

use super::{
    report::{MeasurementEnd, measure, number},
    robots::{RandomPlans, RobotArguments},
};
use toposlam_simulator::evaluation::{
    measured_run::{LENGTH_CHANGES, MeasuredRun},
    report::TargetStatus,
    run_sampler::RunSampler,
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
        let sampler =
            RunSampler::new(plans, usize::MAX, 0, seed, noise, MappingAlgorithm::Algorithm1);
        let equipment = self.robots.equipment()?;
        if matches!(equipment, RobotEquipment::Laser(_)) {
            let cause =
                "a robot with a scanner drives into arms on its way, and measures no hallways";
            return Err(CliError::at("--sensor", cause));
        }
        let numbers = 0..sampler.runs_with(self.traversals);
        let runs = measure("runs", "runs", numbers, |number, watch| {
            sampler.measured(number, &equipment, watch)
        })?;
        let ending = MeasurementEnd::interrupted_if(must_stop());
        let [measured, compared]: [usize; 2] =
            [runs.iter().map(|run| run.measured).sum(), runs.iter().map(|run| run.compared).sum()];
        // With the calibration of the base, and with the uncertainty of a log: the false alarms, and for each of the
        // changes, how many were found, and how many were made.
        let tests = [0, 1].map(|test: usize| {
            let tests = || runs.iter().map(move |run| &run.tests[test]);
            let found = [0, 1, 2, 3].map(|change: usize| {
                let made = || tests().filter_map(move |test| test.found[change]);
                [made().filter(|&found| found).count(), made().count()]
            });
            (tests().map(|test| test.alarms.len()).sum::<usize>(), found)
        });
        let statuses = tests.map(|(alarms, _)| TargetStatus::from_counts(alarms, measured, TARGET));
        let outcome = ending.outcome(statuses[0].max(statuses[1]));

        writeln!(sheet.text, "Lengths of hallways, by {}, seed {seed}", self.robots.sensing())?;
        writeln!(
            sheet.text,
            "  {} traversals in {}",
            number(measured),
            counted(runs.len(), "run")
        )?;
        let compared_text = number(compared);
        writeln!(sheet.text, "  {compared_text} of them in hallways that were measured before")?;
        for (run, alarm) in alarms(&runs) {
            let what = format!("run {} in {}", run.case.number, run.case.plan_name);
            sheet.failure(what, alarm.measurement)?;
        }
        let [robot, log] = tests.map(|(alarms, _)| {
            let most = 100.0 * upper_bound(alarms, measured);
            format!("{}, at most {most:.3} %", number(alarms))
        });
        let changes = LENGTH_CHANGES.into_iter().enumerate().map(|(change, metres)| {
            let [robot, log] = tests.map(|(_, found)| {
                let [found, of] = found[change].map(number);
                format!("{found} of {of}")
            });
            [format!("{metres:.1} m found"), robot, log]
        });
        let rows = iter::once(["false alarms".to_owned(), robot, log]).chain(changes);
        sheet.table(["", "calibrated base", "log"], rows)?;
        for (noise, (alarms, found)) in ["calibrated", "log"].into_iter().zip(tests) {
            sheet.share_line(&format!("false alarms, {noise}"), [alarms, measured])?;
            for (metres, found) in LENGTH_CHANGES.into_iter().zip(found) {
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
            "runs": runs.len(), "traversals": measured, "compared": compared,
            "seed": seed, "target": TARGET, "first_alarm": first_alarm,
        });
        let verdict = ending.verdict(
            outcome,
            [
                "holds: at most 1 false alarm in 10,000 traversals",
                "violated: more than 1 false alarm in 10,000 traversals",
                "not shown: there are too few traversals",
            ],
        );
        sheet.finish(out, ("lengths", line), outcome, verdict)
    }
}

/// The false alarms with a calibrated base, with their runs.
fn alarms(
    runs: &[MeasuredRun],
) -> impl Iterator<Item = (&MeasuredRun, &MeasurementContradiction)> + '_ {
    runs.iter().flat_map(|run| run.tests[0].alarms.iter().map(move |alarm| (run, alarm)))
}
