//! CARMEN logs (`logger_io.h` of the Carnegie Mellon Robot Navigation Toolkit): one message a line, its keyword first,
//! then its fields, separated by spaces. A list stands behind the number of its elements. The last field is the
//! logger's clock; the third last is the clock of the program that sent the message.

mod fields;
mod scan;

pub(super) use fields::decode;
pub(super) use scan::{RecordedScan, reading};

pub(super) struct LineKind {
    pub(super) keyword: &'static str,
    pub(super) type_name: &'static str,
    /// The fields after the keyword, as a definition of ROS 1.
    pub(super) definition: &'static str,
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
const ODOM: &str = "float64 x\nfloat64 y\nfloat64 theta\nfloat64 tv\nfloat64 rv\nfloat64 accel\n\
    float64 ipc_timestamp\nstring ipc_hostname\nfloat64 logger_timestamp\n";
const TRUE_POSE: &str = "float64 x\nfloat64 y\nfloat64 theta\nfloat64 odom_x\nfloat64 odom_y\n\
    float64 odom_theta\nfloat64 ipc_timestamp\nstring ipc_hostname\nfloat64 logger_timestamp\n";

/// The kinds of lines that are read. Others are skipped.
pub(super) const KINDS: [LineKind; 5] = [
    LineKind { keyword: "FLASER", type_name: "carmen/FLASER", definition: OLD_LASER },
    LineKind { keyword: "RLASER", type_name: "carmen/RLASER", definition: OLD_LASER },
    LineKind { keyword: "ROBOTLASER1", type_name: "carmen/ROBOTLASER1", definition: ROBOT_LASER },
    LineKind { keyword: "ODOM", type_name: "carmen/ODOM", definition: ODOM },
    LineKind { keyword: "TRUEPOS", type_name: "carmen/TRUEPOS", definition: TRUE_POSE },
];

/// The first word of a line with a parameter: its name, its value, and times that are often 0.
pub(super) const PARAMETER: &[u8] = b"PARAM";

/// What the parameters of a log state of its robot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Parameters {
    /// How far the front scanner is ahead of the robot's centre, in metres.
    pub(super) front_offset: f64,
    /// How far the rear scanner is ahead of the robot's centre, in metres.
    pub(super) rear_offset: f64,
}

impl Parameters {
    /// Reads a `PARAM` line. One that is not used, or not a number, is ignored.
    pub(super) fn read(&mut self, line: &[u8]) {
        let Ok(line) = std::str::from_utf8(line) else { return };
        let mut words = line.split_ascii_whitespace().skip(1);
        let (Some(name), Some(Ok(value))) = (words.next(), words.next().map(str::parse)) else {
            return;
        };
        let value: f64 = value;
        match name {
            _ if !value.is_finite() => {}
            "robot_frontlaser_offset" => self.front_offset = value,
            "robot_rearlaser_offset" => self.rear_offset = value,
            _ => {}
        }
    }
}

pub(super) fn keyword(line: &[u8]) -> &[u8] {
    let line = line.trim_ascii();
    line.split(u8::is_ascii_whitespace).next().unwrap_or_default()
}

/// The logger's clock in a line, in seconds: its last word.
pub(super) fn logger_time(line: &[u8]) -> Option<f64> {
    let last = line.trim_ascii().rsplit(u8::is_ascii_whitespace).next()?;
    std::str::from_utf8(last).ok()?.parse().ok()
}

pub(super) fn is_carmen(head: &[u8]) -> bool {
    let mut lines = head.split(|&byte| byte == b'\n');
    lines.any(|line| {
        let word = keyword(line);
        let is_kind = word == PARAMETER || KINDS.iter().any(|kind| kind.keyword.as_bytes() == word);
        is_kind && line.starts_with(word) && line.len() > word.len()
    })
}
