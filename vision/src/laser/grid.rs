//! The local map around the robot: cells that are free, occupied or unknown.

use super::params::LocalMapParams;

/// What is known of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cell {
    /// No ray has reached it.
    Unknown,
    /// Rays have passed it.
    Free,
    /// Rays have ended there.
    Occupied,
}

/// A square of cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// The number of cells on a side.
    pub side: usize,
    /// The side of a cell, in metres.
    pub cell: f64,
    /// The corner with the least coordinates, in metres in the frame of odometry.
    pub origin: [f64; 2],
    /// The cells, row by row.
    pub cells: Vec<Cell>,
}

impl Grid {
    /// The index of the cell at a point, if it is on the map.
    #[must_use]
    pub fn index(&self, point: [f64; 2]) -> Option<usize> {
        let [column, row] = self.column_row(point);
        let within = |at: i64| (0..self.side as i64).contains(&at);
        (within(column) && within(row)).then(|| row as usize * self.side + column as usize)
    }

    /// The column and the row of a point, on the map or not.
    #[must_use]
    pub fn column_row(&self, point: [f64; 2]) -> [i64; 2] {
        [0, 1].map(|axis| ((point[axis] - self.origin[axis]) / self.cell).floor() as i64)
    }

    /// The middle of a cell.
    #[must_use]
    pub fn point(&self, index: usize) -> [f64; 2] {
        let at = [index % self.side, index / self.side];
        [0, 1].map(|axis| self.origin[axis] + (at[axis] as f64 + 0.5) * self.cell)
    }

    /// Whether a cell is on the border of the map.
    #[must_use]
    pub fn is_border(&self, index: usize) -> bool {
        let last = self.side - 1;
        [index % self.side, index / self.side].iter().any(|&at| at == 0 || at == last)
    }

    /// The eight neighbours of a cell that is not on the border, in clockwise order from a diagonal one.
    #[must_use]
    pub fn neighbours(&self, index: usize) -> [usize; 8] {
        let side = self.side;
        [
            index - side - 1,
            index - side,
            index - side + 1,
            index + 1,
            index + side + 1,
            index + side,
            index + side - 1,
            index - 1,
        ]
    }

    /// The groups of neighbouring cells of a kind. Cells on the border of the map are in a group, but do not
    /// connect it.
    pub(super) fn groups(&self, is_member: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
        let mut seen = vec![false; self.cells.len()];
        let mut groups = Vec::new();
        for start in 0..self.cells.len() {
            if seen[start] || !is_member(start) {
                continue;
            }
            seen[start] = true;
            let mut group = vec![start];
            let mut next = 0;
            while let Some(&at) = group.get(next) {
                next += 1;
                if self.is_border(at) {
                    continue;
                }
                for near in self.neighbours(at) {
                    if !seen[near] && is_member(near) {
                        seen[near] = true;
                        group.push(near);
                    }
                }
            }
            groups.push(group);
        }
        groups
    }

    /// Makes free what only looks otherwise: cells between rays, and obstacles too small to divide a way.
    pub(super) fn clean(&mut self, params: &LocalMapParams) {
        let is_free = |cells: &[Cell], at: usize| cells[at] == Cell::Free;
        let specks: Vec<usize> = (0..self.cells.len())
            .filter(|&at| self.cells[at] == Cell::Unknown && !self.is_border(at))
            .filter(|&at| {
                self.neighbours(at).into_iter().filter(|&near| is_free(&self.cells, near)).count()
                    >= 5
            })
            .collect();
        for at in specks {
            self.cells[at] = Cell::Free;
        }
        let limit = (params.small_obstacle / self.cell).ceil() as usize;
        for group in self.groups(|at| !is_free(&self.cells, at)) {
            let is_small = [1, self.side].iter().all(|&unit| {
                let along = || group.iter().map(|&at| at / unit % self.side);
                let (low, high) = (along().min(), along().max());
                low.zip(high).is_some_and(|(low, high)| high - low < limit)
            });
            if is_small && !group.iter().any(|&at| self.is_border(at)) {
                for at in group {
                    self.cells[at] = Cell::Free;
                }
            }
        }
    }
}
