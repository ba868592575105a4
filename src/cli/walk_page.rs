//! A page on which a person walks two worlds at once.

use std::path::Path;

use toposlam_model::{ambiguity::state_count, format::named_world::NamedWorld, marker::Marker};

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
    marker: &dyn Marker,
) -> Result<(), CliError> {
    let states = state_count(&world.graph, marker);
    if states <= MOST_STATES {
        return Ok(());
    }
    let [states, most] = [states, MOST_STATES].map(|count| grouped(count as u128));
    let cause = format!("{} has {states} states; a page can show at most {most}", world.name);
    Err(CliError::in_file(path, cause))
}
