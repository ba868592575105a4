//! The algorithms and the search for indistinguishable worlds, compared with second implementations in
//! Python. The Python code shares no code with the Rust code, only the paper and descriptions.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::process::Command;

use serde_json::Value;
use toposlam::model::format::world_file;

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
fn agree(oracle: &[&str], check: &[&str]) {
    let script = format!("tests/oracle/{}", oracle[0]);
    if !python(&script) {
        return;
    }
    // -B: no files are left behind.
    let oracle = objects(Command::new("python3").args(["-B", &script]).args(&oracle[1..]));
    let check = [&["check", "--json"], check].concat();
    let ours = objects(Command::new(env!("CARGO_BIN_EXE_toposlam")).args(check));
    assert_eq!(oracle.len(), ours.len());
    for (oracle, ours) in oracle.iter().zip(&ours) {
        for (key, value) in oracle.as_object().unwrap() {
            assert_eq!(&ours[key], value, "{key}: {oracle} against {ours}");
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

/// The output of `counterexample` in the format of the oracle: `KIND m placed_worlds ambiguous` and
/// `KIND smallest M K`.
fn counterexamples(class: &str, edges: &str) -> String {
    let lines = objects(Command::new(env!("CARGO_BIN_EXE_toposlam")).args([
        "counterexample",
        "--json",
        "--class",
        class,
        "--edges",
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
