//! The proof of a judgement, as far as it is about percepts and doors: what an algorithm would have done is no part of it.
//! Beyond the paper.

use std::{collections::BTreeMap, slice};

use toposlam_model::{
    aid::State,
    embedded_graph::{Dart, EmbeddedGraph},
    folding::SmallestWorld,
    marker::{MarkerKind, NoMarker},
    proof::{Claim, NotProved, PerceivedRun, PerceivedWalk, Proof, Seen, unexplained},
    trace::poses,
    visits::{Explanation, VisitSet, choice_in_world},
};

use super::{
    check::CheckedLog,
    config::ConformConfig,
    known_world::KnownWorld,
    possible_visits::{PossibleVisits, VisitFit},
};

impl CheckedLog {
    /// The proofs of what the recorded percepts and doors show. In a known world: that they are a walk in it, or from none of
    /// the possible starts. Otherwise: that they determine their world, that no world gives them, or a world that does.
    /// Of visits with several possible percepts: that some choice fits the known world or a world that was found, or that
    /// none does. Of a run with a marker that is carried: what is so in a known world.
    ///
    /// # Errors
    /// Returns an error if there is no proof of this kind.
    pub fn proofs(&self) -> Result<Vec<Proof<'_>>, NotProved> {
        let judgement = &self.judgement;
        let Some(marker) = self.config.aid.fixed() else { return self.proofs_of_run() };
        if let Some(possible) = &judgement.possible {
            if possible.fit == VisitFit::UnseenWay {
                return Err(NotProved::UnseenWay);
            }
            return match &self.config.world {
                Some(known) => Ok(of_visits(known, marker, &possible.sets)),
                None => of_visits_in_some_world(possible, marker).map(|proof| vec![proof]),
            };
        }
        let trace = &judgement.trace;
        if !trace.relocations().is_empty() {
            return Err(NotProved::Lost);
        }
        let walk = PerceivedWalk::new(trace.percepts(), trace.doors())?;
        if let Some(known) = &self.config.world {
            return Ok(in_known_world(known, marker, walk));
        }
        if let Some((walk, claim)) = unexplained(&walk, marker) {
            let seen = Some(Seen::Walk(walk));
            return Ok(vec![Proof { worlds: Vec::new(), marker, seen, claims: vec![claim] }]);
        }
        let Some(SmallestWorld::World { graph, marker: place, .. }) = &judgement.smallest else {
            return Err(NotProved::NoWorldFound);
        };
        in_found_world((graph, *place), marker, walk).map(|proof| vec![proof])
    }

    /// That a run with a marker that the robot carries is one in the known world, or a proof for each place of the marker that
    /// it is not.
    fn proofs_of_run(&self) -> Result<Vec<Proof<'_>>, NotProved> {
        let ConformConfig { aid, world, .. } = &self.config;
        let trace = &self.judgement.trace;
        if !trace.relocations().is_empty() {
            return Err(NotProved::Lost);
        }
        let run = PerceivedRun::new(*aid, trace)?;
        let known = world.as_ref().ok_or(NotProved::AidWithoutWorld(aid.name()))?;
        let graph = &known.graph;
        let proof = |facing, claim| Proof {
            worlds: vec![(graph, facing)],
            marker: NoMarker,
            seen: Some(Seen::Run(run.clone())),
            claims: vec![claim],
        };
        let mut starts: BTreeMap<Dart, Vec<Dart>> = BTreeMap::new();
        for state in &known.states {
            let facing = state.placed.first().copied().flatten().ok_or(NotProved::NoWorldFound)?;
            if poses(graph, aid, slice::from_ref(state), trace).misfit.is_none() {
                return Ok(vec![proof(facing, Claim::Conforms { from: state.pose })]);
            }
            starts.entry(facing).or_default().push(state.pose);
        }
        let diverges =
            |(facing, poses)| proof(facing, Claim::Diverges { from: unless_all(poses, graph) });
        Ok(starts.into_iter().map(diverges).collect())
    }
}

/// The possible poses at the start, by the place of the marker.
fn starts_of(known: &KnownWorld) -> BTreeMap<Dart, Vec<Dart>> {
    let mut starts: BTreeMap<Dart, Vec<Dart>> = BTreeMap::new();
    for state in known.with_fixed_marker() {
        starts.entry(state.placed).or_default().push(state.pose);
    }
    starts
}

/// `None` for all poses of a world.
fn unless_all(poses: Vec<Dart>, graph: &EmbeddedGraph) -> Option<Vec<Dart>> {
    (poses.len() < graph.dart_count()).then_some(poses)
}

/// That some choice of visits fits a known world, or a proof for each place of the marker that none does.
fn of_visits<'w>(known: &'w KnownWorld, marker: MarkerKind, visits: &[VisitSet]) -> Vec<Proof<'w>> {
    let graph = &known.graph;
    let visits: &Vec<_> = &visits.iter().map(VisitSet::with_existing_doors).collect();
    let proof = |facing, claim| {
        let seen = Some(Seen::Visits(visits.clone()));
        Proof { worlds: vec![(graph, facing)], marker, seen, claims: vec![claim] }
    };
    let states = known.with_fixed_marker();
    if let Some((State { pose: from, placed }, choice)) =
        choice_in_world(graph, &marker, &states, visits)
    {
        return vec![proof(placed, Claim::Fits { from, choice })];
    }
    let misfits =
        |(facing, poses)| proof(facing, Claim::Misfits { from: unless_all(poses, graph) });
    starts_of(known).into_iter().map(misfits).collect()
}

/// That some choice of visits fits a world that was found, or that none fits any world.
fn of_visits_in_some_world(
    possible: &PossibleVisits,
    marker: MarkerKind,
) -> Result<Proof<'_>, NotProved> {
    let (explanation, world) = possible.searched.as_ref().ok_or(NotProved::Possible)?;
    match explanation {
        Explanation::Explained(_) => {
            let world = world.as_ref().ok_or(NotProved::NoWorldFound)?;
            Proof::of_visits_in_world(world, marker, &possible.sets)
        }
        &Explanation::Impossible { visit } => {
            Proof::of_impossible_visits(&possible.sets, visit, marker)
        }
        Explanation::NotKnown => Err(NotProved::SearchEnded),
    }
}

/// That a walk is one in a known world, or a proof for each place of the marker that it is not.
fn in_known_world(known: &KnownWorld, marker: MarkerKind, walk: PerceivedWalk) -> Vec<Proof<'_>> {
    let graph = &known.graph;
    let starts = starts_of(known);
    let proof = |facing, walk, claim| {
        let seen = Some(Seen::Walk(walk));
        Proof { worlds: vec![(graph, facing)], marker, seen, claims: vec![claim] }
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
        proof(facing, walk.clone(), Claim::Diverges { from: unless_all(poses, graph) })
    };
    starts.into_iter().map(diverges).collect()
}

/// That a walk is one in the world that was found, and in no other if it determines its world.
fn in_found_world(
    (graph, place): (&EmbeddedGraph, Option<Dart>),
    marker: MarkerKind,
    walk: PerceivedWalk,
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
    let seen = Some(Seen::Walk(walk));
    Ok(Proof { worlds: vec![(graph, facing)], marker, seen, claims: vec![claim] })
}
