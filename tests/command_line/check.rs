//! `toposlam check`: the counts, the shards, files of worlds, the worst start, and Ctrl-C.

use std::fs;

use serde_json::Value;
use toposlam_model::format::plantri::{self, PlantriCode};

use super::{folder, objects, read_world, run, stderr, stdout, stdout_of, world_files};

fn numbers(lines: &[Value], key: &str) -> Vec<u64> {
    lines.iter().map(|line| line[key].as_u64().unwrap()).collect()
}

// paper: cost.moves
#[test]
fn every_start_of_every_world_with_up_to_4_edges_is_mapped() {
    let text = stdout_of(["check", "--json", "--edges", "1..=4"]);
    let lines = objects(&text);
    assert_eq!(numbers(&lines, "edges"), [1, 2, 3, 4]);
    assert_eq!(numbers(&lines, "worlds"), [2, 5, 20, 107]);
    assert_eq!(numbers(&lines, "starts"), [2, 10, 74, 706]);
    assert_eq!(numbers(&lines, "mapped"), [2, 10, 74, 706]);
    assert_eq!(numbers(&lines, "failed"), [0; 4]);
    assert_eq!(numbers(&lines, "moves_total"), [2, 23, 289, 4182]);
    assert_eq!(numbers(&lines, "moves_max"), [1, 3, 10, 21]);
    // By the second implementation in Python.
    assert_eq!(numbers(&lines, "certificate_total"), [2, 22, 266, 3625]);
    assert_eq!(numbers(&lines, "certificate_max"), [1, 3, 6, 10]);
    for line in &lines {
        assert_eq!(line["class"], "multigraph");
        assert_eq!(line["marker"], "directional");
        assert_eq!(line["holds"], true);
        assert!(line.get("shard").is_none() && line.get("failure").is_none(), "{line}");
    }
}

// paper: movable.place
#[test]
fn with_a_movable_marker_every_simple_world_is_mapped() {
    let lines = objects(&stdout_of(["check", "--json", "--edges", "1..=6", "--marker", "movable"]));
    assert_eq!(numbers(&lines, "starts"), [1, 2, 6, 23, 108, 596]);
    assert_eq!(numbers(&lines, "mapped"), [1, 2, 6, 23, 108, 596]);
    assert_eq!(numbers(&lines, "moves_total"), [1, 5, 27, 173, 1222, 9519]);
    assert_eq!(numbers(&lines, "moves_max"), [1, 3, 6, 15, 24, 36]);
    for line in &lines {
        assert_eq!((&line["class"], &line["marker"]), (&"simple".into(), &"movable".into()));
        assert_eq!(line["holds"], true);
    }
    // From the start with four vertices and 32 moves, not from the one with 36 moves.
    assert_eq!(lines[5]["largest_ratio"], 4.0 / 3.0);
    // Certificates are for the directional marker.
    assert!(lines.iter().all(|line| line.get("certificate_total").is_none()));
    for class in ["simple", "corridor", "planar"] {
        let table = stdout_of(["check", "--marker", "movable", "--class", class]);
        let title = format!("Place and back-link validation, movable marker, class {class}\n");
        assert!(table.starts_with(&title), "{table}");
        assert!(table.contains("  max/(m n)\n") && table.contains("\nholds: "), "{table}");
    }
}

#[test]
fn the_error_names_the_world_that_is_not_simple() {
    let folder = folder("check_movable");
    let graph_of = |name: &str| {
        let file = world_files().into_iter().find(|path| path.ends_with(name)).unwrap();
        read_world(&file).graph
    };
    let worlds = ["k4-plane.toml", "two-loops-torus.toml", "theta-plane.toml"].map(graph_of);
    let file = folder.join("three.ec");
    fs::write(&file, plantri::write(&worlds, PlantriCode::Edge).unwrap()).unwrap();
    let file = file.to_str().unwrap();
    let rejected = run(["check", "--marker", "movable", "--from", file]);
    assert_eq!(rejected.status.code(), Some(2));
    let message = stderr(&rejected);
    assert!(message.starts_with(&format!("error: {file}: world 2 has loops or")), "{message}");
    let lines = objects(&stdout_of(["check", "--json", "--from", file]));
    assert_eq!(lines.len(), 3);
}

#[test]
fn the_output_is_the_same_at_any_number_of_threads() {
    let with =
        |threads: &str| stdout_of(["check", "--json", "--edges", "1..=5", "--threads", threads]);
    assert_eq!(with("1"), with("2"));
    let table = |threads: &str| stdout_of(["check", "--edges", "1..=5", "--threads", threads]);
    assert_eq!(table("1"), table("2"));
}

#[test]
fn the_table_fits_80_columns() {
    for arguments in [["--edges", "7", "--shard", "1/64"], ["--marker", "movable", "--edges", "5"]]
    {
        let table = stdout_of([&["check"][..], &arguments].concat());
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    }
    let table = stdout_of(["check", "--edges", "6"]);
    assert!(table.contains(" mean/max moves  certificate  ratio\n"), "{table}");
    // The published figures.
    assert!(table.contains("         11.4/55       8.5/21   1.34\n"), "{table}");
}

#[test]
fn smaller_classes_are_parts_of_larger_ones() {
    let worlds = |class: &str| {
        let lines = objects(&stdout_of(["check", "--json", "--edges", "1..=6", "--class", class]));
        assert!(lines.iter().all(|line| line["class"] == class && line["holds"] == true));
        numbers(&lines, "worlds")
    };
    let [all, simple, corridor, planar] =
        ["multigraph", "simple", "corridor", "planar"].map(worlds);
    assert_eq!(all.last(), Some(&9436));
    for smaller in [&corridor, &planar] {
        assert!(smaller.iter().zip(&simple).all(|(some, more)| some <= more));
    }
    assert!(simple.iter().zip(&all).all(|(some, more)| some < more));
}

#[test]
fn two_shards_add_up_to_the_whole() {
    let check =
        |shard: &str| objects(&stdout_of(["check", "--json", "--edges", "4", "--shard", shard]));
    let (first, second, whole) = (check("1/2"), check("2/2"), check("1/1"));
    assert_eq!((&first[0]["shard"], &second[0]["shard"]), (&"1/2".into(), &"2/2".into()));
    for key in ["worlds", "starts", "mapped", "moves_total"] {
        let sum = numbers(&first, key)[0] + numbers(&second, key)[0];
        assert_eq!(sum, numbers(&whole, key)[0], "{key}");
    }
}

#[test]
fn an_empty_shard_never_holds() {
    let output = run(["check", "--json", "--edges", "1", "--shard", "5/5"]);
    assert_eq!(output.status.code(), Some(3));
    let lines = objects(&stdout(&output));
    assert_eq!((numbers(&lines, "starts"), &lines[0]["holds"]), (vec![0], &false.into()));
    let text = stdout(&run(["check", "--edges", "1", "--shard", "5/5"]));
    assert!(text.contains("incomplete: there is nothing to check"), "{text}");
}

#[test]
fn all_choices_count_states_and_runs() {
    let lines = objects(&stdout_of(["check", "--json", "--edges", "1..=4", "--choices", "all"]));
    assert_eq!(numbers(&lines, "states"), [4, 43, 725, 16471]);
    assert_eq!(numbers(&lines, "runs"), [3, 45, 1777, 502_371]);
    assert_eq!(numbers(&lines, "moves_least"), [1, 2, 3, 4]);
    assert_eq!(numbers(&lines, "moves_most"), [1, 4, 11, 22]);
    let given_up = run(["check", "--edges", "4", "--choices", "all", "--max-states", "9"]);
    assert_eq!(given_up.status.code(), Some(3));
    let text = stdout(&given_up);
    assert!(text.contains("have more states than --max-states"), "{text}");
}

#[test]
fn every_world_of_the_repository_is_mapped_from_everywhere() {
    for path in world_files() {
        let file = path.to_str().unwrap();
        let lines = objects(&stdout_of(["check", "--json", "--from", file]));
        let graph = read_world(&path).graph;
        assert_eq!(numbers(&lines, "edges"), [graph.edge_count() as u64], "{file}");
        assert_eq!(numbers(&lines, "worlds"), [1]);
        let starts = numbers(&lines, "starts")[0] as usize;
        assert!(starts >= 1 && graph.dart_count().is_multiple_of(starts), "{file}: {starts}");
    }
}

#[test]
fn worlds_in_plantris_codes_are_checked_by_size() {
    let folder = folder("check_plantri");
    let graph_of = |name: &str| {
        let file = world_files().into_iter().find(|path| path.ends_with(name)).unwrap();
        read_world(&file).graph
    };
    let worlds = ["k4-plane.toml", "cycle-3.toml", "k4-torus.toml"].map(graph_of);
    for (code, name) in [(PlantriCode::Planar, "three.pc"), (PlantriCode::Edge, "three.ec")] {
        let file = folder.join(name);
        fs::write(&file, plantri::write(&worlds, code).unwrap()).unwrap();
        let lines = objects(&stdout_of(["check", "--json", "--from", file.to_str().unwrap()]));
        assert_eq!(numbers(&lines, "edges"), [3, 6]);
        assert_eq!(numbers(&lines, "worlds"), [1, 2]);
        assert!(lines.iter().all(|line| line["holds"] == true));
    }
}

// paper: cost.moves
#[test]
fn the_worst_start_costs_the_same_in_explore() {
    let folder = folder("check_worst");
    for ending in ["toml", "json"] {
        let file = folder.join(format!("worst.{ending}"));
        let file = file.to_str().unwrap();
        let lines = objects(&stdout_of(["check", "--json", "--edges", "1..=4", "--worst", file]));
        let explored = objects(&stdout_of(["explore", "--json", file]));
        assert_eq!(explored[0]["moves"], lines[3]["moves_max"]);
        assert_eq!(explored[0]["edges"], 4);
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_check_prints_its_results_and_does_not_hold() {
    use std::{
        io::{BufRead, BufReader, Read},
        process::{Command, Stdio},
    };

    let mut check = super::toposlam();
    check.args(["check", "--json", "--edges", "3..=9"]);
    let mut check = check.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut out = BufReader::new(check.stdout.take().unwrap());
    // The first line shows that the check is running.
    let mut text = String::new();
    out.read_line(&mut text).unwrap();
    let killed = Command::new("kill").args(["-INT", &check.id().to_string()]).status().unwrap();
    assert!(killed.success());
    out.read_to_string(&mut text).unwrap();
    let output = check.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    let lines = objects(&text);
    let (last, before) = lines.split_last().unwrap();
    assert_eq!((&last["interrupted"], &last["holds"]), (&true.into(), &false.into()));
    assert!(before.iter().all(|line| line["holds"] == true));
    assert_eq!((&last["failed"], &last["starts"]), (&0.into(), &last["mapped"]));
}

#[cfg(not(feature = "cluster"))]
#[test]
fn the_error_of_a_build_for_one_machine_has_the_command_that_adds_clusters() {
    for command in ["check", "counterexample"] {
        let output = run([command, "--hosts", "hosts.txt", "--process", "0"]);
        assert_eq!(output.status.code(), Some(2));
        let error = stderr(&output);
        assert!(error.contains("cargo build --release --features cluster"), "{error}");
    }
}
