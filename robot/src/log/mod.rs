//! Logs of runs: MCAP as ROS 2 writes it, and ROS 1 bags. Sections 5 and 6.

mod container;
pub mod decode;
pub mod definition;
pub mod entries;
pub mod error;
mod in_order;
pub mod mapping;
pub mod message;
pub mod messages;
mod own;
mod picture;
pub mod reading;
pub mod recorder;
#[cfg(test)]
pub(crate) mod shared;
mod source;
pub mod standard;
mod told;
pub mod topic;
pub mod value;
mod world_hash;
pub mod writer;

pub use container::{Format, MOST_GROWTH};
pub use told::scene as scene_message;
pub(crate) use told::scene_of;
pub use world_hash::world_hash;
