//! What Algorithm 2 needs of a robot: it takes a frame, turns, and goes ahead. Sections 2.5 and 4.

use thiserror::Error;
use toposlam_model::driving::odometry::Odometry;

use crate::{pose::Pose, record::Frame};

/// A robot with a camera. An action may fail, be late, or be inexact; odometry reports its result.
pub trait Robot {
    /// Takes a frame.
    ///
    /// # Errors
    /// Returns [`RobotError::NoPicture`] or [`RobotError::StalePicture`] if the next attempt may succeed,
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
    fn odometry(&self) -> Reckoned;

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
    pub reckoned: Reckoned,
}

/// Where the robot is by its wheels, at some time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reckoned {
    /// In seconds since the robot was switched on.
    pub time: f64,
    /// Where it is.
    pub odometry: Odometry,
}

/// Why a robot does not do what it is asked for.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RobotError {
    /// The camera gave no picture; the next may come.
    #[error("the camera gives no picture")]
    NoPicture,
    /// There are no more pictures in the log.
    #[error("the log has no more pictures")]
    EndOfLog,
    /// A recorded robot was asked for something else than what is recorded.
    #[error("entry {entry} of the recording is {recorded}; what is asked for is {asked}")]
    NotRecorded {
        /// Which entry it is, counted from 1.
        entry: usize,
        /// What it is.
        recorded: String,
        /// What the robot was asked for.
        asked: String,
    },
    /// There is nobody at the other end.
    #[error("there is no master of ROS at {master}: {cause}")]
    Unreachable {
        /// The address.
        master: String,
        /// What happened.
        cause: String,
    },
    /// Nothing comes from the robot any more.
    #[error("nothing has come on {topic} for {seconds} s{}", unreadable(*.unread))]
    Silent {
        /// The topic on which nothing came.
        topic: String,
        /// For how long.
        seconds: f64,
        /// How many messages came of another type.
        unread: u64,
    },
    /// The connection is closed.
    #[error("the connection to {topic} is closed")]
    Closed {
        /// The topic.
        topic: String,
    },
    /// Pictures come, and all were taken before the robot stood still.
    #[error("the last picture is {behind:.3} s older than the end of the last motion")]
    StalePicture {
        /// By so many seconds.
        behind: f64,
    },
    /// The robot was told to stop, and did not.
    #[error("by its odometry the robot still moves {seconds} s after it was told to stop")]
    StillMoving {
        /// For how long.
        seconds: f64,
    },
    /// Somebody ended the run.
    #[error("the run was ended")]
    Stopped,
}

fn unreadable(messages: u64) -> String {
    match messages {
        0 => String::new(),
        messages => format!("; {messages} messages there are of another type"),
    }
}
