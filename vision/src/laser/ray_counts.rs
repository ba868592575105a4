//! Where rays of the last scans have passed and where they have ended, on the local map.

use nalgebra::{Isometry2, Point2, Vector2};

use super::{
    grid::{Cell, Grid},
    params::LocalMapParams,
};

/// The rays of one scan, in metres in the robot's frame.
#[derive(Clone, Debug, Default)]
pub(super) struct Rays {
    /// Where rays ended at an obstacle.
    pub hits: Vec<Point2<f64>>,
    /// Where rays passed, up to the cell of the end.
    pub free: Vec<[Point2<f64>; 2]>,
    /// Straight pieces of wall between the ends of neighbouring rays.
    pub walls: Vec<[Point2<f64>; 2]>,
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

    /// Adds the rays of a scan, by the motion from the robot's frame to that of the map.
    pub(super) fn add(&mut self, rays: &Rays, map_from_robot: &Isometry2<f64>) {
        self.count(rays, map_from_robot, 1);
    }

    /// Removes what the same rays and motion have added.
    pub(super) fn remove(&mut self, rays: &Rays, map_from_robot: &Isometry2<f64>) {
        self.count(rays, map_from_robot, -1);
    }

    /// Adds so much to the counts of the cells of rays.
    fn count(&mut self, rays: &Rays, map_from_robot: &Isometry2<f64>, more: i32) {
        let side = self.side;
        let place = self.place_from(map_from_robot);
        // All lines before the first is drawn: a processor guesses wrong where a line ends, and then waits for the next.
        let line = |ends: &[Point2<f64>; 2]| {
            let ends = ends.map(&place);
            (Line::new(side, ends, 0), index_of(side, cell_at(ends[1])))
        };
        let lines: Vec<(Line, Option<usize>)> = rays.free.iter().map(line).collect();
        for (line, last) in lines {
            let before = last.map(|last| self.passes[last]);
            line.for_cells(side, |at, is_new| {
                self.passes[at] += if is_new { more } else { 0 };
            });
            if let Some((last, before)) = last.zip(before) {
                self.passes[last] = before;
            }
        }
        for &hit in &rays.hits {
            if let Some(at) = index_of(side, cell_at(place(hit))) {
                self.hits[at] += more;
            }
        }
        for ends in &rays.walls {
            let ends = ends.map(&place);
            let known = ends.map(|end| index_of(side, cell_at(end)));
            Line::new(side, ends, 1).for_cells(side, |at, is_new| {
                if is_new && !known.contains(&Some(at)) {
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
        [
            self.near(cells, |at| self.hits[at] > 0),
            self.near(cells, |at| self.cell(at, params) == Cell::Occupied),
        ]
    }

    /// What is at most this many cells from a wall, along both axes.
    fn near(&self, cells: usize, is_wall: impl Fn(usize) -> bool) -> NearWalls {
        let walls: Vec<bool> = (0..self.hits.len()).map(is_wall).collect();
        let counts = self.hits.iter().zip(&self.passes);
        let near = spread(&walls, self.side, cells).into_iter().zip(counts);
        let near = near.map(|(near, (&hits, &passes))| (hits > 0 || passes > 0).then_some(near));
        NearWalls { side: self.side, near: near.collect() }
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

    /// The columns and rows of points of another frame, by the motion from there, on the map or not.
    pub(super) fn cells_at<'p>(
        &self,
        points: &'p [Point2<f64>],
        motion: &Isometry2<f64>,
    ) -> impl Iterator<Item = [i64; 2]> + use<'p> {
        let place = self.place_from(motion);
        points.iter().map(move |&point| cell_at(place(point)))
    }

    /// The column and the row of a point, on the map or not.
    pub(super) fn cell_at(&self, point: Point2<f64>) -> [i64; 2] {
        cell_at(self.place_from(&Isometry2::identity())(point))
    }

    /// The places of points of another frame, by the motion from there.
    fn place_from(&self, motion: &Isometry2<f64>) -> impl Fn(Point2<f64>) -> Place + use<> {
        let scale = PARTS / self.cell;
        let turn = motion.rotation.to_rotation_matrix().into_inner() * scale;
        let shift = (motion.translation.vector - self.origin.coords) * scale;
        move |point| {
            let place = turn * point.coords + shift;
            [place.x, place.y].map(|at| at.clamp(-FARTHEST, FARTHEST) as i64)
        }
    }
}

/// The cells of a square map that are at most so many from one that is set, along both axes.
fn spread(cells: &[bool], side: usize, reach: usize) -> Vec<bool> {
    let join = |cells: &mut [bool], others: &[bool]| {
        cells.iter_mut().zip(others).for_each(|(cell, other)| *cell |= other);
    };
    // The others that lie so many behind or before, in the order of both.
    let join_shifted = |cells: &mut [bool], others: &[bool], shift: usize| {
        join(cells, &others[shift..]);
        join(&mut cells[shift..], others);
    };
    let reach = reach.min(side);
    let mut along_rows = cells.to_vec();
    let rows = along_rows.chunks_exact_mut(side).zip(cells.chunks_exact(side));
    for (row, cells) in rows {
        (1..=reach).for_each(|shift| join_shifted(row, cells, shift));
    }
    let mut spread = along_rows.clone();
    (1..=reach).for_each(|shift| join_shifted(&mut spread, &along_rows, shift * side));
    spread
}

fn index_of(side: usize, [column, row]: [i64; 2]) -> Option<usize> {
    // As numbers without a sign, those below zero are beyond every map.
    let [column, row] = [column as usize, row as usize];
    (column < side && row < side).then(|| row * side + column)
}

/// Where a point is, from the corner of a map, in [`PARTS`] of a cell.
type Place = [i64; 2];
/// The parts of a cell: 2^32.
const PARTS: f64 = 4_294_967_296.0;
/// The logarithm of their number.
const PART_BITS: u32 = 32;
/// What is farther away is taken to be here, and a line that begins here reaches no map.
const FARTHEST: f64 = (1_i64 << 61) as f64;

/// The cell at a place.
fn cell_at(place: Place) -> [i64; 2] {
    place.map(|at| at >> PART_BITS)
}

/// A line between two places, by its samples on a square map.
struct Line {
    first: Place,
    step: Place,
    samples: i64,
}

impl Line {
    /// A line that is sampled from its begin to its end: successive samples are at most a cell apart along its main axis, or a
    /// half or a quarter of one if that is halved once or twice.
    fn new(side: usize, [from, to]: [Place; 2], halved: u32) -> Self {
        let off = [0, 1].map(|axis| to[axis] - from[axis]);
        let main = off[0].abs().max(off[1].abs());
        let sample = 1 << (PART_BITS - halved);
        let steps = ((main + sample - 1) >> (PART_BITS - halved)).max(1);
        let step = off.map(|off| off / steps);
        let is_all_on_map =
            [from, to].iter().all(|place| index_of(side, cell_at(*place)).is_some());
        let (first, last) =
            if is_all_on_map { (0, steps) } else { on_map(side, from, step, steps) };
        let samples = last + 1 - first;
        Self { first: [0, 1].map(|axis| from[axis] + first * step[axis]), step, samples }
    }

    /// Visits the cells of its samples. The visitor gets the cell of each sample, and whether it is another one than that of the
    /// sample before.
    fn for_cells(self, side: usize, mut visit: impl FnMut(usize, bool)) {
        let Self { first: [mut x, mut y], step, samples } = self;
        let mut before = usize::MAX;
        for _ in 0..samples {
            let at = (y >> PART_BITS) as usize * side + (x >> PART_BITS) as usize;
            // The visitor can do without a branch, which would be hard to predict.
            visit(at, at != before);
            before = at;
            (x, y) = (x + step[0], y + step[1]);
        }
    }
}

/// The first and the last step of a line that are on a map; the last one is before the first if none is.
#[cold]
fn on_map(side: usize, from: Place, step: Place, steps: i64) -> (i64, i64) {
    if from.iter().any(|at| at.abs() >= FARTHEST as i64) {
        return (0, -1);
    }
    let border = (side as i64) << PART_BITS;
    let (mut first, mut last) = (0, steps);
    for axis in 0..2 {
        let from = from[axis];
        // How far it is to the first and to the last place on the map, forwards.
        let (near, far) = match step[axis] {
            ..0 => (from + 1 - border, from),
            _ => (-from, border - 1 - from),
        };
        match step[axis].abs() {
            0 if near > 0 || far < 0 => return (0, -1),
            0 => {}
            step => {
                first = first.max(-(-near).div_euclid(step));
                last = last.min(far.div_euclid(step));
            }
        }
    }
    if first <= last { (first, last) } else { (0, -1) }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn cells_spread_along_both_axes_and_not_around_the_border(
            set in prop::collection::vec(prop::bool::weighted(0.1), 49..=49),
            reach in 0_usize..9,
        ) {
            const SIDE: usize = 7;
            let spread = spread(&set, SIDE, reach);
            for (at, &is_near) in spread.iter().enumerate() {
                let reaches = |other: usize| {
                    (at % SIDE).abs_diff(other % SIDE).max((at / SIDE).abs_diff(other / SIDE)) <= reach
                };
                let expected = (0..set.len()).any(|other| set[other] && reaches(other));
                prop_assert_eq!(is_near, expected);
            }
        }

        #[test]
        fn a_line_visits_the_cells_on_the_map_on_which_it_has_samples(
            ends in prop::array::uniform2([-30.0..50.0, -30.0..50.0_f64]),
            halved in 0..=2_u32,
        ) {
            const SIDE: usize = 20;
            let ends = ends.map(Vector2::from);
            let mut visited = Vec::new();
            let places = ends.map(|end| [end.x, end.y].map(|at| (at * PARTS) as i64));
            let line = Line::new(SIDE, places, halved);
            line.for_cells(SIDE, |at, is_new| if is_new { visited.push(at) });
            let off = ends[1] - ends[0];
            let steps = (f64::from(1 << halved) * off.amax()).ceil().max(1.0);
            let samples = (0..=steps as u32).map(|step| ends[0] + f64::from(step) / steps * off);
            let cells: Vec<Vector2<f64>> = samples.collect();
            // At the border of two cells rounding decides.
            let is_inside = |at: &Vector2<f64>| at.iter().all(|at| (at - at.round()).abs() > 1e-6);
            for at in cells.iter().filter(|at| is_inside(at)) {
                if let Some(index) = index_of(SIDE, [at.x, at.y].map(|at| at.floor() as i64)) {
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
