//! The base of a live robot: wheels and odometry behind topics. Section 2.5.

use std::time::{Duration, Instant};

use super::{
    messages::{Nanoseconds, Reckoning, SECOND, twist},
    node::{Publisher, Subscription},
};
use crate::{
    robot::{RobotError, Sample, TimedOdometry},
    superscout::{Base, PERIOD, WheelSpeeds},
};

/// Delay of a command in seconds, in addition to its period: odometry comes ten times a second,
/// messages take time, and wheels respond gradually.
const LAG: f64 = 0.15;

/// The longest time for which the stop command is repeated at the end,
const STOP_TIMEOUT: Duration = Duration::from_secs(1);
/// and its interval.
const REPEAT_INTERVAL: Duration = Duration::from_millis(50);
/// The greatest distance between two odometry readings of a robot that stands, in metres,
const STANDS: f64 = 0.002;
/// and the greatest turn, in radians.
const STANDS_ANGLE: f64 = 0.004;

/// Whether a robot stood between two readings.
fn stands(before: &Reckoning, after: &Reckoning) -> bool {
    after.at.distance(&before.at) <= STANDS
        && before.at.seen(after.at.heading).abs() <= STANDS_ANGLE
}

/// A base behind topics. After any error the stop command has been sent to its wheels. Dropping it repeats the stop
/// command until odometry reports that the robot stands, or for a second.
pub(super) struct LiveBase {
    wheels: Publisher,
    odometry: Subscription<Reckoning>,
    /// The longest time without a message.
    pub(super) patience: Duration,
    /// Whether the run is to stop.
    pub(super) stop: fn() -> bool,
    /// The time of the robot's time 0.
    epoch: Nanoseconds,
    last: Reckoning,
    pub(super) track: Vec<Sample>,
}

impl LiveBase {
    /// A base at rest, as soon as odometry has come.
    pub(super) fn new(
        wheels: Publisher,
        odometry: Subscription<Reckoning>,
        patience: Duration,
        stop: fn() -> bool,
    ) -> Result<Self, RobotError> {
        let last = odometry.wait(patience, stop, Some)?;
        let epoch = last.stamp;
        let mut base = Self { wheels, odometry, patience, stop, epoch, last, track: Vec::new() };
        base.sample(WheelSpeeds::STOP);
        Ok(base)
    }

    /// The robot's time in seconds; negative before its time 0.
    pub(super) fn seconds(&self, stamp: Nanoseconds) -> f64 {
        let since =
            |later: Nanoseconds, earlier: Nanoseconds| (later - earlier) as f64 / SECOND as f64;
        if stamp >= self.epoch { since(stamp, self.epoch) } else { -since(self.epoch, stamp) }
    }

    /// Stops the wheels after an error.
    pub(super) fn halt(&self) {
        // The first error is reported, not one of stopping.
        let _ = self.wheels.publish(&twist(WheelSpeeds::STOP));
    }

    /// The present odometry, if it comes.
    pub(super) fn read(&mut self) {
        if let Some(now) = self.odometry.take().filter(|now| now.stamp > self.last.stamp) {
            self.last = now;
            self.sample(WheelSpeeds::STOP);
        }
    }

    fn sample(&mut self, wheels: WheelSpeeds) {
        let (speed, turning) = (wheels.speed(), wheels.turn_rate());
        self.track.push(Sample { speed, turning, reading: self.reading() });
    }

    /// Sets the wheel speeds and waits until the period is over; after a stop, until the robot
    /// stands.
    fn command(&mut self, wheels: WheelSpeeds) -> Result<(), RobotError> {
        if (self.stop)() {
            return Err(RobotError::Stopped);
        }
        // The period begins now, not at the last odometry.
        let mut last = self.odometry.take().filter(|now| now.stamp > self.last.stamp);
        let begun = last.unwrap_or(self.last).stamp;
        self.wheels.publish(&twist(wheels))?;
        let over = begun + (PERIOD * SECOND as f64) as Nanoseconds;
        let mut moves = false;
        let stopping = wheels == WheelSpeeds::STOP;
        let arrived = |now: Reckoning| {
            // Ignore odometry that goes back in time.
            let before = last.filter(|before| before.stamp < now.stamp);
            let stood = before.is_some_and(|before| stands(&before, &now));
            if now.stamp > begun {
                last = Some(now);
            }
            moves = stopping && now.stamp >= over && !stood;
            (now.stamp >= over && (!stopping || stood)).then_some(now)
        };
        let now = self.odometry.wait(self.patience, self.stop, arrived);
        let seconds = self.patience.as_secs_f64();
        self.last = now.map_err(|error| match error {
            RobotError::Silent { .. } if moves => RobotError::StillMoving { seconds },
            error => error,
        })?;
        self.sample(wheels);
        Ok(())
    }
}

impl Base for LiveBase {
    fn drive(&mut self, wheels: WheelSpeeds) -> Result<TimedOdometry, RobotError> {
        match self.command(wheels) {
            Ok(()) => Ok(self.reading()),
            Err(error) => {
                self.halt();
                Err(error)
            }
        }
    }

    fn reading(&self) -> TimedOdometry {
        TimedOdometry { time: self.seconds(self.last.stamp), odometry: self.last.at }
    }

    fn lag(&self) -> f64 {
        LAG
    }

    /// The live robot's sonars are not used.
    fn sonar(&self, _: usize) -> f64 {
        f64::INFINITY
    }
}

impl Drop for LiveBase {
    fn drop(&mut self) {
        let until = Instant::now() + STOP_TIMEOUT;
        let mut last: Option<Reckoning> = None;
        while Instant::now() < until {
            self.halt();
            let stood = |now: Reckoning| {
                let before = last.replace(now)?;
                stands(&before, &now).then_some(())
            };
            match self.odometry.wait(REPEAT_INTERVAL, || false, stood) {
                Ok(()) | Err(RobotError::Closed { .. }) => break,
                Err(_) => {}
            }
        }
    }
}
