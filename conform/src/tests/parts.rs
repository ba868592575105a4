//! Facts on the parts of the check: what the head of a log decides, what is not known of a run, excursions, and
//! shorter logs.

use toposlam_logs::{messages::Run, world_hash};
use toposlam_model::{format::named_world::NamedWorld, marker::NoMarker};

use super::*;

/// The good run of most tests, and where it starts.
fn good_run() -> (Arc<FloorPlan>, Dart, Log) {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let facing = starts_of(&plan)[0];
    let log = log(&plan, facing, 1);
    (plan, facing, log)
}

fn arrival(number: u32, degree: u32, sighting: Option<Sighting>) -> CheckedEvent {
    let arrival = Arrival { number: Some(number), degree, sighting, form: None, entry: None };
    let kind = CheckedKind::Arrival { arrival, entry_off: None, hallway: None };
    CheckedEvent { source: EventSource::default(), kind }
}

fn door(number: u32, door: u32) -> CheckedEvent {
    let kind = CheckedKind::Door { door: Door(door), number: Some(number), off: None };
    CheckedEvent { source: EventSource::default(), kind }
}

fn other(kind: CheckedKind) -> CheckedEvent {
    CheckedEvent { source: EventSource::default(), kind }
}

fn of(events: Vec<CheckedEvent>) -> RunEvents {
    RunEvents { events, ..RunEvents::default() }
}

#[test]
fn a_log_may_show_a_marker_unless_it_records_that_none_was_seen() {
    let shows = |sighting| of(vec![door(1, 0), arrival(1, 2, sighting)]).may_show_marker();
    assert!(shows(None), "that is not recorded");
    assert!(shows(Some(Sighting::Lying(1))));
    assert!(!shows(Some(Sighting::Nothing)));
    assert!(!of(vec![door(1, 0)]).may_show_marker());
    // Without a marker in its head, such a log is compared with no algorithm.
    let none = of(vec![arrival(0, 2, Some(Sighting::Nothing))]);
    let algorithm = MappingAlgorithm::Folding;
    let head = Run { marker: "directional".to_owned(), ..Run::default() };
    assert_eq!(LogHead(None).check_marker(&none, algorithm), Err(MarkerNotShown { algorithm }));
    assert_eq!(LogHead(Some(&Run::default())).check_marker(&none, algorithm).ok(), None);
    assert_eq!(LogHead(Some(&head)).check_marker(&none, algorithm), Ok(()));
    let unknown = of(vec![arrival(0, 2, None)]);
    assert_eq!(LogHead(None).check_marker(&unknown, algorithm), Ok(()));
}

#[test]
fn a_directional_marker_lies_along_a_door() {
    let mut events = of(vec![arrival(0, 2, Some(Sighting::Lying(1)))]);
    assert_eq!(events.complete_sightings(&Directional), Err(SightingError::NoDoor));
    assert_eq!(events.complete_sightings(&NoMarker), Ok(()));
}

#[test]
fn a_head_decides_the_marker_the_algorithm_the_start_and_the_world() {
    let (plan, facing, _) = good_run();
    let world = NamedWorld {
        plan: Some((*plan).clone()),
        ..NamedWorld::numbered("here", "", plan.graph().clone(), Some(facing))
    };
    let run = Run {
        marker: "undirected".to_owned(),
        algorithm: "folding max-moves=25".to_owned(),
        world: "there".to_owned(),
        world_hash: world_hash(&world.graph, facing),
        start: world.start_text(facing),
        ..Run::default()
    };
    let head = LogHead(Some(&run));
    assert_eq!(head.marker().unwrap().name(), "undirected");
    assert_eq!(LogHead(None).marker().unwrap().name(), "directional");
    assert_eq!(head.settings(None).unwrap().budget.moves, Some(25));
    let unknown = Run { algorithm: "bold".to_owned(), ..run.clone() };
    assert_eq!(LogHead(Some(&unknown)).settings(None), Err("bold".to_owned()));
    assert_eq!(head.start(&world), Some(facing));
    assert!(!head.is_of_other_world(&world.graph));
    // The same names in another world are other places.
    let elsewhere = Run { world_hash: "0".repeat(64), ..run };
    let head = LogHead(Some(&elsewhere));
    assert_eq!((head.start(&world), head.is_of_other_world(&world.graph)), (None, true));
    // A log without a hash may be of any world.
    assert!(!LogHead(Some(&Run::default())).is_of_other_world(&world.graph));
}

#[test]
fn what_comes_after_an_unrecognised_junction_is_not_checked() {
    let (plan, facing, log) = good_run();
    let question = question(&plan, Some(facing));
    let good = log.recorded();
    let unclear = |source| {
        let kind = CheckedKind::Undecided(UndecidedCause::Unclear);
        CheckedEvent { source, kind }
    };
    for at in [4, 8] {
        let mut events = good.clone();
        events.events.insert(at, unclear(good.events[at].source));
        // What follows contradicts everything before.
        if let CheckedKind::Arrival { arrival, .. } = &mut events.events[at + 1].kind {
            arrival.degree += 5;
        }
        let judgement = judged(&events, &question);
        assert_eq!((judgement.unrecognised, &judgement.divergence), (Some(at), &None));
        assert_eq!(judgement.verdict(), ConformVerdict::Incomplete);
        assert_eq!(judgement.events, events);
        let before = judged(&good.up_to(at - 1), &question);
        assert_eq!((judgement.trace, judgement.coverage), (before.trace, before.coverage));
    }
    // Of a run that begins with one, nothing is known.
    let mut events = good.clone();
    events.events.insert(0, unclear(EventSource::default()));
    for question in [question, without_world()] {
        let judgement = judged(&events, &question);
        assert_eq!((judgement.unrecognised, &judgement.divergence), (Some(0), &None));
        assert_eq!((judgement.determines_world(), judgement.candidates()), (None, 0));
        assert!(judgement.trail.is_none() && judgement.algorithm.is_none());
        assert_eq!((judgement.smallest, judgement.coverage), (None, RunCoverage::default()));
        assert_eq!(judgement.events, events);
    }
}

#[test]
fn excursions_are_left_out_of_the_moves_and_turn_the_next_door() {
    let nothing = Some(Sighting::Nothing);
    let back = || other(CheckedKind::TurnedBack);
    let events = of(vec![
        arrival(0, 1, nothing),
        door(1, 0),
        arrival(1, 3, nothing),
        door(2, 1),
        back(),
        arrival(2, 3, nothing),
        // Seen from the door of the first excursion, the entry door is door 2.
        door(3, 2),
        back(),
        arrival(3, 3, nothing),
        door(4, 1),
        arrival(4, 1, nothing),
    ]);
    let left = events.without_excursions();
    let expected = [
        arrival(0, 1, nothing),
        door(1, 0),
        arrival(1, 3, nothing),
        door(2, 1),
        arrival(2, 1, nothing),
    ];
    assert_eq!(left.events, expected);
    assert!(left.may_turn_back);
}

#[test]
fn the_first_events_of_a_run_have_its_uncertainty() {
    let (_, _, log) = good_run();
    let first = log.recorded().up_to(3);
    assert_eq!(
        (first.events.len(), first.measurement_noise, first.has_head),
        (4, log_noise(), true)
    );
    assert_eq!(first.end, None);
}

#[test]
fn a_run_begins_where_the_marker_lies() {
    let (_, _, log) = good_run();
    let mut events = log.recorded();
    if let CheckedKind::Arrival { arrival, .. } = &mut events.events[0].kind {
        arrival.sighting = Some(Sighting::Nothing);
    }
    let divergence = judged(&events, &without_world()).divergence.unwrap();
    let cause = "a run begins where the marker lies, directed along the entry door";
    assert_eq!((divergence.event, divergence.cause.to_string().as_str()), (0, cause));
}

/// The shorter log of a run with a changed event, and the divergence of the run.
fn shortened(event: usize, change: impl Fn(&mut Arrival)) -> (ShortenedRun, Divergence) {
    let (plan, facing, log) = good_run();
    let mut events = log.recorded();
    match &mut events.events[event].kind {
        CheckedKind::Arrival { arrival, .. } => change(arrival),
        other => panic!("{other:?} is not an arrival"),
    }
    let question = question(&plan, Some(facing));
    let judgement = judged(&events, &question);
    let shorter = shorten_run(&judgement, &question, &()).unwrap();
    (shorter, judgement.divergence.unwrap())
}

/// More doors than any junction has.
fn many_doors(arrival: &mut Arrival) {
    (arrival.degree, arrival.form) = (9, None);
}

fn wrong_number(arrival: &mut Arrival) {
    arrival.number = Some(99);
}

#[test]
fn a_shorter_log_of_a_wrong_percept_needs_its_world_and_few_events() {
    let (_, _, good) = good_run();
    let last = good.places().len() - 1;
    let (ShortenedRun { events, event, by_itself }, divergence) = shortened(last, many_doors);
    assert_eq!((divergence.event, event + 1, by_itself), (last, events.events.len(), false));
    assert!(event < last, "{event}");
    assert!(events.has_head);
    // Its events are a second apart, and its moves are counted from the first.
    for (index, event) in events.events.iter().enumerate() {
        assert_eq!(event.source.time, index as u64 * 1_000_000_000);
        let counted = match &event.kind {
            CheckedKind::Arrival { arrival, .. } => arrival.number,
            CheckedKind::Door { number, .. } => *number,
            other => panic!("{other:?}"),
        };
        assert_eq!(counted, Some(index.div_ceil(2) as u32));
    }
}

#[test]
fn a_shorter_log_of_a_wrong_number_begins_at_the_arrival_before() {
    let (ShortenedRun { events, event, by_itself }, divergence) = shortened(6, wrong_number);
    assert_eq!((divergence.event, divergence.cause.name()), (6, "number"));
    // Alone, the event would be the first, whose number counts from itself.
    assert_eq!((event, by_itself, events.events.len()), (2, true, 4));
    assert!(events.has_head && !events.may_turn_back);
    assert_eq!(events.measurement_noise, log_noise());
    let CheckedKind::Arrival { arrival, hallway, .. } = &events.events[0].kind else {
        panic!("{events:?}")
    };
    assert_eq!((arrival.number, *hallway), (Some(0), None));
}

#[test]
fn a_wrong_end_has_no_shorter_log() {
    let (plan, facing, log) = good_run();
    let question = question(&plan, Some(facing));
    let mut events = log.recorded();
    events.end.as_mut().unwrap().moves += 1;
    let judgement = judged(&events, &question);
    assert_eq!(judgement.divergence.as_ref().unwrap().cause.name(), "moves");
    assert_eq!(shorten_run(&judgement, &question, &()), None);
    let good = judged(&log.recorded(), &question);
    assert_eq!(shorten_run(&good, &question, &()), None);
}

#[test]
fn divergences_are_alike_if_cause_class_and_expectation_are() {
    let (_, _, log) = good_run();
    let expected = |divergence: &Divergence| match &divergence.cause {
        DivergenceCause::World(misfit) => misfit.candidates[0].1,
        other => panic!("{other:?} at a junction with nine doors"),
    };
    let arrivals = (2..log.places().len()).step_by(2);
    let all: Vec<_> = arrivals.map(|event| shortened(event, many_doors).1).collect();
    let alike = |other: &Divergence| expected(&all[0]) == expected(other);
    assert!(all.iter().any(|other| !alike(other)), "all junctions are expected to be equal");
    for other in all.iter().filter(|other| other.fault == all[0].fault) {
        assert_eq!(all[0].is_like(other), alike(other));
    }
    let (_, number) = shortened(6, wrong_number);
    assert!(number.is_like(&number) && !number.is_like(&all[0]) && !all[0].is_like(&number));
    let other_class = Divergence { fault: FaultClass::Motion, ..number.clone() };
    assert!(!number.is_like(&other_class));
}
