//! A SuperScout behind the topics of ROS 1. Section 2.5. The robot and its driver are nodes of one master.

mod definition;
mod messages;
mod node;

use std::time::Duration;

use toposlam_logs::{
    Mount, recorder,
    standard::{
        CompressedImage, FileBytes, LaserScanMessage, OdometryMessage, PoseStamped, TFMessage,
        Twist,
    },
};
use toposlam_model::driving::scene::MarkerView;
use toposlam_vision::laser::scan::Scan;

use self::node::{Node, Publisher};
use crate::{
    live::{
        Connection, LiveRobot, LiveSensor, Nanoseconds, Reckoning, RobotTopics, ScanTopic,
        SensorTopics, ServedRobot, Wheels, topic::Subscription,
    },
    robot::RobotError,
    superscout::WheelSpeeds,
};

/// The robot behind topics at a master, as in `http://127.0.0.1:11311`, as soon as odometry and an image, or a scan, have
/// come. A scanner is in its centre.
///
/// `patience` is the longest time without odometry, and without an image if one is expected. If
/// `stop` returns true, the robot stops and does nothing more.
///
/// # Errors
/// Returns an error if there is no master or no robot.
pub fn connect(
    master: &str,
    topics: &RobotTopics,
    sensor: LiveSensor,
    patience: Duration,
    stop: fn() -> bool,
) -> Result<LiveRobot, RobotError> {
    let node = Node::new(master, "/toposlam")?;
    let odometry = node.subscribe(&topics.odometry, messages::read_odometry)?;
    let sensor = match sensor {
        LiveSensor::Camera => {
            SensorTopics::Camera(node.subscribe(&topics.images, messages::read_image)?)
        }
        LiveSensor::Laser => SensorTopics::Laser {
            scans: ScanTopic {
                scans: node.subscribe(&topics.scans, messages::read_scan)?,
                frame: None,
                mount: Mount::centre(),
            },
            markers: node.subscribe(&topics.marker, messages::read_marker)?,
        },
    };
    let wheels = Box::new(node.advertise::<Twist>(&topics.wheels)?);
    let connection = Connection { wheels, odometry, sensor, node: Box::new(node) };
    LiveRobot::new(connection, patience, stop)
}

impl Wheels for Publisher {
    fn command(&self, wheels: WheelSpeeds) -> Result<bool, RobotError> {
        self.publish(&messages::twist(wheels)).map(|()| true)
    }
}

/// The topics of a simulated robot at a master.
pub struct MasterTopics {
    commands: Subscription<WheelSpeeds>,
    odometry: Publisher,
    frames: Publisher,
    images: Publisher,
    scans: Publisher,
    markers: Publisher,
    // The last field: it is dropped after its publishers.
    _node: Node,
}

impl MasterTopics {
    /// # Errors
    /// Returns an error if there is no master.
    pub fn new(master: &str, topics: &RobotTopics) -> Result<Self, RobotError> {
        let node = Node::new(master, "/toposlam_simulator")?;
        Ok(Self {
            commands: node.subscribe(&topics.wheels, messages::read_twist)?,
            odometry: node.advertise::<OdometryMessage>(&topics.odometry)?,
            frames: node.advertise::<TFMessage>(recorder::TF)?,
            images: node.advertise::<CompressedImage<FileBytes>>(&topics.images)?,
            scans: node.advertise::<LaserScanMessage<&[f32]>>(&topics.scans)?,
            markers: node.advertise::<PoseStamped>(&topics.marker)?,
            _node: node,
        })
    }
}

impl ServedRobot for MasterTopics {
    fn command(&self) -> Option<WheelSpeeds> {
        self.commands.take()
    }

    fn odometry(&self, number: u32, reckoning: &Reckoning) -> Result<(), RobotError> {
        self.odometry.publish(&messages::odometry(number, reckoning))?;
        self.frames.publish(&messages::frames(number, reckoning))
    }

    fn image(&self, number: u32, stamp: Nanoseconds, file: &[u8]) -> Result<(), RobotError> {
        self.images.publish(&messages::image(number, stamp, file))
    }

    fn scan(&self, number: u32, stamp: Nanoseconds, scan: &Scan) -> Result<(), RobotError> {
        self.scans.publish(&messages::scan(number, stamp, scan))
    }

    fn marker(&self, number: u32, stamp: Nanoseconds, seen: &MarkerView) -> Result<(), RobotError> {
        self.markers.publish(&messages::marker(number, stamp, seen))
    }
}
