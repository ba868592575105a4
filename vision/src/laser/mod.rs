//! Sensing with a laser scanner: from scans and odometry to junctions with any number of arms at any angle.
//!
//! From the ground up:
//!
//! * [`params`]: what a user may change for a building;
//! * [`scan`]: one sweep of the scanner;
//! * `matching`: where it was taken, by odometry and by the walls of earlier scans, and [`scan_motion`]: without odometry;
//! * [`drift`]: how much the heading of odometry drifts;
//! * `grid`: the local map, of the cells where rays of the last scans have passed and ended;
//! * `clearances`: the distance of each cell to the nearest wall, and lines of sight;
//! * `ends`: where the ways around the robot go on unseen, and where they end;
//! * `skeleton`: their middle lines, the generalised Voronoi graph;
//! * `arm_view`: how far one sees along an arm, and beside which walls; `viewpoint`: where no scan looked;
//! * [`navigation`]: how a robot goes on along them, and where they meet near it;
//! * [`way_graph`]: its meet points and the arms that count, and `junctions`: junctions, corners and dead ends;
//! * [`local_map`]: all of these steps on one map;
//! * [`sensor`]: the views of a robot that drives, and [`pictures`] of them;
//! * [`scan_log`]: the views of a log, by all of its scans, of which `scan_choice` takes some, and by those of other `passes`.

#![allow(clippy::cast_possible_wrap, reason = "a map has far fewer cells")]

mod arm_view;
mod clearances;
pub mod drift;
mod ends;
mod grid;
mod junctions;
pub mod local_map;
mod matching;
pub mod navigation;
pub mod params;
mod passes;
pub mod pictures;
mod ray_counts;
pub mod scan;
mod scan_choice;
pub mod scan_log;
pub mod scan_motion;
pub mod sensor;
mod skeleton;
#[cfg(test)]
mod tests;
mod viewpoint;
pub mod way_graph;
