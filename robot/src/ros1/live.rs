//! A live robot: whatever answers on the topics of a SuperScout. Section 2.5.

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
    superscout::{Base, Drive, Reading},
};

/// A robot behind the topics of ROS 1.
///
/// It turns and goes ahead by the same control loop as the simulated one, within a SuperScout's limits.
/// Wherever it fails, and wherever it is dropped, the last that its wheels are told is that they stand.
///
/// A picture counts that was taken after the end of the last motion. Odometry and pictures are stamped by
/// one clock.
// paper: hardware.ros
pub struct LiveRobot {
    // Dropped in this order: the node last, for the wheels are told through it to stand.
    base: LiveBase,
    pictures: Subscription<Photograph>,
    asked: u64,
    _node: Node,
}

impl LiveRobot {
    /// The robot behind these topics, as soon as odometry and a picture have come.
    ///
    /// No more than so many seconds may pass without odometry, or without a picture where one is waited
    /// for. As soon as `stop` says so, it stands, and does nothing any more.
    ///
    /// # Errors
    /// Where there is no master, or no robot.
    pub fn connect(
        topics: &RobotTopics,
        patience: Duration,
        stop: impl Fn() -> bool + 'static,
    ) -> Result<Self, RobotError> {
        let node = Node::new(&topics.master, "/toposlam")?;
        let odometry = node.listen(&topics.odometry, read_odometry)?;
        let pictures = node.listen(&topics.pictures, read_picture)?;
        let wheels = Wheels::new(node.speak(&topics.wheels, TWIST)?, odometry.clone());
        let base = LiveBase::new(wheels, odometry, patience.max(FIRST), Box::new(stop))?;
        pictures.wait(patience.max(FIRST), base.stop(), |_| Some(()))?;
        let base = base.patient(patience);
        Ok(Self { base, pictures, asked: 0, _node: node })
    }

    /// How many pictures it was asked for.
    #[must_use]
    pub fn pictures(&self) -> u64 {
        self.asked
    }

    fn picture(&mut self) -> Result<Frame, RobotError> {
        let Reading { time: ended, odometry } = self.base.reading();
        let id = self.asked;
        let mut behind = None;
        let base = &self.base;
        let fresh = |photograph: Photograph| {
            let taken = base.seconds(photograph.stamp);
            behind = Some(ended - taken);
            let image = Some(CameraImage::encoded(photograph.file));
            (taken > ended).then_some(Frame { id, taken, odometry, image, scene: None })
        };
        let picture = self.pictures.wait(base.patience(), base.stop(), fresh);
        picture.map_err(|error| match (error, behind) {
            (RobotError::Silent { .. }, Some(behind)) => RobotError::StalePicture { behind },
            (RobotError::Silent { .. }, None) => RobotError::NoPicture,
            (error, _) => error,
        })
    }
}

/// Nodes find each other within this.
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
