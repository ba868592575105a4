//! Checks of an algorithm that is chosen at run time.
//!
//! These methods are compiled in this crate, and so as fast as this crate, however the caller is compiled.

use std::borrow::Cow;

use super::{
    Check, CheckPieces, EveryWay, FinishedUnits, PartTally, Probe, RunChoices, SearchMemory,
    SharedPrefixCheck, Tally, check_worlds, judge::check_moves, judge_map,
};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Watch,
    isomorphism::{Bijection, Candidate},
    mapping::{ExploredMap, FACING, Flaw, MapWalk, MappingAlgorithm, with_explorer},
};

impl MappingAlgorithm {
    /// Judges a run that has ended, as [`judge`](super::judge): its map, the robot's `pose` in it, which is `truly` the
    /// one in the world, and the moves of its walk.
    ///
    /// # Errors
    /// Returns the first [`Flaw`].
    pub fn judge<'c>(
        self,
        (walk, pose): (&MapWalk, Dart),
        (graph, facing): (&EmbeddedGraph, Dart),
        truly: Dart,
        candidate: &'c mut Candidate,
    ) -> Result<&'c Bijection, Flaw> {
        let unexplored = walk.map().unexplored_count();
        let map = walk.map().complete().ok_or(Flaw::Unfinished { unexplored })?;
        let map = ExploredMap { graph: Cow::Borrowed(map), facing: FACING, pose };
        let bijection = judge_map(&map, (graph, facing), truly, candidate)?;
        check_moves(walk.moves(), self.move_bound(graph.edge_count(), graph.vertex_count()))?;
        Ok(bijection)
    }

    pub fn sweep(self, sweep: &Check, choices: RunChoices, watch: &dyn Watch) -> Tally {
        with_explorer!(self, new => sweep.run(new, choices, watch))
    }

    pub fn lazy_sweep(
        self,
        sweep: &SharedPrefixCheck,
        units: &dyn FinishedUnits,
        watch: &dyn Watch,
    ) -> Tally {
        with_explorer!(self, new => sweep.resume(new, units, watch))
    }

    pub fn pieces(self, sweep: &SharedPrefixCheck, watch: &dyn Watch) -> CheckPieces {
        with_explorer!(self, new => CheckPieces::new(sweep, new, watch))
    }

    pub fn check_piece(self, of: &CheckPieces, piece: usize, watch: &dyn Watch) -> PartTally {
        with_explorer!(self, new => of.check(piece, new(), watch))
    }

    pub fn finished_pieces(self, counts: PartTally) -> Tally {
        with_explorer!(self, new => CheckPieces::finished(counts, new))
    }

    pub fn probe(self, sweep: &SharedPrefixCheck, numbers: Vec<u64>, watch: &dyn Watch) -> Probe {
        with_explorer!(self, new => sweep.probe(new(), numbers, watch))
    }

    pub fn check_worlds(
        self,
        worlds: &[(EmbeddedGraph, Option<Dart>)],
        choices: RunChoices,
        watch: &dyn Watch,
    ) -> Tally {
        with_explorer!(self, new => check_worlds(worlds, new, choices, watch))
    }

    /// Makes and judges the runs with other than the default choices, as [`RunChoices::others`].
    ///
    /// # Errors
    /// Returns the first [`Flaw`].
    pub fn other_runs(
        self,
        choices: RunChoices,
        (graph, facing): (&EmbeddedGraph, Dart),
        watch: &dyn Watch,
    ) -> Result<Option<EveryWay>, Flaw> {
        with_explorer!(self, new => choices.others(new, (graph, facing), &mut SearchMemory::default(), watch))
    }
}
