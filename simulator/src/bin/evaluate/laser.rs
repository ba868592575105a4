//! `evaluate laser`: compares junctions that are sensed with a laser scanner with the truth.

use std::{io::Write, ops::Range};

use clap::ValueEnum;
use serde_json::{Map, json};
use toposlam_logs::record::StoppedBy;
use toposlam_model::format::named_world::NamedWorld;
use toposlam_terminal::{
    CliError, Outcome,
    exit_codes::help_end,
    method_options::{SafeguardOptions, safeguards_in_words},
    progress::StopSignal,
    remark,
    text::{counted, print_indented, quoted},
};
use toposlam_vision::laser::params::LaserParams;

use super::{
    control,
    failed_runs::{FailedOption, FailedSimulation},
    report::{EvaluationReport, MeasurementEnd, ReportArguments, measure},
    robots::{PLANS, RandomPlans, usual_plans},
};
use toposlam_simulator::{
    RobotEquipment, ScannerParams,
    evaluation::{
        laser::{
            corridor_world::{BuildingKind, CorridorWorld},
            judged_walk::{JudgedLaserVisit, JudgedWalk, LaserVerdict, WalkSampler},
            laser_report,
            scanned_run::ScannedRun,
        },
        traversals::{JudgedTraversal, TraversalSampler},
    },
    options::robot_sensor::{ScannerOption, read_scanner},
    run::RobotOutcome,
};

/// Measure sensing with a laser scanner on random walks in random buildings
///
/// Buildings have corridors at any angle, 1.65 to 2.4 m wide and longer than 11 m, junctions with 3 to 5
/// doors, bends, dead ends, alcoves, round lobbies, and what the scanner's parameters add: glass, black walls,
/// open doors of furnished rooms, furniture, people. Some parameters of sensing were chosen on the buildings of
/// the seeds 1 and 7: another seed gives buildings that were not used.
///
/// A view is one scan and those before it. A visit is derived from several views, as `conform --events laser`
/// derives it. It is right if it has the right degree and the right door. A walk is right if all of its visits
/// are, and no other was derived.
///
/// In a whole run the folding explorer maps the building by what the robot derives, right or wrong. Where the robot
/// may be at a junction it turns around, and drives into each arm of which it does not see enough: one that it cannot
/// follow for 10 m is none. A pilot keeps it on the floor, and a detector of its own reports the marker. A run is right if
/// the map and the pose are, and wrong if the robot does not notice that they are not; otherwise it gave up, also if
/// the map is right but for blocked doors. With --recover it goes on after a contradiction.
///
/// Without --scanner, the usual scanner covers 360 and 180 degrees in turn.
///
/// Control is measured in floor plans with right angles: the robot drives by its scans from junction to
/// junction, in the traversals of `evaluate control --sensor laser` with the same seed. `evaluate runs --sensor
/// laser` measures whole runs of that robot.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  evaluate laser                          takes two minutes
  evaluate laser --walks 400 --runs 0 --traversals 0 --json
  evaluate laser --drift 5                odometry that drifts
  evaluate laser --buildings long         other buildings
  evaluate laser --walks 0 --runs 20 --recover
  evaluate laser --scanner lds-01         another scanner
  evaluate laser --walks 0 --recover --failed failed
  evaluate laser --walk 17                each visit of one walk
  evaluate laser --run 17 --recover       one whole run

A target is met if the 95 % interval of the rate is within it, missed if the \
interval is beyond it, and otherwise not shown: the sample is too small.",
    &[
        (0, "all targets are met"),
        (1, "a target is missed"),
        (2, "bad usage or input"),
        (3, "a target is not shown, or not everything was measured"),
    ],
))]
pub(super) struct EvaluateLaserArguments {
    /// Number of walks, each in another building
    #[arg(long, default_value_t = 60, value_name = "N")]
    walks: u64,
    /// Number of whole runs, each in another building
    #[arg(long, default_value_t = 10, value_name = "N")]
    runs: u64,
    #[command(flatten)]
    safeguards: SafeguardOptions,
    /// Number of traversals by the robot that drives by its scans
    #[arg(long, default_value_t = 100, value_name = "N")]
    traversals: u64,
    /// Number of places that a walk passes: junctions, bends and dead ends
    #[arg(long, default_value_t = 12, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    places: u16,
    /// The buildings
    #[arg(long, value_enum, default_value = "mixed", value_name = "KIND")]
    buildings: BuildingKind,
    /// Random seed
    #[arg(long, default_value_t = 1, value_name = "N")]
    seed: u64,
    /// The most that the heading of the odometry drifts, in degrees in 10 m
    #[arg(long, default_value_t = 1.0, value_name = "DEGREES", value_parser = drift)]
    drift: f64,
    #[command(flatten)]
    scanner: ScannerOption,
    /// Measure only the walk with this number, and print each of its visits
    #[arg(long, value_name = "N", conflicts_with_all = ["walks", "runs", "traversals"])]
    walk: Option<u64>,
    /// Measure only the whole run with this number
    #[arg(long, value_name = "N", conflicts_with_all = ["walk", "walks", "runs", "traversals"])]
    run: Option<u64>,
    #[command(flatten)]
    failed: FailedOption,
    #[command(flatten)]
    report: ReportArguments,
}

impl EvaluateLaserArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let mut sheet = self.report.begin()?;
        let failed = self.failed.begin()?;
        let scanner = self.scanner.given.as_deref().map(read_scanner).transpose()?;
        if let Some(scanner) = &scanner {
            let is_enough = scanner.check_range(CorridorWorld::WIDEST);
            is_enough.map_err(|error| CliError::at("--scanner", error))?;
        }
        let sampler = WalkSampler {
            seed: self.seed,
            buildings: self.buildings,
            places: self.places.into(),
            drift: self.drift.to_radians() / 10.0,
            scanner,
            sensing: LaserParams::default(),
        };
        let one = |number: u64| number..number.saturating_add(1);
        let (walk_numbers, run_numbers, traversals) = match (self.walk, self.run) {
            (Some(walk), _) => (one(walk), 0..0, 0),
            (None, Some(run)) => (0..0, one(run), 0),
            (None, None) => (0..self.walks, 0..self.runs, self.traversals),
        };
        let count = |numbers: &Range<u64>| numbers.end - numbers.start;
        let wanted = count(&walk_numbers) + count(&run_numbers) + traversals;
        let method = self.safeguards.folding();
        let walks =
            measure("walks", "walks", walk_numbers, |number, watch| sampler.walk(number, watch))?;
        let runs = measure("runs", "runs", run_numbers, |number, watch| {
            sampler.run(number, method, watch)
        })?;
        let traversals = self.driven(traversals, scanner.unwrap_or_default())?;
        let measured = walks.len() + runs.len() + traversals.len();
        let is_interrupted = (measured as u64) < wanted;
        let ending = MeasurementEnd::interrupted_if(is_interrupted);
        let figures = laser_report::figures(&walks, &runs, &traversals);
        let outcome = ending.outcome(figures.status());

        let buildings = self.buildings.to_possible_value();
        let buildings = buildings.as_ref().map_or("", |value| value.get_name());
        let line = json!({
            "walks": walks.len(), "runs": runs.len(), "traversals": traversals.len(),
            "buildings": buildings, "places": self.places, "seed": self.seed, "drift": self.drift,
            "audits": method.audits(), "recover": method.recovers(),
        });
        sheet.line("source", &line)?;
        self.print_source(buildings, &walks, !runs.is_empty(), &mut sheet.text)?;
        sheet.figures(&Map::new(), &figures)?;
        sheet.groups("Visits", &figures.groups, |group| {
            let tally = group.tally;
            json!({"wrong": tally.wrong, "undecided": tally.undecided, "of": tally.all()})
        })?;
        writeln!(sheet.text)?;
        for walk in &walks {
            self.add_walk(walk, &mut sheet)?;
        }
        for run in &runs {
            add_run(run, &mut sheet)?;
        }
        if let Some(mut failed) = failed {
            for run in runs.iter().filter(|run| run.outcome != RobotOutcome::Right) {
                let Some(failed_run) = self.failed_run(run, &sampler) else { continue };
                failed.add(&failed_run, |head| {
                    let stopped = StoppedBy(&StopSignal);
                    let logged = sampler.logged_run(run.number, method, &head, stopped);
                    let (run, log) = logged.map_err(|error| CliError::at("--failed", error))?;
                    run.map(|_| log).ok_or(CliError::Interrupted)
                })?;
            }
            remark!("{}", failed.finish()?);
        }
        for made in &traversals {
            if let Some(reason) = made.outcome.reason() {
                sheet.failure(control::named(made), reason)?;
            }
        }
        let line = json!({ "target": figures.status().name(), "interrupted": is_interrupted });
        let verdict = ending.verdict_on_targets(outcome, &figures.statuses().collect::<Vec<_>>());
        sheet.finish(out, ("verdict", line), outcome, &format!("\n{verdict}"))
    }

    /// Drives by scans from junction to junction of floor plans.
    fn driven(&self, count: u64, scanner: ScannerParams) -> Result<Vec<JudgedTraversal>, CliError> {
        if count == 0 {
            return Ok(Vec::new());
        }
        let plans = usual_plans(self.seed, RandomPlans::Any(PLANS), usize::MAX)?;
        let traversals = TraversalSampler::new(plans, self.seed, 1.0);
        let equipment = RobotEquipment::Laser(scanner);
        measure("traversals", "traversals", 0..count, |number, watch| {
            traversals.traversal(number, &equipment, watch)
        })
    }

    fn print_source(
        &self,
        buildings: &str,
        walks: &[JudgedWalk],
        with_runs: bool,
        out: &mut dyn Write,
    ) -> Result<(), CliError> {
        let visits = counted(walks.iter().map(|walk| walk.visits.len()).sum(), "visit");
        let count = counted(walks.len(), "walk");
        writeln!(out, "Laser scanner on {count} with {visits}, seed {}", self.seed)?;
        writeln!(out, "  buildings: {buildings}")?;
        if with_runs {
            let safeguards = safeguards_in_words(self.safeguards.folding());
            let text = format!("whole runs by the folding explorer {safeguards}");
            writeln!(out, "  {}", text.trim_end())?;
        }
        let degrees = if (self.drift - 1.0).abs() < f64::EPSILON { "degree" } else { "degrees" };
        Ok(writeln!(out, "  odometry drifts by up to {} {degrees} in 10 m\n", self.drift)?)
    }

    /// A run that failed, as it is written.
    fn failed_run(&self, run: &ScannedRun, sampler: &WalkSampler) -> Option<FailedSimulation> {
        let ScannedRun { number, outcome, .. } = run;
        let method = self.safeguards.folding();
        let (graph, start) = sampler.run_world(*number)?;
        let settings = WalkSampler::run_settings(&graph, method).recorded().to_string();
        let about = format!("The building of run {number} of seed {}", self.seed);
        let name = format!("building-{}-{number}", self.seed);
        let buildings = self.buildings.to_possible_value()?;
        let mut words = vec![
            format!("evaluate laser --run {number}"),
            format!("--seed {} --buildings {}", self.seed, buildings.get_name()),
            format!("--drift {}", self.drift),
        ];
        words.extend(self.safeguards.arguments());
        let scanner = self.scanner.given.as_ref();
        words
            .extend(scanner.map(|given| format!("--scanner {}", quoted(&given.to_string_lossy()))));
        let command = words.join(" ");
        Some(FailedSimulation {
            seed: self.seed,
            number: *number,
            verdict: in_words_of(outcome),
            reason: outcome.reason().unwrap_or_default(),
            world: NamedWorld::numbered(&name, &about, graph, Some(start)),
            start,
            robot_seed: self.seed,
            vision: None,
            command: Box::new(move |_| command.clone()),
            settings,
        })
    }

    /// Adds the visits of a walk: those that are not right, or all if it is the only walk.
    fn add_walk(&self, walk: &JudgedWalk, sheet: &mut EvaluationReport) -> Result<(), CliError> {
        for visit in &walk.visits {
            if self.walk.is_none() && visit.verdict == LaserVerdict::Right {
                continue;
            }
            let text = format!("walk {}, {}", walk.number, in_words(visit));
            print_indented(&mut sheet.text, "  ", 4, &text)?;
            let line = json!({
                "walk": walk.number, "way": rounded(visit.way), "verdict": visit.verdict.name(),
                "degree": visit.degree, "door": visit.door,
                "found_degree": visit.found.map(|(degree, _)| degree),
                "found_door": visit.found.and_then(|(_, door)| door),
            });
            sheet.line("visit", &line)?;
        }
        for (degree, way) in &walk.invented {
            let doors = counted(*degree as usize, "door");
            let what = format!("walk {}, {way:.0} m", walk.number);
            sheet.failure(what, format!("invented, {doors}"))?;
            let line = json!({
                "walk": walk.number, "way": rounded(*way), "verdict": "invented",
                "degree": null, "door": null, "found_degree": degree, "found_door": null,
            });
            sheet.line("visit", &line)?;
        }
        Ok(())
    }
}

fn add_run(run: &ScannedRun, sheet: &mut EvaluationReport) -> Result<(), CliError> {
    let ScannedRun { number, moves, way, recoveries, tally, outcome } = run;
    let verdict = in_words_of(outcome);
    let reason = outcome.reason();
    if let Some(reason) = &reason {
        let moves = counted(*moves as usize, "move");
        let what = format!("run {number}, {moves}, {way:.0} m");
        sheet.failure(what, format!("{verdict}: {reason}"))?;
    }
    let line = json!({
        "run": number, "moves": moves, "way": rounded(*way), "recoveries": recoveries,
        "percepts": tally.percepts, "wrong_percepts": tally.wrong,
        "missing_percepts": tally.passed, "verdict": verdict, "reason": reason,
    });
    sheet.line("run", &line)
}

fn in_words_of(outcome: &RobotOutcome<String>) -> &'static str {
    match outcome {
        RobotOutcome::Right => "right",
        RobotOutcome::GaveUp(_) => "gave up",
        RobotOutcome::Wrong(_) => "wrong",
    }
}

fn in_words(visit: &JudgedLaserVisit) -> String {
    let JudgedLaserVisit { degree, way, door, found, verdict, .. } = visit;
    let doors = |degree: u32| counted(degree as usize, "door");
    let expected = format!("{}, left by door {door}", doors(*degree));
    let found = match found {
        Some((degree, Some(door))) => format!("; derived {}, door {door}", doors(*degree)),
        Some((degree, None)) => format!("; derived {}", doors(*degree)),
        None => String::new(),
    };
    format!("{way:.0} m: {}, {expected}{found}", verdict.name())
}

fn rounded(metres: f64) -> f64 {
    (metres * 10.0).round() / 10.0
}

/// Parses the drift of odometry.
fn drift(text: &str) -> Result<f64, String> {
    let degrees = text.parse().ok().filter(|degrees: &f64| (0.0..=90.0).contains(degrees));
    degrees.ok_or_else(|| "expected a number of degrees from 0 to 90".to_owned())
}
