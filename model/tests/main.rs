//! Tests of the specification through its public interface.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use std::{fs, path::Path};

use toposlam_model::{
    check::{Check, RunChoices, Shard, Tally},
    embedded_graph::EmbeddedGraph,
    enumerate::{Class, Each, Enumeration},
    format::{named_world::NamedWorld, world_file},
    mapping::Explorer,
    percept::{Door, Percept, Sighting},
};

/// Every start of a class with a number of edges. Its facing dart is dart 0.
fn starts(class: Class, edges: usize) -> Vec<EmbeddedGraph> {
    Enumeration::new(Each::Start, class, edges).unwrap().graphs().collect()
}

/// The text of a file of the workspace.
fn text_of(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)).unwrap()
}

/// A world of `worlds/`.
fn world(name: &str) -> NamedWorld {
    let text = text_of(&format!("worlds/{name}.toml"));
    world_file::read(text.as_bytes()).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The names of all worlds, in order.
fn world_names() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../worlds");
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
    let names = files.filter_map(|file| Some(file.to_str()?.strip_suffix(".toml")?.to_owned()));
    let mut names: Vec<_> = names.collect();
    names.sort();
    names
}

/// The check of explorers with their default choices.
fn checked<E: Explorer>(class: Class, edges: usize, new: impl Fn() -> E + Sync) -> Tally {
    Check::new(class, edges, Shard::WHOLE).unwrap().run(new, RunChoices::Default, &())
}

/// A percept without a marker.
fn plain(degree: u32) -> Percept {
    Percept { degree, sighting: Sighting::Nothing }
}

/// A percept with a directional marker that points along a door.
fn marked(degree: u32, door: u32) -> Percept {
    Percept { degree, sighting: Sighting::Pointing(Door(door)) }
}

mod aids;
mod ambiguity;
mod check;
mod contradictions;
mod costs;
mod counts;
mod explorers;
mod false_each_time;
mod figure_1;
mod folding;
mod folding_senses;
mod lazy;
mod markers;
mod movable;
mod moving;
mod optimum;
mod perception;
mod random_buildings;
mod senses;
mod stories;
mod verdicts;
mod worlds;
