//! Turning by an angle and going a distance, in a control loop on odometry. Section 2.5.

use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use super::{CLEARANCE, COMMAND, PERIOD, SONARS, SPEED, TURN_RATE, WheelSpeeds, sonar_direction};
use crate::robot::RobotError;

/// The wheels, their odometry and the sonars: a simulated robot's, or a real one's.
pub trait Base {
    /// Lets the wheels turn so for one period of the control loop, and reads what comes of it.
    ///
    /// # Errors
    /// Where the base does not answer.
    fn drive(&mut self, wheels: WheelSpeeds) -> Result<Reading, RobotError>;

    /// What was last read.
    fn reading(&self) -> Reading;

    /// By how much a command outlasts its period before the next one takes over, in seconds: what is
    /// known of it is that old, and the last step of a motion is shorter by as much.
    fn lag(&self) -> f64 {
        0.0
    }

    /// How far from its body a sonar hears something, in metres; infinite for nothing.
    fn sonar(&self, sonar: usize) -> f64;
}

/// What a base tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// In seconds since it was switched on.
    pub time: f64,
    /// Where it is by its wheels.
    pub odometry: Odometry,
}

/// The motions of a base: within its limits, and never longer than they should take.
#[derive(Debug)]
pub struct Drive<'a, B>(pub &'a mut B);

/// What is left of a motion does not matter below this: half a unit of odometry.
const NEAR: f64 = 0.0015;
/// The same of a turn, in radians.
const NEAR_ANGLE: f64 = 0.002;
/// Of what a motion is off its heading, this part is mended in one period.
const MEND: f64 = 0.3;
/// Sonars that look no farther aside than this look where the robot goes: 45 degrees and a little.
const WHITHER: f64 = 0.8;
/// A motion may take this much longer than it should.
const PATIENCE: f64 = 1.5;

impl<B: Base> Drive<'_, B> {
    /// Turns on the spot by so many radians, counter-clockwise.
    ///
    /// # Errors
    /// The base's.
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
            let now = self.0.drive(WheelSpeeds::of(0.0, left / lasting))?.odometry;
            turned += wrapped(now.heading - last.heading);
            last = now;
        }
        self.stop()
    }

    /// Goes straight ahead by so many metres, at most as far as one command may; or as far as there is
    /// room.
    ///
    /// # Errors
    /// The base's.
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
            self.0.drive(WheelSpeeds::of(most / lasting, MEND * off / PERIOD))?;
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
    /// The base's.
    pub fn stop(&mut self) -> Result<(), RobotError> {
        self.0.drive(WheelSpeeds::STOP).map(|_| ())
    }
}

/// How many periods a motion may take that should take so many seconds.
fn periods(seconds: f64) -> u32 {
    (seconds / PERIOD * PATIENCE) as u32 + 4
}
