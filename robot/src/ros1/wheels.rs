//! Publishes wheel speeds. The last command is always to stop.

use std::time::{Duration, Instant};

use super::{
    messages::{Reckoning, twist},
    node::{Publisher, Subscription},
};
use crate::{robot::RobotError, superscout::WheelSpeeds};

/// The wheels of a robot. Dropping them repeats the stop command until odometry reports that they
/// stand, or for a second.
pub(super) struct Wheels {
    topic: Publisher,
    odometry: Subscription<Reckoning>,
}

/// The longest time in seconds for which the stop command is repeated,
const STOP_TIMEOUT: Duration = Duration::from_secs(1);
/// and its interval.
const REPEAT_INTERVAL: Duration = Duration::from_millis(50);
/// The greatest distance between two odometry readings of a robot that stands, in metres,
const STANDS: f64 = 0.002;
/// and the greatest turn, in radians.
const STANDS_ANGLE: f64 = 0.004;

/// Whether a robot stood between two readings.
pub(super) fn stands(before: &Reckoning, after: &Reckoning) -> bool {
    after.at.distance(&before.at) <= STANDS
        && before.at.seen(after.at.heading).abs() <= STANDS_ANGLE
}

impl Wheels {
    pub(super) fn new(topic: Publisher, odometry: Subscription<Reckoning>) -> Self {
        Self { topic, odometry }
    }

    /// Sets the wheel speeds.
    pub(super) fn set(&self, wheels: WheelSpeeds) -> Result<(), RobotError> {
        self.topic.publish(&twist(wheels))
    }

    /// Stops the wheels, and waits until the robot stands.
    fn halt(&self) {
        let until = Instant::now() + STOP_TIMEOUT;
        let mut last: Option<Reckoning> = None;
        while Instant::now() < until {
            // A closed connection cannot be reported here.
            let _ = self.set(WheelSpeeds::STOP);
            let mut stood = |now: Reckoning| {
                let before = last.replace(now)?;
                stands(&before, &now).then_some(())
            };
            match self.odometry.wait(REPEAT_INTERVAL, &|| false, &mut stood) {
                Ok(()) | Err(RobotError::Closed { .. }) => break,
                Err(_) => {}
            }
        }
    }
}

impl Drop for Wheels {
    fn drop(&mut self) {
        self.halt();
    }
}
