//! `toposlam evaluate control`: Algorithm 2 through every door of every junction, held against the
//! specification. Section 4.

use std::{io::Write, time::Instant};

use serde_json::json;
use toposlam_robot::evaluation::traversals::{
    JudgedTraversal, TraversalOutcome as Made, TraversalSampler,
};

use super::robots::{RandomPlans, RobotArguments, failed, share, share_json};
use crate::cli::{
    Failure, Outcome,
    json::print_object,
    progress::Progress,
    text::{counted, grouped},
    use_threads,
};

/// Measure driving: does each door of each junction lead where the specification says?
///
/// Each traversal begins at a junction, near its turning point, in one of its entries, and takes one
/// of its doors. It is right if the robot reaches the junction and comes in by the door that the
/// embedded graph says, and perceives there what the specification says.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  toposlam evaluate control                                  thousands of traversals, in a second or two
  toposlam evaluate control --images --traversals 200        with rendered pictures
  toposlam evaluate control --plan worlds/shape-6.toml --noise 2 --json

Exit codes: 0 each traversal is right, 1 one is not, 2 bad usage or input, 3 not all were made.")]
pub(super) struct EvaluateControlArguments {
    /// How many traversals: all doors of all junctions, again and again
    #[arg(long, default_value_t = 20_000, value_name = "N")]
    traversals: u64,
    /// How many random plans, where no plan is given
    #[arg(long, default_value_t = 40, value_name = "N")]
    plans: u64,
    #[command(flatten)]
    robots: RobotArguments,
}

impl EvaluateControlArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        use_threads(self.robots.threads)?;
        let plans = self.robots.plans(RandomPlans::Any(self.plans), usize::MAX)?;
        let traversals = TraversalSampler::new(plans, self.robots.seed, self.robots.noise);
        let eyes = self.robots.eyes()?;
        let begun = Instant::now();
        let progress = Progress::new("traversals", "traversals")?;
        let judged = traversals.judged(0..self.traversals, eyes.as_ref(), &progress);
        progress.finish();
        if self.robots.json {
            self.tell_json(&judged, &traversals, out)?;
        } else {
            self.tell(&judged, &traversals, out)?;
        }
        eprintln!("{:.1} s", begun.elapsed().as_secs_f64());
        Ok(if judged.iter().any(|traversal| traversal.outcome != Made::Right) {
            Outcome::Violated
        } else if judged.is_empty() || (judged.len() as u64) < self.traversals {
            Outcome::Incomplete
        } else {
            Outcome::Holds
        })
    }

    fn tell(
        &self,
        judged: &[JudgedTraversal],
        traversals: &TraversalSampler,
        out: &mut dyn Write,
    ) -> Result<(), Failure> {
        let doors = grouped(traversals.cases() as u128);
        let plans = counted(traversals.plans(), "floor plan");
        writeln!(out, "Control by {}, seed {}", self.robots.sight(), self.robots.seed)?;
        writeln!(out, "  {doors} doors, counted from each entry, in {plans}")?;
        for traversal in judged.iter().filter(|traversal| traversal.outcome != Made::Right) {
            failed(out, named(traversal), &traversal.outcome)?;
        }
        let (wrong, gave_up) = tally(judged);
        writeln!(out, "  wrong    {}", share(wrong, judged.len()))?;
        writeln!(out, "  gave up  {}", share(gave_up, judged.len()))?;
        let mean = |sum: f64| sum / judged.len().max(1) as f64;
        let seconds = mean(judged.iter().map(|traversal| traversal.seconds).sum());
        let pictures = mean(judged.iter().map(|traversal| traversal.pictures as f64).sum());
        writeln!(out, "  {pictures:.1} pictures and {seconds:.1} s of simulated time each")?;
        let verdict = match (judged.is_empty(), wrong + gave_up) {
            (true, _) => "nothing was measured",
            (_, 0) => "holds: each door leads where the specification says",
            _ => "violated",
        };
        Ok(writeln!(out, "{verdict}")?)
    }

    fn tell_json(
        &self,
        judged: &[JudgedTraversal],
        traversals: &TraversalSampler,
        out: &mut dyn Write,
    ) -> Result<(), Failure> {
        for traversal in judged.iter().filter(|traversal| traversal.outcome != Made::Right) {
            let line = json!({
                "schema": 1, "kind": "failure", "traversal": traversal.traversal.number,
                "plan": traversal.traversal.plan_name, "what": traversal.outcome.to_string(),
            });
            print_object(out, &line)?;
        }
        let (wrong, gave_up) = tally(judged);
        print_object(out, &share_json("wrong", wrong, judged.len()))?;
        print_object(out, &share_json("gave up", gave_up, judged.len()))?;
        let line = json!({
            "schema": 1, "kind": "control", "traversals": judged.len(), "doors": traversals.cases(),
            "plans": traversals.plans(), "seed": self.robots.seed,
            "holds": !judged.is_empty() && wrong + gave_up == 0,
        });
        print_object(out, &line)
    }
}

/// How many were wrong, and how many given up.
fn tally(judged: &[JudgedTraversal]) -> (usize, usize) {
    let count = |is: fn(&Made) -> bool| judged.iter().filter(|made| is(&made.outcome)).count();
    (count(|made| matches!(made, Made::Wrong(_))), count(|made| matches!(made, Made::GaveUp(_))))
}

fn named(judged: &JudgedTraversal) -> String {
    let traversal = &judged.traversal;
    let plan = &traversal.config.plan;
    let graph = plan.graph();
    let junction = |dart| &plan.junction(graph.vertex(dart)).name;
    format!(
        "traversal {}, in {} by door {} of {}, having come from {}",
        traversal.number,
        traversal.plan_name,
        traversal.door.0,
        junction(traversal.entry),
        junction(graph.opposite(traversal.entry))
    )
}
