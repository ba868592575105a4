//! `toposlam explore WORLD`: the map, the moves, the doors, the story.

use std::{fs, path::PathBuf};

use serde_json::Value;
use toposlam_model::{
    embedded_graph::{Dart, Vertex},
    folding::fold,
    format::{
        named_world::NamedWorld,
        plantri::{self, PlantriCode},
        world_file,
    },
    isomorphism::Bijection,
    marker::{Directional, Marker, Movable},
    percept::{Door, Percept, Sighting},
    world::{Action, GraphWorld, World},
};

use super::{folder, objects, read_world, run, stderr, stdout, stdout_of, world_files};

/// Repeats the actions of a run from its start.
fn replay<'w, M: Marker>(
    world: &'w NamedWorld,
    marker: M,
    start: Dart,
    doors: &Value,
) -> GraphWorld<'w, M> {
    let mut robot = GraphWorld::with_marker(&world.graph, marker, start);
    for action in doors.as_array().unwrap() {
        let action = match action {
            Value::String(word) => word.parse(),
            number => number.to_string().parse::<Action>(),
        };
        robot.act(action.unwrap()).unwrap();
    }
    robot
}

fn is_isomorphic_start(map: &NamedWorld, world: &NamedWorld, start: Dart) -> bool {
    let bijection = Bijection::of_starts((&map.graph, map.start.unwrap()), (&world.graph, start));
    bijection.verify(&map.graph, &world.graph)
}

// paper: world.interface, motion.door, cost.moves
#[test]
fn the_doors_of_a_run_can_be_repeated_and_its_map_is_the_world() {
    for path in world_files() {
        let file = path.to_str().unwrap();
        let lines = objects(&stdout_of(["explore", "--json", file]));
        let [line] = lines.as_slice() else { panic!("{file}: {} lines", lines.len()) };
        let world = read_world(&path);
        let start = world.start.unwrap();
        assert_eq!(line["edges"], world.graph.edge_count(), "{file}");
        assert_eq!(line["vertices"], world.graph.vertex_count());
        assert_eq!(line["isomorphic"], true);
        assert_eq!(line["marker"], Value::Null);
        assert_eq!(line["doors"].as_array().unwrap().len() as u64, line["moves"]);
        replay(&world, Directional, start, &line["doors"]);
        let map = world_file::read(line["map"].to_string().as_bytes()).unwrap();
        assert!(is_isomorphic_start(&map, &world, start), "{file}");
    }
}

#[test]
fn the_story_of_the_theta_graph_on_the_torus() {
    let story = "\
World theta-torus. The robot starts at u, with its back to the door of edge a.
It puts its marker down here, at vertex v0 of the map. It senses 3 doors, marker
along door 0.

Round 1: the robot takes v0.0 (1 move) and senses 3 doors.
  Possible other ends: 2 darts. The percept rules out 2: no candidate left.
  So v0.0 leads to a new vertex, v1.
  Known: 2 vertices, 1 edge. Unexplored: 4 darts.

Round 2: the robot takes v1.1 (1 move) and senses 3 doors, marker along door 2.
  Possible other ends: 3 darts. The percept rules out 2: 1 candidate left.
  Candidate v0.1: confirmed, the marker is here and points as expected.
  So v1.1 and v0.1 are the two ends of one edge.
  Known: 2 vertices, 2 edges. Unexplored: 2 darts.

Round 3: the robot takes v0.2 (1 move) and senses 3 doors.
  Possible other ends: 1 dart. The percept rules out none: 1 candidate left.
  Candidate v1.2: confirmed, its path leads to the marker, which points as
    expected (1 move).
  So v0.2 and v1.2 are the two ends of one edge.
  Known: 2 vertices, 3 edges. Unexplored: 0 darts.

The map is complete after 4 moves: 2 vertices, 3 edges. A run in this world
takes at least 4 and at most 24 moves.
It is isomorphic to the world:
  v0 = u, v1 = v
The robot is where it believes it is: at v0, entered by dart v0.0.
";
    assert_eq!(stdout_of(["explore", "worlds/theta-torus.toml"]), story);
}

#[test]
fn the_certificate_is_a_walk_whose_folded_trail_is_complete() {
    for path in world_files() {
        let file = path.to_str().unwrap();
        let lines = objects(&stdout_of(["explore", "--json", "--certificate", file]));
        let certificate = &lines[0]["certificate"];
        let world = read_world(&path);
        let start = world.start.unwrap();
        let doors: Vec<Door> = certificate["doors"].as_array().unwrap().iter().map(door).collect();
        assert_eq!(certificate["moves"], doors.len());
        let robot = GraphWorld::with_marker(&world.graph, Directional, start);
        let trail = fold(&percepts(robot, &doors), &doors).unwrap();
        assert!(trail.is_complete(), "{file}");
        let moves = lines[0]["moves"].as_u64().unwrap();
        assert_eq!(certificate["ratio"], moves as f64 / doors.len() as f64);
    }
    let text = flat(&stdout_of(["explore", "worlds/shape-6.toml", "--certificate"]));
    let expected = "Certificate: the shortest walk that proves the map of this world takes 7 moves. \
                    No robot can map the world in fewer. This run took 1.00 times as many. doors 0 2 1 1 1 2 1";
    assert!(text.contains(expected), "{text}");
    let movable = run(["explore", "worlds/shape-6.toml", "--marker", "movable", "--certificate"]);
    assert_eq!(movable.status.code(), Some(2));
}

/// An audit is the way to the marker and the certificate.
#[test]
fn an_audit_walks_the_certificate_of_the_map() {
    for (algorithm, path) in ["algorithm1", "folding"]
        .iter()
        .flat_map(|one| world_files().into_iter().map(move |path| (one, path)))
    {
        let file = path.to_str().unwrap();
        let explored = |audit: &[&str]| {
            let options = ["explore", "--json", "--certificate", "--algorithm", algorithm, file];
            objects(&stdout_of([&options[..], audit].concat())).remove(0)
        };
        let [none, one, two] = [&[][..], &["--audit"], &["--audit=2"]].map(explored);
        let number = |value: &Value| value.as_u64().unwrap() as usize;
        let certificate = number(&none["certificate"]["moves"]);
        assert_eq!(none["audit_moves"], Value::Null);
        for (audits, audited) in [(1, &one), (2, &two)] {
            let [moves, of_audits] = ["moves", "audit_moves"].map(|name| number(&audited[name]));
            assert_eq!(moves, number(&none["moves"]) + of_audits, "{file}");
            assert!(of_audits > audits * certificate, "{file}: {of_audits}");
            for name in ["map", "isomorphic", "certificate", "start", "edges"] {
                assert_eq!(audited[name], none[name], "{file}: {name}");
            }
            // All doors are those of a walk in the world that ends with the certificate.
            let doors: Vec<Door> = audited["doors"].as_array().unwrap().iter().map(door).collect();
            assert_eq!(doors.len(), moves);
            assert_eq!(
                audited["doors"].as_array().unwrap()[..number(&none["moves"])],
                none["doors"].as_array().unwrap()[..]
            );
            let world = read_world(&path);
            let robot = GraphWorld::with_marker(&world.graph, Directional, world.start.unwrap());
            let percepts = percepts(robot, &doors);
            let last = moves - certificate;
            assert!(matches!(percepts[last].sighting, Sighting::Pointing(_)), "{file}");
            let trail = fold(&percepts[last..], &doors[last..]).unwrap();
            assert!(trail.is_complete(), "{file}");
        }
    }
    let text = flat(&stdout_of(["explore", "worlds/shape-6.toml", "--audit=2", "--doors"]));
    assert!(text.contains("The map is complete. The robot audits it. Every percept"), "{text}");
    assert!(text.contains(" Each percept is as the map predicts. "), "{text}");
    let text = flat(&stdout_of(["explore", "worlds/shape-6.toml", "--audit", "--summary"]));
    assert!(text.contains(" moves of audits "), "{text}");
    let movable = run(["explore", "worlds/shape-6.toml", "--marker", "movable", "--audit"]);
    assert_eq!(movable.status.code(), Some(2));
}

fn door(door: &Value) -> Door {
    Door(door.as_u64().unwrap() as u32)
}

fn percepts(mut robot: GraphWorld<Directional>, doors: &[Door]) -> Vec<Percept> {
    let mut percepts = vec![robot.percept().unwrap()];
    for &door in doors {
        robot.traverse(door).unwrap();
        percepts.push(robot.percept().unwrap());
    }
    percepts
}

#[test]
fn the_story_mentions_an_absent_marker_if_it_decides() {
    let story = flat(&stdout_of(["explore", "worlds/petersen.toml"]));
    assert!(story.contains("at move 2 of its path: expected 3 doors, marker along"));
}

#[test]
fn the_start_can_be_chosen() {
    let world =
        read_world(&world_files().into_iter().find(|p| p.ends_with("shape-6.toml")).unwrap());
    for start in world.graph.darts() {
        let text = world.start_text(start);
        let lines =
            objects(&stdout_of(["explore", "worlds/shape-6.toml", "--json", "--start", &text]));
        assert_eq!(lines[0]["start"], text.as_str());
        let map = world_file::read(lines[0]["map"].to_string().as_bytes()).unwrap();
        assert!(is_isomorphic_start(&map, &world, start), "{text}");
    }
}

#[test]
fn the_extension_of_the_map_decides_its_format() {
    let folder = folder("explore_map");
    let file = |name: &str| folder.join(name);
    let svg = file("map.svg");
    for name in ["map.toml", "map.json", "map.ec"] {
        let (map, svg) = (file(name), svg.to_str().unwrap());
        stdout_of([
            "explore",
            "worlds/figure-1b.toml",
            "--map",
            map.to_str().unwrap(),
            "--svg",
            svg,
        ]);
    }
    let map = read_world(&file("map.toml"));
    assert_eq!(map, read_world(&file("map.json")));
    assert!(fs::read(file("map.json")).unwrap().starts_with(b"{"));
    let code = fs::read(file("map.ec")).unwrap();
    let graphs: Vec<_> =
        plantri::read_headerless(&code, PlantriCode::Edge).collect::<Result<_, _>>().unwrap();
    assert_eq!(graphs, [map.graph]);
    let drawn = fs::read_to_string(svg).unwrap();
    assert!(drawn.starts_with("<svg") && drawn.contains("</svg>"));
    assert_eq!(super::names_in(&folder), ["map.ec", "map.json", "map.svg", "map.toml"]);
}

#[test]
fn a_run_that_reaches_its_bound_is_incomplete() {
    let output = run(["explore", "worlds/shape-6.toml", "--max-darts", "3"]);
    assert_eq!(output.status.code(), Some(3));
    assert!(stdout(&output).ends_with("Use --max-darts N to raise the bound.\n"));
    assert_eq!(stderr(&output), "");
    let map = folder("explore-bound").join("map.toml");
    let few = ["explore", "worlds/shape-6.toml", "--max-darts", "3", "--map"];
    let output = run([&few[..], &[map.to_str().unwrap()]].concat());
    assert!(stderr(&output).contains("the map is not written: it is not complete"));
    assert!(!map.exists());
    let output = run(["explore", "worlds/shape-6.toml", "--max-darts", "3", "--json"]);
    assert_eq!(output.status.code(), Some(3));
    let line = &objects(&stdout(&output))[0];
    assert_eq!((&line["isomorphic"], &line["map"]), (&false.into(), &Value::Null));
    assert_eq!(run(["explore", "worlds/shape-6.toml", "--max-darts", "12"]).status.code(), Some(0));
}

// paper: cost.shape-6
#[test]
fn with_all_choices_shape_6_can_cost_9_moves() {
    let path = world_files().into_iter().find(|path| path.ends_with("shape-6.toml")).unwrap();
    let world = read_world(&path);
    let mut costs_9 = 0;
    for start in world.graph.darts() {
        let text = world.start_text(start);
        let arguments =
            ["explore", "worlds/shape-6.toml", "--json", "--choices", "all", "--start", &text];
        let line = &objects(&stdout_of(arguments))[0];
        let costs = line["costs"].as_array().unwrap();
        assert!(costs.contains(&line["moves"]), "{line}");
        assert!(costs.iter().all(|cost| cost.as_u64() >= Some(6)), "{line}");
        assert!(line["runs"].as_u64().unwrap() > 1);
        costs_9 += usize::from(costs.contains(&9.into()));
    }
    assert!(costs_9 > 0);
}

/// The world files that a movable marker suffices for.
fn simple_world_files() -> Vec<PathBuf> {
    let mut files = world_files();
    files.retain(|path| read_world(path).graph.is_simple());
    assert!(files.len() >= 14);
    files
}

/// A text without line breaks.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The first number after each of these words.
fn numbers_after(text: &str, words: &[&str]) -> Vec<u64> {
    let after = words.iter().flat_map(|word| text.split(word).skip(1));
    let digits = after.map(|rest| rest.split(|c: char| !c.is_ascii_digit()).next().unwrap());
    digits.filter_map(|number| number.parse().ok()).collect()
}

// paper: movable.place, movable.new, movable.known, movable.back-link
#[test]
fn a_run_with_a_movable_marker_can_be_repeated_and_ends_at_its_pose() {
    for path in simple_world_files() {
        let file = path.to_str().unwrap();
        let lines = objects(&stdout_of(["explore", file, "--marker", "movable", "--json"]));
        let [line] = lines.as_slice() else { panic!("{file}: {} lines", lines.len()) };
        assert_eq!((&line["marker"], &line["isomorphic"]), (&"movable".into(), &true.into()));
        let world = read_world(&path);
        let start = world.start.unwrap();
        let moves = line["doors"].as_array().unwrap().iter().filter(|door| door.is_number());
        assert_eq!(moves.count() as u64, line["moves"], "{file}");
        let robot = replay(&world, Movable, start, &line["doors"]);
        assert!(robot.carries(), "{file}");

        let story = flat(&stdout_of(["explore", file, "--marker", "movable", "--full", "--doors"]));
        let (rounds, end) = story.split_once(" The map is complete after ").unwrap();
        let pose = end.split("entered by dart v").nth(1).unwrap();
        let pose: Vec<_> = numbers_after(&format!(".{pose}"), &["."]);
        let [vertex, index, ..] = pose[..] else { panic!("{story}") };
        let map = world_file::read(line["map"].to_string().as_bytes()).unwrap();
        assert!(is_isomorphic_start(&map, &world, start), "{file}");
        let bijection = Bijection::of_starts((&map.graph, Dart(0)), (&world.graph, start));
        let pose = map.graph.dart(Vertex(vertex as u32), index as u32).unwrap();
        assert_eq!(bijection.image(pose), Some(robot.pose()), "{file}");
        assert!(story.ends_with(" It carries its marker."), "{story}");

        // The story contains every move and every action once.
        let moves: u64 = numbers_after(rounds, &[" ("]).iter().sum();
        assert_eq!(moves, line["moves"], "{story}");
        let doors =
            rounds.split(" Doors: ").skip(1).map(|rest| rest.split_once(" Known:").unwrap().0);
        let doors: Vec<_> = doors.flat_map(|doors| doors.split(' ')).collect();
        let actions = line["doors"].as_array().unwrap().iter();
        assert!(actions.map(|action| action.to_string().replace('"', "")).eq(doors), "{file}");
    }
}

#[test]
fn the_story_of_shape_6_with_a_movable_marker() {
    let story = "\
World shape-6. The robot starts at corner, with its back to the door to tee.
Its marker lies here, at vertex v0 of the map. It senses 2 doors, marker.
It picks the marker up.

Round 1: the robot takes v0.0 with the marker (1 move) and senses 3 doors.
  Candidates: none of the 1 known vertex.
  So v0.0 leads to a new vertex, v1.
  Known: 2 vertices, 1 edge. Unexplored: 3 darts.

Round 2: the robot takes v1.1 with the marker (1 move) and senses 2 doors.
  Candidates: none of the 2 known vertices.
  So v1.1 leads to a new vertex, v2.
  Known: 3 vertices, 2 edges. Unexplored: 3 darts.

Round 3: the robot takes v2.1 with the marker (1 move) and senses 2 doors.
  Candidates: 1 of the 3 known vertices.
  The robot drops the marker here and searches for it.
  Candidate v0: rejected because the marker is not here (3 moves).
  The marker is at no known vertex.
  The robot returns to the marker (3 moves) and picks it up.
  So v2.1 leads to a new vertex, v3.
  Known: 4 vertices, 3 edges. Unexplored: 3 darts.

Round 4: the robot takes v3.1 with the marker (1 move) and senses 2 doors.
  Candidates: 1 of the 4 known vertices.
  The robot drops the marker here and searches for it.
  Candidate v0: rejected because the marker is not here (4 moves).
  The marker is at no known vertex.
  The robot returns to the marker (4 moves) and picks it up.
  So v3.1 leads to a new vertex, v4.
  Known: 5 vertices, 4 edges. Unexplored: 3 darts.

Round 5: the robot takes v4.1 with the marker (1 move) and senses 3 doors.
  Candidates: 1 of the 5 known vertices.
  The robot drops the marker here and searches for it.
  Candidate v1: confirmed, the marker is here, and only v1.2 is unexplored (4
    moves).
  The robot picks the marker up.
  So v4.1 and v1.2 are the two ends of one edge.
  Known: 5 vertices, 5 edges. Unexplored: 1 dart.

Round 6: the robot takes v0.1 with the marker (2 moves) and senses 1 door.
  Candidates: none of the 5 known vertices.
  So v0.1 leads to a new vertex, v5.
  Known: 6 vertices, 6 edges. Unexplored: 0 darts.

The map is complete after 25 moves: 6 vertices, 6 edges. A run in this world
takes at least 6 and at most 74 moves.
It is isomorphic to the world:
  v0 = corner, v1 = tee, v2 = ne, v3 = se, v4 = sw, v5 = end
The robot is where it believes it is: at v5, entered by dart v5.0.
It carries its marker.
";
    assert_eq!(stdout_of(["explore", "worlds/shape-6.toml", "--marker", "movable"]), story);
    // In the tetrahedron the marker shows by which of two darts a known vertex was entered.
    let back_link = "
Round 3: the robot takes v2.1 with the marker (1 move) and senses 3 doors.
  Candidates: 1 of the 3 known vertices.
  The robot drops the marker here and searches for it.
  Candidate v0: confirmed, the marker is here, and 2 darts are unexplored (3
    moves).
  The robot picks the marker up.
  The robot carries the marker to v2 (2 moves) and drops it.
  Candidate v0.1: rejected because it leads to 3 doors, no marker (4 moves).
  Candidate v0.2: confirmed, it leads to the marker (1 move).
  The robot picks the marker up.
  So v2.1 and v0.2 are the two ends of one edge.
";
    assert!(
        stdout_of(["explore", "worlds/k4-plane.toml", "--marker", "movable"]).contains(back_link)
    );
}

#[test]
fn only_full_stories_contain_every_rejected_candidate() {
    let file = "worlds/building-25.toml";
    let story = stdout_of(["explore", file, "--marker", "movable"]);
    let full = stdout_of(["explore", file, "--marker", "movable", "--full"]);
    let rejected =
        |story: &str| flat(story).matches(": rejected because the marker is not here (").count();
    let omitted: u64 = numbers_after(&story, &["  ... and "]).iter().sum();
    assert!(omitted > 0 && !full.contains("... and "));
    assert_eq!(rejected(&story) as u64 + omitted, rejected(&full) as u64);
}

#[test]
fn a_carried_marker_is_not_drawn() {
    let svg = folder("explore_movable").join("map.svg");
    let drawn = |marker| {
        let svg = svg.to_str().unwrap();
        stdout_of(["explore", "worlds/shape-6.toml", "--svg", svg, "--marker", marker]);
        fs::read_to_string(svg).unwrap()
    };
    let sign = "class=\"marker\"";
    assert!(drawn("directional").contains(sign));
    let carried = drawn("movable");
    assert!(!carried.contains(sign));
    assert!(carried.contains("mapped in 25 moves; the robot carries its marker"), "{carried}");
}

#[test]
fn a_run_with_a_movable_marker_that_reaches_its_bound_is_incomplete() {
    let arguments = ["explore", "worlds/shape-6.toml", "--marker", "movable", "--max-darts"];
    let output = run([&arguments[..], &["4"]].concat());
    assert_eq!(output.status.code(), Some(3));
    let last = "Use --max-darts N to raise the bound.\n";
    assert!(stdout(&output).ends_with(last), "{}", stdout(&output));
    assert_eq!(run([&arguments[..], &["12"]].concat()).status.code(), Some(0));
}

#[test]
fn the_summary_fits_on_a_screen_and_is_the_default_in_large_worlds() {
    let folder = folder("explore_summary");
    let path = folder.join("cycle.toml");
    let name = |vertex: usize| format!("v{}", vertex % 200);
    let list = |vertex| {
        format!("{} = [\"{}\", \"{}\"]\n", name(vertex), name(vertex + 199), name(vertex + 1))
    };
    fs::write(&path, format!("[clockwise]\n{}", (0..200).map(list).collect::<String>())).unwrap();
    let large = path.to_str().unwrap();
    let summary = stdout_of(["explore", large]);
    assert!(summary.lines().count() <= 24, "{summary}");
    assert!(summary.lines().all(|line| line.chars().count() <= 80), "{summary}");
    // Each edge of a cycle is one round; the last one closes it.
    assert_eq!(numbers_after(&flat(&summary), &["rounds ", "a loop "]), [200, 1]);
    assert!(flat(&summary).contains("that found a new vertex 199"), "{summary}");
    assert!(summary.contains("and 175 more"), "{summary}");
    assert_eq!(stdout_of(["explore", large, "--summary"]), summary);
    let story = stdout_of(["explore", large, "--story"]);
    assert!(story.contains("Round 200:"), "{story}");
    let small = stdout_of(["explore", "worlds/shape-6.toml"]);
    assert_eq!(stdout_of(["explore", "worlds/shape-6.toml", "--story"]), small);
    assert!(small.contains("Round 1:"));
    let summary = stdout_of(["explore", "worlds/shape-6.toml", "--summary"]);
    assert!(!summary.contains("Round 1:") && summary.contains("The map is complete"));
}

#[test]
fn the_limit_of_a_search_of_all_choices_is_named() {
    let arguments = ["explore", "worlds/petersen.toml", "--choices", "all", "--max-states", "1000"];
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(3));
    let text = flat(&stdout(&output));
    assert!(text.contains("The search stopped at --max-states 1000."), "{text}");
    let line = &objects(&stdout(&run([&arguments[..], &["--json"]].concat())))[0];
    assert_eq!((&line["limit"], &line["complete"]), (&"max-states".into(), &false.into()));
    let begun = ["states", "states_within_rounds"].map(|key| line[key].as_u64().unwrap());
    assert!(begun[1] > 0 && begun.iter().sum::<u64>() <= 1000, "{begun:?}");
    let whole = ["explore", "worlds/shape-6.toml", "--choices", "all", "--json"];
    assert_eq!(objects(&stdout_of(whole))[0]["limit"], Value::Null);
}

#[cfg(unix)]
#[test]
fn a_search_of_all_choices_that_is_interrupted_is_not_known() {
    use std::{
        io::{BufRead, BufReader, Read},
        process::{Command, Stdio},
    };

    let mut explore = super::toposlam();
    // Far more states than fit into the memory that it uses.
    let arguments = ["--choices", "all", "--max-states", "100000000"];
    explore.args(["explore", "worlds/petersen.toml"]).args(arguments);
    let mut explore = explore.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut out = BufReader::new(explore.stdout.take().unwrap());
    // The story is printed before the search.
    let mut text = String::new();
    out.read_line(&mut text).unwrap();
    let killed = Command::new("kill").args(["-INT", &explore.id().to_string()]).status().unwrap();
    assert!(killed.success());
    out.read_to_string(&mut text).unwrap();
    let output = explore.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{text}{}", stderr(&output));
    assert!(text.contains("The search was interrupted."), "{text}");
}
