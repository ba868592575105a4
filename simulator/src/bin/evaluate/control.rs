//! `evaluate control`: compares Algorithm 2, through every door of every junction, with the
//! specification. Section 4.

use std::{io::Write, time::Instant};

use serde_json::json;
use toposlam_terminal::{
    CliError, Outcome,
    exit_codes::help_end,
    json::print_line,
    progress::Progress,
    remark,
    text::{counted, grouped},
    use_threads,
};

use super::robots::{PLANS, RandomPlans, RobotArguments, print_failure, share, share_json};
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
        use_threads(self.robots.threads)?;
        let plans = self.robots.plans(RandomPlans::Any(self.plans), usize::MAX)?;
        let traversals = TraversalSampler::new(plans, self.robots.seed, self.robots.noise);
        let equipment = self.robots.equipment()?;
        let begun = Instant::now();
        let progress = Progress::new("traversals", "traversals")?;
        let judged = traversals.judged(0..self.traversals, &equipment, &progress);
        progress.finish();
        let outcome = if judged.iter().any(|traversal| traversal.outcome != Made::Right) {
            Outcome::Violated
        } else if judged.is_empty() || (judged.len() as u64) < self.traversals {
            Outcome::Incomplete
        } else {
            Outcome::Holds
        };
        if self.robots.json {
            self.print_json(&judged, &traversals, outcome, out)?;
        } else {
            self.print(&judged, &traversals, outcome, out)?;
        }
        remark!("{:.1} s", begun.elapsed().as_secs_f64());
        Ok(outcome)
    }

    fn print(
        &self,
        judged: &[JudgedTraversal],
        traversals: &TraversalSampler,
        outcome: Outcome,
        out: &mut dyn Write,
    ) -> Result<(), CliError> {
        let doors = grouped(traversals.cases() as u128);
        let plans = counted(traversals.plans(), "floor plan");
        writeln!(out, "Driving by {}, seed {}", self.robots.sensing(), self.robots.seed)?;
        writeln!(out, "  {doors} pairs of entry door and exit door in {plans}")?;
        for traversal in judged.iter().filter(|traversal| traversal.outcome != Made::Right) {
            print_failure(out, named(traversal), &traversal.outcome)?;
        }
        let (wrong, gave_up) = tally(judged);
        writeln!(out, "  wrong    {}", share(wrong, judged.len()))?;
        writeln!(out, "  gave up  {}", share(gave_up, judged.len()))?;
        if !judged.is_empty() {
            let mean = |sum: f64| sum / judged.len() as f64;
            let seconds = mean(judged.iter().map(|traversal| traversal.seconds).sum());
            let count = mean(judged.iter().map(|traversal| traversal.frames as f64).sum());
            let frames = self.robots.frames();
            writeln!(
                out,
                "  {count:.1} {frames} and {seconds:.1} s of simulated time per traversal"
            )?;
        }
        let verdict = match outcome {
            Outcome::Incomplete if judged.is_empty() => "incomplete: nothing was measured",
            Outcome::Incomplete => "incomplete, interrupted",
            Outcome::Holds => "holds in these traversals: every door leads where it should",
            Outcome::Violated => "violated",
        };
        Ok(writeln!(out, "{verdict}")?)
    }

    fn print_json(
        &self,
        judged: &[JudgedTraversal],
        traversals: &TraversalSampler,
        outcome: Outcome,
        out: &mut dyn Write,
    ) -> Result<(), CliError> {
        for traversal in judged.iter().filter(|traversal| traversal.outcome != Made::Right) {
            let [junction, from] = junctions(traversal);
            let line = json!({
                "traversal": traversal.traversal.number,
                "plan": traversal.traversal.plan_name, "junction": junction, "from": from,
                "door": traversal.traversal.door.0,
                "gave_up": matches!(traversal.outcome, Made::GaveUp(_)),
                "what": traversal.outcome.to_string(),
            });
            print_line(out, "failure", &line)?;
        }
        let (wrong, gave_up) = tally(judged);
        print_line(out, "rate", &share_json("wrong", wrong, judged.len()))?;
        print_line(out, "rate", &share_json("gave up", gave_up, judged.len()))?;
        let line = json!({
            "traversals": judged.len(), "doors": traversals.cases(),
            "plans": traversals.plans(), "seed": self.robots.seed,
            "verdict": outcome.verdict(), "holds": outcome == Outcome::Holds,
        });
        print_line(out, "control", &line)
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
