//! Sensing, judged against the truth of the floor plan.

pub mod bound;
pub mod class;
pub mod quantile;
pub mod random_plan;
pub mod truth;
pub mod verdict;
pub mod view;
