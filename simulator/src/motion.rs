//! A simulated base: wheels that slip, an uneven floor, inexact odometry, walls that stop it, and
//! time. Section 2.5.

use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_model::{
    driving::{odometry::Odometry, pose::Pose},
    floor_plan::FloorPlan,
};
use toposlam_robot::{
    robot::{RobotError, Sample, TimedOdometry},
    superscout::{Base, Odometer, PERIOD, WATCHDOG, WheelSpeeds, along_arc},
};

use super::surroundings::Surroundings;
use crate::render::{StreamPurpose, clouds, stream};

/// The differences of a simulated base from an ideal one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionNoise {
    /// Slip of each wheel in each motion, as a share; standard deviation.
    pub slip: f64,
    /// Permanent difference of the two wheels, as a share; standard deviation.
    pub bias: f64,
    /// Turn per metre on an uneven floor, in radians. It depends on the position.
    pub uneven: f64,
    /// Error of the wheel radii in odometry, as a share; standard deviation.
    pub odometry: f64,
}

impl MotionNoise {
    pub const NONE: Self = Self { slip: 0.0, bias: 0.0, uneven: 0.0, odometry: 0.0 };
    /// A base like a SuperScout on tiles.
    pub const DEFAULT: Self = Self { slip: 0.02, bias: 0.006, uneven: 0.03, odometry: 0.006 };
    /// The greatest useful multiple of the default noise. Beyond it, at three standard deviations,
    /// a half turn may end 45 degrees from where odometry puts it, which is a contradiction.
    pub const MOST: f64 = 5.0;

    /// This multiple of all noise.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self {
            slip: self.slip * factor,
            bias: self.bias * factor,
            uneven: self.uneven * factor,
            odometry: self.odometry * factor,
        }
    }
}

/// A simulated base in a building.
#[derive(Clone, Debug)]
pub struct SimulatedBase {
    pub(super) pose: Pose,
    wheels: WheelSpeeds,
    silent: f64,
    time: f64,
    odometer: Odometer,
    pub(super) surroundings: Surroundings,
    uneven: f64,
    /// Errors of the wheels, as shares: permanent, and in this motion.
    always: [f64; 2],
    slip: [f64; 2],
    slip_deviation: f64,
    /// Errors of the wheels in odometry, as shares.
    odometry: [f64; 2],
    chance: Xoshiro256PlusPlus,
    /// The number of commands that will be ignored.
    deaf: u32,
    reading: TimedOdometry,
    /// The recorded wheel speeds, if they are recorded.
    track: Option<Vec<Sample>>,
}

impl SimulatedBase {
    /// The base of the robot with this number in its team, at a pose in a building. The same seed gives the same base.
    pub fn new(
        plan: &FloorPlan,
        pose: Pose,
        noise: &MotionNoise,
        (seed, robot): (u64, usize),
    ) -> Self {
        let mut chance = stream(seed, StreamPurpose::Wheels, robot);
        let mut share = |deviation: f64| deviation * standard(&mut chance);
        let bias = share(noise.bias) / 2.0;
        let odometry = [share(noise.odometry), share(noise.odometry)];
        let surroundings = Surroundings::new(plan);
        let odometer = Odometer::default();
        Self {
            pose,
            wheels: WheelSpeeds::STOP,
            silent: 0.0,
            time: 0.0,
            odometer,
            surroundings,
            uneven: noise.uneven,
            always: [bias, -bias],
            slip: [0.0; 2],
            slip_deviation: noise.slip,
            odometry,
            chance,
            deaf: 0,
            reading: TimedOdometry { time: 0.0, odometry: odometer.reading() },
            track: None,
        }
    }

    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// Time since it was switched on, in seconds.
    pub fn time(&self) -> f64 {
        self.time
    }

    pub(super) fn keep_track(&mut self) {
        self.track = Some(Vec::new());
        self.sample();
    }

    /// The wheel speeds in each period, and while an image was taken.
    pub(super) fn track(&self) -> &[Sample] {
        self.track.as_deref().unwrap_or_default()
    }

    fn sample(&mut self) {
        if let Some(track) = &mut self.track {
            let (speed, turning) = (self.wheels.speed(), self.wheels.turn_rate());
            track.push(Sample { speed, turning, reading: self.reading });
        }
    }

    /// Lets time pass without a command. The wheels keep turning until the watchdog stops them.
    pub fn wait(&mut self, seconds: f64) {
        let mut left = seconds;
        while left > 0.0 {
            let step = left.min(PERIOD);
            if self.silent >= WATCHDOG {
                self.wheels = WheelSpeeds::STOP;
            }
            self.silent += step;
            self.advance(step);
            left -= step;
        }
        self.read();
        self.sample();
    }

    /// Sets the wheel speeds. No time passes.
    #[cfg(feature = "live")]
    pub(crate) fn command(&mut self, wheels: WheelSpeeds) {
        self.wheels = wheels;
        self.silent = 0.0;
    }

    #[cfg(feature = "live")]
    pub(crate) fn wheels(&self) -> WheelSpeeds {
        self.wheels
    }

    /// Starts a motion with its own slip. Returns whether the motion will be carried out.
    pub(crate) fn begin(&mut self) -> bool {
        let slip = self.slip_deviation;
        self.slip = [(); 2].map(|()| slip * standard(&mut self.chance));
        if self.deaf == 0 {
            return true;
        }
        self.deaf -= 1;
        self.time += PERIOD;
        self.read();
        false
    }

    pub(super) fn ignore(&mut self, commands: u32) {
        self.deaf = commands;
    }

    /// Moves the robot for this time unless something is in its way. Its wheels turn in either
    /// case.
    fn advance(&mut self, seconds: f64) {
        self.time += seconds;
        let WheelSpeeds { left, right } = self.wheels;
        if left == 0.0 && right == 0.0 {
            return;
        }
        let scaled = |shares: [f64; 2]| WheelSpeeds {
            left: left * (1.0 + shares[0]),
            right: right * (1.0 + shares[1]),
        };
        self.odometer.add(scaled(self.odometry), seconds);
        let truly = scaled([0, 1].map(|wheel| self.always[wheel] - self.slip[wheel]));
        let from = Odometry { position: self.pose.position, heading: self.pose.heading };
        let to = along_arc(&from, truly, seconds);
        let [x, y] = self.pose.position.map(|coordinate| coordinate as f32 * 3.0);
        let tilted = self.uneven * f64::from(clouds(x, y, 7)) * from.distance(&to);
        let position =
            if self.surroundings.has_room(to.position) { to.position } else { from.position };
        self.pose = Pose { position, heading: to.heading + tilted };
    }

    fn read(&mut self) {
        self.reading = TimedOdometry { time: self.time, odometry: self.odometer.reading() };
    }
}

impl Base for SimulatedBase {
    fn drive(&mut self, wheels: WheelSpeeds) -> Result<TimedOdometry, RobotError> {
        self.wheels = wheels;
        self.silent = PERIOD;
        self.advance(PERIOD);
        self.read();
        self.sample();
        Ok(self.reading)
    }

    fn reading(&self) -> TimedOdometry {
        self.reading
    }

    fn sonar(&self, sonar: usize) -> f64 {
        self.surroundings.sonar(self.pose, sonar)
    }
}

/// A random number of the standard normal distribution.
fn standard(chance: &mut Xoshiro256PlusPlus) -> f64 {
    StandardNormal.sample(chance)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use toposlam_model::driving::scene::wrapped;
    use toposlam_robot::superscout::{CLEARANCE, COMMAND, Drive, RADIUS};

    use super::*;

    /// One hallway to the east, 2 m wide. The walls of its dead ends are at x = -1 and x = 7.
    fn base(noise: &MotionNoise, seed: u64) -> SimulatedBase {
        let junctions = [("a".to_owned(), [0.0, 0.0]), ("b".to_owned(), [6.0, 0.0])];
        let plan = FloorPlan::new(2.0, &junctions, &[("a".to_owned(), "b".to_owned())]).unwrap();
        SimulatedBase::new(&plan, Pose { position: [0.0; 2], heading: 0.0 }, noise, (seed, 0))
    }

    // paper: hardware.drive
    #[test]
    fn an_ideal_base_obeys_commands_within_its_limits() {
        let mut base = base(&MotionNoise::NONE, 1);
        Drive(&mut base).forward(0.4).unwrap();
        assert!((base.pose().position[0] - 0.4).abs() < 0.005, "{:?}", base.pose());
        assert!(base.time() >= 0.4 / 0.2, "{} s", base.time());
        let begun = base.time();
        Drive(&mut base).turn(FRAC_PI_2).unwrap();
        assert!((base.pose().heading - FRAC_PI_2).abs() < 0.005, "{:?}", base.pose());
        assert!(base.time() - begun >= 4.5, "a quarter turn takes 4.5 s at 20 degrees a second");
        let measured = base.reading().odometry;
        assert!(
            measured.distance(&Odometry::default()) > 0.39
                && (measured.heading - FRAC_PI_2).abs() < 0.005
        );
    }

    #[test]
    fn no_command_moves_it_more_than_half_a_metre_and_the_watchdog_stops_it() {
        let mut driven = base(&MotionNoise::NONE, 1);
        Drive(&mut driven).forward(9.0).unwrap();
        assert!((driven.pose().position[0] - COMMAND).abs() < 0.005);
        let mut base = base(&MotionNoise::NONE, 1);
        base.drive(WheelSpeeds::from_motion(0.2, 0.0)).unwrap();
        base.wait(10.0);
        // One period of the command, and one more until the watchdog stops it.
        assert!((base.pose().position[0] - 0.2 * WATCHDOG).abs() < 1e-9, "{:?}", base.pose());
    }

    // paper: hardware.sonar
    #[test]
    fn sonars_stop_it_before_a_wall_and_walls_stop_it_while_its_wheels_turn() {
        let mut careful = base(&MotionNoise::NONE, 1);
        for _ in 0..20 {
            Drive(&mut careful).forward(0.5).unwrap();
        }
        let free = 7.0 - careful.pose().position[0] - RADIUS;
        assert!((CLEARANCE..CLEARANCE + 0.02).contains(&free), "{free} m");
        let mut base = base(&MotionNoise::NONE, 1);
        for _ in 0..400 {
            base.drive(WheelSpeeds::from_motion(0.2, 0.0)).unwrap();
        }
        assert!(base.pose().position[0] <= 7.0 - RADIUS);
        assert!(base.reading().odometry.position[0] > 19.0);
    }

    #[test]
    fn an_ignored_command_only_takes_time() {
        let mut base = base(&MotionNoise::NONE, 1);
        base.ignore(1);
        assert!(!base.begin() && base.begin());
        assert_eq!((base.pose().position, base.time()), ([0.0; 2], PERIOD));
    }

    #[test]
    fn its_track_has_every_period_if_recorded() {
        let mut base = base(&MotionNoise::NONE, 1);
        Drive(&mut base).forward(0.1).unwrap();
        assert!(base.track().is_empty());
        base.keep_track();
        let begun = base.time();
        Drive(&mut base).forward(0.1).unwrap();
        base.wait(0.3);
        // The start; 0.05 m in each of two periods; the stop; an image.
        let speeds: Vec<_> = base.track().iter().map(|sample| sample.speed).collect();
        assert_eq!(speeds.len(), 5);
        assert!(speeds[1] > 0.19 && speeds[2] > 0.15, "{speeds:?}");
        assert_eq!((speeds[0], speeds[3], speeds[4]), (0.0, 0.0, 0.0));
        let times: Vec<_> = base.track().iter().map(|s| s.reading.time - begun).collect();
        assert!((times[4] - (3.0 * PERIOD + 0.3)).abs() < 1e-9 && times[0] == 0.0, "{times:?}");
        assert_eq!(base.track()[4].reading.odometry, base.reading().odometry);
    }

    #[test]
    fn noise_follows_from_the_seed_and_grows_with_its_factor() {
        let off = |factor: f64| {
            let end = |seed| {
                let mut base = base(&MotionNoise::DEFAULT.times(factor), seed);
                base.begin();
                Drive(&mut base).forward(0.5).unwrap();
                base.begin();
                Drive(&mut base).turn(FRAC_PI_2).unwrap();
                base.pose()
            };
            assert_eq!(end(3), end(3));
            (0..50).map(|seed| wrapped(end(seed).heading - FRAC_PI_2).abs()).sum::<f64>() / 50.0
        };
        let [none, default, more] = [off(0.0), off(1.0), off(4.0)];
        assert!(
            none < 0.004 && default > 3.0 * none && more > 2.0 * default,
            "{none} {default} {more}"
        );
    }
}
