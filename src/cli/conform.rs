//! `toposlam conform LOG...`: checks logs against the specification. Sections 2 and 4 to 6.

mod expected;
mod known_world;
mod minimise;
mod origin;
mod report;
mod report_lines;

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use clap::ValueEnum;
use toposlam::page;
use toposlam_model::{
    enumerate::{Class, Watch},
    marker::Marker,
    trace::WorldSearch,
};
use toposlam_robot::conform::{
    ConformConfig, ConformVerdict, Evidence, ExtractError, ExtractedRun, JudgeError, Judgement,
    Quirks, RunCoverage, RunDriver, SensingProgress, extract, judge,
};

use super::{
    Failure, Outcome, input, marker_kinds,
    open_log::{LogOptions, OpenLog},
    output,
    progress::Progress,
};
use known_world::Known;

/// Check logs of runs against the specification
///
/// For each log, the command reports that it conforms and which cases of the specification it covers, or
/// the first event at which it diverges, why, and the class of the fault: perception, motion, algorithm
/// or log.
///
/// A log is a ROS 1 bag or an MCAP file. If it records percepts and doors, these are checked. Otherwise
/// they are inferred from its scenes or images and its odometry. They must fit the known world; without
/// one, the command searches for the smallest world that explains them. The doors must be doors that
/// Algorithm 1 takes, or may take.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  toposlam simulate worlds/shape-6.toml --by-scene --log run.mcap
  toposlam conform run.mcap --world worlds/shape-6.toml --html report.html
  toposlam conform theirs.bag --mapping mapping.toml --calibration camera.toml --colours colours.toml

Exit codes: 0 all logs conform, 1 a log diverges, 2 bad usage or input, 3 a log is incomplete: it is \
truncated, its run did not end, or the search for a world reached its step limit.")]
pub(super) struct ConformArguments {
    /// The logs to check
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// The world file or floor plan in which they were recorded
    #[arg(long, value_name = "FILE")]
    world: Option<PathBuf>,
    /// The robot's start and the door behind it, or `any`
    /// [default: from the log, or else from the world file, or else any]
    #[arg(long, value_name = "VERTEX:FACING", requires = "world")]
    start: Option<String>,
    /// The kind of marker [default: from the log, or else directional]
    #[arg(long, value_name = "MARKER", value_parser = marker_kinds())]
    marker: Option<&'static dyn Marker>,
    /// What chose the doors
    #[arg(long, value_enum, default_value = "algorithm1", value_name = "WHO")]
    driver: Who,
    /// Without --world: the class of worlds to search
    #[arg(long, default_value_t = Class::Multigraph, value_name = "CLASS", conflicts_with = "world")]
    class: Class,
    /// Without --world: the largest number of edges to search; at least 4 more than Algorithm 1 knows
    #[arg(long, default_value_t = 12, value_name = "N", conflicts_with = "world")]
    edges: usize,
    #[command(flatten)]
    sources: LogOptions,
    /// The source of the events [default: the first of these that the log has]
    #[arg(long, value_enum, value_name = "WHAT")]
    events: Option<Made>,
    /// A file of known divergences to tolerate
    #[arg(long, value_name = "FILE")]
    quirks: Option<PathBuf>,
    /// Stop when more edge ends are known
    #[arg(long, value_name = "N", default_value_t = 1000)]
    max_darts: usize,
    /// Write a shorter log that diverges in the same way
    #[arg(long, value_name = "FILE")]
    minimise: Option<PathBuf>,
    /// Write the report as an HTML page
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Print one JSON object for each log, and one for all if there are several
    #[arg(long)]
    json: bool,
}

/// What chose the doors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Who {
    /// Algorithm 1, with any of its choices
    Algorithm1,
    /// Anything, in any way
    Anyone,
}

/// The source of the events.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Made {
    /// Recorded percepts and doors
    #[value(alias = "told")]
    Recorded,
    /// Scenes and odometry
    Scenes,
    /// Images and odometry
    Pictures,
}

/// A log and its judgement.
struct Judged {
    opened: OpenLog,
    gathered: ExtractedRun,
    judgement: Judgement,
    known: Option<Known>,
}

impl SensingProgress for Progress {
    fn sensed(&self, pictures: u64) {
        self.part_done(pictures);
    }
}

impl ConformArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        self.check_places()?;
        let quirks = match &self.quirks {
            None => Quirks::default(),
            Some(path) => {
                let text = String::from_utf8(input::read(path)?)
                    .map_err(|error| Failure::in_file(path, error))?;
                Quirks::read(&text).map_err(|error| Failure::in_file(path, error))?
            }
        };
        let mut reports = Vec::new();
        let mut all = RunCoverage::default();
        let mut worst = Outcome::Holds;
        for path in &self.logs {
            let judged = self.judge(path, &quirks)?;
            all.include(&judged.judgement.coverage);
            worst = worse(worst, judged.judgement.verdict());
            let shorter = self.shorter(&judged)?;
            let mut report = judged.report(path, &quirks, shorter, self.html.is_some());
            if self.html.is_some() {
                report.sources = origin::sources(path, self.world.as_deref())?;
            }
            if self.json {
                report_lines::json(out, &report, &judged.judgement)?;
            } else {
                report_lines::text(out, &report)?;
            }
            reports.push(report);
        }
        if reports.len() > 1 {
            report_lines::together(out, &reports, self.json)?;
        }
        if let Some(path) = &self.html {
            output::write_whole(path, page::conform_page(&reports, &origin::origin()).as_bytes())?;
        }
        Ok(worst)
    }

    fn check_places(&self) -> Result<(), Failure> {
        if let Some(path) = &self.html {
            output::check_place(path, &["html", "htm"])?;
        }
        if let Some(path) = &self.minimise {
            output::check_place(path, &["mcap"])?;
            if self.logs.len() > 1 {
                return Err(Failure::at("--minimise", "this needs exactly one log"));
            }
            if self.logs.contains(path) {
                return Err(Failure::at("--minimise", "this is the log itself"));
            }
        }
        Ok(())
    }

    /// Reads and judges a log.
    fn judge(&self, path: &Path, quirks: &Quirks) -> Result<Judged, Failure> {
        let opened = OpenLog::new(path, &self.sources)?;
        let evidence = match self.events {
            Some(made) if Evidence::from(made).is_in(&opened.mapping) => made.into(),
            Some(_) => {
                let cause = "the log does not have what this needs";
                return Err(Failure::at("--events", format!("{cause} ({})", path.display())));
            }
            None => opened.evidence(path)?,
        };
        let known = match &self.world {
            None => None,
            Some(world) => Some(Known::new(world, self, opened.run.as_ref())?),
        };
        if let (Some(known), Some(run)) = (&known, &opened.run) {
            known.warn(path, run);
        }
        let marker = match (&known, self.marker) {
            (Some(known), _) => known.marker,
            (None, Some(marker)) => marker,
            (None, None) => opened.marker()?,
        };
        let progress = Progress::endless("reading", "pictures")?;
        let sensor = opened.sensor();
        let gathered = extract(
            &opened.log,
            &opened.mapping,
            evidence,
            sensor.as_ref(),
            marker.name() == "directional",
            &progress,
        );
        let gathered = gathered.map_err(|error| match error {
            ExtractError::TopicMap(error) => opened.wrong_mapping(path, &error),
            error => Failure::in_file(path, error),
        })?;
        let question = self.question(known.as_ref());
        let judgement = judge(gathered.events.clone(), &question, quirks, &progress);
        progress.finish();
        let judgement = judgement.map_err(|error| match error {
            JudgeError::Empty if gathered.pictures > 0 => Failure::in_file(
                path,
                format!("no junction is visited in its {} images", gathered.pictures),
            ),
            error => Failure::in_file(path, error),
        })?;
        Ok(Judged { opened, gathered, judgement, known })
    }

    fn question<'k>(&self, known: Option<&'k Known>) -> ConformConfig<'k> {
        ConformConfig {
            world: known.map(Known::question),
            driver: match self.driver {
                Who::Algorithm1 => RunDriver::Algorithm1,
                Who::Anyone => RunDriver::Anyone,
            },
            search: WorldSearch { class: self.class, edges: self.edges, steps: WorldSearch::STEPS },
            dart_bound: self.max_darts,
        }
    }
}

impl From<Made> for Evidence {
    fn from(made: Made) -> Self {
        match made {
            Made::Recorded => Self::Recorded,
            Made::Scenes => Self::Scenes,
            Made::Pictures => Self::Pictures,
        }
    }
}

/// The worse outcome: a divergence is worse than an incomplete log.
fn worse(worst: Outcome, verdict: ConformVerdict) -> Outcome {
    match (worst, verdict) {
        (Outcome::Violated, _) | (_, ConformVerdict::Diverged) => Outcome::Violated,
        (_, ConformVerdict::Incomplete) | (Outcome::Incomplete, _) => Outcome::Incomplete,
        (Outcome::Holds, ConformVerdict::Conforms) => Outcome::Holds,
    }
}
