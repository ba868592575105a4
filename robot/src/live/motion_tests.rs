//! Motions of bases that obey late, accelerate slowly, and whose wheels do not do what they should.

use std::collections::VecDeque;

use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use super::{SECOND, base::Standing, messages::Reckoning, response::ResponseMeter};
use crate::{
    robot::{RobotError, TimedOdometry},
    superscout::{Base, BaseResponse, Drive, PERIOD, WheelSpeeds, along_arc},
};

/// Of the simulation, in seconds.
const TICK: f64 = 0.002;

/// A base with odometry so many times a second. Lengths are in metres, times in seconds.
struct SmallBase {
    readings: f64,
    /// The time until a command acts.
    delay: f64,
    /// The time in which the wheels reach most of a new speed.
    inertia: f64,
    acceleration: f64,
    /// What the wheels do of a command, as odometry shows it.
    parts: [f64; 2],
    room: f64,
    ticks: u64,
    waiting: VecDeque<(f64, WheelSpeeds)>,
    wanted: WheelSpeeds,
    actual: WheelSpeeds,
    at: Odometry,
    last: TimedOdometry,
    meter: ResponseMeter,
    /// Each command and its time.
    commands: Vec<(f64, WheelSpeeds)>,
}

impl SmallBase {
    fn new(readings: f64, lag: f64, acceleration: f64) -> Self {
        Self {
            readings,
            delay: lag / 2.0,
            inertia: lag / 2.0,
            acceleration,
            parts: [1.0; 2],
            room: f64::INFINITY,
            ticks: 0,
            waiting: VecDeque::new(),
            wanted: WheelSpeeds::STOP,
            actual: WheelSpeeds::STOP,
            at: Odometry::default(),
            last: TimedOdometry::default(),
            meter: ResponseMeter::default(),
            commands: Vec::new(),
        }
    }

    /// One tick; the odometry if there is one.
    fn tick(&mut self) -> Option<TimedOdometry> {
        self.ticks += 1;
        let time = self.ticks as f64 * TICK;
        while let Some((_, wheels)) = self.waiting.pop_front_if(|(at, _)| *at <= time) {
            self.wanted = wheels;
        }
        let [wanted, actual] = [self.wanted, self.actual].map(|w| [w.left, w.right]);
        let [left, right] = [0, 1].map(|wheel| {
            let step =
                (wanted[wheel] * self.parts[wheel] - actual[wheel]) * TICK / self.inertia.max(TICK);
            let limit = self.acceleration * TICK;
            actual[wheel] + step.clamp(-limit, limit)
        });
        self.actual = WheelSpeeds { left, right };
        self.at = along_arc(&self.at, self.actual, TICK);
        let every = (1.0 / self.readings / TICK).round() as u64;
        self.ticks.is_multiple_of(every).then_some(TimedOdometry { time, odometry: self.at })
    }

    fn turn(&mut self, angle: f64) -> f64 {
        let begun = self.at;
        Drive(self).turn(angle).unwrap();
        wrapped(self.at.heading - begun.heading - angle)
    }

    fn forward(&mut self, distance: f64) -> f64 {
        let begun = self.at;
        Drive(self).forward(distance).unwrap();
        self.at.distance(&begun) - distance
    }
}

impl Base for SmallBase {
    fn drive(&mut self, wheels: WheelSpeeds) -> Result<TimedOdometry, RobotError> {
        let (before, now) = (self.last, self.ticks as f64 * TICK);
        self.waiting.push_back((now + self.delay, wheels));
        self.commands.push((now, wheels));
        let mut standing = Standing::default();
        loop {
            let Some(read) = self.tick() else { continue };
            let stamp = (read.time * SECOND as f64).round() as u64;
            let stands = standing.is_seen(Reckoning { stamp, at: read.odometry, wheels });
            if read.time >= before.time + PERIOD - 1e-9 && (wheels != WheelSpeeds::STOP || stands) {
                self.last = read;
                self.meter.add(wheels, before, read);
                return Ok(read);
            }
        }
    }

    fn reading(&self) -> TimedOdometry {
        self.last
    }

    fn response(&self) -> BaseResponse {
        self.meter.response()
    }

    fn room(&self) -> f64 {
        self.room - self.last.odometry.position[0]
    }
}

/// Turns in radians, each with a way in metres.
const MOTIONS: [(f64, f64); 5] = [(1.0, 0.5), (-1.6, 0.3), (3.1, 0.5), (0.1, 0.1), (-0.5, 0.5)];

#[test]
fn motions_end_where_they_should_whatever_the_lag_and_however_often_odometry_comes() {
    for lag in [0.05, 0.1, 0.2, 0.3, 0.5] {
        for readings in [10.0, 20.0, 50.0, 100.0] {
            let mut base = SmallBase::new(readings, lag, 0.5);
            for (angle, distance) in MOTIONS {
                let off = [base.turn(angle), base.forward(distance)];
                let most = if lag < 0.4 { 0.006 } else { 0.01 };
                assert!(
                    off.iter().all(|off| off.abs() < most),
                    "{lag} s, {readings} a second: {off:?}"
                );
            }
            let measured = base.response().lag;
            assert!((measured - lag).abs() < 0.05, "{lag} s, {readings} a second: {measured} s");
        }
    }
}

/// Neither the first command nor any later one asks for more than any base can do.
#[test]
fn commands_speed_up_and_slow_down_evenly() {
    let mut base = SmallBase::new(50.0, 0.2, 0.5);
    base.forward(0.5);
    base.turn(2.0);
    let pairs = base.commands.windows(2).map(|pair| {
        let lasted = pair[1].0 - pair[0].0;
        let change = |of: fn(WheelSpeeds) -> f64| (of(pair[1].1) - of(pair[0].1)).abs() / lasted;
        [change(WheelSpeeds::speed), change(WheelSpeeds::turn_rate)]
    });
    for [speed, turning] in pairs {
        assert!(speed < 0.36 && turning < 0.72, "{speed} m/s^2, {turning} rad/s^2");
    }
    let most = base.commands.iter().map(|(_, wheels)| wheels.speed()).fold(0.0, f64::max);
    assert!(most > 0.19, "it reaches its speed: {most} m/s");
}

/// It brakes with less than half of what is asked for at first.
#[test]
fn after_a_few_motions_a_base_that_brakes_slowly_stops_where_it_should() {
    for acceleration in [0.08, 0.12, 0.2] {
        let mut base = SmallBase::new(50.0, 0.1, acceleration);
        let mut off = [[0.0; 2]; 5];
        for _ in 0..2 {
            off = MOTIONS.map(|(angle, distance)| [base.turn(angle), base.forward(distance)]);
        }
        assert!(off.iter().flatten().all(|off| off.abs() < 0.02), "{acceleration} m/s^2: {off:?}");
    }
}

/// The left wheel does 15 % less than the right one, and both less, or more, than what is commanded.
#[test]
fn wheels_that_do_other_than_commanded_still_go_straight_and_as_far_as_they_should() {
    for parts in [[0.7, 0.8], [0.85, 1.0], [1.05, 1.2]] {
        let mut base = SmallBase::new(50.0, 0.15, 0.5);
        base.parts = parts;
        for (angle, distance) in MOTIONS {
            let off = base.turn(angle);
            let heading = base.at.heading;
            let gone = base.forward(distance);
            let aside = wrapped(base.at.heading - heading);
            assert!(off.abs() < 0.03 && gone.abs() < 0.02, "{parts:?}: {off} {gone}");
            assert!(aside.abs() < 0.06, "{parts:?}: {aside}");
        }
    }
}

#[test]
fn motions_that_odometry_does_not_show_are_counted() {
    let mut base = SmallBase::new(50.0, 0.1, 0.5);
    base.forward(0.5);
    assert_eq!(base.meter.still(), 0);
    base.parts = [0.0; 2];
    base.forward(0.5);
    base.turn(1.0);
    assert_eq!(base.meter.still(), 2);
    base.parts = [1.0; 2];
    base.forward(0.5);
    assert_eq!(base.meter.still(), 0);
}

/// A meter after a motion whose last reading but one came after this time in seconds, and that odometry does not show.
fn meter_after(last: f64, change: impl FnOnce(&mut ResponseMeter)) -> ResponseMeter {
    let mut meter = ResponseMeter::default();
    let at = |time| TimedOdometry { time, ..TimedOdometry::default() };
    let ahead = WheelSpeeds::from_motion(0.2, 0.0);
    let times = [0.0, 0.25, 0.5, 0.75, 0.75 + last];
    for pair in times.windows(2) {
        meter.add(ahead, at(pair[0]), at(pair[1]));
    }
    change(&mut meter);
    meter.add(WheelSpeeds::STOP, at(times[4]), at(times[4] + PERIOD));
    meter
}

/// After a pause it does not show how the base obeys.
#[test]
fn a_motion_that_was_interrupted_is_not_measured() {
    assert_eq!(meter_after(0.25, |_| {}).still(), 1);
    assert_eq!(meter_after(0.25, ResponseMeter::discard).still(), 0);
    assert_eq!(meter_after(0.75, |_| {}).still(), 0);
}

#[test]
fn the_robot_stops_where_its_room_ends() {
    for lag in [0.05, 0.2, 0.5] {
        let mut base = SmallBase::new(50.0, lag, 0.5);
        base.turn(0.2);
        base.turn(-0.2);
        base.room = 0.3;
        Drive(&mut base).forward(0.5).unwrap();
        let [x, _] = base.at.position;
        assert!((0.28..0.31).contains(&x), "{lag} s: {x} m");
    }
}
