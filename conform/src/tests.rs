//! Good runs conform. The checker finds every mutation of a good run at its event, unless the mutation
//! is known to have no effect.

use std::sync::Arc;

use proptest::prelude::*;
use toposlam_logs::record::{
    Arrival, Event, EventId, EventKind, Frame, MapRecord, RunEnd, RunEnding, RunObserver,
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
    world::{GraphWorld, World},
};
use toposlam_robot::{
    any_explorer::RobotSensor, budget::RunBudget, measured_hallway::log_noise,
    robot::TimedOdometry, run_settings::RunSettings,
};
use toposlam_simulator::{
    SimulationConfig, plans, random_plan::random_plan_with, run::run, starts_of,
};

use super::*;

mod extracted;
mod folding;
mod log_check;
mod log_report;
mod measured;
mod moving;
mod oracle;
mod parts;
mod possible;
mod recovery;
mod report;
mod tolerance;
mod undirected;
mod verdicts;
mod words;

const DARTS: usize = 400;
const FOLDING: MappingAlgorithm = MappingAlgorithm::Folding;

/// A floor plan, and where a run in it starts.
type Place = (Arc<FloorPlan>, Dart);

/// A floor plan of `worlds/`, and its first start.
fn place_in(name: &str) -> Place {
    let (_, plan) = plans().unwrap().into_iter().find(|(plan, _)| plan == name).unwrap();
    let facing = starts_of(&plan)[0];
    (plan, facing)
}

/// The place of most tests.
fn place() -> Place {
    place_in(&plans().unwrap()[2].0)
}

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
        for (message, (timed, line)) in self.lines.iter().enumerate() {
            let source = source(message, timed);
            recorded.observe(source, &EventKind::Odometry(timed.odometry));
            recorded.observe(source, line);
        }
        let end = Some(RunEnd { moves: self.moves(), ending: RunEnding::Mapped });
        let (events, measurement_noise) = (recorded.finish(), log_noise());
        RunEvents { events, has_head: true, end, measurement_noise, ..RunEvents::default() }
    }

    fn inferred(&self) -> Vec<CheckedEvent> {
        let seen = |(message, (timed, line)): (usize, &(TimedOdometry, EventKind))| match line {
            EventKind::Frame(Frame { scene: Some(scene), .. }) => Some(SensedScene {
                source: source(message, timed),
                scene: scene.clone(),
                odometry: timed.odometry,
            }),
            _ => None,
        };
        infer_events(&self.lines.iter().enumerate().filter_map(seen).collect::<Vec<_>>(), true)
    }
}

fn source(message: usize, timed: &TimedOdometry) -> EventSource {
    let time = (timed.time * 1e9).round() as u64;
    EventSource { time, id: EventId(message as u64 + 1), offset: 0 }
}

impl RunObserver for Log {
    fn event(&mut self, event: &Event) {
        match &event.kind {
            EventKind::Frame(frame) if frame.scene.is_some() => self.odometry = frame.odometry,
            EventKind::Door { .. } | EventKind::Arrival(_) => {}
            _ => return,
        }
        let timed = TimedOdometry { time: event.time as f64 / 1e9, odometry: self.odometry };
        self.lines.push((timed, event.kind.clone()));
    }
}

/// A good run of Algorithm 1.
fn log(place: &Place, seed: u64) -> Log {
    log_of(MappingAlgorithm::Algorithm1, place, seed)
}

/// A good run of a robot that maps.
fn log_of(method: impl Into<MappingMethod>, (plan, facing): &Place, seed: u64) -> Log {
    let robot = SimulationConfig::at_start(plan.clone(), *facing, seed).by_scene();
    let mut log = Log::default();
    let run =
        run(plan, *facing, robot, RobotSensor::Scenes, &mut log, &RunSettings::new(method, DARTS));
    assert_eq!(run.outcome(), toposlam_simulator::run::RunOutcome::Right);
    log
}

/// The good run of most tests.
fn good_run() -> RunEvents {
    log(&place(), 1).recorded()
}

/// In this world, where the robot begins at a place, or anywhere.
fn in_world(plan: &FloorPlan, facing: Option<Dart>, config: &ConformConfig) -> ConformConfig {
    let graph = plan.graph().clone();
    let states = match facing {
        Some(facing) => vec![GraphWorld::with_aid(&graph, config.aid, facing).state()],
        None => anywhere(&graph, &config.aid),
    };
    ConformConfig { world: Some(KnownWorld { graph, states }), ..config.clone() }
}

fn at_place((plan, facing): &Place) -> ConformConfig {
    in_world(plan, Some(*facing), &without_world())
}

fn anywhere_in(plan: &FloorPlan) -> ConformConfig {
    in_world(plan, None, &without_world())
}

fn without_world() -> ConformConfig {
    ConformConfig {
        world: None,
        aid: Directional.into(),
        driver: RunDriver::from(MappingAlgorithm::Algorithm1),
        budget: RunBudget::default(),
        search: WorldSearch { class: Class::Multigraph, max_edges: None, steps: 100_000 },
        dart_bound: DARTS,
    }
}

fn driven(config: ConformConfig, driver: impl Into<RunDriver>) -> ConformConfig {
    ConformConfig { driver: driver.into(), ..config }
}

/// The log of a robot that may choose any door, in any world.
fn by_anyone() -> ConformConfig {
    driven(without_world(), RunDriver::Anyone)
}

fn judgement(events: &RunEvents, config: &ConformConfig) -> Result<Judgement, JudgeError> {
    judge(events.clone(), config, &Quirks::default(), &())
}

fn judged(events: &RunEvents, config: &ConformConfig) -> Judgement {
    judgement(events, config).unwrap()
}

fn divergence(events: &RunEvents, config: &ConformConfig) -> Divergence {
    judged(events, config).divergence.unwrap()
}

/// The event of the first divergence, from 0, and the name of its cause.
fn place_of(divergence: &Divergence) -> (usize, &'static str) {
    (divergence.event, divergence.cause.name())
}

fn arrival_at(events: &mut RunEvents, at: usize) -> &mut Arrival {
    events.events[at].arrival_mut().expect("an arrival")
}

/// The events with another number of doors at these arrivals.
fn with_more_doors(events: &RunEvents, at: &[usize], more: u32) -> RunEvents {
    let mut events = events.clone();
    for &at in at {
        let arrival = arrival_at(&mut events, at);
        (arrival.degree, arrival.shape) = (arrival.degree + more, None);
    }
    events
}

/// Events of other programs, without measurements.
fn bare_events(kinds: impl IntoIterator<Item = CheckedKind>) -> RunEvents {
    let event = |kind| CheckedEvent { source: EventSource::default(), kind };
    RunEvents { events: kinds.into_iter().map(event).collect(), ..RunEvents::default() }
}

fn bare_arrival(degree: u32, sighting: Sighting) -> CheckedKind {
    Percept { degree, sighting }.into()
}

fn bare_door(door: u32) -> CheckedKind {
    Door(door).into()
}

/// The verdict and the first divergence of a good run.
const GOOD: (ConformVerdict, Option<Divergence>) = (ConformVerdict::Conforms, None);

#[test]
fn good_logs_of_every_plan_conform_and_their_inferred_events_are_the_recorded_ones() {
    for (name, plan) in plans().unwrap() {
        let places =
            || (0..).zip(starts_of(&plan)).map(|(seed, facing)| (seed, (plan.clone(), facing)));
        for (seed, place) in places().step_by(2) {
            let events = log(&place, seed).recorded();
            for config in [at_place(&place), anywhere_in(&plan), without_world()] {
                let judgement = judged(&events, &config);
                let found = (judgement.verdict(), judgement.divergence);
                assert_eq!(found, GOOD, "{name} from {:?}", place.1);
            }
        }
        for (seed, place) in places().step_by(3) {
            let events = log_of(FOLDING, &place, seed).recorded();
            for config in [at_place(&place), without_world()] {
                let judgement = judged(&events, &driven(config, FOLDING));
                assert_eq!(judgement.determines_world(), Some(true));
                let found = (judgement.verdict(), judgement.divergence);
                assert_eq!(found, GOOD, "{name} from {:?}, folding", place.1);
            }
        }
        for (seed, place) in places() {
            let log = log(&place, seed);
            let recorded = bare(&log.recorded().events);
            assert_eq!(bare(&log.inferred()), recorded, "{name} from {:?}", place.1);
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

/// A random plan with its first start, if it has one.
fn random_place(seed: u64, junctions: usize) -> Option<Place> {
    let plan = Arc::new(random_plan_with(seed, junctions).unwrap());
    let facing = *starts_of(&plan).first()?;
    Some((plan, facing))
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
                    Sighting::Nothing => Sighting::Pointing(self::Door(by % 3)),
                    _ => Sighting::Nothing,
                };
            }
            (Entry, EventKind::Arrival(Arrival { entry: Some(entry), .. })) => {
                *entry += f64::from(1 + by % 3) * std::f64::consts::FRAC_PI_2;
            }
            (Form, EventKind::Arrival(Arrival { shape: Some(JunctionShape(shape)), .. })) => {
                let before = *shape;
                *shape = [before[0], before[3], before[2], before[1]];
                if *shape == before {
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
fn divergence_at(log: &Log, moves: u64, config: &ConformConfig) -> Option<usize> {
    let mut events = log.recorded();
    events.end.as_mut().unwrap().moves = moves;
    match judgement(&events, config) {
        Err(JudgeError::OutOfOrder { event, .. }) => Some(event - 1),
        Err(JudgeError::Empty) => Some(0),
        Err(error) => panic!("{error}"),
        Ok(judgement) => judgement.divergence.map(|divergence| divergence.event),
    }
}

/// A mutation of the shape may show as one of a junction that has another shape at another visit.
#[track_caller]
fn assert_mutation_is_found(
    good: &Log,
    config: &ConformConfig,
    event: usize,
    how: (Mutation, u32),
) {
    let mut log = good.clone();
    let expected = match log.mutate(event, how.0, how.1) {
        Shows::At(event) => Some(event),
        Shows::Never(_) => None,
        Shows::NotOne => return,
    };
    let found = divergence_at(&log, good.moves(), config);
    if how.0 == Mutation::Form && found != expected {
        let found = divergence(&log.recorded(), config);
        let shape = ContradictoryMeasurement::Shape;
        assert!(
            matches!(found.cause, DivergenceCause::Measurement { between, measurement, .. }
                if between.contains(&event) && measurement == shape),
            "{how:?} of event {event}: {found:?}"
        );
        return;
    }
    assert_eq!(found, expected, "{how:?} of event {event}");
}

/// Changes every event of a run in every way, each by less than `most`.
fn assert_mutations_are_found(place: &Place, algorithm: MappingAlgorithm, most: u32) {
    let good = log_of(algorithm, place, 1);
    let config = driven(at_place(place), algorithm);
    for event in 0..good.places().len() {
        for mutation in MUTATIONS {
            for by in 0..most {
                assert_mutation_is_found(&good, &config, event, (mutation, by));
            }
        }
    }
}

#[test]
fn every_mutation_is_found_at_its_event_or_does_not_show() {
    assert_mutations_are_found(&place(), MappingAlgorithm::Algorithm1, 1);
    assert_mutations_are_found(&place(), FOLDING, 1);
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn every_mutation_in_larger_plans_is_found_at_its_event_or_does_not_show() {
    for (_, plan) in plans().unwrap().into_iter().take(3) {
        let facing = starts_of(&plan)[0];
        assert_mutations_are_found(&(plan, facing), MappingAlgorithm::Algorithm1, 2);
    }
}

#[test]
fn a_log_with_a_wrong_number_of_moves_or_a_wrong_map_diverges_at_its_end() {
    let place = place();
    let good = log(&place, 1);
    let config = at_place(&place);
    let end = good.places().len();
    assert_eq!(divergence_at(&good, good.moves() + 1, &config), Some(end));
    let mut events = good.recorded();
    let opposite = [1, 0].map(|dart| Some(Dart(dart))).to_vec();
    events.map = Some(MapRecord { moves: 0, degrees: vec![2], opposite, robot: Dart(0) });
    let algorithm = MappingAlgorithm::Algorithm1;
    let found = divergence(&events, &config);
    assert_eq!((found.event, found.cause), (end, DivergenceCause::Map { algorithm }));
    // Half a run is incomplete, and diverges if it is recorded as complete.
    let half = good.recorded().up_to(4);
    assert_eq!(judged(&half, &config).verdict(), ConformVerdict::NotKnown);
    let end = RunEnd { moves: 2, ending: RunEnding::Mapped };
    let found = divergence(&RunEvents { end: Some(end), ..half }, &config);
    assert!(matches!(found.cause, DivergenceCause::Unfinished { .. }), "{found:?}");
}

#[test]
fn a_wrong_percept_is_a_fault_of_perception_and_a_wrong_door_one_of_motion() {
    // In shape 8 every junction has a door 1.
    let place = place_in("shape-8");
    let graph = place.0.graph();
    let doors = [1; 8].map(Door);
    let walk = |made: &[Door]| {
        let mut world = GraphWorld::new(graph, place.1);
        let mut percepts = vec![world.sensed()];
        for &door in made {
            world.traverse(door).unwrap();
            percepts.push(world.sensed());
        }
        percepts
    };
    let config = driven(at_place(&place), RunDriver::Anyone);
    let found = |percepts: &[Percept]| {
        let mut doors = doors.iter();
        let kinds = percepts.iter().flat_map(|&percept| {
            [Some(percept.into()), doors.next().map(|&door| door.into())].into_iter().flatten()
        });
        let divergence = judged(&bare_events(kinds), &config).divergence;
        divergence.map(|divergence| (divergence.event, divergence.fault))
    };
    let right = walk(&doors);
    assert_eq!(found(&right), None);
    let mut wrong = right.clone();
    wrong[3].degree = 5;
    assert_eq!(found(&wrong), Some((6, FaultClass::Perception)));
    // The last percept is false, although it would be true elsewhere.
    let mut wrong = right.clone();
    wrong[8].degree = if wrong[8].degree == 2 { 3 } else { 2 };
    assert_eq!(found(&wrong), Some((16, FaultClass::Perception)));
    // The robot takes another door than the recorded one: all later percepts are of another place.
    let mut made = doors;
    made[2] = Door(0);
    assert_eq!(found(&walk(&made)).unwrap().1, FaultClass::Motion);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn good_logs_of_random_plans_conform(seed in 0_u64..1000) {
        if let Some(place) = random_place(seed, 12) {
            let log = log(&place, seed);
            prop_assert_eq!(judged(&log.recorded(), &at_place(&place)).divergence, None);
            prop_assert_eq!(bare(&log.inferred()), bare(&log.recorded().events));
        }
    }
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
        if let Some(place) = random_place(seed, 8) {
            let good = log(&place, seed);
            let event = event.index(good.places().len());
            assert_mutation_is_found(&good, &at_place(&place), event, (mutation, by));
        }
    }

    #[test]
    fn a_shorter_log_diverges_in_the_same_way(
        seed in 0_u64..1000,
        event in any::<prop::sample::Index>(),
        mutation in prop::sample::select(MUTATIONS.to_vec()),
    ) {
        let Some(place) = random_place(seed, 8) else { return Ok(()) };
        let mut log = log(&place, seed);
        let event = event.index(log.places().len());
        log.mutate(event, mutation, 1);
        let config = at_place(&place);
        let Ok(judgement) = judgement(&log.recorded(), &config) else { return Ok(()) };
        if let Some(shorter) = shorten_run(&judgement, &config, &()) {
            let ShortenedRun { events: short, event, by_itself } = shorter;
            let config = if by_itself { config.by_itself() } else { config };
            let divergence = judgement.divergence.unwrap();
            prop_assert!(short.events.len() <= divergence.event + 2);
            let found = judged(&short, &config).divergence.unwrap();
            prop_assert_eq!(found.event, event);
            prop_assert!(found.is_like(&divergence), "{:?} {:?}", found, divergence);
        }
    }
}
