//! How far free cells of the local map are from walls and from what is unknown, by the Euclidean distance transform of
//! Meijster, Roerdink and Hesselink (2000); and how far one sees.

use std::{f64::consts::SQRT_2, ops::Range};

use nalgebra::Point2;

use super::grid::{Cell, Grid, floor};
use crate::geometry::unit;

/// The local map with squared distances of each free cell, in cells; the numbers of the others mean nothing.
#[derive(Clone, Debug)]
pub struct Clearances {
    pub grid: Grid,
    /// To the nearest occupied cell.
    pub wall: Vec<u32>,
    /// To the nearest cell that is not free.
    pub border: Vec<u32>,
}

impl Clearances {
    pub(super) fn new(grid: Grid) -> Self {
        let wall = squared_distances(grid.columns, &grid.cells, |cell| cell == Cell::Occupied);
        let border = squared_distances(grid.columns, &grid.cells, |cell| cell != Cell::Free);
        Self { grid, wall, border }
    }

    /// Whether a free cell is beside the unknown, and not beside a wall, where that means nothing.
    pub(super) fn is_unknown_border(&self, at: usize) -> bool {
        self.grid.cells[at] == Cell::Free && self.border[at] == 1 && self.wall[at] >= 2
    }

    /// How far one sees on the map from a point in a direction: the length up to the first cell that is not
    /// free, or to a limit, in metres; and what that cell is. The line is sampled twice for each cell.
    pub(crate) fn sight(&self, from: Point2<f64>, direction: f64, limit: f64) -> (f64, Cell) {
        let grid = &self.grid;
        let step = grid.cell / 2.0;
        let last = ((limit / step).floor().max(-1.0) as i64).saturating_add(1);
        let (columns, rows) = (grid.columns as i64, grid.rows() as i64);
        let ahead = 0.5 * unit(direction);
        let start = (from - grid.origin) / grid.cell;
        let mut sample = 0;
        loop {
            let at = start + sample as f64 * ahead;
            let (column, row) = (floor(at.x), floor(at.y));
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

/// For each free cell of a rectangle with this many columns, the squared distance, in cells, to the nearest one of the
/// sites. It is at least the square of the longer side if there is none. The numbers of the other cells mean nothing.
fn squared_distances(columns: usize, cells: &[Cell], is_site: impl Fn(Cell) -> bool) -> Vec<u32> {
    let distances = column_distances(columns, cells, is_site);
    let mut squared = vec![0; cells.len()];
    let mut envelope = Vec::with_capacity(columns);
    let rows = distances.chunks_exact(columns).zip(cells.chunks_exact(columns));
    for ((row, cells), squared) in rows.zip(squared.chunks_exact_mut(columns)) {
        // Sites divide a row: no cell is nearer to what is behind one.
        let mut from = 0;
        while from < columns {
            let to = (from..columns).find(|&x| row[x] == 0).unwrap_or(columns);
            if cells[from..to].contains(&Cell::Free) {
                row_distances(row, from..to, &mut envelope, squared);
            }
            from = to + 1;
        }
    }
    squared
}

/// The distance to the nearest site in the same column.
fn column_distances(columns: usize, cells: &[Cell], is_site: impl Fn(Cell) -> bool) -> Vec<i16> {
    let rows = cells.len() / columns.max(1);
    let far = i16::try_from(columns + rows).unwrap_or(i16::MAX);
    let mut distances: Vec<i16> =
        cells.iter().map(|&cell| if is_site(cell) { 0 } else { far }).collect();
    let step = |beside: &[i16], row: &mut [i16]| {
        let farther = |&beside: &i16| beside.saturating_add(1);
        row.iter_mut().zip(beside).for_each(|(at, beside)| *at = (*at).min(farther(beside)));
    };
    // Whole rows at a time are several cells at a time.
    for row in 1..rows {
        let (before, after) = distances.split_at_mut(row * columns);
        step(&before[(row - 1) * columns..], &mut after[..columns]);
    }
    for row in (1..rows).rev() {
        let (before, after) = distances.split_at_mut(row * columns);
        step(&after[..columns], &mut before[(row - 1) * columns..]);
    }
    distances
}

/// The squared distances of cells of a row between two sites, or its ends: the lower envelope of the parabolas
/// of their columns and of those of the sites.
fn row_distances(
    row: &[i16],
    between: Range<usize>,
    envelope: &mut Vec<(usize, usize)>,
    squared: &mut [u32],
) {
    let down = |site: usize| i32::from(row[site]).pow(2);
    let value = |x: usize, site: usize| (x as i32 - site as i32).pow(2) + down(site);
    // The columns on the envelope, each with the first place where it is the lowest.
    envelope.clear();
    for site in between.start.saturating_sub(1)..(between.end + 1).min(row.len()) {
        while let Some(&(below, from)) = envelope.last()
            && value(from, below) > value(from, site)
        {
            envelope.pop();
        }
        let from = match envelope.last() {
            None => between.start,
            Some(&(below, _)) => {
                let (one, other) = (below as i32, site as i32);
                let off = other.pow(2) - one.pow(2) + down(site) - down(below);
                // Most are neighbours, and a shift is faster than a division.
                let apart = other - one;
                let last = if apart == 1 { off >> 1 } else { off.div_euclid(2 * apart) };
                usize::try_from(last + 1).unwrap_or_default()
            }
        };
        if from < between.end {
            envelope.push((site, from));
        }
    }
    let mut lowest = envelope.iter().peekable();
    let mut site = between.start;
    for x in between {
        while let Some(&(next, _)) = lowest.next_if(|&&(_, from)| from <= x) {
            site = next;
        }
        squared[x] = u32::try_from(value(x, site)).unwrap_or(u32::MAX);
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
            let from = Point2::from(from);
            let seen = Clearances::new(grid.clone()).sight(from, direction, limit);
            let step = grid.cell / 2.0;
            let start = (from - grid.origin) / grid.cell;
            let at = |length: f64| {
                let [column, row] = (start + length / step * (0.5 * unit(direction))).into();
                let is_on = |at: f64, side: usize| (0.0..side as f64).contains(&at.floor());
                let is_on_map = is_on(column, sides[0]) && is_on(row, sides[1]);
                if is_on_map { grid.cells[row as usize * columns + column as usize] } else { Cell::Unknown }
            };
            let mut samples = (0_u32..).map(|number| f64::from(number) * step);
            let end = samples.find(|&length| at(length) != Cell::Free || length > limit).unwrap();
            prop_assert_eq!(seen, (end, at(end)));
        }

        #[test]
        fn distances_are_those_to_the_nearest_site(
            columns in 1_usize..12,
            cells in prop::collection::vec(
                prop_oneof![
                    4 => Just(Cell::Unknown), 4 => Just(Cell::Free), 1 => Just(Cell::Occupied)
                ],
                1..100,
            ),
        ) {
            let cells = &cells[..cells.len() / columns * columns];
            prop_assume!(cells.contains(&Cell::Occupied));
            let squared = squared_distances(columns, cells, |cell| cell == Cell::Occupied);
            for (at, &distance) in squared.iter().enumerate() {
                let off = |site: usize| {
                    let [x, y] = [at % columns, at / columns];
                    x.abs_diff(site % columns).pow(2) + y.abs_diff(site / columns).pow(2)
                };
                let sites = (0..cells.len()).filter(|&site| cells[site] == Cell::Occupied);
                let is_nearest = Some(distance as usize) == sites.map(off).min();
                prop_assert!(is_nearest || cells[at] != Cell::Free);
            }
        }
    }

    #[test]
    fn without_a_site_everything_is_far() {
        let squared = squared_distances(5, &[Cell::Free; 20], |_| false);
        assert!(squared.into_iter().all(|squared| squared >= 25));
    }
}
