//! A case of a lemma: its worlds, walks and other values, as text and as JSON.

use std::io::{self, Write};

use serde_json::{Value, json};
use toposlam_model::{
    format::{named_world::NamedWorld, world_file},
    marker::Marker,
    world::{Action, GraphWorld, State},
};
use toposlam_proofs::{
    CaseReplay, Exhibit, Lemma, Stop,
    odometer::listed,
    replay::{ChoicesError, ReplayedCase},
};

use super::print_head;
use crate::cli::{
    CliError, Outcome,
    json::{percept_json, print_line},
    text::{capital, print_command, print_hanging, print_rows},
};

/// Prints the case of these choices, and returns the outcome. A case that the lemma excludes is incomplete.
pub(super) fn print(
    lemma: &Lemma,
    choices: &[u8],
    json: bool,
    out: &mut dyn Write,
) -> Result<Outcome, CliError> {
    let (engine, made) = replay(lemma, choices)
        .map_err(|misfit| CliError::at("--choices", format!("{}: {misfit}", lemma.name)))?;
    let (outcome, word, verdict, claim) = match made.case {
        Ok(()) => (Outcome::Holds, "holds", "holds: the lemma holds in this case", None),
        Err(Stop::Fails(claim)) => {
            (Outcome::Violated, "fails", "violated: the lemma fails in this case", Some(claim))
        }
        Err(Stop::Excluded) => {
            (Outcome::Incomplete, "excluded", "incomplete: the lemma excludes this case", None)
        }
    };
    let ([worlds, walks, values], text) = shown(lemma.name, &made.exhibits)?;
    if json {
        let line = json!({
            "lemma": lemma.name, "engine": engine, "choices": choices, "verdict": word,
            "holds": outcome == Outcome::Holds, "claim": claim, "worlds": worlds, "walks": walks,
            "values": values,
        });
        print_line(out, "case", &line)?;
        return Ok(outcome);
    }
    let cause = claim.map(|claim| format!("it is not true that {claim}"));
    print_head(out, lemma.name, lemma.sentence, cause.as_deref())?;
    let again = format!("toposlam proofs --run {} --choices {}", lemma.name, listed(choices));
    print_command(out, "  again: ", again.trim_end())?;
    out.write_all(&text)?;
    writeln!(out, "\n{verdict}")?;
    Ok(outcome)
}

/// The case, and the engine within whose bound it is. Of two engines it is the one in which the lemma fails, or else
/// the exhaustive one.
fn replay(lemma: &Lemma, choices: &[u8]) -> Result<(&'static str, ReplayedCase), ChoicesError> {
    let exhaustive = lemma.replay(choices).map(|made| ("exhaustive", made));
    let sampled = lemma.sampled.map(|sampled| CaseReplay::show(sampled.replay, choices));
    let fails = |made: &ReplayedCase| matches!(made.case, Err(Stop::Fails(_)));
    match sampled {
        Some(Ok(made)) if exhaustive.is_err() || fails(&made) => Ok(("sampled", made)),
        _ => exhaustive,
    }
}

/// What a lemma shows of a case, worlds, walks and values, and the same in words.
fn shown(lemma: &str, exhibits: &[Exhibit]) -> io::Result<([Vec<Value>; 3], Vec<u8>)> {
    let is_world = |exhibit: &&Exhibit| matches!(exhibit, Exhibit::World { .. });
    let is_only_one = exhibits.iter().filter(is_world).count() == 1;
    let label = |place: usize| {
        if is_only_one { "the world".to_owned() } else { format!("world {}", place + 1) }
    };
    let [mut world_files, mut walks, mut values]: [Vec<Value>; 3] = Default::default();
    let mut text = Vec::new();
    let mut worlds: Vec<NamedWorld> = Vec::new();
    for exhibit in exhibits {
        writeln!(text)?;
        match exhibit {
            Exhibit::World { graph, facing } => {
                let place = worlds.len();
                let name =
                    if is_only_one { "case".to_owned() } else { format!("case-{}", place + 1) };
                let about = format!("A case of {lemma}");
                let world = NamedWorld::numbered(&name, &about, graph.clone(), Some(*facing));
                let head = capital(&label(place));
                writeln!(text, "{head}, as a file for `toposlam draw` and `toposlam explore`:\n")?;
                write!(text, "{}", world_file::to_toml(&world))?;
                world_files.push(world_file::to_json(&world));
                worlds.push(world);
            }
            Exhibit::Walk { world: place, marker, pose, doors } => {
                // A lemma shows a world before the walks in it.
                let Some(world) = worlds.get(*place) else { continue };
                let facing = world.start.unwrap_or(*pose);
                writeln!(text, "A walk in {}, marker {}:\n", label(*place), marker.name())?;
                let robot = GraphWorld::with_marker(&world.graph, *marker, facing);
                let start = State { pose: *pose, ..robot.state() };
                let mut robot = robot.at(start);
                let (mut poses, mut percepts, mut rows) = (Vec::new(), Vec::new(), Vec::new());
                let mut door = "start".to_owned();
                let mut left = doors.iter();
                let stopped = loop {
                    let pose = world.state_text(marker, robot.state());
                    rows.push([door, pose.clone(), robot.sensed().to_string()]);
                    poses.push(pose);
                    percepts.push(percept_json(robot.sensed()));
                    let Some(next) = left.next() else { break None };
                    door = next.0.to_string();
                    if let Err(refused) = robot.act(Action::Take(*next)) {
                        break Some(refused.to_string());
                    }
                };
                print_rows(&mut text, ["door", "robot at", "perceives"], &rows)?;
                if let Some(why) = &stopped {
                    print_hanging(&mut text, "  stopped: ", why)?;
                }
                let doors: Vec<_> = doors.iter().map(|door| door.0).collect();
                walks.push(json!({
                    "world": place, "marker": marker.name(), "doors": doors, "poses": poses,
                    "percepts": percepts, "stopped": stopped,
                }));
            }
            Exhibit::Value { name, value } => {
                print_hanging(&mut text, &format!("{name}: "), value)?;
                values.push(json!({ "name": name, "value": value }));
            }
        }
    }
    Ok(([world_files, walks, values], text))
}
