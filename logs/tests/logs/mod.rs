//! Logs: whole, cut off, damaged, without an index, in every compression, written by ROS tools or
//! by the `mcap` crate.

// What was written is what is read, to the last bit.
#![allow(clippy::float_cmp)]
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod bag;
mod broken;
pub(crate) mod carmen;
mod fiducials;
mod mcap_file;
mod recorded;
mod roles;
mod rosbags;
mod scans;
mod verified;
mod written;
