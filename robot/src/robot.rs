//! What Algorithm 2 needs of a robot: it takes a frame, turns, and goes ahead. Sections 2.5 and 4.

use thiserror::Error;
use toposlam_logs::record::Frame;
use toposlam_model::driving::{odometry::Odometry, pose::Pose};

/// A robot with a camera or a laser scanner. An action may fail, be late, or be inexact; odometry reports its result.
/// An error means that the robot cannot go on.
#[expect(clippy::missing_errors_doc, reason = "they are above")]
pub trait Robot {
    /// Takes a frame. After [`RobotError::NoImage`] or [`RobotError::StaleImage`] the next attempt may succeed.
    // paper: hardware.capture
    fn capture(&mut self) -> Result<Frame, RobotError>;

    /// Turns on the spot, by an angle in radians counter-clockwise.
    fn turn(&mut self, angle: f64) -> Result<(), RobotError>;

    /// Goes straight ahead, by a distance in metres.
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
    pub reading: TimedOdometry,
}

/// Where the robot is by its wheels, and when, in seconds since it was switched on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TimedOdometry {
    pub time: f64,
    pub odometry: Odometry,
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum RobotError {
    #[error("the camera gives no image")]
    NoImage,
    #[error("the log has no more images")]
    EndOfLog,
    #[error("no ROS master at {master}: {cause}")]
    Unreachable { master: String, cause: String },
    #[error("DDS cannot be used: {cause}")]
    NoDds { cause: String },
    #[error("nobody {does} {topic} in domain {domain}; waited for {seconds} s")]
    Nobody { does: &'static str, topic: String, domain: u16, seconds: f64 },
    #[error("{topic} of the robot is {theirs}; this program needs {ours}")]
    OtherType { topic: String, theirs: String, ours: String },
    #[error("the scanner's frame `{frame}` is not connected to the robot: {cause}")]
    NoMount { frame: String, cause: String },
    /// The frame of scans changed after the beginning of the run.
    #[error(
        "the scans on {topic} are of the frame `{theirs}`; those of the scanner are of `{ours}`"
    )]
    OtherFrame { topic: String, theirs: String, ours: String },
    #[error("the stamps on {topic} went back by {seconds:.1} s")]
    ClockWentBack { topic: String, seconds: f64 },
    #[error("the robot does not move: odometry shows nothing of its last {motions} motions")]
    DoesNotMove { motions: u32 },
    /// `unread` counts the messages that cannot be read.
    #[error("no message on {topic} for {seconds} s{}", unreadable(*.unread))]
    Silent { topic: String, seconds: f64, unread: u64 },
    #[error("the connection to {topic} is closed")]
    Closed { topic: String },
    #[error("the robot reports on {topic} that {what}")]
    Hazard { topic: &'static str, what: &'static str },
    /// All images were taken before the robot stood still, this one `behind` seconds before.
    #[error("the last image is {behind:.3} s older than the end of the last motion")]
    StaleImage { behind: f64 },
    #[error("the odometry still moves {seconds} s after the stop command")]
    StillMoving { seconds: f64 },
    /// The user ended the run.
    #[error("the run was ended")]
    Stopped,
}

fn unreadable(messages: u64) -> String {
    match messages {
        0 => String::new(),
        messages => {
            format!("; {messages} messages on it have another type, or numbers that are not finite")
        }
    }
}
