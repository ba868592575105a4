//! A plan of hallways without images: the scenes that a robot gets there, correct or not, and the effect
//! of its motions. Sections 3 and 4.
//!
//! Angles and distances are made of a few small numbers. A surprise (an image that shows nothing, or is
//! wrong; a motion that is not carried out) is a choice, paid from a [`Budget`]. So the number of cases is
//! finite, and they are all cases with no more surprises than that.

use std::f64::consts::{FRAC_PI_2, PI};

use toposlam_model::{
    driving::{
        algorithm2::{Command, JunctionState, Lost, PathExecution, Step},
        odometry::Odometry,
        scene::{
            CentreLine, HallwayStatus, HallwayView, JunctionView, Place, Reason, Scene, Unclear,
            undirected, wrapped,
        },
        visit::JunctionShape,
    },
    percept::{Door, Percept, Sighting},
};

use crate::choose::{Choose, Exhibit};

/// The six forms: a dead end, an L to the left and to the right, a T by its stem, and by an arm with
/// the stem to the left and to the right.
pub const JUNCTION_SHAPES: [JunctionShape; 6] = [
    JunctionShape([true, false, false, false]),
    JunctionShape([true, true, false, false]),
    JunctionShape([true, false, false, true]),
    JunctionShape([true, true, false, true]),
    JunctionShape([true, true, true, false]),
    JunctionShape([true, false, true, true]),
];

/// From the middle of a hallway to its walls, in metres.
pub const HALF_WIDTH: f64 = 0.8;
/// The greatest distance of the robot from the middle.
const FREE: f64 = 0.5;
/// The greatest rounding error of a distance.
const TIE: f64 = 1e-6;
/// Places and directions that are nearer than this, in metres or radians, are the same.
const NEAR: f64 = 0.1;
/// Nearer to a junction than this, an image of a hallway is a mistake,
const SURELY: f64 = 0.7;
/// and farther than this, an image of a junction.
const HARDLY: f64 = 1.6;

/// The driver: Algorithm 2, or a broken variant of it.
pub trait PathDriver {
    /// Begins a path where the last one ended, and gives up after the given number of metres without a
    /// junction.
    fn begin(queue: &'static [Door], from: &JunctionState, leg: f64) -> Self;

    /// One round: a scene in, a command out.
    ///
    /// # Errors
    /// Returns an error if it gives up.
    fn round(&mut self, scene: &Scene, odometry: Odometry) -> Result<Step, Lost>;

    /// The doors that have not been taken.
    fn queue(&self) -> &[Door];
}

impl PathDriver for PathExecution<'static> {
    fn begin(queue: &'static [Door], from: &JunctionState, leg: f64) -> Self {
        Self::new(queue, from).with_leg_bound(leg)
    }

    fn round(&mut self, scene: &Scene, odometry: Odometry) -> Result<Step, Lost> {
        self.round(scene, odometry)
    }

    fn queue(&self) -> &[Door] {
        self.queue()
    }
}

/// A junction of the plan.
#[derive(Clone, Copy, Debug)]
pub struct PathJunction {
    /// Its shape from the door by which the path comes in.
    pub shape: JunctionShape,
    at: [f64; 2],
    entry: f64,
}

impl PathJunction {
    /// The directions of its doors, clockwise from the entry door.
    fn doors(&self) -> impl Iterator<Item = f64> + '_ {
        let quarters = (0..4).filter(|&quarter| self.shape.0[quarter]);
        quarters.map(|quarter| wrapped(self.entry - quarter as f64 * FRAC_PI_2))
    }

    /// The direction of a door that it has.
    pub fn direction(&self, door: Door) -> f64 {
        self.doors().nth(door.0 as usize).unwrap_or(self.entry)
    }

    /// The distance of its turning point from the robot.
    pub fn distance(&self, robot: &Odometry) -> f64 {
        Odometry { position: self.at, heading: 0.0 }.distance(robot)
    }

    /// The view of a robot with a door behind it.
    fn seen(&self, robot: &Odometry) -> JunctionView {
        let through = seen_from(robot, self.at);
        let doors = self.doors();
        let line = |door| CentreLine { through, direction: robot.seen(door) };
        let doors = doors.map(line).collect();
        JunctionView { doors, turning_point: through, confidence: 1.0 }.entered_from(PI)
    }

    /// Its shape from the door in this direction.
    fn shape_from(&self, entry: f64) -> JunctionShape {
        let is_door = |quarter| {
            let direction = entry - f64::from(quarter) * FRAC_PI_2;
            self.doors().any(|door| wrapped(door - direction).abs() < NEAR)
        };
        JunctionShape([0, 1, 2, 3].map(is_door))
    }

    /// The knowledge of a robot that stands there.
    pub fn junction_state(&self) -> JunctionState {
        let percept = Percept { degree: self.shape.degree(), sighting: Sighting::Nothing };
        JunctionState { shape: self.shape, percept, entry: self.entry }
    }
}

/// A place, in metres ahead and to the left of a pose.
fn seen_from(pose: &Odometry, place: [f64; 2]) -> [f64; 2] {
    let [x, y] = [0, 1].map(|axis| place[axis] - pose.position[axis]);
    let (sine, cosine) = pose.heading.sin_cos();
    [x * cosine + y * sine, y * cosine - x * sine]
}

/// The number of surprises that are left.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// In all.
    pub surprises: u8,
    /// Among these, images that are wrong,
    pub mistakes: u8,
    /// and motions of which the half is carried out, or nothing.
    pub failures: u8,
}

/// What an image showed of the next junction, or of the one at which the robot stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageEvidence {
    /// No shape.
    Nothing,
    /// The shape of the junction that is there.
    Truth,
    /// Another shape, or a shape where there is no junction.
    Mistake(JunctionShape),
}

/// A robot on a path of junctions.
#[derive(Clone, Debug)]
pub struct HallwayDrive {
    junctions: Vec<PathJunction>,
    /// The pose of the robot, and its pose by odometry.
    pub robot: Odometry,
    /// The distance from which the robot usually sees a junction.
    sight: f64,
    budget: Budget,
}

impl HallwayDrive {
    /// A robot at the turning point of the first junction, with the doors that lead from each junction to
    /// the next, the length of these hallways, and the shapes of the junctions there, except for one to
    /// which the path comes back.
    #[must_use]
    pub fn new(
        first: JunctionShape,
        legs: &[(Door, f64, JunctionShape)],
        sight: f64,
        budget: Budget,
    ) -> Self {
        let mut junctions = vec![PathJunction { shape: first, at: [0.0; 2], entry: PI }];
        for &(door, length, shape) in legs {
            let last = junctions[junctions.len() - 1];
            let direction = last.direction(door);
            let there = Odometry { position: last.at, heading: direction }.moved(0.0, length);
            let entry = wrapped(direction + PI);
            let known = junctions.iter().find(|junction| junction.distance(&there) < NEAR);
            let shape = known.map_or(shape, |junction| junction.shape_from(entry));
            junctions.push(PathJunction { shape, at: there.position, entry });
        }
        Self { junctions, robot: Odometry::default(), sight, budget }
    }

    /// A junction of the path, by its place on it.
    pub fn junction(&self, place: usize) -> &PathJunction {
        &self.junctions[place]
    }

    /// The junction nearest to the robot; the later one if it is on the path twice.
    pub fn nearest(&self) -> &PathJunction {
        let distance = |junction: &PathJunction| junction.distance(&self.robot);
        let mut nearest = &self.junctions[0];
        for junction in &self.junctions[1..] {
            if distance(junction) < distance(nearest) + TIE {
                nearest = junction;
            }
        }
        nearest
    }

    /// Chooses one of the given number of surprises, if one is left; 0 is none.
    fn surprise(&mut self, choose: &mut impl Choose, ways: u8) -> u8 {
        let ways = if self.budget.surprises == 0 { 0 } else { ways };
        let surprise = if ways == 0 { 0 } else { choose.below(1 + ways) };
        self.budget.surprises -= u8::from(surprise > 0);
        surprise
    }

    /// The scene of an image, and its evidence.
    pub fn image(&mut self, choose: &mut impl Choose) -> (Scene, ImageEvidence) {
        let junction = *self.nearest();
        let distance = junction.distance(&self.robot);
        let (place, evidence) = if distance <= self.sight {
            self.at_junction(choose, junction, distance)
        } else {
            self.in_hallway(choose, junction, distance)
        };
        choose.show(|| Exhibit::Value { name: "image", value: format!("{evidence:?}: {place:?}") });
        (Scene { place, marker: None }, evidence)
    }

    fn at_junction(
        &mut self,
        choose: &mut impl Choose,
        junction: PathJunction,
        distance: f64,
    ) -> (Place, ImageEvidence) {
        let mistakes = if self.budget.mistakes == 0 { 0 } else { JUNCTION_SHAPES.len() as u8 - 1 };
        let hallway = u8::from(distance > SURELY || mistakes > 0);
        match self.surprise(choose, 1 + hallway + mistakes) {
            0 => (Place::Junction(junction.seen(&self.robot)), ImageEvidence::Truth),
            1 => (Place::Unknown(Reason::NothingFits), ImageEvidence::Nothing),
            2 => {
                self.budget.mistakes -= u8::from(distance <= SURELY);
                (Place::Hallway(self.hallway(HallwayStatus::Clear)), ImageEvidence::Nothing)
            }
            other => {
                self.budget.mistakes -= 1;
                let mut others =
                    JUNCTION_SHAPES.into_iter().filter(|&shape| shape != junction.shape);
                let shape = others.nth(usize::from(other) - 3).unwrap_or(JUNCTION_SHAPES[0]);
                let mistaken = PathJunction { shape, ..junction };
                (Place::Junction(mistaken.seen(&self.robot)), ImageEvidence::Mistake(shape))
            }
        }
    }

    fn in_hallway(
        &mut self,
        choose: &mut impl Choose,
        junction: PathJunction,
        distance: f64,
    ) -> (Place, ImageEvidence) {
        let mistakes = if self.budget.mistakes == 0 { 0 } else { 2 * JUNCTION_SHAPES.len() as u8 };
        let near = u8::from(distance <= HARDLY);
        match self.surprise(choose, 2 + near + mistakes) {
            0 => (Place::Hallway(self.hallway(HallwayStatus::Clear)), ImageEvidence::Nothing),
            1 => (Place::Unknown(Reason::NothingFits), ImageEvidence::Nothing),
            2 => {
                let unclear = HallwayStatus::Unclear(Unclear::ClustersAhead);
                (Place::Hallway(self.hallway(unclear)), ImageEvidence::Nothing)
            }
            3 if near > 0 => (Place::Junction(junction.seen(&self.robot)), ImageEvidence::Truth),
            other => {
                self.budget.mistakes -= 1;
                let other = usize::from(other - 3 - near);
                let shape = JUNCTION_SHAPES[other % JUNCTION_SHAPES.len()];
                // At the robot, or a little ahead.
                let ahead = if other < JUNCTION_SHAPES.len() { 0.6 } else { 0.0 };
                let onwards = self.onwards();
                let there = Odometry { heading: onwards, ..self.robot }.moved(0.0, ahead);
                let entry = wrapped(onwards + PI);
                let mistaken = PathJunction { shape, at: there.position, entry };
                (Place::Junction(mistaken.seen(&self.robot)), ImageEvidence::Mistake(shape))
            }
        }
    }

    /// The hallways: start, direction, length.
    fn hallways(&self) -> impl Iterator<Item = ([f64; 2], f64, f64)> + '_ {
        let length = |junction: &PathJunction, door: f64| {
            let leads_to = |other: &&PathJunction| {
                let [x, y] = [0, 1].map(|axis| other.at[axis] - junction.at[axis]);
                x.hypot(y) > NEAR && wrapped(y.atan2(x) - door).abs() < NEAR
            };
            let far = |other: &PathJunction| Odometry { position: other.at, heading: 0.0 };
            let next = self.junctions.iter().find(leads_to);
            next.map_or(2.0 * HALF_WIDTH, |next| junction.distance(&far(next)))
        };
        self.junctions.iter().flat_map(move |junction| {
            junction.doors().map(move |door| (junction.at, door, length(junction, door)))
        })
    }

    /// The distance of the robot to the left of the middle of its hallway, and the hallway's direction out
    /// of a junction.
    fn lane(&self) -> (f64, f64) {
        let mut lane = (f64::INFINITY, 0.0);
        for (from, direction, length) in self.hallways() {
            let start = Odometry { position: from, heading: direction };
            let [way, left] = seen_from(&start, self.robot.position);
            if (-FREE..=length + FREE).contains(&way) && left.abs() < lane.0.abs() {
                lane = (left, direction);
            }
        }
        lane
    }

    /// The direction of a robot that looks nearly along its hallway.
    fn onwards(&self) -> f64 {
        let (_, direction) = self.lane();
        let looks_back = self.robot.seen(direction).abs() > FRAC_PI_2;
        wrapped(direction + if looks_back { PI } else { 0.0 })
    }

    fn hallway(&self, status: HallwayStatus) -> HallwayView {
        let (left, direction) = self.lane();
        let heading = undirected(self.robot.seen(direction));
        let is_back = wrapped(heading - self.robot.seen(direction)).abs() > FRAC_PI_2;
        let left = if is_back { -left } else { left };
        let (left, right) = (HALF_WIDTH - left, HALF_WIDTH + left);
        HallwayView { heading, left, right, status, confidence: 1.0 }
    }

    /// The robot carries out a command: all of it or, by choice, half or nothing. Walls stop it.
    pub fn carry_out(&mut self, choose: &mut impl Choose, command: Command) {
        let ways = if self.budget.failures == 0 { 0 } else { 2 };
        let surprise = self.surprise(choose, ways);
        self.budget.failures -= u8::from(surprise > 0);
        let share = [1.0, 0.5, 0.0][usize::from(surprise)];
        choose
            .show(|| Exhibit::Value { name: "command", value: format!("{share} of {command:?}") });
        let before = self.robot.moved(command.turn * share, 0.0);
        self.robot = before.moved(0.0, command.forward * share);
        if self.lane().0.abs() > FREE {
            self.robot = before;
        }
    }
}
