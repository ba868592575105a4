//! Logs of robots that recover, that got lost, and that turn back to keep within a budget.

use toposlam_logs::{messages, recorder::Recorder};
use toposlam_model::{
    aid::AidKind,
    format::named_world::NamedWorld,
    mapping::MappedWorld,
    marker::{MarkerKind, NoMarker, Undirected},
    trace::{AllowedStep, Departure, MatchEnd, StepPurpose},
};

use super::{log_check::Question, *};

pub(super) fn recovering() -> MappingMethod {
    let noise = Some(log_noise());
    let config = RecoveryConfig { noise, retries_blocked: true, ..RecoveryConfig::default() };
    MappingMethod::Recovering(config)
}

/// A place, and what a robot that recovers is checked against there.
fn recovering_in(name: &str) -> (Place, ConformConfig) {
    let place = place_in(name);
    let config = driven(at_place(&place), RunDriver::Method(recovering()));
    (place, config)
}

/// The log of a run with a fault, and what its map took.
fn log_with(
    settings: &RunSettings,
    (plan, facing): &Place,
    fault: Option<&str>,
    seed: u64,
) -> (RunEvents, Option<MappedWorld>) {
    let faults = fault.map(|fault| fault.parse().unwrap()).into_iter().collect();
    let config =
        SimulationConfig { faults, ..SimulationConfig::at_start(plan.clone(), *facing, seed) };
    let mut log = Log::default();
    let run = run(plan, *facing, config.by_scene(), RobotSensor::Scenes, &mut log, settings);
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
    let degree = before.arrival().map(|arrival| arrival.degree).filter(|&degree| degree > 1)?;
    let CheckedKind::Door { door, .. } = &mut event.kind else { return None };
    door.0 = (door.0 + 1) % degree;
    Some(events)
}

fn departure(events: &RunEvents, config: &ConformConfig) -> Option<Departure> {
    match judged(events, config).algorithm.unwrap().reached {
        MatchEnd::Departure(departure) => Some(departure),
        _ => None,
    }
}

#[test]
fn each_door_of_a_robot_that_recovers_is_compared() {
    let (place, config) = recovering_in("shape-8");
    let settings = RunSettings::new(recovering(), DARTS);
    for (fault, recovers) in [
        ("carried@40", true),
        ("carried@80", true),
        ("blocked@20", false),
        ("blocked@20:250", true),
        ("lights-out@40:120", true),
        ("dropped@30", false),
    ] {
        let (events, mapped) = log_with(&settings, &place, Some(fault), 2);
        assert_eq!(mapped.unwrap().recoveries > 0, recovers, "{fault}");
        let reached = judged(&events, &config).algorithm.unwrap().reached;
        assert_eq!(reached, MatchEnd::Mapped, "{fault}");
        let mut changed = 0;
        for at in 0..events.events.len() {
            let Some(other) = with_other_door(&events, at) else { continue };
            let departed = departure(&other, &config).map(|departure| departure.event.id);
            assert_eq!(departed, Some(at), "{fault}, event {at}");
            changed += 1;
        }
        assert!(changed > 10, "{fault}");
    }
}

#[test]
fn a_robot_that_got_lost_may_be_anywhere_in_its_world() {
    let (place, known) = recovering_in("building-12");
    let settings = RunSettings::new(recovering(), DARTS);
    let (events, _) = log_with(&settings, &place, Some("lights-out@40:120"), 1);
    let judgement = judged(&events, &known);
    assert_eq!((judgement.verdict(), judgement.divergence), GOOD);
    let lost = judgement.lost.unwrap();
    // What comes after it is checked in a known world, and in no other.
    let unknown = judged(&events, &ConformConfig { world: None, ..known.clone() });
    assert_eq!((unknown.verdict(), unknown.divergence), (ConformVerdict::NotKnown, None));
    let poses = judgement.poses.unwrap();
    assert!(poses.left[lost - 1] == 1 && poses.left[lost] > 1, "{:?}", poses.left);
    assert_eq!(poses.left.last(), Some(&1));
    let last = events.events.len() - 1;
    let found = divergence(&with_more_doors(&events, &[last], 1), &known);
    assert!(found.event == last && last > lost, "{found:?}");
    // The move on which it got lost is none.
    let mut wrong = events;
    wrong.end.as_mut().unwrap().moves += 1;
    assert_eq!(divergence(&wrong, &known).cause.name(), "moves");
}

#[test]
fn a_robot_turns_back_exactly_when_its_budget_of_moves_needs_it() {
    let place = place_in("building-12");
    for most in 4..30 {
        let budget = RunBudget { moves: Some(most), ..RunBudget::default() };
        let settings = RunSettings { budget, ..RunSettings::new(FOLDING, DARTS) };
        let (events, mapped) = log_with(&settings, &place, None, 1);
        let config = |budget| ConformConfig { budget, ..driven(at_place(&place), FOLDING) };
        let judgement = judged(&events, &config(budget));
        assert_eq!(judgement.divergence, None, "{most}");
        assert_eq!(mapped.is_some(), judgement.verdict() == ConformVerdict::Conforms);
        if mapped.is_some() {
            continue;
        }
        assert_eq!(judgement.algorithm.unwrap().reached, MatchEnd::EndOfTrace);
        // With 2 moves more it would have gone on, and with 2 moves less it would have turned back before.
        let other = |moves| {
            let budget = RunBudget { moves: Some(moves), ..budget };
            let departure = departure(&events, &config(budget)).unwrap();
            let [AllowedStep { action, purpose }] = departure.allowed[..] else { panic!() };
            assert!(action.is_some() || purpose == StepPurpose::TurnBack);
            (purpose == StepPurpose::TurnBack, departure.event.id)
        };
        let (early, late) = (other(most + 2), other(most - 2));
        assert!(!early.0 && late.0 && late.1 < early.1, "{most}");
        // If it is not known what the robot has measured, it may turn back at any time, but only by its way.
        let time = RunBudget { seconds: Some(1.0), ..RunBudget::default() };
        assert_eq!(departure(&events, &config(time)), None);
        // Where it turns back the other door may be that of the explorer.
        for at in early.1 + 2..events.events.len() {
            let Some(other) = with_other_door(&events, at) else { continue };
            let departed = departure(&other, &config(time)).map(|departure| departure.event.id);
            assert_eq!(departed, Some(at), "{most}");
        }
    }
}

/// Where the robot must turn back, a door that is not that of the algorithm either is a fault of the algorithm.
#[test]
fn a_door_of_no_algorithm_is_no_way_back_that_was_missed() {
    let place = place_in("building-12");
    let (events, _) = log_with(&RunSettings::new(FOLDING, DARTS), &place, None, 1);
    let mut too_late = 0;
    for most in (4..30).step_by(3) {
        let budget = RunBudget { moves: Some(most), ..RunBudget::default() };
        let config = ConformConfig { budget, ..driven(at_place(&place), FOLDING) };
        let is_back = |departure: &Departure| departure.allowed[0].purpose == StepPurpose::TurnBack;
        let missed = departure(&events, &config).unwrap();
        assert!(is_back(&missed), "{most}");
        let Some(other) = with_other_door(&events, missed.event.id) else { continue };
        let departed = departure(&other, &config).unwrap();
        assert_eq!(departed.event.id, missed.event.id, "{most}");
        assert!(!is_back(&departed), "{most}");
        too_late += 1;
    }
    assert!(too_late > 3, "{too_late}");
}

#[test]
fn a_robot_that_recovers_does_not_end_with_lengths_that_contradict_each_other() {
    let (place, config) = recovering_in("shape-8");
    let settings = RunSettings::new(recovering(), DARTS);
    let (mut events, _) = log_with(&settings, &place, None, 1);
    assert_eq!(judged(&events, &config).algorithm.unwrap().reached, MatchEnd::Mapped);
    // In the last hallway, which it knows, it measures 8 m more.
    let last = events.events.last_mut().unwrap();
    let CheckedKind::Arrival { hallway: Some(hallway), .. } = &mut last.kind else { panic!() };
    hallway.length += 8.0;
    let judgement = judged(&events, &config);
    assert_eq!(judgement.algorithm.unwrap().reached, MatchEnd::EndOfTrace);
    assert_eq!(judgement.divergence.unwrap().cause.name(), "moved");
}

/// The head of the log of a run.
pub(super) fn head_of(settings: &RunSettings) -> messages::Run {
    messages::Run {
        marker: "directional".to_owned(),
        algorithm: settings.recorded().to_string(),
        ..messages::Run::default()
    }
}

/// The judgements of the scenes of a run that recovers from a fault: with and without its world, with and without its
/// algorithm, with a search that ends early, and with other markers.
fn judged_scenes(name: &str, fault: &str, seed: u64) -> Vec<Judgement> {
    let place = place_in(name);
    let settings = RunSettings::new(recovering(), DARTS);
    let faults = vec![fault.parse().unwrap()];
    let (plan, facing) = (&place.0, place.1);
    let robot = SimulationConfig::at_start(plan.clone(), facing, seed);
    let robot = SimulationConfig { faults, keeps_track: true, ..robot };
    let mut log = Vec::new();
    let head = head_of(&settings);
    let mut recorder = Recorder::new(&mut log, &head, None).unwrap();
    run(plan, facing, robot.by_scene(), RobotSensor::Scenes, &mut recorder, &settings);
    recorder.finish().unwrap();
    let world = NamedWorld::numbered(name, "", plan.graph().clone(), Some(facing));
    let anyone = DoorChooser::Anyone;
    let marked = [
        (DoorChooser::Algorithm(None), None),
        (anyone, None),
        (anyone, Some(NoMarker)),
        (anyone, Some(Undirected)),
    ];
    let check = |(doors, marker): (_, Option<MarkerKind>), world, start, steps| {
        let aid = marker.map(AidKind::from);
        let head = head.clone();
        let scenes = Question::new(&log, Evidence::Scenes);
        Question { head, world, start, aid, doors, steps, ..scenes }.checked().unwrap().judgement
    };
    let (recorded, anywhere) = (RobotStart::Recorded, RobotStart::Anywhere);
    let ways = [
        (None, recorded, 50),
        (None, recorded, 10_000),
        (Some(&world), recorded, 50),
        (Some(&world), anywhere, 50),
    ];
    let judgements = |how| ways.map(|(world, start, steps)| check(how, world, start, steps));
    marked.into_iter().flat_map(judgements).collect()
}

#[test]
fn scenes_accuse_no_robot_that_got_lost_or_turned_back_at_an_obstacle() {
    for (name, fault, why) in [
        ("shape-6", "lights-out@40:120", Unproved::Lost),
        ("shape-8", "lights-out@40:120", Unproved::Lost),
        ("building-12", "lights-out@60:200", Unproved::Lost),
        ("shape-6", "blocked@20:250", Unproved::Obstacle),
        ("shape-8", "blocked@20:250", Unproved::Obstacle),
    ] {
        let mut contradictions = 0;
        for seed in 1..4 {
            for judgement in judged_scenes(name, fault, seed) {
                let found = (judgement.verdict(), &judgement.divergence);
                assert!(found.0 != ConformVerdict::Diverged && found.1.is_none(), "{found:?}");
                let unproved = judgement.contradiction.map(|(_, why)| why);
                contradictions += usize::from(unproved.is_some());
                assert!(unproved.is_none_or(|unproved| unproved == why), "{name}, {fault}, {seed}");
            }
        }
        // These scenes alone would accuse it.
        assert!(contradictions > 12, "{name}, {fault}: {contradictions}");
    }
}

#[test]
fn scenes_accuse_a_robot_that_was_carried_unawares() {
    let judged = judged_scenes("shape-6", "carried@80", 1);
    let verdicts: Vec<_> = judged.iter().map(Judgement::verdict).collect();
    assert!(verdicts.iter().all(|verdict| *verdict == ConformVerdict::Diverged), "{verdicts:?}");
}
