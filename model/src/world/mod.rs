//! The central interface: everything that a robot can sense of its world and do in it. Section 2.1.

mod graph_world;
mod sensing_world;

pub use graph_world::GraphWorld;
pub use sensing_world::SensingWorld;

use crate::{
    aid::AidAction,
    folding::ArrivalSenses,
    percept::{Door, Percept},
};

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

    /// What does the actions beside doors; `None` if the robot has none.
    fn handler(&mut self) -> Option<&mut dyn AidHandler<Error = Self::Error>> {
        None
    }

    /// What the robot senses besides its percept; by default nothing, as in the paper. The folding explorer asks once after
    /// each percept. No other explorer uses it.
    #[inline]
    fn senses(&mut self) -> ArrivalSenses {
        ArrivalSenses::default()
    }
}

/// All that a robot can do with its marking aid, besides.
// paper: world.interface
pub trait AidHandler {
    type Error;

    /// Does an action with the aid.
    ///
    /// # Errors
    /// Returns an error if it is not possible.
    fn handle(&mut self, action: AidAction) -> Result<(), Self::Error>;
}
