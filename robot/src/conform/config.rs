//! What a run is checked against.

use toposlam_model::{
    folding::WorldSearch,
    mapping::{DirectionalAlgorithm, MappingMethod, RecoveryConfig},
    marker::Marker,
    trace::{AlgorithmMatch, Trace, match_algorithm, match_audited, match_recovering},
};

use super::{budget_check::within_budget, events::RunEvents, known_world::KnownWorld};
use crate::budget::RunBudget;

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
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RunDriver {
    /// An algorithm; Algorithm 1 with any choices.
    Algorithm(DirectionalAlgorithm),
    /// An algorithm with the default choices, and then audits of its map.
    Audited {
        /// The algorithm.
        algorithm: DirectionalAlgorithm,
        /// The number of audits.
        audits: u32,
    },
    /// The folding explorer with audits and recovery.
    Recovering(RecoveryConfig),
    /// Anything, in any way.
    Anyone,
}

impl ConformConfig<'_> {
    /// How far the algorithm follows the trace of these events, if one drives.
    pub(super) fn follow(&self, trace: &Trace, events: &RunEvents) -> Option<AlgorithmMatch> {
        let followed = self.driver.follow(trace, events, self.dart_bound)?;
        Some(within_budget(followed, trace, events, self.budget))
    }
}

impl From<MappingMethod> for RunDriver {
    fn from(method: MappingMethod) -> Self {
        match method {
            MappingMethod::By { algorithm, audits: 0 } => Self::Algorithm(algorithm),
            MappingMethod::By { algorithm, audits } => Self::Audited { algorithm, audits },
            MappingMethod::Recovering(config) => Self::Recovering(config),
        }
    }
}

impl RunDriver {
    /// The algorithm, if it is one.
    #[must_use]
    pub fn algorithm(self) -> Option<DirectionalAlgorithm> {
        match self {
            Self::Algorithm(algorithm) | Self::Audited { algorithm, .. } => Some(algorithm),
            Self::Recovering(_) => Some(DirectionalAlgorithm::Folding),
            Self::Anyone => None,
        }
    }

    /// How far it follows the trace of these events, if it is an algorithm.
    fn follow(self, trace: &Trace, events: &RunEvents, bound: usize) -> Option<AlgorithmMatch> {
        let claim = events.claim();
        match self {
            Self::Algorithm(algorithm) => Some(match_algorithm(algorithm, trace, claim, bound)),
            Self::Audited { algorithm, audits } => {
                Some(match_audited(algorithm, audits, trace, claim, bound))
            }
            Self::Recovering(config) => {
                let visits = events.recorded_visits(trace);
                Some(match_recovering(config, trace, &visits, bound))
            }
            Self::Anyone => None,
        }
    }
}
