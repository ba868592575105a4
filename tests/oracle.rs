//! The algorithms and the search for indistinguishable worlds, compared with second implementations in
//! Python. The Python code shares no code with the Rust code, only the paper and descriptions.

use std::{
    cmp::Reverse,
    collections::{BTreeMap, BTreeSet, HashMap},
    process::Command,
};

use serde_json::{Value, json};
use toposlam_model::{
    aid::{AIDS, AidKind, FEW_STATES},
    ambiguity::Comparison,
    check::{Check, RunChoices, Shard, Tally},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, Enumeration},
    floor_plan::Direction,
    folding::{ArrivalSenses, FoldedTrail, LengthInterval, TrailError, certificate_length, fold},
    format::world_file,
    mapping::MappingAlgorithm,
    percept::{CompassView, Door, Percept, Sighting},
};

use crate::{printed, program, repository};

/// The JSON objects that a command of `toposlam` prints.
fn objects(command: &str) -> Vec<Value> {
    let text = printed(program().args(command.split(' ')).arg("--json"));
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// What a second implementation prints; `None`, with a message, if there is no Python.
fn oracle(command: &str) -> Option<String> {
    let mut python = Command::new("python3");
    // No files are left behind.
    let python = python.arg("-B").args(command.split(' '));
    if Command::new("python3").arg("--version").output().is_err() {
        eprintln!("skipped: there is no python3 to run {command}");
        return None;
    }
    Some(printed(python.current_dir(repository("tests/oracle"))))
}

/// The JSON objects of a second implementation; none if there is no Python.
fn oracle_objects(command: &str) -> Vec<Value> {
    let text = oracle(command).unwrap_or_default();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Every key that the oracle prints has the same value in the output of `check`.
// paper: movable.place, movable.back-link
#[test]
fn the_moves_the_runs_and_the_certificates_are_the_same() {
    for (second, check) in [
        ("algorithm1.py default 5", "check --edges 1..=5"),
        ("algorithm1.py all 4", "check --edges 1..=4 --choices all"),
        ("movable_marker.py 6", "check --edges 1..=6 --marker movable"),
        ("folding.py certificates 5", "check --edges 1..=5"),
    ] {
        let (expected, ours) = (oracle_objects(second), objects(check));
        assert!(expected.is_empty() || expected.len() == ours.len(), "{second}");
        for (expected, ours) in expected.iter().zip(&ours) {
            for (key, value) in expected.as_object().unwrap() {
                assert_eq!(&ours[key], value, "{second}: {key}: {expected} against {ours}");
            }
        }
    }
}

fn numbers(list: &Value) -> Vec<u32> {
    list.as_array().unwrap().iter().map(|number| number.as_u64().unwrap() as u32).collect()
}

/// The darts of a folded trail, breadth first from where the walk began, and the degrees of its vertices in this order.
fn breadth_first(trail: &FoldedTrail) -> (Vec<Dart>, Vec<u32>) {
    let (mut order, mut degrees) = (Vec::new(), Vec::new());
    let mut reached = BTreeSet::new();
    let mut reach = |pose: Dart, order: &mut Vec<Dart>| {
        if !reached.contains(&pose) {
            degrees.push(trail.degree(pose));
            let around = (0..trail.degree(pose)).map(|door| trail.behind(pose, Door(door)));
            reached.extend(around.clone());
            order.extend(around);
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
    (order, degrees)
}

/// A folded trail as a JSON object: its darts are numbered breadth first.
fn numbered(trail: &FoldedTrail) -> Value {
    let (order, degrees) = breadth_first(trail);
    let number: HashMap<Dart, usize> = order.iter().copied().zip(0..).collect();
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

/// The percepts and the doors of a walk.
fn percepts_and_doors(walk: &Value) -> (Vec<Percept>, Vec<Door>) {
    let percept = |percept: &Value| {
        let door = percept[1].as_u64().map(|door| Door(door as u32));
        let sighting = door.map_or(Sighting::Nothing, Sighting::Pointing);
        Percept { degree: percept[0].as_u64().unwrap() as u32, sighting }
    };
    let percepts = walk["percepts"].as_array().unwrap().iter().map(percept).collect();
    (percepts, numbers(&walk["doors"]).into_iter().map(Door).collect())
}

#[test]
fn the_same_walks_fold_to_the_same_graphs() {
    let walks = oracle_objects("folding.py walks 600");
    let mut kinds = [0, 0, 0];
    for walk in &walks {
        let (percepts, doors) = percepts_and_doors(walk);
        let folded = fold(&percepts, &doors);
        kinds[folded.as_ref().map_or(2, |trail| usize::from(trail.is_complete()))] += 1;
        let ours = folded.as_ref().map_or(Value::Null, numbered);
        assert_eq!(ours, walk["folded"], "{walk}");
    }
    // Open and complete folded trails, and contradictions.
    assert!(walks.is_empty() || kinds.iter().all(|&count| count > 50), "{kinds:?}");
}

/// What a robot with lengths and a compass senses; `sensed` is a measured length, and the directions of the doors or null.
fn senses(sensed: &Value) -> ArrivalSenses {
    let length = LengthInterval::measured(sensed[0].as_u64().unwrap() as u32, 100);
    let directions = sensed[1].as_array().into_iter().flatten();
    let view = directions.map(|direction| Direction::ALL[direction.as_u64().unwrap() as usize]);
    let compass = sensed[1].is_array().then(|| CompassView::new(view));
    ArrivalSenses { length: Some(length), compass }
}

#[test]
fn the_same_lengths_and_directions_are_known_of_the_same_walks() {
    let walks = oracle_objects("senses.py 600");
    let mut contradictions = 0;
    for walk in &walks {
        let (percepts, doors) = percepts_and_doors(walk);
        let sensed: Vec<_> = walk["sensed"].as_array().unwrap().iter().map(senses).collect();
        let folded = || -> Result<FoldedTrail, TrailError> {
            let mut trail = FoldedTrail::new(percepts[0])?;
            trail.sense(sensed[0])?;
            for ((&door, &percept), &senses) in doors.iter().zip(&percepts[1..]).zip(&sensed[1..]) {
                trail.step(door, percept)?;
                trail.sense(senses)?;
            }
            Ok(trail)
        };
        let ours = folded().map_or(Value::Null, |trail| {
            let (order, _) = breadth_first(&trail);
            let length = |&dart: &Dart| {
                let length = trail.length(dart);
                (length != LengthInterval::ANY).then(|| length.bounds())
            };
            let direction = |&dart: &Dart| trail.direction(dart).map(|direction| direction as u32);
            json!({
                "lengths": order.iter().map(length).collect::<Vec<_>>(),
                "directions": order.iter().map(direction).collect::<Vec<_>>(),
            })
        });
        contradictions += usize::from(ours.is_null());
        assert_eq!(ours, walk["folded"], "{walk}");
    }
    assert!(walks.is_empty() || (50..walks.len() - 50).contains(&contradictions));
}

#[test]
fn no_walk_that_determines_its_world_is_shorter_than_the_certificate() {
    let starts = oracle_objects("folding.py shortest 3");
    assert!(starts.is_empty() || starts.len() == 2 + 10 + 74);
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

/// The output of `counterexample` in the format of the oracle: `KIND m placed_worlds ambiguous` and
/// `KIND smallest M K`.
fn counterexamples(class: &str, edges: &str, aids: &[&str]) -> String {
    let aids: Vec<_> = aids.iter().map(|aid| format!(" --aid {aid}")).collect();
    let aids = aids.concat();
    let lines = objects(&format!("counterexample --class {class} --max-edges {edges}{aids}"));
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
    for (class, edges) in [("multigraph", "4"), ("simple", "6"), ("corridor", "7"), ("planar", "6")]
    {
        let Some(oracle) = oracle(&format!("ambiguity.py {class} {edges}")) else { return };
        assert!(oracle.lines().count() > 8 * 4);
        assert_eq!(counterexamples(class, edges, &[]), oracle, "{class}");
    }
}

/// The names of the aids that move, but for the one marker that is among those above.
fn moving_aids() -> Vec<&'static str> {
    AIDS[FEW_STATES.len()..].iter().copied().map(AidKind::name).collect()
}

#[test]
fn with_aids_that_move_the_same_worlds_are_counted_and_indistinguishable() {
    let aids = moving_aids();
    for (class, edges) in [("multigraph", "3"), ("simple", "4"), ("corridor", "5")] {
        let command = format!("ambiguity.py {class} {edges} {}", aids.join(" "));
        let Some(oracle) = oracle(&command) else { return };
        assert_eq!(counterexamples(class, edges, &aids), oracle, "{class}");
    }
}

#[test]
fn with_binoculars_the_same_worlds_are_counted_and_indistinguishable() {
    let aids = ["binoculars-1", "binoculars-2", "binoculars-3"];
    for (class, edges) in [("multigraph", "4"), ("simple", "7"), ("corridor", "8"), ("planar", "7")]
    {
        let command = format!("ambiguity.py {class} {edges} {}", aids.join(" "));
        let Some(oracle) = oracle(&command) else { return };
        assert_eq!(counterexamples(class, edges, &aids), oracle, "{class}");
    }
}

/// The numbers are those of the tests in `model/src/ambiguity/quotient.rs`.
#[test]
fn with_a_compass_the_same_worlds_are_counted_and_indistinguishable() {
    let counted = |class: &str, edges: usize| {
        let text = oracle(&format!("compass.py {class} {edges}"))?;
        let numbers = |line: &str| line.strip_prefix(class).unwrap().trim().to_owned();
        Some(text.lines().map(numbers).collect::<Vec<_>>())
    };
    let Some(plane) = counted("plane", 5) else { return };
    assert_eq!(plane, ["1 2 0", "2 6 0", "3 22 0", "4 92 0", "5 420 0", "smallest none"]);
    let all = counted("multigraph", 4).unwrap();
    assert_eq!(all, ["1 4 2", "2 15 9", "3 60 2", "4 300 11", "smallest 2 1"]);
}

#[test]
fn with_every_aid_the_shortest_walks_are_as_long() {
    walks_are_as_long(Class::Multigraph, 2);
    walks_are_as_long(Class::Simple, 4);
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn with_every_aid_the_shortest_walks_in_more_worlds_are_as_long() {
    walks_are_as_long(Class::Multigraph, 3);
}

/// For each aid, the lengths of the shortest walks that distinguish two starts, of all pairs.
fn walks_are_as_long(class: Class, edges: usize) {
    let starts: Vec<EmbeddedGraph> = (1..=edges)
        .flat_map(|edges| Enumeration::new(Each::Start, class, edges).unwrap().graphs())
        .collect();
    let mut found = Vec::new();
    for aid in AIDS {
        let mut lengths: BTreeMap<Option<Reverse<usize>>, usize> = BTreeMap::new();
        for (at, one) in starts.iter().enumerate() {
            for other in &starts[..at] {
                let comparison = Comparison::new(aid, (one, Dart(0)), (other, Dart(0)));
                let walk = comparison.walk([Dart(0); 2]);
                *lengths.entry(walk.map(|walk| Reverse(walk.actions.len()))).or_default() += 1;
            }
        }
        for (length, count) in lengths.iter().rev() {
            let length = length.map_or("never".to_owned(), |Reverse(length)| length.to_string());
            found.push(format!("{} {length} {count}\n", aid.name()));
        }
    }
    let names = AIDS.map(AidKind::name).join(" ");
    let Some(oracle) = oracle(&format!("ambiguity.py --walks {class} {edges} {names}")) else {
        return;
    };
    assert_eq!(found.concat(), oracle, "{class}");
}

/// The moves on every start, of each aid that moves, but for the short strings and the two markers, with which the
/// folding explorer maps.
#[test]
fn explorers_with_aids_that_move_make_as_many_moves() {
    for (class, edges) in [(Class::Simple, 6), (Class::Multigraph, 4)] {
        let Some(oracle) = oracle(&format!("moving.py {class} {edges}")) else { return };
        let is_compared = |known: &MappingAlgorithm| {
            let is_short =
                matches!(known.aid(), AidKind::String(string) if string.length().is_some());
            let is_folding = is_short || *known == MappingAlgorithm::DirectionalAndMovable;
            known.aid().moves() && !is_folding && (class.is_simple() || !known.needs_simple())
        };
        let mut found = BTreeSet::new();
        for algorithm in MappingAlgorithm::all().filter(is_compared) {
            for edges in 1..=edges {
                let check = Check::new(class, edges, Shard::WHOLE).unwrap();
                let tally = algorithm.sweep(&check, RunChoices::Default, &());
                let Tally { starts, moves_total, .. } = &tally;
                let most = tally.moves_max();
                let aid = algorithm.aid().name();
                found.insert(format!("{aid} {class} {edges} {starts} {moves_total} {most}"));
            }
        }
        let expected: BTreeSet<_> = oracle.lines().map(str::to_owned).collect();
        assert_eq!(found, expected);
    }
}
