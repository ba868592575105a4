//! The Nomad SuperScout: wheels, odometry, sonars, and limits of commands. Section 2.5.

mod drive;
mod odometer;
mod wheels;

pub use drive::{Base, BaseResponse, Drive};
pub use odometer::{Odometer, along_arc};
pub use wheels::WheelSpeeds;

use std::f64::consts::{PI, TAU};

use toposlam_model::measurement::MeasurementNoise;

/// The distance between the wheels, in metres.
// paper: hardware.drive
pub const WHEEL_BASE: f64 = 0.3452;
/// The robot's radius, in metres.
pub const RADIUS: f64 = toposlam_vision::params::ROBOT_RADIUS;
/// The highest speed, in metres a second.
pub const SPEED: f64 = 0.20;
/// The highest turn rate on the spot, in radians a second: 20 degrees.
pub const TURN_RATE: f64 = 20.0 / 180.0 * PI;
/// The longest distance of one command, in metres.
pub const COMMAND: f64 = 0.5;
/// The control loop's period, in seconds.
pub const PERIOD: f64 = 0.25;
/// The robot stops by itself this long after the last command, in seconds.
pub const WATCHDOG: f64 = 0.5;
/// The number of sonars. The first looks ahead; the others follow counter-clockwise.
// paper: hardware.sonar
pub const SONARS: usize = 16;
/// The least distance to anything ahead, in metres from the robot's body.
pub const CLEARANCE: f64 = 0.20;

/// The uncertainty of the hallways that it measures. Two lengths of one hallway, measured by simulated robots with
/// the errors of a SuperScout on tiles, differ by 0.05 m (standard deviation) and by at most 0.3 m; the turns drift
/// by 0.03 radians per metre.
pub const MEASUREMENT_NOISE: MeasurementNoise = MeasurementNoise {
    standing: 0.05,
    wandering: 0.01,
    scale: 0.0,
    door: 0.04,
    turning: 0.055,
    drift: 0.03,
};

/// The direction of a sonar relative to the robot's heading, in (-pi, pi].
pub fn sonar_direction(sonar: usize) -> f64 {
    let place = if sonar <= SONARS / 2 { sonar as f64 } else { sonar as f64 - SONARS as f64 };
    place * (TAU / SONARS as f64)
}
