//! How far free cells of the local map are from walls and from what is unknown, and how far one sees.

use std::f64::consts::SQRT_2;

use nalgebra::Point2;

use super::{
    distance::squared_distances,
    grid::{Cell, Grid, floor},
};
use crate::geometry::unit;

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

    /// How far one sees on the map from a point in a direction: the length up to the first cell that is not
    /// free, or to a limit, in metres; and what that cell is. The line is sampled twice for each cell.
    #[must_use]
    pub fn sight(&self, grid: &Grid, from: Point2<f64>, direction: f64, limit: f64) -> (f64, Cell) {
        let step = grid.cell / 2.0;
        let last = ((limit / step).floor().max(-1.0) as i64).saturating_add(1);
        let (columns, rows) = (grid.columns as i64, grid.rows() as i64);
        let ahead = 0.5 * unit(direction);
        let start = (from - grid.origin) / grid.cell;
        let mut sample = 0;
        loop {
            let [column, row] = (start + sample as f64 * ahead).map(floor).into();
            if !(0..columns).contains(&column) || !(0..rows).contains(&row) {
                return (sample as f64 * step, Cell::Unknown);
            }
            let index = (row * columns + column) as usize;
            let cell = grid.cells[index];
            if cell != Cell::Free || sample >= last {
                return (sample as f64 * step, cell);
            }
            // All cells nearer than the border are free. Within a cell one is up to half of its diagonal from
            // its middle, here and there.
            let free = f64::from(self.border[index]).sqrt() - SQRT_2;
            sample = (sample + 1 + (2.0 * free).max(0.0) as i64).min(last);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use proptest::prelude::*;

    use super::*;

    /// A map of so many columns whose border is unknown.
    fn map(columns: usize, inner: &[bool]) -> Grid {
        let mut cells = vec![Cell::Unknown; columns];
        for row in inner.chunks_exact(columns - 2) {
            cells.push(Cell::Unknown);
            let cell = |&free: &bool| if free { Cell::Free } else { Cell::Occupied };
            cells.extend(row.iter().map(cell));
            cells.push(Cell::Unknown);
        }
        cells.extend(vec![Cell::Unknown; columns]);
        Grid { columns, cell: 0.5, origin: Point2::new(-1.0, 2.0), cells }
    }

    proptest! {
        #[test]
        fn one_sees_up_to_the_first_sample_that_is_not_free(
            columns in 4_usize..24,
            inner in prop::collection::vec(prop::bool::weighted(0.97), 22..400),
            part in [0.0..1.0, 0.0..1.0],
            direction in -PI..PI,
            limit in 0.0..20.0,
        ) {
            let grid = map(columns, &inner);
            let sides = [columns, grid.rows()];
            let from = [0, 1].map(|axis: usize| {
                let part: f64 = part[axis];
                grid.origin[axis] + part * grid.cell * sides[axis] as f64
            });
            let seen = Clearances::new(&grid).sight(&grid, from.into(), direction, limit);
            let (sine, cosine) = direction.sin_cos();
            let step = grid.cell / 2.0;
            let samples = (0_u32..).map(|number| f64::from(number) * step);
            let at = |length: f64| {
                let place = [(length, cosine), (length, sine)].map(|(length, part)| {
                    length / step * (0.5 * part)
                });
                let start = [0, 1].map(|axis| (from[axis] - grid.origin[axis]) / grid.cell);
                let [column, row] = [0, 1].map(|axis| (start[axis] + place[axis]).floor());
                let is_on = |at: f64, side: usize| (0.0..side as f64).contains(&at);
                let is_on_map = is_on(column, sides[0]) && is_on(row, sides[1]);
                let index = row as usize * columns + column as usize;
                if is_on_map { grid.cells[index] } else { Cell::Unknown }
            };
            let expected = samples
                .map(|length| (length, at(length)))
                .find(|&(length, cell)| cell != Cell::Free || length > limit);
            prop_assert_eq!(Some(seen), expected);
        }
    }
}
