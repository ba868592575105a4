//! `evaluate control`: compares Algorithm 2, through every door of every junction, with the
//! specification. Section 4.

use std::io::Write;

use serde_json::json;
use toposlam_terminal::{CliError, Outcome, exit_codes::help_end, text::counted};

use super::{
    report::{MeasurementEnd, measure, number},
    robots::{PLANS, RandomPlans, RobotArguments},
};
use toposlam_simulator::{
    evaluation::traversals::{JudgedTraversal, TraversalSampler},
    sample_verdict::SampleTally,
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
        let judged = measure("traversals", "traversals", 0..self.traversals, |number, watch| {
            traversals.traversal(number, &equipment, watch)
        })?;
        let tally: SampleTally = judged.iter().map(|made| made.outcome.verdict()).collect();
        let ending = MeasurementEnd::from_counts(judged.len(), self.traversals);
        let outcome = ending.outcome_with(tally.failed() as u64);

        let (doors, plans) = (traversals.cases.len(), traversals.plans.len());
        writeln!(sheet.text, "Driving by {}, seed {}", self.robots.sensing(), self.robots.seed)?;
        let [doors_text, plans_text] = [number(doors), counted(plans, "floor plan")];
        writeln!(sheet.text, "  {doors_text} pairs of entry door and exit door in {plans_text}")?;
        for made in &judged {
            let Some(what) = made.outcome.reason() else { continue };
            sheet.failure(named(made), &what)?;
            let [junction, from] = junctions(made);
            let line = json!({
                "traversal": made.case.number, "plan": made.case.plan_name,
                "junction": junction, "from": from, "door": made.door.0,
                "gave_up": made.outcome.gave_up(), "what": what,
            });
            sheet.line("failure", &line)?;
        }
        sheet.share("wrong", tally.wrong, judged.len())?;
        sheet.share("gave up", tally.undecided, judged.len())?;
        if !judged.is_empty() {
            let mean = |sum: f64| sum / judged.len() as f64;
            let seconds = mean(judged.iter().map(|made| made.seconds).sum());
            let count = mean(judged.iter().map(|made| made.frames as f64).sum());
            let frames = self.robots.frames();
            writeln!(
                sheet.text,
                "  {count:.1} {frames} and {seconds:.1} s of simulated time per traversal"
            )?;
        }
        let holds = "holds in these traversals: every door leads where it should";
        let line = json!({
            "traversals": judged.len(), "doors": doors, "plans": plans, "seed": self.robots.seed,
        });
        let verdict = ending.verdict(outcome, [holds, "violated", ""]);
        sheet.finish(out, ("control", line), outcome, verdict)
    }
}

/// The names of the junction of a traversal, and of the one from which the robot came.
fn junctions(judged: &JudgedTraversal) -> [&str; 2] {
    let plan = &judged.case.config.plan;
    let graph = plan.graph();
    [judged.entry, graph.opposite(judged.entry)]
        .map(|dart| plan.junction(graph.vertex(dart)).name.as_str())
}

pub(super) fn named(judged: &JudgedTraversal) -> String {
    let [junction, from] = junctions(judged);
    format!(
        "traversal {} in {}, door {} of {junction}, entered from {from}",
        judged.case.number, judged.case.plan_name, judged.door.0,
    )
}
