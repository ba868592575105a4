//! Deterministic topological SLAM that can be trusted.
//!
//! This package is the front of the house: it passes on the specification ([`model`]), draws worlds,
//! traces the paper ([`paper`]) and holds what the command line `toposlam` prints.

pub mod paper;
pub mod picture;

pub use toposlam_model as model;
