//! The Nomad SuperScout: its wheels, its odometry, its sonars, and what it may be commanded. Section
//! 2.5.

mod drive;
mod odometer;
mod wheels;

pub use drive::{Base, Drive, Reading};
pub use odometer::{Odometer, along_arc};
pub use wheels::WheelSpeeds;

use std::f64::consts::{PI, TAU};

/// From one wheel to the other, in metres.
// paper: hardware.drive
pub const WHEEL_BASE: f64 = 0.3452;
/// The robot's radius, in metres.
pub const RADIUS: f64 = 0.205;
/// As fast as it may go, in metres a second.
pub const SPEED: f64 = 0.20;
/// As fast as it may turn on the spot, in radians a second: 20 degrees.
pub const TURN_RATE: f64 = 20.0 / 180.0 * PI;
/// As far as one command may take it, in metres.
pub const COMMAND: f64 = 0.5;
/// The control loop's period, in seconds.
pub const PERIOD: f64 = 0.25;
/// The robot stops by itself when no command has come for so long, in seconds.
pub const WATCHDOG: f64 = 0.5;
/// The number of its sonars; the first looks ahead, the others follow counter-clockwise.
// paper: hardware.sonar
pub const SONARS: usize = 16;
/// It never goes nearer to anything ahead than this, in metres from its body.
pub const CLEARANCE: f64 = 0.20;

/// What a sonar looks along, relative to the robot's heading, in (-pi, pi].
#[must_use]
pub fn sonar_direction(sonar: usize) -> f64 {
    let place = if sonar <= SONARS / 2 { sonar as f64 } else { sonar as f64 - SONARS as f64 };
    place * (TAU / SONARS as f64)
}
