//! What Algorithm 2 needs of a robot: it takes a frame, turns, and goes ahead. Sections 2.5 and 4.

use thiserror::Error;
use toposlam_logs::record::Frame;
use toposlam_model::driving::{odometry::Odometry, pose::Pose};

/// A robot with a camera. An action may fail, be late, or be inexact; odometry reports its result.
pub trait Robot {
    /// Takes a frame.
    ///
    /// # Errors
    /// Returns [`RobotError::NoImage`] or [`RobotError::StaleImage`] if the next attempt may succeed,
    /// another error if the robot cannot go on.
    // paper: hardware.capture
    fn capture(&mut self) -> Result<Frame, RobotError>;

    /// Turns on the spot, by an angle in radians counter-clockwise.
    ///
    /// # Errors
    /// Returns an error if the robot cannot go on.
    fn turn(&mut self, angle: f64) -> Result<(), RobotError>;

    /// Goes straight ahead, by a distance in metres.
    ///
    /// # Errors
    /// Returns an error if the robot cannot go on.
    fn forward(&mut self, distance: f64) -> Result<(), RobotError>;

    /// Where the robot is by its wheels, and when.
    fn odometry(&self) -> TimedOdometry;

    /// The commands of the wheels and the odometry after each, from the beginning; empty if the robot
    /// does not record them.
    fn track(&self) -> &[Sample] {
        &[]
    }

    /// The true pose; known in a simulation only.
    fn truth(&self) -> Option<Pose> {
        None
    }
}

/// A command of the wheels, and the odometry after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Metres a second ahead.
    pub speed: f64,
    /// Radians a second, counter-clockwise.
    pub turning: f64,
    /// The odometry after it.
    pub reckoned: TimedOdometry,
}

/// The odometry at some time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TimedOdometry {
    /// In seconds since the robot was switched on.
    pub time: f64,
    /// Where the robot is by its wheels.
    pub odometry: Odometry,
}

/// Why a robot fails.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RobotError {
    /// The camera gave no image; the next may come.
    #[error("the camera gives no image")]
    NoImage,
    /// There are no more images in the log.
    #[error("the log has no more images")]
    EndOfLog,
    /// A recorded robot got a command that is not the recorded one.
    #[error("entry {entry} of the recording is {recorded}, but the robot is asked for {asked}")]
    NotRecorded {
        /// The number of the entry, counted from 1.
        entry: usize,
        /// The recorded command.
        recorded: String,
        /// The present command.
        asked: String,
    },
    /// The ROS master does not answer.
    #[error("no ROS master at {master}: {cause}")]
    Unreachable {
        /// The address.
        master: String,
        /// What happened.
        cause: String,
    },
    /// The robot sends nothing any more.
    #[error("no message on {topic} for {seconds} s{}", unreadable(*.unread))]
    Silent {
        /// The silent topic.
        topic: String,
        /// For how long, in seconds.
        seconds: f64,
        /// The number of messages of another type.
        unread: u64,
    },
    /// The connection is closed.
    #[error("the connection to {topic} is closed")]
    Closed {
        /// The topic.
        topic: String,
    },
    /// All images were taken before the robot stood still.
    #[error("the last image is {behind:.3} s older than the end of the last motion")]
    StaleImage {
        /// By how much, in seconds.
        behind: f64,
    },
    /// The robot did not stop.
    #[error("the odometry still moves {seconds} s after the stop command")]
    StillMoving {
        /// For how long, in seconds.
        seconds: f64,
    },
    /// The user ended the run.
    #[error("the run was ended")]
    Stopped,
}

fn unreadable(messages: u64) -> String {
    match messages {
        0 => String::new(),
        messages => format!("; {messages} messages on it have another type"),
    }
}
