//! Logs of runs: MCAP as ROS 2 writes it, and ROS 1 bags. Sections 5 and 6.

mod container;
pub mod decode;
pub mod definition;
pub mod error;
mod in_order;
pub mod messages;
pub mod reading;
mod source;
pub mod topic;
pub mod value;

pub use container::{Format, MOST_GROWTH};
