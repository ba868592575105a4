//! A case of a lemma: its worlds, walks and other values, as text and as JSON.

use std::io::{self, Write};

use serde_json::{Value, json};
use toposlam_model::{
    format::{named_world::NamedWorld, world_file},
    marker::Marker,
    world::{GraphWorld, RefusedAction, State, World},
};
use toposlam_proofs::{Exhibit, Lemma, Stop, odometer::listed};

use super::Report;
use crate::cli::{
    CliError, Outcome,
    json::{percept_json, print_line},
    text::{capital, print_command, print_hanging, print_rows},
};

impl Report<'_> {
    /// Prints the case of these choices, and returns the outcome. A case that the lemma excludes is incomplete.
    pub(super) fn case(&mut self, lemma: &Lemma, choices: &[u8]) -> Result<Outcome, CliError> {
        let (engine, made) = lemma
            .replay(choices)
            .map_err(|misfit| CliError::at(format!("--choices: {}", lemma.name), misfit))?;
        let (outcome, word, verdict) = match made.case {
            Ok(()) => (Outcome::Holds, "holds", "holds: the lemma holds in"),
            Err(Stop::Fails(_)) => (Outcome::Violated, "fails", "violated: the lemma fails in"),
            Err(Stop::Excluded) => {
                (Outcome::Incomplete, "excluded", "incomplete: the lemma excludes")
            }
        };
        self.statement(lemma.name, lemma.sentence)?;
        let claim = if let Err(Stop::Fails(claim)) = made.case { Some(claim) } else { None };
        if let Some(claim) = claim {
            print_hanging(self.text, "  fails: ", &format!("it is not true that {claim}"))?;
        }
        let again = format!("toposlam proofs --run {} --choices {}", lemma.name, listed(choices));
        print_command(self.text, "  again: ", again.trim_end())?;
        let [worlds, walks, values] = print_exhibits(lemma.name, &made.exhibits, self.text)?;
        writeln!(self.text, "\n{verdict} this case")?;
        let line = json!({
            "lemma": lemma.name, "engine": engine, "choices": choices, "verdict": word,
            "holds": outcome == Outcome::Holds, "claim": claim, "worlds": worlds, "walks": walks,
            "values": values,
        });
        print_line(self.json, "case", &line)?;
        Ok(outcome)
    }
}

/// Prints what a lemma shows of a case, and returns it: worlds, walks and values.
fn print_exhibits(
    lemma: &str,
    exhibits: &[Exhibit],
    text: &mut dyn Write,
) -> io::Result<[Vec<Value>; 3]> {
    let is_world = |exhibit: &&Exhibit| matches!(exhibit, Exhibit::World { .. });
    let is_only_one = exhibits.iter().filter(is_world).count() == 1;
    let mut worlds: Vec<(String, NamedWorld)> = Vec::new();
    let [mut world_files, mut walks, mut values] = [const { Vec::new() }; 3];
    for exhibit in exhibits {
        writeln!(text)?;
        match exhibit {
            Exhibit::World { graph, facing } => {
                let number = worlds.len() + 1;
                let name = if is_only_one { "case".into() } else { format!("case-{number}") };
                let label =
                    if is_only_one { "the world".into() } else { format!("world {number}") };
                let about = format!("A case of {lemma}");
                let world = NamedWorld::numbered(&name, &about, graph.clone(), Some(*facing));
                let head = capital(&label);
                writeln!(text, "{head}, as a file for `toposlam draw` and `toposlam explore`:\n")?;
                write!(text, "{}", world_file::to_toml(&world))?;
                world_files.push(world_file::to_json(&world));
                worlds.push((label, world));
            }
            Exhibit::Walk { world: place, marker, pose, doors } => {
                // A lemma shows a world before the walks in it.
                let Some((label, world)) = worlds.get(*place) else { continue };
                let facing = world.start.unwrap_or(*pose);
                let robot = GraphWorld::with_marker(&world.graph, *marker, facing);
                let start = State { pose: *pose, ..robot.state() };
                let mut robot = robot.at(start);
                let (mut rows, mut percepts) = (Vec::new(), Vec::new());
                let mut arrive = |door: String, robot: &GraphWorld<_>| {
                    let pose = world.state_text(marker, robot.state());
                    rows.push([door, pose, robot.sensed().to_string()]);
                    percepts.push(percept_json(robot.sensed()));
                };
                arrive("start".to_owned(), &robot);
                let walked: Result<(), RefusedAction> = doors.iter().try_for_each(|door| {
                    robot.traverse(*door)?;
                    arrive(door.0.to_string(), &robot);
                    Ok(())
                });
                let stopped = walked.err().map(|refused| refused.to_string());
                writeln!(text, "A walk in {label}, marker {}:\n", marker.name())?;
                print_rows(text, ["door", "robot at", "perceives"], &rows)?;
                stopped.iter().try_for_each(|why| print_hanging(text, "  stopped: ", why))?;
                let doors: Vec<_> = doors.iter().map(|door| door.0).collect();
                let poses: Vec<_> = rows.iter().map(|row| &row[1]).collect();
                walks.push(json!({
                    "world": place, "marker": marker.name(), "doors": doors, "poses": poses,
                    "percepts": percepts, "stopped": stopped,
                }));
            }
            Exhibit::Value { name, value } => {
                print_hanging(text, &format!("{name}: "), value)?;
                values.push(json!({ "name": name, "value": value }));
            }
        }
    }
    Ok([world_files, walks, values])
}
