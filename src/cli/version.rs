//! The version of this program.

/// The version of the package, and, in a build from a git checkout, the revision: `0.1.0` or
/// `0.1.0+0123456789ab`. If files differ from the revision, `.modified` follows.
pub(super) const VERSION: &str = env!("TOPOSLAM_VERSION");
