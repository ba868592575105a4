//! The rules of the pages of `play` and `compare`, which their scripts apply in the browser, against those of the
//! specification: the judge, folding, the sightings of each marker, comparisons of worlds, and the smallest other world that
//! explains a walk, against trying them all. Sections 2.1 to 2.3.

use std::{borrow::Cow, fmt::Write as _, fs};

use serde_json::{Value, json};
use toposlam_model::{
    aid::{AIDS, Action, Aid, AidKind, FEW_STATES, State},
    ambiguity::{Bisimulation, Comparison},
    check::judge_map,
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, Enumeration},
    folding::fold,
    format::named_world::NamedWorld,
    isomorphism::{Candidate, as_discovered},
    mapping::{ExploredMap, Flaw},
    marker::Directional,
    percept::{Door, Percept},
    world::GraphWorld,
};

use crate::{browser, output, repository};

/// Every start with these numbers of edges.
fn starts(edges: std::ops::RangeInclusive<usize>) -> Vec<EmbeddedGraph> {
    let all = |edges| Enumeration::new(Each::Start, Class::Multigraph, edges).unwrap().graphs();
    edges.flat_map(all).collect()
}

fn end(graph: &EmbeddedGraph, dart: Dart) -> Value {
    json!([graph.vertex(dart).at(), graph.index(dart)])
}

fn lists(graph: &EmbeddedGraph) -> Value {
    let ends = |vertex| graph.darts_of(vertex).map(|dart| end(graph, graph.opposite(dart)));
    graph.vertices().map(|vertex| ends(vertex).collect::<Value>()).collect()
}

/// What the page answers to each case; `None` if there is no Node.
fn answers(name: &str, cases: &[Value]) -> Option<Vec<String>> {
    let mut lines = String::new();
    for case in cases {
        writeln!(lines, "{case}").unwrap();
    }
    let file = output::folder(name).join("cases.jsonl");
    fs::write(&file, lines).unwrap();
    let scripts = repository("draw/src/page/browser");
    let printed = browser::run_in_node("scripts.mjs", &[scripts.as_os_str(), file.as_os_str()])?;
    let answers: Vec<_> = printed.lines().map(str::to_owned).collect();
    assert_eq!(answers.len(), cases.len());
    Some(answers)
}

/// The random number after this one.
fn next(seed: u32) -> u32 {
    seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223)
}

/// A walk of a robot from the start of a world.
struct Walk {
    percepts: Vec<Percept>,
    actions: Vec<Action>,
}

impl Walk {
    /// Random actions; the same random numbers for the same seed.
    fn random(graph: &EmbeddedGraph, marker: AidKind, length: usize, seed: &mut u32) -> Self {
        let mut world = GraphWorld::with_aid(graph, marker, Dart(0));
        let mut walk = Self { percepts: vec![world.sensed()], actions: Vec::new() };
        for _ in 0..length {
            *seed = next(*seed);
            let possible = world.actions();
            let action = possible[(*seed >> 16) as usize % possible.len()];
            world.act(action).unwrap();
            walk.actions.push(action);
            walk.percepts.push(world.sensed());
        }
        walk
    }

    /// Whether a robot perceives the same from the start of a world.
    fn is_explained_by(&self, graph: &EmbeddedGraph, marker: AidKind) -> bool {
        let mut world = GraphWorld::with_aid(graph, marker, Dart(0));
        world.sensed() == self.percepts[0]
            && self
                .actions
                .iter()
                .zip(&self.percepts[1..])
                .all(|(&action, percept)| world.act(action).is_ok() && world.sensed() == *percept)
    }

    fn json(&self) -> [Value; 2] {
        let percept =
            |percept: &Percept| json!({ "degree": percept.degree, "sighting": percept.sighting });
        let percepts = self.percepts.iter().map(percept).collect();
        [percepts, self.actions.iter().map(|action| json!(action.to_string())).collect()]
    }

    fn doors(&self) -> Vec<Door> {
        let door = |action: &Action| match action {
            Action::Take(door) => *door,
            Action::Do(action) => panic!("{action} is not a door"),
        };
        self.actions.iter().map(door).collect()
    }
}

/// Every start as a map of every other one, with the robot anywhere on the map.
#[test]
fn the_judge_of_the_game_agrees_with_the_specification() {
    let starts = starts(1..=3);
    assert_eq!(starts.len(), 2 + 10 + 74);
    let (mut cases, mut expected) = (Vec::new(), Vec::new());
    let mut candidate = Candidate::default();
    for (number, world) in starts.iter().enumerate() {
        let truth = Dart((number % world.dart_count()) as u32);
        for map in &starts {
            for pose in map.darts() {
                cases.push(json!({
                    "rule": "judge", "map": lists(map), "pose": end(map, pose),
                    "world": lists(world), "start": end(world, Dart(0)), "truth": end(world, truth),
                }));
                let map = ExploredMap { graph: Cow::Borrowed(map), facing: Dart(0), pose };
                expected.push(match judge_map(&map, (world, Dart(0)), truth, &mut candidate) {
                    Ok(_) => "right",
                    Err(Flaw::WrongPose { .. }) => "pose",
                    Err(_) => "map",
                });
            }
        }
    }
    let Some(answers) = answers("scripts-maps", &cases) else { return };
    for (case, (answer, expected)) in answers.iter().zip(expected).enumerate() {
        let found = if ["right", "pose"].contains(&&**answer) { answer } else { "map" };
        assert_eq!(found, expected, "case {case}: {answer}");
    }
    for kind in ["right", "pose", "degree", "several", "twice"] {
        assert!(answers.iter().any(|answer| answer == kind), "no map is {kind}");
    }
}

#[test]
fn the_folded_trails_of_the_game_have_the_same_open_doors() {
    let (mut cases, mut expected, mut seed) = (Vec::new(), Vec::new(), 1);
    for graph in starts(1..=3) {
        for length in 1..=9 {
            let walk = Walk::random(&graph, Directional.into(), length, &mut seed);
            let open = fold(&walk.percepts, &walk.doors()).unwrap().open_darts().count();
            let [percepts, actions] = walk.json();
            cases.push(json!({ "rule": "fold", "percepts": percepts, "actions": actions }));
            expected.push(open.to_string());
        }
    }
    let Some(answers) = answers("scripts-walks", &cases) else { return };
    assert_eq!(answers, expected);
    assert!(expected.iter().any(|open| open == "0") && expected.iter().any(|open| open != "0"));
}

/// Every aid as it is at a start, in every pose of every start with up to 4 edges, placed by each dart.
#[test]
fn the_sightings_of_each_aid_are_those_of_the_specification() {
    let (mut cases, mut expected) = (Vec::new(), Vec::new());
    for graph in starts(1..=4) {
        for aid in AIDS {
            for facing in graph.darts().step_by(3) {
                let placed = aid.placed(&graph, facing);
                let sighting = |pose| {
                    let state = State { pose, placed: placed.clone() };
                    json!(aid.sighting(&graph, &state))
                };
                expected.push(graph.darts().map(sighting).collect::<Value>().to_string());
                cases.push(json!({
                    "rule": "sightings", "marker": aid.name(),
                    "world": lists(&graph), "facing": end(&graph, facing),
                }));
            }
        }
    }
    let Some(answers) = answers("scripts-sightings", &cases) else { return };
    assert_eq!(answers, expected);
}

/// What a robot senses and can do: after each action of a random walk, its state in words, its percept and its actions.
/// From every start with up to 3 edges, and from some with 4.
#[test]
fn robots_with_each_aid_do_on_a_page_what_the_specification_says() {
    let some = starts(4..=4).into_iter().step_by(7);
    let (mut cases, mut expected, mut seed) = (Vec::new(), Vec::new(), 3);
    for graph in starts(1..=3).into_iter().chain(some) {
        let named = NamedWorld::numbered("world", "", graph, Some(Dart(0)));
        let graph = &named.graph;
        for aid in AIDS {
            for facing in graph.darts().step_by(3) {
                let length = if aid.moves() { 30 } else { 12 };
                let mut world = GraphWorld::with_aid(graph, aid, facing);
                let (mut actions, mut shown) = (Vec::new(), Vec::new());
                loop {
                    let possible = world.actions();
                    let words: Vec<_> = possible.iter().map(Action::to_string).collect();
                    let state = named.state_text(&aid, &world.state());
                    shown.push(json!([state, world.sensed().to_string(), words]));
                    if actions.len() == length {
                        break;
                    }
                    seed = next(seed);
                    let action = possible[(seed >> 16) as usize % possible.len()];
                    world.act(action).unwrap();
                    actions.push(action.to_string());
                }
                expected.push(Value::from(shown).to_string());
                cases.push(json!({
                    "rule": "walk", "marker": aid.name(), "world": lists(graph),
                    "vertices": named.vertex_names, "facing": end(graph, facing), "actions": actions,
                }));
            }
        }
    }
    let Some(answers) = answers("scripts-aids", &cases) else { return };
    for (case, (answer, expected)) in cases.iter().zip(answers.iter().zip(&expected)) {
        assert_eq!(answer, expected, "{case}");
    }
}

/// If a person claims all that is true, the map of the walk shows what the robot perceives; and nothing that is true is
/// refused. The markers on edges and at their ends may lie where no robot has been.
#[test]
fn a_map_with_true_claims_shows_what_the_robot_perceives() {
    let (mut cases, mut expected, mut seed) = (Vec::new(), Vec::new(), 5);
    for graph in starts(1..=4).into_iter().step_by(5) {
        for aid in AIDS.into_iter().filter(|aid| aid.marks()) {
            let length = if aid.moves() { 24 } else { 12 };
            let walk = Walk::random(&graph, aid, length, &mut seed);
            let sightings = walk.percepts.iter().map(|percept| json!(percept.sighting));
            expected.push(sightings.collect::<Value>().to_string());
            let [_, actions] = walk.json();
            cases.push(json!({
                "rule": "map", "marker": aid.name(), "world": lists(&graph), "actions": actions,
            }));
        }
    }
    let Some(answers) = answers("scripts-claims", &cases) else { return };
    for (case, (answer, expected)) in cases.iter().zip(answers.iter().zip(&expected)) {
        assert_eq!(answer, expected, "{case}");
    }
}

/// Every two starts with up to 2 edges, and some with 3; for the aids with more states, some of the pairs.
#[test]
fn the_comparisons_of_the_pages_are_those_of_the_specification() {
    let some = starts(3..=3).into_iter().step_by(9);
    let worlds: Vec<_> = starts(1..=2).into_iter().chain(some).collect();
    let (mut cases, mut expected, mut apart) = (Vec::new(), Vec::new(), 0);
    for marker in AIDS {
        let step = if FEW_STATES.contains(&marker) { 1 } else { 5 };
        for (number, one) in worlds.iter().enumerate() {
            for other in worlds[number..].iter().step_by(step) {
                let facing = Dart(number as u32 % other.dart_count() as u32);
                cases.push(json!({
                    "rule": "compare", "marker": marker.name(), "worlds": [lists(one), lists(other)],
                    "facings": [end(one, Dart(0)), end(other, facing)],
                }));
                let comparison = Comparison::new(marker, (one, Dart(0)), (other, facing));
                let mut poses = marker.starts(other, facing);
                poses.sort_by_key(|&pose| pose != facing);
                let bisimulation = |&pose: &Dart| {
                    let found = comparison.bisimulation([Dart(0), pose], usize::MAX, &()).unwrap();
                    found.map(|found| (pose, found))
                };
                expected.push(match poses.iter().find_map(bisimulation) {
                    Some((pose, Bisimulation::Relation(relation))) => {
                        json!([relation.0.len(), pose.0])
                    }
                    Some((_, Bisimulation::Classes(_))) => panic!("the relation is small"),
                    None => {
                        apart += 1;
                        let walk = comparison.walk([Dart(0), facing]).unwrap();
                        let actions: Vec<_> = walk.actions.iter().map(Action::to_string).collect();
                        json!([actions.join(" "), facing.0])
                    }
                });
            }
        }
    }
    let Some(answers) = answers("scripts-comparisons", &cases) else { return };
    let expected: Vec<_> = expected.iter().map(Value::to_string).collect();
    assert_eq!(answers, expected);
    assert!(apart > 100 && expected.len() - apart > 100);
}

/// The largest number of edges for which all starts are tried.
const TRIED: usize = 4;

/// The world has up to 3 edges. With up to 4 edges, there is another one exactly if the page finds it, and it has as many
/// edges.
#[test]
fn the_other_world_of_the_game_is_as_small_as_trying_all_finds() {
    let all = starts(1..=TRIED);
    let (mut cases, mut walks, mut seed) = (Vec::new(), Vec::new(), 7);
    for marker in AIDS {
        let step = if FEW_STATES.contains(&marker) { 1 } else { 4 };
        for truth in starts(1..=3).into_iter().step_by(step) {
            for length in [1, 3, 6, 10, 20] {
                let walk = Walk::random(&truth, marker, length, &mut seed);
                let [percepts, actions] = walk.json();
                cases.push(json!({
                    "rule": "other", "marker": marker.name(), "world": lists(&truth),
                    "percepts": percepts, "actions": actions,
                }));
                walks.push((marker, truth.clone(), walk));
            }
        }
    }
    let Some(answers) = answers("scripts-others", &cases) else { return };
    let mut sizes = [0; TRIED + 1];
    let (mut none, mut larger) = (0, 0);
    for ((marker, truth, walk), answer) in walks.iter().zip(answers) {
        let is_other =
            |graph: &&EmbeddedGraph| *graph != truth && walk.is_explained_by(graph, *marker);
        let least = all.iter().find(is_other).map(EmbeddedGraph::edge_count);
        let answer: Option<Vec<Vec<(usize, u32)>>> = serde_json::from_str(&answer).unwrap();
        let Some(found) = answer else {
            assert_eq!(least, None, "{} {truth:?} {:?}", marker.name(), walk.actions);
            none += 1;
            continue;
        };
        let graph = as_discovered(&graph_of(&found), Dart(0));
        assert!(is_other(&&graph), "{} {truth:?} {:?}: {graph:?}", marker.name(), walk.actions);
        let edges = Some(graph.edge_count());
        assert_eq!(
            edges.filter(|&edges| edges <= TRIED),
            least,
            "{} {truth:?} {:?}",
            marker.name(),
            walk.actions
        );
        match least {
            Some(edges) => sizes[edges] += 1,
            None => larger += 1,
        }
    }
    assert!(
        none > 100 && larger > 0 && sizes[1..].iter().all(|&count| count > 10),
        "{none} {larger} {sizes:?}"
    );
}

/// The graph of the lists of a page: dart 0 is its first.
fn graph_of(lists: &[Vec<(usize, u32)>]) -> EmbeddedGraph {
    let mut first = vec![0];
    for ends in lists {
        first.push(first[first.len() - 1] + ends.len() as u32);
    }
    let opposite: Vec<u32> =
        lists.iter().flatten().map(|&(vertex, index)| first[vertex] + index).collect();
    let next = |(vertex, ends): (usize, &Vec<_>)| {
        let (first, degree) = (first[vertex], ends.len() as u32);
        (0..degree).map(move |index| first + (index + 1) % degree)
    };
    let clockwise: Vec<u32> = lists.iter().enumerate().flat_map(next).collect();
    let (graph, number) = EmbeddedGraph::from_permutations(&opposite, &clockwise).unwrap();
    assert_eq!(number[0], Dart(0));
    graph
}
