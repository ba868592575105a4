//! Compares sensing, driving and whole runs with the floor plan and the specification.
//!
//! Each measurement is a function from the number of a sample to its outcome, which [`sampling::sample`] calls on all
//! threads. [`report`] counts the outcomes.

pub mod bound;
pub mod judge;
pub mod judged_view;
pub mod laser;
pub mod measured_run;
pub mod report;
pub mod run_sampler;
pub mod sampling;
pub mod traversals;
pub mod verdict;
pub mod vision_report;
