//! Lengths and turns by odometry: logs of which a stretch was cut out, and logs that were spliced, diverge where
//! that happened.

use std::mem::discriminant;

use toposlam_model::{driving::scene::wrapped, marker::NoMarker, measurement::HallwayMeasurement};

use super::*;

/// The first divergence of these lines, with moves that are counted again.
fn divergence_of(mut lines: Vec<(TimedOdometry, EventKind)>) -> Option<Divergence> {
    let mut moves = 0;
    for (_, line) in &mut lines {
        match line {
            EventKind::Door { number, .. } => {
                moves += 1;
                *number = Some(moves);
            }
            EventKind::Arrival(arrival) => arrival.number = Some(moves),
            _ => {}
        }
    }
    let log = Log { lines, odometry: Odometry::default() };
    judged(&log.recorded(), &by_anyone()).divergence
}

/// Whether a measurement diverges, and if so whether this event is one of it, or one that it contradicts.
fn is_at(found: &Divergence, event: usize) -> Option<bool> {
    match found.cause {
        DivergenceCause::Measurement { between, earlier, .. } => {
            Some([between, earlier].iter().any(|[from, to]| (from..=to).contains(&&event)))
        }
        _ => None,
    }
}

/// Runs of the plans of `worlds/`.
fn runs() -> Vec<(Place, Log)> {
    let runs = plans().unwrap().into_iter().flat_map(|(_, plan)| {
        let starts = starts_of(&plan).into_iter().take(3);
        let places: Vec<Place> = starts.map(|facing| (plan.clone(), facing)).collect();
        places.into_iter().map(|place| (place.clone(), log(&place, 7)))
    });
    runs.collect()
}

/// Without an arrival and the door after it, one move seems to lead from the junction before to the one after it.
#[test]
fn a_stretch_that_was_cut_out_shows_where_the_percepts_fit() {
    let (mut cuts, mut found_at_once, mut found_later, mut elsewhere) = (0, 0, 0, 0);
    for (_, good) in runs() {
        let places = good.places();
        for arrival in (2..places.len().saturating_sub(1)).step_by(2) {
            let mut lines = good.lines.clone();
            lines.drain(places[arrival]..=places[arrival + 1]);
            let Some(found) = divergence_of(lines) else {
                cuts += 1;
                continue;
            };
            // The percepts, or the directions, may show it before or at the same event.
            let Some(is_at) = is_at(&found, arrival) else { continue };
            cuts += 1;
            assert!(found.event >= arrival, "{arrival}: {found:?}");
            // After a wrong percept other visits may be identified that are not one.
            match is_at {
                true if found.event == arrival => found_at_once += 1,
                true => found_later += 1,
                false => elsewhere += 1,
            }
        }
    }
    let named = found_at_once + found_later;
    let counts = format!("{found_at_once}, {found_later}, {elsewhere} of {cuts}");
    assert!(found_at_once > 0 && found_later > 0 && named > 9 * elsewhere, "{counts}");
    // A hallway that was traversed once, on no closed walk, shows nothing.
    assert!(10 * named > 6 * cuts, "{counts}");
}

/// Two runs from one start have the same percepts, and odometry that drifts apart.
#[test]
fn two_spliced_logs_diverge_at_the_splice() {
    let (mut splices, mut found_by_length) = (0, 0);
    for (place, first) in runs() {
        let second = log(&place, 8);
        let places = [first.places(), second.places()];
        assert_eq!(places[0].len(), places[1].len());
        for door in (1..places[0].len()).step_by(2) {
            let [one, other] = [places[0][door], places[1][door]];
            let [before, after] = [&first.lines[..=one], &second.lines[other + 1..]];
            let jump = before[one].0.odometry.distance(&after[0].0.odometry);
            if jump < 5.0 {
                continue;
            }
            let begun = before[one].0.time;
            let later = |(timed, line): &(TimedOdometry, EventKind)| {
                let time = timed.time + begun;
                (TimedOdometry { time, ..*timed }, line.clone())
            };
            let lines = before.iter().cloned().chain(after.iter().map(later)).collect();
            splices += 1;
            let Some(found) = divergence_of(lines) else { continue };
            if let Some(is_at) = is_at(&found, door + 1) {
                found_by_length += 1;
                assert!(is_at, "{door}: {found:?}");
            } else {
                // Its directions do not agree with the doors.
                assert!((door..=door + 2).contains(&found.event), "{door}: {found:?}");
            }
        }
    }
    assert!(found_by_length > 5, "{found_by_length} of {splices}");
}

#[test]
fn a_log_without_odometry_is_not_compared() {
    let mut events = good_run();
    let measured = judged(&events, &by_anyone()).measured;
    assert_eq!(measured.measured, measured.moves);
    assert!(measured.compared > 0);
    for event in (2..events.events.len()).step_by(2) {
        *hallway_before(&mut events, event) = None;
    }
    let judgement = judged(&events, &by_anyone());
    assert_eq!((judgement.measured.measured, judgement.measured.compared), (0, 0));
    assert_eq!(judgement.verdict(), ConformVerdict::Conforms);
}

/// The measurement of the hallway before an arrival.
fn hallway_before(events: &mut RunEvents, event: usize) -> &mut Option<HallwayMeasurement> {
    match &mut events.events[event].kind {
        CheckedKind::Arrival { hallway, .. } => hallway,
        other => panic!("{event}: {other:?}"),
    }
}

fn lengthen_hallway(events: &mut RunEvents, event: usize, metres: f64) {
    hallway_before(events, event).as_mut().unwrap().length += metres;
}

/// The fault at an event, if the hallway before it is longer by this, in metres.
fn with_longer_hallway(metres: f64, event: usize, quirks: &Quirks) -> Option<Divergence> {
    let mut events = good_run();
    lengthen_hallway(&mut events, event, metres);
    judge(events, &by_anyone(), quirks, &()).unwrap().divergence
}

/// The first event at which a hallway that is longer by 6 m is found.
fn first_found() -> (usize, Divergence) {
    let found = |event| Some((event, with_longer_hallway(6.0, event, &Quirks::default())?));
    (2..14).step_by(2).find_map(found).unwrap()
}

#[test]
fn a_longer_hallway_is_found_and_can_be_tolerated() {
    let (event, divergence) = first_found();
    assert_eq!(is_at(&divergence, event), Some(true), "{event}: {divergence:?}");
    assert_eq!(with_longer_hallway(0.2, event, &Quirks::default()), None);
    let text = "[[quirk]]\nname = \"ramp\"\ncause = \"moved\"\nreason = \"the wheels slip on it\"";
    assert_eq!(with_longer_hallway(6.0, event, &Quirks::read(text).unwrap()), None);
}

/// A visit has the measurement of its event, and the darts of its junction.
#[test]
fn the_visits_of_a_run_are_identified_by_its_folded_trail() {
    let good = good_run();
    let visits = good.measured_visits().unwrap();
    let arrivals = good.events.iter().filter_map(|event| match &event.kind {
        CheckedKind::Arrival { arrival, hallway, .. } => Some((arrival.degree, *hallway)),
        _ => None,
    });
    let of_visits = visits.iter().map(|visit| (visit.darts.len() as u32, visit.arrived));
    assert!(visits.len() > 5 && of_visits.eq(arrivals), "{visits:?}");
    let mut junctions: Vec<_> = visits.iter().map(|visit| visit.darts.iter().min()).collect();
    junctions.sort_unstable();
    junctions.dedup();
    assert!(junctions.len() < visits.len(), "the robot came to a junction again");
    // No world explains a run in which a junction has another degree where the robot turns back to it.
    let last = good.events.len() - 1;
    assert_eq!(with_more_doors(&good, &[last], 1).measured_visits(), None);
}

/// A tolerated length does not concern the shape, nor a tolerated shape the length.
#[test]
fn only_the_measurement_that_is_tolerated_is_forgotten() {
    let good = good_run();
    let forgotten = |measurement| {
        let cause = DivergenceCause::Measurement { between: [0, 2], earlier: [4, 6], measurement };
        let mut events = good.clone();
        events.forget_measurement(&cause);
        let mut is_left = |at: usize| {
            (arrival_at(&mut events, at).shape.is_some(), hallway_before(&mut events, at).is_some())
        };
        assert_eq!(is_left(4), (true, true));
        is_left(2)
    };
    assert_eq!(forgotten(ContradictoryMeasurement::Shape), (false, true));
    let DivergenceCause::Measurement { measurement, .. } = first_found().1.cause else { panic!() };
    assert_eq!(forgotten(measurement), (true, false));
    let mut events = good.clone();
    events.forget_measurement(&DivergenceCause::TurnedBack);
    assert_eq!(events, good);
}

/// In a known world the robot's pose identifies the hallways, without a marker too.
#[test]
fn in_a_known_world_hallways_are_compared_without_a_marker() {
    let (plan, facing) = place();
    let mut events = good_run();
    events.arrivals_mut().for_each(|arrival| arrival.sighting = None);
    let unknown = ConformConfig { aid: NoMarker.into(), ..by_anyone() };
    let known = in_world(&plan, Some(facing), &unknown);
    let [known, unknown] =
        [known, unknown].map(|config| judged(&events, &config).measured.compared);
    assert!(known > unknown, "{known} {unknown}");
}

/// Events that are inferred from scenes are measured, too.
#[test]
fn inferred_hallways_are_about_as_long_as_recorded_ones() {
    let log = log(&place(), 1);
    let lengths = |events: &[CheckedEvent]| {
        let length = |event: &CheckedEvent| match event.kind {
            CheckedKind::Arrival { hallway, .. } => Some(hallway.map(|hallway| hallway.length)),
            _ => None,
        };
        events.iter().filter_map(length).collect::<Vec<_>>()
    };
    let [recorded, inferred] = [lengths(&log.recorded().events), lengths(&log.inferred())];
    assert!(recorded.len() > 5 && recorded[0].is_none() && inferred[0].is_none());
    for (one, other) in recorded.iter().zip(&inferred).skip(1) {
        assert!((one.unwrap() - other.unwrap()).abs() < 0.8, "{one:?} {other:?}");
    }
}

/// The closed walks that a contradiction does not need are left out. What is left has the same measurements.
#[test]
fn a_shorter_log_contradicts_itself_in_the_same_way() {
    let (mut shortened, mut kept, mut of) = (0, 0, 0);
    for (_, good) in runs() {
        let good = good.recorded();
        for event in (2..good.events.len()).step_by(6) {
            let mut events = good.clone();
            lengthen_hallway(&mut events, event, 6.0);
            // Odometry that drifts: on a walk that is removed, the robot's frame has turned.
            for (index, event) in events.events.iter_mut().enumerate() {
                if let Some(entry) = event.arrival_mut().and_then(|arrival| arrival.entry.as_mut())
                {
                    *entry += 0.02 * index as f64;
                }
            }
            let judgement = judged(&events, &by_anyone());
            let Some(whole) = judgement.divergence.clone() else { continue };
            let short = shorten_run(&judgement, &by_anyone(), &()).unwrap();
            assert!(short.by_itself && short.event == short.events.events.len() - 1);
            let again = divergence(&short.events, &by_anyone());
            assert_eq!(again.event, short.event, "{event}");
            assert_same_measurement((&events, &whole), (&short.events, &again));
            assert_same_events(&events.events, &short.events.events);
            shortened += 1;
            kept += short.events.events.len();
            of += whole.event + 1;
        }
    }
    assert!(shortened > 20 && 3 * kept < 2 * of, "{kept} of {of} events in {shortened} logs");
}

/// The same visits end it, and the same is measured.
fn assert_same_measurement(
    (events, whole): (&RunEvents, &Divergence),
    (short, again): (&RunEvents, &Divergence),
) {
    let measured = |events: &RunEvents, found: &Divergence| match found.cause {
        DivergenceCause::Measurement { between, earlier, measurement } => {
            let ends = [between, earlier].map(|[_, end]| events.events[end].source);
            (ends, measurement)
        }
        _ => panic!("{found:?}"),
    };
    let [one, other] = [measured(events, whole), measured(short, again)];
    assert_eq!(one.0, other.0);
    match (one.1, other.1) {
        (
            ContradictoryMeasurement::Length { now: before, .. },
            ContradictoryMeasurement::Length { now, .. },
        ) => assert!((before - now).abs() < 1e-9),
        (one, other) => assert_eq!(discriminant(&one), discriminant(&other), "{one} {other}"),
    }
}

/// The events that are left have the doors, lengths and turns that they had.
fn assert_same_events(whole: &[CheckedEvent], short: &[CheckedEvent]) {
    let place = |event: &CheckedEvent| whole.iter().position(|one| one.source == event.source);
    let entry = |event: &CheckedEvent| event.arrival().unwrap().entry.unwrap();
    for (at, event) in short.iter().enumerate() {
        let before = place(event).unwrap();
        match (&event.kind, &whole[before].kind) {
            (CheckedKind::Arrival { hallway: None, arrival, .. }, CheckedKind::Arrival { .. }) => {
                assert_eq!((at, arrival.number), (0, Some(0)));
            }
            (CheckedKind::Arrival { hallway: now, .. }, CheckedKind::Arrival { hallway, .. }) => {
                assert_eq!(now, hallway);
                let now = entry(event) - entry(&short[at - 2]);
                let then = entry(&whole[before]) - entry(&whole[before - 2]);
                assert!(wrapped(now - then).abs() < 1e-9, "{at}: {now} {then}");
            }
            (CheckedKind::Door { door: now, .. }, CheckedKind::Door { door, .. }) => {
                assert_eq!(now, door);
            }
            other => panic!("{other:?}"),
        }
    }
}
