//! The game in a browser, and its judge against that of the specification. Sections 2.1 and 2.3.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    fmt::Write as _,
    fs,
    ops::ControlFlow,
    path::{Path, PathBuf},
    process::Command,
};

use serde_json::{Value, json};
use toposlam_model::{
    check::judge_map,
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, Enumeration},
    folding::fold,
    isomorphism::Candidate,
    mapping::{ExploredMap, Flaw},
    percept::{Door, Percept, Sighting},
    world::{GraphWorld, World},
};

use crate::browser;

fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("play");
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Writes the page of a world, or of a random one.
fn write_page(name: &str, arguments: &[&str]) -> PathBuf {
    let file = folder().join(format!("play-{name}.html"));
    let output = Command::new(env!("CARGO_BIN_EXE_toposlam"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .arg("play")
        .args(arguments)
        .arg("--out")
        .arg(&file)
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    file
}

/// A place with two loops, at the end of an edge from the marker.
const LOOPS: &str = "[doors]\ns = [\"e\"]\na = [\"e\", \"l\", \"l\", \"m\", \"m\"]\n\n\
                     [start]\nat = \"s\"\nfacing = \"e\"\n";

#[test]
fn a_game_with_true_claims_is_won_and_other_maps_are_judged() {
    let world = folder().join("loops.toml");
    fs::write(&world, LOOPS).unwrap();
    let loops = write_page("loops", &[world.to_str().unwrap()]);
    let games: [(&str, &[&str]); 6] = [
        ("shape-8", &["worlds/shape-8.toml"]),
        ("figure-1b", &["worlds/figure-1b.toml"]),
        ("building-12", &["worlds/building-12.toml", "--start", "west:north-west"]),
        ("two-loops", &["worlds/two-loops-torus.toml"]),
        ("corridor", &["--random", "--edges", "8", "--seed", "3"]),
        ("multigraph", &["--random", "--class", "multigraph", "--edges", "6"]),
    ];
    let games =
        games.map(|(name, arguments)| format!("right={}", write_page(name, arguments).display()));
    let pages = [&games[..], &[format!("loops={}", loops.display())]].concat();
    browser::open("play_page.mjs", &pages);
}

/// Every start with up to this number of edges.
fn starts(edges: usize) -> Vec<EmbeddedGraph> {
    let mut starts = Vec::new();
    for edges in 1..=edges {
        let each = Enumeration::new(Each::Start, Class::Multigraph, edges).unwrap();
        let _ = each.for_each(&mut |found| {
            starts.push(found.graph.clone());
            ControlFlow::Continue(())
        });
    }
    starts
}

fn end(graph: &EmbeddedGraph, dart: Dart) -> Value {
    json!([graph.vertex(dart).at(), graph.index(dart)])
}

fn lists(graph: &EmbeddedGraph) -> Value {
    let ends = |vertex| graph.darts_of(vertex).map(|dart| end(graph, graph.opposite(dart)));
    graph.vertices().map(|vertex| ends(vertex).collect::<Value>()).collect()
}

/// Every start with up to 3 edges as a map of every other one, with the robot anywhere on the map.
fn judged_maps() -> (String, Vec<&'static str>) {
    let (mut cases, mut expected) = (String::new(), Vec::new());
    let starts = starts(3);
    assert_eq!(starts.len(), 2 + 10 + 74);
    let mut candidate = Candidate::default();
    for (number, world) in starts.iter().enumerate() {
        let truth = Dart((number % world.dart_count()) as u32);
        for map in &starts {
            for pose in map.darts() {
                let case = json!({
                    "map": lists(map), "pose": end(map, pose),
                    "world": lists(world), "start": end(world, Dart(0)), "truth": end(world, truth),
                });
                writeln!(cases, "{case}").unwrap();
                let explored =
                    ExploredMap { graph: std::borrow::Cow::Borrowed(map), facing: Dart(0), pose };
                expected.push(
                    match judge_map(&explored, (world, Dart(0)), truth, &mut candidate) {
                        Ok(_) => "right",
                        Err(Flaw::WrongPose { .. }) => "pose",
                        Err(_) => "map",
                    },
                );
            }
        }
    }
    (cases, expected)
}

/// Walks in every start with up to 3 edges, and the number of open darts of their folded trails.
fn folded_walks() -> (String, Vec<usize>) {
    let (mut cases, mut expected) = (String::new(), Vec::new());
    let percept_json = |percept: Percept| {
        let marker = match percept.sighting {
            Sighting::Pointing(door) => json!(door.0),
            _ => Value::Null,
        };
        json!({ "degree": percept.degree, "marker": marker })
    };
    let mut number: u32 = 1;
    for graph in starts(3) {
        for length in 1..=9 {
            let mut world = GraphWorld::new(&graph, Dart(0));
            let (mut percepts, mut doors) = (vec![world.sensed()], Vec::new());
            for _ in 0..length {
                number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let door = Door((number >> 16) % world.sensed().degree);
                world.traverse(door).unwrap();
                doors.push(door);
                percepts.push(world.sensed());
            }
            expected.push(fold(&percepts, &doors).unwrap().open_darts().count());
            let percepts: Vec<_> = percepts.into_iter().map(percept_json).collect();
            let doors: Vec<_> = doors.into_iter().map(|door| door.0).collect();
            writeln!(cases, "{}", json!({ "percepts": percepts, "doors": doors })).unwrap();
        }
    }
    (cases, expected)
}

#[test]
fn the_judge_of_the_game_agrees_with_the_specification() {
    let (maps, judged) = judged_maps();
    let (walks, open) = folded_walks();
    let file = folder().join("cases.jsonl");
    fs::write(&file, maps + &walks).unwrap();
    let scripts = Path::new(env!("CARGO_MANIFEST_DIR")).join("draw/src/page/browser");
    let arguments = [scripts.as_os_str(), file.as_os_str()];
    let Some(printed) = browser::run_in_node("play_judge.mjs", &arguments) else { return };
    let lines: Vec<_> = printed.lines().collect();
    assert_eq!(lines.len(), judged.len() + open.len());
    let (of_maps, of_walks) = lines.split_at(judged.len());
    for (case, (line, expected)) in of_maps.iter().zip(&judged).enumerate() {
        let found = if ["right", "pose"].contains(line) { line } else { &"map" };
        assert_eq!(found, expected, "case {case}: {line}");
    }
    for kind in ["right", "pose", "degree", "several", "twice"] {
        assert!(of_maps.contains(&kind), "no map is {kind}");
    }
    let of_walks: Vec<usize> = of_walks.iter().map(|line| line.parse().unwrap()).collect();
    assert_eq!(of_walks, open);
    assert!(open.contains(&0) && open.iter().any(|&open| open > 0));
}
