//! A lazy check as pieces that are done one by one, in any order and on any machine.

use std::sync::atomic::AtomicU64;

use super::{
    SharedPrefixCheck,
    check::{Unit, count_worlds},
};
use crate::{
    check::{PartTally, Tally},
    enumerate::{EnumerationPart, Watch},
    mapping::Explorer,
};

/// The pieces of a [`SharedPrefixCheck`]: its units, and the parts of the worlds that are counted. Equal sweeps have
/// equal pieces on every machine.
#[derive(Debug)]
pub struct CheckPieces {
    sweep: SharedPrefixCheck,
    units: Vec<Unit>,
    world_parts: Vec<EnumerationPart>,
    /// The most moves of a run in a unit that was checked here.
    most_moves: AtomicU64,
}

impl CheckPieces {
    /// The pieces of a sweep with an explorer.
    pub fn new<E: Explorer>(
        sweep: &SharedPrefixCheck,
        new: impl Fn() -> E,
        watch: &dyn Watch,
    ) -> Self {
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
    pub fn check<E: Explorer>(&self, piece: usize, explorer: E, watch: &dyn Watch) -> PartTally {
        if let Some(unit) = self.units.get(piece) {
            return self.sweep.check_unit(unit, explorer, &self.most_moves, watch);
        }
        let part = self.world_parts.get(piece - self.units.len());
        part.map_or_else(PartTally::default, |part| count_worlds(part, watch))
    }

    /// The result, from the counts of all pieces. It is that of [`SharedPrefixCheck::run`].
    pub fn finished<E: Explorer>(counts: PartTally, new: impl Fn() -> E) -> Tally {
        SharedPrefixCheck::finished(counts, new)
    }
}
