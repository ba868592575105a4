//! The algorithms of this crate, to choose from at run time. Section 2.3.

use super::{
    Algorithm, Algorithm1, AllChoices, CostOrder, EveryWay, Flaw, MovableMarker, Sweep, Tally,
    check_worlds,
};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Watch,
    marker::{Directional, Marker, Movable},
};

/// An algorithm, and whether it runs with all choices.
///
/// Its methods are compiled in this crate, and so as fast as this crate, however the caller is
/// compiled.
#[derive(Clone, Copy, Debug)]
pub enum MappingAlgorithm {
    /// Algorithm 1 with the default choices.
    Algorithm1,
    /// Algorithm 1 with all choices.
    AllChoices(AllChoices<Algorithm1>),
    /// The movable marker algorithm with the default choices.
    MovableMarker,
}

/// Evaluates an expression with the algorithm that was chosen.
macro_rules! with_algorithm {
    ($choice:expr, $algorithm:ident => $value:expr) => {
        match $choice {
            MappingAlgorithm::Algorithm1 => {
                let $algorithm = &Algorithm1;
                $value
            }
            MappingAlgorithm::AllChoices($algorithm) => $value,
            MappingAlgorithm::MovableMarker => {
                let $algorithm = &MovableMarker;
                $value
            }
        }
    };
}

impl MappingAlgorithm {
    /// Its name in reports.
    #[must_use]
    pub fn name(&self) -> &'static str {
        with_algorithm!(self, algorithm => algorithm.name())
    }

    /// The marker with which it maps.
    #[must_use]
    pub fn marker(&self) -> &'static dyn Marker {
        match self {
            Self::Algorithm1 | Self::AllChoices(_) => &Directional,
            Self::MovableMarker => &Movable,
        }
    }

    /// The order of its cost.
    #[must_use]
    pub fn order(&self) -> CostOrder {
        with_algorithm!(self, algorithm => algorithm.order())
    }

    /// Checks every start of a sweep, as [`Sweep::run`].
    #[must_use]
    pub fn sweep(&self, sweep: &Sweep, watch: &dyn Watch) -> Tally {
        with_algorithm!(self, algorithm => sweep.run(algorithm, watch))
    }

    /// Checks every start of some worlds, as [`check_worlds`].
    #[must_use]
    pub fn check_worlds(&self, graphs: &[EmbeddedGraph], watch: &dyn Watch) -> Tally {
        with_algorithm!(self, algorithm => check_worlds(graphs, algorithm, watch))
    }

    /// Makes and judges the runs with other than the default choices, as [`Algorithm::other_runs`].
    ///
    /// # Errors
    /// Returns the first [`Flaw`].
    pub fn other_runs(
        &self,
        graph: &EmbeddedGraph,
        facing: Dart,
        watch: &dyn Watch,
    ) -> Result<Option<EveryWay>, Flaw> {
        with_algorithm!(self, algorithm => algorithm.other_runs(graph, facing, watch))
    }
}
