//! Logs of robots whose marking aid moves: what they do with it is compared with the known world and with the algorithm.

use toposlam_model::{
    aid::{self, Action, Aid, AidAction, AidKind},
    embedded_graph::EmbeddedGraph,
    mapping::{MapWalk, MappingEvent, MovableEvent, Observer},
    marker::Undirected,
};

use super::*;
use crate::known_world::KnownWorld;

/// The percepts, actions and doors of a run.
struct Recorded(Vec<CheckedKind>);

impl<A: Aid> Observer<GraphWorld<'_, A>> for Recorded {
    fn event(&mut self, world: &mut GraphWorld<'_, A>, _: &MapWalk, event: MappingEvent) {
        match event {
            MappingEvent::Moved { door, .. } => {
                let number = number_of(world);
                self.0.extend([CheckedKind::Door { number, door, off: None }, arrival(world)]);
            }
            MappingEvent::Movable(MovableEvent::Did(action)) => {
                let before = world.moves() - Action::Do(action).moves();
                let number = u32::try_from(before).ok();
                self.0.extend([CheckedKind::Action { number, action }, arrival(world)]);
            }
            _ => {}
        }
    }
}

/// The moves of all robots together.
fn number_of<A: Aid>(world: &GraphWorld<'_, A>) -> Option<u32> {
    u32::try_from(world.moves()).ok()
}

fn arrival<A: Aid>(world: &GraphWorld<'_, A>) -> CheckedKind {
    let mut kind = CheckedKind::from(world.sensed());
    if let CheckedKind::Arrival { arrival, .. } = &mut kind {
        arrival.number = number_of(world);
    }
    kind
}

/// The run of an algorithm from a start.
fn recorded(algorithm: MappingAlgorithm, graph: &EmbeddedGraph, facing: Dart) -> RunEvents {
    let mut world = GraphWorld::with_aid(graph, algorithm.aid(), facing);
    let mut recorded = Recorded(vec![arrival(&world)]);
    algorithm.map_world(&mut world, DARTS, &mut recorded).1.unwrap();
    let end = Some(RunEnd { moves: world.moves(), ending: RunEnding::Mapped });
    RunEvents { end, has_head: true, ..bare_events(recorded.0) }
}

fn moving() -> impl Iterator<Item = MappingAlgorithm> {
    // A string as long as it takes is not among the aids that a log can name.
    MappingAlgorithm::all().filter(|it| it.aid().moves() && aid::named(it.aid().name()).is_ok())
}

fn config(algorithm: MappingAlgorithm) -> ConformConfig {
    ConformConfig { aid: algorithm.aid(), ..driven(without_world(), algorithm) }
}

/// In this world, from a start or from any.
fn known(
    graph: &EmbeddedGraph,
    facing: Option<Dart>,
    algorithm: MappingAlgorithm,
) -> ConformConfig {
    let aid = algorithm.aid();
    let states = match facing {
        Some(facing) => vec![GraphWorld::with_aid(graph, aid, facing).state()],
        None => anywhere(graph, &aid),
    };
    let world = Some(KnownWorld { graph: graph.clone(), states });
    ConformConfig { world, ..config(algorithm) }
}

/// Two triangles that share a vertex, with a tail.
fn bow_tie() -> EmbeddedGraph {
    let lists = [
        ("end", vec!["a"]),
        ("a", vec!["end", "b", "c", "d", "e"]),
        ("b", vec!["c", "a"]),
        ("c", vec!["a", "b"]),
        ("d", vec!["e", "a"]),
        ("e", vec!["a", "d"]),
    ];
    EmbeddedGraph::from_neighbour_lists(&lists).unwrap()
}

#[test]
fn a_run_with_each_aid_conforms_in_its_world_and_without_one() {
    let graph = bow_tie();
    for algorithm in moving() {
        for facing in graph.darts().step_by(3) {
            let events = recorded(algorithm, &graph, facing);
            for config in [
                known(&graph, Some(facing), algorithm),
                known(&graph, None, algorithm),
                config(algorithm),
            ] {
                let judged = judged(&events, &config);
                let what = format!("{} from {facing:?}", algorithm.aid().name());
                assert_eq!((judged.verdict(), judged.divergence), GOOD, "{what}");
            }
            // What is seen where a marker was just dropped or picked up need not be recorded; of others it must.
            let seen_again = |&at: &usize| {
                at > 0
                    && is_action(&events.events[at - 1].kind)
                    && !is_action(&events.events[at].kind)
            };
            let kept = (0..events.events.len()).filter(|at| !seen_again(at));
            let kept = kept.map(|at| events.events[at].clone()).collect();
            let kept = RunEvents { events: kept, ..events.clone() };
            let judged_again = judgement(&kept, &known(&graph, Some(facing), algorithm));
            let is_marker = matches!(
                algorithm.aid(),
                AidKind::Markers(_) | AidKind::Pointer(_) | AidKind::DirectionalAndMovable(_)
            );
            if is_marker {
                assert_eq!(judged_again.unwrap().verdict(), ConformVerdict::Conforms);
            } else {
                let error = judged_again.unwrap_err();
                let expected =
                    SightingError::NotRecordedAfter { event: nth(&kept, 0, is_action) + 1 };
                assert!(matches!(error, JudgeError::Marker(found) if found == expected), "{error}");
            }
            // Nobody knows which worlds explain the doors of a robot that no algorithm drives.
            let anyone = driven(config(algorithm), RunDriver::Anyone);
            assert_eq!(judged(&events, &anyone).verdict(), ConformVerdict::NotKnown);
            let anyone = driven(known(&graph, None, algorithm), RunDriver::Anyone);
            assert_eq!(judged(&events, &anyone).verdict(), ConformVerdict::Conforms);
        }
    }
}

/// The index of the first event that a predicate holds for after so many of them.
fn nth(events: &RunEvents, number: usize, is: impl Fn(&CheckedKind) -> bool) -> usize {
    let found = events.events.iter().enumerate().filter(|(_, event)| is(&event.kind));
    found.map(|(index, _)| index).nth(number).expect("so many")
}

fn is_action(kind: &CheckedKind) -> bool {
    matches!(kind, CheckedKind::Action { .. })
}

/// A run in a known world is the only one of its algorithm there: any other log diverges where it differs first.
#[test]
fn an_action_that_is_left_out_or_done_twice_is_found_where_the_log_differs_first() {
    let graph = bow_tie();
    for algorithm in moving() {
        let good = recorded(algorithm, &graph, Dart(0));
        let config = known(&graph, Some(Dart(0)), algorithm);
        let check = |mut events: RunEvents| {
            let pairs = events.events.iter().zip(&good.events);
            let first = pairs.take_while(|(one, other)| one == other).count();
            let is_part = first == events.events.len();
            events.end = events.end.filter(|_| !is_part);
            let found = judged(&events, &config).divergence;
            let expected = (!is_part).then_some(first);
            let what = format!("{}: {found:?}", algorithm.aid().name());
            assert_eq!(found.map(|found| found.event), expected, "{what}");
        };
        let actions = good.events.iter().filter(|event| is_action(&event.kind)).count();
        for number in 0..actions {
            let at = nth(&good, number, is_action);
            // With what was perceived then.
            let [mut left_out, mut twice, mut end] = [good.clone(), good.clone(), good.clone()];
            left_out.events.drain(at..at + 2);
            let again = good.events[at..at + 2].to_vec();
            twice.events.splice(at..at, again);
            end.events.truncate(at + 1);
            for events in [left_out, twice, end] {
                check(events);
            }
        }
    }
}

#[test]
fn what_cannot_be_done_in_the_known_world_is_a_divergence_by_itself() {
    let graph = bow_tie();
    let algorithm = moving().find(|it| it.aid().name() == "movable").unwrap();
    let mut events = recorded(algorithm, &graph, Dart(0));
    let drop =
        |kind: &CheckedKind| matches!(kind, CheckedKind::Action { action: AidAction::Drop, .. });
    let at = nth(&events, 0, drop);
    events.events[at].kind = CheckedKind::Action { number: None, action: AidAction::PickUp };
    let anyone = driven(known(&graph, Some(Dart(0)), algorithm), RunDriver::Anyone);
    let found = divergence(&events, &anyone);
    assert_eq!(place_of(&found), (at, "impossible-action"));
    assert_eq!(found.fault, FaultClass::Algorithm);
    // With the algorithm it is the same event, and the algorithm's own action is named.
    let found = divergence(&events, &config(algorithm));
    assert_eq!(place_of(&found), (at, "action"));
    let DivergenceCause::Algorithm(departure) = found.cause else { panic!() };
    assert!(departure.allowed[0].to_string().starts_with("drop ("), "{departure:?}");
}

#[test]
fn a_wrong_percept_is_found_where_the_marker_was_dropped() {
    let graph = bow_tie();
    for algorithm in moving() {
        let good = recorded(algorithm, &graph, Dart(0));
        let config = known(&graph, Some(Dart(0)), algorithm);
        for at in (0..good.events.len()).filter(|&at| good.events[at].arrival().is_some()) {
            let wrong = with_more_doors(&good, &[at], 1);
            let found = divergence(&wrong, &config);
            assert_eq!((found.event, found.cause.name()), (at, "percept"));
        }
    }
}

#[test]
fn a_robot_with_a_fixed_marker_does_nothing_with_it() {
    let graph = bow_tie();
    let algorithm = moving().next().unwrap();
    let events = recorded(algorithm, &graph, Dart(0));
    let fixed = ConformConfig { aid: Undirected.into(), ..by_anyone() };
    let error = judgement(&events, &fixed).unwrap_err();
    let event = nth(&events, 0, is_action) + 1;
    assert!(matches!(error, JudgeError::Action { event: found, .. } if found == event), "{error}");
    // An algorithm needs its own aid.
    let other = ConformConfig { aid: AidKind::from(Undirected), ..config(algorithm) };
    assert!(matches!(judgement(&events, &other), Err(JudgeError::Algorithm { .. })));
}

/// Nobody is accused because a log is checked for another aid than that of its robot.
#[test]
fn what_is_seen_of_another_aid_is_an_error() {
    let graph = bow_tie();
    for (recorded_aid, checked_aid, seen) in [
        ("team-2", "movable", "robot 2 here along door 0"),
        ("movable-2-distinct", "movable-2", "first and second marker"),
        ("string-1", "team-2", "fixed end"),
        ("team-2", "team-3", "robot 2 here along door 0"),
    ] {
        let algorithm = moving().find(|it| it.aid().name() == recorded_aid).unwrap();
        let events = recorded(algorithm, &graph, Dart(0));
        let aid = aid::named(checked_aid).unwrap();
        let config = ConformConfig { aid, ..by_anyone() };
        let error = judgement(&events, &config).unwrap_err().to_string();
        let expected = format!("in event 1 its robot sees `{seen}");
        assert!(error.starts_with(&expected), "{error}");
    }
}

#[test]
fn a_log_with_actions_is_shortened_with_them() {
    let graph = bow_tie();
    let algorithm = moving().find(|it| it.aid().name() == "movable").unwrap();
    let good = recorded(algorithm, &graph, Dart(0));
    let is_door = |kind: &CheckedKind| matches!(kind, CheckedKind::Door { .. });
    let last = 1 + (0..good.events.len()).rfind(|&at| is_door(&good.events[at].kind)).unwrap();
    let wrong = with_more_doors(&good, &[last], 1);
    let config = driven(known(&graph, Some(Dart(0)), algorithm), RunDriver::Anyone);
    let judged = judged(&wrong, &config);
    let shorter = shorten_run(&judged, &config, &()).expect("a shorter run");
    assert!(shorter.events.events.len() < wrong.events.len());
    let found = divergence(&shorter.events, &config);
    assert_eq!(place_of(&found), (shorter.event, "percept"));
}
