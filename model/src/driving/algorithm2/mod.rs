//! Algorithm 2: driving a door sequence. Section 4.3.
//!
//! The numbers are those of the printed lines. One call of [`PathExecution::round`] is one round of
//! the printed loop: a scene in, a command out. Images, sensing and motors are the caller's. What
//! odometry says and when to give up is in `dead_reckoning`.

mod dead_reckoning;
mod lost;

use std::f64::consts::{FRAC_PI_4, PI};

pub use dead_reckoning::{CREEP, IDLE, LEG, STALLS, UNKNOWNS};
pub use lost::{Lost, LostReason};

use super::{
    odometry::Odometry,
    scene::{CentreLine, HallwayStatus, HallwayView, JunctionView, Place, Scene, Turning, wrapped},
    visit::{JunctionEstimate, JunctionShape, SoughtMarker},
};
use crate::percept::{Door, Percept};
use dead_reckoning::{DeadReckoning, ON_THE_WAY, Round};

/// A unit distance, in metres.
// paper: alg2.2
pub const UNIT: f64 = 0.5;
/// Shorter motions count as done, in metres.
pub const LEAST_FORWARD: f64 = 0.03;
/// Smaller turns count as done, in radians.
pub const LEAST_TURN: f64 = 0.035;

/// At this distance from the centre line, in metres, the robot is too close to one side.
const TOO_CLOSE: f64 = 0.10;
/// It then turns towards that line by at most this angle.
const INWARDS: f64 = FRAC_PI_4 / 2.0;
/// A door within this angle is straight ahead: ten degrees.
const STRAIGHT: f64 = 10.0 / 180.0 * PI;
/// The robot aims at the turning point while it is within this angle.
const AHEAD: f64 = FRAC_PI_4;
/// Arrival needs a hallway in between, or this distance since the turn, in metres.
const ARRIVAL: f64 = 1.2;
/// A junction is the one just left if odometry puts that one within this distance of it, in metres.
const SAME: f64 = 0.6;

/// The robot's state on its path.
// paper: alg2.1
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PathState {
    Leaving,
    Hallway,
    /// At a junction, on the way to its turning point or turning there.
    Junction,
    Unknown,
}

/// A command: first turn, then go straight ahead.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Command {
    /// Radians counter-clockwise, in (-pi, pi].
    pub turn: f64,
    /// Metres, from 0 to [`UNIT`].
    pub forward: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Execute this command, then take the next image. The command may be empty.
    Go(Command),
    /// The path is complete: the robot is at the turning point of its last junction.
    Arrived(JunctionState),
}

/// The robot between two paths: at the turning point of a junction that it has identified.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JunctionState {
    /// The shape of the junction, seen from its entry door.
    pub shape: JunctionShape,
    /// What the robot perceives there.
    pub percept: Percept,
    /// The direction of the entry door, in the frame of odometry.
    pub entry: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub struct PathExecution<'a> {
    /// The doors that have not been taken.
    queue: &'a [Door],
    state: PathState,
    /// The estimate of the junction ahead, or of the one where the robot is.
    visit: JunctionEstimate,
    /// The door, taken from the queue, to which the robot is turning.
    door: Option<Door>,
    reckoning: DeadReckoning,
}

enum Seen {
    Hallway(HallwayView),
    /// The junction that the robot has just left.
    Left(JunctionView),
    /// The junction to which the robot has come, its doors clockwise from the entry door.
    Junction(JunctionView),
    Unknown,
}

impl<'a> PathExecution<'a> {
    // paper: drive.path
    pub fn new(queue: &'a [Door], from: &JunctionState) -> Self {
        let visit = JunctionEstimate::decided(from.shape, from.percept.sighting);
        Self::at_junction(queue, visit, from.entry)
    }

    /// The empty path at the start of a run. It identifies the junction at whose turning point the
    /// robot stands, with its back to the facing door and the marker along it.
    pub fn at_start(odometry: &Odometry) -> Self {
        Self::at_junction(&[], JunctionEstimate::at_marker(), odometry.whither(PI))
    }

    /// The empty path of a robot that does not know where it is. It goes on in a direction, given in the frame
    /// of odometry, and identifies the next junction.
    pub fn onwards_to_junction(direction: f64) -> Self {
        let reckoning = DeadReckoning::on_the_way(direction, ON_THE_WAY);
        let visit = JunctionEstimate::default();
        Self { queue: &[], state: PathState::Hallway, visit, door: None, reckoning }
    }

    /// The same of a robot that turns its back to a junction to which it could not come: it lies this far behind, in
    /// metres, and is not the next one.
    pub fn onwards_from_junction(direction: f64, behind: f64) -> Self {
        Self {
            state: PathState::Leaving,
            reckoning: DeadReckoning::on_the_way(direction, behind),
            ..Self::onwards_to_junction(direction)
        }
    }

    fn at_junction(queue: &'a [Door], visit: JunctionEstimate, entry: f64) -> Self {
        // 1
        let state = PathState::Leaving;
        Self { queue, state, visit, door: None, reckoning: DeadReckoning::at_junction(entry) }
    }

    /// Sets the distance between junctions, in metres, after which the path is given up; by default
    /// [`LEG`].
    #[must_use]
    pub fn with_leg_bound(mut self, metres: f64) -> Self {
        self.reckoning.leg_bound = metres;
        self
    }

    /// Sets the marker for which the robot looks; by default, one that points.
    #[must_use]
    pub fn with_sought(mut self, sought: SoughtMarker) -> Self {
        self.visit = self.visit.with_sought(sought);
        self
    }

    pub fn state(&self) -> PathState {
        self.state
    }

    pub fn queue(&self) -> &'a [Door] {
        self.queue
    }

    /// The direction from which the robot comes, in the frame of odometry.
    pub fn way_back(&self) -> f64 {
        self.reckoning.way_back()
    }

    /// One round of the loop, lines 3 to 32, on the scene of an image and the odometry when it was
    /// taken.
    ///
    /// # Errors
    /// Returns an error if the robot is lost. So a path always ends.
    // paper: alg2.3, alg2.4, alg2.5, alg2.6, alg2.7, alg2.8, alg2.9, alg2.10, alg2.11, alg2.12
    // paper: alg2.13, alg2.14, alg2.15, alg2.16, alg2.17, alg2.18, alg2.19, alg2.20, alg2.21
    // paper: alg2.22, alg2.23, alg2.24, alg2.25, alg2.26, alg2.27, alg2.28, alg2.29, alg2.30
    // paper: alg2.31, alg2.32, drive.clear, drive.unclear
    pub fn round(&mut self, scene: &Scene, odometry: Odometry) -> Result<Step, Lost> {
        self.reckoning.begin(odometry).map_err(|why| self.lost(why))?;
        // 4, 5, 6: the caller's; type and status are the scene's.
        let seen = self.interpret(scene).map_err(|why| self.lost(why))?;
        let command = match seen {
            // 7
            Seen::Hallway(hallway) => {
                // 8
                self.state = PathState::Hallway;
                // 9
                let along = self.aligned(&hallway);
                // 10
                let turn = along + towards_centre(&hallway, along);
                let forward = match hallway.status {
                    // 11, 12
                    HallwayStatus::Clear => UNIT,
                    // 13, 14
                    HallwayStatus::Unclear(_) => UNIT / 2.0,
                };
                Command { turn, forward }
            }
            // The print is silent here: half a metre after the turn the robot is still in the
            // junction's square. It goes on, still leaving.
            Seen::Left(junction) => {
                self.state = PathState::Leaving;
                self.onwards(&junction)
            }
            // 15, 16
            Seen::Junction(junction) if self.is_before(&junction) => {
                // 17
                self.state = PathState::Junction;
                // 18, 19
                to_turning_point(&junction)
            }
            // 20
            Seen::Junction(junction) => {
                self.state = PathState::Junction;
                match self.at_turning_point(&junction).map_err(|why| self.lost(why))? {
                    Step::Go(command) => command,
                    arrived @ Step::Arrived(_) => return Ok(arrived),
                }
            }
            // 27
            Seen::Unknown => match self.state {
                // 28, 29
                PathState::Hallway | PathState::Leaving if !self.reckoning.is_at_junction() => {
                    Command { turn: 0.0, forward: UNIT / 3.0 }
                }
                // 30
                _ => {
                    // 32
                    self.state = PathState::Unknown;
                    // 31
                    Command { turn: self.reckoning.little_turn(), forward: 0.0 }
                }
            },
        };
        Ok(Step::Go(self.reckoning.end(command)))
    }

    /// Lines 20 to 26: the red line is reached or passed.
    // paper: drive.turn
    fn at_turning_point(&mut self, junction: &JunctionView) -> Result<Step, LostReason> {
        // Two images decide an estimate, and doors are counted in an image that agrees with them. If
        // this one does not, take another from the same place.
        let agreed =
            |state: &JunctionState| JunctionShape::from_view(junction) == Some(state.shape);
        let Some(state) = self.junction_state().filter(agreed) else {
            return Ok(Step::Go(Command::default()));
        };
        let door = match (self.door, self.queue.split_first()) {
            (Some(door), _) => door,
            // 21, 22
            (None, None) => return Ok(Step::Arrived(state)),
            // 23
            (None, Some((&door, rest))) => {
                self.queue = rest;
                self.reckoning.stop_at_junction();
                door
            }
        };
        let Some(CentreLine { direction: exit, .. }) = junction.doors.get(door.0 as usize).copied()
        else {
            return Err(LostReason::NoSuchDoor { door, degree: state.shape.degree() });
        };
        if exit.abs() > STRAIGHT {
            // 24: before the robot leaves, an image must show the doors turned by this angle.
            self.door = Some(door);
            return Ok(Step::Go(Command { turn: exit, forward: 0.0 }));
        }
        self.door = None;
        // 26
        self.state = PathState::Leaving;
        self.visit = self.visit.next();
        self.reckoning.leave(exit);
        // 25
        Ok(Step::Go(Command { turn: exit, forward: UNIT }))
    }

    fn interpret(&mut self, scene: &Scene) -> Result<Seen, LostReason> {
        let seen = match &scene.place {
            Place::Unknown(_) => Seen::Unknown,
            // At a junction that the robot has not left there is no hallway.
            Place::Hallway(_) if self.reckoning.is_at_junction() => Seen::Unknown,
            Place::Hallway(hallway) => {
                self.reckoning.hallway(hallway.heading)?;
                self.visit.add_scene(scene);
                Seen::Hallway(*hallway)
            }
            Place::Junction(junction) if self.has_left(junction) => {
                let is_here = self.reckoning.left(junction);
                if is_here { Seen::Left(junction.clone()) } else { Seen::Unknown }
            }
            Place::Junction(junction) => self.junction(scene, junction),
        };
        let is_known = !matches!(seen, Seen::Unknown);
        self.reckoning.note(if is_known { Round::Known } else { Round::Unknown })?;
        Ok(seen)
    }

    /// A junction, seen from its entry door. Once its shape is known, an image of another shape, or of
    /// the same one turned against odometry, is ignored. One that is only possible shows no shape that is not known.
    fn junction(&mut self, scene: &Scene, junction: &JunctionView) -> Seen {
        let Some(entry) = self.reckoning.entry(junction) else { return Seen::Unknown };
        let junction = junction.clone().entered_from(entry);
        let shape = JunctionShape::from_view(&junction);
        let decided = self.junction_state();
        let is_new =
            !junction.is_certain() && decided.is_none_or(|state| shape != Some(state.shape));
        match decided.filter(|_| self.reckoning.is_at_junction()) {
            Some(state) if shape != Some(state.shape) => return Seen::Unknown,
            Some(_) => {}
            None if is_new => return Seen::Unknown,
            None => self.visit.add_scene(&Scene {
                place: Place::Junction(junction.clone()),
                marker: scene.marker,
            }),
        }
        self.reckoning.at(&junction);
        Seen::Junction(junction)
    }

    /// Whether a junction is the one that the robot has just left.
    fn has_left(&self, junction: &JunctionView) -> bool {
        if self.reckoning.is_at_junction() {
            return false;
        }
        let since = self.reckoning.since_turn;
        let [x, y] = junction.turning_point;
        let direction = self.reckoning.ahead();
        let ahead = x * direction.cos() + y * direction.sin();
        let is_behind = (since + ahead).abs() < SAME;
        let is_early = self.state == PathState::Leaving && since < ARRIVAL;
        is_behind || is_early
    }

    /// Whether the turning point is still ahead. Once the robot turns to a door, it does not matter.
    fn is_before(&self, junction: &JunctionView) -> bool {
        self.door.is_none() && junction.turning() == Turning::Before
    }

    /// The junction where the robot is, once two images agree on it.
    fn junction_state(&self) -> Option<JunctionState> {
        let (shape, percept) = (self.visit.shape()?, self.visit.percept()?);
        Some(JunctionState { shape, percept, entry: self.reckoning.entry })
    }

    /// The hallway's direction onwards.
    // paper: drive.align
    fn aligned(&self, hallway: &HallwayView) -> f64 {
        let ahead = self.reckoning.ahead();
        let off = wrapped(hallway.heading - ahead);
        if off.abs() <= PI / 2.0 { hallway.heading } else { wrapped(hallway.heading + PI) }
    }

    /// The command that leads out of a junction, along the centre line of the door taken.
    fn onwards(&self, junction: &JunctionView) -> Command {
        let ahead = self.reckoning.ahead();
        let off = |line: &&CentreLine| wrapped(line.direction - ahead).abs();
        let exit = junction.doors.iter().min_by(|one, other| off(one).total_cmp(&off(other)));
        let turn = exit.map_or(0.0, |exit| {
            let (sine, cosine) = exit.direction.sin_cos();
            let left = exit.through[1] * cosine - exit.through[0] * sine;
            exit.direction + inwards(left)
        });
        Command { turn, forward: UNIT / 2.0 }
    }

    fn lost(&self, why: LostReason) -> Lost {
        Lost { why, state: self.state, since_turn: self.reckoning.since_turn }
    }
}

/// The additional turn towards the centre line of a hallway, if the robot is too close to one side;
/// `along` is the hallway's direction onwards.
// paper: drive.centre
fn towards_centre(hallway: &HallwayView, along: f64) -> f64 {
    let left = (hallway.left - hallway.right) / 2.0;
    let back = wrapped(along - hallway.heading).abs() > PI / 2.0;
    inwards(if back { -left } else { left })
}

/// The turn towards a line at this distance to the left, if it is too far.
fn inwards(left: f64) -> f64 {
    if left.abs() > TOO_CLOSE { left.atan2(UNIT).clamp(-INWARDS, INWARDS) } else { 0.0 }
}

/// Lines 18 and 19: towards the crossing of the centre lines, in steps of half a unit, to get more
/// images for the estimate.
// paper: drive.before
fn to_turning_point(junction: &JunctionView) -> Command {
    let [x, y] = junction.turning_point;
    let bearing = y.atan2(x);
    let along = junction.doors.first().map_or(0.0, |entry| wrapped(entry.direction + PI));
    // Beside the turning point the crossing would be far aside.
    let (turn, distance) = if wrapped(bearing - along).abs() <= AHEAD {
        (bearing, x.hypot(y))
    } else {
        (along, junction.distance())
    };
    Command { turn, forward: distance.clamp(0.0, UNIT / 2.0) }
}

#[cfg(test)]
mod tests;
