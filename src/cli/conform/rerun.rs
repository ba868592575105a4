//! `toposlam conform --rerun LOG`: the off-line version on a log. Section 6.
//!
//! Each recorded image is sensed again, and Algorithm 2 and the mapping algorithm run again. Scenes, commands,
//! percepts, doors and the map are compared with the recorded ones, and the computing time with the robot's time.
//! If the log has no images, its scenes are used.

use std::{io::Write, path::Path, time::Instant};

use serde_json::{Value, json};
use toposlam_conform::LogHead;
use toposlam_logs::topic_map::Role;
use toposlam_model::{
    embedded_graph::EmbeddedGraph,
    format::named_world::NamedWorld,
    mapping::{FACING, MappingError},
};
use toposlam_robot::{
    replay::{Agreement, Replay, ReplayComparison, ReplayDifference, ReplayError, replay},
    run_settings::{RecordedSettings, RunSettings},
};

use super::ConformArguments;
use crate::cli::{
    CliError, Outcome,
    certificate_cost::CertificateCost,
    json::{TruncatedLine, print_line},
    open_log::OpenLog,
    output,
    text::{counted, grouped, print_hanging, printable, since_start, tenths, vertices},
};

impl ConformArguments {
    pub(super) fn rerun(&self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let [log] = &self.logs[..] else {
            return Err(CliError::at("--rerun", "this needs exactly one log"));
        };
        output::check_world_place(&self.map, false)?;
        let opened = OpenLog::new(log, &self.sources)?;
        let begun = Instant::now();
        let head = LogHead(opened.run.as_ref());
        // A robot that is driven again has no gripper.
        if let Some(aid) = head.aid().ok().filter(|aid| aid.moves()) {
            let name = aid.name();
            let cause = format!(
                "its robot maps with `{name}`, which moves; such a robot is not driven again"
            );
            return Err(CliError::in_file(log, cause));
        }
        let settings = head.settings(self.algorithm);
        let RecordedSettings { method, budget, is_resumed, dart_bound, .. } =
            settings.map_err(|head| {
                let cause = format!("its algorithm `{head}` is unknown; use --algorithm");
                CliError::in_file(log, cause)
            })?;
        if is_resumed {
            let cause = "its robot went on from an earlier run, which is not in this log";
            return Err(CliError::in_file(log, cause));
        }
        let dart_bound = self.max_darts.unwrap_or(dart_bound);
        let settings = RunSettings { budget, ..RunSettings::new(method, dart_bound) };
        let replay = replay(&opened.log, &opened.topics, opened.sensor(), &settings);
        let seconds = begun.elapsed().as_secs_f64();
        let replay = replay.map_err(|error| match error {
            ReplayError::TopicMap(error) => opened.wrong_topics(log, &error),
            ReplayError::Calibration(error) => opened.wrong_calibration(log, &error),
            error => CliError::in_file(log, error),
        })?;
        if self.json {
            print_line(out, "replay", &json(log, &opened, &replay, seconds))?;
        } else {
            print(out, log, &replay, seconds)?;
            if let Some(truncation) = opened.log.truncation() {
                writeln!(out, "The log is {truncation}.")?;
            }
        }
        if let Some(path) = &self.map {
            match complete_map(&replay) {
                None => remark!("the map is not written: the run ended early"),
                Some(graph) => {
                    let about = format!("The map from a replay of {}", log.display());
                    let map = NamedWorld::numbered("map", &about, graph.clone(), Some(FACING));
                    output::write_world(path, &map)?;
                }
            }
        }
        Ok(outcome(&replay))
    }
}

/// What `--json` prints.
fn json(log: &Path, opened: &OpenLog, replay: &Replay, compute_seconds: f64) -> Value {
    let Replay { mapping, error, comparison, recorded_seconds, .. } = replay;
    let map = mapping.map();
    let both = |agreement: Agreement| [agreement.agree, agreement.of];
    let difference = comparison.difference.as_ref().map(|difference| {
        json!({
            "picture": difference.frame, "time": difference.time, "what": difference.what,
            "recorded": difference.recorded, "found": difference.found,
        })
    });
    json!({
        "log": log.display().to_string(),
        "pictures": comparison.frames,
        "moves": mapping.moves(),
        "certificate": certificate(replay),
        "vertices": map.vertex_count(),
        "edges": edges(replay),
        "complete": map.complete().is_some(),
        "error": error.as_ref().map(ToString::to_string),
        "scenes": both(comparison.scenes),
        "commands": both(comparison.commands),
        "percepts": both(comparison.percepts),
        "doors": both(comparison.doors),
        "map": comparison.map,
        "difference": difference,
        "compute_seconds": compute_seconds,
        "recorded_seconds": recorded_seconds,
        "truncated": opened.log.truncation().map(TruncatedLine::from),
    })
}

fn print(out: &mut dyn Write, log: &Path, replay: &Replay, seconds: f64) -> Result<(), CliError> {
    let map = replay.mapping.map();
    let whole = if map.complete().is_some() { "complete" } else { "incomplete" };
    let comparison = &replay.comparison;
    writeln!(out, "{}: the map is {whole}", printable(&log.display().to_string()))?;
    let (frame, frames) = match replay.frames {
        Role::Image => ("image", "images"),
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

fn complete_map(replay: &Replay) -> Option<&EmbeddedGraph> {
    replay.mapping.map().complete().filter(|_| replay.error.is_none())
}

fn certificate(replay: &Replay) -> Option<CertificateCost> {
    let graph = complete_map(replay)?;
    Some(CertificateCost::new(graph, FACING, Some(replay.mapping.moves())))
}

/// The number of edges whose both ends are known.
fn edges(replay: &Replay) -> usize {
    let map = replay.mapping.map();
    (map.dart_count() - map.unexplored_count() as usize) / 2
}

fn outcome(replay: &Replay) -> Outcome {
    let ReplayComparison { scenes, commands, percepts, doors, map, ref difference, .. } =
        replay.comparison;
    let differs = difference.is_some() || map == Some(false);
    match &replay.error {
        _ if differs => Outcome::Violated,
        // The log ends too early, the robot gave up in the recorded run, too, or the bound is reached.
        Some(_) => Outcome::Incomplete,
        None if [scenes, commands, percepts, doors].into_iter().all(Agreement::is_whole) => {
            Outcome::Holds
        }
        None => Outcome::Violated,
    }
}
