//! What a judgement reports beside its verdict: causes, counts of cases, candidates, and limits of tolerance.

use std::{
    collections::{BTreeMap, BTreeSet},
    f64::consts::{FRAC_PI_2, FRAC_PI_4},
};

use toposlam_model::{
    aid::{AidAction, Places, State, markers::MOVABLE},
    trace::{Departure, Misfit, MisfitReason, TraceEvent, TraceEventKind, TraceOrderError},
};

use serde_json::{Value, json};

use super::*;
use crate::divergence::{NAMES, OFF};

#[test]
fn each_cause_has_a_name_and_a_class() {
    use DivergenceCause::*;
    use FaultClass::{Algorithm as Chosen, Log, Motion, Perception};
    let percept = TraceEventKind::Percept(Percept { degree: 3, sighting: Sighting::Nothing });
    let (door, drop) = (TraceEventKind::Door(Door(1)), TraceEventKind::Action(AidAction::Drop));
    let [percept, door, drop] =
        [(4, percept), (5, door), (6, drop)].map(|(id, kind)| TraceEvent { id, kind });
    let misfit = |event| {
        let state = State { pose: Dart(0), placed: Places::from_elem(Some(Dart(0)), 1) };
        let candidates = vec![(state, MisfitReason::NoSuchDoor { degree: 1 })];
        World(Misfit { event, moves: 2, candidates })
    };
    let departure = |event| Algorithm(Departure { algorithm: FOLDING, event, allowed: Vec::new() });
    let measured = |measurement| Measurement { between: [2, 4], earlier: [0, 2], measurement };
    let why = Impossibility::Marker;
    let table = [
        (NotInTurn(TraceOrderError::NoDoor { event: 1 }), "not-in-turn", Log),
        (Number { expected: 2, recorded: 5 }, "number", Log),
        (Form { degree: 3, doors: 2 }, "form", Log),
        (LeftBetweenDoors { off: FRAC_PI_4 }, "aside", Motion),
        (Entry { off: FRAC_PI_2 }, "entry", Perception),
        (TurnedBack, "turned-back", Motion),
        (Return { before: 3, now: 4 }, "return", Perception),
        (measured(ContradictoryMeasurement::Length { before: 8.0, now: 14.2 }), "moved", Motion),
        (measured(ContradictoryMeasurement::Turn { before: 0.0, now: 1.0 }), "moved", Motion),
        (measured(ContradictoryMeasurement::ClosedTurns { quarters: 3 }), "moved", Motion),
        (measured(ContradictoryMeasurement::ClosedWalk { off: 3.0, way: 41.0 }), "moved", Motion),
        (measured(ContradictoryMeasurement::Shape), "shape", Perception),
        (Undecided(UndecidedCause::Unclear), "undecided", Perception),
        (Driven, "driven", Perception),
        (misfit(percept), "percept", Perception),
        (misfit(door), "no-such-door", Chosen),
        (misfit(drop), "impossible-action", Chosen),
        (NoWorld { event: percept, why }, "no-world", Perception),
        (NoWorld { event: door, why }, "no-world", Chosen),
        (departure(percept), "contradiction", Perception),
        (departure(door), "door", Chosen),
        (departure(drop), "action", Chosen),
        (Unfinished { unexplored: 3 }, "unfinished", Chosen),
        (Map { algorithm: FOLDING }, "map", Chosen),
        (WrongMap, "wrong-map", Chosen),
        (Moves { made: 7, recorded: 8 }, "moves", Log),
    ];
    for (cause, name, fault) in &table {
        assert_eq!((cause.name(), cause.fault()), (*name, *fault));
    }
    let names: BTreeSet<_> = table.iter().map(|(cause, ..)| cause.name()).collect();
    assert_eq!(names, BTreeSet::from(NAMES));
}

#[test]
fn the_numbers_of_a_cause_are_in_its_json() {
    use DivergenceCause::*;
    let measurement = ContradictoryMeasurement::Shape;
    let nothing = Value::Null;
    for (cause, counts, off, events) in [
        (Number { expected: 2, recorded: 5 }, json!([2, 5]), &nothing, &nothing),
        (Moves { made: 7, recorded: 8 }, json!([7, 8]), &nothing, &nothing),
        (Form { degree: 3, doors: 2 }, json!([2, 3]), &nothing, &nothing),
        (Return { before: 3, now: 4 }, json!([3, 4]), &nothing, &nothing),
        (Unfinished { unexplored: 3 }, json!([3, 0]), &nothing, &nothing),
        (LeftBetweenDoors { off: 0.5 }, Value::Null, &json!(0.5), &nothing),
        (Entry { off: 0.5 }, Value::Null, &json!(0.5), &nothing),
        (
            Measurement { between: [2, 4], earlier: [0, 2], measurement },
            Value::Null,
            &nothing,
            // They are counted from 1.
            &json!([[3, 5], [1, 3]]),
        ),
        (TurnedBack, Value::Null, &nothing, &nothing),
    ] {
        let found = serde_json::to_value(&cause).unwrap();
        assert_eq!([&found["expected"], &found["recorded"]], [&counts[0], &counts[1]], "{cause}");
        assert_eq!(&found["off"], off, "{cause}");
        assert_eq!([&found["between"], &found["earlier"]], [&events[0], &events[1]], "{cause}");
    }
}

#[test]
fn an_event_has_in_json_what_was_perceived_taken_or_done() {
    let action = CheckedKind::Action { number: None, action: AidAction::Drop };
    for (kind, expected) in [
        (
            bare_arrival(3, Sighting::Pointing(Door(2))),
            json!({"what": "percept", "degree": 3, "marker": 2, "door": null}),
        ),
        (
            bare_arrival(3, Sighting::Nothing),
            json!({"what": "percept", "degree": 3, "marker": -1, "door": null}),
        ),
        (
            bare_arrival(3, Sighting::Lying(1)),
            json!({"what": "percept", "degree": 3, "marker": true, "door": null}),
        ),
        (bare_door(2), json!({"what": "door", "degree": null, "marker": null, "door": 2})),
        (
            action,
            json!({"what": "action", "degree": null, "marker": null, "door": null, "action": "drop"}),
        ),
        (
            CheckedKind::TurnedBack,
            json!({"what": "turned-back", "degree": null, "marker": null, "door": null}),
        ),
    ] {
        assert_eq!(serde_json::to_value(&kind).unwrap(), expected);
    }
}

#[test]
fn a_verdict_has_a_name_and_words() {
    use ConformVerdict::*;
    for (verdict, name, words) in [
        (Conforms, "conforms", "conforms"),
        (Diverged, "diverged", "diverged"),
        (NotKnown, "not-known", "not known"),
    ] {
        assert_eq!(serde_json::to_value(verdict).unwrap(), name);
        assert_eq!((verdict.name(), verdict.in_words()), (name, words));
    }
}

#[test]
fn a_percept_that_departs_from_an_algorithm_is_one_of_no_start_or_a_contradiction() {
    let percept = TraceEventKind::Percept(Percept { degree: 3, sighting: Sighting::Nothing });
    let words = |id, algorithm| {
        let event = TraceEvent { id, kind: percept };
        DivergenceCause::Algorithm(Departure { algorithm, event, allowed: Vec::new() }).to_string()
    };
    let at_marker = "a run begins where the marker lies, directed along the entry door";
    assert_eq!(words(0, FOLDING), at_marker);
    assert_eq!(words(2, FOLDING), "this percept contradicts the percepts before it");
    let movable = MappingAlgorithm::MovableMarkers(MOVABLE);
    let with_aid = "a run begins where the robot has all of its marking aid, `movable`";
    assert_eq!(words(0, movable), with_aid);
}

/// The events of a measurement are counted from 1.
#[test]
fn a_contradictory_measurement_names_its_events() {
    let words = |between, earlier, measurement| {
        DivergenceCause::Measurement { between, earlier, measurement }.to_string()
    };
    let length = ContradictoryMeasurement::Length { before: 8.0, now: 14.2 };
    assert_eq!(
        words([11, 13], [2, 4], length),
        "moved by hand or slipped between events 12 and 14: the hallway is 14.2 m long, and was 8.0 m \
         between events 3 and 5"
    );
    let shape = ContradictoryMeasurement::Shape;
    let expected = "the junction has another shape than at event 3";
    assert_eq!(words([2, 13], [2, 13], shape), expected);
}

#[test]
fn arrivals_are_counted_by_the_shape_of_their_junction() {
    let events = log(&place_in("shape-6"), 1).recorded();
    let mut expected = BTreeMap::new();
    for shape in events.events.iter().filter_map(|event| event.arrival()?.shape) {
        *expected.entry(shape).or_insert(0) += 1;
    }
    assert!(expected.values().any(|&count| count > 1), "{expected:?}");
    assert_eq!(judged(&events, &without_world()).coverage.junctions, expected);
}

#[test]
fn the_candidates_are_the_poses_that_are_left() {
    let (plan, facing) = place_in("shape-6");
    let events = log(&(plan.clone(), facing), 1).recorded();
    let anywhere = anywhere_in(&plan);
    let judgement = judged(&events, &anywhere);
    // In a known world none is searched.
    assert_eq!((judgement.candidates(), judgement.smallest), (1, None));
    assert_eq!(judged(&events, &without_world()).candidates(), 1);
    // Before the first move, each pose with as many doors is one.
    let begun = RunEvents { has_head: false, ..events.up_to(0) };
    let anywhere = driven(anywhere, RunDriver::Anyone);
    let graph = plan.graph();
    let degree = |dart| graph.degree(graph.vertex(dart));
    let alike = graph.darts().filter(|&dart| degree(dart) == degree(facing)).count();
    assert!(alike > 1);
    assert_eq!(judged(&begun, &anywhere).candidates(), alike);
    // Shape 6 has six edges.
    let search = WorldSearch { max_edges: Some(5), ..without_world().search };
    assert_eq!(judged(&events, &ConformConfig { search, ..without_world() }).candidates(), 0);
}

/// An angle by odometry contradicts a door if it is larger than [`OFF`].
#[test]
fn the_largest_angle_that_odometry_may_have_is_no_contradiction() {
    let config = at_place(&place());
    for (event, name) in [(2, "entry"), (3, "aside")] {
        let with = |angle: f64| {
            let mut events = good_run();
            match &mut events.events[event].kind {
                CheckedKind::Arrival { entry_off: off, .. } | CheckedKind::Door { off, .. } => {
                    *off = Some(angle);
                }
                other => panic!("{other:?}"),
            }
            judged(&events, &config).divergence.as_ref().map(place_of)
        };
        assert_eq!((with(OFF), with(OFF + 1e-9)), (None, Some((event, name))));
    }
}

#[test]
fn an_event_that_is_earlier_than_the_one_before_it_is_named() {
    let mut events = good_run();
    let before = events.events[2].source.time;
    // Two events may have the same time.
    events.events[3].source.time = before;
    let error = |events: &RunEvents| judgement(events, &without_world()).err();
    assert_eq!(error(&events), None);
    events.events[3].source.time = before - 1;
    let order = OutOfOrder { time: before - 1, before };
    assert_eq!(error(&events), Some(JudgeError::OutOfOrder { event: 4, order }));
}

/// What explains the events before a divergence is no world of the log.
#[test]
fn a_log_that_no_world_explains_has_no_smallest_world() {
    let good = good_run();
    let last = good.events.len() - 1;
    let judgement = judged(&with_more_doors(&good, &[last], 9), &by_anyone());
    assert_eq!(judgement.divergence.map(|found| found.event), Some(last));
    assert_eq!(judgement.smallest, None);
}
