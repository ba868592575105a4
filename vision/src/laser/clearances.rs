//! How far each cell of the local map is from walls and from what is unknown.

use super::{
    distance::squared_distances,
    grid::{Cell, Grid},
};

/// Squared distances of each cell, in cells.
#[derive(Clone, Debug)]
pub struct Clearances {
    /// To the nearest occupied cell.
    pub wall: Vec<u32>,
    /// To the nearest unknown cell.
    pub unknown: Vec<u32>,
}

impl Clearances {
    /// The distances on a map.
    #[must_use]
    pub fn new(grid: &Grid) -> Self {
        let squared = |kind| squared_distances(grid.columns, &grid.cells, kind);
        Self { wall: squared(Cell::Occupied), unknown: squared(Cell::Unknown) }
    }
}
