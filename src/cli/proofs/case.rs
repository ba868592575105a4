//! A case of a lemma: its worlds, walks and other values, as text and as JSON.

use std::io::{self, Write};

use serde_json::{Value, json};
use toposlam_model::{
    embedded_graph::Dart,
    format::{named_world::NamedWorld, world_file},
    marker::Marker,
    percept::Door,
    world::{Action, GraphWorld, State},
};
use toposlam_proofs::Exhibit;

use crate::cli::{
    json::percept_json,
    text::{capital, print_hanging, print_rows},
};

/// What a lemma shows of a case.
#[derive(Default)]
pub(super) struct CaseView {
    pub(super) worlds: Vec<Value>,
    pub(super) walks: Vec<Value>,
    pub(super) values: Vec<Value>,
    /// The same in words, in the order in which the lemma shows it.
    pub(super) text: Vec<u8>,
}

impl CaseView {
    pub(super) fn new(lemma: &str, exhibits: &[Exhibit]) -> io::Result<Self> {
        let is_world = |exhibit: &&Exhibit| matches!(exhibit, Exhibit::World { .. });
        let is_only_one = exhibits.iter().filter(is_world).count() == 1;
        let label = |place: usize| {
            if is_only_one { "the world".to_owned() } else { format!("world {}", place + 1) }
        };
        let mut view = Self::default();
        let mut worlds: Vec<NamedWorld> = Vec::new();
        for exhibit in exhibits {
            writeln!(view.text)?;
            match exhibit {
                Exhibit::World { graph, facing } => {
                    let place = worlds.len();
                    let name =
                        if is_only_one { "case".to_owned() } else { format!("case-{}", place + 1) };
                    let start = Some(*facing).filter(|facing| facing.at() < graph.dart_count());
                    let about = format!("A case of {lemma}");
                    let world = NamedWorld::numbered(&name, &about, graph.clone(), start);
                    let head = capital(&label(place));
                    write!(
                        view.text,
                        "{head}, as a file for `toposlam draw` and `toposlam explore`:\n\n{}",
                        world_file::to_toml(&world)
                    )?;
                    view.worlds.push(world_file::to_json(&world));
                    worlds.push(world);
                }
                Exhibit::Walk { world: place, marker, pose, doors } => {
                    let world = worlds.get(*place);
                    let there = world.filter(|world| pose.at() < world.graph.dart_count());
                    let start = there.and_then(|world| Some((world, world.start?)));
                    if let Some((world, facing)) = start {
                        let (which, name) = (label(*place), marker.name());
                        writeln!(view.text, "A walk in {which}, marker {name}:\n")?;
                        let start = (*marker, facing, *pose);
                        let mut walk = show_walk(&mut view.text, world, start, doors)?;
                        walk["world"] = json!(place);
                        view.walks.push(walk);
                    } else {
                        let doors: Vec<_> = doors.iter().map(|door| door.0.to_string()).collect();
                        let value =
                            format!("from dart {} by the doors {}", pose.0, doors.join(","));
                        view.show_value("walk", &value)?;
                    }
                }
                Exhibit::Value { name, value } => view.show_value(name, value)?,
            }
        }
        Ok(view)
    }

    fn show_value(&mut self, name: &str, value: &str) -> io::Result<()> {
        self.values.push(json!({ "name": name, "value": value }));
        print_hanging(&mut self.text, &format!("{name}: "), value)
    }
}

/// Prints a walk through doors as far as it is possible, and returns it as JSON.
fn show_walk(
    text: &mut Vec<u8>,
    world: &NamedWorld,
    (marker, facing, pose): (&'static dyn Marker, Dart, Dart),
    doors: &[Door],
) -> io::Result<Value> {
    let robot = GraphWorld::with_marker(&world.graph, marker, facing);
    let start = State { pose, ..robot.state() };
    let mut robot = robot.at(start);
    let (mut poses, mut percepts, mut rows) = (Vec::new(), Vec::new(), Vec::new());
    let mut labels =
        std::iter::once("start".to_owned()).chain(doors.iter().map(|d| d.0.to_string()));
    let mut left = doors.iter();
    let stopped = loop {
        let (pose, percept) = (world.state_text(&marker, robot.state()), robot.sensed());
        rows.push([labels.next().unwrap_or_default(), pose.clone(), percept.to_string()]);
        poses.push(pose);
        percepts.push(percept_json(percept));
        match left.next().map(|&door| robot.act(Action::Take(door))) {
            Some(Ok(())) => {}
            Some(Err(refused)) => break Some(refused.to_string()),
            None => break None,
        }
    };
    print_rows(text, ["door", "robot at", "perceives"], &rows)?;
    if let Some(why) = &stopped {
        print_hanging(text, "  stopped: ", why)?;
    }
    let doors: Vec<_> = doors.iter().map(|door| door.0).collect();
    Ok(json!({
        "marker": marker.name(), "doors": doors, "poses": poses, "percepts": percepts, "stopped": stopped,
    }))
}
