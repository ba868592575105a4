//! A random walk through a random building, and where the robot is on it.

use std::f64::consts::PI;

use nalgebra::{Point2, Rotation2, Vector2, center};
use rand::{RngExt, SeedableRng, seq::IndexedRandom};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_model::driving::{odometry::Odometry, pose::Pose, scene::wrapped};
use toposlam_vision::geometry::{direction, distance, unit};

use super::corridor_world::{CorridorArm, CorridorWorld};

/// A walk: it begins and ends within a corridor, and passes places in between.
#[derive(Clone, Debug, PartialEq)]
pub struct LaserWalk {
    pub passed: Vec<PassedPlace>,
    /// Where the robot takes its scans.
    pub steps: Vec<WalkStep>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct PassedPlace {
    pub place: usize,
    /// Its arms, clockwise from the one by which the robot came.
    pub arms: Vec<CorridorArm>,
    /// The index of the arm by which it leaves.
    pub door: usize,
    /// The length of its way when it is there, in metres.
    pub way: f64,
    /// Whether the robot has turned back since the junction before it.
    pub turned_back: bool,
}

/// Where the robot takes a scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WalkStep {
    /// The length of its way, in metres.
    pub way: f64,
    pub pose: Pose,
    pub odometry: Odometry,
    /// In seconds.
    pub time: f64,
}

/// The way from scan to scan, in metres, and the turn, in radians.
const STEP: f64 = 0.25;
const TURN: f64 = 0.25;
/// Metres and radians a second.
const SPEED: f64 = 0.5;
const TURN_RATE: f64 = 0.5;
/// The robot passes a place at most this far from its middle, and in a corridor is this far aside, in metres.
const OFF: f64 = 0.25;
const ASIDE: f64 = 0.2;
/// Noise of the odometry: of a length as a part of it, and of the heading in radians a step.
const LENGTH_NOISE: f64 = 0.01;
const HEADING_NOISE: f64 = 0.002;
/// How often the robot turns back where it need not.
const BACK: f64 = 0.08;

/// Drives from point to point, and takes scans on its way.
#[derive(Clone, Debug)]
struct WalkDriver {
    steps: Vec<WalkStep>,
    /// Where it is, or will be after its last step, and the length of its way, in metres.
    at: Point2<f64>,
    way: f64,
    /// The direction of the last leg.
    heading: Option<f64>,
    /// Of the heading of the odometry, in radians a metre.
    drift: f64,
    chance: Xoshiro256PlusPlus,
}

impl LaserWalk {
    /// The random walk of a seed that passes so many places. The heading of the odometry drifts by up to
    /// `drift` radians a metre, always to the same side.
    pub fn random(world: &CorridorWorld, places: usize, drift: f64, seed: u64) -> Self {
        let mut passed: Vec<PassedPlace> = Vec::new();
        let mut driver = WalkDriver::new(drift, seed);
        let Some(&link) = world.links.choose(&mut driver.chance) else {
            return Self { passed, steps: Vec::new() };
        };
        let [mut from, mut at] = link;
        if driver.chance.random() {
            std::mem::swap(&mut from, &mut at);
        }
        driver.at = center(&world.places[from], &world.places[at]);
        let (mut turned_back, mut has_visited) = (false, false);
        for _ in 0..places {
            let arms = world.arms_from(at, from);
            let door = if arms.len() == 1 || driver.chance.random::<f64>() < BACK {
                0
            } else {
                driver.chance.random_range(1..arms.len())
            };
            driver.drive_near(world.places[at]);
            let to = arms[door].to;
            let is_junction = arms.len() >= 3;
            // Who has not been at a junction yet comes from anywhere.
            let turned = turned_back && has_visited;
            let way = driver.way;
            passed.push(PassedPlace { place: at, arms, door, way, turned_back: turned });
            if is_junction {
                (turned_back, has_visited) = (false, true);
            } else {
                turned_back ^= door == 0;
            }
            (from, at) = (at, to);
        }
        driver.drive_to(center(&driver.at, &world.places[at]));
        Self { passed, steps: driver.steps }
    }
}

impl WalkDriver {
    fn new(drift: f64, seed: u64) -> Self {
        let mut chance = Xoshiro256PlusPlus::seed_from_u64(seed);
        let drift = drift * chance.random_range(-1.0..=1.0);
        Self { steps: Vec::new(), at: Point2::origin(), way: 0.0, heading: None, drift, chance }
    }

    /// Drives to a place, nearly.
    fn drive_near(&mut self, place: Point2<f64>) {
        let place = place.map(|part| part + OFF * self.chance.random_range(-1.0..=1.0));
        self.drive_to(place);
    }

    /// Turns, and drives to a point.
    fn drive_to(&mut self, point: Point2<f64>) {
        let from = self.at;
        let length = distance(from, point);
        if length < 1e-6 {
            return;
        }
        let ahead = direction(from, point);
        let turn = self.heading.map_or(0.0, |heading| wrapped(ahead - heading));
        let turns = (turn.abs() / TURN).ceil();
        for part in 1..=turns as u32 {
            let heading = wrapped(ahead - turn * (1.0 - f64::from(part) / turns));
            self.push(Pose { position: from.into(), heading }, self.way);
        }
        self.heading = Some(ahead);
        // The robot swings about the middle of the corridor, and is on the line at both ends.
        let swings = f64::from(self.chance.random_range(1..=3_u32));
        let aside = ASIDE * self.chance.random_range(-1.0..=1.0);
        let count = (length / STEP).ceil();
        let onwards = unit(ahead);
        let leftwards = Vector2::new(-onwards.y, onwards.x);
        for step in 1..=count as u32 {
            let share = f64::from(step) / count;
            let swing = (PI * swings * share).sin_cos();
            let left = aside * swing.0;
            let slope = aside * PI * swings / length * swing.1;
            let along = share * length;
            let position = (from + along * onwards + left * leftwards).into();
            let heading = wrapped(ahead + slope.atan());
            self.push(Pose { position, heading }, self.way + along);
        }
        self.way += length;
        self.at = point;
    }

    /// Adds a step, with odometry that drifts.
    fn push(&mut self, pose: Pose, way: f64) {
        let Pose { position, heading } = pose;
        let Some(&last) = self.steps.last() else {
            let odometry = Odometry { position, heading };
            self.steps.push(WalkStep { way, pose, odometry, time: 0.0 });
            return;
        };
        let off = Point2::from(position) - Point2::from(last.pose.position);
        let (driven, turned) = (off.x.hypot(off.y), wrapped(heading - last.pose.heading));
        let chance = &mut self.chance;
        let mut standard = || -> f64 { StandardNormal.sample(chance) };
        let odometry_from_plan = Rotation2::new(wrapped(last.odometry.heading - last.pose.heading));
        let scale = 1.0 + LENGTH_NOISE * standard();
        let position = Point2::from(last.odometry.position) + scale * (odometry_from_plan * off);
        let noise = HEADING_NOISE * standard();
        let heading = wrapped(last.odometry.heading + turned + self.drift * driven + noise);
        let time = last.time + driven / SPEED + turned.abs() / TURN_RATE;
        let odometry = Odometry { position: position.into(), heading };
        self.steps.push(WalkStep { way, pose, odometry, time });
    }
}

#[cfg(test)]
mod tests {
    use toposlam_vision::geometry::clockwise;

    use super::{super::corridor_world::BuildingKind, *};

    fn walk(seed: u64, drift: f64) -> (CorridorWorld, LaserWalk) {
        let world = CorridorWorld::random(BuildingKind::Mixed, seed);
        let walk = LaserWalk::random(&world, 12, drift, seed);
        (world, walk)
    }

    #[test]
    fn the_robot_stays_on_the_floor_and_leaves_a_place_by_the_corridor_to_the_next() {
        for seed in 0..60 {
            let (world, walk) = walk(seed, 0.0);
            let floor = world.plan.floor();
            for step in &walk.steps {
                let is_on_floor = floor.iter().any(|piece| piece.holds(step.pose.position));
                assert!(is_on_floor, "{seed}: {step:?}");
            }
            assert_eq!(walk.passed.len(), 12);
            for two in walk.passed.windows(2) {
                assert_eq!(two[0].arms[two[0].door].to, two[1].place);
                assert_eq!(two[1].arms[0].to, two[0].place, "the first arm is the way back");
                let entry = two[0].arms[0].direction;
                let doors = two[0].arms.iter().map(|arm| clockwise(entry, arm.direction));
                assert!(doors.is_sorted(), "{:?}", two[0]);
            }
        }
    }

    #[test]
    fn odometry_drifts_by_the_way_and_a_little_noise() {
        let drift = 2_f64.to_radians() / 10.0;
        let mut most: f64 = 0.0;
        for seed in 0..40 {
            let (_, walk) = walk(seed, drift);
            let last = walk.steps.last().unwrap();
            let off = wrapped(last.odometry.heading - last.pose.heading).abs();
            // 12 corridors of up to 25 m turn by up to 60 degrees.
            assert!(off < drift * last.way + 0.4, "{off}");
            most = most.max(off / (drift * last.way));
        }
        assert!(most > 0.7, "{most}");
    }
}
