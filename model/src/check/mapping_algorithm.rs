//! The algorithms of this crate, to choose from at run time. Section 2.3.

use super::{
    Algorithm, Algorithm1, AllChoices, CostOrder, EveryWay, Flaw, Folding, MovableMarker, Sweep,
    Tally, check_worlds,
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
    /// The folding explorer with the default choices.
    Folding,
    /// The folding explorer with every way to break its ties.
    FoldingAllChoices(AllChoices<Folding>),
}

impl MappingAlgorithm {
    /// Its name in reports.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Algorithm1 | Self::AllChoices(_) => Algorithm1.name(),
            Self::MovableMarker => MovableMarker.name(),
            Self::Folding | Self::FoldingAllChoices(_) => Folding.name(),
        }
    }

    /// The marker with which it maps.
    #[must_use]
    pub fn marker(&self) -> &'static dyn Marker {
        match self {
            Self::Algorithm1 | Self::AllChoices(_) | Self::Folding | Self::FoldingAllChoices(_) => {
                &Directional
            }
            Self::MovableMarker => &Movable,
        }
    }

    /// The order of its cost.
    #[must_use]
    pub fn order(&self) -> CostOrder {
        match self {
            Self::Algorithm1 | Self::AllChoices(_) => Algorithm1.order(),
            Self::MovableMarker => MovableMarker.order(),
            Self::Folding | Self::FoldingAllChoices(_) => Folding.order(),
        }
    }

    /// Checks every start of a sweep, as [`Sweep::run`].
    #[must_use]
    pub fn sweep(&self, sweep: &Sweep, watch: &dyn Watch) -> Tally {
        match self {
            Self::Algorithm1 => sweep.run(&Algorithm1, watch),
            Self::AllChoices(algorithm) => sweep.run(algorithm, watch),
            Self::MovableMarker => sweep.run(&MovableMarker, watch),
            Self::Folding => sweep.run(&Folding, watch),
            Self::FoldingAllChoices(algorithm) => sweep.run(algorithm, watch),
        }
    }

    /// Checks every start of some worlds, as [`check_worlds`].
    #[must_use]
    pub fn check_worlds(&self, graphs: &[EmbeddedGraph], watch: &dyn Watch) -> Tally {
        match self {
            Self::Algorithm1 => check_worlds(graphs, &Algorithm1, watch),
            Self::AllChoices(algorithm) => check_worlds(graphs, algorithm, watch),
            Self::MovableMarker => check_worlds(graphs, &MovableMarker, watch),
            Self::Folding => check_worlds(graphs, &Folding, watch),
            Self::FoldingAllChoices(algorithm) => check_worlds(graphs, algorithm, watch),
        }
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
        match self {
            Self::AllChoices(algorithm) => algorithm.other_runs(graph, facing, watch),
            Self::FoldingAllChoices(algorithm) => algorithm.other_runs(graph, facing, watch),
            Self::Algorithm1 | Self::MovableMarker | Self::Folding => Ok(None),
        }
    }
}
