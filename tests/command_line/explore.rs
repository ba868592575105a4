//! `toposlam explore WORLD`: the map, the moves, the doors, the story, with each algorithm.

use serde_json::{Value, json};
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

use super::{Scratch, has, read_world, stderr, world_files};

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

fn is_isomorphic_start(map: &Value, world: &NamedWorld, start: Dart) -> bool {
    let map = world_file::read(map.to_string().as_bytes()).unwrap();
    let bijection = Bijection::of_starts((&map.graph, map.start.unwrap()), (&world.graph, start));
    bijection.verify(&map.graph, &world.graph)
}

fn doors_of(value: &Value) -> Vec<Door> {
    let doors = value.as_array().unwrap().iter();
    doors.map(|door| Door(door.as_u64().unwrap() as u32)).collect()
}

fn percepts(world: &NamedWorld, doors: &[Door]) -> Vec<Percept> {
    let mut robot = GraphWorld::with_marker(&world.graph, Directional, world.start.unwrap());
    let mut percepts = vec![robot.percept().unwrap()];
    for &door in doors {
        robot.traverse(door).unwrap();
        percepts.push(robot.percept().unwrap());
    }
    percepts
}

// paper: world.interface, motion.door, cost.moves
#[test]
fn the_doors_of_a_run_can_be_repeated_and_its_map_is_the_world() {
    let scratch = Scratch::new("explore_worlds");
    let mut sums = [0, 0];
    for path in world_files() {
        let file = path.to_str().unwrap();
        let world = read_world(&path);
        let start = world.start.unwrap();
        for (algorithm, sum) in ["algorithm1", "folding"].iter().zip(&mut sums) {
            let explore = format!("explore {file} --algorithm {algorithm} --certificate");
            let line = scratch.last(&explore, 0);
            let named = (*algorithm == "folding").then_some("folding");
            has(
                &line,
                &json!({
                    "algorithm": named, "edges": world.graph.edge_count(),
                    "vertices": world.graph.vertex_count(), "isomorphic": true, "marker": null,
                    "doors.#": line["moves"],
                }),
                &explore,
            );
            let robot = replay(&world, Directional, start, &line["doors"]);
            assert_eq!(line["moves"], robot.moves());
            assert!(is_isomorphic_start(&line["map"], &world, start), "{file}");
            *sum += robot.moves();
            // The certificate is a walk whose folded trail is complete.
            let certificate = &line["certificate"];
            let doors = doors_of(&certificate["doors"]);
            assert!(fold(&percepts(&world, &doors), &doors).unwrap().is_complete(), "{file}");
            let ratio = robot.moves() as f64 / doors.len() as f64;
            has(certificate, &json!({ "moves": doors.len(), "ratio": ratio }), &explore);
        }
    }
    assert!(2 * sums[1] < sums[0], "{sums:?}");
}

/// An audit is the way to the marker and the certificate.
#[test]
fn an_audit_walks_the_certificate_of_the_map() {
    let scratch = Scratch::new("explore_audit");
    for (algorithm, path) in ["algorithm1", "folding"]
        .iter()
        .flat_map(|one| world_files().into_iter().map(move |path| (one, path)))
    {
        let file = path.to_str().unwrap();
        let explored = |audit: &str| {
            let options = format!("--certificate --algorithm {algorithm} {audit}");
            scratch.last(&format!("explore {file} {options}"), 0)
        };
        let [none, one, two] = ["", "--audit", "--audit=2"].map(explored);
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
            let doors = doors_of(&audited["doors"]);
            assert_eq!(doors.len(), moves);
            assert!(doors.starts_with(&doors_of(&none["doors"])));
            let percepts = percepts(&read_world(&path), &doors);
            let last = moves - certificate;
            assert!(matches!(percepts[last].sighting, Sighting::Pointing(_)), "{file}");
            let trail = fold(&percepts[last..], &doors[last..]).unwrap();
            assert!(trail.is_complete(), "{file}");
        }
    }
}

#[test]
fn the_start_can_be_chosen() {
    let scratch = Scratch::new("explore_start");
    let world = read_world(&scratch.path("worlds/shape-6.toml"));
    for start in world.graph.darts() {
        let text = world.start_text(start);
        let line = scratch.last(&format!("explore worlds/shape-6.toml --start {text}"), 0);
        assert_eq!(line["start"], text.as_str());
        assert!(is_isomorphic_start(&line["map"], &world, start), "{text}");
    }
}

#[test]
fn the_extension_of_the_map_decides_its_format() {
    let scratch = Scratch::new("explore_map");
    for map in ["map.toml", "map.json", "map.ec"] {
        scratch.out(&format!("explore worlds/figure-1b.toml --map {map} --svg map.svg"), 0);
    }
    let map = read_world(&scratch.path("map.toml"));
    assert_eq!(map, read_world(&scratch.path("map.json")));
    assert!(scratch.text("map.json").starts_with('{'));
    let code = scratch.bytes("map.ec");
    let graphs: Vec<_> =
        plantri::read_headerless(&code, PlantriCode::Edge).collect::<Result<_, _>>().unwrap();
    assert_eq!(graphs, [map.graph]);
    let drawn = scratch.text("map.svg");
    assert!(drawn.starts_with("<svg") && drawn.contains("</svg>"));
    assert_eq!(scratch.written(), ["map.ec", "map.json", "map.svg", "map.toml"]);
    // A carried marker is not drawn.
    for (marker, sign) in [("directional", true), ("movable", false)] {
        scratch.out(&format!("explore worlds/shape-6.toml --svg map.svg --marker {marker}"), 0);
        let drawn = scratch.text("map.svg");
        assert_eq!(drawn.contains("class=\"marker\""), sign, "{marker}");
        let carried = drawn.contains("mapped in 25 moves; the robot carries its marker");
        assert_eq!(carried, !sign, "{marker}");
    }
}

#[test]
fn a_run_or_a_search_that_reaches_its_bound_is_incomplete() {
    let scratch = Scratch::new("explore_bounds");
    let shape_6 = "explore worlds/shape-6.toml";
    for (how, few) in [("", 3), ("--algorithm folding", 3), ("--marker movable", 4)] {
        let bounded = format!("{shape_6} {how} --max-darts {few}");
        scratch.facts(&[(&bounded, 3, json!({ "isomorphic": false, "map": null }))]);
        scratch.out(&format!("{shape_6} {how} --max-darts 12"), 0);
    }
    let output = scratch.run(&format!("{shape_6} --max-darts 3 --map map.toml"));
    assert!(stderr(&output).contains("the map is not written: it is not complete"));
    assert_eq!(scratch.written(), [""; 0]);
    let petersen = "explore worlds/petersen.toml --choices all --max-states 1000";
    let line = scratch.last(petersen, 3);
    has(&line, &json!({ "limit": "max-states", "complete": false }), petersen);
    let begun = ["states", "states_within_rounds"].map(|key| line[key].as_u64().unwrap());
    assert!(begun[1] > 0 && begun.iter().sum::<u64>() <= 1000, "{begun:?}");
    let all = format!("{shape_6} --choices all");
    scratch.facts(&[
        (&all, 0, json!({ "limit": null })),
        (&format!("{all} --algorithm folding"), 0, json!({ "complete": true })),
        (&format!("{all} --algorithm folding --max-states 3"), 3, json!({ "complete": false })),
    ]);
    let folding = scratch.last(&format!("{all} --algorithm folding"), 0);
    assert!(folding["runs"].as_u64() > Some(1), "{folding}");
    scratch.out("check --edges 1..=3 --choices all --algorithm folding", 0);
}

// paper: cost.shape-6
#[test]
fn with_all_choices_shape_6_can_cost_9_moves() {
    let scratch = Scratch::new("explore_choices");
    let world = read_world(&scratch.path("worlds/shape-6.toml"));
    let mut costs_9 = 0;
    for start in world.graph.darts() {
        let start = world.start_text(start);
        let explore = format!("explore worlds/shape-6.toml --choices all --start {start}");
        let line = scratch.last(&explore, 0);
        let costs = line["costs"].as_array().unwrap();
        assert!(costs.contains(&line["moves"]), "{line}");
        assert!(costs.iter().all(|cost| cost.as_u64() >= Some(6)), "{line}");
        assert!(line["runs"].as_u64().unwrap() > 1);
        costs_9 += usize::from(costs.contains(&9.into()));
    }
    assert!(costs_9 > 0);
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
    let scratch = Scratch::new("explore_movable");
    let mut files = world_files();
    files.retain(|path| read_world(path).graph.is_simple());
    assert!(files.len() >= 14);
    for path in files {
        let file = path.to_str().unwrap();
        let explore = format!("explore {file} --marker movable");
        let line = scratch.last(&explore, 0);
        has(&line, &json!({ "marker": "movable", "isomorphic": true }), file);
        let world = read_world(&path);
        let start = world.start.unwrap();
        let moves = line["doors"].as_array().unwrap().iter().filter(|door| door.is_number());
        assert_eq!(moves.count() as u64, line["moves"], "{file}");
        let robot = replay(&world, Movable, start, &line["doors"]);
        assert!(robot.carries(), "{file}");

        let story = flat(&scratch.out(&format!("{explore} --full --doors"), 0));
        let (rounds, end) = story.split_once(" The map is complete after ").unwrap();
        let pose = end.split("entered by dart v").nth(1).unwrap();
        let pose: Vec<_> = numbers_after(&format!(".{pose}"), &["."]);
        let [vertex, index, ..] = pose[..] else { panic!("{story}") };
        assert!(is_isomorphic_start(&line["map"], &world, start), "{file}");
        let map = world_file::read(line["map"].to_string().as_bytes()).unwrap();
        let bijection = Bijection::of_starts((&map.graph, Dart(0)), (&world.graph, start));
        let pose = map.graph.dart(Vertex(vertex as u32), index as u32).unwrap();
        assert_eq!(bijection.image(pose), Some(robot.pose()), "{file}");

        // The story contains every move and every action once.
        let moves: u64 = numbers_after(rounds, &[" ("]).iter().sum();
        assert_eq!(moves, line["moves"], "{story}");
        let doors =
            rounds.split(" Doors: ").skip(1).map(|rest| rest.split_once(" Known:").unwrap().0);
        let doors: Vec<_> = doors.flat_map(|doors| doors.split(' ')).collect();
        let actions = line["doors"].as_array().unwrap().iter();
        assert!(actions.map(|action| action.to_string().replace('"', "")).eq(doors), "{file}");
    }
    // Only full stories contain every rejected candidate.
    let explore = "explore worlds/building-25.toml --marker movable";
    let story = scratch.out(explore, 0);
    let full = scratch.out(&format!("{explore} --full"), 0);
    let rejected =
        |story: &str| flat(story).matches(": rejected because the marker is not here (").count();
    let omitted: u64 = numbers_after(&story, &["  ... and "]).iter().sum();
    assert!(omitted > 0 && !full.contains("... and "));
    assert_eq!(rejected(&story) as u64 + omitted, rejected(&full) as u64);
}

#[test]
fn the_summary_fits_on_a_screen_and_is_the_default_in_large_worlds() {
    let scratch = Scratch::new("explore_summary");
    let line = |v: usize| format!("v{v} = [\"v{}\", \"v{}\"]\n", (v + 199) % 200, (v + 1) % 200);
    scratch.write("cycle.toml", format!("[clockwise]\n{}", (0..200).map(line).collect::<String>()));
    let summary = scratch.out("explore cycle.toml", 0);
    assert!(summary.lines().count() <= 24, "{summary}");
    // Each edge of a cycle is one round; the last one closes it.
    assert_eq!(numbers_after(&flat(&summary), &["rounds ", "a loop "]), [200, 1]);
    assert_eq!(numbers_after(&flat(&summary), &["that found a new vertex "]), [199]);
    assert_eq!(scratch.out("explore cycle.toml --summary", 0), summary);
    assert!(scratch.out("explore cycle.toml --story", 0).contains("Round 200:"));
    let small = scratch.out("explore worlds/shape-6.toml", 0);
    assert_eq!(scratch.out("explore worlds/shape-6.toml --story", 0), small);
}

#[cfg(unix)]
#[test]
fn a_search_of_all_choices_that_is_interrupted_is_not_known() {
    // Far more states than fit into the memory that it uses. The story is printed before the search.
    let search = "explore worlds/petersen.toml --choices all --max-states 100000000";
    let output = super::interrupted_after_a_line(search);
    let text = super::stdout(&output);
    assert_eq!(output.status.code(), Some(3), "{text}{}", stderr(&output));
    assert!(text.contains("The search was interrupted."), "{text}");
}
