//! What a judgement reports beside its verdict: causes in words, counts of cases, candidates, and limits of
//! tolerance.

use std::{
    collections::{BTreeMap, BTreeSet},
    f64::consts::{FRAC_PI_2, FRAC_PI_4},
};

use toposlam_model::{
    trace::{Departure, Misfit, MisfitReason, TraceEvent, TraceEventKind, TraceOrderError},
    world::State,
};

use super::*;
use crate::divergence::{NAMES, OFF};

/// A percept, and a door after it.
fn percept_and_door() -> [TraceEvent; 2] {
    let percept = Percept { degree: 3, sighting: Sighting::Nothing };
    [(4, TraceEventKind::Percept(percept)), (5, TraceEventKind::Door(Door(1)))]
        .map(|(id, kind)| TraceEvent { id, kind })
}

/// An event that does not fit this many poses.
fn misfit(event: TraceEvent, poses: u32) -> DivergenceCause {
    let state = |pose| State { pose: Dart(pose), placed: None };
    let why = MisfitReason::NoSuchDoor { degree: 1 };
    let candidates = (0..poses).map(|pose| (state(pose), why)).collect();
    DivergenceCause::World(Misfit { event, moves: 2, candidates })
}

fn departure(event: TraceEvent, algorithm: MappingAlgorithm) -> DivergenceCause {
    DivergenceCause::Algorithm(Departure { algorithm, event, allowed: Vec::new() })
}

#[test]
fn each_cause_has_a_name_a_class_and_words() {
    use DivergenceCause::*;
    use FaultClass::{Algorithm as Chosen, Log, Motion, Perception};
    use MappingAlgorithm::{Algorithm1, Folding};
    let [percept, door] = percept_and_door();
    let why = Impossibility::Marker;
    let no_world = "no world of any size explains the log up to here: the robot has no marker, and perceived one";
    let table = [
        (
            NotInTurn(TraceOrderError::NoDoor { event: 1 }),
            "not-in-turn",
            Log,
            "a percept follows a percept: no door was taken in between",
        ),
        (
            Number { expected: 2, recorded: 5 },
            "number",
            Log,
            "its move number is 2, and the log records 5",
        ),
        (Form { degree: 3, doors: 2 }, "form", Log, "its degree is 3, but it has 2 doors"),
        (Aside { off: FRAC_PI_4 }, "aside", Motion, "the robot drove off 45 degrees from the door"),
        (
            Entry { off: FRAC_PI_2 },
            "entry",
            Perception,
            "by odometry the robot came from a direction 90 degrees off the entry door",
        ),
        (TurnedBack, "turned-back", Motion, "the robot turned back before it reached a junction"),
        (
            Return { before: 3, now: 4 },
            "return",
            Perception,
            "the robot turned back and entered the junction that it had left: 3 doors, now 4",
        ),
        (
            Undecided(UndecidedCause::Unclear),
            "undecided",
            Perception,
            "the robot was at a junction that was not seen clearly",
        ),
        (
            Undecided(UndecidedCause::UnseenArm),
            "undecided",
            Perception,
            "the robot was at a junction that may have an arm that its scanner did not look into",
        ),
        (misfit(percept, 1), "percept", Perception, "it does not fit the known world"),
        (
            misfit(door, 2),
            "no-such-door",
            Chosen,
            "it fits none of the 2 candidate poses in the known world",
        ),
        (NoWorld { event: percept, why }, "no-world", Perception, no_world),
        (NoWorld { event: door, why }, "no-world", Chosen, no_world),
        (
            departure(percept, Algorithm1),
            "contradiction",
            Perception,
            "this percept contradicts the percepts before it",
        ),
        (departure(door, Algorithm1), "door", Chosen, "no run of Algorithm 1 takes this door here"),
        (
            departure(door, Folding),
            "door",
            Chosen,
            "the folding explorer does not take this door here",
        ),
        (
            Unfinished { unexplored: 3 },
            "unfinished",
            Chosen,
            "the log records that the map is complete; 3 edge ends are unexplored",
        ),
        (
            Map { algorithm: Folding },
            "map",
            Chosen,
            "the recorded map is not the map of the folding explorer",
        ),
        (WrongMap, "wrong-map", Chosen, "the map is not the known world"),
        (
            Moves { made: 7, recorded: 8 },
            "moves",
            Log,
            "the log records that 8 moves were made; it has 7",
        ),
    ];
    for (cause, name, fault, words) in &table {
        assert_eq!((cause.name(), cause.fault(), &*cause.to_string()), (*name, *fault, *words));
    }
    let names = table.iter().map(|(cause, ..)| cause.name()).chain(["moved", "shape"]);
    assert_eq!(names.collect::<BTreeSet<_>>(), BTreeSet::from(NAMES));
}

#[test]
fn each_contradictory_measurement_has_a_name_a_class_and_words() {
    use ContradictoryMeasurement::{ClosedTurns, ClosedWalk, Length, Shape, Turn};
    use DivergenceCause::Measurement;
    use FaultClass::{Motion, Perception};
    let table = [
        (
            Measurement {
                between: [11, 13],
                earlier: [2, 4],
                measurement: Length { before: 8.0, now: 14.2 },
            },
            "moved",
            Motion,
            "moved by hand or slipped between events 12 and 14: the hallway is 14.2 m long, and was 8.0 m \
             between events 3 and 5",
        ),
        (
            Measurement {
                between: [11, 13],
                earlier: [2, 4],
                measurement: Turn { before: 0.0, now: -FRAC_PI_2 },
            },
            "moved",
            Motion,
            "moved by hand or slipped between events 12 and 14: the hallway turns by -90 degrees, and by 0 \
             between events 3 and 5",
        ),
        (
            Measurement {
                between: [2, 13],
                earlier: [2, 13],
                measurement: ClosedTurns { quarters: 3 },
            },
            "moved",
            Motion,
            "moved by hand or slipped between events 3 and 14: the turns of this closed walk are 270 degrees \
             too many",
        ),
        (
            Measurement {
                between: [2, 13],
                earlier: [2, 13],
                measurement: ClosedWalk { off: 3.04, way: 41.0 },
            },
            "moved",
            Motion,
            "moved by hand or slipped between events 3 and 14: this closed walk of 41.0 m ends 3.0 m from \
             where it began",
        ),
        (
            Measurement { between: [2, 13], earlier: [2, 13], measurement: Shape },
            "shape",
            Perception,
            "the junction has another shape than at event 3",
        ),
    ];
    for (cause, name, fault, words) in &table {
        assert_eq!((cause.name(), cause.fault(), &*cause.to_string()), (*name, *fault, *words));
    }
}

#[test]
fn a_marker_that_is_elsewhere_after_turning_back_has_words_of_its_own() {
    let words = DivergenceCause::Return { before: 3, now: 3 }.to_string();
    assert!(words.ends_with("the marker is elsewhere"), "{words}");
}

#[test]
fn classes_and_verdicts_have_names() {
    let classes = FaultClass::ALL.map(|class| format!("{class:>10}"));
    assert_eq!(classes, ["perception", "    motion", " algorithm", "       log"]);
    let verdicts = [ConformVerdict::Conforms, ConformVerdict::Diverged, ConformVerdict::Incomplete];
    assert_eq!(verdicts.map(ConformVerdict::name), ["conforms", "diverged", "incomplete"]);
}

#[test]
fn arrivals_are_counted_by_the_shape_of_their_junction() {
    let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == "shape-6").unwrap();
    let events = log(&plan, starts_of(&plan)[0], 1).recorded();
    let mut expected = BTreeMap::new();
    for event in &events.events {
        if let CheckedKind::Arrival { arrival: Arrival { form: Some(form), .. }, .. } = event.kind {
            *expected.entry(form).or_insert(0) += 1;
        }
    }
    assert!(expected.values().any(|&count| count > 1), "{expected:?}");
    let coverage = judged(&events, &without_world()).coverage;
    assert_eq!(coverage.junctions, expected);
    let mut twice = coverage.clone();
    twice.include(&coverage);
    for (form, count) in &twice.junctions {
        assert_eq!(*count, 2 * expected[form]);
    }
    for case in toposlam_model::trace::AlgorithmCase::ALL {
        assert_eq!(twice.algorithm.count(case), 2 * coverage.algorithm.count(case));
    }
}

#[test]
fn the_candidates_are_the_poses_that_are_left() {
    let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == "shape-6").unwrap();
    let facing = starts_of(&plan)[0];
    let events = log(&plan, facing, 1).recorded();
    assert_eq!(judged(&events, &question(&plan, None)).candidates(), 1);
    assert_eq!(judged(&events, &without_world()).candidates(), 1);
    // Before the first move, each pose with as many doors is one.
    let begun = RunEvents { has_head: false, end: None, ..events.up_to(0) };
    let anywhere = ConformConfig { driver: RunDriver::Anyone, ..question(&plan, None) };
    let graph = plan.graph();
    let degree = |dart| graph.degree(graph.vertex(dart));
    let alike = graph.darts().filter(|&dart| degree(dart) == degree(facing)).count();
    assert!(alike > 1);
    assert_eq!(judged(&begun, &anywhere).candidates(), alike);
    // In a known world none is searched.
    assert_eq!(judged(&events, &question(&plan, None)).smallest, None);
    // Shape 6 has six edges.
    let search = WorldSearch { max_edges: Some(5), ..without_world().search };
    assert_eq!(judged(&events, &ConformConfig { search, ..without_world() }).candidates(), 0);
}

/// An angle by odometry contradicts a door if it is larger than [`OFF`].
#[test]
fn the_largest_angle_that_odometry_may_have_is_no_contradiction() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let facing = starts_of(&plan)[0];
    let good = log(&plan, facing, 1).recorded();
    let question = question(&plan, Some(facing));
    for (event, name) in [(2, "entry"), (3, "aside")] {
        let with = |angle: f64| {
            let mut events = good.clone();
            match &mut events.events[event].kind {
                CheckedKind::Arrival { entry_off: off, .. } | CheckedKind::Door { off, .. } => {
                    *off = Some(angle);
                }
                other => panic!("{other:?}"),
            }
            let divergence = judged(&events, &question).divergence;
            divergence.map(|found| (found.event, found.cause.name()))
        };
        assert_eq!((with(OFF), with(OFF + 1e-9)), (None, Some((event, name))));
    }
}

#[test]
fn an_event_that_is_earlier_than_the_one_before_it_is_named() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let mut events = log(&plan, starts_of(&plan)[0], 1).recorded();
    let before = events.events[2].source.time;
    // Two events may have the same time.
    events.events[3].source.time = before;
    let error =
        |events: &RunEvents| judge(events.clone(), &without_world(), &Quirks::default(), &()).err();
    assert_eq!(error(&events), None);
    events.events[3].source.time = before - 1;
    let order = OutOfOrder { time: before - 1, before };
    assert_eq!(error(&events), Some(JudgeError::OutOfOrder { event: 4, order }));
}

/// What explains the events before a divergence is no world of the log.
#[test]
fn a_log_that_no_world_explains_has_no_smallest_world() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let mut events = log(&plan, starts_of(&plan)[0], 1).recorded();
    let last = events.events.len() - 1;
    let CheckedKind::Arrival { arrival, .. } = &mut events.events[last].kind else { panic!() };
    arrival.degree = 9;
    arrival.form = None;
    let anyone = ConformConfig { driver: RunDriver::Anyone, ..without_world() };
    let judgement = judged(&events, &anyone);
    assert_eq!(judgement.divergence.map(|found| found.event), Some(last));
    assert_eq!(judgement.smallest, None);
}
