//! Writes a page on which a person walks two worlds at once.

use std::path::Path;

use toposlam::page::{WalkPage, page};
use toposlam_model::{
    ambiguity::Comparison, embedded_graph::Dart, format::named_world::NamedWorld, marker::Marker,
};

use super::{Failure, output};

/// Refuses a path that cannot become a page, before long work begins.
pub(crate) fn check_place(path: &Path) -> Result<(), Failure> {
    output::check_place(path, &["html", "htm"])
}

/// Writes the page of two worlds with a marker, whose robots begin in these poses.
pub(crate) fn write(
    path: &Path,
    worlds: [&NamedWorld; 2],
    marker: &dyn Marker,
    comparison: &Comparison,
    poses: [Dart; 2],
) -> Result<(), Failure> {
    let title = format!("{} and {}, {} marker", worlds[0].name, worlds[1].name, marker.name());
    let stop = if marker.about().ends_with('?') { "" } else { "." };
    let verdict = if comparison.indistinguishable(poses) {
        "No walk tells these worlds apart: whatever both robots do, both perceive the same."
    } else {
        "A walk tells these worlds apart: it is as short as any that does."
    };
    let about = format!("The marker: {}{stop} {verdict}", marker.about());
    let document = page(&WalkPage { title: &title, about: &about, worlds, comparison, poses });
    output::write_whole(path, document.as_bytes())
}
