//! A world whose robot senses more than its percepts.

use super::{AidHandler, World};
use crate::{
    folding::ArrivalSenses,
    percept::{Door, Percept},
};

/// A world with other [senses](World::senses): those that a function returns for the robot where it is.
#[derive(Clone, Debug)]
pub struct SensingWorld<W, S> {
    world: W,
    sense: S,
}

impl<W, S: FnMut(&W) -> ArrivalSenses> SensingWorld<W, S> {
    pub fn new(world: W, sense: S) -> Self {
        Self { world, sense }
    }

    /// The world without these senses.
    pub fn world(&self) -> &W {
        &self.world
    }

    pub(crate) fn world_mut(&mut self) -> &mut W {
        &mut self.world
    }
}

impl<W: World, S: FnMut(&W) -> ArrivalSenses> World for SensingWorld<W, S> {
    type Error = W::Error;

    fn percept(&mut self) -> Result<Percept, W::Error> {
        self.world.percept()
    }

    fn traverse(&mut self, door: Door) -> Result<(), W::Error> {
        self.world.traverse(door)
    }

    fn handler(&mut self) -> Option<&mut dyn AidHandler<Error = W::Error>> {
        self.world.handler()
    }

    fn senses(&mut self) -> ArrivalSenses {
        (self.sense)(&self.world)
    }
}
