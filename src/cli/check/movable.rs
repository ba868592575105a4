//! Where one movable marker does not suffice. Section 2.3.

use std::fmt::Display;

/// Why a world, or a class of worlds, is not mapped with a movable marker.
pub(super) fn not_sufficient(what: impl Display) -> String {
    let pair = smallest_pair();
    format!(
        "{what} has loops or parallel edges, and with these one movable marker does not suffice: \
         it cannot tell {pair}"
    )
}

/// The smallest two worlds that no robot with one movable marker can tell apart, in words: at their
/// only vertex the marker is always at hand, and tells nothing.
fn smallest_pair() -> &'static str {
    "two loops at a vertex that lie side by side from two that cross \
     (worlds/two-loops-plane.toml, worlds/two-loops-torus.toml; `toposlam counterexample --marker \
     movable --class multigraph`)"
}
