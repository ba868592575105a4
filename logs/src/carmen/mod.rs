//! CARMEN logs (`logger_io.h` of the Carnegie Mellon Robot Navigation Toolkit): one message a line, its keyword first,
//! then its fields, separated by spaces. A list stands behind the number of its elements. The last field is the
//! logger's clock; the third last is the clock of the program that sent the message.

mod fields;
mod scan;

use std::f64::consts::PI;

use nalgebra::{Isometry2, Vector2};

pub(super) use fields::decode;
pub(super) use scan::{RecordedScan, reading};

pub(super) struct LineKind {
    pub(super) keyword: &'static str,
    pub(super) type_name: &'static str,
    /// The fields after the keyword, as a definition of ROS 1.
    pub(super) definition: &'static str,
}

impl LineKind {
    pub(super) fn has_scan(&self) -> bool {
        self.definition.contains("] ranges")
    }
}

/// The old laser message: the corrected pose comes before the odometry.
const OLD_LASER: &str = "float32[] ranges\nfloat64 x\nfloat64 y\nfloat64 theta\nfloat64 odom_x\n\
    float64 odom_y\nfloat64 odom_theta\nfloat64 ipc_timestamp\nstring ipc_hostname\n\
    float64 logger_timestamp\n";
const ROBOT_LASER: &str = "int32 laser_type\nfloat64 start_angle\nfloat64 field_of_view\n\
    float64 angular_resolution\nfloat64 maximum_range\nfloat64 accuracy\nint32 remission_mode\n\
    float32[] ranges\nfloat32[] remissions\nfloat64 laser_x\nfloat64 laser_y\nfloat64 laser_theta\n\
    float64 odom_x\nfloat64 odom_y\nfloat64 odom_theta\nfloat64 laser_tv\nfloat64 laser_rv\n\
    float64 forward_safety_dist\nfloat64 side_safety_dist\nfloat64 turn_axis\n\
    float64 ipc_timestamp\nstring ipc_hostname\nfloat64 logger_timestamp\n";
/// A message of the program that reads a scanner: the robot's pose is in the lines of its odometry.
const RAW_LASER: &str = "int32 laser_type\nfloat64 start_angle\nfloat64 field_of_view\n\
    float64 angular_resolution\nfloat64 maximum_range\nfloat64 accuracy\nint32 remission_mode\n\
    float32[] ranges\nfloat32[] remissions\nfloat64 ipc_timestamp\nstring ipc_hostname\n\
    float64 logger_timestamp\n";
/// What GMapping writes of a scan: with the pose that it corrected.
const LASER_READING: &str = "float32[] ranges\nfloat64 odom_x\nfloat64 odom_y\nfloat64 odom_theta\n\
    float64 timestamp\n";
/// What GMapping writes of the odometry.
const SHORT_ODOM: &str = "float64 x\nfloat64 y\nfloat64 theta\nfloat64 timestamp\n";
const ODOM: &str = "float64 x\nfloat64 y\nfloat64 theta\nfloat64 tv\nfloat64 rv\nfloat64 accel\n\
    float64 ipc_timestamp\nstring ipc_hostname\nfloat64 logger_timestamp\n";
const TRUE_POSE: &str = "float64 x\nfloat64 y\nfloat64 theta\nfloat64 odom_x\nfloat64 odom_y\n\
    float64 odom_theta\nfloat64 ipc_timestamp\nstring ipc_hostname\nfloat64 logger_timestamp\n";

/// The kinds of lines that are read. Others are skipped.
pub(super) const KINDS: [LineKind; 10] = [
    LineKind { keyword: "FLASER", type_name: "carmen/FLASER", definition: OLD_LASER },
    LineKind { keyword: "RLASER", type_name: "carmen/RLASER", definition: OLD_LASER },
    LineKind { keyword: "ROBOTLASER1", type_name: "carmen/ROBOTLASER1", definition: ROBOT_LASER },
    LineKind { keyword: "ROBOTLASER2", type_name: "carmen/ROBOTLASER2", definition: ROBOT_LASER },
    LineKind { keyword: "RAWLASER1", type_name: "carmen/RAWLASER1", definition: RAW_LASER },
    LineKind { keyword: "RAWLASER2", type_name: "carmen/RAWLASER2", definition: RAW_LASER },
    LineKind {
        keyword: "LASER_READING",
        type_name: "carmen/LASER_READING",
        definition: LASER_READING,
    },
    LineKind { keyword: "TRUEPOS", type_name: "carmen/TRUEPOS", definition: TRUE_POSE },
    LineKind { keyword: "ODOM", type_name: "carmen/ODOM", definition: ODOM },
    LineKind { keyword: "ODOM", type_name: "carmen/SHORT_ODOM", definition: SHORT_ODOM },
];

/// The index of the kind of a line, and the kind. A line of odometry with four numbers is GMapping's.
pub(super) fn kind_of(keyword: &[u8], line: &[u8]) -> Option<(u32, &'static LineKind)> {
    let mut kinds = (0..).zip(&KINDS).filter(|(_, kind)| kind.keyword.as_bytes() == keyword);
    let (first, other) = (kinds.next()?, kinds.next());
    let words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    Some(other.filter(|_| words.count() == 5).unwrap_or(first))
}

/// The first word of a line with a parameter: its name, its value, and times that are often 0.
pub(super) const PARAMETER: &[u8] = b"PARAM";

/// Where a scanner is on its robot, in metres and radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ScannerOffset {
    ahead: f64,
    left: f64,
    turn: f64,
}

impl ScannerOffset {
    fn on_robot(self) -> Isometry2<f64> {
        Isometry2::new(Vector2::new(self.ahead, self.left), self.turn)
    }
}

/// What the parameters of a log state of its robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Parameters {
    front: ScannerOffset,
    rear: ScannerOffset,
}

impl Default for Parameters {
    fn default() -> Self {
        let front = ScannerOffset { ahead: 0.0, left: 0.0, turn: 0.0 };
        Self { front, rear: ScannerOffset { turn: PI, ..front } }
    }
}

impl Parameters {
    /// Reads a `PARAM` line. One that is not used, or not a number, is ignored.
    pub(super) fn read(&mut self, line: &[u8]) {
        let Ok(line) = std::str::from_utf8(line) else { return };
        let mut words = line.split_ascii_whitespace().skip(1);
        let (Some(name), Some(Ok(value))) = (words.next(), words.next().map(str::parse::<f64>))
        else {
            return;
        };
        if !value.is_finite() {
            return;
        }
        match name {
            "robot_frontlaser_offset" => self.front.ahead = value,
            "robot_frontlaser_side_offset" => self.front.left = value,
            "robot_frontlaser_angular_offset" => self.front.turn = value.to_radians(),
            "robot_rearlaser_offset" => self.rear.ahead = value,
            "robot_rearlaser_side_offset" => self.rear.left = value,
            "robot_rearlaser_angular_offset" => self.rear.turn = value.to_radians(),
            _ => {}
        }
    }
}

pub(super) fn keyword(line: &[u8]) -> &[u8] {
    let line = line.trim_ascii();
    line.split(u8::is_ascii_whitespace).next().unwrap_or_default()
}

/// The logger's clock in a line: its last word, which is a number of seconds.
pub(super) fn logger_time(line: &[u8]) -> Option<(&str, f64)> {
    let last = line.trim_ascii().rsplit(u8::is_ascii_whitespace).next()?;
    let word = std::str::from_utf8(last).ok()?;
    Some((word, word.parse().ok()?))
}

pub(super) fn is_carmen(head: &[u8]) -> bool {
    let mut lines = head.split(|&byte| byte == b'\n');
    lines.any(|line| {
        let word = keyword(line);
        let is_kind = word == PARAMETER || KINDS.iter().any(|kind| kind.keyword.as_bytes() == word);
        is_kind && line.starts_with(word) && line.len() > word.len()
    })
}
