//! What the wheels are told; the last of it is always that they stand.

use std::time::{Duration, Instant};

use super::{
    messages::{Reckoning, twist},
    node::{Publisher, Subscription},
};
use crate::{robot::RobotError, superscout::WheelSpeeds};

/// The wheels of a robot. Dropped, whatever happened, they are told to stand, until odometry tells that
/// they do, or for a second.
pub(super) struct Wheels {
    topic: Publisher,
    odometry: Subscription<Reckoning>,
}

/// They are told so long to stand, where odometry does not tell that they do;
const INSIST: Duration = Duration::from_secs(1);
/// as often as this.
const AGAIN: Duration = Duration::from_millis(50);
/// A robot stands that by odometry goes no farther than this from one reading to the next, in metres:
const STANDS: f64 = 0.002;
/// nor turns by more than this, in radians.
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

    /// Tells them to turn so.
    pub(super) fn tell(&self, wheels: WheelSpeeds) -> Result<(), RobotError> {
        self.topic.say(&twist(wheels))
    }

    /// Tells them to stand, and waits until they do.
    fn halt(&self) {
        let until = Instant::now() + INSIST;
        let mut last: Option<Reckoning> = None;
        while Instant::now() < until {
            // There is nobody left to tell that the connection is gone.
            let _ = self.tell(WheelSpeeds::STOP);
            let mut stood = |now: Reckoning| {
                let before = last.replace(now)?;
                stands(&before, &now).then_some(())
            };
            match self.odometry.wait(AGAIN, &|| false, &mut stood) {
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
