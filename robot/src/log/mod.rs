//! Logs of runs: MCAP as ROS 2 writes it, and ROS 1 bags. Sections 5 and 6.

mod container;
pub mod decode;
pub mod definition;
pub mod entries;
pub mod error;
mod in_order;
pub mod mapping;
pub mod messages;
mod own;
mod picture;
pub mod reading;
mod source;
pub mod topic;
pub mod value;

pub use container::{Format, MOST_GROWTH};
