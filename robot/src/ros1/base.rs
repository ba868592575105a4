//! The base of a live robot: wheels and odometry behind topics. Section 2.5.

use std::time::Duration;

use toposlam_model::driving::odometry::Odometry;

use super::{
    messages::{Nanoseconds, Reckoning, SECOND},
    node::Subscription,
    wheels::{Wheels, stands},
};
use crate::{
    robot::{RobotError, Sample, TimedOdometry},
    superscout::{Base, PERIOD, WheelReading, WheelSpeeds},
};

/// Delay of a command in seconds, in addition to its period: odometry comes ten times a second,
/// messages take time, and wheels respond gradually.
const LAG: f64 = 0.15;

/// A base behind topics. After any error the stop command has been sent to its wheels.
pub(super) struct LiveBase {
    wheels: Wheels,
    odometry: Subscription<Reckoning>,
    /// The longest time without a message.
    patience: Duration,
    /// Whether the run is to stop.
    stop: Box<dyn Fn() -> bool>,
    /// The time of the robot's time 0.
    epoch: Nanoseconds,
    last: Reckoning,
    track: Vec<Sample>,
}

impl LiveBase {
    /// A base at rest, as soon as odometry has come.
    pub(super) fn new(
        wheels: Wheels,
        odometry: Subscription<Reckoning>,
        patience: Duration,
        stop: Box<dyn Fn() -> bool>,
    ) -> Result<Self, RobotError> {
        let last = odometry.wait(patience, &stop, Some)?;
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

    /// The same base with another longest time without a message.
    pub(super) fn patient(self, patience: Duration) -> Self {
        Self { patience, ..self }
    }

    pub(super) fn patience(&self) -> Duration {
        self.patience
    }

    pub(super) fn stop(&self) -> &dyn Fn() -> bool {
        &self.stop
    }

    pub(super) fn track(&self) -> &[Sample] {
        &self.track
    }

    /// Stops the wheels after an error.
    pub(super) fn halt(&self) {
        // The first error is reported, not one of stopping.
        let _ = self.wheels.set(WheelSpeeds::STOP);
    }

    /// The present odometry, if it comes.
    pub(super) fn read(&mut self) {
        if let Some(now) = self.odometry.take().filter(|now| now.stamp > self.last.stamp) {
            self.last = now;
            self.sample(WheelSpeeds::STOP);
        }
    }

    fn sample(&mut self, wheels: WheelSpeeds) {
        let WheelReading { time, odometry } = self.reading();
        let reckoned = TimedOdometry { time, odometry };
        let (speed, turning) = (wheels.speed(), wheels.turn_rate());
        self.track.push(Sample { speed, turning, reckoned });
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
        self.wheels.set(wheels)?;
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
        let now = self.odometry.wait(self.patience, &self.stop, arrived);
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
    fn drive(&mut self, wheels: WheelSpeeds) -> Result<WheelReading, RobotError> {
        match self.command(wheels) {
            Ok(()) => Ok(self.reading()),
            Err(error) => {
                self.halt();
                Err(error)
            }
        }
    }

    fn reading(&self) -> WheelReading {
        let Reckoning { stamp, at, .. } = self.last;
        let Odometry { position, heading } = at;
        WheelReading { time: self.seconds(stamp), odometry: Odometry { position, heading } }
    }

    fn lag(&self) -> f64 {
        LAG
    }

    /// The live robot's sonars are not used.
    fn sonar(&self, _: usize) -> f64 {
        f64::INFINITY
    }
}
