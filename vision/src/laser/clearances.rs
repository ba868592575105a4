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
    /// To the nearest cell that is unknown, or on the border of the map.
    pub unknown: Vec<u32>,
}

impl Clearances {
    /// The distances on a map.
    #[must_use]
    pub fn new(grid: &Grid) -> Self {
        let is_unknown = |at: usize| grid.cells[at] == Cell::Unknown || grid.is_border(at);
        Self {
            wall: squared_distances(grid.side, |at| grid.cells[at] == Cell::Occupied),
            unknown: squared_distances(grid.side, is_unknown),
        }
    }
}
