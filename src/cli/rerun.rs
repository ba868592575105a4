//! `toposlam conform --rerun LOG`: the off-line version on a log. Section 6.
//!
//! Each recorded image is sensed again, and Algorithm 2 and the mapping algorithm run again. Scenes, commands,
//! percepts, doors and the map are compared with the recorded ones, and the computing time with the robot's time.
//! If the log has no images, its scenes are used.

use std::{io::Write, path::Path, time::Instant};

use serde::Serialize;
use toposlam_logs::topic_map::Role;
use toposlam_model::{
    format::named_world::NamedWorld,
    mapping::{FACING, MappingAlgorithm, MappingError},
};
use toposlam_robot::{
    replay::{Agreement, Replay, ReplayDifference, ReplayError, replay},
    run_settings::{RecordedSettings, RunSettings},
};

use super::{
    CliError, Outcome,
    certificate_cost::CertificateCost,
    json::{TruncatedLine, print_line},
    open_log::{LogOptions, OpenLog},
    output,
    text::{counted, grouped, print_hanging, since_start, tenths, vertices},
};

/// A log, and how it is mapped again.
pub(super) struct Rerun<'a> {
    pub(super) log: &'a Path,
    pub(super) sources: &'a LogOptions,
    /// Instead of the algorithm in the log.
    pub(super) algorithm: Option<MappingAlgorithm>,
    /// Instead of the limit in the log.
    pub(super) max_darts: Option<usize>,
    /// Where the map is written.
    pub(super) map: Option<&'a Path>,
    pub(super) json: bool,
}

/// What `--json` prints.
#[derive(Serialize)]
struct RerunLine {
    log: String,
    pictures: u64,
    moves: u64,
    certificate: Option<CertificateCost>,
    vertices: usize,
    edges: usize,
    complete: bool,
    error: Option<String>,
    scenes: [u64; 2],
    commands: [u64; 2],
    percepts: [u64; 2],
    doors: [u64; 2],
    map: Option<bool>,
    difference: Option<DifferenceJson>,
    compute_seconds: f64,
    recorded_seconds: f64,
    truncated: Option<TruncatedLine>,
}

#[derive(Serialize)]
struct DifferenceJson {
    picture: u64,
    time: f64,
    what: &'static str,
    recorded: String,
    found: String,
}

impl Rerun<'_> {
    pub(super) fn run(&self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        if let Some(map) = self.map {
            output::check_world_place(map, false)?;
        }
        let opened = OpenLog::new(self.log, self.sources)?;
        let begun = Instant::now();
        let RecordedSettings { method, budget, is_resumed, dart_bound } =
            opened.settings(self.log, self.algorithm)?;
        if is_resumed {
            let cause = "its robot went on from an earlier run, which is not in this log";
            return Err(CliError::in_file(self.log, cause));
        }
        let dart_bound = self.max_darts.unwrap_or(dart_bound);
        let settings = RunSettings { budget, ..RunSettings::new(method, dart_bound) };
        let (log, topics) = (&opened.log, &opened.topics);
        let replay = replay(log, topics, opened.sensor(), &settings);
        let seconds = begun.elapsed().as_secs_f64();
        let replay = replay.map_err(|error| match error {
            ReplayError::TopicMap(error) => opened.wrong_topics(self.log, &error),
            ReplayError::Calibration(error) => opened.wrong_calibration(self.log, &error),
            error => CliError::in_file(self.log, error),
        })?;
        if self.json {
            print_line(out, "replay", &self.line(&opened, &replay, seconds))?;
        } else {
            self.print(out, &replay, seconds)?;
            if let Some(truncation) = opened.log.truncation() {
                writeln!(out, "The log is {truncation}.")?;
            }
        }
        if let Some(path) = self.map {
            let complete = replay.mapping.map().complete();
            match complete.filter(|_| replay.error.is_none()) {
                None => remark!("the map is not written: the run ended early"),
                Some(graph) => {
                    let about = format!("The map from a replay of {}", self.log.display());
                    let map = NamedWorld::numbered("map", &about, graph.clone(), Some(FACING));
                    output::write_world(path, &map)?;
                }
            }
        }
        Ok(outcome(&replay))
    }

    fn line(&self, opened: &OpenLog, replay: &Replay, compute_seconds: f64) -> RerunLine {
        let map = replay.mapping.map();
        let both = |agreement: Agreement| [agreement.agree, agreement.of];
        RerunLine {
            log: self.log.display().to_string(),
            pictures: replay.comparison.frames,
            moves: replay.mapping.moves(),
            certificate: certificate(replay),
            vertices: map.vertex_count(),
            edges: edges(replay),
            complete: map.complete().is_some(),
            error: replay.error.as_ref().map(ToString::to_string),
            scenes: both(replay.comparison.scenes),
            commands: both(replay.comparison.commands),
            percepts: both(replay.comparison.percepts),
            doors: both(replay.comparison.doors),
            map: replay.comparison.map,
            difference: replay.comparison.difference.clone().map(|difference| DifferenceJson {
                picture: difference.frame,
                time: difference.time,
                what: difference.what,
                recorded: difference.recorded,
                found: difference.found,
            }),
            compute_seconds,
            recorded_seconds: replay.recorded_seconds,
            truncated: opened.log.truncation().map(TruncatedLine::from),
        }
    }

    fn print(&self, out: &mut dyn Write, replay: &Replay, seconds: f64) -> Result<(), CliError> {
        let map = replay.mapping.map();
        let whole = if map.complete().is_some() { "complete" } else { "incomplete" };
        let comparison = &replay.comparison;
        writeln!(out, "{}: the map is {whole}", self.log.display())?;
        let (frame, frames) = match replay.frames {
            Role::Image => ("image", "images"),
            Role::Scan => ("scan", "scans"),
            _ => ("scene", "scenes"),
        };
        writeln!(out, "  {frames:<11} {}", grouped(comparison.frames.into()))?;
        writeln!(out, "  moves       {}", grouped(replay.mapping.moves().into()))?;
        let (vertices, edges) = (vertices(map.vertex_count()), counted(edges(replay), "edge"));
        writeln!(out, "  map         {vertices}, {edges}")?;
        if let Some(certificate) = certificate(replay) {
            certificate.print("  certificate ", out)?;
        }
        if let Some(error) = &replay.error {
            print_hanging(out, "  ended early ", &error.to_string())?;
            if matches!(error, MappingError::Bound { .. }) {
                writeln!(out, "              Use --max-darts N to raise the bound.")?;
            }
        }
        writeln!(out, "As recorded:")?;
        let rows = [
            ("scenes", comparison.scenes),
            ("commands", comparison.commands),
            ("percepts", comparison.percepts),
            ("doors", comparison.doors),
        ];
        for (name, agreement) in rows.iter().filter(|(_, agreement)| agreement.of > 0) {
            let [agree, of] = [agreement.agree, agreement.of].map(|count| grouped(count.into()));
            writeln!(out, "  {name:<11} {agree} of {of}")?;
        }
        if let Some(same) = comparison.map {
            writeln!(out, "  map         {}", if same { "yes" } else { "no" })?;
        }
        if let Some(difference) = &comparison.difference {
            let ReplayDifference { frame: number, what, recorded, found, .. } = difference;
            let number = grouped((*number).into());
            let time = since_start(difference.time);
            writeln!(out, "First difference: the {what} at {frame} {number}, {time}")?;
            print_hanging(out, "  recorded    ", recorded)?;
            print_hanging(out, "  replayed    ", found)?;
        }
        // paper: exp.off-line-time
        let ratio = (replay.recorded_seconds / seconds.max(1e-9)) as u128;
        let minutes = replay.recorded_seconds / 60.0;
        writeln!(out, "Time:")?;
        writeln!(out, "  recorded    {} minutes", tenths(minutes))?;
        writeln!(out, "  computed    {seconds:.2} s, {} times faster", grouped(ratio))?;
        Ok(())
    }
}

/// The certificate of the complete map.
fn certificate(replay: &Replay) -> Option<CertificateCost> {
    let graph = replay.mapping.map().complete().filter(|_| replay.error.is_none())?;
    Some(CertificateCost::new(graph, FACING, Some(replay.mapping.moves())))
}

/// The number of edges whose both ends are known.
fn edges(replay: &Replay) -> usize {
    let map = replay.mapping.map();
    (map.dart_count() - map.unexplored_count() as usize) / 2
}

fn outcome(replay: &Replay) -> Outcome {
    let agreements = [
        replay.comparison.scenes,
        replay.comparison.commands,
        replay.comparison.percepts,
        replay.comparison.doors,
    ];
    let differs = replay.comparison.difference.is_some() || replay.comparison.map == Some(false);
    match &replay.error {
        _ if differs => Outcome::Violated,
        // The log ends too early, the robot gave up in the recorded run, too, or the bound is reached.
        Some(_) => Outcome::Incomplete,
        None if agreements.into_iter().all(Agreement::is_whole) => Outcome::Holds,
        None => Outcome::Violated,
    }
}
