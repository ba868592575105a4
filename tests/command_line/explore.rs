//! `toposlam explore WORLD`: the map, the moves and the doors, with each algorithm. Other facts are in
//! `tests/facts/explore.txt`.

use serde_json::{Value, json};
use toposlam_model::{
    aid::Action,
    aid::{Aid, markers::MOVABLE},
    embedded_graph::Dart,
    folding::fold,
    format::{named_world::NamedWorld, world_file},
    isomorphism::Bijection,
    marker::Directional,
    percept::{Door, Percept, Sighting},
    world::{GraphWorld, World},
};

use super::{Scratch, has, read_world, world_files};

/// Repeats the actions of a run from its start. Returns the robot, and what it senses after each action.
fn replay<'w, A: Aid>(
    world: &'w NamedWorld,
    aid: A,
    doors: &Value,
) -> (GraphWorld<'w, A>, Vec<Percept>) {
    let mut robot = GraphWorld::with_aid(&world.graph, aid, world.start.unwrap());
    let mut percepts = vec![robot.percept().unwrap()];
    for action in doors.as_array().unwrap() {
        let action = match action {
            Value::String(word) => word.parse(),
            number => number.to_string().parse::<Action>(),
        };
        robot.act(action.unwrap()).unwrap();
        percepts.push(robot.percept().unwrap());
    }
    (robot, percepts)
}

fn is_isomorphic_start(map: &Value, world: &NamedWorld, start: Dart) -> bool {
    let map = world_file::read(map.to_string().as_bytes()).unwrap();
    let bijection = Bijection::of_starts((&map.graph, map.start.unwrap()), (&world.graph, start));
    bijection.verify(&map.graph, &world.graph)
}

/// Whether this end of a walk determines its world.
fn is_complete(percepts: &[Percept], doors: &Value) -> bool {
    let doors = doors.as_array().unwrap().iter().map(|door| Door(door.as_u64().unwrap() as u32));
    let doors: Vec<_> = doors.collect();
    let first = doors.len() + 1 - percepts.len();
    fold(percepts, &doors[first..]).unwrap().is_complete()
}

// paper: world.interface, motion.door, cost.moves
#[test]
fn the_doors_of_a_run_can_be_repeated_and_its_map_is_the_world() {
    let scratch = Scratch::new("explore_worlds");
    let mut sums = [0, 0];
    for path in world_files() {
        let (file, world) = (path.to_str().unwrap(), read_world(&path));
        for (algorithm, sum) in ["algorithm1", "folding"].iter().zip(&mut sums) {
            let explore = format!("explore {file} --algorithm {algorithm} --certificate");
            let line = scratch.last(&explore, 0);
            let (robot, _) = replay(&world, Directional, &line["doors"]);
            // The certificate is a walk that determines its world.
            let certificate = &line["certificate"]["doors"];
            let length = certificate.as_array().unwrap().len();
            assert!(
                is_complete(&replay(&world, Directional, certificate).1, certificate),
                "{file}"
            );
            let named = (*algorithm == "folding").then_some("folding");
            let ratio = robot.moves() as f64 / length as f64;
            has(
                &line,
                &json!({
                    "algorithm": named, "edges": world.graph.edge_count(), "moves": robot.moves(),
                    "vertices": world.graph.vertex_count(), "isomorphic": true, "marker": null,
                    "certificate.moves": length, "certificate.ratio": ratio, "audit_moves": null,
                }),
                &explore,
            );
            assert!(is_isomorphic_start(&line["map"], &world, world.start.unwrap()), "{file}");
            *sum += robot.moves();

            // An audit is the way to the marker and the certificate.
            let audited = scratch.last(&format!("{explore} --audit=2"), 0);
            for name in ["map", "isomorphic", "certificate", "start", "edges"] {
                assert_eq!(audited[name], line[name], "{file}: {name}");
            }
            let (moved, percepts) = replay(&world, Directional, &audited["doors"]);
            let audits = moved.moves() - robot.moves();
            has(&audited, &json!({ "moves": moved.moves(), "audit_moves": audits }), file);
            assert!(audits > 2 * length as u64, "{file}: {audits}");
            let last = &percepts[percepts.len() - 1 - length..];
            assert!(matches!(last[0].sighting, Sighting::Pointing(_)), "{file}");
            assert!(is_complete(last, &audited["doors"]), "{file}");
        }
    }
    assert!(2 * sums[1] < sums[0], "{sums:?}");
}

// paper: movable.place, movable.new, movable.known, movable.back-link
#[test]
fn a_run_with_a_movable_marker_can_be_repeated_and_ends_with_the_marker() {
    let scratch = Scratch::new("explore_movable");
    let mut files = world_files();
    files.retain(|path| read_world(path).graph.is_simple());
    assert!(files.len() >= 14);
    for path in files {
        let (file, world) = (path.to_str().unwrap(), read_world(&path));
        let line = scratch.last(&format!("explore {file} --marker movable"), 0);
        let (robot, _) = replay(&world, MOVABLE, &line["doors"]);
        let fields = json!({ "marker": "movable", "isomorphic": true, "moves": robot.moves() });
        has(&line, &fields, file);
        assert!(is_isomorphic_start(&line["map"], &world, world.start.unwrap()), "{file}");
        assert_eq!(robot.held(), 1, "{file}");
    }
}

// paper: cost.shape-6
#[test]
fn from_each_start_of_shape_6_the_map_is_right_and_from_some_it_can_cost_9_moves() {
    let scratch = Scratch::new("explore_starts");
    let world = read_world(&scratch.path("worlds/shape-6.toml"));
    let mut costs_9 = 0;
    for start in world.graph.darts() {
        let text = world.start_text(start);
        let line =
            scratch.last(&format!("explore worlds/shape-6.toml --choices all --start {text}"), 0);
        assert_eq!(line["start"], text.as_str());
        assert!(is_isomorphic_start(&line["map"], &world, start), "{text}");
        let costs = line["costs"].as_array().unwrap();
        assert!(costs.contains(&line["moves"]), "{line}");
        assert!(costs.iter().all(|cost| cost.as_u64() >= Some(6)), "{line}");
        assert!(line["runs"].as_u64() > Some(1), "{line}");
        costs_9 += usize::from(costs.contains(&9.into()));
    }
    assert!(costs_9 > 0);
}

#[test]
fn a_search_of_all_choices_stops_at_its_limit_and_at_ctrl_c() {
    let petersen = "explore worlds/petersen.toml --choices all=1000";
    let line = Scratch::new("explore_bounds").last(petersen, 3);
    let begun = ["states", "states_within_rounds"].map(|key| line[key].as_u64().unwrap());
    assert!(begun[1] > 0 && begun.iter().sum::<u64>() <= 1000, "{begun:?}");
    // Far more states than fit into the memory that it uses. The story is printed before the search.
    #[cfg(unix)]
    super::interrupted_after_a_line(&petersen.replace("1000", "100000000"));
}
