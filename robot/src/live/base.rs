//! The base of a live robot: wheels and odometry behind topics. Section 2.5.

use std::{
    thread::sleep,
    time::{Duration, Instant},
};

use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use super::{
    Wheels,
    messages::{Nanoseconds, Reckoning, SECOND},
    response::ResponseMeter,
    scanner::Scanner,
    stamps::StampFaults,
    topic::Subscription,
};
use crate::{
    robot::{RobotError, Sample, TimedOdometry},
    superscout::{Base, BaseResponse, PERIOD, SPEED, TURN_RATE, WheelSpeeds},
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

/// Odometry jumps if it goes farther than twice as fast as the robot, and this, in metres,
const JUMP: f64 = 0.1;
/// or turns so, and this, in radians.
const JUMP_ANGLE: f64 = 0.2;

/// Finds out from readings whether a robot stands.
#[derive(Default)]
pub(super) struct Standing {
    /// The first reading at this place, and the time of the last one.
    since: Option<(Reckoning, Nanoseconds)>,
}

impl Standing {
    /// Whether a robot stands at a reading. One that is not later than the last one is ignored.
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
    /// What is wrong with the stamps of later messages.
    stamps: StampFaults,
    /// `None` for a robot without a laser scanner.
    pub(super) scanner: Option<Scanner>,
    response: ResponseMeter,
    pub(super) track: Vec<Sample>,
}

impl LiveBase {
    /// A base at rest, as soon as odometry of two times has come.
    pub(super) fn new(
        wheels: Box<dyn Wheels>,
        odometry: Subscription<Reckoning>,
        scanner: Option<Scanner>,
        patience: Duration,
        stop: fn() -> bool,
    ) -> Result<Self, RobotError> {
        let first = odometry.wait(patience, stop, Some)?;
        let mut stamps = StampFaults::default();
        let is_later = |now: Reckoning| stamps.is_later(first.stamp, now.stamp).then_some(now);
        let last =
            odometry.wait(patience, stop, is_later).map_err(|error| stamps.explain(error))?;
        let mut base = Self {
            wheels,
            odometry,
            patience,
            stop,
            epoch: last.stamp,
            last,
            arrived: Instant::now(),
            stamps,
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
    pub(super) fn read(&mut self) -> Result<(), RobotError> {
        if self.take_odometry()?.is_some() {
            self.sample(WheelSpeeds::STOP);
        }
        Ok(())
    }

    /// The stamp of the last odometry, also of one that was not used yet.
    pub(super) fn stamp(&self) -> Nanoseconds {
        self.odometry.peek(|now| now.stamp).unwrap_or_default().max(self.last.stamp)
    }

    /// # Errors
    /// Returns an error if the stamp of a message that came now is farther from those of odometry than the longest time
    /// without a message.
    pub(super) fn check_clock(&self, topic: &str, stamp: Nanoseconds) -> Result<(), RobotError> {
        let seconds = self.seconds(stamp) - self.seconds(self.stamp());
        if seconds.abs() <= self.patience.as_secs_f64() {
            return Ok(());
        }
        let [topic, odometry] = [topic, self.odometry.topic()].map(str::to_owned);
        Err(RobotError::ClocksDiffer { topic, odometry, seconds: seconds.abs() })
    }

    /// # Errors
    /// Returns an error if odometry has not come for too long, or has jumped.
    pub(super) fn check_odometry(&mut self) -> Result<(), RobotError> {
        self.take_odometry()?;
        if self.arrived.elapsed() > self.patience {
            return Err(self.stamps.explain(self.odometry.silent(self.patience)));
        }
        Ok(())
    }

    /// Takes the last odometry, if it is newer.
    fn take_odometry(&mut self) -> Result<Option<Reckoning>, RobotError> {
        self.odometry.check_source()?;
        let Some((now, arrived)) = self.odometry.take_timed() else { return Ok(None) };
        if !self.stamps.is_later(self.last.stamp, now.stamp) {
            return Ok(None);
        }
        check_way(self.odometry.topic(), &self.last, &now)?;
        (self.last, self.arrived) = (now, arrived);
        Ok(Some(now))
    }

    /// Waits while the run is paused, then until the robot stands; checks that odometry and scans come. Whether the run was
    /// paused.
    fn get_ready(&mut self) -> Result<bool, RobotError> {
        let was_paused = self.wheels.wait()?;
        if was_paused {
            self.response.discard();
            self.command(WheelSpeeds::STOP)?;
        }
        self.check_odometry()?;
        if let Some(mut scanner) = self.scanner.take() {
            let checked =
                scanner.update(self.patience, |topic, stamp| self.check_clock(topic, stamp));
            self.scanner = Some(scanner);
            checked?;
        }
        Ok(was_paused)
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
    /// stands. Nothing is sent if a pause has begun.
    fn command(&mut self, wheels: WheelSpeeds) -> Result<(), RobotError> {
        if (self.stop)() {
            return Err(RobotError::Stopped);
        }
        let stopping = wheels == WheelSpeeds::STOP;
        // The period begins now, not at the last odometry.
        let mut standing = Standing::default();
        if let Some(last) = self.take_odometry()? {
            standing.is_seen(last);
        }
        if !self.wheels.command(wheels)? {
            return Ok(());
        }
        let (before, mut last) = (self.reading(), self.last);
        let over = last.stamp + (PERIOD * SECOND as f64) as Nanoseconds;
        let (odometry, stamps, mut moves) = (&self.odometry, &mut self.stamps, false);
        let arrived = |now: Reckoning| {
            if !stamps.is_later(last.stamp, now.stamp) {
                return None;
            }
            if let Err(jumped) = check_way(odometry.topic(), &last, &now) {
                return Some(Err(jumped));
            }
            last = now;
            let stood = standing.is_seen(now);
            moves = stopping && now.stamp >= over && !stood;
            (now.stamp >= over && (!stopping || stood)).then_some(Ok(now))
        };
        let now = odometry.wait(self.patience, self.stop, arrived);
        let seconds = self.patience.as_secs_f64();
        self.last = now.map_err(|error| match error {
            RobotError::Silent { .. } if moves => RobotError::StillMoving { seconds },
            error => self.stamps.explain(error),
        })??;
        self.arrived = Instant::now();
        self.sample(wheels);
        if self.wheels.is_interrupted() {
            self.response.discard();
        }
        self.response.add(wheels, before, self.reading());
        if self.response.still() >= STILL {
            return Err(RobotError::DoesNotMove { motions: STILL });
        }
        Ok(())
    }

    /// Stops the wheels after an error.
    pub(super) fn or_halt<T>(&self, done: Result<T, RobotError>) -> Result<T, RobotError> {
        if done.is_err() {
            self.halt();
        }
        done
    }
}

/// # Errors
/// Returns an error if the robot cannot have gone from one reading to a later one.
fn check_way(topic: &str, from: &Reckoning, to: &Reckoning) -> Result<(), RobotError> {
    let seconds = to.stamp.saturating_sub(from.stamp) as f64 / SECOND as f64;
    let (metres, turned) = (to.at.distance(&from.at), from.at.seen(to.at.heading).abs());
    if metres <= 2.0 * SPEED * seconds + JUMP && turned <= 2.0 * TURN_RATE * seconds + JUMP_ANGLE {
        return Ok(());
    }
    let degrees = turned.to_degrees();
    Err(RobotError::OdometryJumped { topic: topic.to_owned(), metres, degrees, seconds })
}

impl Base for LiveBase {
    fn wait_for_pause(&mut self) -> Result<bool, RobotError> {
        let ready = self.get_ready();
        self.or_halt(ready)
    }

    fn drive(&mut self, wheels: WheelSpeeds) -> Result<TimedOdometry, RobotError> {
        let done = self.command(wheels);
        self.or_halt(done).map(|()| self.reading())
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
                Err(RobotError::Silent { .. }) => {}
                Err(_) => sleep(REPEAT_INTERVAL),
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
    fn readings_that_go_back_in_time_are_ignored() {
        let at = Odometry { position: [1.0, 0.0], heading: 0.0 };
        let reading = |stamp| Reckoning { stamp, at, wheels: WheelSpeeds::STOP };
        let mut standing = Standing::default();
        assert!(
            ![5, 1, 5, 4].into_iter().any(|tenth| standing.is_seen(reading(tenth * SECOND / 10)))
        );
        assert!(standing.is_seen(reading(6 * SECOND / 10)));
    }
}
