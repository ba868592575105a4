//! A lazy check as pieces that are done one by one, in any order and on any machine.

use std::sync::atomic::AtomicU64;

use serde::{Deserialize, Serialize};

use super::{
    LazyCheck, LazySweep, LazyTally,
    sweep::{Unit, WorldCount},
};
use crate::{
    enumerate::{EnumerationPart, Watch},
    mapping::Explorer,
};

/// The pieces of a [`LazySweep`]: its units, and the parts of the worlds that are counted. Equal sweeps have
/// equal pieces on every machine.
#[derive(Debug)]
pub struct CheckPieces {
    sweep: LazySweep,
    units: Vec<Unit>,
    world_parts: Vec<EnumerationPart>,
    /// The most moves of a run in a unit that was checked here.
    most_moves: AtomicU64,
}

/// The counts of some pieces of a check.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct PieceCounts {
    /// The counts of units.
    pub tally: LazyTally,
    /// The number of worlds.
    pub worlds: WorldCount,
}

impl PieceCounts {
    /// Adds the counts of other pieces.
    pub fn merge(&mut self, other: Self) {
        self.tally.merge(other.tally);
        self.worlds = self.worlds.merged(other.worlds);
    }
}

impl CheckPieces {
    /// The pieces of a sweep with an explorer.
    pub fn new<E: Explorer>(sweep: &LazySweep, new: impl Fn() -> E, watch: &dyn Watch) -> Self {
        Self {
            units: sweep.units(new, watch),
            world_parts: sweep.world_parts(),
            most_moves: AtomicU64::new(0),
            sweep: sweep.clone(),
        }
    }

    /// The number of pieces.
    #[must_use]
    pub fn count(&self) -> usize {
        self.units.len() + self.world_parts.len()
    }

    /// The number of units. They are the first pieces.
    #[must_use]
    pub fn unit_count(&self) -> usize {
        self.units.len()
    }

    /// The counts of a piece; none if there is no such piece.
    pub fn check<E: Explorer>(&self, piece: usize, explorer: E, watch: &dyn Watch) -> PieceCounts {
        let mut counts = PieceCounts::default();
        if let Some(unit) = self.units.get(piece) {
            counts.tally = self.sweep.check_unit(unit, explorer, &self.most_moves, watch);
        } else if let Some(part) = self.world_parts.get(piece - self.units.len()) {
            counts.worlds = WorldCount::of(part, watch);
        }
        counts
    }

    /// The result, from the counts of all pieces. It is that of [`LazySweep::run`].
    pub fn finished<E: Explorer>(
        PieceCounts { tally, worlds }: PieceCounts,
        new: impl Fn() -> E,
    ) -> LazyCheck {
        LazySweep::finished(tally, worlds, new)
    }
}
