//! Where rays of the last scans have passed and where they have ended, on the local map.

use nalgebra::{Isometry2, Point2, Vector2};

use super::{
    grid::{Cell, Grid, ceil, floor},
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

impl Rays {
    /// The same rays in another frame.
    pub(super) fn moved(&self, motion: &Isometry2<f64>) -> Self {
        let all = |points: &[Point2<f64>]| points.iter().map(|point| motion * point).collect();
        Self {
            from: motion * self.from,
            hits: all(&self.hits),
            between: all(&self.between),
            walls: self.walls.iter().map(|ends| ends.map(|end| motion * end)).collect(),
        }
    }
}

/// Where a map shows walls, and what is near them.
pub(super) struct NearWalls {
    side: usize,
    near: Vec<Option<bool>>,
}

impl NearWalls {
    /// Whether a cell is near a wall; `None` where no ray was.
    pub(super) fn at(&self, cell: [i64; 2]) -> Option<bool> {
        self.near[index_of(self.side, cell)?]
    }
}

/// Counts of rays. Rays are added, and removed again when their scan is forgotten.
#[derive(Clone, Debug)]
pub(super) struct RayCounts {
    side: usize,
    /// The side of a cell, in metres.
    pub cell: f64,
    /// The corner with the least coordinates, in metres.
    origin: Point2<f64>,
    hits: Vec<i32>,
    passes: Vec<i32>,
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
        self.count(rays, 1);
    }

    pub(super) fn remove(&mut self, rays: &Rays) {
        self.count(rays, -1);
    }

    /// Adds so much to the counts of the cells of rays.
    fn count(&mut self, rays: &Rays, more: i32) {
        let side = self.side;
        let from = self.place(rays.from);
        for (ends, is_hit) in [(&rays.hits, true), (&rays.between, false)] {
            for &end in ends {
                let end = self.place(end);
                let last = index_of(side, cell_at(end));
                let before = last.map(|last| self.passes[last]);
                for_cells(side, [from, end], 1.0, |at| self.passes[at] += more);
                // A ray does not pass the cell in which it ends.
                if let Some((last, before)) = last.zip(before) {
                    self.passes[last] = before;
                    self.hits[last] += if is_hit { more } else { 0 };
                }
            }
        }
        for ends in &rays.walls {
            let ends = ends.map(|end| self.place(end));
            let known = ends.map(|end| index_of(side, cell_at(end)));
            for_cells(side, ends, 2.0, |at| {
                if !known.contains(&Some(at)) {
                    self.hits[at] += more;
                }
            });
        }
    }

    /// Where rays ended at most this many cells off, along both axes, and where walls are.
    pub(super) fn near_hits_and_walls(
        &self,
        cells: usize,
        params: &LocalMapParams,
    ) -> [NearWalls; 2] {
        let is_known = |at: usize| self.hits[at] > 0 || self.passes[at] > 0;
        let near = |is_wall: &dyn Fn(usize) -> bool| {
            let walls: Vec<bool> = (0..self.hits.len()).map(is_wall).collect();
            let near = spread(&spread(&walls, self.side, 1, cells), self.side, self.side, cells);
            let near = near.into_iter().enumerate().map(|(at, near)| is_known(at).then_some(near));
            NearWalls { side: self.side, near: near.collect() }
        };
        let is_hit = |at: usize| self.hits[at] > 0;
        let is_wall = |at: usize| self.cell(at, params) == Cell::Occupied;
        [near(&is_hit), near(&is_wall)]
    }

    /// Whether a window of this many cells a side fits around a point.
    pub(super) fn covers(&self, point: Point2<f64>, window: usize) -> bool {
        let half = (window / 2) as i64;
        self.cell_at(point).iter().all(|&at| at - half >= 0 && at + half < self.side as i64)
    }

    /// What is known around a point, in a square of an odd number of cells a side, which must fit; without
    /// the rows and columns in which nothing is known, except one on each side.
    pub(super) fn window(&self, point: Point2<f64>, side: usize, params: &LocalMapParams) -> Grid {
        let half = (side / 2) as i64;
        // The window without its border.
        let [west, south] = self.cell_at(point).map(|at| (at - half + 1).max(1) as usize);
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

    /// The column and the row of a point, on the map or not.
    pub(super) fn cell_at(&self, point: Point2<f64>) -> [i64; 2] {
        cell_at(self.place(point))
    }

    /// A point in cells from the corner.
    fn place(&self, point: Point2<f64>) -> Vector2<f64> {
        (point - self.origin) / self.cell
    }
}

/// The cells that are set, and those at most so many before or behind one in its row (`stride` 1) or column (`stride` the
/// side).
fn spread(cells: &[bool], side: usize, stride: usize, reach: usize) -> Vec<bool> {
    let mut spread = vec![false; cells.len()];
    for index in (0..cells.len()).filter(|&index| cells[index]) {
        let at = index / stride % side;
        let first = index - at.min(reach) * stride;
        let last = index + (side - 1 - at).min(reach) * stride;
        for near in (first..=last).step_by(stride) {
            spread[near] = true;
        }
    }
    spread
}

fn index_of(side: usize, [column, row]: [i64; 2]) -> Option<usize> {
    let within = |at: i64| (0..side as i64).contains(&at);
    (within(column) && within(row)).then(|| row as usize * side + column as usize)
}

/// The cell at a place; far away, one beyond every map.
#[inline]
fn cell_at(place: Vector2<f64>) -> [i64; 2] {
    let cell = |at: f64| floor(at.clamp(-FARTHEST, FARTHEST));
    [cell(place.x), cell(place.y)]
}

/// Ends of lines are at most this many cells from the corner of a map.
const FARTHEST: f64 = 1e9;
/// The parts of a cell in which samples are placed: 2^32.
const PARTS: f64 = 4_294_967_296.0;

/// Visits the cells of a square map on a line, each once, sampled this often on each cell that it crosses along its main
/// axis.
fn for_cells(
    side: usize,
    [from, to]: [Vector2<f64>; 2],
    density: f64,
    mut visit: impl FnMut(usize),
) {
    let near = |at: f64| at.clamp(-FARTHEST, FARTHEST);
    let from = Vector2::new(near(from.x), near(from.y));
    let to = Vector2::new(near(to.x), near(to.y));
    let off = to - from;
    let steps = ceil(density * off.x.abs().max(off.y.abs())).max(1);
    let step = off / steps as f64;
    // The samples on the map.
    let (mut first, mut last) = (0, steps);
    let border = side as f64;
    let is_on_map = |at: f64| (0.0..border).contains(&at);
    for axis in 0..2 {
        if step[axis] == 0.0 || is_on_map(from[axis]) && is_on_map(to[axis]) {
            continue;
        }
        let [one, other] = [0.0, border].map(|border| (border - from[axis]) / step[axis]);
        first = first.max(floor(one.min(other)));
        last = last.min(ceil(one.max(other)));
    }
    if first > last {
        return;
    }
    let start = from + first as f64 * step;
    let in_parts = |at: f64| (at * PARTS) as i64;
    let (mut x, mut y) = (in_parts(start.x), in_parts(start.y));
    let (east, north) = (in_parts(step.x), in_parts(step.y));
    let mut before = usize::MAX;
    let points = last - first + 1;
    for _ in 0..points {
        let [column, row] = [(x >> 32) as usize, (y >> 32) as usize];
        if column < side && row < side {
            let at = row * side + column;
            if at != before {
                visit(at);
                before = at;
            }
        }
        (x, y) = (x + east, y + north);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_line_visits_the_cells_on_the_map_on_which_it_has_samples(
            ends in prop::array::uniform2([-30.0..50.0, -30.0..50.0_f64]),
            density in 1.0..2.0,
        ) {
            const SIDE: usize = 20;
            let ends = ends.map(Vector2::from);
            let mut visited = Vec::new();
            for_cells(SIDE, ends, density, |at| visited.push(at));
            let off = ends[1] - ends[0];
            let steps = (density * off.amax()).ceil().max(1.0);
            let samples = (0..=steps as u32).map(|step| ends[0] + f64::from(step) / steps * off);
            let cells: Vec<Vector2<f64>> = samples.collect();
            // At the border of two cells rounding decides.
            let is_inside = |at: &Vector2<f64>| at.iter().all(|at| (at - at.round()).abs() > 1e-6);
            for at in cells.iter().filter(|at| is_inside(at)) {
                if let Some(index) = index_of(SIDE, cell_at(*at)) {
                    prop_assert!(visited.contains(&index), "{at}");
                }
            }
            for &index in &visited {
                let middle = Vector2::new((index % SIDE) as f64, (index / SIDE) as f64).add_scalar(0.5);
                prop_assert!(cells.iter().any(|at| (at - middle).amax() < 0.5 + 1e-6));
            }
            let mut once = visited.clone();
            once.dedup();
            prop_assert_eq!(once, visited);
        }
    }
}
