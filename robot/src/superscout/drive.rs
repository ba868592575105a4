//! Turning by an angle and going a distance, in a control loop on odometry. Section 2.5.

use toposlam_model::driving::scene::wrapped;

use super::{CLEARANCE, COMMAND, PERIOD, SONARS, SPEED, TURN_RATE, WheelSpeeds, sonar_direction};
use crate::robot::{RobotError, TimedOdometry};

/// The wheels, their odometry and the sonars of a simulated or a real robot.
pub trait Base {
    /// Waits while the run is paused. Whether it was paused since the last call: then the robot stands, and the last
    /// commands are void. What is decided after it is decided with the newest readings.
    ///
    /// # Errors
    /// Returns an error if the robot must not go on.
    fn wait_for_pause(&mut self) -> Result<bool, RobotError> {
        Ok(false)
    }

    /// Turns the wheels for one period of the control loop, and returns the odometry after it.
    ///
    /// # Errors
    /// Returns an error if the base does not answer.
    fn drive(&mut self, wheels: WheelSpeeds) -> Result<TimedOdometry, RobotError>;

    fn reading(&self) -> TimedOdometry;

    fn response(&self) -> BaseResponse {
        BaseResponse::IDEAL
    }

    /// The range that a sonar measures from the robot's body, in metres; infinite if there is no echo.
    fn sonar(&self, _sonar: usize) -> f64 {
        f64::INFINITY
    }

    /// How far the robot may go ahead, in metres: up to the clearance before what its sonars measure.
    fn room(&self) -> f64 {
        let ahead = (0..SONARS).filter(|&sonar| sonar_direction(sonar).abs() <= SONAR_AHEAD);
        ahead.map(|sonar| self.sonar(sonar) - CLEARANCE).fold(f64::INFINITY, f64::min)
    }
}

/// How a base answers to commands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseResponse {
    /// From one command to the next, in seconds.
    pub period: f64,
    /// The time from a command until odometry shows it, in seconds.
    pub lag: f64,
    /// The greatest change of the speed that is commanded, in metres a second, each second. It may be infinite.
    pub acceleration: f64,
    /// The same of the turn rate, in radians a second, each second.
    pub turn_acceleration: f64,
}

impl BaseResponse {
    /// Every command is carried out at once.
    pub const IDEAL: Self = Self {
        period: PERIOD,
        lag: 0.0,
        acceleration: f64::INFINITY,
        turn_acceleration: f64::INFINITY,
    };

    /// The speed for the next period if so much is left, above zero: the robot can then brake evenly.
    fn speed(&self, left: f64, acceleration: f64, last: f64) -> f64 {
        let Self { period, .. } = *self;
        if acceleration.is_infinite() {
            return left / period;
        }
        // The way of this period and of braking after it is v * period + v^2 / (2 * acceleration).
        let braking =
            acceleration * ((period * period + 2.0 * left / acceleration).sqrt() - period);
        braking.min(last + acceleration * period)
    }
}

/// What was commanded in a motion, with the time from which on.
#[derive(Debug, Default)]
struct SentSpeeds(Vec<(f64, f64)>);

impl SentSpeeds {
    /// The way that is still to come at this time, of commands that act after a lag.
    fn coming(&self, now: f64, lag: f64) -> f64 {
        let ends = self.0.iter().skip(1).map(|(begin, _)| *begin).chain([now]);
        let acting = self.0.iter().zip(ends);
        acting.map(|(&(begin, speed), end)| speed * (end - begin.max(now - lag)).max(0.0)).sum()
    }

    fn last(&self) -> f64 {
        self.0.last().map_or(0.0, |(_, speed)| *speed)
    }
}

/// Motions of a base, within its limits and a time limit.
#[derive(Debug)]
pub struct Drive<'a, B>(pub &'a mut B);

/// A motion is complete when less than this is left, in metres: half a unit of odometry.
const NEAR: f64 = 0.0015;
/// The same for a turn, in radians.
const NEAR_ANGLE: f64 = 0.002;
/// If more than this is left when the robot stands, the motion goes on, in metres,
const REST: f64 = 0.01;
/// and for a turn, in radians;
const REST_ANGLE: f64 = 0.01;
/// at most this many times.
const RESUMED: u32 = 2;
/// The part of a heading error that is corrected in one period.
const HEADING_GAIN: f64 = 0.3;
/// Sonars up to this angle from straight ahead look where the robot goes: a little over 45 degrees.
const SONAR_AHEAD: f64 = 0.8;
/// A motion may take this many times its expected duration.
const PATIENCE: f64 = 1.5;

impl<B: Base> Drive<'_, B> {
    /// Turns on the spot by an angle in radians, counter-clockwise.
    ///
    /// # Errors
    /// Returns the error of the base.
    pub fn turn(&mut self, angle: f64) -> Result<(), RobotError> {
        let angle = wrapped(angle);
        let mut last = self.0.reading().odometry;
        let mut turned = 0.0;
        for _ in 0..=RESUMED {
            let begun = angle - turned;
            let mut sent = SentSpeeds::default();
            for _ in 0..self.periods(begun.abs() / TURN_RATE) {
                if self.0.wait_for_pause()? {
                    sent = SentSpeeds::default();
                    let there = self.0.reading().odometry;
                    turned += wrapped(there.heading - last.heading);
                    last = there;
                }
                let (now, response) = (self.0.reading().time, self.0.response());
                let left = angle - turned - sent.coming(now, response.lag);
                if left.abs() <= NEAR_ANGLE {
                    break;
                }
                // It turns back only from a standstill.
                let before = (sent.last() * left.signum()).max(0.0);
                let rate = response.speed(left.abs(), response.turn_acceleration, before);
                let rate = rate.min(TURN_RATE).copysign(left);
                sent.0.push((now, rate));
                let there = self.0.drive(WheelSpeeds::from_motion(0.0, rate))?.odometry;
                turned += wrapped(there.heading - last.heading);
                last = there;
            }
            self.stop()?;
            let there = self.0.reading().odometry;
            turned += wrapped(there.heading - last.heading);
            last = there;
            if !self.goes_on(begun, angle - turned, REST_ANGLE) {
                break;
            }
        }
        Ok(())
    }

    /// Goes straight ahead by a distance in metres, at most the limit of one command, and only as far as
    /// there is room.
    ///
    /// # Errors
    /// Returns the error of the base.
    pub fn forward(&mut self, distance: f64) -> Result<(), RobotError> {
        let distance = distance.clamp(0.0, COMMAND);
        let begun = self.0.reading().odometry;
        for _ in 0..=RESUMED {
            let mut sent = SentSpeeds::default();
            let mut turns = SentSpeeds::default();
            let gone = self.0.reading().odometry.distance(&begun);
            for _ in 0..self.periods((distance - gone).max(0.0) / SPEED) {
                if self.0.wait_for_pause()? {
                    (sent, turns) = (SentSpeeds::default(), SentSpeeds::default());
                }
                let TimedOdometry { time, odometry } = self.0.reading();
                let response = self.0.response();
                let left = distance - odometry.distance(&begun);
                let most = self.0.room().min(left) - sent.coming(time, response.lag);
                if most <= NEAR {
                    break;
                }
                let off =
                    wrapped(begun.heading - odometry.heading) - turns.coming(time, response.lag);
                let speed = response.speed(most, response.acceleration, sent.last()).min(SPEED);
                let turn = HEADING_GAIN * off / PERIOD;
                sent.0.push((time, speed));
                turns.0.push((time, turn));
                self.0.drive(WheelSpeeds::from_motion(speed, turn))?;
            }
            self.stop()?;
            let left = distance - self.0.reading().odometry.distance(&begun);
            if self.0.room().min(left) <= REST || !self.goes_on(distance - gone, left, REST) {
                break;
            }
        }
        Ok(())
    }

    /// Whether a motion of which so much was left before, and after it, goes on. One that was not carried out does not.
    fn goes_on(&self, before: f64, after: f64, rest: f64) -> bool {
        self.0.response() != BaseResponse::IDEAL
            && (rest..before.abs() / 2.0).contains(&after.abs())
    }

    /// Stops.
    ///
    /// # Errors
    /// Returns the error of the base.
    pub fn stop(&mut self) -> Result<(), RobotError> {
        self.0.drive(WheelSpeeds::STOP).map(|_| ())
    }

    /// The most periods that a motion of this duration at full speed may take.
    fn periods(&self, seconds: f64) -> u32 {
        let BaseResponse { period, lag, acceleration, .. } = self.0.response();
        let begins = lag + if acceleration.is_finite() { 2.0 * SPEED / acceleration } else { 0.0 };
        ((seconds + begins) / period * PATIENCE) as u32 + 4
    }
}
