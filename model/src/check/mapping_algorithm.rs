//! The algorithms of this crate, to choose from at run time. Section 2.3.

use super::{
    Algorithm, Algorithm1, Algorithm1Explorer, AllChoices, CheckPieces, CostOrder, EveryWay,
    FailedStart, FinishedUnits, Flaw, Folding, FoldingStepExplorer, LazyCheck, LazySweep,
    MovableMarker, MovableMarkerExplorer, PieceCounts, Probe, RunState, Sweep, Tally, check_worlds,
    first_false_step,
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

    /// Checks every start of a lazy sweep, as [`LazySweep::resume`]. `None` with all choices: then runs are not
    /// shared.
    #[must_use]
    pub fn lazy_sweep(
        &self,
        sweep: &LazySweep,
        units: &dyn FinishedUnits,
        watch: &dyn Watch,
    ) -> Option<LazyCheck> {
        match self {
            Self::Algorithm1 => {
                let check = sweep.resume(Algorithm1Explorer::default, units, watch);
                Some(with_false_step(&Algorithm1, check))
            }
            Self::MovableMarker => {
                let check = sweep.resume(MovableMarkerExplorer::default, units, watch);
                Some(with_false_step(&MovableMarker, check))
            }
            Self::Folding => {
                let check = sweep.resume(FoldingStepExplorer::default, units, watch);
                Some(with_false_step(&Folding, check))
            }
            Self::AllChoices(_) | Self::FoldingAllChoices(_) => None,
        }
    }

    /// The number of units of a lazy sweep; `None` with all choices.
    #[must_use]
    pub fn unit_count(&self, sweep: &LazySweep) -> Option<usize> {
        match self {
            Self::Algorithm1 => Some(sweep.unit_count(Algorithm1Explorer::default)),
            Self::MovableMarker => Some(sweep.unit_count(MovableMarkerExplorer::default)),
            Self::Folding => Some(sweep.unit_count(FoldingStepExplorer::default)),
            Self::AllChoices(_) | Self::FoldingAllChoices(_) => None,
        }
    }

    /// The pieces of a lazy sweep, as [`CheckPieces::new`]; `None` with all choices.
    #[must_use]
    pub fn pieces(&self, sweep: &LazySweep, watch: &dyn Watch) -> Option<CheckPieces> {
        match self {
            Self::Algorithm1 => Some(CheckPieces::new(sweep, Algorithm1Explorer::default, watch)),
            Self::MovableMarker => {
                Some(CheckPieces::new(sweep, MovableMarkerExplorer::default, watch))
            }
            Self::Folding => Some(CheckPieces::new(sweep, FoldingStepExplorer::default, watch)),
            Self::AllChoices(_) | Self::FoldingAllChoices(_) => None,
        }
    }

    /// The counts of a piece, as [`CheckPieces::check`]; none with all choices.
    #[must_use]
    pub fn check_piece(&self, of: &CheckPieces, piece: usize, watch: &dyn Watch) -> PieceCounts {
        match self {
            Self::Algorithm1 => of.check(piece, Algorithm1Explorer::default(), watch),
            Self::MovableMarker => of.check(piece, MovableMarkerExplorer::default(), watch),
            Self::Folding => of.check(piece, FoldingStepExplorer::default(), watch),
            Self::AllChoices(_) | Self::FoldingAllChoices(_) => PieceCounts::default(),
        }
    }

    /// The result of a lazy sweep, as [`CheckPieces::finished`]; `None` with all choices.
    #[must_use]
    pub fn finished_pieces(&self, counts: PieceCounts) -> Option<LazyCheck> {
        match self {
            Self::Algorithm1 => {
                let check = CheckPieces::finished(counts, Algorithm1Explorer::default);
                Some(with_false_step(&Algorithm1, check))
            }
            Self::MovableMarker => {
                let check = CheckPieces::finished(counts, MovableMarkerExplorer::default);
                Some(with_false_step(&MovableMarker, check))
            }
            Self::Folding => {
                let check = CheckPieces::finished(counts, FoldingStepExplorer::default);
                Some(with_false_step(&Folding, check))
            }
            Self::AllChoices(_) | Self::FoldingAllChoices(_) => None,
        }
    }

    /// A random probe, as [`LazySweep::probe`]; `None` with all choices.
    #[must_use]
    pub fn probe(&self, sweep: &LazySweep, numbers: Vec<u64>, watch: &dyn Watch) -> Option<Probe> {
        match self {
            Self::Algorithm1 => Some(sweep.probe(Algorithm1Explorer::default(), numbers, watch)),
            Self::MovableMarker => {
                Some(sweep.probe(MovableMarkerExplorer::default(), numbers, watch))
            }
            Self::Folding => Some(sweep.probe(FoldingStepExplorer::default(), numbers, watch)),
            Self::AllChoices(_) | Self::FoldingAllChoices(_) => None,
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

/// Adds the first wrong addition to the map to the first failure.
fn with_false_step<A: Algorithm>(algorithm: &A, mut check: LazyCheck) -> LazyCheck {
    if let Some(FailedStart { graph, facing, false_step, .. }) = &mut check.tally.failure {
        // A wrong map can have more darts than the world.
        let mut state = A::State::new(2 * graph.dart_count());
        *false_step = first_false_step(algorithm, graph, *facing, &mut state);
    }
    check
}
