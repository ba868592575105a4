//! Proofs of verdicts: what is claimed, and the steps that show it, in the text format of
//! `docs/proofs-of-verdicts.md`. A checker that is proved in Coq confirms them. Beyond the paper.

mod claim;
mod folded_walk;
mod text;
mod walk;

pub use claim::{Claim, NotProved, WalkPair, unexplained};
pub use folded_walk::{FoldedWalk, Passage, UnionStep, WalkContradiction, WalkEnd, fold_walk};
pub use walk::{PerceivedWalk, WalkRecorder};

use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::{Directional, MarkerKind, NoMarker},
    visits::VisitSet,
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
}

#[cfg(test)]
mod tests;
