//! What a run is checked against.

use toposlam_model::{
    folding::WorldSearch,
    mapping::DirectionalAlgorithm,
    marker::Marker,
    trace::{AlgorithmMatch, Trace, TraceClaim, match_algorithm, match_audited},
};

use super::known_world::KnownWorld;

/// What a run is checked against.
#[derive(Clone, Debug)]
pub struct ConformConfig<'w> {
    /// The world, if it is known.
    pub world: Option<KnownWorld<'w>>,
    /// The kind of marker.
    pub marker: &'static dyn Marker,
    /// What chose the doors.
    pub driver: RunDriver,
    /// The worlds to search if none is known.
    pub search: WorldSearch,
    /// The largest number of darts that the algorithm may know.
    pub dart_bound: usize,
}

/// What chooses the doors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    /// Anything, in any way.
    Anyone,
}

impl RunDriver {
    /// The algorithm, if it is one.
    #[must_use]
    pub fn algorithm(self) -> Option<DirectionalAlgorithm> {
        match self {
            Self::Algorithm(algorithm) | Self::Audited { algorithm, .. } => Some(algorithm),
            Self::Anyone => None,
        }
    }

    /// How far it follows a trace, if it is an algorithm.
    pub(super) fn follow(
        self,
        trace: &Trace,
        claim: TraceClaim,
        bound: usize,
    ) -> Option<AlgorithmMatch> {
        match self {
            Self::Algorithm(algorithm) => Some(match_algorithm(algorithm, trace, claim, bound)),
            Self::Audited { algorithm, audits } => {
                Some(match_audited(algorithm, audits, trace, claim, bound))
            }
            Self::Anyone => None,
        }
    }
}
