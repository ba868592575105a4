//! Compares sensing, driving and whole runs with the floor plan and the specification.

pub mod bound;
pub mod calibration;
pub mod clutter;
pub mod failure_groups;
pub mod judge;
pub mod judged_view;
pub mod laser;
pub mod measured_run;
mod parallel;
pub mod quantile;
pub mod report;
pub mod run_sampler;
pub mod scene_class;
pub mod traversals;
pub mod verdict;
