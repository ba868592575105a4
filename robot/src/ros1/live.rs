//! A live robot behind the topics of a SuperScout. Section 2.5.

use std::time::Duration;

use super::{
    RobotTopics,
    base::LiveBase,
    messages::{Photograph, TWIST, read_odometry, read_picture},
    node::{Node, Subscription},
    wheels::Wheels,
};
use crate::{
    record::{CameraImage, Frame},
    robot::{Reckoned, Robot, RobotError, Sample},
    superscout::{Base, Drive, WheelReading},
};

/// A robot behind the topics of ROS 1.
///
/// It turns and drives with the same control loop as the simulated robot, within a SuperScout's
/// limits. After an error, and when it is dropped, the last command to its wheels is to stop.
///
/// Only images that were taken after the end of the last motion count. Odometry and images are
/// stamped by one clock.
// paper: hardware.ros
pub struct LiveRobot {
    // The fields are dropped in this order. The node is last, because the wheels are stopped
    // through it.
    base: LiveBase,
    pictures: Subscription<Photograph>,
    asked: u64,
    _node: Node,
}

impl LiveRobot {
    /// The robot behind these topics, as soon as odometry and an image have come.
    ///
    /// `patience` is the longest time without odometry, and without an image if one is expected. If
    /// `stop` returns true, the robot stops and does nothing more.
    ///
    /// # Errors
    /// Returns an error if there is no master or no robot.
    pub fn connect(
        topics: &RobotTopics,
        patience: Duration,
        stop: impl Fn() -> bool + 'static,
    ) -> Result<Self, RobotError> {
        let node = Node::new(&topics.master, "/toposlam")?;
        let odometry = node.subscribe(&topics.odometry, read_odometry)?;
        let pictures = node.subscribe(&topics.pictures, read_picture)?;
        let wheels = Wheels::new(node.advertise(&topics.wheels, TWIST)?, odometry.clone());
        let base = LiveBase::new(wheels, odometry, patience.max(FIRST), Box::new(stop))?;
        pictures.wait(patience.max(FIRST), base.stop(), |_| Some(()))?;
        let base = base.patient(patience);
        Ok(Self { base, pictures, asked: 0, _node: node })
    }

    /// The number of images that were requested.
    #[must_use]
    pub fn pictures(&self) -> u64 {
        self.asked
    }

    fn picture(&mut self) -> Result<Frame, RobotError> {
        let WheelReading { time: ended, odometry } = self.base.reading();
        let id = self.asked;
        let mut behind = None;
        let base = &self.base;
        let fresh = |photograph: Photograph| {
            let taken = base.seconds(photograph.stamp);
            behind = Some(ended - taken);
            let image = Some(CameraImage::encoded(photograph.file));
            (taken > ended).then_some(Frame { id, taken, odometry, image, ..Frame::default() })
        };
        let picture = self.pictures.wait(base.patience(), base.stop(), fresh);
        picture.map_err(|error| match (error, behind) {
            (RobotError::Silent { .. }, Some(behind)) => RobotError::StalePicture { behind },
            (RobotError::Silent { .. }, None) => RobotError::NoPicture,
            (error, _) => error,
        })
    }
}

/// The longest time until nodes have found each other.
const FIRST: Duration = Duration::from_secs(10);

impl Robot for LiveRobot {
    fn capture(&mut self) -> Result<Frame, RobotError> {
        self.asked += 1;
        let picture = self.picture();
        match &picture {
            Ok(_) => self.base.read(),
            Err(_) => self.base.halt(),
        }
        picture
    }

    fn turn(&mut self, angle: f64) -> Result<(), RobotError> {
        Drive(&mut self.base).turn(angle)
    }

    fn forward(&mut self, distance: f64) -> Result<(), RobotError> {
        Drive(&mut self.base).forward(distance)
    }

    fn odometry(&self) -> Reckoned {
        let reading = self.base.reading();
        Reckoned { time: reading.time, odometry: reading.odometry }
    }

    fn track(&self) -> &[Sample] {
        self.base.track()
    }
}
