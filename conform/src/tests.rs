//! Good runs conform. The checker finds every mutation of a good run at its event, unless the mutation
//! is known to have no effect.

use std::sync::Arc;

use proptest::prelude::*;
use toposlam_logs::record::{
    Arrival, Event, EventId, EventKind, Frame, MapRecord, NoSensor, RunEnd, RunEnding, RunObserver,
};
use toposlam_model::{
    driving::{odometry::Odometry, visit::JunctionShape},
    embedded_graph::Dart,
    enumerate::Class,
    floor_plan::FloorPlan,
    folding::WorldSearch,
    mapping::{MappingAlgorithm, MappingMethod, RecoveryConfig},
    marker::Directional,
    measurement::ContradictoryMeasurement,
    percept::{Door, Percept, Sighting},
    trace::anywhere,
    world::GraphWorld,
};
use toposlam_robot::{
    budget::RunBudget, measured_hallway::log_noise, robot::TimedOdometry, run_settings::RunSettings,
};
use toposlam_simulator::{
    SimulationConfig, plans, random_plan::random_plan_with, run::run, starts_of,
};

use super::*;

mod extracted;
mod folding;
mod measured;
mod oracle;
mod parts;
mod recovery;
mod report;
mod tolerance;
mod verdicts;

const DARTS: usize = 400;

/// The content of a log of a simulated run.
#[derive(Clone, Debug, Default)]
struct Log {
    /// Scenes, arrivals and doors.
    lines: Vec<(TimedOdometry, EventKind)>,
    /// Of the last frame.
    odometry: Odometry,
}

impl Log {
    fn moves(&self) -> u64 {
        self.lines.iter().filter(|(_, line)| matches!(line, EventKind::Door { .. })).count() as u64
    }

    fn recorded(&self) -> RunEvents {
        let mut recorded = RecordedEvents::default();
        for (message, (reckoned, line)) in self.lines.iter().enumerate() {
            let source = source(message, reckoned);
            recorded.observe(source, &EventKind::Odometry(reckoned.odometry));
            recorded.observe(source, line);
        }
        let end = Some(RunEnd { moves: self.moves(), ending: RunEnding::Mapped });
        RunEvents {
            events: recorded.finish(),
            has_head: true,
            end,
            measurement_noise: log_noise(),
            ..RunEvents::default()
        }
    }

    fn inferred(&self) -> Vec<CheckedEvent> {
        let seen = |(message, (reckoned, line)): (usize, &(TimedOdometry, EventKind))| match line {
            EventKind::Frame(Frame { scene: Some(scene), .. }) => Some(SensedScene {
                source: source(message, reckoned),
                scene: scene.clone(),
                odometry: reckoned.odometry,
            }),
            _ => None,
        };
        infer_events(&self.lines.iter().enumerate().filter_map(seen).collect::<Vec<_>>(), true)
    }
}

fn source(message: usize, reckoned: &TimedOdometry) -> EventSource {
    let time = (reckoned.time * 1e9).round() as u64;
    EventSource { time, id: EventId(message as u64 + 1), offset: 0 }
}

impl RunObserver for Log {
    fn event(&mut self, event: &Event) {
        match &event.kind {
            EventKind::Frame(frame) if frame.scene.is_some() => self.odometry = frame.odometry,
            EventKind::Door { .. } | EventKind::Arrival(_) => {}
            _ => return,
        }
        let reckoned = TimedOdometry { time: event.time as f64 / 1e9, odometry: self.odometry };
        self.lines.push((reckoned, event.kind.clone()));
    }
}

/// A good run of Algorithm 1.
fn log(plan: &Arc<FloorPlan>, facing: Dart, seed: u64) -> Log {
    log_of(MappingAlgorithm::Algorithm1, plan, facing, seed)
}

/// A good run of a robot that maps.
fn log_of(method: impl Into<MappingMethod>, plan: &Arc<FloorPlan>, facing: Dart, seed: u64) -> Log {
    let robot = SimulationConfig::at_start(plan.clone(), facing, seed).by_scene();
    let mut log = Log::default();
    let run = run(plan, facing, robot, NoSensor, &mut log, &RunSettings::new(method, DARTS));
    assert_eq!(run.outcome(), toposlam_simulator::run::RunOutcome::Right);
    log
}

fn question(plan: &FloorPlan, facing: Option<Dart>) -> ConformConfig<'_> {
    let graph = plan.graph();
    let states = match facing {
        Some(facing) => vec![GraphWorld::new(graph, facing).state()],
        None => anywhere(graph, &Directional),
    };
    let world = Some(KnownWorld { graph, states });
    ConformConfig { world, ..without_world() }
}

fn without_world() -> ConformConfig<'static> {
    let search = WorldSearch { class: Class::Multigraph, max_edges: None, steps: 100_000 };
    ConformConfig {
        world: None,
        marker: &Directional,
        driver: RunDriver::from(MappingAlgorithm::Algorithm1),
        budget: RunBudget::default(),
        search,
        dart_bound: DARTS,
    }
}

fn judged(events: &RunEvents, question: &ConformConfig) -> Judgement {
    judge(events.clone(), question, &Quirks::default(), &()).unwrap()
}

#[test]
fn good_logs_of_every_plan_conform() {
    for (name, plan) in plans().unwrap() {
        for (seed, facing) in starts_of(&plan).into_iter().enumerate().step_by(2) {
            let events = log(&plan, facing, seed as u64).recorded();
            for question in [question(&plan, Some(facing)), question(&plan, None), without_world()]
            {
                let judgement = judged(&events, &question);
                assert_eq!(
                    (judgement.verdict(), &judgement.divergence),
                    (ConformVerdict::Conforms, &None),
                    "{name} from {facing:?}"
                );
            }
        }
    }
}

/// Percepts and doors, without their sources.
fn bare(events: &[CheckedEvent]) -> Vec<(Option<Percept>, Option<Door>)> {
    let bare = |event: &CheckedEvent| match &event.kind {
        CheckedKind::Arrival { arrival, .. } => (arrival.percept(), None),
        CheckedKind::Door { door, .. } => (None, Some(*door)),
        other => panic!("{other:?} in a good run"),
    };
    events.iter().map(bare).collect()
}

#[test]
fn inferred_percepts_and_doors_are_the_recorded_ones() {
    for (name, plan) in plans().unwrap() {
        for (seed, facing) in starts_of(&plan).into_iter().enumerate() {
            let log = log(&plan, facing, seed as u64);
            assert_eq!(
                bare(&log.inferred()),
                bare(&log.recorded().events),
                "{name} from {facing:?}"
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn good_logs_of_random_plans_conform(seed in 0_u64..1000) {
        let plan = Arc::new(random_plan_with(seed, 12).unwrap());
        if let Some(&facing) = starts_of(&plan).first() {
            let log = log(&plan, facing, seed);
            let judgement = judged(&log.recorded(), &question(&plan, Some(facing)));
            prop_assert_eq!(judgement.divergence, None);
            prop_assert_eq!(bare(&log.inferred()), bare(&log.recorded().events));
        }
    }
}

/// A change of one field of one event of a log, or of its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mutation {
    Degree,
    Marker,
    Entry,
    Form,
    Door,
    Number,
    Dropped,
    Repeated,
    Swapped,
    Earlier,
    Later,
    Within,
}

const MUTATIONS: [Mutation; 12] = [
    Mutation::Degree,
    Mutation::Marker,
    Mutation::Entry,
    Mutation::Form,
    Mutation::Door,
    Mutation::Number,
    Mutation::Dropped,
    Mutation::Repeated,
    Mutation::Swapped,
    Mutation::Earlier,
    Mutation::Later,
    Mutation::Within,
];

/// Where a mutated log diverges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shows {
    /// At this event, from 0.
    At(usize),
    /// Nowhere, and why.
    Never(&'static str),
    /// This event has no such mutation.
    NotOne,
}

impl Log {
    /// The indices of the events among the lines.
    fn places(&self) -> Vec<usize> {
        let is_event = |line: &EventKind| !matches!(line, EventKind::Frame(_));
        (0..self.lines.len()).filter(|&place| is_event(&self.lines[place].1)).collect()
    }

    /// Mutates an event, and returns where that shows.
    fn mutate(&mut self, event: usize, mutation: Mutation, by: u32) -> Shows {
        use Mutation::*;
        let places = self.places();
        let (place, last) = (places[event], event + 1 == places.len());
        let time = self.lines[place].0.time;
        let before = event.checked_sub(1).map(|before| self.lines[places[before]].0.time);
        match (mutation, &mut self.lines[place].1) {
            (Degree, EventKind::Arrival(Arrival { degree, .. })) => {
                *degree = *degree % 3 + 1 + u32::from(*degree == 3 && by > 2);
            }
            (Marker, EventKind::Arrival(Arrival { sighting: Some(sighting), .. })) => {
                *sighting = match sighting {
                    Sighting::Nothing => Sighting::Pointing(toposlam_model::percept::Door(by % 3)),
                    _ => Sighting::Nothing,
                };
            }
            (Entry, EventKind::Arrival(Arrival { entry: Some(entry), .. })) => {
                *entry += f64::from(1 + by % 3) * std::f64::consts::FRAC_PI_2;
            }
            (Form, EventKind::Arrival(Arrival { form: Some(JunctionShape(form)), .. })) => {
                let before = *form;
                *form = [before[0], before[3], before[2], before[1]];
                if *form == before {
                    return Shows::NotOne;
                }
                let next = places.get(event + 1).map(|&next| &self.lines[next].1);
                let Some(EventKind::Door { door, .. }) = next else {
                    return Shows::Never("no door is left by after the last percept");
                };
                return match door.0 {
                    0 => Shows::Never("the entry door is where it was"),
                    // The door that is taken is no longer where the robot goes.
                    _ => Shows::At(event + 1),
                };
            }
            (Door, EventKind::Door { door, .. }) => door.0 = (door.0 + 1 + by % 2) % 3,
            (
                Number,
                EventKind::Arrival(Arrival { number: Some(number), .. })
                | EventKind::Door { number: Some(number), .. },
            ) => *number ^= 1 + by,
            (Dropped, _) => {
                self.lines.remove(place);
            }
            (Repeated, _) => {
                let line = self.lines[place].clone();
                self.lines.insert(place + 1, line);
                return Shows::At(event + 1);
            }
            (Swapped | Later, _) if last => return Shows::NotOne,
            (Swapped, _) => {
                let next = places[event + 1];
                let (one, other) = (self.lines[place].1.clone(), self.lines[next].1.clone());
                (self.lines[place].1, self.lines[next].1) = (other, one);
            }
            (Earlier, _) => match before {
                Some(before) if before < time => self.lines[place].0.time = before - 0.01,
                _ => return Shows::NotOne,
            },
            (Later, _) => {
                self.lines[place].0.time = self.lines[places[event + 1]].0.time + 0.01;
                // Then the next event is too early.
                return Shows::At(event + 1);
            }
            (Within, _) => {
                let next =
                    places.get(event + 1).map_or(time + 1.0, |&next| self.lines[next].0.time);
                self.lines[place].0.time = f64::midpoint(time, next);
                return Shows::Never("the time is still between those of its neighbours");
            }
            _ => return Shows::NotOne,
        }
        Shows::At(event)
    }
}

/// The first event at which a log does not conform, from 0.
fn divergence_at(log: &Log, moves: u64, question: &ConformConfig) -> Option<usize> {
    let mut events = log.recorded();
    events.end.as_mut().unwrap().moves = moves;
    match judge(events, question, &Quirks::default(), &()) {
        Err(JudgeError::OutOfOrder { event, .. }) => Some(event - 1),
        Err(JudgeError::Empty) => Some(0),
        Err(error) => panic!("{error}"),
        Ok(judgement) => judgement.divergence.map(|divergence| divergence.event),
    }
}

#[track_caller]
fn assert_mutation_is_found(
    good: &Log,
    plan: &FloorPlan,
    facing: Dart,
    event: usize,
    how: (Mutation, u32),
) {
    let mut log = good.clone();
    let expected = match log.mutate(event, how.0, how.1) {
        Shows::At(event) => Some(event),
        Shows::Never(_) => None,
        Shows::NotOne => return,
    };
    let question = question(plan, Some(facing));
    let found = divergence_at(&log, good.moves(), &question);
    if how.0 == Mutation::Form && found != expected && is_shape_of(&log, event, &question) {
        return;
    }
    assert_eq!(found, expected, "{how:?} of event {event}");
}

/// Whether a log diverges because a junction has another shape at an event than at another visit.
fn is_shape_of(log: &Log, event: usize, question: &ConformConfig) -> bool {
    let found = judged(&log.recorded(), question).divergence;
    found.is_some_and(|found| match found.cause {
        DivergenceCause::Measurement {
            between,
            measurement: ContradictoryMeasurement::Shape,
            ..
        } => between.contains(&event),
        _ => false,
    })
}

#[test]
fn every_mutation_is_found_at_its_event_or_does_not_show() {
    for (name, plan) in plans().unwrap().into_iter().take(3) {
        println!("{name}");
        let facing = starts_of(&plan)[0];
        let good = log(&plan, facing, 1);
        for event in 0..good.places().len() {
            for mutation in MUTATIONS {
                for by in 0..2 {
                    assert_mutation_is_found(&good, &plan, facing, event, (mutation, by));
                }
            }
        }
    }
}

#[test]
fn a_log_with_a_wrong_number_of_moves_or_a_wrong_map_diverges_at_its_end() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let facing = starts_of(&plan)[0];
    let good = log(&plan, facing, 1);
    let question = question(&plan, Some(facing));
    let end = good.places().len();
    assert_eq!(divergence_at(&good, good.moves() + 1, &question), Some(end));
    let mut events = good.recorded();
    events.map = Some(MapRecord {
        moves: 0,
        degrees: vec![2],
        opposite: [1, 0].map(|dart| Some(Dart(dart))).to_vec(),
        robot: Dart(0),
    });
    let divergence = judged(&events, &question).divergence.unwrap();
    assert_eq!(
        (divergence.event, divergence.cause),
        (end, DivergenceCause::Map { algorithm: MappingAlgorithm::Algorithm1 })
    );
}

#[test]
fn half_a_run_is_incomplete_and_diverges_if_it_is_recorded_as_complete() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let facing = starts_of(&plan)[0];
    let good = log(&plan, facing, 1).recorded();
    let question = question(&plan, Some(facing));
    let half = good.up_to(4);
    assert_eq!(judged(&half, &question).verdict(), ConformVerdict::Incomplete);
    let end = RunEnd { moves: 2, ending: RunEnding::Mapped };
    let whole = RunEvents { end: Some(end), ..half };
    let divergence = judged(&whole, &question).divergence.unwrap();
    assert!(matches!(divergence.cause, DivergenceCause::Unfinished { .. }), "{divergence:?}");
}

#[test]
fn a_wrong_percept_is_a_fault_of_perception_and_a_wrong_door_one_of_motion() {
    // In shape 8 every junction has a door 1.
    let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == "shape-8").unwrap();
    let graph = plan.graph();
    let facing = starts_of(&plan)[0];
    let doors = [1; 8].map(Door);
    let walk = |made: &[Door]| {
        let mut world = GraphWorld::new(graph, facing);
        let mut kinds = vec![world.sensed()];
        for &door in made {
            toposlam_model::world::World::traverse(&mut world, door).unwrap();
            kinds.push(world.sensed());
        }
        kinds
    };
    let events = |percepts: &[Percept]| {
        let mut recorded = RecordedEvents::default();
        let mut observe = |kind| recorded.observe(EventSource::default(), &kind);
        for (moves, &percept) in percepts.iter().enumerate() {
            let number = Some(moves as u32);
            let Percept { degree, sighting } = percept;
            let sighting = Some(sighting);
            let arrival = Arrival { number, degree, sighting, form: None, entry: None };
            observe(EventKind::Arrival(arrival));
            if let Some(&door) = doors.get(moves) {
                observe(EventKind::Door { number: Some(moves as u32 + 1), door });
            }
        }
        RunEvents { events: recorded.finish(), ..RunEvents::default() }
    };
    let question = ConformConfig { driver: RunDriver::Anyone, ..question(&plan, Some(facing)) };
    let right = walk(&doors);
    assert_eq!(judged(&events(&right), &question).divergence, None);
    // One percept is false.
    let mut false_percept = right.clone();
    false_percept[3].degree = 5;
    let divergence = judged(&events(&false_percept), &question).divergence.unwrap();
    assert_eq!((divergence.event, divergence.fault), (6, FaultClass::Perception));
    // The last percept is false, although it would be true elsewhere.
    let mut last = right.clone();
    let degree = &mut last.last_mut().unwrap().degree;
    *degree = if *degree == 2 { 3 } else { 2 };
    let divergence = judged(&events(&last), &question).divergence.unwrap();
    assert_eq!((divergence.event, divergence.fault), (16, FaultClass::Perception));
    // The robot takes another door than the recorded one: all later percepts are of another place.
    let mut made = doors;
    made[2] = Door(0);
    let elsewhere = walk(&made);
    let divergence = judged(&events(&elsewhere), &question).divergence.unwrap();
    assert_eq!(divergence.fault, FaultClass::Motion);
}

#[test]
fn a_quirk_is_tolerated_and_counted() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let facing = starts_of(&plan)[0];
    let mut log = log(&plan, facing, 1);
    let moves = log.moves();
    let percept = log.places().len() - 1;
    assert_eq!(log.mutate(percept, Mutation::Marker, 0), Shows::At(percept));
    let question = question(&plan, Some(facing));
    assert_eq!(divergence_at(&log, moves, &question), Some(percept));
    let text = "[[quirk]]\nname = \"glare\"\ncause = \"percept\"\nreason = \"the window\"";
    let quirks = Quirks::read(text).unwrap();
    let judgement = judge(log.recorded(), &question, &quirks, &()).unwrap();
    assert_eq!((judgement.verdict(), judgement.tolerated.len()), (ConformVerdict::Conforms, 1));
    let elsewhere = Quirks::read(&format!("{text}\nevent = 1")).unwrap();
    let judgement = judge(log.recorded(), &question, &elsewhere, &()).unwrap();
    assert_eq!(judgement.verdict(), ConformVerdict::Diverged);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_mutation_of_a_run_in_a_random_plan_is_found(
        seed in 0_u64..1000,
        event in any::<prop::sample::Index>(),
        mutation in prop::sample::select(MUTATIONS.to_vec()),
        by in 0_u32..3,
    ) {
        let plan = Arc::new(random_plan_with(seed, 8).unwrap());
        if let Some(&facing) = starts_of(&plan).first() {
            let good = log(&plan, facing, seed);
            let event = event.index(good.places().len());
            assert_mutation_is_found(&good, &plan, facing, event, (mutation, by));
        }
    }

    #[test]
    fn a_shorter_log_diverges_in_the_same_way(
        seed in 0_u64..1000,
        event in any::<prop::sample::Index>(),
        mutation in prop::sample::select(MUTATIONS.to_vec()),
    ) {
        let plan = Arc::new(random_plan_with(seed, 8).unwrap());
        let Some(&facing) = starts_of(&plan).first() else { return Ok(()) };
        let mut log = log(&plan, facing, seed);
        let event = event.index(log.places().len());
        log.mutate(event, mutation, 1);
        let question = question(&plan, Some(facing));
        let Ok(judgement) = judge(log.recorded(), &question, &Quirks::default(), &()) else {
            return Ok(());
        };
        if let Some(shorter) = shorten_run(&judgement, &question, &()) {
            let ShortenedRun { events: short, event, by_itself } = shorter;
            let question = if by_itself { question.by_itself() } else { question };
            let divergence = judgement.divergence.unwrap();
            prop_assert!(short.events.len() <= divergence.event + 2);
            let found = judged(&short, &question).divergence.unwrap();
            prop_assert_eq!(found.event, event);
            prop_assert!(found.is_like(&divergence), "{:?} {:?}", found, divergence);
        }
    }
}
