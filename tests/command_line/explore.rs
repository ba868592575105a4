//! `toposlam explore WORLD`: the map, the moves, the doors, the story.

use std::fs;

use serde_json::Value;
use toposlam_model::{
    embedded_graph::Dart,
    format::{
        named_world::NamedWorld,
        plantri::{self, Code},
        world_file,
    },
    isomorphism::Bijection,
    percept::Door,
    world::{GraphWorld, World},
};

use crate::{folder, objects, read_world, run, said, stdout, world_files};

/// The doors of a run, taken again from its start; answers where they lead.
fn replay(world: &NamedWorld, start: Dart, doors: &Value) -> Dart {
    let mut robot = GraphWorld::new(&world.graph, start);
    for door in doors.as_array().unwrap() {
        robot.traverse(Door(door.as_u64().unwrap().try_into().unwrap())).unwrap();
    }
    robot.pose()
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
        assert_eq!(line["doors"].as_array().unwrap().len() as u64, line["moves"]);
        replay(&world, start, &line["doors"]);
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
        plantri::read_headerless(&code, Code::Edge).collect::<Result<_, _>>().unwrap();
    assert_eq!(graphs, [map.graph]);
    let drawn = fs::read_to_string(svg).unwrap();
    assert!(drawn.starts_with("<svg") && drawn.contains("</svg>"));
    assert_eq!(crate::names_in(&folder), ["map.ec", "map.json", "map.svg", "map.toml"]);
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
