//! An embedded graph with a marker and a robot in it, as a world. Section 2.1.

use std::{fmt, str::FromStr};

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use thiserror::Error;

use super::{MarkerCarrier, World};
use crate::{
    counts::{counted, grouped},
    embedded_graph::{Dart, EmbeddedGraph},
    marker::{Directional, Marker, MarkerKind},
    percept::{Door, Percept, Sighting},
};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum RefusedAction {
    #[error("door {} was taken at a vertex with {}", door.0, counted(*degree as usize, "door"))]
    NoSuchDoor { door: Door, degree: u32 },
    #[error("there is no marker here that could be picked up")]
    NothingToPickUp,
    #[error("the robot carries no marker that it could drop")]
    NothingToDrop,
    #[error("no more than {} moves are allowed", grouped((*bound).into()))]
    OutOfMoves { bound: u64 },
    #[error("no world of this class and size agrees with what the robot has perceived")]
    NoWorldLeft,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct State {
    pub pose: Dart,
    /// The facing dart that places the marker where it lies, the first of those alike; none while
    /// the robot carries it. Without a marker, dart 0.
    pub placed: Option<Dart>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Action {
    Take(Door),
    PickUp,
    Drop,
}

/// The door's number, `pick-up` or `drop`.
impl fmt::Display for Action {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Take(door) => write!(out, "{}", door.0),
            Self::PickUp => write!(out, "pick-up"),
            Self::Drop => write!(out, "drop"),
        }
    }
}

/// A door is a number, another action is a word.
impl Serialize for Action {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Take(door) => door.serialize(serializer),
            Self::PickUp | Self::Drop => serializer.collect_str(self),
        }
    }
}

impl<'de> Deserialize<'de> for Action {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            Door(u32),
            Word(String),
        }
        match Written::deserialize(deserializer)? {
            Written::Door(door) => Ok(Self::Take(Door(door))),
            Written::Word(word) => word.parse().map_err(de::Error::custom),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{0}` is not an action; write a door number, pick-up or drop")]
pub struct UnknownAction(String);

impl FromStr for Action {
    type Err = UnknownAction;

    fn from_str(text: &str) -> Result<Self, UnknownAction> {
        match text {
            "pick-up" => Ok(Self::PickUp),
            "drop" => Ok(Self::Drop),
            door => {
                let digits = door.bytes().all(|byte| byte.is_ascii_digit());
                let number = digits.then(|| door.parse().ok()).flatten();
                number.map(|n| Self::Take(Door(n))).ok_or_else(|| UnknownAction(text.to_owned()))
            }
        }
    }
}

/// An embedded graph with a marker and a robot in it, as a [`World`].
#[derive(Clone, Debug)]
pub struct GraphWorld<'g, M = MarkerKind> {
    graph: &'g EmbeddedGraph,
    marker: M,
    state: State,
    moves: u64,
    bound: u64,
}

impl<'g> GraphWorld<'g> {
    /// The world of a start: the directional marker lies at the start vertex and points along the
    /// facing dart, which is one of the graph's, and the robot's entry dart.
    pub fn new(graph: &'g EmbeddedGraph, facing: Dart) -> Self {
        Self::with_marker(graph, Directional, facing)
    }
}

impl<'g, M: Marker> GraphWorld<'g, M> {
    /// The world of a start with any marker, placed by the facing dart, which is one of the graph's,
    /// and the robot's entry dart.
    pub fn with_marker(graph: &'g EmbeddedGraph, marker: M, facing: Dart) -> Self {
        let placed = Some(marker.first_alike(graph, facing));
        Self { graph, marker, state: State { pose: facing, placed }, moves: 0, bound: u64::MAX }
    }

    /// The same world in another state.
    #[must_use]
    pub fn at(self, state: State) -> Self {
        Self { state, ..self }
    }

    /// The same world, in which at most `bound` moves are possible.
    #[must_use]
    pub fn with_bound(self, bound: u64) -> Self {
        Self { bound, ..self }
    }

    /// The robot's percept: a graph can always be sensed.
    #[inline]
    pub fn sensed(&self) -> Percept {
        let degree = self.graph.degree_around(self.state.pose);
        Percept { degree, sighting: self.sighting() }
    }

    /// The possible actions: the doors, and picking up or dropping the marker.
    pub fn actions(&self) -> impl Iterator<Item = Action> + use<M> {
        let doors = (0..self.graph.degree_around(self.state.pose)).map(|n| Action::Take(Door(n)));
        let handling = if self.can_pick_up() {
            Some(Action::PickUp)
        } else {
            self.carries().then_some(Action::Drop)
        };
        doors.chain(handling)
    }

    /// Does one of the [`actions`](Self::actions).
    ///
    /// # Errors
    /// Returns an error if it is not one of them.
    pub fn act(&mut self, action: Action) -> Result<(), RefusedAction> {
        match action {
            Action::Take(door) => self.traverse(door),
            Action::PickUp => self.pick_up(),
            Action::Drop => MarkerCarrier::drop(self),
        }
    }

    pub fn carries(&self) -> bool {
        self.state.placed.is_none() && self.marker.is_movable()
    }

    fn can_pick_up(&self) -> bool {
        self.marker.is_movable() && self.sighting() != Sighting::Nothing
    }

    #[inline]
    fn sighting(&self) -> Sighting {
        match self.state.placed {
            Some(placed) => self.marker.sighting(self.graph, placed, self.state.pose),
            None => Sighting::Nothing,
        }
    }
}

impl<'g, M> GraphWorld<'g, M> {
    pub fn graph(&self) -> &'g EmbeddedGraph {
        self.graph
    }

    pub fn marker(&self) -> &M {
        &self.marker
    }

    pub fn pose(&self) -> Dart {
        self.state.pose
    }

    pub fn moves(&self) -> u64 {
        self.moves
    }

    pub fn state(&self) -> State {
        self.state
    }
}

impl<M: Marker> World for GraphWorld<'_, M> {
    type Error = RefusedAction;

    #[inline]
    fn percept(&mut self) -> Result<Percept, RefusedAction> {
        Ok(self.sensed())
    }

    #[inline]
    fn traverse(&mut self, door: Door) -> Result<(), RefusedAction> {
        let degree = self.graph.degree_around(self.state.pose);
        if door.0 >= degree {
            return Err(RefusedAction::NoSuchDoor { door, degree });
        }
        if self.moves >= self.bound {
            return Err(RefusedAction::OutOfMoves { bound: self.bound });
        }
        self.state.pose = self.graph.after(self.state.pose, door);
        self.moves += 1;
        Ok(())
    }

    fn carrier(&mut self) -> Option<&mut dyn MarkerCarrier<Error = RefusedAction>> {
        Some(self)
    }
}

impl<M: Marker> MarkerCarrier for GraphWorld<'_, M> {
    type Error = RefusedAction;

    fn pick_up(&mut self) -> Result<(), RefusedAction> {
        if !self.can_pick_up() {
            return Err(RefusedAction::NothingToPickUp);
        }
        self.state.placed = None;
        Ok(())
    }

    fn drop(&mut self) -> Result<(), RefusedAction> {
        if !self.carries() {
            return Err(RefusedAction::NothingToDrop);
        }
        self.state.placed = Some(self.marker.first_alike(self.graph, self.state.pose));
        Ok(())
    }
}
