//! A page on which a person walks two worlds at once.

use std::path::Path;

use toposlam_model::{aid::AidKind, format::named_world::NamedWorld};

use super::{CliError, mapping_marker::check_seen, output, text::grouped};
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
    check_seen(marker, path, [&world.graph])?;
    if world.graph.dart_count() <= MOST_DARTS {
        return Ok(());
    }
    let most = grouped(MOST_DARTS as u128);
    let cause = format!("{} has more than the {most} darts that a page can show", world.name);
    Err(CliError::in_file(path, cause))
}
