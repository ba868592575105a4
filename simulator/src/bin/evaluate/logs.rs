//! `evaluate logs`: judges the logs of simulated runs by a laser scanner, as `conform --events laser` does.

use std::io::Write;

use clap::ValueEnum;
use serde_json::json;
use toposlam_conform::ConformVerdict;
use toposlam_terminal::{
    CliError, Outcome,
    exit_codes::help_end,
    text::{counted, grouped},
};

use super::report::{MeasurementEnd, ReportArguments, measure, unmeasured};
use toposlam_simulator::{
    SCANNERS,
    evaluation::{bound::upper_bound, laser::judged_log::OwnJudgement, report::TargetStatus},
};

/// Judge the logs of runs by a laser scanner: is a robot accused that did nothing wrong?
///
/// Runs are those of `evaluate laser --recover`, by the scanners that --scanner names, in turn, in mixed, long and
/// diagonal buildings. A run is stopped after 12 arrivals, or after 6 with a scanner of a short range. `conform --events
/// laser` judges its log without a world and in its own one. Neither may find that it diverges.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  evaluate logs                           takes some minutes
  evaluate logs --runs 1000 --json
  evaluate logs --first 17 --runs 1       one run",
    &[
        (0, "no log diverges"),
        (1, "a log diverges"),
        (2, "bad usage or input"),
        (3, "not everything was judged, or a log shows too few visits"),
    ],
))]
pub(super) struct EvaluateLogsArguments {
    /// Number of runs
    #[arg(long, default_value_t = 40, value_name = "N")]
    runs: u64,
    /// Number of the first run
    #[arg(long, default_value_t = 0, value_name = "N")]
    first: u64,
    /// Random seed
    #[arg(long, default_value_t = 3, value_name = "N")]
    seed: u64,
    #[command(flatten)]
    report: ReportArguments,
}

impl EvaluateLogsArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let mut sheet = self.report.begin()?;
        let Self { runs, first, seed, .. } = self;
        let numbers = first..first.saturating_add(runs);
        let judged = measure("logs", "logs", numbers, |number, watch| {
            OwnJudgement::of_run(seed, number, watch).transpose()
        })?;
        let judged: Vec<OwnJudgement> =
            judged.into_iter().collect::<Result<_, _>>().map_err(unmeasured)?;
        writeln!(
            sheet.text,
            "Logs of {} by a laser scanner, seed {seed}\n",
            counted(judged.len(), "run")
        )?;
        for log in judged.iter().filter(|log| log.diverges() || log.says_nothing()) {
            let [without, in_world] = log.verdicts.map(in_words);
            let how = if log.diverges() { "it diverges" } else { "it shows too few visits" };
            let buildings = log.buildings.to_possible_value();
            let buildings = buildings.as_ref().map_or("", |kind| kind.get_name());
            let how = format!(
                "{how}: without a world {without}, in its own {in_world}; {} visits, {} arrivals",
                log.visits, log.arrivals
            );
            sheet.failure(format!("run {}, {}, {buildings}", log.number, log.scanner), how)?;
            let line = json!({
                "run": log.number, "scanner": log.scanner, "buildings": buildings,
                "without_world": log.verdicts[0].map(ConformVerdict::name),
                "in_world": log.verdicts[1].map(ConformVerdict::name),
                "visits": log.visits, "arrivals": log.arrivals, "diverges": log.diverges(),
            });
            sheet.line("judged-log", &line)?;
        }
        let rows = SCANNERS.iter().map(|scanner| {
            let logs = || judged.iter().filter(|log| log.scanner == scanner.name);
            let count = |is: &dyn Fn(&OwnJudgement) -> bool| {
                logs().filter(|log| is(log)).count().to_string()
            };
            let conform = |log: &OwnJudgement| log.verdicts[0] == Some(ConformVerdict::Conforms);
            let in_world = |log: &OwnJudgement| log.verdicts[1] == Some(ConformVerdict::Conforms);
            [
                scanner.name.to_owned(),
                logs().count().to_string(),
                count(&OwnJudgement::diverges),
                count(&conform),
                count(&in_world),
                logs().map(|log| log.visits).sum::<usize>().to_string(),
            ]
        });
        let heads =
            ["scanner", ">logs", ">diverge", ">conform", ">conform in their world", ">visits"];
        sheet.table(heads, rows)?;
        let diverged = judged.iter().filter(|log| log.diverges()).count();
        let short = judged.iter().filter(|log| log.says_nothing()).count();
        let ending = MeasurementEnd::from_counts(judged.len(), runs);
        let status = match (diverged, short) {
            (0, 0) => TargetStatus::Met,
            (0, _) => TargetStatus::NotShown,
            _ => TargetStatus::Missed,
        };
        let outcome = ending.outcome(status);
        let most = 100.0 * upper_bound(diverged, judged.len().max(1));
        let [of, diverging] = [judged.len(), diverged].map(|count| grouped(count as u128));
        writeln!(sheet.text, "\n{diverging} of {of} diverge, at most {most:.3} %")?;
        let line = json!({
            "runs": judged.len(), "seed": seed, "diverged": diverged, "too_few_visits": short,
            "upper_bound": upper_bound(diverged, judged.len().max(1)),
        });
        let verdict = ending.verdict(
            outcome,
            [
                "holds: no log of a simulated run diverges",
                "violated: a log of a simulated run diverges",
                "not shown: a log shows too few visits",
            ],
        );
        sheet.finish(out, ("logs", line), outcome, verdict)
    }
}

fn in_words(verdict: Option<ConformVerdict>) -> &'static str {
    verdict.map_or("no visit", ConformVerdict::in_words)
}
