//! Lengths and turns by odometry: logs of which a stretch was cut out, and logs that were spliced, diverge where
//! that happened.

use toposlam_logs::record::Frame;
use toposlam_model::driving::scene::wrapped;

use super::*;

/// The log of a robot that may choose any door.
fn by_anyone() -> ConformConfig<'static> {
    ConformConfig { driver: RunDriver::Anyone, ..without_world() }
}

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

/// The events of a divergence between which the robot was moved, if it was, from 0.
fn moved(found: &Divergence) -> Option<[usize; 2]> {
    match found.cause {
        DivergenceCause::Measurement { between, .. } => Some(between),
        _ => None,
    }
}

/// The event of a measurement, or one that it contradicts.
fn is_at(found: &Divergence, event: usize) -> bool {
    match found.cause {
        DivergenceCause::Measurement { between, earlier, .. } => {
            let has = |[from, to]: [usize; 2]| (from..=to).contains(&event);
            has(between) || has(earlier)
        }
        _ => false,
    }
}

/// Runs of the plans of `worlds/`.
fn runs() -> Vec<(Arc<FloorPlan>, Dart, Log)> {
    let runs = plans().unwrap().into_iter().flat_map(|(_, plan)| {
        let starts = starts_of(&plan).into_iter().take(3);
        let run = |facing| (plan.clone(), facing, log(&plan, facing, 7));
        starts.map(run).collect::<Vec<_>>()
    });
    runs.collect()
}

/// Without an arrival and the door after it, one move seems to lead from the junction before to the one after it.
#[test]
fn a_stretch_that_was_cut_out_shows_where_the_percepts_fit() {
    let (mut cuts, mut found_at_once, mut found_later, mut elsewhere) = (0, 0, 0, 0);
    for (_, _, good) in runs() {
        let places = good.places();
        for arrival in (2..places.len().saturating_sub(1)).step_by(2) {
            let cut = places[arrival]..=places[arrival + 1];
            let keep = |(place, line): (usize, &(TimedOdometry, EventKind))| {
                (!cut.contains(&place)).then(|| line.clone())
            };
            let lines: Vec<_> = good.lines.iter().enumerate().filter_map(keep).collect();
            let Some(found) = divergence_of(lines) else {
                cuts += 1;
                continue;
            };
            // The percepts, or the directions, may show it before or at the same event.
            if moved(&found).is_none() {
                continue;
            }
            cuts += 1;
            assert!(found.event >= arrival, "{arrival}: {found:?}");
            // After a wrong percept other visits may be identified that are not one.
            match is_at(&found, arrival) {
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
    for (plan, facing, first) in runs() {
        let second = log(&plan, facing, 8);
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
            let later = |(reckoned, line): &(TimedOdometry, EventKind)| {
                let time = reckoned.time + begun;
                (TimedOdometry { time, ..*reckoned }, line.clone())
            };
            let lines = before.iter().cloned().chain(after.iter().map(later)).collect();
            splices += 1;
            let Some(found) = divergence_of(lines) else { continue };
            match moved(&found) {
                Some(_) => {
                    found_by_length += 1;
                    assert!(is_at(&found, door + 1), "{door}: {found:?}");
                }
                // Its directions do not agree with the doors.
                None => assert!((door..=door + 2).contains(&found.event), "{door}: {found:?}"),
            }
        }
    }
    assert!(found_by_length > 5, "{found_by_length} of {splices}");
}

#[test]
fn a_log_without_odometry_is_not_compared() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let mut events = log(&plan, starts_of(&plan)[0], 1).recorded();
    let measured = judged(&events, &by_anyone()).measured;
    assert_eq!(measured.measured, measured.moves);
    assert!(measured.compared > 0);
    for event in &mut events.events {
        if let CheckedKind::Arrival { hallway, .. } = &mut event.kind {
            *hallway = None;
        }
    }
    let judgement = judged(&events, &by_anyone());
    assert_eq!((judgement.measured.measured, judgement.measured.compared), (0, 0));
    assert_eq!(judgement.verdict(), ConformVerdict::Conforms);
}

/// The fault at an event, if the hallway before it is longer by this, in metres.
fn with_longer_hallway(metres: f64, event: usize, quirks: &Quirks) -> Option<Divergence> {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let mut events = log(&plan, starts_of(&plan)[0], 1).recorded();
    let CheckedKind::Arrival { hallway: Some(hallway), .. } = &mut events.events[event].kind else {
        panic!("{event}")
    };
    hallway.length += metres;
    judge(events, &by_anyone(), quirks, &()).unwrap().divergence
}

#[test]
fn a_longer_hallway_is_found_and_can_be_tolerated() {
    let found = |event| with_longer_hallway(6.0, event, &Quirks::default());
    let (event, divergence) =
        (2..14).step_by(2).find_map(|event| Some((event, found(event)?))).unwrap();
    assert!(is_at(&divergence, event), "{event}: {divergence:?}");
    assert_eq!(with_longer_hallway(0.2, event, &Quirks::default()), None);
    let text = "[[quirk]]\nname = \"ramp\"\ncause = \"moved\"\nreason = \"the wheels slip on it\"";
    assert_eq!(with_longer_hallway(6.0, event, &Quirks::read(text).unwrap()), None);
}

/// A visit has the measurement of its event, and the darts of its junction.
#[test]
fn the_visits_of_a_run_are_identified_by_its_folded_trail() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let good = log(&plan, starts_of(&plan)[0], 1).recorded();
    let visits = good.measured_visits().unwrap();
    let arrivals: Vec<_> = (good.events.iter())
        .filter_map(|event| match &event.kind {
            CheckedKind::Arrival { arrival, hallway, .. } => Some((arrival.degree, *hallway)),
            _ => None,
        })
        .collect();
    assert!(arrivals.len() > 5);
    let of_visits: Vec<_> =
        visits.iter().map(|visit| (visit.darts.len() as u32, visit.arrived)).collect();
    assert_eq!(of_visits, arrivals);
    let mut junctions: Vec<_> = visits.iter().map(|visit| visit.darts.iter().min()).collect();
    junctions.sort_unstable();
    junctions.dedup();
    assert!(junctions.len() < visits.len(), "the robot came to a junction again");
    // No world explains a run in which a junction has another degree where the robot turns back to it.
    let mut wrong = good.clone();
    let last = wrong.events.len() - 1;
    let CheckedKind::Arrival { arrival, .. } = &mut wrong.events[last].kind else { panic!() };
    arrival.degree += 1;
    assert_eq!(wrong.measured_visits(), None);
}

/// A tolerated length says nothing about the shape, nor a tolerated shape about the length.
#[test]
fn only_the_measurement_that_is_tolerated_is_forgotten() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let good = log(&plan, starts_of(&plan)[0], 1).recorded();
    let forgotten = |measurement| {
        let cause = DivergenceCause::Measurement { between: [0, 2], earlier: [4, 6], measurement };
        let mut events = good.clone();
        events.forget_measurement(&cause);
        let is_left = |at: usize| match &events.events[at].kind {
            CheckedKind::Arrival { arrival, hallway, .. } => {
                (arrival.form.is_some(), hallway.is_some())
            }
            _ => panic!("{at}"),
        };
        assert_eq!(is_left(4), (true, true));
        is_left(2)
    };
    assert_eq!(forgotten(ContradictoryMeasurement::Shape), (false, true));
    let found =
        (2..14).step_by(2).find_map(|event| with_longer_hallway(6.0, event, &Quirks::default()));
    let Some(DivergenceCause::Measurement { measurement, .. }) = found.map(|found| found.cause)
    else {
        panic!()
    };
    assert_eq!(forgotten(measurement), (true, false));
    let mut events = good.clone();
    events.forget_measurement(&DivergenceCause::TurnedBack);
    assert_eq!(events, good);
}

/// In a known world the robot's pose identifies the hallways, without a marker too.
#[test]
fn in_a_known_world_hallways_are_compared_without_a_marker() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let facing = starts_of(&plan)[0];
    let mut events = log(&plan, facing, 1).recorded();
    for event in &mut events.events {
        if let CheckedKind::Arrival { arrival, .. } = &mut event.kind {
            arrival.sighting = None;
        }
    }
    let marker = &toposlam_model::marker::NoMarker;
    let unknown = ConformConfig { marker, ..by_anyone() };
    let known = question(&plan, Some(facing)).world.map(|world| KnownWorld {
        states: vec![GraphWorld::with_marker(world.graph, marker, facing).state()],
        ..world
    });
    let known = ConformConfig { world: known, ..unknown.clone() };
    let compared = |question: &ConformConfig| judged(&events, question).measured.compared;
    assert!(compared(&known) > compared(&unknown), "{} {}", compared(&known), compared(&unknown));
}

/// Events that are inferred from scenes are measured, too.
#[test]
fn inferred_hallways_are_about_as_long_as_recorded_ones() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let log = log(&plan, starts_of(&plan)[0], 1);
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
    assert!(log.lines.iter().any(|(_, line)| matches!(line, EventKind::Frame(Frame { .. }))));
}

/// The closed walks that a contradiction does not need are left out. What is left has the same measurements.
#[test]
fn a_shorter_log_contradicts_itself_in_the_same_way() {
    let (mut shortened, mut kept, mut of) = (0, 0, 0);
    for (_, _, good) in runs() {
        let good = good.recorded();
        for event in (2..good.events.len()).step_by(6) {
            let mut events = good.clone();
            let CheckedKind::Arrival { hallway: Some(hallway), .. } =
                &mut events.events[event].kind
            else {
                panic!("{event}")
            };
            hallway.length += 6.0;
            // Odometry that drifts: on a walk that is removed, the robot's frame has turned.
            for (index, event) in events.events.iter_mut().enumerate() {
                if let CheckedKind::Arrival { arrival, .. } = &mut event.kind {
                    arrival.entry = arrival.entry.map(|entry| entry + 0.02 * index as f64);
                }
            }
            let judgement = judge(events.clone(), &by_anyone(), &Quirks::default(), &()).unwrap();
            let Some(whole) = judgement.divergence.clone() else { continue };
            let DivergenceCause::Measurement { between, earlier, measurement } = whole.cause else {
                panic!("{whole:?}")
            };
            let short = shorten_run(&judgement, &by_anyone(), &()).unwrap();
            assert!(short.by_itself && short.event == short.events.events.len() - 1);
            let again = judged(&short.events, &by_anyone()).divergence.unwrap();
            assert_eq!(again.event, short.event, "{event}");
            let DivergenceCause::Measurement {
                between: now_between,
                earlier: now_earlier,
                measurement: now,
            } = again.cause
            else {
                panic!("{again:?}")
            };
            // The same visits end it.
            let source = |events: &RunEvents, at: usize| events.events[at].source;
            assert_eq!(source(&short.events, now_between[1]), source(&events, between[1]));
            assert_eq!(source(&short.events, now_earlier[1]), source(&events, earlier[1]));
            match (measurement, now) {
                (
                    ContradictoryMeasurement::Length { now: before, .. },
                    ContradictoryMeasurement::Length { now, .. },
                ) => assert!((before - now).abs() < 1e-9),
                (one, other) => assert_eq!(
                    std::mem::discriminant(&one),
                    std::mem::discriminant(&other),
                    "{one} {other}"
                ),
            }
            let entry = |event: &CheckedEvent| match event.kind {
                CheckedKind::Arrival { arrival, .. } => arrival.entry.unwrap(),
                _ => panic!("{event:?}"),
            };
            for at in (2..short.events.events.len()).step_by(2) {
                let whole = (events.events.iter())
                    .position(|event| event.source == short.events.events[at].source);
                let turns = [(&short.events, at), (&events, whole.unwrap())]
                    .map(|(log, at)| entry(&log.events[at]) - entry(&log.events[at - 2]));
                assert!(wrapped(turns[0] - turns[1]).abs() < 1e-9, "{event}: {turns:?}");
            }
            for CheckedEvent { source, kind } in &short.events.events {
                let same = events.events.iter().find(|event| event.source == *source).unwrap();
                match (kind, &same.kind) {
                    (
                        CheckedKind::Arrival { hallway: Some(now), .. },
                        CheckedKind::Arrival { hallway: Some(before), .. },
                    ) => assert_eq!(now, before),
                    (
                        CheckedKind::Arrival { hallway: None, arrival, .. },
                        CheckedKind::Arrival { .. },
                    ) => assert_eq!(arrival.number, Some(0)),
                    (
                        CheckedKind::Door { door: now, .. },
                        CheckedKind::Door { door: before, .. },
                    ) => assert_eq!(now, before),
                    other => panic!("{other:?}"),
                }
            }
            shortened += 1;
            kept += short.events.events.len();
            of += whole.event + 1;
        }
    }
    assert!(shortened > 20 && 3 * kept < 2 * of, "{kept} of {of} events in {shortened} logs");
}
