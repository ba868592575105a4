//! A SuperScout behind the topics of ROS 1, as its drivers name them: wheels that are told their speeds
//! on one, odometry on another, pictures on a third. Section 2.5.
//!
//! [`LiveRobot`] drives whatever answers on these topics; [`serve`] answers on them with a simulated
//! robot. Both are nodes of the same master, and know nothing else of each other.

mod base;
mod live;
mod messages;
mod node;
mod simulated;
mod wheels;

pub use live::LiveRobot;
pub use simulated::{MOST_SPEED, ServeSummary, serve};

use crate::log::recorder;

/// Where a robot is reached.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RobotTopics {
    /// The master's address, as in `http://127.0.0.1:11311`.
    pub master: String,
    /// The topic of its pictures, `sensor_msgs/CompressedImage`.
    pub pictures: String,
    /// The topic of its odometry, `nav_msgs/Odometry`.
    pub odometry: String,
    /// The topic of what its wheels are told, `geometry_msgs/Twist`.
    pub wheels: String,
}

impl RobotTopics {
    /// The topics that drivers use unless somebody says otherwise, as in a log, at a master.
    #[must_use]
    pub fn usual(master: &str) -> Self {
        Self {
            master: master.to_owned(),
            pictures: recorder::IMAGE.to_owned(),
            odometry: recorder::ODOM.to_owned(),
            wheels: recorder::CMD_VEL.to_owned(),
        }
    }
}
