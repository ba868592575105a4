//! `evaluate runs`: compares whole runs of a simulated robot with the specification. Section 6.

use std::{io::Write, time::Instant};

use serde_json::json;
use toposlam_model::mapping::MappingMethod;
use toposlam_terminal::{
    CliError, Outcome,
    exit_codes::help_end,
    json::print_line,
    method_options::{MethodOptions, safeguards_in_words},
    progress::Progress,
    remark,
    text::{counted, grouped, print_hanging, print_rows, tenths},
    use_threads,
};

use super::robots::{RandomPlans, RobotArguments, print_failure, share, share_json};
use toposlam_simulator::{
    FAULTS, FaultKind, RobotEquipment,
    evaluation::run_sampler::{Faults, JudgedRun, RunSampler},
    run::{RunOutcome, WayToMarker},
};

/// Measure whole runs: is every building mapped correctly, in the specified number of moves?
///
/// A run is right if the map is isomorphic to the floor plan, the robot's pose in the map is true,
/// every move and every percept is as specified, and the number of moves is that of the algorithm in the
/// plan's embedded graph.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  evaluate runs                                 takes half a minute
  evaluate runs --images --plans 10 --starts 3  with rendered images,
                                                         takes 15 minutes
  evaluate runs --sensor laser --plans 40       by a laser scanner
  evaluate runs --faults --plans 100            one fault in each run
  evaluate runs --faults --recover
  evaluate runs --algorithm algorithm1          more moves

With --faults, a run may also be given up if the robot reports a contradiction. \
A wrong map is not a violation if the robot was carried to a place that it cannot \
distinguish from the right one. With --recover it is, because an audit detects it.",
    &[
        (0, "every run is right"),
        (1, "a run is wrong"),
        (2, "bad usage or input"),
        (3, "not all runs were made"),
    ],
))]
pub(super) struct EvaluateRunsArguments {
    /// Number of random plans with 5 to 25 junctions, if no plan is given; with --images, of any size
    #[arg(long, default_value_t = 200, value_name = "N", conflicts_with = "plan")]
    plans: u64,
    /// Number of starts in each plan
    #[arg(long, default_value_t = 3, value_name = "N")]
    starts: usize,
    /// Number of runs [default: one from each start]
    #[arg(long, value_name = "N")]
    runs: Option<u64>,
    #[command(flatten)]
    method: MethodOptions,
    /// Inject this number of faults into each run; 1 if there is no number
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "1")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..))]
    faults: Option<u32>,
    #[command(flatten)]
    robots: RobotArguments,
}

/// The most junctions of a plan with rendered images, in which a run would take minutes.
const MOST_WITH_IMAGES: usize = 12;

impl EvaluateRunsArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        use_threads(self.robots.threads)?;
        let equipment = self.robots.equipment()?;
        let (random, most) = match equipment {
            RobotEquipment::Images(_) => (RandomPlans::Any(self.plans), MOST_WITH_IMAGES),
            _ => (RandomPlans::Large(self.plans), usize::MAX),
        };
        let plans = self.robots.plans(random, most)?;
        let count = plans.len();
        let faults = self.faults.map_or(Faults::None, Faults::Each);
        let method = self.method.method()?;
        let RobotArguments { seed, noise, json, .. } = self.robots;
        let runs = RunSampler::new(plans, self.starts, faults, seed, noise, method);
        let wanted = self.runs.unwrap_or(runs.starts() as u64);
        let begun = Instant::now();
        let progress = Progress::new("runs", "runs")?;
        let judged = runs.judged(0..wanted, &equipment, &progress);
        progress.finish();
        let violations = judged.iter().filter(|run| self.violates(run)).count();
        let outcome = if violations > 0 {
            Outcome::Violated
        } else if judged.is_empty() || (judged.len() as u64) < wanted {
            Outcome::Incomplete
        } else {
            Outcome::Holds
        };
        if json {
            self.print_json(method, &judged, (violations, outcome), out)?;
        } else {
            let sensing = self.robots.sensing();
            writeln!(out, "Whole runs by {sensing}, seed {seed}")?;
            let starts = counted(runs.starts(), "start");
            let plans = counted(count, "floor plan");
            let by = method.algorithm().in_words();
            let by = format!("{by} {}", safeguards_in_words(method));
            writeln!(out, "  by {}", by.trim_end())?;
            writeln!(out, "  {starts} in {plans}")?;
            self.print(method, &judged, outcome, out)?;
        }
        remark!("{:.1} s", begun.elapsed().as_secs_f64());
        Ok(outcome)
    }

    /// Whether a run fails: without faults it must be right, with faults it must not be wrong without an error.
    fn violates(&self, run: &JudgedRun) -> bool {
        match self.faults {
            None => run.ending != RunOutcome::Right,
            Some(_) => run.is_violation(),
        }
    }

    fn print(
        &self,
        method: MappingMethod,
        judged: &[JudgedRun],
        outcome: Outcome,
        out: &mut dyn Write,
    ) -> Result<(), CliError> {
        for run in judged
            .iter()
            .filter(|run| self.faults.is_none() || matches!(run.ending, RunOutcome::Wrong(_)))
        {
            if run.ending != RunOutcome::Right {
                print_failure(out, named(run), &run.ending)?;
            }
        }
        if self.faults.is_some() {
            let heads = ["fault", " runs", "right", "given up", "wrong"];
            let rows: Vec<_> = FAULTS.iter().map(|&(kind, ..)| row(judged, kind)).collect();
            print_rows(out, heads, &rows)?;
        }
        let [right, gave_up, wrong] = tally(judged.iter());
        let all = judged.len();
        writeln!(out, "  right    {} of {}", grouped(right as u128), grouped(all as u128))?;
        writeln!(out, "  gave up  {}", share(gave_up, all))?;
        writeln!(out, "  wrong    {}", share(wrong, all))?;
        if method.audits() > 0 || method.recovers() {
            print_safeguards(method, judged, out)?;
        }
        let moves: u64 = judged.iter().map(|run| run.moves[0]).sum();
        if !judged.is_empty() {
            let count: u64 = judged.iter().map(|run| run.frames).sum();
            let hours = judged.iter().map(|run| run.seconds).sum::<f64>() / 3600.0;
            let (moves, count) = (counted(moves as usize, "move"), grouped(count.into()));
            let frames = self.robots.frames();
            let hours = tenths(hours);
            writeln!(out, "  {moves}, {count} {frames}, {hours} hours of simulated time")?;
        }
        if let Some(ratio) = CertificateTotal::of(judged).ratio()
            && self.faults.is_none()
        {
            writeln!(
                out,
                "  the right runs took {ratio:.2} times the moves of their certificates"
            )?;
        }
        let verdict = match (outcome, self.faults.is_some()) {
            (Outcome::Incomplete, _) if judged.is_empty() => "incomplete: nothing was measured",
            (Outcome::Incomplete, _) => "incomplete, interrupted",
            (Outcome::Holds, false) => {
                "holds in these runs: every map is right, and every move is as specified"
            }
            (Outcome::Holds, true) if method.recovers() => {
                "holds in these runs: every map is right, or the robot gave up"
            }
            (Outcome::Holds, true) => {
                "holds in these runs: every map is right, or the robot gave up or was carried"
            }
            (Outcome::Violated, _) => "violated",
        };
        Ok(writeln!(out, "{verdict}")?)
    }

    fn print_json(
        &self,
        method: MappingMethod,
        judged: &[JudgedRun],
        (violations, outcome): (usize, Outcome),
        out: &mut dyn Write,
    ) -> Result<(), CliError> {
        for run in judged {
            let faults = run.case.config.faults.iter();
            let faults: Vec<_> = faults
                .map(|fault| json!({ "fault": fault.kind.name(), "picture": fault.frame }))
                .collect();
            let line = json!({
                "run": run.case.number, "plan": run.case.plan_name, "faults": faults,
                "moves": run.moves[0], "explore_moves": run.moves[1],
                "certificate_moves": run.certificate_moves,
                "right": run.ending == RunOutcome::Right,
                "gave_up": matches!(run.ending, RunOutcome::GaveUp(_)),
                "cut_off": run.way_to_marker == WayToMarker::None,
                "narrow": run.way_to_marker == WayToMarker::Narrow,
                "ending": run.ending.to_string(), "simulated_seconds": run.seconds,
                "frames": run.frames,
                "recoveries": run.mapped.as_ref().map(|mapped| mapped.recoveries),
                "audit_moves": run.mapped.as_ref().map(|mapped| mapped.audit_moves),
                "blocked": run.mapped.as_ref().map(|mapped| mapped.blocked.len()),
            });
            print_line(out, "run", &line)?;
        }
        let [right, gave_up, wrong] = tally(judged.iter());
        for (what, seen) in [("right", right), ("gave up", gave_up), ("wrong", wrong)] {
            print_line(out, "rate", &share_json(what, seen, judged.len()))?;
        }
        let certificates = CertificateTotal::of(judged);
        let line = json!({
            "runs": judged.len(), "seed": self.robots.seed,
            "moves_total": certificates.moves, "certificate_total": certificates.certificate_moves,
            "ratio": certificates.ratio(),
            "algorithm": method.algorithm().name(),
            "audits": method.audits(), "recover": method.recovers(),
            "violations": violations, "verdict": outcome.verdict(), "holds": outcome == Outcome::Holds,
        });
        print_line(out, "runs", &line)
    }
}

/// The moves of the right runs that left no hallway out, audits apart, and those of their certificates.
#[derive(Clone, Copy, Default)]
struct CertificateTotal {
    moves: u64,
    certificate_moves: u64,
}

impl CertificateTotal {
    fn of(judged: &[JudgedRun]) -> Self {
        let whole =
            judged.iter().filter(|run| run.ending == RunOutcome::Right && run.blocked().is_empty());
        whole.fold(Self::default(), |sum, run| {
            let audits = run.mapped.as_ref().map_or(0, |mapped| mapped.audit_moves);
            Self {
                moves: sum.moves + run.moves[0].saturating_sub(audits),
                certificate_moves: sum.certificate_moves + run.certificate_moves,
            }
        })
    }

    /// `None` without such a run.
    fn ratio(self) -> Option<f64> {
        (self.certificate_moves > 0).then(|| self.moves as f64 / self.certificate_moves as f64)
    }
}

/// What audits and recoveries took in all runs.
fn print_safeguards(
    method: MappingMethod,
    judged: &[JudgedRun],
    out: &mut dyn Write,
) -> Result<(), CliError> {
    let right = || judged.iter().filter(|run| run.ending == RunOutcome::Right);
    let all = || right().filter_map(|run| run.mapped.as_ref());
    let audits: u64 = all().map(|mapped| mapped.audit_moves).sum();
    let [made, explored] = [0, 1].map(|at| right().map(|run| run.moves[at]).sum::<u64>());
    let extra = made.saturating_sub(audits).saturating_sub(explored);
    let number = |number: u64| grouped(number.into());
    let explored = number(explored);
    let text =
        format!("{explored} in the right runs without faults, {} more for audits", number(audits));
    if !method.recovers() {
        return Ok(print_hanging(out, "  moves    ", &text)?);
    }
    let blocked = all().filter(|mapped| !mapped.blocked.is_empty()).count();
    let recoveries: u32 = all().map(|mapped| mapped.recoveries).sum();
    let recoveries = if recoveries == 1 {
        "1 recovery".to_owned()
    } else {
        format!("{} recoveries", number(recoveries.into()))
    };
    let text = format!("{text}, {} more for {recoveries}", number(extra));
    print_hanging(out, "  moves    ", &text)?;
    let recovered = || {
        let is_one = |run: &&JudgedRun| run.mapped.as_ref().is_some_and(|map| map.recoveries > 0);
        right().filter(is_one)
    };
    let count = recovered().count();
    if count > 0 {
        let mean = |moves: &dyn Fn(&JudgedRun) -> u64| {
            recovered().map(moves).sum::<u64>() as f64 / count as f64
        };
        let audits = |run: &JudgedRun| run.mapped.as_ref().map_or(0, |mapped| mapped.audit_moves);
        let extra =
            mean(&|run| run.moves[0].saturating_sub(audits(run)).saturating_sub(run.moves[1]));
        let over = mean(&|run| run.moves[1]);
        let text = format!(
            "{extra:.1} more moves on average in the {} right runs that recovered; to start over, \
             {over:.1}",
            grouped(count as u128)
        );
        print_hanging(out, "  cost     ", &text)?;
    }
    let blocked = grouped(blocked as u128);
    writeln!(out, "  blocked  {blocked} of the right runs are right but for a hallway")?;
    let gave_up = judged.iter().filter(|run| matches!(run.ending, RunOutcome::GaveUp(_)));
    let ended = |way| gave_up.clone().filter(|run| run.way_to_marker == way).count();
    for (name, way, why) in [
        ("cut off", WayToMarker::None, "an obstacle leaves no way to the marker"),
        (
            "narrow",
            WayToMarker::Narrow,
            "each way to the marker is beside an obstacle, within 0.4 m of the middle of a hallway",
        ),
    ] {
        let text = format!("{} given up because {why}", counted(ended(way), "run"));
        print_hanging(out, &format!("  {name:<9}"), &text)?;
    }
    Ok(())
}

/// The number of runs that were right, given up, wrong.
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
    let runs = || judged.iter().filter(|run| run.has_fault(kind));
    let [right, gave_up, wrong] = tally(runs());
    let number = |count: usize, width: usize| format!("{:>width$}", grouped(count as u128));
    [
        kind.name().to_owned(),
        number(runs().count(), 5),
        number(right, 5),
        number(gave_up, 8),
        number(wrong, 5),
    ]
}

fn named(run: &JudgedRun) -> String {
    let faults = run.case.config.faults.iter();
    let faults = faults.map(|fault| format!("{}@{}", fault.kind.name(), fault.frame));
    let plan = run.case.plan_name.clone();
    let parts = std::iter::once(plan).chain(faults).collect::<Vec<_>>().join(", ");
    format!("run {}, {parts}", run.case.number)
}
