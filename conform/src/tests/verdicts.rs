//! "Conforms", "diverged" and "incomplete" are three verdicts: a good log never diverges, a mutated log
//! conforms only if another walk explains it, and a log diverges only at an event that cannot be explained.

use proptest::prelude::*;
use toposlam_model::{
    embedded_graph::EmbeddedGraph,
    enumerate::{Each, EnumeratedGraph, Enumeration},
    folding::{SearchLimit, SmallestWorld},
    format::world_file,
    mapping::{MapWalk, MappingEvent},
    marker::{Marker, NoMarker, Undirected},
    percept::Sighting,
    trace::{Trace, TraceEventKind},
    world::{GraphWorld, World},
};
use toposlam_vision::visits::ApproachParams;

use super::{
    oracle::{Place, is_explained_by_small, takes_doors, witness},
    *,
};

/// How a log is recorded and judged.
#[derive(Clone, Debug)]
struct Options {
    seed: u64,
    junctions: usize,
    /// Whether the world is known, and the start in it.
    world: Option<bool>,
    class: Class,
    steps: u64,
    max_edges: Option<usize>,
    driver: RunDriver,
    dart_bound: usize,
    /// Without numbers, shapes, directions and odometry, as logs of others.
    bare: bool,
    /// Whether the events are inferred from scenes.
    inferred: bool,
    marker: RunMarker,
}

/// The marker of a robot, and how its log records it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RunMarker {
    /// A directional one.
    Directional,
    /// An undirected one, recorded with a door as if it pointed along it.
    AlongDoor,
    /// An undirected one, recorded without a door.
    Undirected,
    /// None, and no record of it.
    NotRecorded,
}

impl RunMarker {
    fn marker(self) -> &'static dyn Marker {
        match self {
            Self::Directional => &Directional,
            Self::AlongDoor | Self::Undirected => &Undirected,
            Self::NotRecorded => &NoMarker,
        }
    }
}

fn options() -> impl Strategy<Value = Options> {
    let world = prop::sample::select(vec![None, Some(true), Some(false)]);
    let by = |algorithm, audits| RunDriver::Method(MappingMethod::By { algorithm, audits });
    let recovery = RecoveryConfig {
        noise: Some(log_noise()),
        retries_blocked: true,
        ..RecoveryConfig::default()
    };
    let drivers = prop::sample::select(vec![
        by(MappingAlgorithm::Algorithm1, 0),
        by(MappingAlgorithm::Algorithm1, 1),
        by(MappingAlgorithm::Folding, 0),
        by(MappingAlgorithm::Folding, 2),
        RunDriver::Method(MappingMethod::Recovering(recovery)),
        RunDriver::Anyone,
    ]);
    let max_edges = prop::option::weighted(0.3, 1_usize..20);
    let limits = (prop::sample::select(vec![0, 30, 2_000]), max_edges, 3_usize..40);
    let class = prop::sample::select(Class::ALL.to_vec());
    let markers = prop::sample::select(vec![
        RunMarker::Directional,
        RunMarker::AlongDoor,
        RunMarker::Undirected,
        RunMarker::NotRecorded,
    ]);
    let recorded = (any::<[bool; 2]>(), markers);
    (0_u64..1000, 2_usize..9, world, class, limits, drivers, recorded).prop_map(
        |(seed, junctions, world, class, limits, driver, ([bare, inferred], marker))| Options {
            seed,
            junctions,
            world,
            class,
            steps: limits.0,
            max_edges: limits.1,
            driver: if marker == RunMarker::Directional { driver } else { RunDriver::Anyone },
            dart_bound: limits.2,
            bare,
            inferred,
            marker,
        },
    )
}

impl Options {
    /// A good run of the algorithm that it is judged with.
    fn log(&self, plan: &Arc<FloorPlan>, facing: Dart) -> Log {
        let method = match self.driver {
            RunDriver::Method(method) => method,
            RunDriver::Anyone => MappingMethod::default(),
        };
        log_of(method, plan, facing, self.seed)
    }

    fn question<'p>(&self, plan: &'p FloorPlan, facing: Dart) -> ConformConfig<'p> {
        let graph = plan.graph();
        let marker = self.marker.marker();
        let known = self.world.map(|known| KnownWorld {
            graph,
            states: if known {
                vec![GraphWorld::with_marker(graph, marker, facing).state()]
            } else {
                anywhere(graph, &marker)
            },
        });
        ConformConfig {
            world: known,
            marker: self.marker.marker(),
            driver: self.driver,
            budget: RunBudget::default(),
            search: WorldSearch { class: self.class, max_edges: self.max_edges, steps: self.steps },
            dart_bound: self.dart_bound,
        }
    }

    /// The events of a log, as far as they are recorded.
    fn recorded(&self, log: &Log) -> RunEvents {
        let mut events = log.recorded();
        if self.inferred {
            events.events = log.inferred();
            events.measurement_noise.standing = ApproachParams::DEFAULT.near;
        }
        for event in &mut events.events {
            match &mut event.kind {
                CheckedKind::Arrival { arrival, entry_off, .. } => {
                    match (self.marker, &mut arrival.sighting) {
                        (RunMarker::NotRecorded, sighting) => *sighting = None,
                        (RunMarker::Undirected, Some(sighting @ Sighting::Pointing(_))) => {
                            *sighting = Sighting::Lying(1);
                        }
                        _ => {}
                    }
                    if self.bare {
                        (arrival.number, arrival.form, arrival.entry) = (None, None, None);
                        *entry_off = None;
                    }
                }
                CheckedKind::Door { number, off, .. } if self.bare => {
                    (*number, *off) = (None, None);
                }
                _ => {}
            }
        }
        events
    }

    /// The places in which the walk may begin, if the world is known.
    fn places<'p>(&self, plan: &'p FloorPlan, facing: Dart) -> Vec<Place<'p>> {
        let graph = plan.graph();
        let is_marked = self.marker != RunMarker::NotRecorded;
        let place = |pose| Place { graph, marker: Some(pose).filter(|_| is_marked), pose };
        match self.world {
            None => Vec::new(),
            Some(true) => vec![place(facing)],
            Some(false) => graph.darts().map(place).collect(),
        }
    }
}

/// Why a mutated log conforms.
#[derive(Debug)]
#[expect(dead_code, reason = "the reasons are printed if they do not hold")]
enum Unobservable {
    /// The mutation changes nothing that is compared: see [`Log::mutate`].
    NotCompared(&'static str),
    /// What was mutated is not in the log.
    NotRecorded,
    /// The log is one of another walk in the known world.
    AnotherWalk,
    /// The log is one of a walk in another world, which was found.
    AnotherWorld,
}

fn trace_of(events: &RunEvents, question: &ConformConfig) -> Trace {
    let mut events = events.clone();
    events.complete_sightings(question.marker).unwrap();
    events.trace().unwrap()
}

/// A quirk for a cause, at one event or at all.
fn quirk_of(cause: &str, event: Option<usize>) -> Result<Quirks, QuirkError> {
    let event = event.map_or(String::new(), |event| format!("event = {}\n", event + 1));
    Quirks::read(&format!(
        "[[quirk]]\nname = \"one\"\ncause = \"{cause}\"\nreason = \"it is known\"\n{event}"
    ))
}

/// Any quirk.
fn quirk() -> impl Strategy<Value = Quirks> {
    let causes =
        ["percept", "number", "shape", "entry", "moved", "aside", "turned-back"].as_slice();
    let event = prop::option::of(0_usize..20);
    (prop::sample::select(causes), event).prop_map(|(cause, event)| quirk_of(cause, event).unwrap())
}

/// Checks that no world of any size explains the trace up to an event, and that one explains it up to the
/// event before.
fn assert_impossible(trace: &Trace, event: usize) {
    if let Some(before) = event.checked_sub(1) {
        let before = trace.up_to(before);
        // Where an undirected marker may lie in too many ways, this is not decided.
        if let Ok(witness) = witness(&before) {
            let (graph, marker, pose) = witness.expect("it is possible before the event");
            assert!(Place { graph: &graph, marker, pose }.explains(&before));
        }
    }
    let cut = trace.up_to(event);
    assert!(!matches!(witness(&cut), Ok(Some(_))), "event {event} is possible");
    assert!(!is_explained_by_small(&cut, 3), "event {event} is possible");
}

/// Checks that each world that explains the trace up to an event has a loop or parallel edges, and that this
/// is not so before.
fn assert_not_simple(trace: &Trace, event: usize) {
    let [before, cut] = [event - 1, event].map(|event| witness(&trace.up_to(event)));
    if let Ok(cut) = cut {
        let (graph, ..) = cut.unwrap();
        assert!(!graph.is_simple(), "event {event} is possible");
    }
    if let Ok(before) = before {
        let (graph, ..) = before.unwrap();
        assert!(graph.is_simple());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn a_good_log_never_diverges_and_needs_no_quirk(
        options in options(),
        cut in any::<prop::sample::Index>(),
        quirk in quirk(),
    ) {
        let plan = Arc::new(random_plan_with(options.seed, options.junctions).unwrap());
        let Some(&facing) = starts_of(&plan).first() else { return Ok(()) };
        let log = options.log(&plan, facing);
        let whole = options.recorded(&log);
        let last = cut.index(2 * whole.events.len());
        let is_cut = last < whole.events.len();
        let events = if is_cut { whole.up_to(last) } else { whole };
        let question = options.question(&plan, facing);
        let judgement = judged(&events, &question);
        prop_assert_eq!(&judgement.divergence, &None);
        let complete = !is_cut && judgement.is_decided();
        let expected =
            if complete { ConformVerdict::Conforms } else { ConformVerdict::Incomplete };
        prop_assert_eq!(judgement.verdict(), expected);
        let with_quirk = judge(events.clone(), &question, &quirk, &()).unwrap();
        prop_assert_eq!((with_quirk.verdict(), with_quirk.tolerated.len()), (expected, 0));
        if let Some(SmallestWorld::World { graph, marker, .. }) = &judgement.smallest {
            let trace = trace_of(&events, &question);
            let place = Place { graph, marker: *marker, pose: Dart(0) };
            prop_assert!(place.explains(&trace));
            prop_assert!(options.class.contains(graph));
        }
    }

    #[test]
    fn a_mutated_log_diverges_where_it_must_or_another_walk_explains_it(
        options in options(),
        event in any::<prop::sample::Index>(),
        mutation in prop::sample::select(MUTATIONS.to_vec()),
        by in 0_u32..3,
    ) {
        let plan = Arc::new(random_plan_with(options.seed, options.junctions).unwrap());
        let Some(&facing) = starts_of(&plan).first() else { return Ok(()) };
        // Scenes are not mutated.
        let options = Options { inferred: false, ..options };
        let good = options.log(&plan, facing);
        let mut mutated = good.clone();
        let shows = mutated.mutate(event.index(good.places().len()), mutation, by);
        if shows == Shows::NotOne {
            return Ok(());
        }
        let question = options.question(&plan, facing);
        let [before, mut events] = [&good, &mutated].map(|log| options.recorded(log));
        events.end.as_mut().unwrap().moves = good.moves();
        // As the command does.
        events.complete_sightings(question.marker).unwrap();
        let checked = match options.driver {
            RunDriver::Anyone => events.without_excursions(),
            RunDriver::Method(_) => events.clone(),
        };
        let Ok(judgement) = judge(checked.clone(), &question, &Quirks::default(), &()) else {
            return Ok(());
        };
        if let Some(divergence) = &judgement.divergence
            && let Ok(quirk) = quirk_of(divergence.cause.name(), Some(divergence.event))
        {
            // The events before it stay as they are, and what is tolerated is not where the log diverges.
            let place = |found: &Divergence| (found.event, found.cause.name());
            let again = judge(checked, &question, &quirk, &()).unwrap();
            let left = again.divergence.as_ref().map(place);
            match &again.tolerated[..] {
                [] => prop_assert_eq!(left, Some(place(divergence))),
                tolerated => {
                    prop_assert!(tolerated.iter().all(|(found, _)| place(found) == place(divergence)));
                    prop_assert_ne!(left, Some(place(divergence)));
                    prop_assert!(left.is_none_or(|(event, _)| event >= divergence.event));
                }
            }
        }
        match judgement.divergence.as_ref().map(|divergence| &divergence.cause) {
            Some(DivergenceCause::NoWorld { event, why }) => {
                let event = judgement.trace.index_of(event.id);
                match why {
                    Impossibility::NotSimple { .. } => {
                        assert_not_simple(&judgement.trace, event);
                    }
                    Impossibility::Class { .. } => prop_assert_eq!(options.class, Class::Planar),
                    _ => assert_impossible(&judgement.trace, event),
                }
            }
            Some(DivergenceCause::World(misfit)) => {
                let cut = judgement.trace.up_to(judgement.trace.index_of(misfit.event.id));
                let places = options.places(&plan, facing);
                prop_assert!(!places.iter().any(|place| place.explains(&cut)));
            }
            Some(DivergenceCause::Algorithm(departure)) => {
                let event = judgement.trace.index_of(departure.event.id);
                match departure.event.kind {
                    // The algorithm begins with the marker in front of it.
                    TraceEventKind::Percept(percept) if event == 0 => {
                        prop_assert_ne!(percept.sighting, Sighting::Pointing(Door(0)));
                    }
                    // A percept that contradicts others does so in every world.
                    TraceEventKind::Percept(_) => {
                        prop_assert_eq!(witness(&judgement.trace.up_to(event)).unwrap(), None);
                    }
                    TraceEventKind::Door(_) => {
                        if let RunDriver::Method(MappingMethod::By { algorithm, audits: 0 }) = options.driver {
                            let cut = judgement.trace.up_to(event);
                            prop_assert_ne!(takes_doors(algorithm, &cut), Some(true));
                        }
                    }
                }
            }
            Some(_) => {}
            None if judgement.verdict() == ConformVerdict::Incomplete => {}
            None => {
                let trace = trace_of(&events, &question);
                let same = trace == trace_of(&before, &question);
                let why = match (shows, &judgement.smallest) {
                    (Shows::Never(why), _) => Unobservable::NotCompared(why),
                    _ if same => Unobservable::NotRecorded,
                    (_, Some(_)) => Unobservable::AnotherWorld,
                    (_, None) => Unobservable::AnotherWalk,
                };
                let holds = match &why {
                    Unobservable::NotCompared(_) => same,
                    Unobservable::NotRecorded => {
                        let is_unmarked = options.marker == RunMarker::NotRecorded;
                        options.bare || (is_unmarked && mutation == Mutation::Marker)
                    }
                    Unobservable::AnotherWalk => {
                        options.places(&plan, facing).iter().any(|place| place.explains(&trace))
                    }
                    Unobservable::AnotherWorld => match &judgement.smallest {
                        Some(SmallestWorld::World { graph, marker, .. }) => {
                            let place = Place { graph, marker: *marker, pose: Dart(0) };
                            place.explains(&trace) && options.class.contains(graph)
                        }
                        _ => false,
                    },
                };
                prop_assert!(holds, "{:?} conforms: {:?}", mutation, why);
            }
        }
    }

    #[test]
    fn the_first_impossible_event_is_exact(
        edges in 1_usize..4,
        start in any::<prop::sample::Index>(),
        walk in prop::collection::vec(0_u32..4, 0..9),
        changed in any::<prop::sample::Index>(),
        change in 0_u32..9,
    ) {
        let mut starts: Vec<EmbeddedGraph> = Vec::new();
        let mut visit = |found: EnumeratedGraph| {
            starts.push(found.graph.clone());
            std::ops::ControlFlow::Continue(())
        };
        let all = Enumeration::new(Each::Start, Class::Multigraph, edges).unwrap();
        let _ = all.for_each(&mut visit);
        let mut world = GraphWorld::new(&starts[start.index(starts.len())], Dart(0));
        let mut kinds = vec![TraceEventKind::Percept(world.sensed())];
        for step in walk {
            let door = Door(step % world.sensed().degree);
            world.traverse(door).unwrap();
            kinds.extend([TraceEventKind::Door(door), TraceEventKind::Percept(world.sensed())]);
        }
        let good = Trace::new(kinds.clone()).unwrap();
        let impossible = |trace: &Trace| FoldedTrace::new(trace, &Directional, Class::Multigraph).impossible;
        prop_assert_eq!(impossible(&good), None);
        let at = changed.index(kinds.len());
        match &mut kinds[at] {
            TraceEventKind::Percept(percept) if change < 3 => percept.degree = change + 1,
            TraceEventKind::Percept(percept) => {
                percept.sighting = match change {
                    3 => Sighting::Nothing,
                    door => Sighting::Pointing(Door(door - 4)),
                };
            }
            TraceEventKind::Door(door) => door.0 = change % 5,
        }
        let trace = Trace::new(kinds).unwrap();
        if let Some((event, _)) = impossible(&trace) {
            prop_assert!(event >= at);
            assert_impossible(&trace, event);
        } else {
            let (graph, marker, pose) = witness(&trace).unwrap().expect("a world explains it");
            let place = Place { graph: &graph, marker, pose };
            prop_assert!(place.explains(&trace));
        }
    }
}

/// A walk of others in building 12, which has 14 edges.
#[test]
fn a_limit_is_not_a_divergence() {
    let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == "building-12").unwrap();
    let facing = starts_of(&plan)[0];
    let events = log(&plan, facing, 1).recorded();
    let search = WorldSearch { steps: 0, ..without_world().search };
    let anyone = ConformConfig { driver: RunDriver::Anyone, search, ..without_world() };
    // A complete trail needs no search.
    let whole = judged(&events, &anyone);
    assert_eq!((whole.verdict(), whole.determines_world()), (ConformVerdict::Conforms, Some(true)));
    let Some(SmallestWorld::World { graph, limit: None, .. }) = &whole.smallest else { panic!() };
    assert_eq!(graph.edge_count(), 14);
    // Half of the walk is explained by a world that may not be the smallest.
    let half = events.up_to(events.events.len() / 2);
    let half = RunEvents { has_head: false, end: None, ..half };
    let few = judged(&half, &anyone);
    assert_eq!(few.limits(), [ReachedLimit::SmallerWorld(SearchLimit::Steps)]);
    assert_eq!((few.verdict(), few.determines_world()), (ConformVerdict::Conforms, Some(false)));
    let many = ConformConfig { search: without_world().search, ..anyone };
    assert_eq!(judged(&half, &many).limits(), []);
    // The world has one edge more.
    let search = WorldSearch { max_edges: Some(13), ..without_world().search };
    let bounded =
        judged(&events, &ConformConfig { driver: RunDriver::Anyone, search, ..without_world() });
    assert_eq!((bounded.verdict(), &bounded.divergence), (ConformVerdict::Incomplete, &None));
    assert_eq!(bounded.limits(), [ReachedLimit::World(SearchLimit::Edges)]);
    // Algorithm 1 does not come to its end if it may know only one dart.
    let few = judged(&events, &ConformConfig { dart_bound: 1, ..without_world() });
    assert_eq!((few.verdict(), &few.divergence), (ConformVerdict::Incomplete, &None));
    let at_once = |limit: &ReachedLimit| matches!(limit, ReachedLimit::Darts { event: 0, .. });
    assert!(few.limits().iter().any(at_once), "{:?}", few.limits());
}

/// The robot leaves by a door and comes back to the marker by another one.
#[test]
fn a_loop_is_a_divergence_in_a_class_without_loops() {
    let marked = |door| {
        TraceEventKind::Percept(Percept { degree: 3, sighting: Sighting::Pointing(Door(door)) })
    };
    let events = [marked(0), TraceEventKind::Door(Door(1)), marked(1)];
    let trace = Trace::new(events).unwrap();
    let impossible = |class| FoldedTrace::new(&trace, &Directional, class).impossible;
    assert_eq!(impossible(Class::Multigraph), None);
    for class in [Class::Simple, Class::Corridor, Class::Planar] {
        assert_eq!(impossible(class), Some((2, Impossibility::NotSimple { class })));
    }
}

#[test]
fn the_marker_is_honoured_without_a_world() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let events = log(&plan, starts_of(&plan)[0], 1).recorded();
    // A robot without a marker does not see one.
    let unmarked =
        ConformConfig { marker: &NoMarker, driver: RunDriver::Anyone, ..without_world() };
    let divergence = judged(&events, &unmarked).divergence.unwrap();
    assert_eq!((divergence.event, divergence.fault), (0, FaultClass::Perception));
    let DivergenceCause::NoWorld { why, .. } = divergence.cause else { panic!() };
    assert_eq!(why, Impossibility::Marker);
    // Algorithm 1 needs one.
    let algorithm =
        ConformConfig { driver: RunDriver::from(MappingAlgorithm::Algorithm1), ..unmarked.clone() };
    let judged =
        |question: &ConformConfig| judge(events.clone(), question, &Quirks::default(), &());
    let error = judged(&algorithm).unwrap_err();
    assert_eq!(error.to_string(), "Algorithm 1 needs the directional marker, not `none`");
    // If the marker is not recorded, the log does not show that it was not seen.
    let unmapped = Options { marker: RunMarker::NotRecorded, ..bare() }.recorded(&log(
        &plan,
        starts_of(&plan)[0],
        1,
    ));
    let judged =
        |question: &ConformConfig| judge(unmapped.clone(), question, &Quirks::default(), &());
    assert_eq!(
        judged(&without_world()).unwrap_err(),
        JudgeError::Marker(SightingError::NotRecorded)
    );
    assert_eq!(judged(&unmarked).unwrap().divergence, None);
}

/// Judged as a log of others.
fn bare() -> Options {
    Options {
        seed: 1,
        junctions: 6,
        world: None,
        class: Class::Multigraph,
        steps: 100_000,
        max_edges: None,
        driver: RunDriver::Anyone,
        dart_bound: DARTS,
        bare: true,
        inferred: false,
        marker: RunMarker::Directional,
    }
}

/// The wheel of Figure 1(b) lies on the torus.
#[test]
fn the_first_event_that_no_planar_world_explains_is_exact() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../worlds/figure-1b.toml");
    let wheel = world_file::read(&std::fs::read(file).unwrap()).unwrap();
    let mut robot = GraphWorld::new(&wheel.graph, wheel.start.unwrap());
    let mut kinds = vec![(robot.sensed(), None)];
    let mut listen = |robot: &mut GraphWorld, _: &MapWalk, event: MappingEvent| {
        if let MappingEvent::Moved { door, .. } = event {
            kinds.push((robot.sensed(), Some(door)));
        }
    };
    MappingAlgorithm::Algorithm1.map_world(&mut robot, DARTS, &mut listen).1.unwrap();
    let mut recorded = RecordedEvents::default();
    let mut observe = |kind| recorded.observe(EventSource::default(), &kind);
    for (Percept { degree, sighting }, door) in kinds {
        if let Some(door) = door {
            observe(EventKind::Door { number: None, door });
        }
        let sighting = Some(sighting);
        observe(EventKind::Arrival(Arrival {
            number: None,
            degree,
            sighting,
            form: None,
            entry: None,
        }));
    }
    let events = RunEvents { events: recorded.finish(), ..RunEvents::default() };
    let search = WorldSearch { class: Class::Planar, ..without_world().search };
    let planar = ConformConfig { search, ..without_world() };
    let divergence_of = |last| judged(&events.up_to(last), &planar).divergence;
    let last = events.events.len() - 1;
    let whole = divergence_of(last).unwrap();
    let class = Impossibility::Class { class: Class::Planar };
    assert!(matches!(&whole.cause, DivergenceCause::NoWorld { why, .. } if *why == class));
    for event in (0..=last).step_by(2) {
        let found = divergence_of(event);
        let first = (event >= whole.event).then_some(&whole);
        assert_eq!(found.as_ref(), first, "after event {event}");
    }
    let other = ConformConfig { search: without_world().search, ..planar.clone() };
    assert_eq!(judged(&events, &other).divergence, None);
}

/// Events of other programs, without measurements.
fn bare_events(kinds: impl IntoIterator<Item = CheckedKind>) -> RunEvents {
    let event = |kind| CheckedEvent { source: EventSource::default(), kind };
    RunEvents { events: kinds.into_iter().map(event).collect(), ..RunEvents::default() }
}

fn bare_arrival(degree: u32, sighting: Sighting) -> CheckedKind {
    let sighting = Some(sighting);
    CheckedKind::Arrival {
        arrival: Arrival { number: None, degree, sighting, form: None, entry: None },
        entry_off: None,
        hallway: None,
    }
}

fn bare_door(door: u32) -> CheckedKind {
    CheckedKind::Door { door: Door(door), number: None, off: None }
}

#[test]
fn a_driver_may_turn_back_but_not_find_another_junction_then() {
    let arrival = |degree| bare_arrival(degree, Sighting::Nothing);
    let events = |again| {
        let back = CheckedKind::TurnedBack;
        bare_events([arrival(3), bare_door(1), back, arrival(again), bare_door(2), arrival(2)])
    };
    let anyone = ConformConfig { driver: RunDriver::Anyone, ..without_world() };
    assert_eq!(judged(&events(3).without_excursions(), &anyone).divergence, None);
    let found = judged(&events(4).without_excursions(), &anyone).divergence.unwrap();
    assert_eq!((found.event, found.fault), (2, FaultClass::Perception));
    assert_eq!(found.cause, DivergenceCause::Return { before: 3, now: 4 });
    // Who does not say that it may turn back has not moved as it should.
    let found = judged(&events(3), &anyone).divergence.unwrap();
    assert_eq!((found.event, found.cause), (2, DivergenceCause::TurnedBack));
}

#[test]
fn a_driver_who_turned_back_before_an_unrecognised_junction_is_accused_of_nothing() {
    let unclear = CheckedKind::Undecided(UndecidedCause::Unclear);
    let walk = [bare_arrival(3, Sighting::Nothing), bare_door(1), CheckedKind::TurnedBack, unclear];
    let events = bare_events(walk).without_excursions();
    let anyone = ConformConfig { driver: RunDriver::Anyone, ..without_world() };
    let judgement = judged(&events, &anyone);
    assert_eq!((judgement.unrecognised, &judgement.divergence), (Some(3), &None));
    assert_eq!(judgement.verdict(), ConformVerdict::Incomplete);
}

#[test]
fn the_door_after_turning_back_is_counted_from_the_first_entry() {
    // From the way back, doors 1 and 2 of the second entry are doors 2 and 0 of the first one; and the marker is
    // along the same door.
    let pointing = |door| Sighting::Pointing(Door(door));
    let back = || CheckedKind::TurnedBack;
    for (again, door) in [(1, 2), (2, 0)] {
        let events = bare_events([
            bare_arrival(3, pointing(0)),
            bare_door(1),
            back(),
            bare_arrival(3, pointing(2)),
            bare_door(again),
        ]);
        let kept = bare_events([bare_arrival(3, pointing(0)), bare_door(door)]);
        assert_eq!(events.without_excursions(), RunEvents { may_turn_back: true, ..kept });
    }
    // Twice; then 1 + 1 + 1 doors are all round.
    let excursion = |along| [bare_door(1), back(), bare_arrival(3, pointing(along))];
    let first = bare_arrival(3, pointing(0));
    let twice = excursion(2).into_iter().chain(excursion(1));
    let events = bare_events([first.clone()].into_iter().chain(twice).chain([bare_door(1)]));
    let kept = RunEvents { may_turn_back: true, ..bare_events([first, bare_door(0)]) };
    assert_eq!(events.without_excursions(), kept);
}

#[test]
fn a_door_that_a_junction_does_not_have_diverges_whoever_drives() {
    let anyone = ConformConfig { driver: RunDriver::Anyone, ..without_world() };
    let nothing = |degree| bare_arrival(degree, Sighting::Nothing);
    let at = |events: RunEvents| {
        let found = judged(&events.without_excursions(), &anyone).divergence;
        found.map(|found| (found.event, found.cause.name()))
    };
    for (door, found) in [(1, None), (2, Some((3, "no-world"))), (u32::MAX, Some((3, "no-world")))]
    {
        // After the junction with two doors lies another one.
        let walk = [nothing(1), bare_door(0), nothing(2), bare_door(door), nothing(1)];
        assert_eq!(at(bare_events(walk)), found, "door {door}");
    }
    for door in [2, u32::MAX] {
        let back = || CheckedKind::TurnedBack;
        let pointing = |door| bare_arrival(2, Sighting::Pointing(Door(door)));
        // By a door that is not there, the robot has not turned back.
        let left = [pointing(0), bare_door(door), back(), pointing(0), bare_door(0), nothing(1)];
        assert_eq!(at(bare_events(left)), Some((1, "no-world")), "door {door}");
        let later = [pointing(0), bare_door(1), back(), pointing(1), bare_door(door), nothing(1)];
        assert_eq!(at(bare_events(later)), Some((1, "no-world")), "door {door}");
        let marker = [pointing(door), bare_door(1), back(), pointing(door), bare_door(0)];
        assert_eq!(at(bare_events(marker)), Some((0, "no-world")), "marker along door {door}");
    }
}
