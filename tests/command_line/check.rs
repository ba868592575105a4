//! `toposlam check`: the counts, the shards, files of worlds, the worst start, and Ctrl-C.

use serde_json::{Value, json};
use toposlam_model::format::plantri::{self, PlantriCode};

use super::{Scratch, numbers, objects, read_world, stderr, world_files};

/// A column of numbers for each name.
fn columns(lines: &[Value], expected: &[(&str, &[u64])]) {
    for (key, column) in expected {
        assert_eq!(numbers(lines, key), *column, "{key}");
    }
}

// paper: cost.moves, movable.place
#[test]
fn every_start_of_small_worlds_is_mapped_at_the_known_cost() {
    let scratch = Scratch::new("check_counts");
    let lines = scratch.lines("check --edges 1..=4", 0);
    columns(
        &lines,
        &[
            ("edges", &[1, 2, 3, 4]),
            ("worlds", &[2, 5, 20, 107]),
            ("starts", &[2, 10, 74, 706]),
            ("mapped", &[2, 10, 74, 706]),
            ("failed", &[0; 4]),
            ("moves_total", &[2, 23, 289, 4182]),
            ("moves_max", &[1, 3, 10, 21]),
            // By the second implementation in Python.
            ("certificate_total", &[2, 22, 266, 3625]),
            ("certificate_max", &[1, 3, 6, 10]),
        ],
    );
    let row = json!({
        "class": "multigraph", "marker": "directional", "holds": true, "shard": null, "failure": null,
    });
    super::has(&lines.into(), &vec![row; 4].into(), "check");
    let lines = scratch.lines("check --edges 1..=6 --marker movable", 0);
    columns(
        &lines,
        &[
            ("starts", &[1, 2, 6, 23, 108, 596]),
            ("mapped", &[1, 2, 6, 23, 108, 596]),
            ("moves_total", &[1, 5, 27, 173, 1222, 9519]),
            ("moves_max", &[1, 3, 6, 15, 24, 36]),
        ],
    );
    // From the start with four vertices and 32 moves, not from the one with 36 moves.
    assert_eq!(lines[5]["largest_ratio"], 4.0 / 3.0);
    // Certificates are for the directional marker.
    let row = json!({
        "class": "simple", "marker": "movable", "holds": true, "certificate_total": null,
    });
    super::has(&lines.into(), &vec![row; 6].into(), "check --marker movable");
    let lines = scratch.lines("check --edges 1..=4 --choices all", 0);
    columns(
        &lines,
        &[
            ("states", &[4, 43, 725, 16471]),
            ("runs", &[3, 45, 1777, 502_371]),
            ("moves_least", &[1, 2, 3, 4]),
            ("moves_most", &[1, 4, 11, 22]),
        ],
    );
    let given_up = scratch.out("check --edges 4 --choices all --max-states 9", 3);
    assert!(given_up.contains("have more states than --max-states"), "{given_up}");
}

#[test]
fn the_output_is_the_same_at_any_number_of_threads() {
    let scratch = Scratch::new("check_threads");
    for format in ["", "--json"] {
        let with =
            |threads| scratch.out(&format!("check --edges 1..=5 --threads {threads} {format}"), 0);
        assert_eq!(with(1), with(2));
    }
}

#[test]
fn smaller_classes_are_parts_of_larger_ones() {
    let scratch = Scratch::new("check_classes");
    let worlds = |class: &str| {
        let lines = scratch.lines(&format!("check --edges 1..=6 --class {class}"), 0);
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
fn an_empty_shard_never_holds() {
    let empty = json!([{ "starts": 0, "holds": false }]);
    Scratch::new("check_shards").facts(&[("check --edges 1 --shard 5/5", 3, empty)]);
}

#[test]
fn every_world_of_the_repository_is_mapped_from_everywhere() {
    let scratch = Scratch::new("check_worlds");
    for path in world_files() {
        let file = path.to_str().unwrap();
        let graph = read_world(&path).graph;
        let line = scratch.last(&format!("check --from {file}"), 0);
        super::has(&line, &json!({ "edges": graph.edge_count(), "worlds": 1 }), file);
        let starts = line["starts"].as_u64().unwrap() as usize;
        assert!(starts >= 1 && graph.dart_count().is_multiple_of(starts), "{file}: {starts}");
    }
}

#[test]
fn worlds_in_plantris_codes_are_checked_by_size() {
    let scratch = Scratch::new("check_plantri");
    let write = |worlds: [&str; 3], code, name: &str| {
        let graph_of = |name: &str| read_world(&scratch.path("worlds").join(name)).graph;
        let worlds = worlds.map(graph_of);
        scratch.write(name, plantri::write(&worlds, code).unwrap());
    };
    let three = ["k4-plane.toml", "cycle-3.toml", "k4-torus.toml"];
    write(three, PlantriCode::Planar, "three.pc");
    write(three, PlantriCode::Edge, "three.ec");
    let sizes = json!([
        { "edges": 3, "worlds": 1, "holds": true }, { "edges": 6, "worlds": 2, "holds": true },
    ]);
    scratch
        .facts(&[("check --from three.pc", 0, sizes.clone()), ("check --from three.ec", 0, sizes)]);
    // The error names the world that is not simple.
    let three = ["k4-plane.toml", "two-loops-torus.toml", "theta-plane.toml"];
    write(three, PlantriCode::Edge, "loops.ec");
    assert_eq!(scratch.lines("check --from loops.ec", 0).len(), 3);
    let message = scratch.error("check --marker movable --from loops.ec");
    assert!(message.starts_with("error: loops.ec: world 2 has loops or"), "{message}");
}

// paper: cost.moves
#[test]
fn the_worst_start_costs_the_same_in_explore() {
    let scratch = Scratch::new("check_worst");
    for file in ["worst.toml", "worst.json"] {
        let lines = scratch.lines(&format!("check --edges 1..=4 --worst {file}"), 0);
        let moves = &lines[3]["moves_max"];
        scratch.facts(&[(&format!("explore {file}"), 0, json!({ "moves": moves, "edges": 4 }))]);
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_check_prints_its_results_and_does_not_hold() {
    // The first line shows that the check is running.
    let output = super::interrupted_after_a_line("check --json --edges 3..=9");
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    let lines = objects(&super::stdout(&output));
    let (last, before) = lines.split_last().unwrap();
    super::has(last, &json!({ "interrupted": true, "holds": false, "failed": 0 }), "check");
    assert!(before.iter().all(|line| line["holds"] == true));
    assert_eq!(last["starts"], last["mapped"]);
}

#[cfg(not(feature = "cluster"))]
#[test]
fn the_error_of_a_build_for_one_machine_has_the_command_that_adds_clusters() {
    let scratch = Scratch::new("check_hosts");
    for command in ["check", "counterexample"] {
        let error = scratch.error(&format!("{command} --hosts hosts.txt --process 0"));
        assert!(error.contains("cargo build --release --features cluster"), "{error}");
    }
}
