//! `toposlam simulate PLAN --ros URI`: the simulated robot is driven through topics of ROS 1, by
//! `toposlam drive` or by anybody else.

use std::io::Write;

use toposlam_model::enumerate::Watch;
use toposlam_robot::{
    ros1::{RobotTopics, ServeSummary, serve},
    simulator::SimulatedRobot,
};

use super::{Failure, Outcome};
use crate::cli::progress::Progress;

/// Lets the robot be driven until Ctrl-C.
pub(super) fn run(
    robot: SimulatedRobot,
    master: &str,
    speed: f64,
    out: &mut dyn Write,
) -> Result<Outcome, Failure> {
    let progress = Progress::endless("serving", "pictures")?.hidden();
    let topics = RobotTopics::usual(master);
    let RobotTopics { wheels, odometry, pictures, .. } = &topics;
    writeln!(out, "A robot at {master}: {wheels} in, {odometry}, /tf and {pictures} out.")?;
    writeln!(out, "Ctrl-C ends it.")?;
    out.flush()?;
    let served = serve(robot, &topics, speed, || progress.stop());
    progress.finish();
    let ServeSummary { seconds, real_seconds, pictures } =
        served.map_err(|error| Failure::at("--ros", error))?;
    writeln!(
        out,
        "{seconds:.0} s of simulated time in {real_seconds:.0} s: {:.1} times as fast; \
         {pictures} pictures, {:.1} a second",
        seconds / real_seconds,
        pictures as f64 / real_seconds
    )?;
    Ok(Outcome::Holds)
}
