//! Logs of runs: MCAP as ROS 2 writes it, and ROS 1 bags. Sections 5 and 6.

pub mod definition;
pub mod messages;
