//! All that a robot does for Algorithm 2: it takes a picture, it turns, it goes ahead. Sections 2.5
//! and 4.

use thiserror::Error;
use toposlam_model::driving::odometry::Odometry;

/// A robot with a camera. What it is asked for may fail, be late, or come out differently: what came
/// of a motion is what odometry says next.
pub trait Robot {
    /// What its camera gives.
    type View: PartialEq;

    /// Takes a picture.
    ///
    /// # Errors
    /// [`RobotError::NoPicture`] where none came; others where the robot cannot go on.
    // paper: hardware.capture
    fn capture(&mut self) -> Result<Picture<Self::View>, RobotError>;

    /// Turns on the spot by so many radians, counter-clockwise.
    ///
    /// # Errors
    /// Where the robot cannot go on.
    fn turn(&mut self, angle: f64) -> Result<(), RobotError>;

    /// Goes straight ahead by so many metres.
    ///
    /// # Errors
    /// Where the robot cannot go on.
    fn forward(&mut self, distance: f64) -> Result<(), RobotError>;

    /// Where the robot is by its wheels, and when.
    fn odometry(&self) -> Reckoned;

    /// What the wheels were told and what odometry said then, from the beginning; empty where nobody
    /// keeps it.
    fn track(&self) -> &[Sample] {
        &[]
    }
}

/// What the wheels were told, and what came of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Metres a second ahead.
    pub speed: f64,
    /// Radians a second, counter-clockwise.
    pub turning: f64,
    /// What odometry said after it.
    pub reckoned: Reckoned,
}

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture<V> {
    /// When it was taken, in seconds since the robot was switched on.
    pub taken: f64,
    /// What it shows.
    pub view: V,
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
