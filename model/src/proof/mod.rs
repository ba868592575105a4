//! Proofs of verdicts: what is claimed, and the steps that show it, in the text format of
//! `docs/proofs-of-verdicts.md`. A checker that is proved in Coq confirms them. Beyond the paper.

mod claim;
mod folded_walk;
mod impossible_visits;
mod run;
mod text;
mod walk;

pub use claim::{Claim, NotProved, WalkPair, unexplained};
pub use folded_walk::{FoldedWalk, Passage, UnionStep, WalkContradiction, WalkEnd, fold_walk};
pub use impossible_visits::ChoiceLine;
pub use run::PerceivedRun;
pub use walk::{PerceivedWalk, WalkRecorder};

use impossible_visits::impossible_visits;

use crate::{
    aid::State,
    embedded_graph::{Dart, EmbeddedGraph},
    folding::ClosedTrail,
    marker::{Directional, MarkerKind, NoMarker},
    visits::{VisitSet, choice_in_world},
};

/// Claims about the same worlds and the same walk, each with its steps. It is written by its
/// [`Display`](std::fmt::Display).
#[derive(Clone, Debug)]
pub struct Proof<'g> {
    /// At most two worlds, each with the dart by which the marker was placed.
    pub worlds: Vec<(&'g EmbeddedGraph, Dart)>,
    pub marker: MarkerKind,
    pub seen: Option<Seen>,
    pub claims: Vec<Claim>,
}

/// What a robot saw on its way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Seen {
    Walk(PerceivedWalk),
    Visits(Vec<VisitSet>),
    /// With a marker that it carries, which takes the place of the proof's marker.
    Run(PerceivedRun),
}

impl<'g> Proof<'g> {
    /// A claim about two embedded graphs, whose markers do not matter.
    pub fn of_graphs(graphs: [&'g EmbeddedGraph; 2], claim: Claim) -> Self {
        let worlds = graphs.map(|graph| (graph, Dart(0))).to_vec();
        Self { worlds, marker: NoMarker, seen: None, claims: vec![claim] }
    }

    /// That this is the map of the only world that gives a walk. The robot began at the marker, with the pose of the facing
    /// dart.
    ///
    /// # Errors
    /// Returns an error if the walk does not determine its world.
    pub fn of_map(
        map: &'g EmbeddedGraph,
        facing: Dart,
        walk: PerceivedWalk,
    ) -> Result<Self, NotProved> {
        if walk.first_difference((map, facing), Directional, facing).is_some() {
            return Err(NotProved::NotInMap);
        }
        let claim = Claim::determined(&walk, Directional, facing)?;
        let worlds = vec![(map, facing)];
        Ok(Self { worlds, marker: Directional, seen: Some(Seen::Walk(walk)), claims: vec![claim] })
    }

    /// That some choice of visits fits the world that [was found](crate::visits::explain) to explain them.
    ///
    /// # Errors
    /// Returns an error if none does.
    pub fn of_visits_in_world(
        world: &'g ClosedTrail,
        marker: MarkerKind,
        visits: &[VisitSet],
    ) -> Result<Self, NotProved> {
        let ClosedTrail { graph, marker: seen, start, .. } = world;
        let visits: Vec<_> = visits.iter().map(VisitSet::with_existing_doors).collect();
        let placed = seen.or_else(|| graph.darts().last()).ok_or(NotProved::NoWorldFound)?;
        // The robot may have turned back before its first vertex.
        let states = [*start, graph.opposite(*start)].map(|pose| State { pose, placed });
        let found = choice_in_world(graph, &marker, &states, &visits);
        let (State { pose: from, .. }, choice) = found.ok_or(NotProved::NoWorldFound)?;
        let (seen, claims) = (Some(Seen::Visits(visits)), vec![Claim::Fits { from, choice }]);
        Ok(Self { worlds: vec![(graph, placed)], marker, seen, claims })
    }

    /// That no choice of visits fits any world. `last` is the first visit up to which none does. The proof is about the visits
    /// that contradict each other, up to this one.
    ///
    /// # Errors
    /// Returns an error if the proof would be too long, or if some choice does not contradict itself.
    pub fn of_impossible_visits(
        visits: &[VisitSet],
        last: usize,
        marker: MarkerKind,
    ) -> Result<Self, NotProved> {
        let (visits, lines) = impossible_visits(visits, last, marker)?;
        let (seen, claims) = (Some(Seen::Visits(visits)), vec![Claim::Impossible { lines }]);
        Ok(Self { worlds: Vec::new(), marker, seen, claims })
    }
}

#[cfg(test)]
mod tests;
