//! A page on which a person walks two worlds at once.

use std::path::Path;

use toposlam_model::{
    aid::{Aid, AidKind},
    format::named_world::NamedWorld,
};

use super::{CliError, output, text::grouped};
use crate::page::{WalkPage, page};

/// The most darts of a world on a page.
const MOST_DARTS: usize = 20_000;

pub(crate) fn write(path: &Path, content: &WalkPage) -> Result<(), CliError> {
    for world in content.worlds {
        check_world(path, world, content.marker)?;
    }
    output::write_whole(path, page(content).as_bytes())
}

/// Checks that a page can show a world.
///
/// # Errors
/// Returns an error if it is too large, or if the aid cannot be seen everywhere in it.
pub(super) fn check_world(
    path: &Path,
    world: &NamedWorld,
    marker: AidKind,
) -> Result<(), CliError> {
    if !marker.is_seen_everywhere(&world.graph) {
        let aid = marker.name();
        let cause =
            format!("a page shows no {aid} in {}: a vertex has too many doors for it", world.name);
        return Err(CliError::in_file(path, cause));
    }
    if world.graph.dart_count() <= MOST_DARTS {
        return Ok(());
    }
    let most = grouped(MOST_DARTS as u128);
    let cause = format!("{} has more than the {most} darts that a page can show", world.name);
    Err(CliError::in_file(path, cause))
}
