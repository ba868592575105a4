//! Runs of a robot that maps random buildings by a laser scanner, and the judgement of their own logs by `conform --events
//! laser`: it never accuses a robot that was simulated.

use thiserror::Error;
use toposlam_conform::{
    CheckError, ConformVerdict, DoorChooser, Evidence, LogCheck, LogSource, Quirks, RobotStart,
};
use toposlam_logs::{
    error::LogError,
    messages,
    reader::Log,
    record::{Event, EventKind, RunObserver},
    topic_map::TopicMap,
    writer::LogWriteError,
};
use toposlam_model::{
    enumerate::{Class, Watch},
    folding::WorldSearch,
    format::{document::DocumentError, named_world::NamedWorld},
    mapping::{MappingMethod, RecoveryConfig},
    marker::NoMarker,
};
use toposlam_vision::laser::params::LaserParams;

use super::{corridor_world::BuildingKind, judged_walk::WalkSampler};
use crate::{NamedScanner, SCANNERS};

/// A scanner with a longer range sees arms as far as that makes them certain, in metres. A robot with another one drives
/// into each arm, so its visits take longer.
const FAR: f64 = 24.5;
/// The number of arrivals until a run is stopped, with a scanner that sees far and with another one.
const MOST: [usize; 2] = [12, 6];
/// With fewer visits a log says nothing.
const FEWEST: usize = 4;
/// The kinds of buildings, in turn.
const KINDS: [BuildingKind; 3] = [BuildingKind::Mixed, BuildingKind::Long, BuildingKind::Diagonal];
/// The bound of the search for a world, in steps.
const STEPS: u64 = 100_000;

/// The judgement of a run's own log.
#[derive(Clone, Copy, Debug)]
pub struct OwnJudgement {
    pub number: u64,
    pub scanner: &'static str,
    pub buildings: BuildingKind,
    /// Without a world and in its own one; `None` if the scans show no junction that was visited.
    pub verdicts: [Option<ConformVerdict>; 2],
    /// The number of visits that the scans show.
    pub visits: usize,
    /// The number of times that the robot derived where it is.
    pub arrivals: usize,
    sees_far: bool,
}

#[derive(Debug, Error)]
pub enum LogJudgingError {
    #[error("run {0} has no building")]
    NoBuilding(u64),
    #[error(transparent)]
    Write(#[from] LogWriteError),
    #[error(transparent)]
    Read(#[from] LogError),
    #[error(transparent)]
    Topics(#[from] DocumentError),
    #[error(transparent)]
    Check(#[from] CheckError),
}

/// Counts the arrivals of a robot, and stops it after some of them.
struct Arrivals<'a> {
    count: usize,
    most: usize,
    watch: &'a dyn Watch,
}

impl RunObserver for Arrivals<'_> {
    fn event(&mut self, event: &Event) {
        self.count += usize::from(matches!(event.kind, EventKind::Arrival(_)));
    }

    fn stop(&self) -> bool {
        self.count >= self.most || self.watch.stop()
    }
}

impl OwnJudgement {
    /// Makes the run with this number among those of a seed, and judges its log; `None` if the watch stops. Scanners and
    /// kinds of buildings are taken in turn.
    ///
    /// # Errors
    /// Returns an error if there is no such building, or the log cannot be judged.
    pub fn of_run(
        seed: u64,
        number: u64,
        watch: &dyn Watch,
    ) -> Result<Option<Self>, LogJudgingError> {
        let NamedScanner { name: scanner, params, .. } =
            &SCANNERS[number as usize % SCANNERS.len()];
        let buildings = KINDS[number as usize / SCANNERS.len() % KINDS.len()];
        let sampler = WalkSampler {
            seed,
            buildings,
            places: 12,
            drift: 1_f64.to_radians() / 10.0,
            scanner: Some(*params),
            sensing: LaserParams::default(),
        };
        let method = MappingMethod::Recovering(RecoveryConfig::default());
        let world = sampler.run_world(number);
        let (graph, facing) = world.ok_or(LogJudgingError::NoBuilding(number))?;
        let head = messages::Run {
            marker: "directional".to_owned(),
            algorithm: WalkSampler::run_settings(&graph, method).recorded().to_string(),
            ..messages::Run::default()
        };
        let sees_far = params.range >= FAR;
        let mut arrivals = Arrivals { count: 0, most: MOST[usize::from(!sees_far)], watch };
        let (_, log) = sampler.logged_run(number, method, &head, &mut arrivals)?;
        let log = Log::of_bytes(log)?;
        let world = NamedWorld::numbered("building", "", graph, Some(facing));
        let mut verdicts = [None; 2];
        let mut visits = 0;
        for (verdict, world) in verdicts.iter_mut().zip([None, Some(&world)]) {
            if watch.stop() {
                return Ok(None);
            }
            let topics = TopicMap::from_log(&log)?;
            let source = LogSource { log: &log, topics: &topics, head: Some(&head), sensor: None };
            let quirks = Quirks::default();
            let check = LogCheck {
                evidence: Evidence::Laser,
                laser: LaserParams::default(),
                world,
                start: RobotStart::Anywhere,
                aid: Some(NoMarker.into()),
                assumes_marker: false,
                doors: DoorChooser::Anyone,
                search: WorldSearch { class: Class::Multigraph, max_edges: None, steps: STEPS },
                max_darts: None,
                quirks: &quirks,
            };
            match check.run(&source, &(), || {}) {
                Ok(checked) => {
                    visits = checked.extracted.junctions.len();
                    *verdict = Some(checked.judgement.verdict());
                }
                Err(CheckError::NoVisit { .. }) => {}
                Err(error) => return Err(error.into()),
            }
        }
        let arrivals = arrivals.count;
        Ok(Some(Self { number, scanner, buildings, verdicts, visits, arrivals, sees_far }))
    }

    /// Whether the log's robot is accused.
    pub fn diverges(&self) -> bool {
        self.verdicts.contains(&Some(ConformVerdict::Diverged))
    }

    /// Whether the run is too short to say something. What a scanner that does not see far shows of arms is less than what
    /// the robot derives.
    pub fn says_nothing(&self) -> bool {
        (if self.sees_far { self.visits } else { self.arrivals }) < FEWEST
    }
}
