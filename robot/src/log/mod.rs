//! Logs of runs: MCAP as ROS 2 writes it, and ROS 1 bags. Sections 5 and 6.

pub mod message;
pub mod messages;
pub mod recorder;
pub mod standard;
mod told;
mod world_hash;
pub mod writer;

pub use world_hash::world_hash;
