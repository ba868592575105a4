//! Where rays of the last scans have passed and where they have ended, on the local map.

use nalgebra::{Point2, Vector2};

use super::{
    grid::{Cell, Grid, floor},
    params::LocalMapParams,
};

/// The rays of one scan, in metres on the local map.
#[derive(Clone, Debug, Default)]
pub(super) struct Rays {
    pub from: Point2<f64>,
    /// Where rays ended at an obstacle.
    pub hits: Vec<Point2<f64>>,
    /// Where rays between two neighbours would have ended at the latest.
    pub between: Vec<Point2<f64>>,
    /// Straight pieces of wall between the ends of neighbouring rays.
    pub walls: Vec<[Point2<f64>; 2]>,
}

/// Counts of rays. Rays are added, and removed again when their scan is forgotten.
#[derive(Clone, Debug)]
pub(super) struct RayCounts {
    side: usize,
    cell: f64,
    /// The corner with the least coordinates, in metres.
    origin: Point2<f64>,
    hits: Vec<u32>,
    passes: Vec<u32>,
}

impl RayCounts {
    /// Counts around a point, in a square of this many cells a side. The corners of cells lie `shift` cells from
    /// the origin of the frame.
    pub(super) fn around(point: Point2<f64>, side: usize, cell: f64, shift: Vector2<f64>) -> Self {
        let half = (side / 2) as f64;
        Self {
            side,
            cell,
            origin: ((point / cell).map(|at| at.floor() - half) + shift) * cell,
            hits: vec![0; side * side],
            passes: vec![0; side * side],
        }
    }

    pub(super) fn add(&mut self, rays: &Rays) {
        self.count(rays, |count| *count = count.saturating_add(1));
    }

    pub(super) fn remove(&mut self, rays: &Rays) {
        self.count(rays, |count| *count = count.saturating_sub(1));
    }

    fn count(&mut self, rays: &Rays, change: impl Fn(&mut u32)) {
        let from = self.place(rays.from);
        for (ends, hit) in [(&rays.hits, true), (&rays.between, false)] {
            for &end in ends {
                let end = self.place(end);
                let last = cell_at(end);
                for at in cells(from, end, 1.0).filter(|&at| at != last) {
                    if let Some(index) = self.index(at) {
                        change(&mut self.passes[index]);
                    }
                }
                if let Some(index) = self.index(last).filter(|_| hit) {
                    change(&mut self.hits[index]);
                }
            }
        }
        for &[one, other] in &rays.walls {
            let (one, other) = (self.place(one), self.place(other));
            let ends = [cell_at(one), cell_at(other)];
            for at in cells(one, other, 2.0).filter(|at| !ends.contains(at)) {
                if let Some(index) = self.index(at) {
                    change(&mut self.hits[index]);
                }
            }
        }
    }

    /// Whether a window of this many cells a side fits around a point.
    pub(super) fn covers(&self, point: Point2<f64>, window: usize) -> bool {
        let half = (window / 2) as i64;
        cell_at(self.place(point)).iter().all(|&at| at - half >= 0 && at + half < self.side as i64)
    }

    /// What is known around a point, in a square of an odd number of cells a side, which must fit; without
    /// the rows and columns in which nothing is known, except one on each side.
    pub(super) fn window(&self, point: Point2<f64>, side: usize, params: &LocalMapParams) -> Grid {
        let half = (side / 2) as i64;
        // The window without its border.
        let [west, south] = cell_at(self.place(point)).map(|at| (at - half + 1).max(1) as usize);
        let inner = side.saturating_sub(2);
        let width = (west + inner).min(self.side - 1) - west;
        let mut all = Vec::with_capacity(inner * width);
        for row in south..(south + inner).min(self.side - 1) {
            let first = row * self.side + west;
            all.extend((first..first + width).map(|index| self.cell(index, params)));
        }
        let is_known = |at: usize| all[at] != Cell::Unknown;
        let is_known_row = |row: &usize| (row * width..(row + 1) * width).any(is_known);
        let is_known_column = |column: &usize| (*column..all.len()).step_by(width).any(is_known);
        let (mut rows, mut columns) = (0..all.len() / width, 0..width);
        let bottom = rows.find(is_known_row).unwrap_or_default();
        let top = rows.rfind(is_known_row).unwrap_or(bottom);
        let left = columns.find(is_known_column).unwrap_or_default();
        let right = columns.rfind(is_known_column).unwrap_or(left);
        let columns = right + 3 - left;
        let mut cells = vec![Cell::Unknown; columns];
        for row in bottom..=top {
            cells.push(Cell::Unknown);
            let first = row * width;
            cells.extend_from_slice(&all[first + left..=first + right]);
            cells.push(Cell::Unknown);
        }
        cells.extend(vec![Cell::Unknown; columns]);
        let corner = Vector2::new(west + left, south + bottom).map(|at| at as f64 - 1.0);
        let origin = self.origin + corner * self.cell;
        Grid { columns, cell: self.cell, origin, cells }
    }

    fn cell(&self, index: usize, params: &LocalMapParams) -> Cell {
        let (hits, passes) = (self.hits[index], self.passes[index]);
        if hits == 0 {
            if passes == 0 { Cell::Unknown } else { Cell::Free }
        } else {
            let part = f64::from(hits) / (f64::from(hits) + f64::from(passes));
            if part >= params.occupied { Cell::Occupied } else { Cell::Free }
        }
    }

    /// A point in cells from the corner.
    fn place(&self, point: Point2<f64>) -> Vector2<f64> {
        (point - self.origin) / self.cell
    }

    fn index(&self, [column, row]: [i64; 2]) -> Option<usize> {
        let within = |at: i64| (0..self.side as i64).contains(&at);
        (within(column) && within(row)).then(|| row as usize * self.side + column as usize)
    }
}

/// The cell at a place; far away, one beyond every map.
fn cell_at(place: Vector2<f64>) -> [i64; 2] {
    place.map(|at| floor(at.clamp(-1e9, 1e9))).into()
}

/// The cells on a line, each once, sampled this often on each cell that it crosses along its main axis.
fn cells(from: Vector2<f64>, to: Vector2<f64>, density: f64) -> impl Iterator<Item = [i64; 2]> {
    let [from, to] = [from, to].map(|place| place.map(|at| at.clamp(-1e9, 1e9)));
    let off = to - from;
    let steps = (density * off.amax()).ceil().max(1.0);
    let step = off / steps;
    let mut last = None;
    (0..=steps as u32).filter_map(move |number| {
        let at = (from + f64::from(number) * step).map(floor);
        (last.replace(at) != Some(at)).then_some(at.into())
    })
}
