//! A live robot behind topics. Section 2.5.

use std::{any::Any, sync::Arc, time::Duration};

use toposlam_logs::{Mount, record::Frame};
use toposlam_model::driving::scene::MarkerView;

use super::{
    FIRST, Wheels,
    base::LiveBase,
    messages::{Nanoseconds, Reckoning, ScanReading, SentImage, Stamped},
    topic::Subscription,
};
use crate::{
    robot::{Robot, RobotError, Sample, TimedOdometry},
    superscout::{Base, Drive},
};

/// A robot behind the topics of ROS 1 or ROS 2.
///
/// It turns and drives with the same control loop as the simulated robot, within a SuperScout's
/// limits. After an error, and when it is dropped, the last command to its wheels is to stop.
///
/// Only images, scans and markers of a time after the end of the last motion count. All stamps are of one
/// clock.
// paper: hardware.ros
pub struct LiveRobot {
    // The fields are dropped in this order. The node is last, because the wheels are stopped
    // through it.
    base: LiveBase,
    sensor: SensorTopics,
    asked: u64,
    _node: Box<dyn Any>,
}

/// What a live robot senses with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LiveSensor {
    Camera,
    /// A laser scanner, and a detector of the marker.
    Laser,
}

pub(crate) enum SensorTopics {
    Camera(Subscription<Stamped<SentImage>>),
    Laser {
        scans: Subscription<Stamped<ScanReading>>,
        /// Where the scanner is on the robot.
        mount: Mount,
        markers: Subscription<Stamped<MarkerView>>,
    },
}

/// The topics of a robot, and the node to which they belong.
pub(crate) struct Connection {
    pub(crate) wheels: Box<dyn Wheels>,
    pub(crate) odometry: Subscription<Reckoning>,
    pub(crate) sensor: SensorTopics,
    pub(crate) node: Box<dyn Any>,
}

impl LiveRobot {
    /// The robot behind these topics, as soon as odometry and an image, or a scan, have come.
    ///
    /// `patience` is the longest time without odometry, and without an image if one is expected. If
    /// `stop` returns true, the robot stops and does nothing more.
    ///
    /// # Errors
    /// Returns an error if there is no robot.
    pub(crate) fn new(
        connection: Connection,
        patience: Duration,
        stop: fn() -> bool,
    ) -> Result<Self, RobotError> {
        let Connection { wheels, odometry, sensor, node } = connection;
        let first = patience.max(FIRST);
        let mut base = LiveBase::new(wheels, odometry, first, stop)?;
        match &sensor {
            SensorTopics::Camera(images) => images.wait(first, stop, |_| Some(()))?,
            SensorTopics::Laser { scans, .. } => scans.wait(first, stop, |_| Some(()))?,
        }
        base.patience = patience;
        Ok(Self { base, sensor, asked: 0, _node: node })
    }

    /// The number of images or scans that were requested.
    pub fn frames(&self) -> u64 {
        self.asked
    }

    fn frame(&mut self) -> Result<Frame, RobotError> {
        let TimedOdometry { time: ended, odometry } = self.base.reading();
        let id = self.asked;
        let mut behind = None;
        let base = &self.base;
        let mut is_fresh = |stamp: Nanoseconds| {
            let taken = base.seconds(stamp);
            behind = Some(ended - taken);
            (taken > ended).then_some(Frame { id, taken, odometry, ..Frame::default() })
        };
        let frame = match &self.sensor {
            SensorTopics::Camera(images) => {
                images.wait(base.patience, base.stop, |Stamped { stamp, content }| {
                    let fresh = is_fresh(stamp)?;
                    Some(Frame { image: Some(content.file()?), ..fresh })
                })
            }
            SensorTopics::Laser { scans, mount, markers } => {
                let scanned = scans.wait(base.patience, base.stop, |Stamped { stamp, content }| {
                    let fresh = is_fresh(stamp)?;
                    Some(Frame { scan: Some(Arc::new(content.scan(mount)?)), ..fresh })
                });
                // The marker is reported only where it is seen.
                scanned.and_then(|frame| {
                    let seen = |Stamped { stamp, content }| {
                        (base.seconds(stamp) > ended).then_some(content)
                    };
                    match markers.wait(MARKER_DELAY, base.stop, seen) {
                        Ok(marker) => Ok(Frame { marker: Some(marker), ..frame }),
                        Err(RobotError::Silent { .. }) => Ok(frame),
                        Err(error) => Err(error),
                    }
                })
            }
        };
        frame.map_err(|error| match (error, behind) {
            (RobotError::Silent { .. }, Some(behind)) => RobotError::StaleImage { behind },
            (RobotError::Silent { .. }, None) => RobotError::NoImage,
            (error, _) => error,
        })
    }
}

/// A marker that was seen with a scan is reported within this time after it.
const MARKER_DELAY: Duration = Duration::from_millis(250);

impl Robot for LiveRobot {
    fn capture(&mut self) -> Result<Frame, RobotError> {
        self.asked += 1;
        let frame = self.frame();
        match &frame {
            Ok(_) => self.base.read(),
            Err(_) => self.base.halt(),
        }
        frame
    }

    fn turn(&mut self, angle: f64) -> Result<(), RobotError> {
        Drive(&mut self.base).turn(angle)
    }

    fn forward(&mut self, distance: f64) -> Result<(), RobotError> {
        Drive(&mut self.base).forward(distance)
    }

    fn odometry(&self) -> TimedOdometry {
        self.base.reading()
    }

    fn track(&self) -> &[Sample] {
        &self.base.track
    }
}
