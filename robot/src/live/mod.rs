//! A live robot behind the topics of a SuperScout's drivers: one for wheel speeds, one for odometry, one for images, or one
//! for laser scans and one for the marker. Section 2.5. What [`ros1`](crate::ros1) and [`ros2`](crate::ros2) share.
//!
//! [`LiveRobot`] drives any robot behind these topics. A [`ServedRobot`] is the other side of them: the simulated robot.
//! They have no other connection.

mod base;
#[cfg(test)]
mod message_tests;
pub(crate) mod messages;
#[cfg(test)]
mod motion_tests;
mod response;
mod robot;
mod scanner;
mod stamps;
pub(crate) mod topic;

use std::time::Duration;

use toposlam_logs::recorder;
use toposlam_model::driving::scene::MarkerView;
use toposlam_vision::laser::scan::Scan;

use crate::{robot::RobotError, superscout::WheelSpeeds};

pub use messages::{Nanoseconds, Reckoning, SECOND};
pub(crate) use robot::{Connection, SensorTopics};
pub use robot::{LiveRobot, LiveSensor};
pub(crate) use scanner::ScanTopic;

/// The longest time until nodes have found each other.
pub(crate) const FIRST: Duration = Duration::from_secs(10);

/// The topics of a robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RobotTopics {
    /// `sensor_msgs/CompressedImage`.
    pub images: String,
    /// Of a laser scanner, `sensor_msgs/LaserScan`.
    pub scans: String,
    /// In the robot's frame, x along it, `geometry_msgs/PoseStamped`.
    pub marker: String,
    /// `nav_msgs/Odometry`.
    pub odometry: String,
    /// `geometry_msgs/Twist`; in ROS 2 also `TwistStamped`.
    pub wheels: String,
}

impl Default for RobotTopics {
    /// The usual topics, as in a log.
    fn default() -> Self {
        Self {
            images: recorder::IMAGE.to_owned(),
            scans: recorder::SCAN.to_owned(),
            marker: recorder::MARKER.to_owned(),
            odometry: recorder::ODOM.to_owned(),
            wheels: recorder::CMD_VEL.to_owned(),
        }
    }
}

/// The topic of the commands to the wheels.
pub(crate) trait Wheels {
    /// Waits until the wheels may move. Whether a pause stopped them since the last call.
    fn wait(&self) -> Result<bool, RobotError> {
        Ok(false)
    }

    /// Whether a pause stopped the wheels since the last [`wait`](Self::wait).
    fn is_interrupted(&self) -> bool {
        false
    }

    /// Sends a command, and returns whether it did. A pause stops the wheels: until the next [`wait`](Self::wait), only a
    /// stop is sent.
    fn command(&self, wheels: WheelSpeeds) -> Result<bool, RobotError>;
}

/// A simulated robot behind topics. Messages with a header are numbered.
#[expect(clippy::missing_errors_doc, reason = "an error means that the connection is lost")]
pub trait ServedRobot {
    /// The last command to the wheels, if it was not taken yet.
    fn command(&self) -> Option<WheelSpeeds>;

    /// Publishes odometry, and the transform from its frame to the robot.
    fn odometry(&self, number: u32, reckoning: &Reckoning) -> Result<(), RobotError>;

    /// Publishes the file of an image.
    fn image(&self, number: u32, stamp: Nanoseconds, file: &[u8]) -> Result<(), RobotError>;

    fn scan(&self, number: u32, stamp: Nanoseconds, scan: &Scan) -> Result<(), RobotError>;

    /// Publishes the marker's pose in the robot's frame.
    fn marker(&self, number: u32, stamp: Nanoseconds, seen: &MarkerView) -> Result<(), RobotError>;
}
