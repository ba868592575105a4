//! The base of a live robot: wheels and odometry behind topics. Section 2.5.

use std::time::{Duration, Instant};

use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use super::{
    Wheels,
    messages::{Nanoseconds, Reckoning, SECOND},
    response::ResponseMeter,
    scanner::{Scanner, went_back},
    topic::Subscription,
};
use crate::{
    robot::{RobotError, Sample, TimedOdometry},
    superscout::{Base, BaseResponse, PERIOD, WheelSpeeds},
};

/// The robot does not move if this many motions in a row are not carried out.
const STILL: u32 = 3;

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
pub(super) struct Standing {
    /// The first reading at this place, and the time of the last one.
    since: Option<(Reckoning, Nanoseconds)>,
}

impl Standing {
    /// Whether a robot stands at a reading. One that goes back in time says nothing.
    pub(super) fn is_seen(&mut self, now: Reckoning) -> bool {
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
    /// When the last odometry came.
    arrived: Instant,
    /// `None` for a robot without a laser scanner.
    pub(super) scanner: Option<Scanner>,
    response: ResponseMeter,
    pub(super) track: Vec<Sample>,
}

impl LiveBase {
    /// A base at rest, as soon as odometry has come.
    pub(super) fn new(
        wheels: Box<dyn Wheels>,
        odometry: Subscription<Reckoning>,
        scanner: Option<Scanner>,
        patience: Duration,
        stop: fn() -> bool,
    ) -> Result<Self, RobotError> {
        let last = odometry.wait(patience, stop, Some)?;
        let mut base = Self {
            wheels,
            odometry,
            patience,
            stop,
            epoch: last.stamp,
            last,
            arrived: Instant::now(),
            scanner,
            response: ResponseMeter::default(),
            track: Vec::new(),
        };
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
        if self.take_odometry().is_some() {
            self.sample(WheelSpeeds::STOP);
        }
    }

    /// The stamp of the last odometry, also of one that was not used yet.
    pub(super) fn stamp(&self) -> Nanoseconds {
        self.odometry.peek(|now| now.stamp).unwrap_or_default().max(self.last.stamp)
    }

    /// # Errors
    /// Returns an error if odometry has not come for too long.
    pub(super) fn check_odometry(&mut self) -> Result<(), RobotError> {
        self.take_odometry();
        if self.arrived.elapsed() > self.patience {
            return Err(self.odometry.silent(self.patience));
        }
        Ok(())
    }

    /// Takes the last odometry, if it is newer.
    fn take_odometry(&mut self) -> Option<Reckoning> {
        let (now, arrived) = self.odometry.take_timed()?;
        (now.stamp > self.last.stamp).then(|| {
            (self.last, self.arrived) = (now, arrived);
            now
        })
    }

    fn sample(&mut self, wheels: WheelSpeeds) {
        let (speed, turning) = (wheels.speed(), wheels.turn_rate());
        self.track.push(Sample { speed, turning, reading: self.reading() });
    }

    /// Where the robot was at a time, by its track.
    fn pose(&self, stamp: Nanoseconds) -> Odometry {
        let time = self.seconds(stamp);
        let after = self.track.partition_point(|sample| sample.reading.time <= time);
        let before = self.track[..after].last().or(self.track.first());
        let [before, after] = [before, self.track.get(after)].map(|s| s.map(|s| s.reading));
        match (before, after) {
            (Some(before), Some(after)) if before.time < time => {
                let part = (time - before.time) / (after.time - before.time);
                let (from, to) = (before.odometry, after.odometry);
                let position = [0, 1].map(|axis| {
                    from.position[axis] + part * (to.position[axis] - from.position[axis])
                });
                let heading = wrapped(from.heading + part * wrapped(to.heading - from.heading));
                Odometry { position, heading }
            }
            (Some(at), _) | (None, Some(at)) => at.odometry,
            (None, None) => self.last.at,
        }
    }

    /// Sets the wheel speeds and waits until the period is over; after a stop, until the robot
    /// stands. The robot moves only while odometry and scans come.
    fn command(&mut self, wheels: WheelSpeeds) -> Result<(), RobotError> {
        if (self.stop)() {
            return Err(RobotError::Stopped);
        }
        let stopping = wheels == WheelSpeeds::STOP;
        let (begun, before, mut standing) = loop {
            if !stopping {
                self.wheels.wait()?;
            }
            // The period begins now, not at the last odometry.
            let last = self.take_odometry();
            if !stopping {
                self.check_odometry()?;
                if let Some(scanner) = &mut self.scanner {
                    scanner.update(self.patience)?;
                }
            }
            let mut standing = Standing::default();
            if let Some(last) = last {
                standing.is_seen(last);
            }
            if self.wheels.command(wheels)? {
                break (self.last.stamp, self.reading(), standing);
            }
        };
        let over = begun + (PERIOD * SECOND as f64) as Nanoseconds;
        let (mut moves, mut back) = (false, 0);
        let arrived = |now: Reckoning| {
            back = begun.saturating_sub(now.stamp);
            let stood = now.stamp > begun && standing.is_seen(now);
            moves = stopping && now.stamp >= over && !stood;
            (now.stamp >= over && (!stopping || stood)).then_some(now)
        };
        let now = self.odometry.wait(self.patience, self.stop, arrived);
        let seconds = self.patience.as_secs_f64();
        self.last = now.map_err(|error| match error {
            RobotError::Silent { .. } if moves => RobotError::StillMoving { seconds },
            RobotError::Silent { topic, .. } if back > 0 => went_back(&topic, back),
            error => error,
        })?;
        self.arrived = Instant::now();
        self.sample(wheels);
        self.response.add(wheels, before, self.reading());
        if self.response.still() >= STILL {
            return Err(RobotError::DoesNotMove { motions: STILL });
        }
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

    fn response(&self) -> BaseResponse {
        self.response.response()
    }

    /// By the last scan. A robot with a camera has only what Algorithm 2 sees.
    fn room(&self) -> f64 {
        let Some(scanner) = &self.scanner else { return f64::INFINITY };
        let then = scanner.stamp().map_or(self.last.at, |stamp| self.pose(stamp));
        scanner.room(&then, &self.last.at)
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
