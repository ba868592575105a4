//! The version of this program.

use std::sync::OnceLock;

static VERSION: OnceLock<String> = OnceLock::new();

/// Adds the revision of the sources to the version, as build metadata. Only the program knows it: the library does
/// not compile again when it changes.
pub(super) fn set_revision(revision: Option<&str>) {
    let revision = revision.filter(|revision| !revision.is_empty());
    let revision = revision.map(|revision| format!("+{revision}")).unwrap_or_default();
    // A second call changes nothing.
    let _ = VERSION.set(env!("CARGO_PKG_VERSION").to_owned() + &revision);
}

/// The version of the package, and the revision, if the build was given one: `0.1.0` or `0.1.0+0123456789ab`.
pub(super) fn version() -> &'static str {
    VERSION.get().map_or(env!("CARGO_PKG_VERSION"), String::as_str)
}

/// The version of the package in a version.
pub(super) fn release(version: &str) -> &str {
    version.split_once('+').map_or(version, |(release, _)| release)
}
