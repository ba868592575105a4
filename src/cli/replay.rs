//! `toposlam replay LOG`: the off-line version on a log, without a robot that moves. Section 6.

use std::{io::Write, path::PathBuf, time::Instant};

use serde::Serialize;
use toposlam_model::{format::named_world::NamedWorld, mapping::FACING};
use toposlam_robot::replay::{Agreement, NotReplayed, Replay, replay};

use super::{
    Failure, Outcome,
    json::print_object,
    open_log::{LogOptions, OpenLog},
    output,
    text::{counted, grouped, vertices},
};

/// Run sensing and Algorithm 1 on the pictures of a log, without a robot that moves
///
/// Each recorded picture is sensed again, Algorithm 2 answers it again, and Algorithm 1 maps again.
/// Scenes, commands, percepts, doors and the map are held against those that were recorded; and the time
/// that this took against the time that the robot took. A log without pictures is replayed from the
/// scenes in it.
#[derive(clap::Args)]
#[command(after_help = "\
Example:
  toposlam simulate worlds/shape-6.toml --log run.mcap
  toposlam replay run.mcap

Exit codes: 0 all is as recorded, 1 something is not, 2 bad usage or input, 3 the log is truncated or
its run did not come to its end.")]
pub(super) struct Arguments {
    /// The log
    log: PathBuf,
    #[command(flatten)]
    sources: LogOptions,
    /// Give up when more edge ends are known
    #[arg(long, value_name = "N", default_value_t = 1000)]
    max_darts: usize,
    /// Write the map: .toml, .json, .dot, or plantri's .ec or .pc
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Line {
    schema: u32,
    log: String,
    pictures: u64,
    moves: u64,
    vertices: usize,
    edges: usize,
    complete: bool,
    error: Option<String>,
    scenes: [u64; 2],
    commands: [u64; 2],
    percepts: [u64; 2],
    doors: [u64; 2],
    map: Option<bool>,
    difference: Option<Difference>,
    compute_seconds: f64,
    recorded_seconds: f64,
}

#[derive(Serialize)]
struct Difference {
    picture: u64,
    time: f64,
    what: &'static str,
    recorded: String,
    found: String,
}

impl Arguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        if let Some(map) = &self.map {
            output::check_world_place(map, false)?;
        }
        let opened = OpenLog::new(&self.log, &self.sources)?;
        let begun = Instant::now();
        let replay = replay(&opened.log, &opened.mapping, opened.sensor(), self.max_darts);
        let seconds = begun.elapsed().as_secs_f64();
        let replay = replay.map_err(|error| match error {
            NotReplayed::TopicMap(error) => opened.wrong_mapping(&self.log, &error),
            error => Failure::in_file(&self.log, error),
        })?;
        if self.json {
            print_object(out, &self.line(&replay, seconds))?;
        } else {
            self.tell(out, &replay, seconds)?;
            if let Some(truncation) = opened.log.truncation() {
                writeln!(out, "  the log is {truncation}")?;
            }
        }
        if let Some(path) = &self.map {
            match replay.exploration.map().complete() {
                None => eprintln!("the map is not complete, and is not written"),
                Some(graph) => {
                    let about = format!("The map that {} gives off-line", self.log.display());
                    let map = NamedWorld::numbered("map", &about, graph.clone(), Some(FACING));
                    output::write_world(path, &map)?;
                }
            }
        }
        Ok(outcome(&replay))
    }

    fn line(&self, replay: &Replay, compute_seconds: f64) -> Line {
        let map = replay.exploration.map();
        let both = |agreement: Agreement| [agreement.agree, agreement.of];
        Line {
            schema: 1,
            log: self.log.display().to_string(),
            pictures: replay.comparison.pictures,
            moves: replay.exploration.moves(),
            vertices: map.vertex_count(),
            edges: edges(replay),
            complete: map.complete().is_some(),
            error: replay.error.as_ref().map(ToString::to_string),
            scenes: both(replay.comparison.scenes),
            commands: both(replay.comparison.commands),
            percepts: both(replay.comparison.percepts),
            doors: both(replay.comparison.doors),
            map: replay.comparison.map,
            difference: replay.comparison.difference.clone().map(|difference| Difference {
                picture: difference.picture,
                time: difference.time,
                what: difference.what,
                recorded: difference.recorded,
                found: difference.found,
            }),
            compute_seconds,
            recorded_seconds: replay.recorded_seconds,
        }
    }

    fn tell(&self, out: &mut dyn Write, replay: &Replay, seconds: f64) -> Result<(), Failure> {
        let map = replay.exploration.map();
        let whole = if map.complete().is_some() { "the map" } else { "a part of the map" };
        writeln!(
            out,
            "{}: {} give {whole}: {}, {}, in {}",
            self.log.display(),
            counted(replay.comparison.pictures as usize, "picture"),
            vertices(map.vertex_count()),
            counted(edges(replay), "edge"),
            counted(replay.exploration.moves() as usize, "move")
        )?;
        if let Some(error) = &replay.error {
            writeln!(out, "  it ends early: {error}")?;
        }
        let rows = [
            ("scenes", replay.comparison.scenes),
            ("commands", replay.comparison.commands),
            ("percepts", replay.comparison.percepts),
            ("doors", replay.comparison.doors),
        ];
        for (name, agreement) in rows.iter().filter(|(_, agreement)| agreement.of > 0) {
            writeln!(out, "  {name:<10} {agreement} as recorded")?;
        }
        match replay.comparison.map {
            Some(true) => writeln!(out, "  map        as recorded")?,
            Some(false) => writeln!(out, "  map        not as recorded")?,
            None => {}
        }
        if let Some(difference) = &replay.comparison.difference {
            writeln!(
                out,
                "  first difference at picture {}, {:.1} s: the {} was {}; it is {}",
                difference.picture,
                difference.time,
                difference.what,
                difference.recorded,
                difference.found
            )?;
        }
        // paper: exp.off-line-time
        let ratio = (replay.recorded_seconds / seconds.max(1e-9)) as u128;
        writeln!(
            out,
            "  computed in {seconds:.2} s what was recorded in {:.1} minutes: 1 : {}",
            replay.recorded_seconds / 60.0,
            grouped(ratio)
        )?;
        Ok(())
    }
}

/// How many edges are known.
fn edges(replay: &Replay) -> usize {
    let map = replay.exploration.map();
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
        // The log ends too early, or the robot gave up, and does so again.
        Some(_) => Outcome::Incomplete,
        None if agreements.into_iter().all(Agreement::is_whole) => Outcome::Holds,
        None => Outcome::Violated,
    }
}
