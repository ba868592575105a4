//! A page on which a person walks two worlds at once.

use std::path::Path;

use toposlam_model::{
    aid::{AidKind, FEW_STATES},
    ambiguity::has_more_states,
    embedded_graph::Dart,
    format::named_world::NamedWorld,
};

use super::{CliError, output, text::grouped};
use crate::page::{WalkPage, page};

/// The most states of a world on a page.
const MOST_STATES: usize = 20_000;

pub(crate) fn write(path: &Path, content: &WalkPage) -> Result<(), CliError> {
    for world in content.worlds {
        check_states(path, world, content.marker)?;
    }
    output::write_whole(path, page(content).as_bytes())
}

/// Checks that a page can show a world.
///
/// # Errors
/// Returns an error if the robot can be in too many states.
pub(super) fn check_states(
    path: &Path,
    world: &NamedWorld,
    marker: AidKind,
) -> Result<(), CliError> {
    if !FEW_STATES.contains(&marker) {
        let known: Vec<_> = FEW_STATES.iter().map(|aid| aid.name()).collect();
        let cause = format!("a page shows no {}; it shows {}", marker.name(), known.join(", "));
        return Err(CliError::at("--html", cause));
    }
    let start = world.start.unwrap_or(Dart(0));
    if !has_more_states(&world.graph, marker, start, MOST_STATES) {
        return Ok(());
    }
    let most = grouped(MOST_STATES as u128);
    let cause = format!("{} has more than the {most} states that a page can show", world.name);
    Err(CliError::in_file(path, cause))
}
