//! A live robot behind topics. Section 2.5.

use std::{
    any::Any,
    time::{Duration, Instant},
};

use toposlam_logs::{is_robot_frame, record::Frame};
use toposlam_model::driving::scene::MarkerView;

use super::{
    FIRST, Wheels,
    base::LiveBase,
    messages::{MarkerReading, Nanoseconds, Reckoning, SentImage, Stamped},
    scanner::{ScanTopic, Scanner},
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
    messages: SensorMessages,
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
    Laser { scans: ScanTopic, markers: Subscription<Stamped<MarkerReading>> },
}

/// What is read of a sensor besides the scans, which belong to the base.
enum SensorMessages {
    Images(Subscription<Stamped<SentImage>>),
    Markers(Subscription<Stamped<MarkerReading>>),
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
        Self::within(patience.max(FIRST), connection, patience, stop)
    }

    /// The same if the first messages come within a time.
    pub(super) fn within(
        first: Duration,
        connection: Connection,
        patience: Duration,
        stop: fn() -> bool,
    ) -> Result<Self, RobotError> {
        let Connection { wheels, odometry, sensor, node } = connection;
        let (messages, scanner) = match sensor {
            SensorTopics::Camera(images) => (SensorMessages::Images(images), None),
            SensorTopics::Laser { scans, markers } => {
                (SensorMessages::Markers(markers), Some(Scanner::new(scans)))
            }
        };
        let mut base = LiveBase::new(wheels, odometry, scanner, first, stop)?;
        base.patience = patience;
        if let SensorMessages::Images(images) = &messages {
            wait_for_image(&base, images, first)?;
        }
        if let Some(mut scanner) = base.scanner.take() {
            scanner.wait(first, stop, |topic, stamp| base.check_clock(topic, stamp), Some)?;
            base.scanner = Some(scanner);
        }
        Ok(Self { base, messages, asked: 0, _node: node })
    }

    /// The number of images or scans that were requested.
    pub fn frames(&self) -> u64 {
        self.asked
    }

    fn frame(&mut self) -> Result<Frame, RobotError> {
        let asked = Instant::now();
        let TimedOdometry { time: ended, odometry } = self.base.reading();
        let (id, patience, stop) = (self.asked, self.base.patience, self.base.stop);
        let mut behind = None;
        let mut scanner = self.base.scanner.take();
        let base = &self.base;
        let mut is_fresh = |stamp: Nanoseconds| {
            let taken = base.seconds(stamp);
            behind = Some(ended - taken);
            (taken > ended).then_some(Frame { id, taken, odometry, ..Frame::default() })
        };
        let frame = match (&self.messages, &mut scanner) {
            (SensorMessages::Images(images), _) => {
                images.wait(patience, stop, |Stamped { stamp, content }| {
                    let fresh = is_fresh(stamp)?;
                    Some(Frame { image: Some(content.file()?), ..fresh })
                })
            }
            (SensorMessages::Markers(markers), Some(scanner)) => {
                let check_clock = |topic: &str, stamp| base.check_clock(topic, stamp);
                let scanned = scanner.wait(patience, stop, check_clock, &mut is_fresh);
                scanned.and_then(|(frame, scan)| {
                    let marker = seen_marker(base, markers, asked, ended, frame.taken)?;
                    Ok(Frame { scan: Some(scan), marker, ..frame })
                })
            }
            (SensorMessages::Markers(_), None) => Err(RobotError::NoImage),
        };
        self.base.scanner = scanner;
        if frame.is_err() {
            // A robot that is gone sends nothing at all.
            self.base.check_odometry()?;
        }
        frame.map_err(|error| match (error, behind) {
            (RobotError::Silent { .. }, Some(behind)) => RobotError::StaleImage { behind },
            (RobotError::Silent { .. }, None) => RobotError::NoImage,
            (error, _) => error,
        })
    }
}

/// Waits for an image with a stamp of the clock of odometry.
fn wait_for_image(
    base: &LiveBase,
    images: &Subscription<Stamped<SentImage>>,
    patience: Duration,
) -> Result<(), RobotError> {
    let mut fault = None;
    let found = images.wait(patience, base.stop, |image| {
        fault = base.check_clock(images.topic(), image.stamp).err();
        fault.is_none().then_some(())
    });
    found.map_err(|error| match (error, fault) {
        (RobotError::Silent { .. }, Some(fault)) => fault,
        (error, _) => error,
    })
}

/// The marker, if it is reported with the scan of this time, after the end of the last motion. It is reported only where
/// it is seen, so that the stamps of odometry show when it is too late.
///
/// # Errors
/// Returns an error if messages come that do not show where the marker is: that it is not seen is not known then.
fn seen_marker(
    base: &LiveBase,
    markers: &Subscription<Stamped<MarkerReading>>,
    asked: Instant,
    ended: f64,
    taken: f64,
) -> Result<Option<MarkerView>, RobotError> {
    let until = Instant::now() + MARKER_DELAY;
    let mut fault = None;
    loop {
        // Both are looked up before the marker.
        let is_late = Instant::now() >= until
            || base.seconds(base.stamp()) > taken + MARKER_DELAY.as_secs_f64();
        let patience = if is_late { Duration::ZERO } else { LOOK };
        let found = markers.wait_timed(patience, base.stop, |message, arrived| {
            match marker_after(base, markers.topic(), ended, message) {
                Ok(marker) => marker.map(Ok),
                Err(other @ RobotError::OtherFrame { .. }) => Some(Err(other)),
                Err(other) => {
                    // A message that came before the last motion has an old stamp.
                    fault = (arrived >= asked).then_some(other);
                    None
                }
            }
        });
        match found {
            Ok(marker) => return marker.map(Some),
            Err(RobotError::Silent { .. }) if is_late => break,
            Err(RobotError::Silent { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    markers.check_readable()?;
    fault.map_or(Ok(None), Err)
}

/// The marker of a message, if it was seen after this time.
///
/// # Errors
/// Returns an error if it is not in the robot's frame, or its stamp is of another clock.
fn marker_after(
    base: &LiveBase,
    topic: &str,
    ended: f64,
    Stamped { stamp, content }: Stamped<MarkerReading>,
) -> Result<Option<MarkerView>, RobotError> {
    let MarkerReading { frame, marker } = content;
    if !is_robot_frame(&frame) {
        let ours = "that of the robot: base_link, base_footprint or base".to_owned();
        return Err(RobotError::OtherFrame { topic: topic.to_owned(), theirs: frame, ours });
    }
    base.check_clock(topic, stamp)?;
    Ok((base.seconds(stamp) > ended).then_some(marker))
}

/// Interval of looks at odometry while a marker may come.
const LOOK: Duration = Duration::from_millis(2);
/// A marker that was seen with a scan is reported within this time after it, by the clock of the robot.
const MARKER_DELAY: Duration = Duration::from_millis(250);

impl Robot for LiveRobot {
    fn capture(&mut self) -> Result<Frame, RobotError> {
        self.asked += 1;
        let frame = self.frame();
        let read = frame.and_then(|frame| self.base.read().map(|()| frame));
        self.base.or_halt(read)
    }

    fn turn(&mut self, angle: f64) -> Result<(), RobotError> {
        Drive(&mut self.base).turn(angle)
    }

    fn forward(&mut self, distance: f64) -> Result<(), RobotError> {
        if let Some(scanner) = &self.base.scanner {
            self.base.or_halt(scanner.check_view())?;
        }
        Drive(&mut self.base).forward(distance)
    }

    fn odometry(&self) -> TimedOdometry {
        self.base.reading()
    }

    fn track(&self) -> &[Sample] {
        &self.base.track
    }
}
