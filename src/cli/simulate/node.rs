//! `toposlam simulate PLAN --ros URI`: another program drives the simulated robot through ROS 1 topics.

use std::io::Write;

use toposlam_model::enumerate::Watch;
use toposlam_robot::ros1::RobotTopics;
use toposlam_simulator::SimulatedRobot;
use toposlam_simulator::ros1::{ServeSummary, serve};

use super::{CliError, Outcome};
use crate::cli::{progress::Progress, text::grouped};

/// Serves the robot until Ctrl-C.
pub(super) fn run(
    robot: SimulatedRobot,
    master: &str,
    speed: f64,
    out: &mut dyn Write,
) -> Result<Outcome, CliError> {
    let progress = Progress::endless("serving", "images")?.hidden();
    let topics = RobotTopics::usual(master);
    let RobotTopics { wheels, odometry, images, scans, marker, .. } = &topics;
    writeln!(out, "A simulated robot at {master}. Ctrl-C ends it.")?;
    writeln!(out, "  subscribes to  {wheels}")?;
    writeln!(out, "  publishes      {odometry}, /tf, {images}, {scans}, {marker}")?;
    out.flush()?;
    let served = serve(robot, &topics, speed, || progress.stop());
    progress.finish();
    let ServeSummary { seconds, real_seconds, frames } =
        served.map_err(|error| CliError::at("--ros", error))?;
    writeln!(
        out,
        "{seconds:.0} s of simulated time in {real_seconds:.0} s ({:.1} times real time), \
         {} images ({:.1} a second)",
        seconds / real_seconds,
        grouped(frames.into()),
        frames as f64 / real_seconds
    )?;
    Ok(Outcome::Holds)
}
