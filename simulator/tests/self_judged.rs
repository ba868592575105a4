//! Runs of a robot that maps random buildings by a laser scanner, and the judgement of their own logs by `conform --events
//! laser`: it never accuses a robot that was simulated.

use std::env;

use toposlam_conform::{
    CheckError, CheckedLog, ConformVerdict, DoorChooser, Evidence, LogCheck, LogSource, Quirks,
    RobotStart,
};
use toposlam_logs::{
    messages,
    reader::Log,
    record::{Event, EventKind, RunObserver},
    topic_map::TopicMap,
};
use toposlam_model::{
    enumerate::Class,
    folding::WorldSearch,
    format::named_world::NamedWorld,
    mapping::{MappingMethod, RecoveryConfig},
    marker::NoMarker,
};
use toposlam_simulator::{
    SCANNERS,
    evaluation::{
        laser::{corridor_world::BuildingKind, judged_walk::WalkSampler},
        sampling::sample,
    },
};
use toposlam_vision::laser::params::LaserParams;

/// Counts the arrivals of a robot, and stops it after some of them.
#[derive(Default)]
struct Arrivals {
    count: usize,
    most: usize,
}

impl RunObserver for Arrivals {
    fn event(&mut self, event: &Event) {
        self.count += usize::from(matches!(event.kind, EventKind::Arrival(_)));
    }

    fn stop(&self) -> bool {
        self.count >= self.most
    }
}

/// A scanner with a longer range sees arms as far as that makes them certain, in metres. A robot with another one drives
/// into each arm, so its visits take longer.
const FAR: f64 = 24.5;
/// The number of arrivals until a run is stopped, with a scanner that sees far and with another one.
const MOST: [usize; 2] = [12, 6];

/// The judgement of a run's own log.
#[derive(Debug)]
struct SelfJudged {
    /// Without a world and in its own one; `None` if the scans show no junction that was visited.
    verdicts: [Option<ConformVerdict>; 2],
    /// The number of visits that the scans show.
    visits: usize,
    /// The number of times that the robot derived where it is.
    arrivals: usize,
}

fn judged(number: u64) -> SelfJudged {
    let scanner = &SCANNERS[number as usize % SCANNERS.len()];
    let kinds = [BuildingKind::Mixed, BuildingKind::Long, BuildingKind::Diagonal];
    let sampler = WalkSampler {
        seed: 3,
        buildings: kinds[number as usize / SCANNERS.len() % kinds.len()],
        places: 12,
        drift: 1_f64.to_radians() / 10.0,
        scanner: Some(scanner.params),
        sensing: LaserParams::default(),
    };
    let method = MappingMethod::Recovering(RecoveryConfig::default());
    let (graph, facing) = sampler.run_world(number).unwrap();
    let head = messages::Run {
        marker: "directional".to_owned(),
        algorithm: WalkSampler::run_settings(&graph, method).recorded().to_string(),
        ..messages::Run::default()
    };
    let most = if scanner.params.range < FAR { MOST[1] } else { MOST[0] };
    let mut arrivals = Arrivals { most, ..Arrivals::default() };
    let (_, log) = sampler.logged_run(number, method, &head, &mut arrivals).unwrap();
    let log = Log::of_bytes(log).unwrap();
    let world = NamedWorld::numbered("building", "", graph, Some(facing));
    let checked = [None, Some(&world)].map(|world| check(&log, &head, world));
    let visits = checked[0].as_ref().map_or(0, |checked| checked.extracted.junctions.len());
    let verdicts = checked.map(|checked| checked.map(|checked| checked.judgement.verdict()));
    SelfJudged { verdicts, visits, arrivals: arrivals.count }
}

/// The judgement of a log; `None` if no junction is visited in its scans.
fn check(log: &Log, head: &messages::Run, world: Option<&NamedWorld>) -> Option<CheckedLog> {
    let topics = TopicMap::from_log(log).unwrap();
    let source = LogSource { log, topics: &topics, head: Some(head), sensor: None };
    let check = LogCheck {
        evidence: Evidence::Laser,
        laser: LaserParams::default(),
        world,
        start: RobotStart::Anywhere,
        marker: Some(&NoMarker),
        assumes_marker: false,
        doors: DoorChooser::Anyone,
        search: WorldSearch { class: Class::Multigraph, max_edges: None, steps: 100_000 },
        max_darts: None,
        quirks: &Quirks::default(),
    };
    match check.run(&source, &(), || {}) {
        Err(CheckError::NoVisit { .. }) => None,
        checked => Some(checked.unwrap()),
    }
}

/// `.ci/run --all` sets the number of runs.
#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn the_log_of_a_simulated_run_never_diverges() {
    let runs = env::var("TOPOSLAM_SELF_JUDGED").map_or(16, |runs| runs.parse().unwrap());
    let judged = sample(0..runs, &(), |number| Some(judged(number)));
    assert_eq!(judged.len() as u64, runs);
    let mut wrong = Vec::new();
    for (run, scanner) in judged.into_iter().zip(SCANNERS.iter().cycle()) {
        eprintln!("{} {run:?}", scanner.name);
        let is_accused = run.verdicts.contains(&Some(ConformVerdict::Diverged));
        // What a scanner that does not see far shows of arms is less than what the robot derives.
        let visits = if scanner.params.range < FAR { run.arrivals } else { run.visits };
        if is_accused || visits < 4 {
            wrong.push((scanner.name, run));
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}
