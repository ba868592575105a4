//! Judges the end of a run: by the explorer's map and the record of what was revealed, and nothing else.

use std::{
    ops::ControlFlow,
    sync::atomic::{AtomicU64, Ordering},
};

use super::{LazyWorld, search::LazyRunEnd};
use crate::{
    aid::Aid,
    check::{EnumeratedStart, PartTally, judge::check_moves, judge_map, one_by_one::check_stop},
    embedded_graph::EmbeddedGraph,
    enumerate::Watch,
    folding::MarkerTree,
    isomorphism::Candidate,
    mapping::{Explorer, FACING, Flaw},
    marker::{Directional, Marker},
};

/// Judges one end after the other. Memory is kept.
pub(super) struct LeafJudge<'m> {
    pub(super) tally: PartTally,
    candidate: Candidate,
    /// Measures certificates, if the marker has them.
    certificates: Option<MarkerTree>,
    /// The most moves of any run of the check so far.
    most_moves: &'m AtomicU64,
}

impl<'m> LeafJudge<'m> {
    pub(super) fn new(aid: &impl Aid, most_moves: &'m AtomicU64) -> Self {
        let directional = aid.name() == Marker::name(&Directional);
        let certificates = directional.then(MarkerTree::default);
        let (tally, candidate) = (PartTally::default(), Candidate::default());
        Self { tally, candidate, certificates, most_moves }
    }

    /// Judges each start that agrees with the record. Breaks if the watch stops.
    pub(super) fn judge<E: Explorer>(
        &mut self,
        world: &LazyWorld<E::Aid>,
        explorer: &E,
        end: &LazyRunEnd,
        watch: &dyn Watch,
    ) -> ControlFlow<()> {
        // An explorer that stops early leaves many starts to judge at once.
        let is_decided = world.draft.edges_left() == 0;
        world.draft.for_each_completion(&mut |graph| {
            let judged = match end {
                LazyRunEnd::Failed(flaw) => Err(flaw.clone()),
                LazyRunEnd::Done | LazyRunEnd::Cut => self.judge_run(world, explorer, graph),
            };
            self.count(graph, world.robot().moves, judged.is_ok());
            if is_decided { ControlFlow::Continue(()) } else { check_stop(watch) }
        })
    }

    /// Judges a run in one of these starts, as [`judge_start`](crate::check::judge_start).
    fn judge_run<E: Explorer>(
        &mut self,
        world: &LazyWorld<E::Aid>,
        explorer: &E,
        graph: &EmbeddedGraph,
    ) -> Result<(), Flaw> {
        let map = explorer.explored()?;
        // An explorer that numbers darts as it meets them returns the record itself, dart for dart, and the identity
        // is the bijection.
        let is_record =
            map.facing == FACING && map.pose == world.pose() && map.graph.as_ref() == graph;
        if !is_record {
            judge_map(&map, (graph, FACING), world.pose(), &mut self.candidate)?;
        }
        let bound = explorer.move_bound(graph.edge_count(), graph.vertex_count());
        check_moves(world.robot().moves, bound)
    }

    fn count(&mut self, graph: &EmbeddedGraph, moves: u64, is_right: bool) {
        let tally = &mut self.tally;
        tally.starts += 1;
        let certificates = self.certificates.as_mut();
        let certificate =
            certificates.map(|tree| tree.certificate(graph, graph.vertex(FACING)) as u64);
        tally.count_certificate(certificate);
        if !is_right {
            tally.count_failure(EnumeratedStart::new(graph, FACING));
            return;
        }
        // A start with fewer moves than another one of the check cannot be the worst one.
        let worst = (moves >= self.most_moves.load(Ordering::Relaxed)).then(|| {
            self.most_moves.fetch_max(moves, Ordering::Relaxed);
            (moves, EnumeratedStart::new(graph, FACING))
        });
        tally.mapped += 1;
        tally.count_run((moves, graph.vertex_count()), certificate, worst);
    }
}
