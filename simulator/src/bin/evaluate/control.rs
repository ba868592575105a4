//! `evaluate control`: compares Algorithm 2, through every door of every junction, with the
//! specification. Section 4.

use std::io::Write;

use serde_json::json;
use toposlam_terminal::{
    CliError, Outcome,
    exit_codes::help_end,
    progress::Progress,
    text::{counted, grouped},
};

use super::{
    evaluation_report::{MeasurementEnd, outcome},
    robots::{PLANS, RandomPlans, RobotArguments},
};
use toposlam_simulator::evaluation::report::TargetStatus;
use toposlam_simulator::evaluation::traversals::{
    JudgedTraversal, Traversal, TraversalOutcome as Made, TraversalSampler,
};

/// Measure driving: does every door of every junction lead where it should?
///
/// Each traversal starts near the turning point of a junction, at one of its entry doors, and leaves by
/// one of its doors. It is right if the robot enters the junction by the door that the embedded graph
/// specifies, and perceives what the specification predicts.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  evaluate control                             takes a few seconds
  evaluate control --images --traversals 200   with rendered images
  evaluate control --sensor laser --traversals 2000
  evaluate control --plan worlds/shape-6.toml --noise 2 --json",
    &[
        (0, "every traversal is right"),
        (1, "a traversal is wrong"),
        (2, "bad usage or input"),
        (3, "not all traversals were made"),
    ],
))]
pub(super) struct EvaluateControlArguments {
    /// Number of traversals; they go through all doors of all junctions repeatedly
    #[arg(long, default_value_t = 20_000, value_name = "N")]
    traversals: u64,
    /// Number of random plans, if no plan is given
    #[arg(long, default_value_t = PLANS, value_name = "N", conflicts_with = "plan")]
    plans: u64,
    #[command(flatten)]
    robots: RobotArguments,
}

impl EvaluateControlArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let mut sheet = self.robots.report.begin()?;
        let plans = self.robots.plans(RandomPlans::Any(self.plans), usize::MAX)?;
        let traversals = TraversalSampler::new(plans, self.robots.seed, self.robots.noise);
        let equipment = self.robots.equipment()?;
        let progress = Progress::new("traversals", "traversals")?;
        let judged = traversals.judged(0..self.traversals, &equipment, &progress);
        progress.finish();
        let ending = MeasurementEnd::of(judged.len(), self.traversals);
        let (wrong, gave_up) = tally(&judged);
        let status = if wrong + gave_up > 0 { TargetStatus::Missed } else { TargetStatus::Met };
        let outcome = outcome(status, ending);

        let doors = grouped(traversals.cases() as u128);
        let plans = counted(traversals.plans(), "floor plan");
        let text = sheet.text();
        writeln!(text, "Driving by {}, seed {}", self.robots.sensing(), self.robots.seed)?;
        writeln!(text, "  {doors} pairs of entry door and exit door in {plans}")?;
        for traversal in judged.iter().filter(|traversal| traversal.outcome != Made::Right) {
            sheet.failure(named(traversal), &traversal.outcome)?;
            let [junction, from] = junctions(traversal);
            let line = json!({
                "traversal": traversal.traversal.number,
                "plan": traversal.traversal.plan_name, "junction": junction, "from": from,
                "door": traversal.traversal.door.0,
                "gave_up": matches!(traversal.outcome, Made::GaveUp(_)),
                "what": traversal.outcome.to_string(),
            });
            sheet.line("failure", &line)?;
        }
        sheet.share("wrong", wrong, judged.len())?;
        sheet.share("gave up", gave_up, judged.len())?;
        if !judged.is_empty() {
            let mean = |sum: f64| sum / judged.len() as f64;
            let seconds = mean(judged.iter().map(|traversal| traversal.seconds).sum());
            let count = mean(judged.iter().map(|traversal| traversal.frames as f64).sum());
            let frames = self.robots.frames();
            writeln!(
                sheet.text(),
                "  {count:.1} {frames} and {seconds:.1} s of simulated time per traversal"
            )?;
        }
        let verdict = match (outcome, ending) {
            (Outcome::Holds, _) => "holds in these traversals: every door leads where it should",
            (Outcome::Violated, _) => "violated",
            (_, MeasurementEnd::Empty) => "incomplete: nothing was measured",
            _ => "incomplete, interrupted",
        };
        let line = json!({
            "traversals": judged.len(), "doors": traversals.cases(),
            "plans": traversals.plans(), "seed": self.robots.seed,
        });
        sheet.finish(out, ("control", &line), outcome, verdict)
    }
}

/// The number of traversals that were wrong, and that were given up.
fn tally(judged: &[JudgedTraversal]) -> (usize, usize) {
    let count = |is: fn(&Made) -> bool| judged.iter().filter(|made| is(&made.outcome)).count();
    (count(|made| matches!(made, Made::Wrong(_))), count(|made| matches!(made, Made::GaveUp(_))))
}

/// The names of the junction of a traversal, and of the one from which the robot came.
fn junctions(judged: &JudgedTraversal) -> [&str; 2] {
    let Traversal { entry, config, .. } = &judged.traversal;
    let graph = config.plan.graph();
    [*entry, graph.opposite(*entry)]
        .map(|dart| config.plan.junction(graph.vertex(dart)).name.as_str())
}

pub(super) fn named(judged: &JudgedTraversal) -> String {
    let traversal = &judged.traversal;
    let [junction, from] = junctions(judged);
    format!(
        "traversal {} in {}, door {} of {junction}, entered from {from}",
        traversal.number, traversal.plan_name, traversal.door.0,
    )
}
