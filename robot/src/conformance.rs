//! The specification judges a robot: after each move, where it is and what it perceives there are
//! held against the embedded graph of the floor plan. Section 2.1.

use std::fmt;

use toposlam_model::{
    driving::{algorithm2::Standing, scene::wrapped},
    embedded_graph::Dart,
    floor_plan::FloorPlan,
    percept::{Door, Percept},
    world::{GraphWorld, State, World},
};

use crate::{
    pose::Pose,
    truth::{JunctionTruth, angle},
};

/// A robot that stands at a junction is no farther from its turning point, in metres.
const THERE: f64 = 0.5;

/// Follows a robot in the embedded graph of its floor plan.
#[derive(Clone, Debug)]
pub struct Specification<'p> {
    plan: &'p FloorPlan,
    world: GraphWorld<'p>,
    arrivals: Vec<Arrival>,
}

/// A robot's coming to a junction, as it was and as it should have been.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrival {
    /// By which door of the last junction; `None` at the start.
    pub door: Option<Door>,
    /// Where the robot is by the specification: the dart by which it has come in.
    pub expected: Dart,
    /// Where it really is, by its entry door; `None` if at no junction.
    pub reached: Option<Dart>,
    /// What it should perceive where it should be.
    pub expected_percept: Percept,
    /// What it perceives.
    pub perceived: Percept,
    /// Where it is on the floor.
    pub pose: Pose,
}

impl Arrival {
    /// Whether the robot is where it should be, and perceives what it should.
    #[must_use]
    pub fn conforms(&self) -> bool {
        self.reached == Some(self.expected) && self.perceived == self.expected_percept
    }
}

/// Where a robot first did something else than the specification.
#[derive(Clone, Debug, PartialEq)]
pub struct Divergence {
    /// After how many moves.
    pub moves: usize,
    /// Where it was and what it perceived.
    pub arrival: Arrival,
    /// Where it should have been, and where it was, in words.
    names: [String; 2],
}

impl fmt::Display for Divergence {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let Self { moves, arrival, names: [expected, reached] } = self;
        write!(out, "after move {moves} ")?;
        if arrival.reached == Some(arrival.expected) {
            let Arrival { expected_percept, perceived, .. } = arrival;
            write!(
                out,
                "at {reached} the robot perceived {perceived}; there are {expected_percept}"
            )
        } else {
            write!(out, "the robot was at {reached}; by the specification it was at {expected}")
        }
    }
}

impl<'p> Specification<'p> {
    /// A robot that stands at the facing dart's junction, its back to the dart's hallway.
    #[must_use]
    pub fn new(plan: &'p FloorPlan, facing: Dart) -> Self {
        Self::at(plan, facing, facing)
    }

    /// A robot that stands at the entry dart's junction, having come by it; the marker lies along the
    /// facing dart.
    #[must_use]
    pub fn at(plan: &'p FloorPlan, facing: Dart, entry: Dart) -> Self {
        let world = GraphWorld::new(plan.graph(), facing);
        let state = State { pose: entry, ..world.state() };
        Self { plan, world: world.at(state), arrivals: Vec::new() }
    }

    /// Judges where a robot has come by a door, and what it knows of the junction; `entry` is the
    /// direction of the plan in which it takes its entry door to be.
    pub fn judge(&mut self, door: Option<Door>, at: &Standing, pose: Pose, entry: f64) {
        // A door that is not there leads nowhere; where the robot is then differs.
        let refused = door.is_some_and(|door| self.world.traverse(door).is_err());
        let reached = self.dart_at(pose, entry).filter(|_| !refused);
        let arrival = Arrival {
            door,
            expected: self.world.pose(),
            reached,
            expected_percept: self.world.sensed(),
            perceived: at.percept,
            pose,
        };
        self.arrivals.push(arrival);
    }

    /// The dart of the junction at a pose whose hallway leads in a direction.
    fn dart_at(&self, pose: Pose, entry: f64) -> Option<Dart> {
        let graph = self.plan.graph();
        let off = |vertex: &_| {
            let [x, y] = self.plan.junction(*vertex).position;
            (x - pose.position[0]).hypot(y - pose.position[1])
        };
        let vertex = graph
            .vertices()
            .filter(|vertex| off(vertex) <= THERE)
            .min_by(|one, other| off(one).total_cmp(&off(other)))?;
        let turned = |dart: &Dart| wrapped(angle(self.plan.direction(*dart)) - entry).abs();
        graph.darts_of(vertex).min_by(|one, other| turned(one).total_cmp(&turned(other)))
    }

    /// What a robot would know that stands where it is by the specification, at a pose: `None` at no
    /// junction that a robot knows.
    #[must_use]
    pub fn standing(&self, pose: Pose) -> Option<Standing> {
        let dart = self.world.pose();
        let entry = wrapped(angle(self.plan.direction(dart)) - pose.heading);
        let from = Pose { heading: angle(self.plan.direction(dart).reversed()), ..pose };
        let form = JunctionTruth::of(self.plan, self.plan.graph().vertex(dart), from).form?;
        Some(Standing { form, percept: self.world.sensed(), entry })
    }

    /// Every arrival so far, the start first.
    #[must_use]
    pub fn arrivals(&self) -> &[Arrival] {
        &self.arrivals
    }

    /// The first arrival that is not as specified.
    #[must_use]
    pub fn divergence(&self) -> Option<Divergence> {
        let moves = self.arrivals.iter().position(|arrival| !arrival.conforms())?;
        let arrival = self.arrivals[moves].clone();
        let name = |dart: Dart| {
            let graph = self.plan.graph();
            let junction = |dart| &self.plan.junction(graph.vertex(dart)).name;
            format!("{}, having come from {}", junction(dart), junction(graph.opposite(dart)))
        };
        let reached = arrival.reached.map_or_else(|| "no junction".to_owned(), name);
        Some(Divergence { moves, names: [name(arrival.expected), reached], arrival })
    }

    /// Where the robot really is, by its entry door.
    #[must_use]
    pub fn reached(&self) -> Option<Dart> {
        self.arrivals.last()?.reached
    }
}
