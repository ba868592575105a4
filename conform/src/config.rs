//! What a run is checked against.

use toposlam_model::{
    folding::WorldSearch,
    mapping::{MappingAlgorithm, MappingMethod},
    marker::Marker,
    trace::{AlgorithmMatch, Trace, match_algorithm, match_audited, match_recovering},
};
use toposlam_robot::{budget::RunBudget, run_settings::RecordedSettings};

use super::{budget_check::within_budget, events::RunEvents, known_world::KnownWorld};

/// What a run is checked against.
#[derive(Clone, Debug)]
pub struct ConformConfig<'w> {
    /// The world, if it is known.
    pub world: Option<KnownWorld<'w>>,
    /// The kind of marker.
    pub marker: &'static dyn Marker,
    /// What chose the doors.
    pub driver: RunDriver,
    /// What the robot might spend.
    pub budget: RunBudget,
    /// The worlds to search if none is known.
    pub search: WorldSearch,
    /// The largest number of darts that the algorithm may know.
    pub dart_bound: usize,
}

/// What chooses the doors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum RunDriver {
    /// A robot that maps; Algorithm 1 with any choices if no audit follows, and otherwise with the default ones.
    Method(MappingMethod),
    /// Anything, in any way.
    #[default]
    Anyone,
}

impl ConformConfig<'_> {
    /// How far the algorithm follows the trace of these events, if one drives.
    pub(super) fn follow(&self, trace: &Trace, events: &RunEvents) -> Option<AlgorithmMatch> {
        let followed = self.driver.follow(trace, events, self.dart_bound)?;
        Some(within_budget(followed, trace, events, self.budget))
    }
}

impl From<MappingAlgorithm> for RunDriver {
    fn from(algorithm: MappingAlgorithm) -> Self {
        Self::Method(algorithm.into())
    }
}

/// The algorithm that the doors of a log are compared with. The doors of a robot that went on from earlier runs
/// depend on logs that are not known here.
impl From<RecordedSettings> for RunDriver {
    fn from(recorded: RecordedSettings) -> Self {
        if recorded.is_resumed { Self::Anyone } else { Self::Method(recorded.method) }
    }
}

impl RunDriver {
    /// The algorithm, if it is one.
    #[must_use]
    pub fn algorithm(self) -> Option<MappingAlgorithm> {
        match self {
            Self::Method(method) => Some(method.algorithm()),
            Self::Anyone => None,
        }
    }

    /// How far it follows the trace of these events, if it is an algorithm.
    fn follow(self, trace: &Trace, events: &RunEvents, bound: usize) -> Option<AlgorithmMatch> {
        let claim = events.claim();
        let Self::Method(method) = self else { return None };
        Some(match method {
            MappingMethod::By { algorithm, audits: 0 } => {
                match_algorithm(algorithm, trace, claim, bound)
            }
            MappingMethod::By { algorithm, audits } => {
                match_audited(algorithm, audits, trace, claim, bound)
            }
            MappingMethod::Recovering(config) => {
                match_recovering(config, trace, &events.recorded_visits(trace), bound)
            }
        })
    }
}
