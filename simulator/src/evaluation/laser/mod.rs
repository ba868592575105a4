//! Compares junctions that are sensed with a laser scanner with the truth, in random buildings.

mod corridor_robot;
pub mod corridor_world;
pub mod judged_log;
pub mod judged_walk;
pub mod laser_report;
pub mod scanned_run;
pub mod walk;
