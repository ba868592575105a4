//! What worlds cost, with either algorithm: the tables in `worlds/README.md`.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{fs, path::Path};

use toposlam_model::{
    check::{
        Algorithm, Algorithm1, DEFAULT_STATE_BUDGET, MovableMarker, RunState, Shard, Sweep, Tally,
        every_way,
    },
    embedded_graph::Dart,
    enumerate::Class,
    format::{named_world::NamedWorld, world_file},
    world::GraphWorld,
};

fn worlds(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../worlds");
    fs::read_to_string(folder.join(name)).unwrap()
}

/// The rows of the table that stands under a heading.
fn printed(heading: &str) -> Vec<String> {
    let readme = worlds("README.md");
    let (_, section) = readme.split_once(&format!("\n## {heading}\n")).unwrap();
    let section = section.split("\n## ").next().unwrap();
    let rows = section.lines().filter(|line| line.starts_with('|'));
    // After its head.
    rows.skip(2).map(str::to_owned).collect()
}

fn world(name: &str) -> NamedWorld {
    world_file::read(worlds(&format!("{name}.toml")).as_bytes()).unwrap()
}

fn moves<A: Algorithm>(algorithm: &A, world: &NamedWorld, facing: Dart) -> u64 {
    let mut state = A::State::new(world.graph.dart_count());
    let mut robot = GraphWorld::with_marker(&world.graph, A::Marker::default(), facing);
    algorithm.run(&mut robot, &mut state, &mut ()).unwrap();
    state.journey().moves()
}

/// A row for each start: its moves, the runs with free choices and the least and most moves among
/// them, and whether the paper's cost is among them.
fn rows(name: &str, paper: u64) -> Vec<String> {
    let world = world(name);
    world
        .graph
        .darts()
        .map(|facing| {
            let ways =
                every_way(&Algorithm1, &world.graph, facing, DEFAULT_STATE_BUDGET, &()).unwrap();
            let (least, most) = ways.costs.min().zip(ways.costs.max()).unwrap();
            let among = if ways.costs.contains(paper) { "yes" } else { "no" };
            let (start, moves) = (world.start_text(facing), moves(&Algorithm1, &world, facing));
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
    let printed = printed("What the paper's own worlds cost");
    assert_eq!(printed, table, "\n{}", table.join("\n"));
    assert!(table.iter().any(|row| row.contains("| 9: yes |")));
    assert!(table.iter().any(|row| row.contains("| 14: yes |")));
}

/// A row for each world file without loops and parallel edges, from the file's own start.
fn own_starts() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../worlds");
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
    let names = files.filter_map(|file| Some(file.to_str()?.strip_suffix(".toml")?.to_owned()));
    let mut names: Vec<_> = names.collect();
    names.sort();
    let worlds = names.iter().map(|name| world(name)).filter(|world| world.graph.is_simple());
    let rows = worlds.map(|world| {
        let facing = world.start.unwrap();
        format!(
            "| {} | {} | {} | {} | {} | {} |",
            world.name,
            world.start_text(facing),
            world.graph.vertex_count(),
            world.graph.edge_count(),
            moves(&Algorithm1, &world, facing),
            moves(&MovableMarker, &world, facing),
        )
    });
    rows.collect()
}

#[test]
fn the_table_of_both_costs_is_true() {
    let table = own_starts();
    let printed = printed("What a movable marker costs");
    assert!(table.len() >= 14);
    assert_eq!(printed, table, "\n{}", table.join("\n"));
}

fn tally(class: Class, edges: usize, algorithm: &impl Algorithm) -> Tally {
    let tally = Sweep::new(class, edges, Shard::WHOLE).unwrap().run(algorithm, &());
    assert_eq!(tally.failure, None);
    tally
}

/// A row for each number of edges: the mean and the most moves of both algorithms.
fn every_start(class: Class, up_to: usize) -> Vec<String> {
    let rows = (1..=up_to).map(|edges| {
        let tallies = [tally(class, edges, &Algorithm1), tally(class, edges, &MovableMarker)];
        let [one, other] = tallies.each_ref().map(|tally| {
            let mean = tally.moves_total as f64 / tally.starts as f64;
            format!("{mean:.1} | {}", tally.moves_max())
        });
        format!("| {class} | {edges} | {} | {one} | {other} |", tallies[0].starts)
    });
    rows.collect()
}

#[test]
fn the_table_of_every_small_start_is_true() {
    let classes = [(Class::Simple, 8), (Class::Corridor, 10), (Class::Planar, 8)];
    let table = classes.map(|(class, up_to)| every_start(class, up_to)).concat();
    let printed = printed("What every small start costs");
    assert_eq!(printed, table, "\n{}", table.join("\n"));
}
