//! Facts on the parts of the check: what the head of a log decides, what is not known of a run, excursions, and
//! shorter logs.

use toposlam_logs::{messages::Run, world_hash};
use toposlam_model::{aid::AidKind, format::named_world::NamedWorld, marker::NoMarker};

use super::*;

#[test]
fn a_log_may_show_a_marker_unless_it_records_that_none_was_seen() {
    let events = |sighting| {
        let mut events = bare_events([bare_door(0), bare_arrival(2, Sighting::Nothing)]);
        arrival_at(&mut events, 1).sighting = sighting;
        events
    };
    let [unknown, lying, none] =
        [None, Some(Sighting::Lying(1)), Some(Sighting::Nothing)].map(events);
    let shows = [&unknown, &lying, &none, &bare_events([bare_door(0)])];
    assert_eq!(shows.map(RunEvents::may_show_marker), [true, true, false, false]);
    // Without a marker in its head, a log that shows none is compared with no algorithm.
    let (unmarked, marked) =
        (Run::default(), Run { marker: "directional".to_owned(), ..Run::default() });
    for (head, events, is_compared) in [
        (None, &none, false),
        (Some(&unmarked), &none, false),
        (Some(&marked), &none, true),
        (None, &unknown, true),
    ] {
        let found = LogHead(head).check_marker(events, FOLDING);
        assert_eq!(found.is_ok(), is_compared, "{head:?}");
    }
    // A directional marker lies along a door.
    let completed = |marker| lying.clone().complete_sightings(AidKind::from(marker));
    assert_eq!(completed(Directional), Err(SightingError::NoDoor));
    assert_eq!(completed(NoMarker), Ok(()));
}

#[test]
fn a_head_decides_the_marker_the_algorithm_the_start_and_the_world() {
    let (plan, facing) = place();
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
    assert_eq!(head.aid().unwrap().name(), "undirected");
    assert_eq!(LogHead(None).aid().unwrap().name(), "directional");
    let carried = Run { marker: "movable".to_owned(), ..run.clone() };
    assert_eq!(LogHead(Some(&carried)).aid().unwrap().name(), "movable");
    assert_eq!(head.settings(None).unwrap().budget.moves, Some(25));
    let unknown = Run { algorithm: "bold".to_owned(), ..run.clone() };
    assert_eq!(LogHead(Some(&unknown)).settings(None), Err("bold".to_owned()));
    // The same names in another world are other places. A log without a hash may be of any world.
    let elsewhere = Run { world_hash: "0".repeat(64), ..run.clone() };
    for (run, start, is_here) in [
        (&run, Some(facing), Some(true)),
        (&elsewhere, None, Some(false)),
        (&Run::default(), None, None),
    ] {
        let head = LogHead(Some(run));
        let found = (head.start(&world), head.is_recorded_in(&world.graph));
        assert_eq!(found, (start, is_here), "{run:?}");
    }
}

#[test]
fn what_comes_after_an_unrecognised_junction_is_not_checked() {
    let config = at_place(&place());
    let good = good_run();
    let with_unclear = |at: usize| {
        let kind = CheckedKind::Undecided(UndecidedCause::Unclear);
        let mut events = good.clone();
        events.events.insert(at, CheckedEvent { source: good.events[at].source, kind });
        events
    };
    for at in [4, 8] {
        // What follows contradicts everything before.
        let mut events = with_unclear(at);
        arrival_at(&mut events, at + 1).degree += 5;
        let judgement = judged(&events, &config);
        assert_eq!((judgement.unrecognised, &judgement.divergence), (Some(at), &None));
        assert_eq!(judgement.verdict(), ConformVerdict::NotKnown);
        assert_eq!(judgement.events, events);
        let before = judged(&good.up_to(at - 1), &config);
        assert_eq!((judgement.trace, judgement.coverage), (before.trace, before.coverage));
    }
    // Of a run that begins with one, nothing is known.
    let events = with_unclear(0);
    for config in [config, without_world()] {
        let judgement = judged(&events, &config);
        assert_eq!((judgement.unrecognised, &judgement.divergence), (Some(0), &None));
        assert_eq!((judgement.determines_world(), judgement.candidates()), (None, 0));
        assert!(judgement.trail.is_none() && judgement.algorithm.is_none());
        assert_eq!((judgement.smallest, judgement.coverage), (None, RunCoverage::default()));
        assert_eq!(judgement.events, events);
    }
}

#[test]
fn excursions_are_left_out_of_the_moves_and_turn_the_next_door() {
    let kinds = |steps: &[(u32, u32)]| {
        let mut moves = 0;
        let mut kinds = Vec::new();
        for &(degree, door) in steps {
            let mut arrival = bare_arrival(degree, Sighting::Nothing);
            if let CheckedKind::Arrival { arrival, .. } = &mut arrival {
                arrival.number = Some(moves);
            }
            moves += 1;
            let door = CheckedKind::Door { door: Door(door), number: Some(moves), off: None };
            kinds.extend([arrival, door]);
        }
        kinds
    };
    // Seen from the door of the first excursion, the entry door is door 2.
    let mut walk = kinds(&[(1, 0), (3, 1), (3, 2), (3, 1), (1, 0)]);
    walk.insert(6, CheckedKind::TurnedBack);
    walk.insert(4, CheckedKind::TurnedBack);
    let kept = bare_events(kinds(&[(1, 0), (3, 1), (1, 0)]));
    let left = bare_events(walk).without_excursions();
    assert_eq!(left, RunEvents { may_turn_back: true, ..kept });
}

#[test]
fn a_run_begins_where_the_marker_lies() {
    let mut events = good_run();
    arrival_at(&mut events, 0).sighting = Some(Sighting::Nothing);
    let found = divergence(&events, &without_world());
    let cause = "a run begins where the marker lies, directed along the entry door";
    assert_eq!((found.event, found.cause.to_string().as_str()), (0, cause));
}

/// The shorter log of a run with a changed event, and the divergence of the run.
fn shortened(event: usize, change: impl Fn(&mut Arrival)) -> (ShortenedRun, Divergence) {
    let mut events = good_run();
    change(arrival_at(&mut events, event));
    let config = at_place(&place());
    let judgement = judged(&events, &config);
    let shorter = shorten_run(&judgement, &config, &()).unwrap();
    (shorter, judgement.divergence.unwrap())
}

/// More doors than any junction has.
fn many_doors(arrival: &mut Arrival) {
    (arrival.degree, arrival.shape) = (9, None);
}

fn wrong_number(arrival: &mut Arrival) {
    arrival.number = Some(99);
}

#[test]
fn a_shorter_log_of_a_wrong_percept_needs_its_world_and_few_events() {
    let last = good_run().events.len() - 1;
    let (ShortenedRun { mut events, event, by_itself }, divergence) = shortened(last, many_doors);
    assert_eq!((divergence.event, event + 1, by_itself), (last, events.events.len(), false));
    assert!(event < last && events.has_head, "{event}");
    // Its events are a second apart, and its moves are counted from the first.
    for (index, event) in events.events.iter_mut().enumerate() {
        assert_eq!(event.source.time, index as u64 * 1_000_000_000);
        assert_eq!(event.number_mut(), Some(&mut (index.div_ceil(2) as u32)));
    }
}

#[test]
fn a_shorter_log_of_a_wrong_number_begins_at_the_arrival_before() {
    let (ShortenedRun { events, event, by_itself }, divergence) = shortened(6, wrong_number);
    assert_eq!(place_of(&divergence), (6, "number"));
    // Alone, the event would be the first, whose number counts from itself.
    assert_eq!((event, by_itself, events.events.len()), (2, true, 4));
    assert!(events.has_head && !events.may_turn_back && events.end.is_none());
    assert_eq!(events.measurement_noise, log_noise());
    let CheckedKind::Arrival { arrival, hallway: None, .. } = &events.events[0].kind else {
        panic!("{events:?}")
    };
    assert_eq!(arrival.number, Some(0));
}

#[test]
fn a_wrong_end_has_no_shorter_log() {
    let config = at_place(&place());
    let mut events = good_run();
    assert_eq!(shorten_run(&judged(&events, &config), &config, &()), None);
    events.end.as_mut().unwrap().moves += 1;
    let judgement = judged(&events, &config);
    assert_eq!(judgement.divergence.as_ref().unwrap().cause.name(), "moves");
    assert_eq!(shorten_run(&judgement, &config, &()), None);
}

#[test]
fn divergences_are_alike_if_cause_class_and_expectation_are() {
    let expected = |divergence: &Divergence| match &divergence.cause {
        DivergenceCause::World(misfit) => misfit.candidates[0].1,
        other => panic!("{other:?} at a junction with nine doors"),
    };
    let arrivals = (2..good_run().events.len()).step_by(2);
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
