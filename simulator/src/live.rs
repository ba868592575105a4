//! A simulated robot behind topics. To its driver it looks like a live robot.

use std::{
    thread,
    time::{Duration, Instant, SystemTime, UNIX_EPOCH},
};

use toposlam_logs::record::Frame;
use toposlam_robot::{
    live::{Nanoseconds, Reckoning, SECOND, ServedRobot},
    robot::RobotError,
    superscout::{Base, WheelSpeeds},
};

use crate::{SimulatedRobot, simulated_robot::IMAGE_TIME};

/// Wheel speeds take effect after at most this time, in seconds of simulated time.
const TICK: f64 = 0.05;
/// Odometry is published every this many ticks: ten times a second.
const READING: u64 = 2;
/// Interval between images in seconds. Rendering takes most of the time.
const IMAGE_EVERY: f64 = 1.0;
/// The greatest speed of simulated time relative to real time. At higher speeds a motion would be
/// over before odometry reports it.
pub const MOST_SPEED: f64 = 20.0;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServeSummary {
    /// Simulated time, in seconds.
    pub seconds: f64,
    pub real_seconds: f64,
    pub frames: u64,
}

/// Serves a simulated robot on topics until `stop` returns true.
///
/// Simulated time passes `speed` times as fast as real time or slower, without jumps: it stands
/// still while an image is rendered. The watchdog stops the wheels half a second of simulated time
/// after the last command. Time stamps begin at the present time.
pub fn serve(
    robot: SimulatedRobot,
    topics: &dyn ServedRobot,
    speed: f64,
    stop: impl Fn() -> bool,
) -> Result<ServeSummary, RobotError> {
    let mut scout =
        Scout { topics, epoch: now(), ignores: false, exposed: None, next_image: 0.0, robot };
    let begun = Instant::now();
    let tick = Duration::from_secs_f64(TICK / speed.clamp(0.01, MOST_SPEED));
    let mut due = begun;
    let mut ticks = 0;
    while !stop() {
        scout.tick(ticks)?;
        ticks += 1;
        // Lost time is not made up for.
        due = (due + tick).max(Instant::now());
        thread::sleep(due.saturating_duration_since(Instant::now()));
    }
    let (seconds, frames) = (scout.robot.base.time(), scout.robot.frames());
    Ok(ServeSummary { seconds, real_seconds: begun.elapsed().as_secs_f64(), frames })
}

fn now() -> Nanoseconds {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    since.as_secs() * SECOND
}

struct Scout<'t> {
    topics: &'t dyn ServedRobot,
    /// The stamp of its time 0.
    epoch: Nanoseconds,
    /// Whether the present motion is ignored.
    ignores: bool,
    /// An image that is on its way, and its time of arrival.
    exposed: Option<(f64, Frame)>,
    next_image: f64,
    robot: SimulatedRobot,
}

impl Scout<'_> {
    /// Advances by one tick, with this number.
    fn tick(&mut self, number: u64) -> Result<(), RobotError> {
        if let Some(wheels) = self.topics.command() {
            self.command(wheels);
        }
        self.robot.base.wait(TICK);
        if number.is_multiple_of(READING) {
            self.publish_odometry((number / READING) as u32)?;
        }
        self.photograph()
    }

    /// A motion begins when the wheels are set in motion.
    fn command(&mut self, wheels: WheelSpeeds) {
        let base = &mut self.robot.base;
        let stood = base.wheels() == WheelSpeeds::STOP;
        if wheels == WheelSpeeds::STOP {
            self.ignores = false;
        } else if stood && !self.ignores {
            self.ignores = !base.begin();
        }
        base.command(if self.ignores { WheelSpeeds::STOP } else { wheels });
    }

    fn stamp(&self, seconds: f64) -> Nanoseconds {
        self.epoch + (seconds * SECOND as f64).round() as Nanoseconds
    }

    fn publish_odometry(&mut self, number: u32) -> Result<(), RobotError> {
        let base = &self.robot.base;
        let (reading, wheels) = (base.reading(), base.wheels());
        let reckoning = Reckoning { stamp: self.stamp(reading.time), at: reading.odometry, wheels };
        self.topics.odometry(number, &reckoning)
    }

    /// Takes an image if one is due, and publishes it when it has arrived.
    fn photograph(&mut self) -> Result<(), RobotError> {
        let time = self.robot.base.time();
        if let Some((_, exposed)) = self.exposed.take_if(|(there, _)| *there <= time) {
            let number = self.robot.frames() as u32;
            let stamp = self.stamp(exposed.taken);
            if let Some(file) = exposed.image.as_ref().and_then(|image| image.file()) {
                self.topics.image(number, stamp, file)?;
            }
            if let Some(seen) = &exposed.marker {
                self.topics.marker(number, stamp, seen)?;
            }
            if let Some(sweep) = &exposed.scan {
                self.topics.scan(number, stamp, sweep)?;
            }
        }
        if time >= self.next_image {
            self.next_image = time + IMAGE_EVERY;
            self.exposed = self.robot.expose().map(|image| (time + IMAGE_TIME, image));
        }
        Ok(())
    }
}
