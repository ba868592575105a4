//! The local map around the robot: cells that are free, occupied or unknown.

use nalgebra::{Point2, Vector2, distance};

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

/// A rectangle of cells. Those on its border are unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    pub columns: usize,
    /// The side of a cell, in metres.
    pub cell: f64,
    /// The corner with the least coordinates, in metres in the frame of the local map.
    pub origin: Point2<f64>,
    /// Row by row.
    pub cells: Vec<Cell>,
}

/// The greatest whole number that is not above this one. `f64::floor` calls a function on older processors.
pub(super) fn floor(number: f64) -> i64 {
    let towards_zero = number as i64;
    towards_zero.saturating_sub(i64::from(number < towards_zero as f64))
}

impl Grid {
    pub(super) fn rows(&self) -> usize {
        self.cells.len() / self.columns.max(1)
    }

    /// The index of the cell at a point, if it is on the map.
    pub(super) fn index(&self, point: Point2<f64>) -> Option<usize> {
        let [column, row] = self.column_row(point);
        let within = |at: i64, count: usize| (0..count as i64).contains(&at);
        let is_on_map = within(column, self.columns) && within(row, self.rows());
        is_on_map.then(|| row as usize * self.columns + column as usize)
    }

    /// The column and the row of a point, on the map or not.
    pub(super) fn column_row(&self, point: Point2<f64>) -> [i64; 2] {
        ((point - self.origin) / self.cell).map(floor).into()
    }

    pub(super) fn point(&self, index: usize) -> Point2<f64> {
        let [column, row] = [index % self.columns, index / self.columns];
        self.origin + Vector2::new(column as f64 + 0.5, row as f64 + 0.5) * self.cell
    }

    /// The cells whose middles are within a distance of a point, in metres, in their order.
    pub(super) fn cells_near(
        &self,
        point: Point2<f64>,
        within: f64,
    ) -> impl Iterator<Item = usize> + '_ {
        self.cells_around(point, within)
            .filter(move |&at| distance(&self.point(at), &point) <= within)
    }

    /// The cells that are at most this far from a point along both axes, in metres, in their order.
    pub(super) fn cells_around(
        &self,
        point: Point2<f64>,
        within: f64,
    ) -> impl Iterator<Item = usize> + '_ {
        let reach = (within / self.cell).ceil() as i64;
        let [column, row] = self.column_row(point);
        let around = move |at: i64, count: usize| {
            let last = count as i64 - 1;
            (at - reach).clamp(0, last)..=(at + reach).clamp(0, last)
        };
        around(row, self.rows()).flat_map(move |row| {
            around(column, self.columns)
                .map(move |column| row as usize * self.columns + column as usize)
        })
    }

    /// The eight neighbours of a cell that is not on the border, in clockwise order from a diagonal one.
    pub(super) fn neighbours(&self, index: usize) -> [usize; 8] {
        let row = self.columns;
        [
            index - row - 1,
            index - row,
            index - row + 1,
            index + 1,
            index + row + 1,
            index + row,
            index + row - 1,
            index - 1,
        ]
    }

    /// The groups of neighbouring cells of a set. None of them is on the border.
    pub(super) fn groups(&self, set: &[usize]) -> Vec<Vec<usize>> {
        // Whether a cell belongs to the set and to no group yet.
        let mut is_left = vec![false; self.cells.len()];
        for &at in set {
            is_left[at] = true;
        }
        let mut groups = Vec::new();
        for &start in set {
            if !is_left[start] {
                continue;
            }
            is_left[start] = false;
            let mut group = vec![start];
            let mut next = 0;
            while let Some(&at) = group.get(next) {
                next += 1;
                for near in self.neighbours(at) {
                    if is_left[near] {
                        is_left[near] = false;
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
        let mut changed: Vec<usize> = Vec::new();
        for row in 1..self.rows().saturating_sub(1) {
            for at in row * self.columns + 1..(row + 1) * self.columns - 1 {
                let is_free = |at: &usize| self.cells[*at] == Cell::Free;
                let direct = [at - 1, at + 1, at - self.columns, at + self.columns];
                if self.cells[at] == Cell::Unknown
                    && direct.iter().any(is_free)
                    && self.neighbours(at).iter().filter(|at| is_free(at)).count() >= 5
                {
                    changed.push(at);
                }
            }
        }
        self.free(&changed);
        let limit = (params.small_obstacle / self.cell).ceil() as usize;
        let small = self.small_obstacles(limit);
        self.free(&small);
    }

    fn free(&mut self, cells: &[usize]) {
        for &at in cells {
            self.cells[at] = Cell::Free;
        }
    }

    /// The cells of groups that are not free and smaller than this many cells along both axes.
    fn small_obstacles(&self, limit: usize) -> Vec<usize> {
        let is_free = |at: usize| self.cells[at] == Cell::Free;
        let column_row = |at: usize| [at % self.columns, at / self.columns];
        let border = [self.columns - 1, self.rows() - 1];
        let is_border =
            |place: [usize; 2]| (0..2).any(|axis| place[axis] == 0 || place[axis] == border[axis]);
        // The number of the group, from 1; a large group is left before all of its cells are seen.
        let mut group = vec![0_u32; self.cells.len()];
        let mut large = vec![true];
        let mut small = Vec::new();
        let mut members = Vec::new();
        // The first cell of a row of a group has a free one before it.
        for start in (1..self.cells.len()).filter(|&at| !is_free(at) && is_free(at - 1)) {
            if group[start] > 0 {
                continue;
            }
            let number = large.len() as u32;
            group[start] = number;
            members.clear();
            members.push(start);
            let (mut low, mut high) = (column_row(start), column_row(start));
            let mut next = 0;
            let is_large = loop {
                let Some(&at) = members.get(next) else { break false };
                next += 1;
                let place = column_row(at);
                low = [0, 1].map(|axis| low[axis].min(place[axis]));
                high = [0, 1].map(|axis| high[axis].max(place[axis]));
                if is_border(place) || (0..2).any(|axis| high[axis] - low[axis] >= limit) {
                    break true;
                }
                let near = self.neighbours(at);
                let is_of_large = |&near: &usize| {
                    group[near] > 0 && group[near] != number && large[group[near] as usize]
                };
                if near.iter().any(|near| !is_free(*near) && is_of_large(near)) {
                    break true;
                }
                for near in near {
                    if !is_free(near) && group[near] != number {
                        group[near] = number;
                        members.push(near);
                    }
                }
            };
            large.push(is_large);
            if !is_large {
                small.extend_from_slice(&members);
            }
        }
        small
    }
}
