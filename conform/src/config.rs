//! What a run is checked against.

use toposlam_model::{
    aid::AidKind,
    folding::WorldSearch,
    mapping::{MappingAlgorithm, MappingMethod},
    trace::{AlgorithmMatch, Trace, match_algorithm, match_audited, match_recovering},
};
use toposlam_robot::{budget::RunBudget, run_settings::RecordedSettings};

use super::{budget_check::within_budget, events::RunEvents, known_world::KnownWorld};

#[derive(Clone, Debug)]
pub struct ConformConfig {
    pub world: Option<KnownWorld>,
    pub aid: AidKind,
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

impl ConformConfig {
    /// How far the algorithm follows the trace of these events, if one drives.
    pub(super) fn follow(&self, trace: &Trace, events: &RunEvents) -> Option<AlgorithmMatch> {
        let RunDriver::Method(method) = self.driver else { return None };
        let (claim, bound) = (events.claim(), self.dart_bound);
        let followed = match method {
            MappingMethod::By { algorithm, audits: 0 } => {
                match_algorithm(algorithm, trace, claim, bound)
            }
            MappingMethod::By { algorithm, audits } => {
                match_audited(algorithm, audits, trace, claim, bound)
            }
            MappingMethod::Recovering(config) => {
                match_recovering(config, trace, &events.recorded_visits(trace), bound)
            }
        };
        Some(within_budget(followed, trace, events, self.budget))
    }
}

impl From<MappingAlgorithm> for RunDriver {
    fn from(algorithm: MappingAlgorithm) -> Self {
        Self::Method(algorithm.into())
    }
}

/// The doors of a robot that went on from earlier runs depend on logs that are not known here.
impl From<RecordedSettings> for RunDriver {
    fn from(recorded: RecordedSettings) -> Self {
        if recorded.is_resumed { Self::Anyone } else { Self::Method(recorded.method) }
    }
}

impl RunDriver {
    pub(crate) fn algorithm(self) -> Option<MappingAlgorithm> {
        match self {
            Self::Method(method) => Some(method.algorithm()),
            Self::Anyone => None,
        }
    }
}
