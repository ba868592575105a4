//! `evaluate runs`: compares whole runs of a simulated robot with the specification. Section 6.

use std::io::Write;

use serde_json::{Value, json};
use toposlam_model::mapping::MappingMethod;
use toposlam_terminal::{
    CliError, Outcome,
    exit_codes::help_end,
    method_options::{MethodOptions, safeguards_in_words},
    progress::must_stop,
    remark,
    text::{counted, grouped, print_hanging, quoted, tenths},
};

use super::{
    failed_runs::{FailedOption, FailedSimulation, plan_world},
    report::{MeasurementEnd, measure, number},
    robots::{RandomPlans, RobotArguments},
};
use toposlam_simulator::{
    FAULTS, RobotEquipment,
    evaluation::run_sampler::{JudgedRun, RobotCase, RunSampler},
    run::{RunOutcome, WayToMarker},
    sample_verdict::{SampleTally, SampleVerdict},
};
use toposlam_vision::camera::calibration;

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
  evaluate runs --faults 2 --recover --failed failed
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
    failed: FailedOption,
    #[command(flatten)]
    robots: RobotArguments,
}

/// The most junctions of a plan with rendered images, in which a run would take minutes.
const MOST_WITH_IMAGES: usize = 12;

impl EvaluateRunsArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let mut sheet = self.robots.report.begin()?;
        let failed = self.failed.begin()?;
        let equipment = self.robots.equipment()?;
        let (random, most) = match equipment {
            RobotEquipment::Images(_) => (RandomPlans::Any(self.plans), MOST_WITH_IMAGES),
            _ => (RandomPlans::Large(self.plans), usize::MAX),
        };
        let plans = self.robots.plans(random, most)?;
        let count = counted(plans.len(), "floor plan");
        let method = self.method.method()?;
        let (has_faults, recovers) = (self.faults.is_some(), method.recovers());
        let RobotArguments { seed, noise, .. } = self.robots;
        let faults = self.faults.unwrap_or_default();
        let runs = RunSampler::new(plans, self.starts, faults, seed, noise, method);
        let starts = runs.starts.len();
        let wanted = self.runs.unwrap_or(starts as u64);
        let judged = measure("runs", "runs", 0..wanted, |number, watch| {
            runs.run(number, &equipment, watch)
        })?;
        // Without faults a run must be right, with faults it must not be wrong without an error.
        let violates = |run: &&JudgedRun| {
            if has_faults { run.is_violation() } else { run.ending != RunOutcome::Right }
        };
        let violations = judged.iter().filter(violates).count();
        let ending = MeasurementEnd::from_counts(judged.len(), wanted);
        let outcome = ending.outcome_with(violations as u64);

        writeln!(sheet.text, "Whole runs by {}, seed {seed}", self.robots.sensing())?;
        let by = format!("{} {}", method.algorithm().in_words(), safeguards_in_words(method));
        writeln!(sheet.text, "  by {}", by.trim_end())?;
        writeln!(sheet.text, "  {} in {count}", counted(starts, "start"))?;
        for run in &judged {
            sheet.line("run", &run_line(run))?;
            let verdict = run.ending.verdict();
            if verdict == SampleVerdict::Wrong || !has_faults && verdict == SampleVerdict::Undecided
            {
                sheet.failure(named(run), &run.ending)?;
            }
        }
        if has_faults {
            let rows = FAULTS.iter().map(|&(kind, name, ..)| {
                let tally = tally(judged.iter().filter(|run| run.has_fault(kind)));
                let [all, right, gave_up, wrong] =
                    [tally.all(), tally.right, tally.undecided, tally.wrong].map(number);
                [name.to_owned(), all, right, gave_up, wrong]
            });
            sheet.table(["fault", ">runs", ">right", ">given up", ">wrong"], rows)?;
        }
        let tally = tally(&judged);
        let all = judged.len();
        writeln!(sheet.text, "  right    {} of {}", number(tally.right), number(all))?;
        sheet.share_line("right", [tally.right, all])?;
        sheet.share("gave up", tally.undecided, all)?;
        sheet.share("wrong", tally.wrong, all)?;
        if method.audits() > 0 || recovers {
            print_safeguards(method, &judged, &mut sheet.text)?;
        }
        // The right runs that left no hallway out: their moves without audits, and those of their certificates.
        let whole = right(&judged).filter(|run| run.blocked().is_empty());
        let [moves, certificates] = whole.fold([0, 0], |[moves, certificates], run| {
            [moves + without_audits(run), certificates + run.certificate_moves]
        });
        let ratio = (certificates > 0).then(|| moves as f64 / certificates as f64);
        self.print_moves(&judged, ratio.filter(|_| !has_faults), &mut sheet.text)?;
        if let Some(mut failed) = failed {
            for run in judged.iter().filter(|run| run.ending != RunOutcome::Right) {
                let log = |head| {
                    let log = runs.log(&run.case, &equipment, &head);
                    log.map_err(|error| CliError::at("--failed", error))
                };
                failed.add(&self.failed_run(run, &runs, &equipment), log)?;
                if must_stop() {
                    break;
                }
            }
            remark!("{}", failed.finish()?);
        }
        let line = json!({
            "runs": all, "seed": seed,
            "moves_total": moves, "certificate_total": certificates, "ratio": ratio,
            "algorithm": method.algorithm().name(), "audits": method.audits(), "recover": recovers,
            "violations": violations,
        });
        let holds = match (has_faults, recovers) {
            (false, _) => "every map is right, and every move is as specified",
            (true, true) => "every map is right, or the robot gave up",
            (true, false) => "every map is right, or the robot gave up or was carried",
        };
        let holds = format!("holds in these runs: {holds}");
        let verdict = ending.verdict(outcome, [&holds, "violated", ""]);
        sheet.finish(out, ("runs", line), outcome, verdict)
    }

    /// A run that failed, as it is written.
    fn failed_run(
        &self,
        run: &JudgedRun,
        runs: &RunSampler,
        equipment: &RobotEquipment,
    ) -> FailedSimulation {
        let JudgedRun { case, ending, .. } = run;
        let RobotCase { number, plan_name, config } = case;
        let seed = self.robots.seed;
        let about = format!("The floor plan of run {number} of seed {seed}");
        let world = plan_world(plan_name, &about, &config.plan, Some(config.marker));
        let look = equipment.sensors().map(|sensors| (sensors, sensors.look(*number)));
        let vision = look.map(|(sensors, look)| {
            [calibration::to_toml(sensors.camera()), sensors.colours(look).to_toml()]
        });
        let settings = runs.settings(case);
        let mut options = self.method.arguments();
        options.push(format!("--max-darts {}", settings.dart_bound));
        options.push(format!("--seed {}", config.seed));
        if config.noise.to_bits() != 1_f64.to_bits() {
            options.push(format!("--noise {}", config.noise));
        }
        options.extend(config.faults.iter().map(|fault| format!("--fault {fault}")));
        options.extend(self.robots.sensing_options(look.map(|(_, look)| look)));
        FailedSimulation {
            seed,
            number: *number,
            verdict: if ending.gave_up() { "gave up" } else { "wrong" },
            reason: ending.reason().unwrap_or_default(),
            world,
            start: config.marker,
            robot_seed: config.seed,
            vision,
            command: Box::new(move |world| {
                format!("toposlam simulate {} {}", quoted(world), options.join(" "))
            }),
            settings: settings.to_string(),
        }
    }

    /// Prints what all runs took.
    fn print_moves(
        &self,
        judged: &[JudgedRun],
        ratio: Option<f64>,
        out: &mut dyn Write,
    ) -> Result<(), CliError> {
        if judged.is_empty() {
            return Ok(());
        }
        let moves: u64 = judged.iter().map(|run| run.moves[0]).sum();
        let count: u64 = judged.iter().map(|run| run.frames).sum();
        let hours = tenths(judged.iter().map(|run| run.seconds).sum::<f64>() / 3600.0);
        let (moves, count) = (counted(moves as usize, "move"), grouped(count.into()));
        let frames = self.robots.frames();
        writeln!(out, "  {moves}, {count} {frames}, {hours} hours of simulated time")?;
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
        "gave_up": run.ending.gave_up(),
        "cut_off": run.way_to_marker == WayToMarker::None,
        "narrow": run.way_to_marker == WayToMarker::Narrow,
        "ending": run.ending.to_string(), "simulated_seconds": run.seconds,
        "frames": run.frames,
        "recoveries": mapped.map(|mapped| mapped.recoveries),
        "audit_moves": mapped.map(|mapped| mapped.audit_moves),
        "blocked": mapped.map(|mapped| mapped.blocked.len()),
    })
}

fn tally<'r>(runs: impl IntoIterator<Item = &'r JudgedRun>) -> SampleTally {
    runs.into_iter().map(|run| run.ending.verdict()).collect()
}

fn right(judged: &[JudgedRun]) -> impl Iterator<Item = &JudgedRun> + Clone {
    judged.iter().filter(|run| run.ending == RunOutcome::Right)
}

fn without_audits(run: &JudgedRun) -> u64 {
    run.moves[0].saturating_sub(run.audit_moves())
}

/// What audits and recoveries took in all runs.
fn print_safeguards(
    method: MappingMethod,
    judged: &[JudgedRun],
    out: &mut dyn Write,
) -> Result<(), CliError> {
    let right = || right(judged);
    let number = |number: u64| grouped(number.into());
    let audits: u64 = right().map(JudgedRun::audit_moves).sum();
    let [made, explored] = [0, 1].map(|at| right().map(|run| run.moves[at]).sum::<u64>());
    let extra = made.saturating_sub(audits).saturating_sub(explored);
    let (explored, audits) = (number(explored), number(audits));
    let text = format!("{explored} in the right runs without faults, {audits} more for audits");
    if !method.recovers() {
        return Ok(print_hanging(out, "  moves    ", &text)?);
    }
    let recoveries = |run: &JudgedRun| run.mapped.as_ref().map_or(0, |mapped| mapped.recoveries);
    let all = match right().map(recoveries).sum() {
        1 => "1 recovery".to_owned(),
        all => format!("{} recoveries", number(u32::into(all))),
    };
    let text = format!("{text}, {} more for {all}", number(extra));
    print_hanging(out, "  moves    ", &text)?;
    let recovered = || right().filter(|run| recoveries(run) > 0);
    let count = recovered().count();
    if count > 0 {
        let mean = |moves: fn(&JudgedRun) -> u64| {
            recovered().map(moves).sum::<u64>() as f64 / count as f64
        };
        let extra = mean(|run| without_audits(run).saturating_sub(run.moves[1]));
        let over = mean(|run| run.moves[1]);
        let text = format!(
            "{extra:.1} more moves on average in the {} right runs that recovered; to start over, \
             {over:.1}",
            number(count as u64)
        );
        print_hanging(out, "  cost     ", &text)?;
    }
    let blocked = number(right().filter(|run| !run.blocked().is_empty()).count() as u64);
    writeln!(out, "  blocked  {blocked} of the right runs are right but for a hallway")?;
    let gave_up = judged.iter().filter(|run| run.ending.gave_up());
    for (name, way, why) in [
        ("cut off", WayToMarker::None, "an obstacle leaves no way to the marker"),
        (
            "narrow",
            WayToMarker::Narrow,
            "each way to the marker is beside an obstacle, within 0.4 m of the middle of a hallway",
        ),
    ] {
        let count = gave_up.clone().filter(|run| run.way_to_marker == way).count();
        let text = format!("{} given up because {why}", counted(count, "run"));
        print_hanging(out, &format!("  {name:<9}"), &text)?;
    }
    Ok(())
}

fn named(run: &JudgedRun) -> String {
    let faults = run.case.config.faults.iter();
    let faults = faults.map(|fault| format!("{}@{}", fault.kind.name(), fault.frame));
    let plan = run.case.plan_name.clone();
    let parts = std::iter::once(plan).chain(faults).collect::<Vec<_>>().join(", ");
    format!("run {}, {parts}", run.case.number)
}
