//! What Algorithm 2 needs of a robot: it takes a frame, turns, and goes ahead. Sections 2.5 and 4.

use thiserror::Error;
use toposlam_logs::record::Frame;
use toposlam_model::{
    aid::AidAction,
    driving::{odometry::Odometry, pose::Pose},
    percept::Door,
};
use toposlam_vision::laser::scan::ScanError;

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

    /// Does something with its marking aid, where it stands. A gripper feels whether it holds the marker, so this is an
    /// error if the action did not succeed.
    fn handle(&mut self, action: AidAction) -> Result<(), RobotError> {
        Err(RobotError::CannotHandle { action })
    }

    /// The number of doors where the other robot of its team stands, as that one reports; `None` if it reports nothing.
    fn reported_degree(&mut self) -> Option<u32> {
        None
    }

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
    #[error("this robot cannot do `{action}`")]
    CannotHandle { action: AidAction },
    #[error("the gripper finds no marker")]
    NothingGripped,
    #[error("the robot stands at no junction, and keeps its marker")]
    NotAtJunction,
    #[error("robot {robot} could not go through its door {}: {cause}", door.0)]
    NotSent { robot: u8, door: Door, cause: String },
    #[error("the other robot is not seen, and does not report where it is")]
    NoReport,
    #[error("the gripper is {}", if *.holds { "full" } else { "empty" })]
    Gripper { holds: bool },
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
    /// Scans are in another frame than the first one, or the marker is not in the robot's.
    #[error("the messages on {topic} are in the frame `{theirs}`; this program needs {ours}")]
    OtherFrame { topic: String, theirs: String, ours: String },
    #[error("the messages on {topic} are no scans: {cause}")]
    NoScan { topic: String, cause: ScanError },
    #[error(
        "the scans on {topic} show nothing ahead of the robot: their ranges there are 0, not numbers, or of the robot itself"
    )]
    NothingAhead { topic: String },
    #[error("the stamps on {topic} went back by {seconds:.1} s")]
    ClockWentBack { topic: String, seconds: f64 },
    /// A driver that does not set stamps.
    #[error("all messages on {topic} have the same stamp")]
    SameStamp { topic: String },
    /// The clocks of the two drivers differ, or the messages of one come late.
    #[error("the stamps on {topic} and on {odometry} differ by {seconds:.1} s")]
    ClocksDiffer { topic: String, odometry: String, seconds: f64 },
    /// A driver that starts again begins at 0.
    #[error(
        "the odometry on {topic} jumped: it went {metres:.2} m and turned {degrees:.0} degrees in {seconds:.2} s"
    )]
    OdometryJumped { topic: String, metres: f64, degrees: f64, seconds: f64 },
    #[error("the robot does not move: odometry shows nothing of its last {motions} motions")]
    DoesNotMove { motions: u32 },
    /// `unread` counts the last messages, which cannot be read.
    #[error("no message on {topic} for {seconds} s{}", unreadable(*.unread))]
    Silent { topic: String, seconds: f64, unread: u64 },
    /// Messages of both would be mixed.
    #[error("two nodes publish on {topic}: stop one of them, or name another topic with --topic")]
    TwoSources { topic: String },
    #[error("the last messages on {topic} ({unread}) {}", UNREADABLE)]
    Unreadable { topic: String, unread: u64 },
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

fn unreadable(count: u64) -> String {
    if count == 0 { String::new() } else { format!("; the last on it ({count}) {UNREADABLE}") }
}

/// What messages that cannot be read have.
const UNREADABLE: &str = "have another type, or numbers that are not finite";
