//! Turning by an angle and going a distance, in a control loop on odometry. Section 2.5.

use toposlam_model::driving::scene::wrapped;

use super::{CLEARANCE, COMMAND, PERIOD, SONARS, SPEED, TURN_RATE, WheelSpeeds, sonar_direction};
use crate::robot::{RobotError, TimedOdometry};

/// The wheels, their odometry and the sonars of a simulated or a real robot.
pub trait Base {
    /// Turns the wheels for one period of the control loop, and returns the odometry after it.
    ///
    /// # Errors
    /// Returns an error if the base does not answer.
    fn drive(&mut self, wheels: WheelSpeeds) -> Result<TimedOdometry, RobotError>;

    fn reading(&self) -> TimedOdometry;

    /// How long a command acts after its period, in seconds. Readings are this old, and the last step of
    /// a motion is shorter by as much.
    fn lag(&self) -> f64 {
        0.0
    }

    /// The range that a sonar measures from the robot's body, in metres; infinite if there is no echo.
    fn sonar(&self, sonar: usize) -> f64;
}

/// Motions of a base, within its limits and a time limit.
#[derive(Debug)]
pub struct Drive<'a, B>(pub &'a mut B);

/// A motion is complete when less than this is left, in metres: half a unit of odometry.
const NEAR: f64 = 0.0015;
/// The same for a turn, in radians.
const NEAR_ANGLE: f64 = 0.002;
/// The part of a heading error that is corrected in one period.
const MEND: f64 = 0.3;
/// Sonars up to this angle from straight ahead look where the robot goes: a little over 45 degrees.
const WHITHER: f64 = 0.8;
/// A motion may take this many times its expected duration.
const PATIENCE: f64 = 1.5;

impl<B: Base> Drive<'_, B> {
    /// Turns on the spot by an angle in radians, counter-clockwise.
    ///
    /// # Errors
    /// Returns the error of the base.
    pub fn turn(&mut self, angle: f64) -> Result<(), RobotError> {
        let angle = wrapped(angle);
        let begun = self.0.reading().odometry;
        let lasting = PERIOD + self.0.lag();
        let mut turned = 0.0;
        let mut last = begun;
        for _ in 0..periods(angle.abs() / TURN_RATE) {
            let left = angle - turned;
            if left.abs() <= NEAR_ANGLE {
                break;
            }
            let now = self.0.drive(WheelSpeeds::from_motion(0.0, left / lasting))?.odometry;
            turned += wrapped(now.heading - last.heading);
            last = now;
        }
        self.stop()
    }

    /// Goes straight ahead by a distance in metres, at most the limit of one command, and only as far as
    /// there is room.
    ///
    /// # Errors
    /// Returns the error of the base.
    pub fn forward(&mut self, distance: f64) -> Result<(), RobotError> {
        let distance = distance.clamp(0.0, COMMAND);
        let lasting = PERIOD + self.0.lag();
        let begun = self.0.reading().odometry;
        for _ in 0..periods(distance / SPEED) {
            let odometry = self.0.reading().odometry;
            let left = distance - odometry.distance(&begun);
            let most = self.room().min(left);
            if most <= NEAR {
                break;
            }
            let off = wrapped(begun.heading - odometry.heading);
            self.0.drive(WheelSpeeds::from_motion(most / lasting, MEND * off / PERIOD))?;
        }
        self.stop()
    }

    /// How far the robot may go ahead by its sonars.
    fn room(&self) -> f64 {
        let ahead = (0..SONARS).filter(|&sonar| sonar_direction(sonar).abs() <= WHITHER);
        ahead.map(|sonar| self.0.sonar(sonar) - CLEARANCE).fold(f64::INFINITY, f64::min)
    }

    /// Stops.
    ///
    /// # Errors
    /// Returns the error of the base.
    pub fn stop(&mut self) -> Result<(), RobotError> {
        self.0.drive(WheelSpeeds::STOP).map(|_| ())
    }
}

/// The most periods that a motion of this expected duration may take.
fn periods(seconds: f64) -> u32 {
    (seconds / PERIOD * PATIENCE) as u32 + 4
}
