//! "Conforms", "diverged" and "not known" are three verdicts: a good log never diverges, a mutated log
//! conforms only if another walk explains it, and a log diverges only at an event that cannot be explained.

use toposlam_model::{
    aid::AidKind,
    embedded_graph::EmbeddedGraph,
    enumerate::{Each, Enumeration},
    folding::{SearchLimit, SmallestWorld},
    format::world_file,
    mapping::{MapWalk, MappingEvent},
    marker::{Directional, MarkerKind, NoMarker, Undirected},
    trace::{Trace, TraceEventKind},
};
use toposlam_vision::visits::APPROACH_RANGE;

use super::{
    oracle::{Position, is_explained_by_small, takes_doors, witness},
    recovery::recovering,
    *,
};
use crate::impossible::FoldedTrace;

/// How a log is recorded and judged.
#[derive(Clone, Debug)]
struct Options {
    seed: u64,
    junctions: usize,
    /// Whether the world is known, and the start in it.
    world: Option<bool>,
    /// Without the world.
    config: ConformConfig,
    /// Without numbers, shapes, directions and odometry, as logs of others.
    bare: bool,
    /// Whether the events are inferred from scenes.
    inferred: bool,
    marker: RunMarker,
}

/// The marker of a robot, and how its log records it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RunMarker {
    Directional,
    /// An undirected one, recorded with a door as if it pointed along it.
    AlongDoor,
    /// An undirected one, recorded without a door.
    Undirected,
    /// None, and no record of it.
    NotRecorded,
}

impl RunMarker {
    fn marker(self) -> MarkerKind {
        match self {
            Self::Directional => Directional,
            Self::AlongDoor | Self::Undirected => Undirected,
            Self::NotRecorded => NoMarker,
        }
    }
}

prop_compose! {
    fn options()(
        seed in 0_u64..1000,
        junctions in 2_usize..9,
        world in prop::sample::select(vec![None, Some(true), Some(false)]),
        class in prop::sample::select(Class::ALL.to_vec()),
        steps in prop::sample::select(vec![0, 30, 2_000]),
        max_edges in prop::option::weighted(0.3, 1_usize..20),
        dart_bound in 3_usize..40,
        driver in prop::sample::select(drivers()),
        [bare, inferred] in any::<[bool; 2]>(),
        marker in prop::sample::select(vec![
            RunMarker::Directional,
            RunMarker::AlongDoor,
            RunMarker::Undirected,
            RunMarker::NotRecorded,
        ]),
    ) -> Options {
        let driver = if marker == RunMarker::Directional { driver } else { RunDriver::Anyone };
        let search = WorldSearch { class, max_edges, steps };
        let config = ConformConfig { aid: marker.marker().into(), driver, search, dart_bound, ..without_world() };
        Options { seed, junctions, world, config, bare, inferred, marker }
    }
}

fn drivers() -> Vec<RunDriver> {
    let by = |algorithm, audits| MappingMethod::By { algorithm, audits };
    let algorithm1 = MappingAlgorithm::Algorithm1;
    let methods =
        [by(algorithm1, 0), by(algorithm1, 1), by(FOLDING, 0), by(FOLDING, 2), recovering()];
    methods.map(RunDriver::Method).into_iter().chain([RunDriver::Anyone]).collect()
}

impl Options {
    /// A good run of the algorithm that it is judged with.
    fn log(&self, place: &Place) -> Log {
        let method = match self.config.driver {
            RunDriver::Method(method) => method,
            RunDriver::Anyone => MappingMethod::default(),
        };
        log_of(method, place, self.seed)
    }

    fn config(&self, (plan, facing): &Place) -> ConformConfig {
        match self.world {
            None => self.config.clone(),
            Some(is_known) => in_world(plan, is_known.then_some(*facing), &self.config),
        }
    }

    /// The events of a log, as far as they are recorded.
    fn recorded(&self, log: &Log) -> RunEvents {
        let mut events = log.recorded();
        if self.inferred {
            events.events = log.inferred();
            events.measurement_noise.standing = APPROACH_RANGE;
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
                        (arrival.number, arrival.shape, arrival.entry) = (None, None, None);
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

    /// Whether the walk of a trace, from where it may begin in the known world, has its percepts.
    fn explains(&self, (plan, facing): &Place, trace: &Trace) -> bool {
        let graph = plan.graph();
        let is_marked = self.marker != RunMarker::NotRecorded;
        let mut starts = match self.world {
            None => Vec::new(),
            Some(true) => vec![*facing],
            Some(false) => graph.darts().collect(),
        }
        .into_iter();
        starts.any(|pose| {
            let marker = Some(pose).filter(|_| is_marked);
            Position { graph, marker, pose }.explains(trace)
        })
    }
}

fn trace_of(events: &RunEvents, config: &ConformConfig) -> Trace {
    let mut events = events.clone();
    events.complete_sightings(config.aid).unwrap();
    events.trace().unwrap()
}

/// A quirk for a cause, at one event or at all; `None` if it cannot be tolerated.
fn quirk_of(cause: &str, event: Option<usize>) -> Option<Quirks> {
    let event = event.map_or(String::new(), |event| format!("event = {}\n", event + 1));
    let text = format!(
        "[[quirk]]\nname = \"one\"\ncause = \"{cause}\"\nreason = \"it is known\"\n{event}"
    );
    Quirks::read(&text).ok()
}

/// Any quirk.
fn quirk() -> impl Strategy<Value = Quirks> {
    let causes =
        ["percept", "number", "shape", "entry", "moved", "aside", "turned-back"].as_slice();
    let event = prop::option::of(0_usize..20);
    (prop::sample::select(causes), event).prop_map(|(cause, event)| quirk_of(cause, event).unwrap())
}

/// Checks that no world of any size explains the trace up to an event, of a robot with a marker or without one, and that
/// one explains it up to the event before.
fn assert_impossible(trace: &Trace, event: usize, is_marked: bool) {
    if let Some(before) = event.checked_sub(1) {
        let before = trace.up_to(before);
        // Where an undirected marker may lie in too many ways, this is not decided.
        if let Ok(witness) = witness(&before) {
            let (graph, marker, pose) = witness.expect("it is possible before the event");
            assert!(Position { graph: &graph, marker, pose }.explains(&before));
        }
    }
    let cut = trace.up_to(event);
    if let Ok(Some((graph, marker, pose))) = witness(&cut) {
        // The marker would lie where the robot has not been.
        let explains = |dart| Position { graph: &graph, marker: Some(dart), pose }.explains(&cut);
        let has_place = marker.is_some() || graph.darts().any(explains);
        assert!(is_marked && !has_place, "event {event} is possible");
    }
    assert!(!is_explained_by_small(&cut, 3, is_marked), "event {event} is possible");
}

/// Checks that each world that explains the trace up to an event has a loop or parallel edges, and that this
/// is not so before.
fn assert_not_simple(trace: &Trace, event: usize) {
    for (last, is_simple) in [(event, false), (event - 1, true)] {
        if let Ok(witness) = witness(&trace.up_to(last)) {
            assert_eq!(witness.unwrap().0.is_simple(), is_simple, "event {event}");
        }
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
        let Some(place) = random_place(options.seed, options.junctions) else { return Ok(()) };
        let log = options.log(&place);
        prop_assert_eq!(bare(&log.inferred()), bare(&log.recorded().events));
        let whole = options.recorded(&log);
        let last = cut.index(2 * whole.events.len());
        let is_cut = last < whole.events.len();
        let events = if is_cut { whole.up_to(last) } else { whole };
        let config = options.config(&place);
        let judgement = judged(&events, &config);
        prop_assert_eq!(&judgement.divergence, &None);
        let complete = !is_cut && judgement.is_decided();
        let expected =
            if complete { ConformVerdict::Conforms } else { ConformVerdict::NotKnown };
        prop_assert_eq!(judgement.verdict(), expected);
        let with_quirk = judge(events.clone(), &config, &quirk, &()).unwrap();
        prop_assert_eq!((with_quirk.verdict(), with_quirk.tolerated.len()), (expected, 0));
        if let Some(SmallestWorld::World { graph, marker, .. }) = &judgement.smallest {
            let position = Position { graph, marker: *marker, pose: Dart(0) };
            prop_assert!(position.explains(&trace_of(&events, &config)));
            prop_assert!(config.search.class.contains(graph));
        }
    }

    #[test]
    fn a_mutated_log_diverges_where_it_must_or_another_walk_explains_it(
        options in options(),
        event in any::<prop::sample::Index>(),
        mutation in prop::sample::select(MUTATIONS.to_vec()),
        by in 0_u32..3,
    ) {
        let Some(place) = random_place(options.seed, options.junctions) else { return Ok(()) };
        // Scenes are not mutated.
        let options = Options { inferred: false, ..options };
        let good = options.log(&place);
        let mut mutated = good.clone();
        let shows = mutated.mutate(event.index(good.places().len()), mutation, by);
        if shows == Shows::NotOne {
            return Ok(());
        }
        let config = options.config(&place);
        let [before, mut events] = [&good, &mutated].map(|log| options.recorded(log));
        events.end.as_mut().unwrap().moves = good.moves();
        // As the command does.
        events.complete_sightings(config.aid).unwrap();
        let checked = match config.driver {
            RunDriver::Anyone => events.without_excursions(),
            RunDriver::Method(_) => events.clone(),
        };
        let Ok(judgement) = judgement(&checked, &config) else { return Ok(()) };
        if let Some(divergence) = &judgement.divergence
            && let Some(quirk) = quirk_of(divergence.cause.name(), Some(divergence.event))
        {
            // The events before it stay as they are, and what is tolerated is not where the log diverges.
            let again = judge(checked, &config, &quirk, &()).unwrap();
            let left = again.divergence.as_ref().map(place_of);
            let place = place_of(divergence);
            prop_assert!(again.tolerated.iter().all(|(found, _)| place_of(found) == place));
            prop_assert_eq!(left == Some(place), again.tolerated.is_empty());
            prop_assert!(left.is_none_or(|(event, _)| event >= divergence.event));
        }
        let trace = &judgement.trace;
        match judgement.divergence.as_ref().map(|divergence| &divergence.cause) {
            Some(DivergenceCause::NoWorld { event, why }) => {
                let event = trace.index_of(event.id);
                match why {
                    Impossibility::NotSimple { .. } => assert_not_simple(trace, event),
                    Impossibility::Class { .. } => {
                        prop_assert_eq!(config.search.class, Class::Planar);
                    }
                    _ => {
                        assert_impossible(trace, event, config.aid != AidKind::from(NoMarker));
                    }
                }
            }
            Some(DivergenceCause::World(misfit)) => {
                let cut = trace.up_to(trace.index_of(misfit.event.id));
                prop_assert!(!options.explains(&place, &cut));
            }
            Some(DivergenceCause::Algorithm(departure)) => {
                let event = trace.index_of(departure.event.id);
                let cut = trace.up_to(event);
                match departure.event.kind {
                    // The algorithm begins with the marker in front of it.
                    TraceEventKind::Percept(percept) if event == 0 => {
                        prop_assert_ne!(percept.sighting, Sighting::Pointing(Door(0)));
                    }
                    // A percept that contradicts others does so in every world.
                    TraceEventKind::Percept(_) => prop_assert_eq!(witness(&cut).unwrap(), None),
                    TraceEventKind::Action(action) => panic!("{action} with a fixed marker"),
                    TraceEventKind::Door(_) => {
                        if let RunDriver::Method(MappingMethod::By { algorithm, audits: 0 }) =
                            config.driver
                        {
                            prop_assert_ne!(takes_doors(algorithm, &cut), Some(true));
                        }
                    }
                }
            }
            None if judgement.verdict() == ConformVerdict::Conforms => {
                let trace = trace_of(&events, &config);
                let same = trace == trace_of(&before, &config);
                let (why, holds) = match (shows, &judgement.smallest) {
                    (Shows::Never(why), _) => (why, same),
                    _ if same => {
                        let is_unmarked = options.marker == RunMarker::NotRecorded;
                        let is_marker = mutation == Mutation::Marker;
                        ("it is not recorded", options.bare || (is_unmarked && is_marker))
                    }
                    (_, Some(SmallestWorld::World { graph, marker, .. })) => {
                        let position = Position { graph, marker: *marker, pose: Dart(0) };
                        let holds = position.explains(&trace) && config.search.class.contains(graph);
                        ("it is a walk in another world", holds)
                    }
                    (_, Some(_)) => ("a world was found", false),
                    (_, None) => {
                        ("it is another walk in the known world", options.explains(&place, &trace))
                    }
                };
                prop_assert!(holds, "{:?} conforms: {}", mutation, why);
            }
            Some(_) | None => {}
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
        let starts: Vec<EmbeddedGraph> =
            Enumeration::new(Each::Start, Class::Multigraph, edges).unwrap().graphs().collect();
        let mut world = GraphWorld::new(start.get(&starts), Dart(0));
        let mut kinds = vec![TraceEventKind::Percept(world.sensed())];
        for step in walk {
            let door = Door(step % world.sensed().degree);
            world.traverse(door).unwrap();
            kinds.extend([TraceEventKind::Door(door), TraceEventKind::Percept(world.sensed())]);
        }
        let impossible = |kinds: &[TraceEventKind]| {
            let trace = Trace::new(kinds.to_vec()).unwrap();
            let folded = FoldedTrace::new(&trace, Directional.into(), Class::Multigraph);
            (folded.impossible, trace)
        };
        prop_assert_eq!(impossible(&kinds).0, None);
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
            TraceEventKind::Action(action) => panic!("{action} with a fixed marker"),
        }
        if let (Some((event, _)), trace) = impossible(&kinds) {
            prop_assert!(event >= at);
            assert_impossible(&trace, event, true);
        } else {
            let trace = Trace::new(kinds).unwrap();
            let (graph, marker, pose) = witness(&trace).unwrap().expect("a world explains it");
            let position = Position { graph: &graph, marker, pose };
            prop_assert!(position.explains(&trace));
        }
    }
}

/// A walk of others in building 12, which has 14 edges.
#[test]
fn a_limit_is_not_a_divergence() {
    let events = log(&place_in("building-12"), 1).recorded();
    let with_search = |max_edges, steps| {
        let search = WorldSearch { max_edges, steps, ..without_world().search };
        ConformConfig { search, ..by_anyone() }
    };
    // A complete trail needs no search.
    let whole = judged(&events, &with_search(None, 0));
    assert_eq!((whole.verdict(), whole.determines_world()), (ConformVerdict::Conforms, Some(true)));
    let Some(SmallestWorld::World { graph, limit: None, .. }) = &whole.smallest else { panic!() };
    assert_eq!(graph.edge_count(), 14);
    // Half of the walk is explained by a world that may not be the smallest.
    let half = events.up_to(events.events.len() / 2);
    let half = RunEvents { has_head: false, ..half };
    let few = judged(&half, &with_search(None, 0));
    assert_eq!(few.limits(), [ReachedLimit::SmallerWorld(SearchLimit::Steps)]);
    assert_eq!((few.verdict(), few.determines_world()), (ConformVerdict::Conforms, Some(false)));
    assert_eq!(judged(&half, &by_anyone()).limits(), []);
    // The world has one edge more. No algorithm comes to its end if it may know only one dart.
    let bounded = ConformConfig { dart_bound: 1, ..without_world() };
    let darts = |algorithm| ReachedLimit::Darts { algorithm, event: 0, bound: 1 };
    for (config, limit) in [
        (with_search(Some(13), 100_000), ReachedLimit::World(SearchLimit::Edges)),
        (bounded.clone(), darts(MappingAlgorithm::Algorithm1)),
        (driven(bounded, FOLDING), darts(FOLDING)),
    ] {
        let judgement = judged(&events, &config);
        let found = (judgement.verdict(), &judgement.divergence);
        assert_eq!(found, (ConformVerdict::NotKnown, &None));
        assert_eq!(judgement.limits().last(), Some(&limit));
    }
}

/// The robot leaves by a door and comes back to the marker by another one.
#[test]
fn a_loop_is_a_divergence_in_a_class_without_loops() {
    let marked = |door| {
        TraceEventKind::Percept(Percept { degree: 3, sighting: Sighting::Pointing(Door(door)) })
    };
    let trace = Trace::new([marked(0), TraceEventKind::Door(Door(1)), marked(1)]).unwrap();
    let impossible = |class| FoldedTrace::new(&trace, Directional.into(), class).impossible;
    assert_eq!(impossible(Class::Multigraph), None);
    for class in [Class::Simple, Class::Corridor, Class::Planar] {
        assert_eq!(impossible(class), Some((2, Impossibility::NotSimple { class })));
    }
}

#[test]
fn the_marker_is_honoured_without_a_world() {
    let mut events = good_run();
    // A robot without a marker does not see one.
    let unmarked = ConformConfig { aid: NoMarker.into(), ..by_anyone() };
    let found = divergence(&events, &unmarked);
    assert_eq!((found.event, found.fault), (0, FaultClass::Perception));
    let why = Impossibility::Marker;
    assert!(matches!(found.cause, DivergenceCause::NoWorld { why: found, .. } if found == why));
    // Algorithm 1 needs one.
    let error = |events: &RunEvents, config: ConformConfig| judgement(events, &config).unwrap_err();
    let (algorithm, aid) = (MappingAlgorithm::Algorithm1, NoMarker.name());
    let by_algorithm = driven(unmarked.clone(), algorithm);
    assert_eq!(error(&events, by_algorithm), JudgeError::Algorithm { algorithm, aid });
    // If the marker is not recorded, the log does not show that it was not seen.
    events.arrivals_mut().for_each(|arrival| arrival.sighting = None);
    let expected = JudgeError::Marker(SightingError::NotRecorded);
    assert_eq!(error(&events, without_world()), expected);
    assert_eq!(judged(&events, &unmarked).divergence, None);
}

/// The wheel of Figure 1(b) lies on the torus.
#[test]
fn the_first_event_that_no_planar_world_explains_is_exact() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../worlds/figure-1b.toml");
    let wheel = world_file::read(&std::fs::read(file).unwrap()).unwrap();
    let mut robot = GraphWorld::new(&wheel.graph, wheel.start.unwrap());
    let mut kinds = vec![CheckedKind::from(robot.sensed())];
    let mut listen = |robot: &mut GraphWorld, _: &MapWalk, event: MappingEvent| {
        if let MappingEvent::Moved { door, .. } = event {
            kinds.extend([door.into(), robot.sensed().into()]);
        }
    };
    MappingAlgorithm::Algorithm1.map_world(&mut robot, DARTS, &mut listen).1.unwrap();
    let events = bare_events(kinds);
    let search = WorldSearch { class: Class::Planar, ..without_world().search };
    let planar = ConformConfig { search, ..without_world() };
    let whole = divergence(&events, &planar);
    let class = Impossibility::Class { class: Class::Planar };
    assert!(matches!(&whole.cause, DivergenceCause::NoWorld { why, .. } if *why == class));
    for event in (0..events.events.len()).step_by(2) {
        let found = judged(&events.up_to(event), &planar).divergence;
        let first = (event >= whole.event).then_some(&whole);
        assert_eq!(found.as_ref(), first, "after event {event}");
    }
    assert_eq!(judged(&events, &without_world()).divergence, None);
}

#[test]
fn a_driver_may_turn_back_but_not_find_another_junction_then() {
    let arrival = |degree| bare_arrival(degree, Sighting::Nothing);
    let events = |again| {
        let back = CheckedKind::TurnedBack;
        bare_events([arrival(3), bare_door(1), back, arrival(again), bare_door(2), arrival(2)])
    };
    assert_eq!(judged(&events(3).without_excursions(), &by_anyone()).divergence, None);
    let found = divergence(&events(4).without_excursions(), &by_anyone());
    assert_eq!((found.event, found.fault), (2, FaultClass::Perception));
    assert_eq!(found.cause, DivergenceCause::Return { before: 3, now: 4 });
    // To turn back is a fault of motion if the robot may not.
    let found = divergence(&events(3), &by_anyone());
    assert_eq!((found.event, found.cause), (2, DivergenceCause::TurnedBack));
    // Turning back before a junction that is not recognised is no fault.
    let unclear = CheckedKind::Undecided(UndecidedCause::Unclear);
    let walk = bare_events([arrival(3), bare_door(1), CheckedKind::TurnedBack, unclear]);
    let judgement = judged(&walk.without_excursions(), &by_anyone());
    assert_eq!((judgement.unrecognised, &judgement.divergence), (Some(3), &None));
    assert_eq!(judgement.verdict(), ConformVerdict::NotKnown);
}

/// A robot that left between two doors took none of them, and did not turn back.
#[test]
fn leaving_between_two_doors_is_one_fault_at_the_event_that_records_it() {
    let fork = || bare_arrival(3, Sighting::Nothing);
    let door = |off| CheckedKind::Door { door: Door(1), number: None, off: Some(off) };
    let aside = || CheckedKind::LeftBetweenDoors { off: 1.0 };
    let reported = bare_events([fork(), door(1.0), aside(), fork()]);
    let faults = |events: &RunEvents| {
        events.own_faults().into_iter().map(|(event, _)| event).collect::<Vec<_>>()
    };
    assert_eq!(faults(&reported), [2]);
    assert_eq!(faults(&bare_events([fork(), door(1.0), fork()])), [1]);
    assert!(faults(&bare_events([fork(), door(0.1), fork()])).is_empty());
    assert_eq!(reported.without_excursions().events, reported.events);
}

/// An arrival with two or three doors that sees the marker along one.
fn pointing(degree: u32, door: u32) -> CheckedKind {
    bare_arrival(degree, Sighting::Pointing(Door(door)))
}

#[test]
fn the_door_after_turning_back_is_counted_from_the_first_entry() {
    // From the way back, doors 1 and 2 of the second entry are doors 2 and 0 of the first one; and the marker is
    // along the same door. After two excursions 1 + 1 + 1 doors are all round.
    let excursion = |along| vec![bare_door(1), CheckedKind::TurnedBack, pointing(3, along)];
    let twice = [excursion(2), excursion(1)].concat();
    for (excursions, again, door) in [(excursion(2), 1, 2), (excursion(2), 2, 0), (twice, 1, 0)] {
        let walk = [vec![pointing(3, 0)], excursions, vec![bare_door(again)]].concat();
        let kept = bare_events([pointing(3, 0), bare_door(door)]);
        let expected = RunEvents { may_turn_back: true, ..kept };
        assert_eq!(bare_events(walk).without_excursions(), expected);
    }
}

#[test]
fn a_marker_that_is_not_seen_lies_behind_some_door() {
    let nothing = |degree| bare_arrival(degree, Sighting::Nothing);
    let at = |last: u32, marker: MarkerKind| {
        let walk = [nothing(1), bare_door(0), nothing(last)];
        let judged =
            judged(&bare_events(walk), &ConformConfig { aid: marker.into(), ..by_anyone() });
        judged.divergence.as_ref().map(place_of)
    };
    for marker in [Directional, Undirected] {
        // Two dead ends, and nothing else.
        assert_eq!(at(1, marker), Some((2, "no-world")), "{}", marker.name());
        assert_eq!(at(2, marker), None, "{}", marker.name());
    }
    assert_eq!(at(1, NoMarker), None);
}

#[test]
fn a_door_that_a_junction_does_not_have_diverges_whoever_drives() {
    let nothing = |degree| bare_arrival(degree, Sighting::Nothing);
    let at = |kinds: &[CheckedKind]| {
        let events = bare_events(kinds.to_vec()).without_excursions();
        judged(&events, &by_anyone()).divergence.as_ref().map(place_of)
    };
    for (door, found) in [(1, None), (2, Some((3, "no-world"))), (u32::MAX, Some((3, "no-world")))]
    {
        // After the junction with two doors lies another one, from which the marker may be reached.
        let walk = [nothing(1), bare_door(0), nothing(2), bare_door(door), nothing(2)];
        assert_eq!(at(&walk), found, "door {door}");
    }
    let back = || CheckedKind::TurnedBack;
    for door in [2, u32::MAX] {
        // By a door that is not there, the robot has not turned back.
        let left =
            [pointing(2, 0), bare_door(door), back(), pointing(2, 0), bare_door(0), nothing(1)];
        let later =
            [pointing(2, 0), bare_door(1), back(), pointing(2, 1), bare_door(door), nothing(1)];
        let marker = [pointing(2, door), bare_door(1), back(), pointing(2, door), bare_door(0)];
        for (walk, event) in [(&left[..], 1), (&later, 1), (&marker, 0)] {
            assert_eq!(at(walk), Some((event, "no-world")), "door {door}");
        }
    }
}
