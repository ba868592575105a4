//! Benchmark of `conform` on long logs, after their events are read: `cargo bench -p toposlam-conform
//! --bench conform`. Runs in the plans with 12, 50, 100 and 200 junctions have 141, 5,763, 34,393
//! and 95,411 events.

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use toposlam_conform::{
    CheckedEvent, CheckedKind, ConformConfig, EventSource, Evidence, ExtractConfig, KnownWorld,
    Quirks, RunDriver, RunEvents, extract, judge,
};
use toposlam_logs::{
    action_message, arrival_message, door_message,
    messages::{self, ProjectMessage, Stamp},
    reader::Log,
    record::Arrival,
    topic_map::TopicMap,
    writer::LogWriter,
};
use toposlam_model::{
    aid::AidKind,
    embedded_graph::Dart,
    enumerate::Class,
    floor_plan::FloorPlan,
    folding::{WorldSearch, fold, smallest_world},
    mapping::{Algorithm1Run, MapWalk, MappingAlgorithm, MappingEvent, Observed, explore},
    marker::Directional,
    percept::Percept,
    trace::{Trace, TraceEvent, TraceEventKind, anywhere},
    world::GraphWorld,
};
use toposlam_robot::budget::RunBudget;
use toposlam_simulator::random_plan::random_plan_with;

fn main() {
    divan::main();
}

/// A run of Algorithm 1 in a plan with this number of junctions.
fn trace(plan: &FloorPlan) -> Trace {
    let graph = plan.graph();
    let mut events = vec![TraceEventKind::Percept(GraphWorld::new(graph, Dart(0)).sensed())];
    let mut listen = |_: &mut _, _: &MapWalk, event: MappingEvent| {
        if let MappingEvent::Moved { door, percept } = event {
            events.extend([TraceEventKind::Door(door), TraceEventKind::Percept(percept)]);
        }
    };
    let mut exploration = Algorithm1Run::new(graph.dart_count());
    let mut world = GraphWorld::new(graph, Dart(0));
    explore(&mut exploration, &mut Observed::new(&mut world, &mut listen)).unwrap();
    Trace::new(events).unwrap()
}

/// A run of Algorithm 1 in a known world, from any start.
fn in_known_world(plan: &FloorPlan) -> ConformConfig {
    let graph = plan.graph().clone();
    let states = anywhere(&graph, &AidKind::from(Directional));
    ConformConfig {
        world: Some(KnownWorld { graph, states }),
        aid: Directional.into(),
        driver: RunDriver::from(MappingAlgorithm::Algorithm1),
        budget: RunBudget::default(),
        search: SEARCH,
        dart_bound: 1000,
    }
}

/// The default limits.
const SEARCH: WorldSearch =
    WorldSearch { class: Class::Multigraph, max_edges: None, steps: WorldSearch::STEPS };

/// Follows a run in a known world, with and without a known start.
#[divan::bench(args = [12, 50, 100, 200], sample_count = 5)]
fn a_run(bencher: divan::Bencher, junctions: usize) {
    let plan = random_plan_with(1, junctions).unwrap();
    let trace = trace(&plan);
    let event = |(_, event): (_, TraceEvent)| CheckedEvent {
        source: EventSource { time: event.id as u64, ..EventSource::default() },
        kind: match event.kind {
            TraceEventKind::Percept(percept) => percept.into(),
            TraceEventKind::Door(door) => door.into(),
            TraceEventKind::Action(action) => CheckedKind::Action { number: None, action },
        },
    };
    let events = RunEvents { events: trace.events().map(event).collect(), ..RunEvents::default() };
    let config = in_known_world(&plan);
    bencher.bench_local(|| judge(events.clone(), &config, &Quirks::default(), &()));
}

/// Opens, reads and follows a log of 10,000 events in memory.
#[divan::bench(sample_count = 10)]
fn ten_thousand_events(bencher: divan::Bencher) {
    let plan = random_plan_with(1, 100).unwrap();
    let trace = trace(&plan).up_to(9_999);
    let mut log = LogWriter::new(Vec::new()).unwrap();
    for (_, event) in trace.events() {
        let (time, moves) = (event.id as u64 * 1_000_000_000, event.id as u32 / 2);
        let stamp = Stamp::from_nanoseconds(time);
        match event.kind {
            TraceEventKind::Percept(Percept { degree, sighting }) => {
                let (number, sighting) = (Some(moves), Some(sighting));
                let arrival = Arrival { number, degree, sighting, shape: None, entry: None };
                let message = arrival_message(stamp, &arrival);
                log.write(messages::Percept::TOPIC, time, &message).unwrap();
            }
            TraceEventKind::Door(door) => {
                let message = door_message(stamp, Some(moves + 1), door);
                log.write(messages::Door::TOPIC, time, &message).unwrap();
            }
            TraceEventKind::Action(action) => {
                let message = action_message(stamp, Some(moves), action);
                log.write(messages::Action::TOPIC, time, &message).unwrap();
            }
        }
    }
    let bytes = log.finish().unwrap();
    let config = in_known_world(&plan);
    bencher.bench_local(|| {
        let log = Log::of_bytes(bytes.clone()).unwrap();
        let topics = TopicMap::unambiguous(&log);
        let extraction = ExtractConfig { marked: true, ..ExtractConfig::new(Evidence::Recorded) };
        let extracted = extract(&log, &topics, &extraction, &()).unwrap();
        let judgement = judge(extracted.events, &config, &Quirks::default(), &()).unwrap();
        assert!(judgement.divergence.is_none() && judgement.trace.len() == 10_000);
    });
}

/// Searches the smallest world for half of a run, with the default limits.
#[divan::bench(args = [12, 50, 100], sample_count = 3)]
fn the_smallest_world(bencher: divan::Bencher, junctions: usize) {
    let plan = random_plan_with(1, junctions).unwrap();
    let trace = trace(&plan);
    let half = trace.up_to(trace.len() / 2);
    let trail = fold(half.percepts(), half.doors()).unwrap();
    bencher.bench_local(|| smallest_world(&trail, SEARCH, &()));
}
