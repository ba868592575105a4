//! Sensing and driving, judged against the truth of the floor plan and against the specification.

pub mod bound;
pub mod calibration;
pub mod causes;
pub mod class;
pub mod control;
mod eyes;
mod in_turn;
pub mod judged;
pub mod judging;
mod learning;
mod plans;
pub mod quantile;
pub mod random_plan;
pub mod report;
pub mod runs;
pub mod verdict;
pub mod view;
pub mod views;

pub use eyes::Eyes;
pub use learning::{LearningError, learned};
pub use plans::plans;
