//! A simulated robot as a node of ROS 1: whoever drives it cannot tell it from a live one.

use std::{
    thread,
    time::{Duration, Instant, SystemTime, UNIX_EPOCH},
};

use super::{
    RobotTopics,
    messages::{
        FRAMES, Nanoseconds, ODOMETRY, PICTURE, Reckoning, SECOND, frames, odometry, picture,
        read_twist,
    },
    node::{Node, Publisher, Subscription},
};
use crate::{
    log::recorder,
    record::Frame,
    robot::RobotError,
    simulator::SimulatedRobot,
    superscout::{Base, WheelSpeeds},
};

/// What its wheels are told takes effect after this at most, in seconds of its time.
const TICK: f64 = 0.05;
/// Of so many ticks, one is told by odometry: ten times a second.
const READING: u64 = 2;
/// A picture is taken every second, or as often as the camera can: to render one is most of the work.
const PICTURE_EVERY: f64 = 1.0;
/// The simulated time goes by at most so many times as fast as the real one: faster, a motion would be
/// over before it is known of.
pub const MOST_SPEED: f64 = 20.0;

/// What a simulated robot did as a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServeSummary {
    /// Seconds of the simulated time.
    pub seconds: f64,
    /// Seconds of the real time.
    pub real_seconds: f64,
    /// How many pictures it took.
    pub pictures: u64,
}

/// Lets a simulated robot be driven through topics, until somebody says `stop`.
///
/// Its time goes by `speed` times as fast as the real one, or slower, never in jumps: while a picture is
/// rendered, time stands. Its watchdog stops its wheels half a second after they were last told
/// something, in its time. Stamps begin at the present time.
///
/// # Errors
/// Where there is no master, or the connection is closed.
pub fn serve(
    robot: SimulatedRobot,
    topics: &RobotTopics,
    speed: f64,
    stop: impl Fn() -> bool,
) -> Result<ServeSummary, RobotError> {
    let node = Node::new(&topics.master, "/toposlam_simulator")?;
    let mut scout = Scout {
        told: node.listen(&topics.wheels, read_twist)?,
        odometry: node.speak(&topics.odometry, ODOMETRY)?,
        frames: node.speak(recorder::TF, FRAMES)?,
        pictures: node.speak(&topics.pictures, PICTURE)?,
        epoch: now(),
        deaf: false,
        exposed: None,
        next_picture: 0.0,
        robot,
    };
    let begun = Instant::now();
    let tick = Duration::from_secs_f64(TICK / speed.clamp(0.01, MOST_SPEED));
    let mut due = begun;
    let mut ticks = 0;
    while !stop() {
        scout.tick(ticks)?;
        ticks += 1;
        // Time that was lost is not made up for.
        due = (due + tick).max(Instant::now());
        thread::sleep(due.saturating_duration_since(Instant::now()));
    }
    let (seconds, pictures) = (scout.robot.time(), scout.robot.pictures());
    Ok(ServeSummary { seconds, real_seconds: begun.elapsed().as_secs_f64(), pictures })
}

fn now() -> Nanoseconds {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    since.as_secs() * SECOND
}

/// A simulated robot and its topics.
struct Scout {
    told: Subscription<WheelSpeeds>,
    odometry: Publisher,
    frames: Publisher,
    pictures: Publisher,
    /// The stamp of its time 0.
    epoch: Nanoseconds,
    /// It does not carry out the present motion.
    deaf: bool,
    /// A picture that is on its way, and when it comes.
    exposed: Option<(f64, Frame)>,
    next_picture: f64,
    robot: SimulatedRobot,
}

impl Scout {
    /// What happens in one tick, of this number.
    fn tick(&mut self, number: u64) -> Result<(), RobotError> {
        if let Some(wheels) = self.told.take() {
            self.command(wheels);
        }
        self.robot.base().wait(TICK);
        if number.is_multiple_of(READING) {
            self.tell((number / READING) as u32)?;
        }
        self.photograph()
    }

    /// A motion begins whenever the wheels stood.
    fn command(&mut self, wheels: WheelSpeeds) {
        let base = self.robot.base();
        let stood = base.wheels() == WheelSpeeds::STOP;
        if wheels == WheelSpeeds::STOP {
            self.deaf = false;
        } else if stood && !self.deaf {
            self.deaf = !base.begin();
        }
        base.command(if self.deaf { WheelSpeeds::STOP } else { wheels });
    }

    fn stamp(&self, seconds: f64) -> Nanoseconds {
        self.epoch + (seconds * SECOND as f64).round() as Nanoseconds
    }

    /// Odometry, and the same as a frame.
    fn tell(&mut self, number: u32) -> Result<(), RobotError> {
        let base = self.robot.base();
        let (reading, wheels) = (base.reading(), base.wheels());
        let reckoning = Reckoning { stamp: self.stamp(reading.time), at: reading.odometry, wheels };
        self.odometry.say(&odometry(number, &reckoning))?;
        self.frames.say(&frames(number, &reckoning))
    }

    /// Takes a picture where one is due, and gives it when it is there.
    fn photograph(&mut self) -> Result<(), RobotError> {
        let time = self.robot.time();
        if let Some((_, exposed)) = self.exposed.take_if(|(there, _)| *there <= time) {
            let number = self.robot.pictures() as u32;
            let stamp = self.stamp(exposed.taken);
            if let Some(file) = exposed.image.as_ref().and_then(|image| image.file()) {
                self.pictures.say(&picture(number, stamp, file))?;
            }
        }
        if time >= self.next_picture {
            let takes = self.robot.picture_time();
            self.next_picture = time + takes.max(PICTURE_EVERY);
            self.exposed = self.robot.expose().map(|picture| (time + takes, picture));
        }
        Ok(())
    }
}
