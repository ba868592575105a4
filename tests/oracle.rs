//! The algorithms and the search for indistinguishable worlds, compared with second implementations in
//! Python. The Python code shares no code with the Rust code, only the paper and descriptions.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{collections::HashMap, process::Command};

use serde_json::{Value, json};
use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    folding::{FoldedTrail, certificate_length, fold},
    format::world_file,
    percept::{Door, Percept, Sighting},
};

/// The JSON objects that a command prints.
fn objects(command: &mut Command) -> Vec<Value> {
    let output = command.current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Whether Python can run a second implementation. Prints a message if not.
fn python(program: &str) -> bool {
    let found = Command::new("python3").arg("--version").output().is_ok();
    if !found {
        eprintln!("skipped: there is no python3 to run {program}");
    }
    found
}

/// Asserts that every key that the oracle prints has the same value in the output of `check`.
fn agree(program: &[&str], check: &[&str]) {
    let Some(expected) = oracle(program) else { return };
    let check = [&["check", "--json"], check].concat();
    let ours = objects(Command::new(env!("CARGO_BIN_EXE_toposlam")).args(check));
    assert_eq!(expected.len(), ours.len());
    for (expected, ours) in expected.iter().zip(&ours) {
        for (key, value) in expected.as_object().unwrap() {
            assert_eq!(&ours[key], value, "{key}: {expected} against {ours}");
        }
    }
}

#[test]
fn the_default_choices_cost_the_same() {
    agree(&["algorithm1.py", "default", "5"], &["--edges", "1..=5"]);
}

#[test]
fn all_choices_have_the_same_states_runs_and_costs() {
    agree(&["algorithm1.py", "all", "3"], &["--edges", "1..=3", "--choices", "all"]);
}

// paper: movable.place, movable.back-link
#[test]
fn with_a_movable_marker_the_moves_are_the_same() {
    agree(&["movable_marker.py", "6"], &["--edges", "1..=6", "--marker", "movable"]);
}

/// The objects that a second implementation prints; `None` if there is no Python.
fn oracle(program: &[&str]) -> Option<Vec<Value>> {
    let script = format!("tests/oracle/{}", program[0]);
    // -B: no files are left behind.
    python(&script)
        .then(|| objects(Command::new("python3").args(["-B", &script]).args(&program[1..])))
}

/// A list of numbers.
fn numbers(list: &Value) -> Vec<u32> {
    list.as_array().unwrap().iter().map(|number| number.as_u64().unwrap() as u32).collect()
}

/// A folded trail as a JSON object: its darts are numbered breadth first from where the walk began.
fn numbered(trail: &FoldedTrail) -> Value {
    let (mut order, mut degrees) = (Vec::new(), Vec::new());
    let mut number: HashMap<Dart, usize> = HashMap::new();
    let mut reach = |pose: Dart, order: &mut Vec<Dart>| {
        if !number.contains_key(&pose) {
            degrees.push(trail.degree(pose));
            for door in 0..trail.degree(pose) {
                let dart = trail.behind(pose, Door(door));
                number.insert(dart, order.len());
                order.push(dart);
            }
        }
    };
    reach(trail.root_of(Dart(0)), &mut order);
    let mut next = 0;
    while let Some(&dart) = order.get(next) {
        next += 1;
        if let Some(far) = trail.opposite(dart) {
            reach(far, &mut order);
        }
    }
    let opposite: Vec<_> =
        order.iter().map(|&dart| trail.opposite(dart).map(|far| number[&far])).collect();
    json!({
        "degrees": degrees,
        "opposite": opposite,
        "marker": trail.marker().map(|dart| number[&dart]),
        "pose": number[&trail.pose()],
        "open": trail.open_count(),
    })
}

#[test]
fn the_same_walks_fold_to_the_same_graphs() {
    let Some(walks) = oracle(&["folding.py", "walks", "600"]) else { return };
    let mut kinds = [0, 0, 0];
    for walk in walks {
        let percept = |percept: &Value| {
            let door = percept[1].as_u64().map(|door| Door(door as u32));
            let sighting = door.map_or(Sighting::Nothing, Sighting::Pointing);
            Percept { degree: percept[0].as_u64().unwrap() as u32, sighting }
        };
        let percepts: Vec<_> = walk["percepts"].as_array().unwrap().iter().map(percept).collect();
        let doors: Vec<_> = numbers(&walk["doors"]).into_iter().map(Door).collect();
        let folded = fold(&percepts, &doors);
        kinds[folded.as_ref().map_or(2, |trail| usize::from(trail.is_complete()))] += 1;
        let ours = folded.as_ref().map_or(Value::Null, numbered);
        assert_eq!(ours, walk["folded"], "{walk}");
    }
    // Open and complete folded trails, and contradictions.
    assert!(kinds.iter().all(|&count| count > 50), "{kinds:?}");
}

#[test]
fn no_walk_that_determines_its_world_is_shorter_than_the_certificate() {
    let Some(starts) = oracle(&["folding.py", "shortest", "3"]) else { return };
    assert_eq!(starts.len(), 2 + 10 + 74);
    for start in starts {
        let opposite = numbers(&start["opposite"]);
        let mut clockwise: Vec<u32> = (1..=opposite.len() as u32).collect();
        let mut first = 0;
        for degree in numbers(&start["degrees"]) {
            clockwise[(first + degree - 1) as usize] = first;
            first += degree;
        }
        let (graph, number) = EmbeddedGraph::from_permutations(&opposite, &clockwise).unwrap();
        assert_eq!(start["certificate"], certificate_length(&graph, number[0]), "{start}");
    }
}

#[test]
fn all_certificates_together_are_as_long() {
    agree(&["folding.py", "certificates", "5"], &["--edges", "1..=5"]);
}

/// The output of `counterexample` in the format of the oracle: `KIND m placed_worlds ambiguous` and
/// `KIND smallest M K`.
fn counterexamples(class: &str, edges: &str) -> String {
    let lines = objects(Command::new(env!("CARGO_BIN_EXE_toposlam")).args([
        "counterexample",
        "--json",
        "--class",
        class,
        "--max-edges",
        edges,
    ]));
    let found = lines.iter().map(|line| {
        let marker = line["marker"].as_str().unwrap();
        let found = match line["smallest"]["worlds"].as_array() {
            Some(worlds) => {
                let size = |world: &Value| {
                    let world = world_file::read(world.to_string().as_bytes()).unwrap();
                    world.graph.edge_count()
                };
                format!("smallest {} {}", size(&worlds[1]), size(&worlds[0]))
            }
            None if line.get("smallest").is_some() => "smallest none".to_owned(),
            None => format!("{} {} {}", line["edges"], line["placed_worlds"], line["ambiguous"]),
        };
        format!("{marker} {found}\n")
    });
    found.collect()
}

#[test]
fn the_same_worlds_are_counted_and_indistinguishable() {
    let program = "tests/oracle/ambiguity.py";
    if !python(program) {
        return;
    }
    for (class, edges) in [("multigraph", "4"), ("simple", "6"), ("corridor", "7"), ("planar", "6")]
    {
        let oracle = Command::new("python3")
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .args(["-B", program, class, edges])
            .output()
            .unwrap();
        assert!(oracle.status.success(), "{oracle:?}");
        let oracle = String::from_utf8(oracle.stdout).unwrap();
        assert!(oracle.lines().count() > 8 * 4);
        assert_eq!(counterexamples(class, edges), oracle, "{class}");
    }
}
