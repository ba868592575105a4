//! `--algorithm folding`: the folding explorer in each command that maps.

use serde_json::Value;
use toposlam_model::{
    format::world_file,
    isomorphism::Bijection,
    percept::Door,
    world::{GraphWorld, World},
};

use super::{folder, objects, read_world, run, stderr, stdout, stdout_of, world_files};

const FOLDING: [&str; 2] = ["--algorithm", "folding"];

#[test]
fn the_folding_explorer_maps_every_world_file_in_few_moves() {
    let mut moves = [0; 2];
    for path in world_files() {
        let file = path.to_str().unwrap();
        let of = |more: &[&str]| {
            objects(&stdout_of([&["explore", "--json", file], more].concat())).remove(0)
        };
        let (line, other) = (of(&FOLDING), of(&[]));
        assert_eq!((&line["algorithm"], &other["algorithm"]), (&"folding".into(), &Value::Null));
        assert_eq!(line["isomorphic"], true, "{file}");
        let world = read_world(&path);
        let start = world.start.unwrap();
        let mut robot = GraphWorld::new(&world.graph, start);
        for door in line["doors"].as_array().unwrap() {
            robot.traverse(Door(door.as_u64().unwrap() as u32)).unwrap();
        }
        assert_eq!(line["moves"], robot.moves());
        let map = world_file::read(line["map"].to_string().as_bytes()).unwrap();
        let bijection =
            Bijection::of_starts((&map.graph, map.start.unwrap()), (&world.graph, start));
        assert!(bijection.verify(&map.graph, &world.graph), "{file}");
        for (sum, line) in moves.iter_mut().zip([line, other]) {
            *sum += line["moves"].as_u64().unwrap();
        }
    }
    assert!(2 * moves[0] < moves[1], "{moves:?}");
}

#[test]
fn the_story_has_each_test_and_each_folding_of_the_trail() {
    let story = "\
World shape-8. The robot starts at nw, with its back to the door to w.
It puts its marker down here, at vertex v0 of the map. It senses 2 doors, marker
along door 0.

Round 1: the robot takes v0.0 (1 move) and senses 3 doors.
  So v0.0 leads to a new vertex, v1.
  Known: 2 vertices, 1 edge. Unexplored: 3 darts.

Round 2: the robot takes v1.1 (1 move) and senses 3 doors.

Round 3: may v1.1 and v1.2 be the two ends of one edge? If so, a walk of 1 move
         leads to the marker.
  Candidate v1.2: rejected on the way: expected 2 doors, marker along door 0,
    sensed 2 doors, no marker (1 move).
  So v1.1 leads to a new vertex, v2.
  Known: 3 vertices, 2 edges. Unexplored: 4 darts.
  So v2.1 leads to a new vertex, v3.
  Known: 4 vertices, 3 edges. Unexplored: 4 darts.

Round 4: the robot takes v3.1 (1 move) and senses 2 doors, marker along door 1.
  The marker is here: the trail folds from 5 vertices to 4.
  So v0.1 and v3.1 are the two ends of one edge.
  Known: 4 vertices, 4 edges. Unexplored: 2 darts.

Round 5: the robot takes v1.2 (2 moves) and senses 2 doors.
  So v1.2 leads to a new vertex, v4.
  Known: 5 vertices, 5 edges. Unexplored: 2 darts.

Round 6: the robot takes v4.1 (1 move) and senses 2 doors.
  So v4.1 leads to a new vertex, v5.
  Known: 6 vertices, 6 edges. Unexplored: 2 darts.

Round 7: the robot takes v5.1 (1 move) and senses 3 doors.

Round 8: may v5.1 and v2.2 be the two ends of one edge? If so, a walk of 2 moves
         leads to the marker.
  Candidate v2.2: confirmed, the walk leads to the marker (2 moves).
  The marker is here: the trail folds from 9 vertices to 6.
  So v2.2 and v5.1 are the two ends of one edge.
  Known: 6 vertices, 7 edges. Unexplored: 0 darts.

The map is complete after 10 moves: 6 vertices, 7 edges. A run in this world
takes at least 10 and at most 1,744 moves.
It is isomorphic to the world:
  v0 = nw, v1 = w, v2 = e, v3 = ne, v4 = sw, v5 = se
The robot is where it believes it is: at v0, entered by dart v0.0.
";
    let found = stdout_of([&["explore", "worlds/shape-8.toml"], &FOLDING[..]].concat());
    assert_eq!(found, story);
    assert!(found.lines().all(|line| line.len() <= 80), "{found}");
}

#[test]
fn the_summary_counts_tests_and_foldings() {
    let words = ["explore", "worlds/building-25.toml", "--summary"];
    let text = stdout_of([&words[..], &FOLDING].concat());
    assert!(text.contains("  times that the trail was folded"), "{text}");
    assert!(!stdout_of(words).contains("trail"));
}

#[test]
fn all_ties_are_followed() {
    let words = ["explore", "worlds/shape-6.toml", "--choices", "all", "--json"];
    let line = objects(&stdout_of([&words[..], &FOLDING].concat())).remove(0);
    assert_eq!(line["complete"], true, "{line}");
    assert!(line["runs"].as_u64().unwrap() > 1, "{line}");
    let few = [&words[..], &FOLDING, &["--max-states", "3"]].concat();
    let output = run(few);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    let words = ["check", "--edges", "1..=3", "--choices", "all"];
    stdout_of([&words[..], &FOLDING].concat());
}

#[test]
fn a_run_that_reaches_its_bound_is_incomplete() {
    let words = ["explore", "worlds/shape-6.toml", "--max-darts", "3"];
    let output = run([&words[..], &FOLDING].concat());
    assert_eq!(output.status.code(), Some(3));
    assert!(stdout(&output).ends_with("Use --max-darts N to raise the bound.\n"));
}

#[test]
fn one_movable_marker_is_not_for_the_folding_explorer() {
    let words = ["explore", "worlds/shape-6.toml", "--marker", "movable"];
    let output = run([&words[..], &FOLDING].concat());
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("the folding explorer maps with --marker directional"));
}

#[test]
fn a_simulated_run_is_logged_and_replayed_with_its_algorithm() {
    let folder = folder("folding-run");
    let paths = ["run.mcap", "run.html"].map(|name| folder.join(name));
    let [log, page] = [&paths[0], &paths[1]].map(|path| path.to_str().unwrap());
    let words = ["simulate", "worlds/building-12.toml", "--by-scene", "--json", "--log", log];
    let line = [&words[..], &FOLDING, &["--html", page]].concat();
    let simulated = objects(&stdout_of(line)).remove(0);
    assert_eq!(simulated["algorithm"], "folding");
    assert_eq!(simulated["moves"], simulated["explore_moves"]);
    for holds in ["isomorphic", "pose_true", "conforms"] {
        assert_eq!(simulated[holds], true, "{simulated}");
    }
    let text = std::fs::read_to_string(page).unwrap();
    assert!(text.contains("the trail folds from"));
    let replayed = objects(&stdout_of(["conform", "--rerun", log, "--json"])).remove(0);
    assert_eq!((&replayed["map"], &replayed["difference"]), (&true.into(), &Value::Null));
    assert_eq!(replayed["moves"], simulated["moves"]);
    let output = run(["conform", "--rerun", log, "--json", "--algorithm", "algorithm1"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(objects(&stdout(&output))[0]["difference"]["what"], "door");
}

#[test]
fn a_lost_robot_gives_up_with_the_folding_explorer_too() {
    let words = ["simulate", "worlds/shape-6.toml", "--by-scene", "--fault", "lights-out@20"];
    let output = run([&words[..], &FOLDING].concat());
    assert_eq!(output.status.code(), Some(1));
    assert!(stdout(&output).contains("The robot gave up: on move "));
}
