//! How a base obeys: how late, and how fast it brakes, measured by odometry.

use crate::robot::{Sample, TimedOdometry};
use crate::superscout::{BaseResponse, PERIOD, WheelSpeeds};
use toposlam_model::driving::scene::wrapped;

/// Before it was measured, in seconds.
const UNKNOWN: f64 = 0.15;
/// The greatest, in seconds,
const MOST: f64 = 1.0;
/// and the accuracy.
const STEP: f64 = 0.01;
/// The part of a new measurement in the next estimate.
const WEIGHT: f64 = 0.3;
/// A motion with a longer time between two of its readings is not measured, in seconds: the robot was paused, messages were
/// lost, or a clock jumped.
const GAP: f64 = 2.5 * PERIOD;
/// Shorter motions are not measured, in metres or radians.
const LEAST: f64 = 0.08;
/// Uncertainty of what a wheel does of a command, as a share; of a reading, in metres or radians.
const SLIP: f64 = 0.1;
const READING: f64 = 0.003;
/// A motion was not carried out if odometry shows less than this part of what was commanded.
const CARRIED_OUT: f64 = 0.1;
/// The limits of what is commanded, in metres or radians a second, each second: most bases for a floor can do that.
const ACCELERATION: f64 = 0.3;
const TURN_ACCELERATION: f64 = 0.6;
/// A base that goes on for longer than this after a stop, besides its lag, brakes more slowly, in metres or radians:
const COASTS: f64 = 0.01;
/// the limit is this part of the last one,
const GENTLER: f64 = 0.7;
/// and at least this part of the first.
const GENTLEST: f64 = 0.15;

/// Measures a base by its motions: each begins and ends at a standstill.
#[derive(Clone, Debug)]
pub(super) struct ResponseMeter {
    lag: Option<f64>,
    /// The length of a period, in seconds.
    period: f64,
    /// The limits, in metres or radians a second, each second.
    acceleration: f64,
    turn_acceleration: f64,
    /// The present motion: its begin, and each command with the odometry after it.
    motion: Vec<Sample>,
    /// Whether the present motion does not show how the base obeys.
    is_discarded: bool,
    /// The number of motions in a row that were not carried out.
    still: u32,
}

impl Default for ResponseMeter {
    fn default() -> Self {
        Self {
            lag: None,
            period: PERIOD,
            acceleration: ACCELERATION,
            turn_acceleration: TURN_ACCELERATION,
            motion: Vec::new(),
            is_discarded: false,
            still: 0,
        }
    }
}

impl ResponseMeter {
    pub(super) fn response(&self) -> BaseResponse {
        BaseResponse {
            period: self.period,
            lag: self.lag.unwrap_or(UNKNOWN),
            acceleration: self.acceleration,
            turn_acceleration: self.turn_acceleration,
        }
    }

    /// The number of motions in a row that were not carried out, up to now.
    pub(super) fn still(&self) -> u32 {
        self.still
    }

    /// Does not measure the present motion: the base did not get all of its commands.
    pub(super) fn discard(&mut self) {
        self.is_discarded = !self.motion.is_empty();
    }

    /// Adds a command, and the odometry before and after it.
    pub(super) fn add(&mut self, wheels: WheelSpeeds, before: TimedOdometry, after: TimedOdometry) {
        if self.motion.is_empty() {
            if wheels == WheelSpeeds::STOP {
                return;
            }
            self.motion.push(Sample { speed: 0.0, turning: 0.0, reading: before });
        }
        let is_stop = wheels == WheelSpeeds::STOP;
        // A base may take longer to stand.
        let measured = if is_stop { before } else { after };
        let last = self.motion.last().map_or(measured.time, |last| last.reading.time);
        self.is_discarded |= measured.time - last > GAP;
        let (speed, turning) = (wheels.speed(), wheels.turn_rate());
        self.motion.push(Sample { speed, turning, reading: after });
        if is_stop {
            let motion = Motion::new(&std::mem::take(&mut self.motion));
            if !std::mem::take(&mut self.is_discarded) {
                self.learn(&motion);
            }
        } else {
            // A late message makes one period longer, not all.
            let lasted = after.time - before.time;
            self.period += WEIGHT * (lasted.clamp(PERIOD, 2.0 * PERIOD) - self.period);
        }
    }

    fn learn(&mut self, motion: &Motion) {
        let commanded = motion.commanded(f64::INFINITY);
        if commanded.abs() < LEAST {
            return;
        }
        let moved = motion.readings.last().map_or(0.0, |(_, moved)| *moved);
        if moved / commanded < CARRIED_OUT {
            self.still += 1;
            return;
        }
        self.still = 0;
        let found = motion.lag();
        let lag = self.lag.map_or(found, |lag| lag + WEIGHT * (found - lag));
        self.lag = Some(lag);
        if motion.coasted(lag) > COASTS {
            let (limit, first) = if motion.is_turn {
                (&mut self.turn_acceleration, TURN_ACCELERATION)
            } else {
                (&mut self.acceleration, ACCELERATION)
            };
            *limit = (*limit * GENTLER).max(first * GENTLEST);
        }
    }
}

/// A motion by its commands and by odometry, along the way or about the axis.
struct Motion {
    is_turn: bool,
    /// The time from which on each speed was commanded.
    speeds: Vec<(f64, f64)>,
    /// The way since the beginning, or the turn, at a time.
    readings: Vec<(f64, f64)>,
}

impl Motion {
    fn new(samples: &[Sample]) -> Self {
        let sum =
            |of: fn(&Sample) -> f64| samples.iter().map(|sample| of(sample).abs()).sum::<f64>();
        let is_turn = sum(|sample| sample.turning) > sum(|sample| sample.speed);
        let (mut speeds, mut readings, mut moved) = (Vec::new(), Vec::new(), 0.0);
        for pair in samples.windows(2) {
            let [last, next] = [pair[0].reading, pair[1].reading];
            speeds.push((last.time, if is_turn { pair[1].turning } else { pair[1].speed }));
            moved += if is_turn {
                wrapped(next.odometry.heading - last.odometry.heading)
            } else {
                next.odometry.distance(&last.odometry)
            };
            readings.push((next.time, moved));
        }
        Self { is_turn, speeds, readings }
    }

    /// What was commanded up to a time.
    fn commanded(&self, until: f64) -> f64 {
        let ends = self.speeds.iter().skip(1).map(|(begin, _)| *begin);
        let all = self.speeds.iter().zip(ends.chain([f64::MAX]));
        // The last command is the stop.
        all.map(
            |(&(begin, speed), end)| {
                if speed == 0.0 { 0.0 } else { speed * (end.min(until) - begin).max(0.0) }
            },
        )
        .sum()
    }

    /// How far it went after the stop, besides what was to come with this lag.
    fn coasted(&self, lag: f64) -> f64 {
        let [.., (stopped, at), (_, end)] = self.readings[..] else { return 0.0 };
        let all = self.commanded(f64::INFINITY);
        (end - at - (all - self.commanded(stopped - lag))) * all.signum()
    }

    /// The lag with which the readings fit best to a part of what was commanded. A part that is far from all of it is less
    /// likely.
    fn lag(&self) -> f64 {
        let misfit = |lag: f64| {
            let weight = (READING / SLIP).powi(2);
            let (mut both, mut square) = (weight, weight);
            for (time, moved) in &self.readings {
                let commanded = self.commanded(time - lag);
                both += commanded * moved;
                square += commanded * commanded;
            }
            let part = both / square;
            let off = |(time, moved): &(f64, f64)| moved - part * self.commanded(time - lag);
            self.readings.iter().map(|reading| off(reading).powi(2)).sum::<f64>()
                + weight * (part - 1.0).powi(2)
        };
        let lags = (0..=(MOST / STEP) as u32).map(|step| f64::from(step) * STEP);
        let fits = lags.map(|lag| (lag, misfit(lag)));
        fits.min_by(|one, other| one.1.total_cmp(&other.1)).map_or(UNKNOWN, |(lag, _)| lag)
    }
}
