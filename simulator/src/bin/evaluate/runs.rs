//! `evaluate runs`: compares whole runs of a simulated robot with the specification. Section 6.

use std::io::Write;

use serde_json::{Value, json};
use toposlam_model::mapping::MappingMethod;
use toposlam_terminal::{
    CliError, Outcome,
    exit_codes::help_end,
    method_options::{MethodOptions, safeguards_in_words},
    progress::Progress,
    text::{counted, grouped, print_hanging, print_rows, tenths},
};

use super::{
    evaluation_report::{MeasurementEnd, outcome},
    robots::{RandomPlans, RobotArguments},
};
use toposlam_simulator::{
    FAULTS, FaultKind, RobotEquipment,
    evaluation::{
        report::TargetStatus,
        run_sampler::{Faults, JudgedRun, RunSampler},
    },
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
        let mut sheet = self.robots.report.begin()?;
        let equipment = self.robots.equipment()?;
        let (random, most) = match equipment {
            RobotEquipment::Images(_) => (RandomPlans::Any(self.plans), MOST_WITH_IMAGES),
            _ => (RandomPlans::Large(self.plans), usize::MAX),
        };
        let plans = self.robots.plans(random, most)?;
        let count = counted(plans.len(), "floor plan");
        let faults = self.faults.map_or(Faults::None, Faults::Each);
        let method = self.method.method()?;
        let RobotArguments { seed, noise, .. } = self.robots;
        let runs = RunSampler::new(plans, self.starts, faults, seed, noise, method);
        let wanted = self.runs.unwrap_or(runs.starts() as u64);
        let progress = Progress::new("runs", "runs")?;
        let judged = runs.judged(0..wanted, &equipment, &progress);
        progress.finish();
        let ending = MeasurementEnd::of(judged.len(), wanted);
        let violations = judged.iter().filter(|run| self.violates(run)).count();
        let status = if violations > 0 { TargetStatus::Missed } else { TargetStatus::Met };
        let outcome = outcome(status, ending);

        let text = sheet.text();
        writeln!(text, "Whole runs by {}, seed {seed}", self.robots.sensing())?;
        let by = format!("{} {}", method.algorithm().in_words(), safeguards_in_words(method));
        writeln!(text, "  by {}", by.trim_end())?;
        writeln!(text, "  {} in {count}", counted(runs.starts(), "start"))?;
        for run in &judged {
            sheet.line("run", &run_line(run))?;
            let is_wrong = matches!(run.ending, RunOutcome::Wrong(_));
            if is_wrong || self.faults.is_none() && run.ending != RunOutcome::Right {
                sheet.failure(named(run), &run.ending)?;
            }
        }
        if self.faults.is_some() {
            let heads = ["fault", " runs", "right", "given up", "wrong"];
            let rows: Vec<_> = FAULTS.iter().map(|&(kind, ..)| row(&judged, kind)).collect();
            print_rows(sheet.text(), heads, &rows)?;
        }
        let [right, gave_up, wrong] = tally(judged.iter());
        let [seen, all] = [right, judged.len()].map(|count| grouped(count as u128));
        writeln!(sheet.text(), "  right    {seen} of {all}")?;
        sheet.share_line("right", [right, judged.len()])?;
        sheet.share("gave up", gave_up, judged.len())?;
        sheet.share("wrong", wrong, judged.len())?;
        if method.audits() > 0 || method.recovers() {
            print_safeguards(method, &judged, sheet.text())?;
        }
        self.print_moves(&judged, sheet.text())?;
        let certificates = CertificateTotal::of(&judged);
        let line = json!({
            "runs": judged.len(), "seed": seed,
            "moves_total": certificates.moves, "certificate_total": certificates.certificate_moves,
            "ratio": certificates.ratio(),
            "algorithm": method.algorithm().name(),
            "audits": method.audits(), "recover": method.recovers(),
            "violations": violations,
        });
        let verdict = match (outcome, ending, self.faults.is_some()) {
            (Outcome::Holds, _, false) => {
                "holds in these runs: every map is right, and every move is as specified"
            }
            (Outcome::Holds, _, true) if method.recovers() => {
                "holds in these runs: every map is right, or the robot gave up"
            }
            (Outcome::Holds, ..) => {
                "holds in these runs: every map is right, or the robot gave up or was carried"
            }
            (Outcome::Violated, ..) => "violated",
            (_, MeasurementEnd::Empty, _) => "incomplete: nothing was measured",
            _ => "incomplete, interrupted",
        };
        sheet.finish(out, ("runs", &line), outcome, verdict)
    }

    /// Whether a run fails: without faults it must be right, with faults it must not be wrong without an error.
    fn violates(&self, run: &JudgedRun) -> bool {
        match self.faults {
            None => run.ending != RunOutcome::Right,
            Some(_) => run.is_violation(),
        }
    }

    /// Prints what all runs took.
    fn print_moves(&self, judged: &[JudgedRun], out: &mut dyn Write) -> Result<(), CliError> {
        if judged.is_empty() {
            return Ok(());
        }
        let moves: u64 = judged.iter().map(|run| run.moves[0]).sum();
        let count: u64 = judged.iter().map(|run| run.frames).sum();
        let hours = tenths(judged.iter().map(|run| run.seconds).sum::<f64>() / 3600.0);
        let (moves, count) = (counted(moves as usize, "move"), grouped(count.into()));
        let frames = self.robots.frames();
        writeln!(out, "  {moves}, {count} {frames}, {hours} hours of simulated time")?;
        let ratio = CertificateTotal::of(judged).ratio().filter(|_| self.faults.is_none());
        if let Some(ratio) = ratio {
            let times = "times the moves of their certificates";
            writeln!(out, "  the right runs took {ratio:.2} {times}")?;
        }
        Ok(())
    }
}

fn run_line(run: &JudgedRun) -> Value {
    let faults = run.case.config.faults.iter();
    let faults: Vec<_> =
        faults.map(|fault| json!({ "fault": fault.kind.name(), "picture": fault.frame })).collect();
    let mapped = run.mapped.as_ref();
    json!({
        "run": run.case.number, "plan": run.case.plan_name, "faults": faults,
        "moves": run.moves[0], "explore_moves": run.moves[1],
        "certificate_moves": run.certificate_moves,
        "right": run.ending == RunOutcome::Right,
        "gave_up": matches!(run.ending, RunOutcome::GaveUp(_)),
        "cut_off": run.way_to_marker == WayToMarker::None,
        "narrow": run.way_to_marker == WayToMarker::Narrow,
        "ending": run.ending.to_string(), "simulated_seconds": run.seconds,
        "frames": run.frames,
        "recoveries": mapped.map(|mapped| mapped.recoveries),
        "audit_moves": mapped.map(|mapped| mapped.audit_moves),
        "blocked": mapped.map(|mapped| mapped.blocked.len()),
    })
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
