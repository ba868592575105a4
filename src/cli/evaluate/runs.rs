//! `toposlam evaluate runs`: whole buildings mapped by a simulated robot, held against the
//! specification. Section 6.

use std::{io::Write, time::Instant};

use serde_json::json;
use toposlam_robot::{
    evaluation::run_sampler::{Faults, JudgedRun, RunSampler},
    run::RunOutcome,
    simulator::{FAULTS, FaultKind},
};

use super::robots::{RandomPlans, RobotArguments, failed, share, share_json};
use crate::cli::{
    Failure, Outcome,
    json::print_object,
    progress::Progress,
    text::print_rows,
    text::{counted, grouped},
    use_threads,
};

/// Measure whole runs: is each building mapped right, with the moves that the specification makes?
///
/// A run is right if the map is isomorphic to the floor plan, the robot is where it believes to be,
/// each move led where the specification says and each percept was right, and there were exactly as
/// many moves as `toposlam explore` makes in the plan's embedded graph.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  toposlam evaluate runs                                     hundreds of runs, in half a minute
  toposlam evaluate runs --images --plans 10 --starts 3      with rendered pictures, in a quarter of an hour
  toposlam evaluate runs --faults --plans 100                in each run something goes wrong

With --faults a run may also be given up, if the robot says what was contradictory. It is no violation
if a robot that was carried, unseen, to a place that looks and goes on alike has a wrong map.

Exit codes: 0 each run is right, 1 one is not, 2 bad usage or input, 3 not all were made.")]
pub(super) struct EvaluateRunsArguments {
    /// How many random plans, with 5 to 25 junctions, where no plan is given; with --images any
    #[arg(long, default_value_t = 200, value_name = "N")]
    plans: u64,
    /// From how many starts each plan is mapped
    #[arg(long, default_value_t = 3, value_name = "N")]
    starts: usize,
    /// How many runs [default: one from each start]
    #[arg(long, value_name = "N")]
    runs: Option<u64>,
    /// In each run one thing goes wrong
    #[arg(long)]
    faults: bool,
    #[command(flatten)]
    robots: RobotArguments,
}

/// With pictures, plans have no more junctions: else a run takes minutes.
const MOST_WITH_IMAGES: usize = 12;

impl EvaluateRunsArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        use_threads(self.robots.threads)?;
        let eyes = self.robots.eyes()?;
        let (random, most) = match eyes {
            None => (RandomPlans::Large(self.plans), usize::MAX),
            Some(_) => (RandomPlans::Any(self.plans), MOST_WITH_IMAGES),
        };
        let plans = self.robots.plans(random, most)?;
        let count = plans.len();
        let faults = if self.faults { Faults::Each } else { Faults::None };
        let RobotArguments { seed, noise, json, .. } = self.robots;
        let runs = RunSampler::new(plans, self.starts, faults, seed, noise);
        let wanted = self.runs.unwrap_or(runs.starts() as u64);
        let begun = Instant::now();
        let progress = Progress::new("runs", "runs")?;
        let judged = runs.judged(0..wanted, eyes.as_ref(), &progress);
        progress.finish();
        let violations = judged.iter().filter(|run| self.violates(run)).count();
        if json {
            self.tell_json(&judged, violations, out)?;
        } else {
            let sight = self.robots.sight();
            writeln!(out, "Whole runs by {sight}, seed {seed}")?;
            let plans = counted(count, "floor plan");
            writeln!(out, "  {} starts in {plans}", grouped(runs.starts() as u128))?;
            self.tell(&judged, violations, out)?;
        }
        eprintln!("{:.1} s", begun.elapsed().as_secs_f64());
        Ok(if violations > 0 {
            Outcome::Violated
        } else if judged.is_empty() || (judged.len() as u64) < wanted {
            Outcome::Incomplete
        } else {
            Outcome::Holds
        })
    }

    /// Whether a run is not as it must be: without faults right, else not wrong without knowing it.
    fn violates(&self, run: &JudgedRun) -> bool {
        if self.faults { run.is_violation() } else { run.ending != RunOutcome::Right }
    }

    fn tell(
        &self,
        judged: &[JudgedRun],
        violations: usize,
        out: &mut dyn Write,
    ) -> Result<(), Failure> {
        for run in
            judged.iter().filter(|run| !self.faults || matches!(run.ending, RunOutcome::Wrong(_)))
        {
            if run.ending != RunOutcome::Right {
                failed(out, named(run), &run.ending)?;
            }
        }
        if self.faults {
            let heads = ["fault", " runs", "right", "given up", "wrong"];
            let rows: Vec<_> = FAULTS.iter().map(|&(kind, ..)| row(judged, kind)).collect();
            print_rows(out, heads, &rows)?;
        }
        let [right, gave_up, wrong] = tally(judged.iter());
        let all = judged.len();
        writeln!(out, "  right    {} of {}", grouped(right as u128), grouped(all as u128))?;
        writeln!(out, "  gave up  {}", share(gave_up, all))?;
        writeln!(out, "  wrong    {}", share(wrong, all))?;
        let moves: u64 = judged.iter().map(|run| run.moves[0]).sum();
        let pictures: u64 = judged.iter().map(|run| run.pictures).sum();
        let hours = judged.iter().map(|run| run.seconds).sum::<f64>() / 3600.0;
        let (moves, pictures) = (grouped(moves.into()), grouped(pictures.into()));
        writeln!(out, "  {moves} moves, {pictures} pictures, {hours:.1} hours of simulated time")?;
        let verdict = match (judged.is_empty(), violations, self.faults) {
            (true, ..) => "nothing was measured",
            (_, 0, false) => "holds: each map is right, and each move as specified",
            (_, 0, true) => "holds: each map is right, or the robot gave up, or it was carried",
            _ => "violated",
        };
        Ok(writeln!(out, "{verdict}")?)
    }

    fn tell_json(
        &self,
        judged: &[JudgedRun],
        violations: usize,
        out: &mut dyn Write,
    ) -> Result<(), Failure> {
        for run in judged {
            let fault = run.case.config.faults.first();
            let line = json!({
                "schema": 1, "kind": "run", "run": run.case.number, "plan": run.case.plan_name,
                "fault": fault.map(|fault| fault.kind.name()),
                "fault_picture": fault.map(|fault| fault.picture),
                "moves": run.moves[0], "explore_moves": run.moves[1],
                "right": run.ending == RunOutcome::Right,
                "gave_up": matches!(run.ending, RunOutcome::GaveUp(_)),
                "ending": run.ending.to_string(), "simulated_seconds": run.seconds,
                "frames": run.pictures,
            });
            print_object(out, &line)?;
        }
        let [right, gave_up, wrong] = tally(judged.iter());
        for (what, seen) in [("right", right), ("gave up", gave_up), ("wrong", wrong)] {
            print_object(out, &share_json(what, seen, judged.len()))?;
        }
        let line = json!({
            "schema": 1, "kind": "runs", "runs": judged.len(), "seed": self.robots.seed,
            "violations": violations, "holds": !judged.is_empty() && violations == 0,
        });
        print_object(out, &line)
    }
}

/// How many were right, given up, wrong.
fn tally<'r>(runs: impl Iterator<Item = &'r JudgedRun>) -> [usize; 3] {
    runs.fold([0; 3], |mut tally, run| {
        let ending = match run.ending {
            RunOutcome::Right => 0,
            RunOutcome::GaveUp(_) => 1,
            RunOutcome::Wrong(_) => 2,
        };
        tally[ending] += 1;
        tally
    })
}

fn row(judged: &[JudgedRun], kind: FaultKind) -> [String; 5] {
    let runs = || judged.iter().filter(|run| run.fault() == Some(kind));
    let [right, gave_up, wrong] = tally(runs());
    [
        kind.name().to_owned(),
        format!("{:>5}", runs().count()),
        format!("{right:>5}"),
        format!("{gave_up:>8}"),
        format!("{wrong:>5}"),
    ]
}

fn named(run: &JudgedRun) -> String {
    let fault = run.case.config.faults.first();
    let fault = fault
        .map_or_else(String::new, |fault| format!(", {}@{}", fault.kind.name(), fault.picture));
    format!("run {}, {}{fault}", run.case.number, run.case.plan_name)
}
