//! Logs of runs: MCAP as ROS 2 writes it, and ROS 1 bags. Sections 5 and 6.

mod container;
pub mod decode;
pub mod definition;
mod encode;
pub mod entries;
pub mod error;
mod from_value;
mod image;
mod laser_scan;
mod mcap_writer;
mod merge;
pub mod message;
pub mod messages;
pub mod reader;
pub mod recorder;
mod source;
pub mod standard;
pub mod topic;
pub mod topic_map;
pub mod value;
pub mod verify;
mod world_hash;
pub mod writer;

pub use container::{Format, MOST_GROWTH};
pub use encode::{arrival as arrival_message, door as door_message, scene as scene_message};
pub use merge::{RawMessage, RawMessages};
pub use world_hash::world_hash;
