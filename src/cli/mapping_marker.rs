//! The algorithm of a run, its marker, and the worlds in which the marker suffices. Section 2.3.

use std::{fmt::Display, path::Path};

use toposlam_model::{
    aid::{self, Aid, AidKind},
    embedded_graph::EmbeddedGraph,
    mapping::MappingAlgorithm,
    marker::Directional,
};

use super::CliError;

/// Parses the name of an aid that an algorithm maps with.
pub(super) fn mapping_marker(name: &str) -> Result<AidKind, String> {
    let mut aids = MappingAlgorithm::all().map(MappingAlgorithm::aid);
    aids.find(|aid| aid.name() == name).ok_or_else(|| {
        let mut names: Vec<_> = MappingAlgorithm::all().map(|known| known.aid().name()).collect();
        names.dedup();
        format!("no algorithm maps with `{name}`; choose one of {}", names.join(", "))
    })
}

/// Parses the name of a marking aid. For a name that none has, the error lists those of the algorithms.
pub(super) fn marker_kind(name: &str) -> Result<AidKind, String> {
    aid::named(name).or_else(|_| mapping_marker(name))
}

/// Whether the marker is that of Algorithm 1, for which there are certificates.
pub(super) fn is_directional(marker: AidKind) -> bool {
    marker.name() == Directional.name()
}

/// Whether the aid suffices only for worlds without loops and parallel edges.
pub(super) fn needs_simple(aid: AidKind) -> bool {
    MappingAlgorithm::all().any(|known| known.aid() == aid && known.needs_simple())
}

/// The algorithm that maps with an aid, if this one is asked for.
///
/// # Errors
/// Returns an error if the algorithm needs another aid.
pub(super) fn algorithm_for(
    asked: MappingAlgorithm,
    marker: AidKind,
) -> Result<MappingAlgorithm, CliError> {
    let mut known = [asked].into_iter().chain(MappingAlgorithm::all());
    let found = known.find(|algorithm| algorithm.aid().name() == marker.name());
    let cause = || mapping_marker(marker.name()).err().unwrap_or_default();
    let found = found.ok_or_else(|| CliError::at("--marker", cause()))?;
    if found != asked && asked != MappingAlgorithm::default() {
        let cause = format!("{} maps with --marker {}", asked.in_words(), asked.aid().name());
        return Err(CliError::at("--algorithm", cause));
    }
    Ok(found)
}

/// Checks that the aid can be seen everywhere in the worlds of a file. Otherwise a run or a comparison is no evidence.
///
/// # Errors
/// Returns an error that names the first world where it cannot.
pub(super) fn check_seen<'g>(
    aid: AidKind,
    path: &Path,
    graphs: impl IntoIterator<Item = &'g EmbeddedGraph>,
) -> Result<(), CliError> {
    match graphs.into_iter().position(|graph| !aid.is_seen_everywhere(graph)) {
        None => Ok(()),
        Some(index) => {
            let (name, place, number) = (aid.name(), aid.unseen_place(), index + 1);
            let cause =
                format!("world {number} has {place}, which is the most for the marking aid {name}");
            Err(CliError::in_file(path, cause))
        }
    }
}

/// Checks that the aid suffices for every world of a file.
///
/// # Errors
/// Returns an error if it suffices only for worlds without loops and parallel edges, and a world has them; or if it
/// cannot be seen everywhere.
pub(super) fn check_worlds(
    marker: AidKind,
    path: &Path,
    graphs: &[EmbeddedGraph],
) -> Result<(), CliError> {
    check_seen(marker, path, graphs)?;
    match graphs.iter().position(|graph| !graph.is_simple()) {
        Some(index) if needs_simple(marker) => {
            let world = format!("world {}", index + 1);
            Err(CliError::in_file(path, not_sufficient(marker, world)))
        }
        _ => Ok(()),
    }
}

/// The error for a world, or a class of worlds, that cannot be mapped with an aid, with the smallest pair that
/// the search finds.
pub(super) fn not_sufficient(aid: AidKind, what: impl Display) -> String {
    let name = aid.name();
    format!(
        "{what} has loops or parallel edges, and the marking aid {name} does not suffice for them: no \
         walk distinguishes [v0 = e0 e0 e1 e1] and [v0 = e0 e1 e0 e1] (see toposlam counterexample \
         --aid {name} --class multigraph)"
    )
}
