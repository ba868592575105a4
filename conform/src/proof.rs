//! The proof of a judgement, as far as it is about percepts and doors: what an algorithm would have done is no part of it.
//! Beyond the paper.

use std::collections::BTreeMap;

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    folding::SmallestWorld,
    marker::MarkerKind,
    proof::{Claim, NotProved, Proof, Walk, unexplained},
};

use super::{check::CheckedLog, known_world::KnownWorld};

impl CheckedLog {
    /// The proofs of what the recorded percepts and doors show. In a known world: that they are a walk in it, or from none of
    /// the possible starts. Otherwise: that they determine their world, that no world gives them, or a world that does.
    ///
    /// # Errors
    /// Returns an error if there is no proof of this kind.
    pub fn proofs(&self) -> Result<Vec<Proof<'_>>, NotProved> {
        let judgement = &self.judgement;
        let marker = self.config.aid.fixed().ok_or(NotProved::Aid(self.config.aid.name()))?;
        if judgement.possible.as_ref().is_some_and(|possible| possible.certain < possible.visits) {
            return Err(NotProved::Possible);
        }
        let trace = &judgement.trace;
        if judgement.lost.is_some() || !trace.relocations().is_empty() {
            return Err(NotProved::Lost);
        }
        let walk = Walk::new(trace.percepts(), trace.doors())?;
        if let Some(known) = &self.config.world {
            return Ok(in_known_world(known, marker, walk));
        }
        if let Some((walk, claim)) = unexplained(&walk, marker) {
            let walk = Some(walk);
            return Ok(vec![Proof { worlds: Vec::new(), marker, walk, claims: vec![claim] }]);
        }
        let Some(SmallestWorld::World { graph, marker: place, .. }) = &judgement.smallest else {
            return Err(NotProved::NoWorldFound);
        };
        in_found_world((graph, *place), marker, walk).map(|proof| vec![proof])
    }
}

/// That a walk is one in a known world, or a proof for each place of the marker that it is not.
fn in_known_world(known: &KnownWorld, marker: MarkerKind, walk: Walk) -> Vec<Proof<'_>> {
    let graph = &known.graph;
    let mut starts: BTreeMap<Dart, Vec<Dart>> = BTreeMap::new();
    for state in known.with_fixed_marker() {
        starts.entry(state.placed).or_default().push(state.pose);
    }
    let proof = |facing, walk, claim| Proof {
        worlds: vec![(graph, facing)],
        marker,
        walk: Some(walk),
        claims: vec![claim],
    };
    // The visit at which the last of the poses differs.
    let mut differs = 0;
    for (&facing, poses) in &starts {
        for &from in poses {
            match walk.first_difference((graph, facing), marker, from) {
                None => return vec![proof(facing, walk, Claim::Conforms { from })],
                Some(visit) => differs = differs.max(visit),
            }
        }
    }
    let walk = walk.up_to(differs);
    let diverges = |(facing, poses): (Dart, Vec<Dart>)| {
        let from = (poses.len() < graph.dart_count()).then_some(poses);
        proof(facing, walk.clone(), Claim::Diverges { from })
    };
    starts.into_iter().map(diverges).collect()
}

/// That a walk is one in the world that was found, and in no other if it determines its world.
fn in_found_world(
    (graph, place): (&EmbeddedGraph, Option<Dart>),
    marker: MarkerKind,
    walk: Walk,
) -> Result<Proof<'_>, NotProved> {
    let from = Dart(0);
    let gives = |&facing: &Dart| walk.first_difference((graph, facing), marker, from).is_none();
    let facing = place.into_iter().chain(graph.darts()).find(gives);
    let facing = facing.ok_or(NotProved::NoWorldFound)?;
    let claim = match Claim::determined(&walk, marker, from) {
        Ok(determined) => determined,
        Err(NotProved::Open(_) | NotProved::OtherMarker) => Claim::Conforms { from },
        Err(why) => return Err(why),
    };
    Ok(Proof { worlds: vec![(graph, facing)], marker, walk: Some(walk), claims: vec![claim] })
}
