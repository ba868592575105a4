//! `toposlam explore WORLD`: the map, the moves, the doors, the story.

use std::{fs, path::PathBuf};

use serde_json::Value;
use toposlam_model::{
    embedded_graph::{Dart, Vertex},
    format::{
        named_world::NamedWorld,
        plantri::{self, PlantriCode},
        world_file,
    },
    isomorphism::Bijection,
    marker::{Directional, Marker, Movable},
    world::{Action, GraphWorld},
};

use super::{folder, objects, read_world, run, said, stdout, world_files};

/// A run done again from its start: the robot and the marker where its doors, and what it does with
/// the marker, lead.
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
fn the_doors_of_a_run_can_be_taken_again_and_its_map_is_the_world() {
    for path in world_files() {
        let file = path.to_str().unwrap();
        let lines = objects(&said(["explore", "--json", file]));
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
theta-torus, from u with its back to the door a.
It drops its marker at v0, where it senses 3 doors, marker along door 0.

  1  behind v0.0, after 1 move: 3 doors
     no other unexplored dart fits
     so v0.0 leads to a new vertex, v1
     known: 2 vertices, 1 edge; unexplored: 4 darts

  2  behind v1.1, after 1 move: 3 doors, marker along door 2
     1 of the 3 other unexplored darts may fit
     v0.1? yes: the marker is here and points as it must
     so v1.1 and v0.1 are one edge
     known: 2 vertices, 2 edges; unexplored: 2 darts

  3  behind v0.2, after 1 move: 3 doors
     1 of the 1 other unexplored dart may fit
     v1.2? yes: its path leads to the marker, which points as it must (1 move)
     so v0.2 and v1.2 are one edge
     known: 2 vertices, 3 edges; unexplored: 0 darts

The map has 2 vertices and 3 edges, and took 4 moves (at least 3, at most 24).
It is isomorphic to the world:
  v0 = u, v1 = v
The robot knows where it is: at v0, having come in by its dart 0.
";
    assert_eq!(said(["explore", "worlds/theta-torus.toml"]), story);
}

#[test]
fn an_absent_marker_is_told_where_it_decides() {
    let told = said(["explore", "worlds/petersen.toml"]);
    assert!(told.contains("fails at move 2: 3 doors, no marker instead of 3 doors, marker along"));
}

#[test]
fn the_start_can_be_chosen() {
    let world =
        read_world(&world_files().into_iter().find(|p| p.ends_with("shape-6.toml")).unwrap());
    for start in world.graph.darts() {
        let text = world.start_text(start);
        let lines = objects(&said(["explore", "worlds/shape-6.toml", "--json", "--start", &text]));
        assert_eq!(lines[0]["start"], text.as_str());
        let map = world_file::read(lines[0]["map"].to_string().as_bytes()).unwrap();
        assert!(is_isomorphic_start(&map, &world, start), "{text}");
    }
}

#[test]
fn the_map_is_written_in_the_format_that_its_name_says() {
    let folder = folder("explore_map");
    let file = |name: &str| folder.join(name);
    let svg = file("map.svg");
    for name in ["map.toml", "map.json", "map.ec"] {
        let (map, svg) = (file(name), svg.to_str().unwrap());
        said(["explore", "worlds/figure-1b.toml", "--map", map.to_str().unwrap(), "--svg", svg]);
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
fn too_small_a_bound_is_incomplete() {
    let output = run(["explore", "worlds/shape-6.toml", "--max-darts", "3"]);
    assert_eq!(output.status.code(), Some(3));
    assert!(stdout(&output).ends_with(
        "After 1 move: more than 3 darts (edge ends) are known and there is no end in sight\n\
         With --max-darts N the robot may go on.\n"
    ));
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
        let line = &objects(&said(arguments))[0];
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

/// The first number after each of these words.
fn numbers_after(text: &str, words: &[&str]) -> Vec<u64> {
    let after = words.iter().flat_map(|word| text.split(word).skip(1));
    let digits = after.map(|rest| rest.split(|c: char| !c.is_ascii_digit()).next().unwrap());
    digits.filter_map(|number| number.parse().ok()).collect()
}

// paper: movable.place, movable.new, movable.known, movable.back-link
#[test]
fn a_run_with_a_movable_marker_can_be_done_again_and_ends_where_it_tells() {
    for path in simple_world_files() {
        let file = path.to_str().unwrap();
        let lines = objects(&said(["explore", file, "--marker", "movable", "--json"]));
        let [line] = lines.as_slice() else { panic!("{file}: {} lines", lines.len()) };
        assert_eq!((&line["marker"], &line["isomorphic"]), (&"movable".into(), &true.into()));
        let world = read_world(&path);
        let start = world.start.unwrap();
        let moves = line["doors"].as_array().unwrap().iter().filter(|door| door.is_number());
        assert_eq!(moves.count() as u64, line["moves"], "{file}");
        let robot = replay(&world, Movable, start, &line["doors"]);
        assert!(robot.carries(), "{file}");

        let story = said(["explore", file, "--marker", "movable", "--full", "--doors"]);
        let pose = numbers_after(&story, &["where it is: at v", "having come in by its dart "]);
        let [vertex, index] = pose[..] else { panic!("{story}") };
        let map = world_file::read(line["map"].to_string().as_bytes()).unwrap();
        assert!(is_isomorphic_start(&map, &world, start), "{file}");
        let bijection = Bijection::of_starts((&map.graph, Dart(0)), (&world.graph, start));
        let told = map.graph.dart(Vertex(vertex as u32), index as u32).unwrap();
        assert_eq!(bijection.image(told), Some(robot.pose()), "{file}");
        assert!(story.ends_with("\nIt carries its marker.\n"), "{story}");

        // Every move is told once, and so is every action.
        let (rounds, _) = story.split_once("\nThe map has ").unwrap();
        let told: u64 = numbers_after(rounds, &[", after ", " ("]).iter().sum();
        assert_eq!(told, line["moves"], "{story}");
        let doors = story.lines().filter_map(|line| line.strip_prefix("     doors: "));
        let doors: Vec<_> = doors.flat_map(|doors| doors.split(' ')).collect();
        let actions = line["doors"].as_array().unwrap().iter();
        assert!(actions.map(|action| action.to_string().replace('"', "")).eq(doors), "{file}");
    }
}

#[test]
fn the_story_of_shape_6_with_a_movable_marker() {
    let story = "\
shape-6, from corner with its back to the door tee.
Its marker lies at v0, where it senses 2 doors, marker.
It picks the marker up.

  1  behind v0.0, after 1 move with the marker: 3 doors
     no known vertex fits
     so v0.0 leads to a new vertex, v1
     known: 2 vertices, 1 edge; unexplored: 3 darts

  2  behind v1.1, after 1 move with the marker: 2 doors
     no known vertex fits
     so v1.1 leads to a new vertex, v2
     known: 3 vertices, 2 edges; unexplored: 3 darts

  3  behind v2.1, after 1 move with the marker: 2 doors
     1 of the 3 known vertices may fit
     it drops the marker here and goes to look for it
     v0? no: the marker is not here (3 moves)
     the marker is at no known vertex
     it goes back to the marker and picks it up (3 moves)
     so v2.1 leads to a new vertex, v3
     known: 4 vertices, 3 edges; unexplored: 3 darts

  4  behind v3.1, after 1 move with the marker: 2 doors
     1 of the 4 known vertices may fit
     it drops the marker here and goes to look for it
     v0? no: the marker is not here (4 moves)
     the marker is at no known vertex
     it goes back to the marker and picks it up (4 moves)
     so v3.1 leads to a new vertex, v4
     known: 5 vertices, 4 edges; unexplored: 3 darts

  5  behind v4.1, after 1 move with the marker: 3 doors
     1 of the 5 known vertices may fit
     it drops the marker here and goes to look for it
     v1? yes: the marker is here, where only v1.2 is unexplored (4 moves)
     it picks the marker up
     so v4.1 and v1.2 are one edge
     known: 5 vertices, 5 edges; unexplored: 1 dart

  6  behind v0.1, after 2 moves with the marker: 1 door
     no known vertex fits
     so v0.1 leads to a new vertex, v5
     known: 6 vertices, 6 edges; unexplored: 0 darts

The map has 6 vertices and 6 edges, and took 25 moves (at least 6, at most 74).
It is isomorphic to the world:
  v0 = corner, v1 = tee, v2 = ne, v3 = se, v4 = sw, v5 = end
The robot knows where it is: at v5, having come in by its dart 0.
It carries its marker.
";
    assert_eq!(said(["explore", "worlds/shape-6.toml", "--marker", "movable"]), story);
    // In the tetrahedron the marker shows by which of two darts a known vertex was entered.
    let back_link = "
  3  behind v2.1, after 1 move with the marker: 3 doors
     1 of the 3 known vertices may fit
     it drops the marker here and goes to look for it
     v0? yes: the marker is here, where 2 darts are unexplored (3 moves)
     it picks the marker up
     it carries the marker to v2 and drops it (2 moves)
     v0.1? no: 3 doors, no marker (4 moves)
     v0.2? yes: it leads to the marker (1 move)
     it picks the marker up
     so v2.1 and v0.2 are one edge
";
    assert!(said(["explore", "worlds/k4-plane.toml", "--marker", "movable"]).contains(back_link));
}

#[test]
fn only_some_of_the_places_without_the_marker_are_told_unless_all_are_wanted() {
    let file = "worlds/building-25.toml";
    let told = said(["explore", file, "--marker", "movable"]);
    let full = said(["explore", file, "--marker", "movable", "--full"]);
    let rejected = |story: &str| story.matches("? no: the marker is not here (").count();
    let untold: u64 = numbers_after(&told, &["     ... and "]).iter().sum();
    assert!(untold > 0 && !full.contains("... and "));
    assert_eq!(rejected(&told) as u64 + untold, rejected(&full) as u64);
}

#[test]
fn a_marker_that_is_carried_is_not_drawn() {
    let svg = folder("explore_movable").join("map.svg");
    let drawn = |marker| {
        let svg = svg.to_str().unwrap();
        said(["explore", "worlds/shape-6.toml", "--svg", svg, "--marker", marker]);
        fs::read_to_string(svg).unwrap()
    };
    let sign = "class=\"marker\"";
    assert!(drawn("directional").contains(sign));
    let carried = drawn("movable");
    assert!(!carried.contains(sign));
    assert!(carried.contains("mapped in 25 moves; the robot carries its marker"), "{carried}");
}

#[test]
fn too_small_a_bound_is_incomplete_with_a_movable_marker_too() {
    let arguments = ["explore", "worlds/shape-6.toml", "--marker", "movable", "--max-darts"];
    let output = run([&arguments[..], &["4"]].concat());
    assert_eq!(output.status.code(), Some(3));
    let last = "With --max-darts N the robot may go on.\n";
    assert!(stdout(&output).ends_with(last), "{}", stdout(&output));
    assert_eq!(run([&arguments[..], &["12"]].concat()).status.code(), Some(0));
}
