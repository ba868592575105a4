//! The base of a live robot: wheels and odometry behind topics. Section 2.5.

use std::time::Duration;

use toposlam_model::driving::odometry::Odometry;

use super::{
    messages::{Nanoseconds, Reckoning, SECOND},
    node::Subscription,
    wheels::{Wheels, stands},
};
use crate::{
    robot::{Reckoned, RobotError, Sample},
    superscout::{Base, PERIOD, Reading, WheelSpeeds},
};

/// A command outlasts its period by about this, in seconds: odometry comes ten times a second, is on its
/// way as long as the command is, and the wheels follow by and by.
const LAG: f64 = 0.15;

/// A base behind topics. Wherever it fails it has been told to stand.
pub(super) struct LiveBase {
    wheels: Wheels,
    odometry: Subscription<Reckoning>,
    /// So long nothing may come.
    patience: Duration,
    /// Whether somebody ends the run.
    stop: Box<dyn Fn() -> bool>,
    /// When the robot's time begins.
    epoch: Nanoseconds,
    last: Reckoning,
    track: Vec<Sample>,
}

impl LiveBase {
    /// A base that stands, as soon as it tells where it is.
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

    /// Seconds of the robot's time; below 0 before its beginning.
    pub(super) fn seconds(&self, stamp: Nanoseconds) -> f64 {
        let since =
            |later: Nanoseconds, earlier: Nanoseconds| (later - earlier) as f64 / SECOND as f64;
        if stamp >= self.epoch { since(stamp, self.epoch) } else { -since(self.epoch, stamp) }
    }

    /// The same with another patience.
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

    /// Tells the wheels to stand: something is wrong.
    pub(super) fn halt(&self) {
        // What is wrong is what will be told.
        let _ = self.wheels.tell(WheelSpeeds::STOP);
    }

    /// Reads where the robot is now, if it tells.
    pub(super) fn read(&mut self) {
        if let Some(now) = self.odometry.take().filter(|now| now.stamp > self.last.stamp) {
            self.last = now;
            self.sample(WheelSpeeds::STOP);
        }
    }

    fn sample(&mut self, wheels: WheelSpeeds) {
        let Reading { time, odometry } = self.reading();
        let reckoned = Reckoned { time, odometry };
        let (speed, turning) = (wheels.speed(), wheels.turn_rate());
        self.track.push(Sample { speed, turning, reckoned });
    }

    /// Tells the wheels, and waits until the period is over; after a stop, until the robot stands.
    fn told(&mut self, wheels: WheelSpeeds) -> Result<(), RobotError> {
        if (self.stop)() {
            return Err(RobotError::Stopped);
        }
        // The period begins now, not when odometry was last read.
        let mut last = self.odometry.take().filter(|now| now.stamp > self.last.stamp);
        let begun = last.unwrap_or(self.last).stamp;
        self.wheels.tell(wheels)?;
        let over = begun + (PERIOD * SECOND as f64) as Nanoseconds;
        let mut moves = false;
        let stopping = wheels == WheelSpeeds::STOP;
        let arrived = |now: Reckoning| {
            // Odometry that goes back in time is no odometry.
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
    fn drive(&mut self, wheels: WheelSpeeds) -> Result<Reading, RobotError> {
        match self.told(wheels) {
            Ok(()) => Ok(self.reading()),
            Err(error) => {
                self.halt();
                Err(error)
            }
        }
    }

    fn reading(&self) -> Reading {
        let Reckoning { stamp, at, .. } = self.last;
        let Odometry { position, heading } = at;
        Reading { time: self.seconds(stamp), odometry: Odometry { position, heading } }
    }

    fn lag(&self) -> f64 {
        LAG
    }

    /// Nobody listens to its sonars.
    fn sonar(&self, _: usize) -> f64 {
        f64::INFINITY
    }
}
