//! The pairs that a search found, and names for their worlds.

use std::{collections::BTreeMap, path::Path, ptr};

use toposlam_model::{
    aid::AidKind,
    ambiguity::{Comparison, Findings, PlacedWorld, Unfinished},
    enumerate::Class,
    format::{named_world::NamedWorld, world_file},
    proof::{Claim, NotProved, Proof},
};

use crate::{
    cli::{CliError, Outcome, output, terminal, walk_page},
    page::WalkPage,
};

/// The reported pairs, and each of their worlds once.
pub(super) struct WorldPairs {
    /// Each once, in the order of the pairs.
    pub(super) worlds: Vec<NamedWorld>,
    /// The indices of the two worlds of each pair, the smallest pair first.
    pairs: Vec<[usize; 2]>,
    /// Whether these are all pairs, and not only the smallest.
    pub(super) all: bool,
}

impl WorldPairs {
    /// The smallest pair, or all.
    pub(super) fn new(marker: AidKind, class: Class, findings: &Findings, all: bool) -> Self {
        let pairs = if all { findings.pairs() } else { findings.smallest().into_iter().collect() };
        let mut worlds: Vec<&PlacedWorld> = Vec::new();
        let mut places = BTreeMap::new();
        let mut place = |world| {
            *places.entry(ptr::from_ref::<PlacedWorld>(world)).or_insert_with(|| {
                worlds.push(world);
                worlds.len() - 1
            })
        };
        let pairs: Vec<_> = pairs.into_iter().map(|pair| pair.map(&mut place)).collect();
        let name = |place: usize| format!("{}-{class}-{}", marker.name(), place + 1);
        let named = |(place, world): (usize, &&PlacedWorld)| {
            let other = pairs.iter().find(|pair| pair.contains(&place));
            let other = other.into_iter().flatten().find(|&&other| other != place);
            let about = format!(
                "No walk distinguishes it from {}; marker: {}",
                other.map_or_else(String::new, |&other| name(other)),
                marker.name()
            );
            let graph = world.graph.clone();
            NamedWorld {
                marker: Some(marker),
                ..NamedWorld::numbered(&name(place), &about, graph, Some(PlacedWorld::FACING))
            }
        };
        Self { worlds: worlds.iter().enumerate().map(named).collect(), pairs, all }
    }

    /// The pairs, the smallest first.
    pub(super) fn pairs(&self) -> Vec<[&NamedWorld; 2]> {
        self.pairs.iter().map(|pair| pair.map(|place| &self.worlds[place])).collect()
    }

    /// Writes the page of the smallest pair. Without a pair it prints a message and writes nothing.
    pub(super) fn write_page(&self, path: &Path, marker: AidKind) -> Result<(), CliError> {
        let Some(worlds @ [one, other]) = self.pairs().first().copied() else {
            remark!("{} is not written: there is no pair", path.display());
            return Ok(());
        };
        let start = PlacedWorld::FACING;
        let comparison = Comparison::new(marker, (&one.graph, start), (&other.graph, start));
        let pose = comparison.start_like(start).unwrap_or(start);
        walk_page::write(path, &WalkPage { worlds, facings: [start, start], pose, marker })
    }

    /// The proofs of the pairs: that no walk distinguishes their worlds, and if these differ without their markers, that.
    ///
    /// # Errors
    /// Returns an error if the marking aid moves.
    pub(super) fn proofs(&self, aid: AidKind) -> Result<String, NotProved> {
        let marker = aid.fixed().ok_or(NotProved::Aid(aid.name()))?;
        let start = PlacedWorld::FACING;
        let proof = |worlds: [&NamedWorld; 2]| {
            let graphs = worlds.map(|world| &world.graph);
            let [one, other] = graphs.map(|graph| (graph, start));
            let comparison = Comparison::new(marker, one, other);
            let pose = comparison.start_like(start).unwrap_or(start);
            let differ = Claim::isomorphism(graphs[0], graphs[1]);
            let differ = Some(differ).filter(|claim| matches!(claim, Claim::NotIsomorphic { .. }));
            let alike = Claim::indistinguishable(&comparison, [start, pose]);
            let claims = differ.into_iter().chain([alike]).collect();
            Proof { worlds: vec![one, other], marker, seen: None, claims }.to_string()
        };
        Ok(self.pairs().into_iter().map(proof).collect())
    }

    /// Writes each world into a file that has its name.
    pub(super) fn write(&self, folder: &Path) -> Result<(), CliError> {
        for world in &self.worlds {
            let path = folder.join(format!("{}.toml", world.name));
            output::write_whole(&path, world_file::to_toml(world).as_bytes())?;
        }
        Ok(())
    }
}

/// Returns the outcome of a search that did not finish. Prints why, if it was not stopped.
pub(super) fn report_unfinished(unfinished: &Unfinished) -> Result<Outcome, CliError> {
    match unfinished {
        Unfinished::Interrupted => Err(CliError::Interrupted),
        Unfinished::Unconfirmed(_) | Unfinished::Unreadable => {
            terminal::print_message(&format!("{unfinished}\n"));
            Ok(Outcome::Violated)
        }
    }
}
