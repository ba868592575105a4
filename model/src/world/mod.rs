//! The seam of the whole system: all that a robot can sense of its world and do in it. Section 2.1.

mod graph_world;

pub use graph_world::{Action, GraphWorld, Refused, State, UnknownAction};

use crate::percept::{Door, Percept};

/// All that a robot can sense of its world, and all that it can do in it.
// paper: world.interface, percept.no-metric
pub trait World {
    /// What can go wrong with sensing or moving.
    type Error;

    /// What the robot senses where it is. At the very start, this is the marked vertex, with the
    /// facing dart as entry dart.
    ///
    /// # Errors
    /// Where the world cannot be sensed.
    fn percept(&mut self) -> Result<Percept, Self::Error>;

    /// Leaves by a door and goes to the other end of the edge.
    ///
    /// # Errors
    /// Where the robot cannot go.
    // paper: motion.door, motion.arrival
    fn traverse(&mut self, door: Door) -> Result<(), Self::Error>;
}

/// All that a robot can do with a movable marker, besides.
// paper: world.interface
pub trait MovableMarkerWorld: World {
    /// Picks the marker up where the robot is, to carry it.
    ///
    /// # Errors
    /// Where the marker is not here, or cannot be moved.
    fn pick_up(&mut self) -> Result<(), Self::Error>;

    /// Drops the marker where the robot is.
    ///
    /// # Errors
    /// Where the robot does not carry it.
    fn drop(&mut self) -> Result<(), Self::Error>;
}
