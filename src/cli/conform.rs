//! `toposlam conform LOG...`: checks logs against the specification. Sections 2 and 4 to 6.

mod judged_log;
mod laser_picture;
mod minimise;
mod origin;
mod rerun;
mod text;

use std::{
    io::Write,
    path::{Path, PathBuf},
    time::Instant,
};

use clap::{
    ValueEnum,
    builder::{PossibleValue, PossibleValuesParser, TypedValueParser},
};
use toposlam_conform::{
    ConformReports, ConformVerdict, DoorChooser, Evidence, LogReport, Quirks, RequiredCoverage,
    RobotStart, UnreadLog, case_names, words,
};
use toposlam_model::{
    aid::AidKind,
    enumerate::Class,
    folding::WorldSearch,
    format::named_world::NamedWorld,
    mapping::MappingAlgorithm,
    marker::{Directional, NoMarker},
    trace::AlgorithmCase,
};

use super::{
    CliError, Outcome,
    ci_report::{CiCase, CiOptions},
    exit_codes::help_end,
    input,
    json::{print_line, print_unread},
    laser_options::WorldLaserOptions,
    marking_aids,
    method_options::algorithms,
    open_log::LogOptions,
    outcome::SeveralInputs,
    output,
    text::print_hanging,
    verdict_proof::ProofOption,
};
use crate::page;
use judged_log::JudgedLog;

/// Check logs of runs against the specification
///
/// For each log, the command reports that it conforms and which cases of the specification it covers, or
/// the first event at which it diverges, why, and the class of the fault: perception, motion, algorithm
/// or log. If a limit was reached first, or the run did not end, it is not known whether the log conforms.
///
/// A log is a ROS 1 bag, an MCAP file, a rosbag2 folder or .db3 file, a CARMEN log, or events as JSON lines
/// or CSV. If it records percepts and doors, these are checked. Otherwise they are inferred from its scenes,
/// images or laser scans, and its odometry. They must fit the known world. Without one, a log diverges at the
/// first event that no world of any size explains, and the command searches for the smallest world that
/// explains the log. The doors must be those of an algorithm: the one that the log names, or else Algorithm 1
/// with any of its choices.
///
/// The command also reports whether the log determines its world. If it does not, some doors were never
/// followed, and different worlds explain the log.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  toposlam simulate worlds/shape-6.toml --by-scene --log run.mcap
  toposlam conform run.mcap --world worlds/shape-6.toml --html report.html
  toposlam conform theirs.bag --topics topics.toml --calibration camera.toml \\
    --colours colours.toml
  toposlam conform scans.log.gz --driver anyone --marker directional \\
    --assume-marker
  toposlam conform --rerun run.mcap",
    &[
        (0, "all logs conform, or --rerun gives the recorded results"),
        (1, "a log diverges, or a result of --rerun differs"),
        (2, "bad usage or input"),
        (3, "not known: a log is truncated, its run did not end, a junction was not recognised, a limit was reached, or a required case is not covered"),
    ],
))]
pub(super) struct ConformArguments {
    /// The logs to check
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// Run sensing and mapping again on the images, scans or scenes of the log, without a robot, and compare
    /// scenes, commands, percepts, doors and the map with the recorded ones
    #[arg(long, conflicts_with_all = [
        "world", "start", "aid", "assume_marker", "driver", "class", "max_edges", "max_steps",
        "laser_params", "corners", "events", "quirks", "require_coverage", "minimise", "picture", "html", "proof", "CiOptions",
    ])]
    rerun: bool,
    /// The world file or floor plan in which they were recorded
    #[arg(long, value_name = "FILE")]
    world: Option<PathBuf>,
    /// The robot's start and the door behind it, or `any`
    /// [default: from the log, or else from the world file, or else any]
    #[arg(long, value_name = "VERTEX:FACING", requires = "world")]
    start: Option<String>,
    /// The robot's marking aid; others than directional, undirected and none are checked with recorded events [default:
    /// from the log, or else directional]
    #[arg(long, visible_alias = "marker", value_name = "KIND", value_parser = marking_aids())]
    aid: Option<AidKind>,
    /// For events inferred from laser scans: check the log as if a marker had lain at the place that --topics
    /// gives, or else at the first junction that the robot visited, along its entry door
    #[arg(long)]
    assume_marker: bool,
    /// What chose the doors
    #[arg(long, value_enum, default_value = "algorithm", value_name = "WHO")]
    driver: DriverOption,
    /// The algorithm that chose the doors: algorithm1 or folding [default: from the log, or else algorithm1]
    #[arg(long, hide_possible_values = true, value_parser = algorithms())]
    algorithm: Option<MappingAlgorithm>,
    /// Without --world: the class of worlds to search
    #[arg(long, default_value_t = Class::Multigraph, value_name = "CLASS", conflicts_with = "world")]
    class: Class,
    /// Without --world: search only worlds with at most this many edges [default: any number]
    #[arg(long, value_name = "N", conflicts_with = "world", value_parser = at_least_one_edge)]
    max_edges: Option<usize>,
    /// Without --world: end the search for the smallest world after this many steps
    #[arg(long, default_value_t = WorldSearch::STEPS, value_name = "N", conflicts_with = "world",
        value_parser = clap::value_parser!(u64).range(1..))]
    max_steps: u64,
    #[command(flatten)]
    sources: LogOptions,
    #[command(flatten)]
    laser: WorldLaserOptions,
    /// The source of the events [default: the first of these that the log has]
    #[arg(long, value_name = "WHAT", value_parser = evidence())]
    events: Option<Evidence>,
    /// A file of known divergences to tolerate
    #[arg(long, value_name = "FILE")]
    quirks: Option<PathBuf>,
    /// Follow the algorithm until more edge ends are known [default: the limit in the log, or 1000]
    #[arg(long, value_name = "N")]
    max_darts: Option<usize>,
    /// Cases that the logs must cover together, such as confirmed,dead-end; if one is missing, exit with 3
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = PossibleValuesParser::new(case_names()),
        hide_possible_values = true)]
    require_coverage: Vec<String>,
    /// Without --world: write the smallest world that was found: .toml, .json, .dot, or plantri's .ec or .pc
    #[arg(long, value_name = "FILE", conflicts_with = "world")]
    map: Option<PathBuf>,
    /// Write a shorter log that diverges in the same way
    #[arg(long, value_name = "FILE")]
    minimise: Option<PathBuf>,
    /// Write a picture of a run with a laser scanner: the map, the robot's way and its visits; .svg or .png
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// Write the report as an HTML page
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    #[command(flatten)]
    proof: ProofOption,
    /// Print one JSON object for each log, and one for all if there are several; with --events also one for
    /// each junction that the robot visited
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    ci: CiOptions,
}

/// What chose the doors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum DriverOption {
    /// The algorithm; Algorithm 1 with any of its choices
    #[value(alias = "algorithm1")]
    Algorithm,
    /// Anything, in any way
    Anyone,
}

/// Parses the source of the events.
fn evidence() -> impl TypedValueParser<Value = Evidence> {
    let sources = [
        PossibleValue::new("recorded").alias("told").help("Recorded percepts and doors"),
        PossibleValue::new("scenes").help("Scenes and odometry"),
        PossibleValue::new("images").alias("pictures").help("Images and odometry"),
        PossibleValue::new("laser").help("Laser scans and odometry"),
    ];
    PossibleValuesParser::new(sources).map(|name| match name.as_str() {
        "scenes" => Evidence::Scenes,
        "images" | "pictures" => Evidence::Images,
        "laser" => Evidence::Laser,
        _ => Evidence::Recorded,
    })
}

/// A largest number of edges.
fn at_least_one_edge(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) => Err("a world has at least one edge".to_owned()),
        Ok(edges) => Ok(edges),
        Err(error) => Err(error.to_string()),
    }
}

impl ConformArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        self.ci.check_places()?;
        if self.rerun {
            return self.rerun(out);
        }
        self.check_places()?;
        self.check_marker()?;
        let quirks = match &self.quirks {
            None => Quirks::default(),
            Some(path) => {
                let text = String::from_utf8(input::read(path)?)
                    .map_err(|error| CliError::in_file(path, error))?;
                Quirks::read(&text).map_err(|error| CliError::in_file(path, error))?
            }
        };
        let world = self.world.as_deref().map(input::read_world).transpose()?;
        if let (Some(world), RobotStart::At(start)) = (&world, self.robot_start()) {
            input::start_of(world, Some(start))?;
        }
        let mut reports = ConformReports::default();
        let mut logs = SeveralInputs::default();
        let mut cases = Vec::new();
        for path in &self.logs {
            let begun = Instant::now();
            let judged = self.judge(path, world.as_ref(), &quirks).map(|judged| {
                let outcome = outcome(judged.checked.judgement.verdict());
                (judged, outcome)
            });
            let cause =
                judged.as_ref().map_or_else(|error| error.cause_in(path), |_| String::new());
            let Some(judged) = logs.add(judged) else {
                let unread = UnreadLog { log: path.display().to_string(), cause };
                if self.json {
                    print_unread(out, &unread.log, &unread.cause)?;
                }
                let message = format!("the log cannot be checked: {}", unread.cause);
                cases.push(ci_case(path, Outcome::Incomplete, message).begun(begun));
                reports.unread.push(unread);
                continue;
            };
            let report = self.report(out, path, &judged)?;
            let case = ci_case(path, outcome(report.verdict), words::result(&report));
            cases.push(case.begun(begun));
            reports.logs.push(report);
        }
        if self.logs.len() > 1 && self.json {
            let coverage = LogReport::coverage_of(&reports.logs);
            print_line(out, "logs", &reports.together(&coverage))?;
        } else if self.logs.len() > 1 {
            text::print_together(out, &reports)?;
        }
        if !self.require_coverage.is_empty() && !reports.logs.is_empty() {
            let required = RequiredCoverage::from_reports(&self.require_coverage, &reports.logs);
            let message = words::required(&required);
            if self.json {
                print_line(out, "required-coverage", &required)?;
            } else {
                print_hanging(out, "", &message)?;
            }
            let all_covered = required.not_covered.is_empty();
            let outcome = if all_covered { Outcome::Holds } else { Outcome::Incomplete };
            logs.add(Ok(((), outcome)));
            let name = "required coverage".to_owned();
            cases.push(CiCase { name, outcome, message, file: None, seconds: None });
            reports.required = Some(required);
        }
        self.ci.write("conform", &cases, self.logs.first().map(PathBuf::as_path))?;
        if let Some(path) = self.html.as_ref().filter(|_| !reports.logs.is_empty()) {
            output::write_whole(path, page::conform_page(&reports, &origin::origin()).as_bytes())?;
        }
        logs.worst()
    }

    /// Prints the report of a log, and writes what belongs to it.
    fn report(
        &self,
        out: &mut dyn Write,
        path: &Path,
        judged: &JudgedLog,
    ) -> Result<LogReport, CliError> {
        let JudgedLog { opened, checked } = judged;
        let mut report = checked.report(&opened.source(None), path.display().to_string());
        if let Some(shorter) = self.shorter(judged)? {
            let events = shorter.events.events.into_iter();
            report.shorter = events.map(|event| event.kind).collect();
            report.command = shorter.command;
        }
        if self.html.is_some() {
            report.sources = origin::sources(path, self.world.as_deref())?;
            let divergence = report.divergence.as_ref();
            let event = divergence
                .and_then(|found| report.events.get(found.event - 1).or(report.events.last()));
            report.image = event.and_then(|event| opened.image(event.source.id));
        }
        if self.json {
            let visits = self.events.map_or(&[][..], |_| &report.visits);
            for visit in visits {
                print_line(out, "event", visit)?;
            }
            print_line(out, "log", &report)?;
        } else {
            text::print(out, &report)?;
        }
        self.write_map(path, &report)?;
        self.proof.write(|| checked.proofs())?;
        if let Some(picture) = &self.picture {
            laser_picture::write(picture, path, judged)?;
        }
        Ok(report)
    }

    fn check_places(&self) -> Result<(), CliError> {
        output::check_place(&self.html, &["html", "htm"])?;
        output::check_world_place(&self.map, self.class.is_simple())?;
        output::check_place(&self.minimise, &["mcap"])?;
        output::check_place(&self.picture, &["svg", "png"])?;
        self.proof.check_place()?;
        let of_one = [
            ("--map", self.map.as_ref()),
            ("--minimise", self.minimise.as_ref()),
            ("--picture", self.picture.as_ref()),
            ("--proof", self.proof.path()),
        ];
        for (option, path) in of_one {
            if path.is_some() && self.logs.len() > 1 {
                return Err(CliError::at(option, "this needs exactly one log"));
            }
        }
        Ok(())
    }

    /// Checks the options about the marker and the driver.
    fn check_marker(&self) -> Result<(), CliError> {
        let fixed = self.aid.and_then(AidKind::fixed);
        if let Some(marker) = fixed.filter(|&marker| marker != Directional)
            && self.driver == DriverOption::Algorithm
        {
            let cause = "the algorithms need the directional marker; add --driver anyone";
            return Err(CliError::at(format!("--aid {}", marker.name()), cause));
        }
        if self.assume_marker && self.aid.is_some_and(|_| fixed.is_none_or(|it| it == NoMarker)) {
            return Err(CliError::at("--assume-marker", "this needs a fixed marker"));
        }
        if self.driver == DriverOption::Anyone {
            let cause = "with --driver anyone the doors are compared with no algorithm";
            if self.algorithm.is_some() {
                return Err(CliError::at("--algorithm", cause));
            }
            if self.max_darts.is_some() {
                return Err(CliError::at("--max-darts", cause));
            }
            let is_of_algorithm =
                |name: &&String| AlgorithmCase::ALL.iter().any(|case| case.name() == name.as_str());
            if let Some(case) = self.require_coverage.iter().find(is_of_algorithm) {
                let cause = format!("{cause}, so that {case} is never covered");
                return Err(CliError::at("--require-coverage", cause));
            }
        }
        Ok(())
    }

    /// Writes the smallest world that explains a log to the file of `--map`.
    fn write_map(&self, log: &Path, report: &LogReport) -> Result<(), CliError> {
        let Some(path) = &self.map else { return Ok(()) };
        let Some(smallest) = &report.facts.smallest else {
            remark!("{}: not written: no world was found", path.display());
            return Ok(());
        };
        let about = format!("The smallest world that explains {}", log.display());
        let world = NamedWorld { about, marker: None, ..smallest.world.clone() };
        output::write_world(path, &world)
    }
}

fn outcome(verdict: ConformVerdict) -> Outcome {
    match verdict {
        ConformVerdict::Conforms => Outcome::Holds,
        ConformVerdict::Diverged => Outcome::Violated,
        ConformVerdict::NotKnown => Outcome::Incomplete,
    }
}

/// The result of a log, for CI systems.
fn ci_case(path: &Path, outcome: Outcome, message: String) -> CiCase {
    let (name, file) = (path.display().to_string(), Some(path.to_owned()));
    CiCase { name, outcome, message, file, seconds: None }
}

impl DriverOption {
    /// What chose the doors: this algorithm, or else that of the log, or anyone.
    fn chooser(self, algorithm: Option<MappingAlgorithm>) -> DoorChooser {
        match self {
            Self::Algorithm => DoorChooser::Algorithm(algorithm),
            Self::Anyone => DoorChooser::Anyone,
        }
    }
}
