//! The worlds, walks and values of a case of a lemma, as text and as JSON.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::Value;
use toposlam_model::{
    embedded_graph::Dart,
    format::{named_world::NamedWorld, world_file},
    marker::Marker,
    percept::{Door, Percept},
    world::{Action, GraphWorld, State},
};
use toposlam_proofs::Exhibit;

use crate::cli::{
    json::percept_json,
    text::{capital, print_hanging, print_rows},
};

/// The worlds of a case, the walks in them, and other values.
pub(super) struct CaseView {
    worlds: Vec<NamedWorld>,
    /// In the order in which the lemma shows them.
    parts: Vec<Part>,
}

enum Part {
    /// The index of a world.
    World(usize),
    Walk(Walk),
    Value {
        name: &'static str,
        value: String,
    },
}

/// A walk in a world with a marker at the start.
struct Walk {
    /// The index of the world.
    world: usize,
    marker: &'static dyn Marker,
    doors: Vec<Door>,
    /// The robot's pose, `vertex:door`, and percept: at the start and after each door.
    steps: Vec<(String, Percept)>,
    /// Why the robot stopped early, if it did.
    stopped: Option<String>,
}

impl CaseView {
    /// The view of what a lemma shows. `about` describes its worlds.
    pub(super) fn new(about: &str, exhibits: &[Exhibit]) -> Self {
        let is_world = |exhibit: &&Exhibit| matches!(exhibit, Exhibit::World { .. });
        let several = exhibits.iter().filter(is_world).count() > 1;
        let mut worlds: Vec<NamedWorld> = Vec::new();
        let mut parts = Vec::new();
        for exhibit in exhibits {
            parts.push(match exhibit {
                Exhibit::World { graph, facing } => {
                    let place = worlds.len();
                    let name =
                        if several { format!("case-{}", place + 1) } else { "case".to_owned() };
                    let start = Some(*facing).filter(|facing| facing.at() < graph.dart_count());
                    worlds.push(NamedWorld::numbered(&name, about, graph.clone(), start));
                    Part::World(place)
                }
                Exhibit::Walk { world, marker, pose, doors } => {
                    Walk::new(&worlds, *world, *marker, *pose, doors)
                        .map_or_else(|| impossible_walk(*pose, doors), Part::Walk)
                }
                Exhibit::Value { name, value } => Part::Value { name, value: value.clone() },
            });
        }
        Self { worlds, parts }
    }

    /// Prints each part after an empty line.
    pub(super) fn print(&self, out: &mut dyn Write) -> io::Result<()> {
        let world = |place: usize| match self.worlds.len() {
            1 => "the world".to_owned(),
            _ => format!("world {}", place + 1),
        };
        for part in &self.parts {
            writeln!(out)?;
            match part {
                Part::World(place) => {
                    let which = capital(&world(*place));
                    writeln!(
                        out,
                        "{which}, as a file for `toposlam draw` and `toposlam explore`:\n"
                    )?;
                    write!(out, "{}", world_file::to_toml(&self.worlds[*place]))?;
                }
                Part::Walk(walk) => {
                    let which = world(walk.world);
                    let marker = walk.marker.name();
                    writeln!(out, "A walk in {which}, marker {marker}:\n")?;
                    walk.print(out)?;
                }
                Part::Value { name, value } => print_hanging(out, &format!("{name}: "), value)?,
            }
        }
        Ok(())
    }

    pub(super) fn json(&self) -> CaseViewLine<'_> {
        let mut line = CaseViewLine {
            worlds: self.worlds.iter().map(world_file::to_json).collect(),
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

/// A walk whose world or pose does not exist, as a value.
fn impossible_walk(pose: Dart, doors: &[Door]) -> Part {
    let doors: Vec<_> = doors.iter().map(|door| door.0.to_string()).collect();
    let value = format!("from dart {} by the doors {}", pose.0, doors.join(","));
    Part::Value { name: "walk", value }
}

impl Walk {
    /// The walk from a pose by these doors in one of the worlds, as far as possible. `None` if there is no
    /// such pose.
    fn new(
        worlds: &[NamedWorld],
        place: usize,
        marker: &'static dyn Marker,
        pose: Dart,
        doors: &[Door],
    ) -> Option<Self> {
        let world = worlds.get(place).filter(|world| pose.at() < world.graph.dart_count())?;
        let facing = world.start?;
        let mut robot = GraphWorld::with_marker(&world.graph, marker, facing);
        let start = State { pose, ..robot.state() };
        robot = robot.at(start);
        let step = |robot: &GraphWorld<'_, &dyn Marker>| {
            (world.state_text(&marker, robot.state()), robot.sensed())
        };
        let mut steps = vec![step(&robot)];
        let mut stopped = None;
        for &door in doors {
            if let Err(refused) = robot.act(Action::Take(door)) {
                stopped = Some(refused.to_string());
                break;
            }
            steps.push(step(&robot));
        }
        Some(Self { world: place, marker, doors: doors.to_vec(), steps, stopped })
    }

    fn print(&self, out: &mut dyn Write) -> io::Result<()> {
        let doors = self.doors.iter().map(|door| door.0.to_string());
        let rows: Vec<_> = std::iter::once("start".to_owned())
            .chain(doors)
            .zip(&self.steps)
            .map(|(door, (pose, percept))| [door, pose.clone(), percept.to_string()])
            .collect();
        print_rows(out, ["door", "robot at", "perceives"], &rows)?;
        if let Some(why) = &self.stopped {
            print_hanging(out, "  stopped: ", why)?;
        }
        Ok(())
    }

    fn json(&self) -> WalkLine<'_> {
        WalkLine {
            world: self.world,
            marker: self.marker.name(),
            doors: self.doors.iter().map(|door| door.0).collect(),
            poses: self.steps.iter().map(|(pose, _)| pose.as_str()).collect(),
            percepts: self.steps.iter().map(|&(_, percept)| percept_json(percept)).collect(),
            stopped: self.stopped.as_deref(),
        }
    }
}

/// The part of a line of `--json` that shows a case.
#[derive(Serialize)]
pub(super) struct CaseViewLine<'a> {
    worlds: Vec<Value>,
    walks: Vec<WalkLine<'a>>,
    values: Vec<ValueLine<'a>>,
}

#[derive(Serialize)]
struct WalkLine<'a> {
    /// The index of its world in `worlds`.
    world: usize,
    marker: &'a str,
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
