//! A SuperScout behind the topics of ROS 1, with the usual names: one for wheel speeds, one for
//! odometry, one for images, or one for laser scans and one for the marker. Section 2.5.
//!
//! [`LiveRobot`] drives any robot behind these topics. `toposlam_simulator::ros1` is a simulated robot behind them.
//! Both are nodes of one master and have no other connection.

mod base;
mod definition;
mod live;
pub mod messages;
pub mod node;

pub use live::{LiveRobot, LiveSensor};

use toposlam_logs::recorder;

/// The address of the master, as in `http://127.0.0.1:11311`, and the topics of a robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RobotTopics {
    pub master: String,
    /// `sensor_msgs/CompressedImage`.
    pub images: String,
    /// Of a laser scanner in the robot's centre, `sensor_msgs/LaserScan`.
    pub scans: String,
    /// In the robot's frame, x along it, `geometry_msgs/PoseStamped`.
    pub marker: String,
    /// `nav_msgs/Odometry`.
    pub odometry: String,
    /// `geometry_msgs/Twist`.
    pub wheels: String,
}

impl RobotTopics {
    /// The usual topics, as in a log, at a master.
    pub fn usual(master: &str) -> Self {
        Self {
            master: master.to_owned(),
            images: recorder::IMAGE.to_owned(),
            scans: recorder::SCAN.to_owned(),
            marker: recorder::MARKER.to_owned(),
            odometry: recorder::ODOM.to_owned(),
            wheels: recorder::CMD_VEL.to_owned(),
        }
    }
}
