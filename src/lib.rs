//! Deterministic topological SLAM that can be trusted.
//!
//! This package is the front of the house: it passes on the specification ([`model`]), draws worlds
//! ([`picture`]), lets a reader walk two of them in a browser ([`page`]) and traces the paper
//! ([`paper`]). [`journal`] is a run of a simulated robot as a person looks at it, [`report`] what the
//! specification says of a log.

pub mod journal;
pub mod page;
pub mod paper;
pub mod picture;
pub mod report;

pub use toposlam_model as model;
