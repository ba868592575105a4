//! Deterministic topological SLAM that can be trusted.
//!
//! This package is the front of the house: it passes on the specification ([`model`]), draws worlds
//! ([`picture`]) and traces the paper ([`paper`]).

pub mod paper;
pub mod picture;

pub use toposlam_model as model;
