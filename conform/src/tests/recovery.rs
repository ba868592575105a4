//! Logs of robots that recover, that got lost, and that turn back to keep within a budget.

use toposlam_model::{
    mapping::{MappedWorld, MappingMethod, RecoveryConfig},
    trace::{AllowedStep, Departure, MatchEnd, StepPurpose},
};

use super::*;

const FOLDING: MappingAlgorithm = MappingAlgorithm::Folding;

fn recovering() -> MappingMethod {
    let noise = Some(log_noise());
    let retries_blocked = true;
    MappingMethod::Recovering(RecoveryConfig {
        noise,
        retries_blocked,
        ..RecoveryConfig::default()
    })
}

fn building(name: &str) -> (Arc<FloorPlan>, Dart) {
    let (_, plan) = plans().unwrap().into_iter().find(|(plan, _)| plan == name).unwrap();
    let facing = starts_of(&plan)[0];
    (plan, facing)
}

/// The log of a run with a fault, and what its map took.
fn log_with(
    settings: &RunSettings,
    (plan, facing): &(Arc<FloorPlan>, Dart),
    fault: Option<&str>,
    seed: u64,
) -> (RunEvents, Option<MappedWorld>) {
    let faults = fault.map(|fault| fault.parse().unwrap()).into_iter().collect();
    let config =
        SimulationConfig { faults, ..SimulationConfig::at_start(plan.clone(), *facing, seed) };
    let mut log = Log::default();
    let run = run(plan, *facing, config.by_scene(), NoSensor, &mut log, settings);
    let ending = match &run.error {
        None => RunEnding::Mapped,
        Some(error) => RunEnding::OutOfBudget(error.to_string()),
    };
    let end = Some(RunEnd { moves: run.moves, ending });
    (RunEvents { end, ..log.recorded() }, run.mapped)
}

/// The events with another door at an event, if it is a door of a junction with others.
fn with_other_door(events: &RunEvents, at: usize) -> Option<RunEvents> {
    let mut events = events.clone();
    let [.., before, event] = &mut events.events[..=at] else { return None };
    match (&before.kind, &mut event.kind) {
        (CheckedKind::Arrival { arrival, .. }, CheckedKind::Door { door, .. })
            if arrival.degree > 1 =>
        {
            door.0 = (door.0 + 1) % arrival.degree;
            Some(events)
        }
        _ => None,
    }
}

fn departure(events: &RunEvents, question: &ConformConfig) -> Option<Departure> {
    match judged(events, question).algorithm.unwrap().reached {
        MatchEnd::Departure(departure) => Some(departure),
        _ => None,
    }
}

#[test]
fn each_door_of_a_robot_that_recovers_is_compared() {
    let place = building("shape-8");
    let settings = RunSettings::new(recovering(), DARTS);
    for fault in [
        "carried@40",
        "carried@80",
        "blocked@20",
        "blocked@20:250",
        "lights-out@40:120",
        "dropped@30",
    ] {
        let (events, mapped) = log_with(&settings, &place, Some(fault), 2);
        let is_without = ["dropped@30", "blocked@20"].contains(&fault);
        assert_eq!(mapped.unwrap().recoveries > 0, !is_without, "{fault}");
        let question = ConformConfig {
            driver: RunDriver::Method(recovering()),
            ..question(&place.0, Some(place.1))
        };
        let reached = judged(&events, &question).algorithm.unwrap().reached;
        assert_eq!(reached, MatchEnd::Mapped, "{fault}");
        let mut changed = 0;
        for at in 0..events.events.len() {
            let Some(other) = with_other_door(&events, at) else { continue };
            let departed = departure(&other, &question).map(|departure| departure.event.id);
            assert_eq!(departed, Some(at), "{fault}, event {at}");
            changed += 1;
        }
        assert!(changed > 10, "{fault}");
    }
}

#[test]
fn a_robot_that_got_lost_may_be_anywhere_in_its_world() {
    let place = building("building-12");
    let settings = RunSettings::new(recovering(), DARTS);
    let (events, _) = log_with(&settings, &place, Some("lights-out@40:120"), 1);
    let driver = RunDriver::Method(recovering());
    let known = ConformConfig { driver, ..question(&place.0, Some(place.1)) };
    let judgement = judged(&events, &known);
    assert_eq!((judgement.verdict(), judgement.divergence), (ConformVerdict::Conforms, None));
    let lost = judgement.lost.unwrap();
    // What comes after it is checked in a known world, and in no other.
    let unknown = judged(&events, &ConformConfig { driver, ..without_world() });
    assert_eq!((unknown.verdict(), unknown.divergence), (ConformVerdict::Incomplete, None));
    let poses = judgement.poses.unwrap();
    assert!(poses.left[lost - 1] == 1 && poses.left[lost] > 1, "{:?}", poses.left);
    assert_eq!(poses.left.last(), Some(&1));
    let mut wrong = events.clone();
    let last = wrong.events.len() - 1;
    let CheckedKind::Arrival { arrival, .. } = &mut wrong.events[last].kind else { panic!() };
    (arrival.degree, arrival.form) = (arrival.degree + 1, None);
    let divergence = judged(&wrong, &known).divergence.unwrap();
    assert!(divergence.event == last && last > lost, "{divergence:?}");
    // The move on which it got lost is none.
    let mut wrong = events.clone();
    wrong.end.as_mut().unwrap().moves += 1;
    assert_eq!(judged(&wrong, &known).divergence.unwrap().cause.name(), "moves");
}

#[test]
fn a_robot_turns_back_exactly_when_its_budget_of_moves_needs_it() {
    let place = building("building-12");
    for most in 4..30 {
        let budget = RunBudget { moves: Some(most), ..RunBudget::default() };
        let settings = RunSettings { budget, ..RunSettings::new(FOLDING, DARTS) };
        let (events, mapped) = log_with(&settings, &place, None, 1);
        let driver = RunDriver::from(FOLDING);
        let question =
            |budget| ConformConfig { driver, budget, ..question(&place.0, Some(place.1)) };
        let within = question(budget);
        let judgement = judged(&events, &within);
        assert_eq!(judgement.divergence, None, "{most}");
        assert_eq!(mapped.is_some(), judgement.verdict() == ConformVerdict::Conforms);
        if mapped.is_some() {
            continue;
        }
        assert_eq!(judgement.algorithm.unwrap().reached, MatchEnd::EndOfTrace);
        // With 2 moves more it would have gone on.
        let larger = RunBudget { moves: Some(most + 2), ..budget };
        let early = departure(&events, &question(larger)).unwrap();
        let [AllowedStep { door: Some(_), purpose }] = early.allowed[..] else { panic!() };
        assert_ne!(purpose, StepPurpose::TurnBack);
        // With 2 moves less it would have turned back before.
        let smaller = RunBudget { moves: Some(most - 2), ..budget };
        let late = departure(&events, &question(smaller)).unwrap();
        assert!(matches!(late.allowed[..], [AllowedStep { purpose: StepPurpose::TurnBack, .. }]));
        assert!(late.event.id < early.event.id, "{most}");
        // If it is not known what the robot has measured, it may turn back at any time, but only by its way.
        let time = RunBudget { seconds: Some(1.0), ..RunBudget::default() };
        assert_eq!(departure(&events, &question(time)), None);
        let turned = early.event.id;
        // There the other door may be that of the explorer.
        for at in turned + 2..events.events.len() {
            let Some(other) = with_other_door(&events, at) else { continue };
            let departed = departure(&other, &question(time)).map(|departure| departure.event.id);
            assert_eq!(departed, Some(at), "{most}");
        }
    }
}

#[test]
fn a_robot_that_recovers_does_not_end_with_lengths_that_contradict_each_other() {
    let place = building("shape-8");
    let settings = RunSettings::new(recovering(), DARTS);
    let (mut events, _) = log_with(&settings, &place, None, 1);
    let driver = RunDriver::Method(recovering());
    let question = ConformConfig { driver, ..question(&place.0, Some(place.1)) };
    assert_eq!(judged(&events, &question).algorithm.unwrap().reached, MatchEnd::Mapped);
    // In the last hallway, which it knows, it measures 8 m more.
    let last = events.events.last_mut().unwrap();
    let CheckedKind::Arrival { hallway: Some(hallway), .. } = &mut last.kind else { panic!() };
    hallway.length += 8.0;
    let judgement = judged(&events, &question);
    assert_eq!(judgement.algorithm.unwrap().reached, MatchEnd::EndOfTrace);
    assert_eq!(judgement.divergence.unwrap().cause.name(), "moved");
}
