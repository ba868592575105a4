//! What the paper's own worlds cost, from every start: the table in `worlds/README.md`.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{fs, path::Path};

use toposlam_model::{
    check::{Algorithm, Algorithm1, DEFAULT_STATE_BUDGET, every_way},
    embedded_graph::Dart,
    format::{named_world::NamedWorld, world_file},
    mapping::Exploration,
    world::GraphWorld,
};

fn worlds(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../worlds");
    fs::read_to_string(folder.join(name)).unwrap()
}

fn moves(world: &NamedWorld, facing: Dart) -> u64 {
    let mut exploration = Exploration::new(world.graph.dart_count());
    let mut robot = GraphWorld::new(&world.graph, facing);
    Algorithm1.run(&mut robot, &mut exploration, &mut ()).unwrap();
    exploration.moves()
}

/// A row for each start: its moves, the runs with free choices and the least and most moves among
/// them, and whether the paper's cost is among them.
fn rows(name: &str, paper: u64) -> Vec<String> {
    let world = world_file::read(worlds(&format!("{name}.toml")).as_bytes()).unwrap();
    world
        .graph
        .darts()
        .map(|facing| {
            let ways =
                every_way(&Algorithm1, &world.graph, facing, DEFAULT_STATE_BUDGET, &()).unwrap();
            let (least, most) = ways.costs.min().zip(ways.costs.max()).unwrap();
            let among = if ways.costs.contains(paper) { "yes" } else { "no" };
            let (start, moves) = (world.start_text(facing), moves(&world, facing));
            let runs = ways.runs;
            format!(
                "| {name} | {start} | {moves} | {runs} | {least} to {most} | {paper}: {among} |"
            )
        })
        .collect()
}

// paper: cost.shape-6, cost.shape-8
#[test]
fn the_table_of_costs_is_true() {
    let table: Vec<_> = [rows("shape-6", 9), rows("shape-8", 14)].concat();
    let readme = worlds("README.md");
    let printed: Vec<_> = readme.lines().filter(|line| line.starts_with("| shape-")).collect();
    assert_eq!(printed, table, "\n{}", table.join("\n"));
    assert!(table.iter().any(|row| row.contains("| 9: yes |")));
    assert!(table.iter().any(|row| row.contains("| 14: yes |")));
}
