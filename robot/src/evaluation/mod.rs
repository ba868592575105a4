//! Compares sensing, driving and whole runs with the floor plan and the specification.

pub mod bound;
pub mod calibration;
pub mod clutter;
mod colour_learning;
mod equipment;
pub mod failure_groups;
mod false_percepts;
pub mod judge;
pub mod judged_view;
pub mod laser;
mod learned_sensors;
pub mod measured_run;
mod parallel;
mod plans;
pub mod quantile;
#[cfg(test)]
mod question_limit;
pub mod random_plan;
pub mod rendered_view;
pub mod report;
pub mod run_sampler;
pub mod scene_class;
pub mod traversals;
pub mod verdict;
pub mod view_sampler;

pub use colour_learning::{LearningError, learned};
pub use equipment::RobotEquipment;
pub use false_percepts::FalsePercepts;
pub use learned_sensors::LearnedSensors;
pub use plans::plans;
