//! The SuperScout robot: live, simulated and recorded runs, their logs, and the checks of runs against
//! the specification. Sections 2.4, 2.5 and 4 to 6.

// Tests compare exact numbers.
#![cfg_attr(test, allow(clippy::float_cmp))]

pub mod budget;
pub mod conform;
pub mod earlier_walks;
pub mod evaluation;
pub mod explorer;
pub mod fuzz;
pub mod ground_truth_monitor;
pub mod log;
pub mod measured_hallway;
mod obstacle_judge;
pub mod record;
pub mod recording;
pub mod replay;
pub mod robot;
#[cfg(feature = "ros1")]
pub mod ros1;
pub mod run;
pub mod run_settings;
pub mod simulator;
pub mod superscout;
pub mod truth;
