//! The requirements of the paper: where each is implemented and where it is tested.
//!
//! The requirements are in `tests/paper.toml`. Sources cite them (see [`citations`]); those
//! citations were collected when this library was built, so that they can be shown far from the
//! sources.

mod citation;
mod requirement;
mod trace;

pub use citation::{Citation, CitationKind, citations};
pub use requirement::{Requirement, Status, TableError, requirements};
pub use trace::{PaperTrace, TracedRequirement};

/// The table of requirements, as it is written.
pub const TABLE: &str = include_str!("../../tests/paper.toml");

/// Every citation in the sources of the workspace, by file and line.
pub const CITATIONS: &[Citation<'static>] = include!(concat!(env!("OUT_DIR"), "/citations.rs"));
