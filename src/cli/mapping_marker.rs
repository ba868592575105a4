//! The algorithm of a run, its marker, and the worlds in which the marker suffices. Section 2.3.

use std::{fmt::Display, path::Path};

use toposlam_model::{
    aid::{self, AidKind},
    embedded_graph::EmbeddedGraph,
    mapping::MappingAlgorithm,
    marker::Directional,
};

use super::{CliError, RunChoices};

/// Parses the name of a marker that an algorithm maps with.
pub(super) fn mapping_marker(name: &str) -> Result<AidKind, String> {
    let mut markers = MappingAlgorithm::ALL.iter().map(|algorithm| algorithm.aid());
    markers
        .find(|marker| marker.name() == name)
        .ok_or_else(|| format!("no algorithm maps with `{name}`; choose directional or movable"))
}

/// Parses the name of a kind of marker. For a name that no marker has, the error lists those of the algorithms.
pub(super) fn marker_kind(name: &str) -> Result<AidKind, String> {
    aid::named(name).or_else(|_| mapping_marker(name))
}

/// Whether the marker is that of Algorithm 1, for which there are certificates.
pub(super) fn is_directional(marker: AidKind) -> bool {
    marker.name() == Directional.name()
}

/// The algorithm that maps with a marker, if this one is asked for.
///
/// # Errors
/// Returns an error if the algorithm needs another marker, or cannot make all choices.
pub(super) fn algorithm_for(
    asked: MappingAlgorithm,
    marker: AidKind,
    choices: RunChoices,
) -> Result<MappingAlgorithm, CliError> {
    let mut known = [asked].into_iter().chain(MappingAlgorithm::ALL.iter().copied());
    let found = known.find(|algorithm| algorithm.aid().name() == marker.name());
    let cause = || mapping_marker(marker.name()).err().unwrap_or_default();
    let found = found.ok_or_else(|| CliError::at("--marker", cause()))?;
    if found != asked && asked != MappingAlgorithm::default() {
        let cause = format!("{} maps with --marker {}", asked.in_words(), asked.aid().name());
        return Err(CliError::at("--algorithm", cause));
    }
    if choices != RunChoices::Default && !is_directional(marker) {
        return Err(CliError::at("--choices", "`all` needs --marker directional"));
    }
    Ok(found)
}

/// Checks that the marker suffices for every world of a file.
///
/// # Errors
/// Returns an error if the marker is movable and a world has loops or parallel edges.
pub(super) fn check_worlds(
    marker: AidKind,
    path: &Path,
    graphs: &[EmbeddedGraph],
) -> Result<(), CliError> {
    match graphs.iter().position(|graph| !graph.is_simple()) {
        Some(index) if marker.moves() => {
            let world = format!("world {}", index + 1);
            Err(CliError::in_file(path, movable_not_sufficient(world)))
        }
        _ => Ok(()),
    }
}

/// The error for a world, or a class of worlds, that one movable marker cannot map, with the smallest pair that
/// the search finds.
pub(super) fn movable_not_sufficient(what: impl Display) -> String {
    format!(
        "{what} has loops or parallel edges, and one movable marker does not suffice for them: no \
         walk distinguishes [v0 = e0 e0 e1 e1] and [v0 = e0 e1 e0 e1] (see toposlam counterexample \
         --marker movable --class multigraph)"
    )
}
