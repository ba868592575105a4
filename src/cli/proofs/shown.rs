//! What a lemma shows of a case, as a person reads it and as a program does.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::Value;
use toposlam_model::{
    embedded_graph::Dart,
    format::{named_world::NamedWorld, world_file},
    marker::Directional,
    percept::{Door, Percept},
    world::{Action, GraphWorld, State},
};
use toposlam_proofs::Exhibit;

use crate::cli::{columns::print_rows, json::percept_json};

/// The worlds of a case, the walks in them, and what else there is, in the order of the lemma.
pub(super) struct Shown {
    parts: Vec<Part>,
}

enum Part {
    World(NamedWorld),
    Walk(Walk),
    Value { name: &'static str, value: String },
}

/// A walk in a world where the directional marker lies at the start.
struct Walk {
    /// The place of the world among those that are shown, from 0.
    world: usize,
    doors: Vec<Door>,
    /// Where the robot is, `vertex:door`, and what it perceives there: at the beginning and after each
    /// door.
    steps: Vec<(String, Percept)>,
    /// Why it did not go on, if it could not.
    stopped: Option<String>,
}

impl Shown {
    /// What a lemma shows; `about` is said of its worlds.
    pub(super) fn new(about: &str, exhibits: &[Exhibit]) -> Self {
        let is_world = |exhibit: &&Exhibit| matches!(exhibit, Exhibit::World { .. });
        let several = exhibits.iter().filter(is_world).count() > 1;
        let mut shown = Self { parts: Vec::new() };
        for exhibit in exhibits {
            let worlds = shown.worlds().count();
            let part = match exhibit {
                Exhibit::World { graph, facing } => {
                    let name =
                        if several { format!("case-{}", worlds + 1) } else { "case".to_owned() };
                    let start = Some(*facing).filter(|facing| facing.at() < graph.dart_count());
                    Part::World(NamedWorld::numbered(&name, about, graph.clone(), start))
                }
                Exhibit::Walk { pose, doors } => match shown.worlds().last() {
                    Some(world) => Walk::new(world, worlds - 1, *pose, doors),
                    None => nowhere(*pose, doors),
                },
                Exhibit::Value { name, value } => Part::Value { name, value: value.clone() },
            };
            shown.parts.push(part);
        }
        shown
    }

    fn worlds(&self) -> impl Iterator<Item = &NamedWorld> {
        self.parts.iter().filter_map(|part| match part {
            Part::World(world) => Some(world),
            _ => None,
        })
    }

    /// Each part, after an empty line.
    pub(super) fn tell(&self, out: &mut dyn Write) -> io::Result<()> {
        let several = self.worlds().count() > 1;
        let mut told = 0;
        for part in &self.parts {
            writeln!(out)?;
            match part {
                Part::World(world) => {
                    told += 1;
                    let which =
                        if several { format!("World {told}") } else { "The world".to_owned() };
                    writeln!(out, "{which}, as a file for toposlam draw and toposlam explore:\n")?;
                    write!(out, "{}", world_file::to_toml(world))?;
                }
                Part::Walk(walk) => {
                    let which = if several {
                        format!("world {}", walk.world + 1)
                    } else {
                        "the world".to_owned()
                    };
                    writeln!(out, "A walk in {which}, with the directional marker:\n")?;
                    walk.tell(out)?;
                }
                Part::Value { name, value } => writeln!(out, "{name}: {value}")?,
            }
        }
        Ok(())
    }

    pub(super) fn json(&self) -> ShownLine<'_> {
        let mut line = ShownLine {
            worlds: self.worlds().map(world_file::to_json).collect(),
            walks: Vec::new(),
            values: Vec::new(),
        };
        for part in &self.parts {
            match part {
                Part::World(_) => {}
                Part::Walk(walk) => line.walks.push(walk.json()),
                Part::Value { name, value } => line.values.push(ValueLine { name, value }),
            }
        }
        line
    }
}

/// A walk that is in none of the worlds that are shown.
fn nowhere(pose: Dart, doors: &[Door]) -> Part {
    let doors: Vec<_> = doors.iter().map(|door| door.0.to_string()).collect();
    let value = format!("from dart {} by the doors {}", pose.0, doors.join(","));
    Part::Value { name: "walk", value }
}

impl Walk {
    /// The walk from a pose by these doors, as far as it goes.
    fn new(world: &NamedWorld, place: usize, pose: Dart, doors: &[Door]) -> Part {
        let Some(facing) = world.start.filter(|_| pose.at() < world.graph.dart_count()) else {
            return nowhere(pose, doors);
        };
        let mut robot = GraphWorld::new(&world.graph, facing);
        let begun = State { pose, ..robot.state() };
        robot = robot.at(begun);
        let step =
            |robot: &GraphWorld| (world.state_text(&Directional, robot.state()), robot.sensed());
        let mut steps = vec![step(&robot)];
        let mut stopped = None;
        for &door in doors {
            if let Err(refused) = robot.act(Action::Take(door)) {
                stopped = Some(refused.to_string());
                break;
            }
            steps.push(step(&robot));
        }
        Part::Walk(Self { world: place, doors: doors.to_vec(), steps, stopped })
    }

    fn tell(&self, out: &mut dyn Write) -> io::Result<()> {
        let doors = self.doors.iter().map(|door| door.0.to_string());
        let rows: Vec<_> = std::iter::once("start".to_owned())
            .chain(doors)
            .zip(&self.steps)
            .map(|(door, (pose, percept))| [door, pose.clone(), percept.to_string()])
            .collect();
        print_rows(out, ["door", "robot at", "perceives"], &rows)?;
        if let Some(why) = &self.stopped {
            writeln!(out, "  it cannot go on: {why}")?;
        }
        Ok(())
    }

    fn json(&self) -> WalkLine<'_> {
        WalkLine {
            world: self.world,
            doors: self.doors.iter().map(|door| door.0).collect(),
            poses: self.steps.iter().map(|(pose, _)| pose.as_str()).collect(),
            percepts: self.steps.iter().map(|&(_, percept)| percept_json(percept)).collect(),
            stopped: self.stopped.as_deref(),
        }
    }
}

/// What `--json` tells of a case.
#[derive(Serialize)]
pub(super) struct ShownLine<'a> {
    worlds: Vec<Value>,
    walks: Vec<WalkLine<'a>>,
    values: Vec<ValueLine<'a>>,
}

#[derive(Serialize)]
struct WalkLine<'a> {
    /// The place of its world in `worlds`.
    world: usize,
    doors: Vec<u32>,
    poses: Vec<&'a str>,
    percepts: Vec<Value>,
    stopped: Option<&'a str>,
}

#[derive(Serialize)]
struct ValueLine<'a> {
    name: &'a str,
    value: &'a str,
}
