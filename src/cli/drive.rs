//! `toposlam drive`: a live robot maps its building. Sections 2.5 and 6.

#[cfg(any(feature = "ros1", feature = "ros2"))]
mod live;

use std::{path::PathBuf, time::Duration};

use toposlam_logs::recorder::{CMD_VEL, IMAGE, MARKER, ODOM, SCAN};

use super::{
    CliError, Outcome,
    exit_codes::help_end,
    laser_options::LaserOptions,
    robot_sensor::{SensorChoice, one_sensor},
    ros_options::RosOptions,
    run_options::{GivenOptions, RunOptions},
};

/// Let a live robot map its building by its camera or its laser scanner
///
/// The robot stands at an L, with its back to one of the two hallways and its marker on the floor along
/// it. The program reads the camera and the odometry and commands the wheels through the topics of ROS 1 or
/// ROS 2. It maps as in a simulated run.
///
/// With --sensor laser it reads a laser scanner. In ROS 2, its place on the robot is read from /tf_static; in ROS 1,
/// it is in the robot's centre and looks ahead. A scanner does not see the marker: another detector must publish the
/// marker's pose in the robot's frame, x along the marker.
///
/// With --corridors a junction is where at least three ways meet that lead on for 10 m or more; dead ends are vertices, and
/// bends are not. The robot stands in a corridor, some metres from its first junction, and looks there; its marker is on
/// the floor before that junction. It drives into ways that it does not see far enough.
///
/// With --recover the robot goes on after a contradiction, and if it gets lost. A hallway that it cannot pass
/// is a dead end: it maps everything else, and reports the doors that are blocked.
///
/// The last command to the wheels is always a stop: at the end, after an error, if odometry or images
/// do not come, and after Ctrl-C. The sonars are not used. Keep the robot's bumpers on and its stop
/// button in reach.
#[derive(clap::Args)]
#[command(
    override_usage = "\
toposlam drive [OPTIONS] <--ros2|--ros <URI>> --calibration <FILE>
                      --colours <FILE>
       toposlam drive [OPTIONS] <--ros2|--ros <URI>> --sensor laser",
    after_help = help_end(
        &notes(),
        &[
            (0, "the building is mapped"),
            (1, "the robot gave up"),
            (2, "bad usage or input, or there is no robot"),
            (3, "ended by Ctrl-C or at the darts of --budget, or a door is blocked"),
        ],
    )
)]
#[command(group(clap::ArgGroup::new("robot").args(["ros", "ros2"]).required(true)))]
#[cfg_attr(
    not(any(feature = "ros1", feature = "ros2")),
    allow(dead_code, reason = "there is no robot to drive")
)]
pub(super) struct DriveArguments {
    #[command(flatten)]
    given: GivenOptions,
    /// The sensor by which the robot drives: camera or laser
    #[arg(long, value_name = "SENSOR", default_value = "camera", value_parser = one_sensor())]
    sensor: SensorChoice,
    /// With --sensor laser: the building is a network of corridors, at any angle and 10 m or longer, and not one of short
    /// hallways at right angles
    #[arg(long)]
    corridors: bool,
    #[command(flatten)]
    laser: LaserOptions,
    /// The camera
    #[arg(long, value_name = "FILE")]
    calibration: Option<PathBuf>,
    /// The colours of the building, as `toposlam camera train` writes them
    #[arg(long, value_name = "FILE")]
    colours: Option<PathBuf>,
    /// Use another topic (repeatable); the topics are listed below
    #[arg(long, value_name = "WHAT=TOPIC", value_parser = topic)]
    topic: Vec<(&'static str, String)>,
    /// Stop if the robot sends nothing for this long, in seconds
    #[arg(long, value_name = "SECONDS", default_value = "2", value_parser = patience)]
    patience: Duration,
    #[command(flatten)]
    options: RunOptions,
    #[command(flatten)]
    ros: RosOptions,
    /// With --ros2: stamp commands by the topic /clock, as with the parameter use_sim_time
    #[arg(long, help_heading = "ROS", requires = "ros2")]
    sim_time: bool,
}

/// What each topic carries, its usual name and its type.
const TOPICS: [(&str, &str, &str); 5] = [
    ("images", IMAGE, "sensor_msgs/CompressedImage, in ROS 2 also Image"),
    ("scans", SCAN, "sensor_msgs/LaserScan, with --sensor laser"),
    ("marker", MARKER, "geometry_msgs/PoseStamped, with --sensor laser"),
    ("odometry", ODOM, "nav_msgs/Odometry, by the clock of the images"),
    ("wheels", CMD_VEL, "geometry_msgs/Twist or TwistStamped, to the robot"),
];

/// Parses what a topic carries, and its name.
fn topic(text: &str) -> Result<(&'static str, String), String> {
    let known = text.split_once('=').and_then(|(what, name)| {
        let (what, ..) = TOPICS.iter().find(|(known, ..)| *known == what)?;
        Some((*what, name.to_owned()))
    });
    let names = TOPICS.map(|(what, ..)| what).join(", ");
    known.ok_or_else(|| format!("write WHAT=TOPIC, as in images=/camera; WHAT is one of {names}"))
}

/// Parses the time without messages.
fn patience(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().filter(|seconds| (0.1..=60.0).contains(seconds));
    let cause = || "expected a number of seconds from 0.1 to 60".to_owned();
    seconds.map(Duration::from_secs_f64).ok_or_else(cause)
}

impl DriveArguments {
    #[cfg(not(any(feature = "ros1", feature = "ros2")))]
    pub(super) fn run(self, _: &mut dyn std::io::Write) -> Result<Outcome, CliError> {
        Err(self.ros.missing())
    }
}

/// Notes and examples.
fn notes() -> String {
    let topics =
        TOPICS.map(|(what, topic, kind)| format!("  {what:<9} {topic:<26}  {kind}\n")).concat();
    format!("Topics:\n{topics}\n{NOTES}")
}

const NOTES: &str =
    "With --ros2 the run publishes /toposlam/map, /toposlam/markers and /toposlam/state, and
the services /toposlam/pause, resume and abort (std_srvs/Trigger) make the robot wait, go on
or stop. A bumper or a cliff sensor of a known type ends the run.

The run is not checked while the robot drives. Check its log with toposlam conform.

This command needs a build with ROS: cargo build --release --features ros2
(or ros1, or both).

Examples:
  toposlam drive --ros http://robot:11311 --calibration camera.toml \\
    --colours colours.toml --log run.mcap --map map.toml
  toposlam drive --ros2 --network --sensor laser --corridors --recover --log run.mcap

A simulated robot:
  toposlam simulate worlds/shape-6.toml --ros2 --sensor laser";
