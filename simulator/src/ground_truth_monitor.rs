//! Checks a robot against the embedded graph of its floor plan: after each move, where it is and what
//! it perceives there. Section 2.1.

use std::fmt;

use toposlam_logs::record::{Event, EventKind, RunObserver};
use toposlam_model::{
    aid::{AidKind, State},
    driving::{algorithm2::JunctionState, odometry::Odometry, pose::Pose, scene::wrapped},
    embedded_graph::{Dart, Vertex},
    floor_plan::FloorPlan,
    marker::Directional,
    percept::{Door, Percept},
    world::{AidHandler, GraphWorld, World},
};
use toposlam_robot::any_explorer::RobotSensor;
use toposlam_vision::geometry::nearest;

use crate::truth::{JunctionTruth, angle, junction_around, junction_at};

/// Follows a robot in the embedded graph of its floor plan, and checks each arrival at a junction.
#[derive(Clone, Debug)]
pub struct GroundTruthMonitor<'p> {
    plan: &'p FloorPlan,
    world: GraphWorld<'p, AidKind>,
    arrivals: Vec<CheckedArrival>,
    /// The door that the robot has taken, and the odometry of the last frame.
    door: Option<Door>,
    /// Whether the robot has done something with its aid, since it last arrived, that is not possible.
    is_refused: bool,
    odometry: Odometry,
    /// The junction at which a robot with a pose is.
    junction: fn(&FloorPlan, Pose) -> Option<Vertex>,
}

/// An arrival at a junction, and the expected one.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckedArrival {
    /// The door of the last junction; `None` at the start.
    pub door: Option<Door>,
    /// The expected entry dart.
    pub expected: Dart,
    /// The true entry dart; `None` if the robot is not at a junction.
    pub reached: Option<Dart>,
    pub expected_percept: Percept,
    pub perceived: Percept,
    pub pose: Pose,
    /// The true entry dart, also if the specification says that the robot could not come there.
    truly: Option<Dart>,
}

impl CheckedArrival {
    /// Whether the robot is where it should be, and perceives what it should.
    pub fn conforms(&self) -> bool {
        self.reached == Some(self.expected) && self.perceived == self.expected_percept
    }
}

/// The first arrival that is not as expected.
#[derive(Clone, Debug, PartialEq)]
pub struct TruthDivergence {
    /// The number of moves before it.
    pub moves: usize,
    pub arrival: CheckedArrival,
    /// The expected place and the reached one, in words.
    names: [String; 2],
}

impl fmt::Display for TruthDivergence {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let Self { moves, arrival, names: [expected, reached] } = self;
        write!(out, "after move {moves} ")?;
        if arrival.reached == Some(arrival.expected) {
            let CheckedArrival { expected_percept, perceived, .. } = arrival;
            write!(
                out,
                "at {reached} the robot perceived {perceived}; there are {expected_percept}"
            )
        } else {
            write!(out, "the robot was at {reached}; by the specification it was at {expected}")
        }
    }
}

impl<'p> GroundTruthMonitor<'p> {
    /// A robot that stands at the facing dart's junction, its back to the dart's hallway, with its marking aid.
    pub fn new(plan: &'p FloorPlan, aid: AidKind, facing: Dart) -> Self {
        let world = GraphWorld::with_aid(plan.graph(), aid, facing);
        let (door, odometry) = (None, Odometry::default());
        let (arrivals, is_refused, junction) = (Vec::new(), false, junction_at as fn(&_, _) -> _);
        Self { plan, world, arrivals, door, is_refused, odometry, junction }
    }

    /// The same for a robot with this sensor. By scans it is at a junction if it is within its walls: it need not stand at
    /// the turning point.
    #[must_use]
    pub fn by(self, sensor: &RobotSensor) -> Self {
        match sensor {
            RobotSensor::Scenes | RobotSensor::Camera(_) => self,
            RobotSensor::Laser(_) => Self { junction: junction_around, ..self },
        }
    }

    /// A robot that came to the entry dart's junction by that dart; the marker lies along the facing
    /// dart.
    pub fn at(plan: &'p FloorPlan, facing: Dart, entry: Dart) -> Self {
        let at_facing = Self::new(plan, Directional.into(), facing);
        let state = State { pose: entry, ..at_facing.world.state() };
        Self { world: at_facing.world.at(state), ..at_facing }
    }

    /// Checks an arrival. `entry` is the direction in the plan of what the robot takes for its entry door.
    fn check(&mut self, perceived: Percept, pose: Pose, entry: f64) {
        let door = self.door.take();
        // A door that does not exist leads nowhere; the robot is then somewhere else.
        let was_refused = std::mem::take(&mut self.is_refused);
        let refused = was_refused | door.is_some_and(|door| self.world.traverse(door).is_err());
        let truly = self.dart_at(pose, entry);
        let reached = truly.filter(|_| !refused);
        let arrival = CheckedArrival {
            door,
            expected: self.world.pose(),
            reached,
            expected_percept: self.world.sensed(),
            perceived,
            pose,
            truly,
        };
        self.arrivals.push(arrival);
    }

    /// The dart of the junction at a pose whose hallway leads in a direction.
    fn dart_at(&self, pose: Pose, entry: f64) -> Option<Dart> {
        let graph = self.plan.graph();
        let vertex = (self.junction)(self.plan, pose)?;
        let turned = |dart: &Dart| wrapped(angle(self.plan.direction(*dart)) - entry).abs();
        nearest(graph.darts_of(vertex), turned)
    }

    /// What a robot at a pose knows if it is at the expected junction; `None` at a junction of a kind that
    /// robots do not know.
    pub fn junction_state(&self, pose: Pose) -> Option<JunctionState> {
        let dart = self.world.pose();
        let entry = wrapped(angle(self.plan.direction(dart)) - pose.heading);
        let from = Pose { heading: angle(self.plan.direction(dart).reversed()), ..pose };
        let shape =
            JunctionTruth::from_plan(self.plan, self.plan.graph().vertex(dart), from).shape?;
        Some(JunctionState { shape, percept: self.world.sensed(), entry })
    }

    /// Every arrival so far, the start first.
    pub fn arrivals(&self) -> &[CheckedArrival] {
        &self.arrivals
    }

    pub fn divergence(&self) -> Option<TruthDivergence> {
        let moves = self.arrivals.iter().position(|arrival| !arrival.conforms())?;
        let arrival = self.arrivals[moves].clone();
        let name = |dart: Dart| {
            let graph = self.plan.graph();
            let junction = |dart| &self.plan.junction(graph.vertex(dart)).name;
            format!("{}, having come from {}", junction(dart), junction(graph.opposite(dart)))
        };
        let reached = arrival.reached.map_or_else(|| "no junction".to_owned(), name);
        Some(TruthDivergence { moves, names: [name(arrival.expected), reached], arrival })
    }

    /// The robot's true entry dart, whatever happened before.
    pub fn truly_reached(&self) -> Option<Dart> {
        self.arrivals.last()?.truly
    }

    pub fn reached(&self) -> Option<Dart> {
        self.arrivals.last()?.reached
    }
}

/// Only events with the robot's true pose are checked.
impl RunObserver for GroundTruthMonitor<'_> {
    fn event(&mut self, event: &Event) {
        match &event.kind {
            EventKind::Frame(frame) => self.odometry = frame.odometry,
            EventKind::Door { door, .. } => self.door = Some(*door),
            EventKind::Action { action, .. } => {
                self.is_refused |= self.world.handle(*action).is_err();
            }
            EventKind::Arrival(arrival) => {
                if let (Some(pose), Some(entry), Some(percept)) =
                    (event.truth, arrival.entry, arrival.percept())
                {
                    self.check(percept, pose, pose.heading + self.odometry.seen(entry));
                }
            }
            _ => {}
        }
    }
}
