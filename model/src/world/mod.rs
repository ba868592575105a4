//! The central interface: everything that a robot can sense of its world and do in it. Section 2.1.

mod graph_world;

pub use graph_world::{Action, GraphWorld, RefusedAction, State, UnknownAction};

use crate::percept::{Door, Percept};

/// Everything that a robot can sense of its world and do in it.
// paper: world.interface, percept.no-metric
pub trait World {
    type Error;

    /// The robot's percept. At the start, the robot is at the marked vertex, and the facing dart is its
    /// entry dart.
    ///
    /// # Errors
    /// Returns an error if the world cannot be sensed.
    fn percept(&mut self) -> Result<Percept, Self::Error>;

    /// Leaves by a door and goes to the other end of the edge.
    ///
    /// # Errors
    /// Returns an error if the robot cannot go there.
    // paper: motion.door, motion.arrival
    fn traverse(&mut self, door: Door) -> Result<(), Self::Error>;

    /// What carries the robot's marker; `None` if the robot cannot carry it.
    fn carrier(&mut self) -> Option<&mut dyn MarkerCarrier<Error = Self::Error>> {
        None
    }
}

/// All that a robot can do with a movable marker, besides.
// paper: world.interface
pub trait MarkerCarrier {
    type Error;

    /// Picks the marker up where the robot is, to carry it.
    ///
    /// # Errors
    /// Returns an error if the marker is not here, or cannot be moved.
    fn pick_up(&mut self) -> Result<(), Self::Error>;

    /// Drops the marker where the robot is.
    ///
    /// # Errors
    /// Returns an error if the robot does not carry it.
    fn drop(&mut self) -> Result<(), Self::Error>;
}
