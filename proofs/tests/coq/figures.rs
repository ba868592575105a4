//! The worlds of `Figures.v` are those of the world files.

use std::{fs, path::Path, process::Command};

use toposlam_model::{embedded_graph::EmbeddedGraph, format::world_file};

use super::{compiled, printed, source};

/// The lists of `Figures.v`, without their ending, and the world files.
const WORLDS: [(&str, &str); 12] = [
    ("cycle_3", "cycle-3"),
    ("cycle_4", "cycle-4"),
    ("figure_1a", "figure-1a"),
    ("figure_1b", "figure-1b"),
    ("smallest_a", "atlas/undirected-simple-1"),
    ("smallest_b", "atlas/undirected-simple-2"),
    ("corridor_a", "atlas/undirected-corridor-1"),
    ("corridor_b", "atlas/undirected-corridor-2"),
    ("planar_a", "atlas/undirected-planar-1"),
    ("planar_b", "atlas/undirected-planar-2"),
    ("edge_a", "atlas/undirected-edge-corridor-1"),
    ("edge_b", "atlas/undirected-edge-corridor-2"),
];

/// The neighbours of each vertex, as Coq prints them: `= [:: [:: 1; 2]; [:: 2; 0]; [:: 0; 1]]`.
fn lists(said: &str) -> Vec<(String, Vec<String>)> {
    let list = |(vertex, text): (usize, &str)| {
        let numbers = text.split(|c: char| !c.is_ascii_digit()).filter(|number| !number.is_empty());
        (vertex.to_string(), numbers.map(str::to_owned).collect())
    };
    let (value, _) = said.split_once(" : ").unwrap();
    value.split("[::").skip(2).enumerate().map(list).collect()
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn the_worlds_of_the_figures_are_those_of_the_world_files() {
    let compiled = compiled();
    let figures = fs::read_to_string(source("Figures.v")).unwrap();
    assert_eq!(figures.matches("_file : world_file :=").count(), WORLDS.len());
    let starts = figures.lines().filter(|line| line.contains(": start := start_at "));
    let facing = starts.filter(|line| line.contains("(erefl : (0, 1) \\in ")).count();
    assert_eq!(facing, WORLDS.len());

    let folder = compiled.copy("figures");
    let imports =
        "From mathcomp Require Import all_ssreflect.\nFrom toposlam Require Import Figures.\n";
    let asked =
        WORLDS.map(|(name, _)| format!("Redirect \"{name}\" Eval vm_compute in {name}_file.\n"));
    let asked = imports.to_owned() + &asked.concat();
    fs::write(folder.join("lists.v"), asked).unwrap();
    printed(
        Command::new("coqc").args(["-q", "-Q", ".", "toposlam", "lists.v"]).current_dir(&folder),
    );
    for (name, file) in WORLDS {
        let said = fs::read_to_string(folder.join(name).with_extension("out")).unwrap();
        let graph = EmbeddedGraph::from_neighbour_lists(&lists(&said)).unwrap();
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../worlds/{file}.toml"));
        let world = world_file::read(&fs::read(path).unwrap()).unwrap();
        assert!(world.graph == graph, "{name} is not worlds/{file}.toml");
        let ends = world.start.map(|facing| [facing, graph.opposite(facing)]);
        let vertices = ends.map(|ends| ends.map(|dart| graph.vertex(dart).0));
        assert_eq!(vertices, Some([0, 1]), "{name}");
    }
}
