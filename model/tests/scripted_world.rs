//! Worlds with scripted percepts, also such that no world has.

use toposlam_model::{
    percept::{Door, Percept, Sighting},
    world::{MarkerCarrier, RefusedAction, World},
};

/// A percept without a marker.
pub(crate) fn plain(degree: u32) -> Percept {
    Percept { degree, sighting: Sighting::Nothing }
}

/// A percept with a directional marker that points along a door.
pub(crate) fn marked(degree: u32, door: u32) -> Percept {
    Percept { degree, sighting: Sighting::Pointing(Door(door)) }
}

/// A sensor with scripted percepts, one a move. The last one repeats. Dropping and picking up the marker
/// always succeeds.
pub(crate) struct ScriptedWorld<'s> {
    percepts: &'s [Percept],
    moves: usize,
}

impl<'s> ScriptedWorld<'s> {
    pub(crate) fn new(percepts: &'s [Percept]) -> Self {
        Self { percepts, moves: 0 }
    }
}

impl World for ScriptedWorld<'_> {
    type Error = RefusedAction;

    fn percept(&mut self) -> Result<Percept, RefusedAction> {
        Ok(self.percepts[self.moves.min(self.percepts.len() - 1)])
    }

    fn traverse(&mut self, _: Door) -> Result<(), RefusedAction> {
        self.moves += 1;
        Ok(())
    }

    fn carrier(&mut self) -> Option<&mut dyn MarkerCarrier<Error = RefusedAction>> {
        Some(self)
    }
}

impl MarkerCarrier for ScriptedWorld<'_> {
    type Error = RefusedAction;

    fn pick_up(&mut self) -> Result<(), RefusedAction> {
        Ok(())
    }

    fn drop(&mut self) -> Result<(), RefusedAction> {
        Ok(())
    }
}
