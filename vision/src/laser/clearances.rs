//! How far free cells of the local map are from walls and from what is unknown.

use super::{
    distance::squared_distances,
    grid::{Cell, Grid},
};

/// Squared distances of each free cell, in cells; the numbers of the others mean nothing.
#[derive(Clone, Debug)]
pub struct Clearances {
    /// To the nearest occupied cell.
    pub wall: Vec<u32>,
    /// To the nearest cell that is not free.
    pub border: Vec<u32>,
}

impl Clearances {
    /// The distances on a map.
    #[must_use]
    pub fn new(grid: &Grid) -> Self {
        let is_free = |cell| cell == Cell::Free;
        let wall =
            squared_distances(grid.columns, &grid.cells, |cell| cell == Cell::Occupied, is_free);
        let border = squared_distances(grid.columns, &grid.cells, |cell| !is_free(cell), is_free);
        Self { wall, border }
    }
}
