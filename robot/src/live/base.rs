//! The base of a live robot: wheels and odometry behind topics. Section 2.5.

use std::time::{Duration, Instant};

use super::{
    Wheels,
    messages::{Nanoseconds, Reckoning, SECOND},
    topic::Subscription,
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
/// The greatest distance between odometry readings of a robot that stands, in metres,
const STANDS: f64 = 0.002;
/// and the greatest turn, in radians,
const STANDS_ANGLE: f64 = 0.004;
/// in all of this time: two readings in a row may be a few milliseconds apart.
const STANDS_TIME: Nanoseconds = SECOND / 10;

/// Finds out from readings whether a robot stands.
#[derive(Default)]
struct Standing {
    /// The first reading at this place, and the time of the last one.
    since: Option<(Reckoning, Nanoseconds)>,
}

impl Standing {
    /// Whether a robot stands at a reading. One that goes back in time says nothing.
    fn is_seen(&mut self, now: Reckoning) -> bool {
        let is_here = |since: &Reckoning| {
            now.at.distance(&since.at) <= STANDS
                && since.at.seen(now.at.heading).abs() <= STANDS_ANGLE
        };
        match &mut self.since {
            Some((_, last)) if now.stamp <= *last => false,
            Some((since, last)) if is_here(since) => {
                *last = now.stamp;
                // Stamps are not exact.
                now.stamp - since.stamp >= STANDS_TIME / 10 * 9
            }
            since => {
                *since = Some((now, now.stamp));
                false
            }
        }
    }
}

/// A base behind topics. After any error the stop command has been sent to its wheels. Dropping it repeats the stop
/// command until odometry reports that the robot stands, or for a second.
pub(super) struct LiveBase {
    wheels: Box<dyn Wheels>,
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
        wheels: Box<dyn Wheels>,
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
        let _ = self.wheels.command(WheelSpeeds::STOP);
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
        let last = self.odometry.take().filter(|now| now.stamp > self.last.stamp);
        let begun = last.unwrap_or(self.last).stamp;
        let mut standing = Standing::default();
        if let Some(last) = last {
            standing.is_seen(last);
        }
        self.wheels.command(wheels)?;
        let over = begun + (PERIOD * SECOND as f64) as Nanoseconds;
        let mut moves = false;
        let stopping = wheels == WheelSpeeds::STOP;
        let arrived = |now: Reckoning| {
            let stood = now.stamp > begun && standing.is_seen(now);
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
        let mut standing = Standing::default();
        while Instant::now() < until {
            self.halt();
            let stood = |now: Reckoning| standing.is_seen(now).then_some(());
            match self.odometry.wait(REPEAT_INTERVAL, || false, stood) {
                Ok(()) | Err(RobotError::Closed { .. }) => break,
                Err(_) => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use toposlam_model::driving::odometry::Odometry;

    use super::*;

    /// The first reading at which a robot that brakes from 0.2 m/s at 0.3 m/s^2 is said to stand, in seconds after it
    /// began to brake.
    fn stands_at(readings_a_second: u64, jitter: f64) -> f64 {
        let mut standing = Standing::default();
        let stands = (1..).find_map(|number| {
            let stamp = number * SECOND / readings_a_second;
            let time = stamp as f64 / SECOND as f64;
            let braked = time.min(0.2 / 0.3);
            let x = 0.2 * braked - 0.15 * braked * braked;
            // Fused odometry is never twice the same.
            let position = [x + if number % 2 == 0 { jitter } else { -jitter }, 0.0];
            let at = Odometry { position, heading: 0.0 };
            standing.is_seen(Reckoning { stamp, at, wheels: WheelSpeeds::STOP }).then_some(time)
        });
        stands.unwrap()
    }

    #[test]
    fn a_robot_that_brakes_stands_when_it_does_however_often_odometry_comes() {
        for readings in [10, 20, 50, 100, 200] {
            let at = stands_at(readings, 0.0005);
            assert!((0.6..0.95).contains(&at), "{readings} a second: {at}");
        }
    }

    #[test]
    fn readings_that_go_back_in_time_say_nothing() {
        let at = Odometry { position: [1.0, 0.0], heading: 0.0 };
        let reading = |stamp| Reckoning { stamp, at, wheels: WheelSpeeds::STOP };
        let mut standing = Standing::default();
        assert!(
            ![5, 1, 5, 4].into_iter().any(|tenth| standing.is_seen(reading(tenth * SECOND / 10)))
        );
        assert!(standing.is_seen(reading(6 * SECOND / 10)));
    }
}
