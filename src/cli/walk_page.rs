//! A page on which a person walks two worlds at once.

use std::path::Path;

use toposlam_model::{
    ambiguity::{Comparison, state_count},
    embedded_graph::Dart,
    format::named_world::NamedWorld,
    marker::Marker,
};

use super::{
    CliError, output,
    text::{grouped, sentence},
};
use crate::page::{WalkPage, page};

/// The most states of a world on a page.
const MOST_STATES: usize = 20_000;

/// Writes the page of two worlds with a marker, with robots that start at these poses.
pub(crate) fn write(
    path: &Path,
    worlds: [&NamedWorld; 2],
    marker: &dyn Marker,
    comparison: &Comparison,
    poses: [Dart; 2],
) -> Result<(), CliError> {
    for world in worlds {
        check_states(path, world, marker)?;
    }
    let kind = if marker.name() == "none" { "no" } else { marker.name() };
    let title = format!("{} and {}, {kind} marker", worlds[0].name, worlds[1].name);
    let starts = format!(
        "from {} in A and {} in B",
        worlds[0].start_text(poses[0]),
        worlds[1].start_text(poses[1])
    );
    let verdict = match comparison.walk(poses) {
        None => format!(
            "{starts} no walk distinguishes these worlds: whatever both robots do, they perceive the \
             same"
        ),
        Some(walk) if walk.actions.is_empty() => format!("{starts} the first percepts differ"),
        Some(walk) => {
            let actions: Vec<_> = walk.actions.iter().map(ToString::to_string).collect();
            format!("{starts} the walk {} distinguishes these worlds", actions.join(", "))
        }
    };
    let about = format!("{} {}", sentence(marker.about()), sentence(&verdict));
    let document = page(&WalkPage { title: &title, about: &about, worlds, comparison, poses });
    output::write_whole(path, document.as_bytes())
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
