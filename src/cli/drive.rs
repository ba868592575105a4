//! `toposlam drive --ros URI`: a live SuperScout maps where it is. Sections 2.5 and 6.

#[cfg(feature = "ros1")]
mod live;
#[cfg(feature = "ros1")]
mod result;

use std::path::PathBuf;

use toposlam_robot::log::recorder::{CMD_VEL, IMAGE, ODOM};

use super::{Failure, Outcome, simulate::MAX_DARTS};

/// Let a live SuperScout map where it is by Algorithm 1, from what its camera sees
///
/// The robot stands at an L, its back to one of the two hallways, its marker on the floor along it. The
/// program reaches its base and its camera through topics of ROS 1: pictures are sensed, Algorithm 2
/// drives by them, and Algorithm 1 maps, as in a simulated run.
///
/// Whatever happens, the last that the wheels are told is that they stand: at the end, after an error,
/// where odometry or pictures do not come, after Ctrl-C. Nobody listens to the robot's sonars: keep its
/// own bumpers and its stop in reach.
#[derive(clap::Args)]
#[command(after_help = AFTER_HELP)]
#[cfg_attr(not(feature = "ros1"), allow(dead_code, reason = "there is no robot to drive"))]
pub(super) struct Arguments {
    /// The master of ROS 1, as in http://127.0.0.1:11311
    #[arg(long, value_name = "URI")]
    ros: String,
    /// The camera
    #[arg(long, value_name = "FILE")]
    calibration: PathBuf,
    /// The colours of the building, as `toposlam train` writes them
    #[arg(long, value_name = "FILE")]
    colours: PathBuf,
    /// The topic of pictures: sensor_msgs/CompressedImage
    #[arg(long, value_name = "TOPIC", default_value = IMAGE)]
    image_topic: String,
    /// The topic of odometry: nav_msgs/Odometry, stamped by the same clock as pictures
    #[arg(long, value_name = "TOPIC", default_value = ODOM)]
    odom_topic: String,
    /// The topic of what the wheels are told: geometry_msgs/Twist
    #[arg(long, value_name = "TOPIC", default_value = CMD_VEL)]
    cmd_vel_topic: String,
    /// Stop when nothing has come from the robot for so long, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 2.0, value_parser = patience)]
    patience: f64,
    /// The floor plan, where it is known: the log names it, and nothing is judged by it here
    #[arg(long, value_name = "FILE")]
    plan: Option<PathBuf>,
    /// Where the robot stands in the plan, and which door is behind it [default: the plan's own start]
    #[arg(long, value_name = "VERTEX:FACING", requires = "plan")]
    start: Option<String>,
    /// Give up when more edge ends are known
    #[arg(long, value_name = "N", default_value_t = MAX_DARTS)]
    max_darts: usize,
    /// Write a log of the run, .mcap: pictures, commands, odometry, scenes, percepts, the mapping
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
    /// Write the map: .toml, .json, .dot, or plantri's .ec
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Reads how long nothing may come.
fn patience(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| (0.1..=60.0).contains(seconds));
    seconds.ok_or_else(|| "write a number of seconds from 0.1 to 60".to_owned())
}

impl Arguments {
    #[cfg(not(feature = "ros1"))]
    #[expect(clippy::unused_self, reason = "with the feature it is used")]
    pub(super) fn run(self, _: &mut dyn std::io::Write) -> Result<Outcome, Failure> {
        Err(super::without_ros())
    }
}

/// Examples.
const AFTER_HELP: &str =
    "With --plan nothing is judged while the robot drives: toposlam conform judges the log.

This verb needs a program that was built with it: cargo build --release --features ros1

Examples:
  toposlam drive --ros http://robot:11311 --calibration camera.toml --colours colours.toml \\
      --log run.mcap --map map.toml
  toposlam simulate worlds/shape-6.toml --ros http://127.0.0.1:11311    a robot to try it with

Exit codes: 0 mapped, 1 the robot gave up, 2 bad usage or input, or there is no robot,
3 ended by Ctrl-C or at --max-darts.";
