//! A robot that maps a building: the robot trait, the explorer that drives it, its runs and recordings, the SuperScout,
//! and the connections to ROS 1 and ROS 2. Sections 2.4, 2.5 and 4 to 6.

// Tests compare exact numbers.
#![cfg_attr(test, allow(clippy::float_cmp))]

pub mod any_explorer;
pub mod budget;
mod capture;
pub mod corridors;
mod event_log;
pub mod explorer;
#[cfg(feature = "live")]
pub mod live;
pub mod measured_hallway;
pub mod recording;
pub mod replay;
pub mod robot;
#[cfg(feature = "ros1")]
pub mod ros1;
#[cfg(feature = "ros2")]
pub mod ros2;
pub mod run_settings;
pub mod superscout;
