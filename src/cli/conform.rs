//! `toposlam conform LOG...`: logs held against the specification. Sections 2 and 4 to 6.

mod known_world;
mod minimise;
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
    Looking, Quirks, RunCoverage, RunDriver, extract, judge,
};

use super::{
    Failure, Outcome, input, marker_kinds,
    open_log::{LogOptions, OpenLog},
    output,
    progress::Progress,
};
use known_world::Known;

/// Hold logs of runs against the specification: do they conform, and if not, where, why, whose fault
///
/// A log is a ROS 1 bag or an MCAP file. Where it tells percepts and doors, those are judged; otherwise
/// they are derived from its scenes or its pictures, and its odometry. They are held against a known
/// world, or else the smallest world is searched that explains them; and against Algorithm 1: are the
/// doors those that it takes, or may take?
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  toposlam simulate worlds/shape-6.toml --by-scene --log run.mcap
  toposlam conform run.mcap --world worlds/shape-6.toml --html report.html
  toposlam conform theirs.bag --mapping mapping.toml --calibration camera.toml --colours colours.toml

Exit codes: 0 all conform, 1 one diverged, 2 bad usage or input, 3 one is incomplete: truncated, or
its run did not come to its end, or worlds were not searched to the bound.")]
pub(super) struct ConformArguments {
    /// The logs
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// The world or floor plan in which they were made
    #[arg(long, value_name = "FILE")]
    world: Option<PathBuf>,
    /// Where the robot starts there, and which door is behind it, or `any`
    /// [default: as the log says, or else the world's own start, or else any]
    #[arg(long, value_name = "VERTEX:FACING", requires = "world")]
    start: Option<String>,
    /// The kind of marker [default: as the log says, or else directional]
    #[arg(long, value_name = "MARKER", value_parser = marker_kinds())]
    marker: Option<&'static dyn Marker>,
    /// Who takes the doors
    #[arg(long, value_enum, default_value = "algorithm1", value_name = "WHO")]
    driver: Who,
    /// Without a known world: the class of worlds that are searched for one that explains a log
    #[arg(long, default_value_t = Class::Multigraph, value_name = "CLASS", conflicts_with = "world")]
    class: Class,
    /// Without a known world: up to how many edges; where Algorithm 1 knows more, 4 beyond that
    #[arg(long, default_value_t = 12, value_name = "N", conflicts_with = "world")]
    edges: usize,
    #[command(flatten)]
    sources: LogOptions,
    /// Of what events are made [default: the first of these that the log has]
    #[arg(long, value_enum, value_name = "WHAT")]
    events: Option<Made>,
    /// Divergences that are known and tolerated
    #[arg(long, value_name = "FILE")]
    quirks: Option<PathBuf>,
    /// Give up when more edge ends are known
    #[arg(long, value_name = "N", default_value_t = 1000)]
    max_darts: usize,
    /// Write a shorter log that diverges in the same way
    #[arg(long, value_name = "FILE")]
    minimise: Option<PathBuf>,
    /// Write the report as a page
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Print one JSON object for each log, and one for all where there are several
    #[arg(long)]
    json: bool,
}

/// Who takes the doors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Who {
    /// Algorithm 1, with any of its choices
    Algorithm1,
    /// Anyone, wherever they like
    Anyone,
}

/// Of what events are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Made {
    /// Of the percepts and doors that the log tells
    Told,
    /// Of the scenes that it tells, and odometry
    Scenes,
    /// Of its pictures, and odometry
    Pictures,
}

/// A log that was judged.
struct Judged {
    opened: OpenLog,
    gathered: ExtractedRun,
    judgement: Judgement,
    known: Option<Known>,
}

impl Looking for Progress {
    fn looked(&self, pictures: u64) {
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
            let report = judged.report(path, &quirks, shorter, self.html.is_some());
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
            output::write_whole(path, page::conform_page(&reports).as_bytes())?;
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
                return Err(Failure::at("--minimise", "this goes with one log"));
            }
            if self.logs.contains(path) {
                return Err(Failure::at("--minimise", "this is the log itself"));
            }
        }
        Ok(())
    }

    /// Reads a log and judges it.
    fn judge(&self, path: &Path, quirks: &Quirks) -> Result<Judged, Failure> {
        let opened = OpenLog::new(path, &self.sources)?;
        let evidence = match self.events {
            Some(made) if Evidence::from(made).is_in(&opened.mapping) => made.into(),
            Some(_) => {
                let cause = "what this needs is not in the log, as far as the mapping tells";
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
                format!("in its {} pictures no junction is visited", gathered.pictures),
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
            Made::Told => Self::Told,
            Made::Scenes => Self::Scenes,
            Made::Pictures => Self::Pictures,
        }
    }
}

/// Of a divergence and what is incomplete, the divergence is worse.
fn worse(worst: Outcome, verdict: ConformVerdict) -> Outcome {
    match (worst, verdict) {
        (Outcome::Violated, _) | (_, ConformVerdict::Diverged) => Outcome::Violated,
        (_, ConformVerdict::Incomplete) | (Outcome::Incomplete, _) => Outcome::Incomplete,
        (Outcome::Holds, ConformVerdict::Conforms) => Outcome::Holds,
    }
}
