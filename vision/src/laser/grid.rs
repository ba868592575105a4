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
        let place = (point - self.origin) / self.cell;
        [floor(place.x), floor(place.y)]
    }

    pub(super) fn point(&self, index: usize) -> Point2<f64> {
        let [column, row] = [index % self.columns, index / self.columns];
        self.origin + Vector2::new(column as f64 + 0.5, row as f64 + 0.5) * self.cell
    }

    /// Takes a piece of wall that stopped a robot here: its cells are occupied, and those between it and the robot are free if
    /// nothing is known of them. Cells on the border stay unknown.
    pub(super) fn build(&mut self, robot: Point2<f64>, [one, other]: [Point2<f64>; 2]) {
        let on_wall = self.along(one, other);
        for &at in &on_wall {
            for cell in self.along(robot, self.point(at)) {
                if self.cells[cell] == Cell::Unknown {
                    self.cells[cell] = Cell::Free;
                }
            }
        }
        for at in on_wall {
            self.cells[at] = Cell::Occupied;
        }
    }

    /// The cells along a straight line, without those on the border.
    fn along(&self, from: Point2<f64>, to: Point2<f64>) -> Vec<usize> {
        let steps = (4.0 * distance(&from, &to) / self.cell).ceil().max(1.0) as u32;
        let points =
            (0..=steps).map(|step| from + f64::from(step) / f64::from(steps) * (to - from));
        let cell = |point| {
            let [column, row] = self.column_row(point);
            let is_within = |at: i64, count: usize| (1..count as i64 - 1).contains(&at);
            (is_within(column, self.columns) && is_within(row, self.rows()))
                .then(|| row as usize * self.columns + column as usize)
        };
        points.filter_map(cell).collect()
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
        let row = (params.row / self.cell).ceil() as usize;
        let small = (params.small_obstacle / self.cell).ceil() as usize;
        let gap = params.row_gap / self.cell;
        // What lies in the shadow of an obstacle is no part of a row.
        let occupied = self.obstacles(row, |cell| cell == Cell::Occupied);
        let mut is_in_row = vec![false; self.cells.len()];
        for obstacle in in_rows(&occupied, gap, row as f64) {
            for &at in &obstacle.cells {
                is_in_row[at] = true;
            }
        }
        for Obstacle { cells, .. } in self.obstacles(small, |cell| cell != Cell::Free) {
            if !cells.iter().any(|&at| is_in_row[at]) {
                self.free(&cells);
            }
        }
    }

    fn free(&mut self, cells: &[usize]) {
        for &at in cells {
            self.cells[at] = Cell::Free;
        }
    }

    /// The groups of neighbouring cells of a kind that are smaller than this many cells along both axes.
    fn obstacles(&self, limit: usize, is_kind: impl Fn(Cell) -> bool) -> Vec<Obstacle> {
        let is_free = |at: usize| !is_kind(self.cells[at]);
        let column_row = |at: usize| [at % self.columns, at / self.columns];
        let border = [self.columns - 1, self.rows() - 1];
        let is_border =
            |place: [usize; 2]| (0..2).any(|axis| place[axis] == 0 || place[axis] == border[axis]);
        // The number of the group, from 1; a large group is left before all of its cells are seen.
        let mut group = vec![0_u32; self.cells.len()];
        let mut large = vec![true];
        let mut obstacles = Vec::new();
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
                obstacles.push(Obstacle { cells: members.clone(), low, high });
            }
        }
        obstacles
    }
}

/// Cells in the order of small numbers, those with the same number in theirs: counting sort.
pub(super) fn in_order_of(number: impl Fn(usize) -> u32, cells: &[usize]) -> Vec<usize> {
    let most = cells.iter().map(|&at| number(at)).max().unwrap_or_default() as usize;
    // Where the next cell with each number goes.
    let mut next = vec![0; most + 2];
    for &at in cells {
        next[number(at) as usize + 1] += 1;
    }
    for at in 1..next.len() {
        next[at] += next[at - 1];
    }
    let mut ordered = vec![0; cells.len()];
    for &at in cells {
        let to = &mut next[number(at) as usize];
        ordered[*to] = at;
        *to += 1;
    }
    ordered
}

/// Neighbouring cells in a rectangle, by the columns and rows of its corners.
struct Obstacle {
    cells: Vec<usize>,
    low: [usize; 2],
    high: [usize; 2],
}

impl Obstacle {
    fn middle(&self) -> Point2<f64> {
        [0, 1].map(|axis| (self.low[axis] + self.high[axis]) as f64 / 2.0).into()
    }

    /// Its length along a direction.
    fn along(&self, direction: &Vector2<f64>) -> f64 {
        let side = |axis: usize| (self.high[axis] - self.low[axis] + 1) as f64;
        side(0) * direction.x.abs() + side(1) * direction.y.abs()
    }

    /// Whether the distance between two rectangles is less than this.
    fn is_near(&self, other: &Self, within: f64) -> bool {
        let gap = |axis: usize| {
            let after = |one: &Self, other: &Self| one.low[axis].saturating_sub(other.high[axis]);
            after(self, other).max(after(other, self)) as f64
        };
        // Most are far apart along one axis.
        gap(0) < within && gap(1) < within && gap(0).hypot(gap(1)) < within
    }
}

/// Which of these obstacles stand in a straight row at least this long, with gaps that are narrower than this: the mullions of
/// a glass front, which is a wall. All in cells.
fn in_rows(obstacles: &[Obstacle], gap: f64, length: f64) -> impl Iterator<Item = &Obstacle> {
    /// How far an obstacle of a row is off its line: as deep as mullions are.
    const OFF: f64 = 2.0;
    /// The part of a row that obstacles fill at least: specks do not.
    const FILLED: f64 = 0.3;
    let middles: Vec<Point2<f64>> = obstacles.iter().map(Obstacle::middle).collect();
    let numbers = 0..obstacles.len();
    let is_beside =
        |one: usize, other: usize| one != other && obstacles[one].is_near(&obstacles[other], gap);
    let beside: Vec<Vec<usize>> = numbers
        .clone()
        .map(|one| numbers.clone().filter(|&other| is_beside(one, other)).collect())
        .collect();
    let mut in_rows = vec![false; obstacles.len()];
    for first in numbers {
        for &second in &beside[first] {
            let mut row = vec![first];
            let mut next = Some(second);
            while let Some(last) = next {
                row.push(last);
                let along = (middles[last] - middles[first]).normalize();
                let off = |other: usize| middles[other] - middles[last];
                let goes_on = |&other: &usize| {
                    off(other).dot(&along) > 0.0 && off(other).perp(&along).abs() <= OFF
                };
                let near =
                    |one: &usize, other: &usize| off(*one).norm().total_cmp(&off(*other).norm());
                next = beside[last].iter().copied().filter(goes_on).min_by(near);
            }
            let along = middles[row[row.len() - 1]] - middles[first];
            let filled: f64 =
                row.iter().map(|&number| obstacles[number].along(&along.normalize())).sum();
            if along.norm() >= length && filled >= FILLED * along.norm() {
                for obstacle in row {
                    in_rows[obstacle] = true;
                }
            }
        }
    }
    obstacles.iter().zip(in_rows).filter_map(|(obstacle, is_in_row)| is_in_row.then_some(obstacle))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Free cells with obstacles of so many columns and 3 rows, each so many columns after the one before.
    fn with_obstacles(number: usize, width: usize, step: usize) -> Grid {
        let (columns, rows) = (80, 20);
        let cell = |at: usize| {
            let [column, row] = [at % columns, at / columns];
            let is_border = [0, columns - 1].contains(&column) || [0, rows - 1].contains(&row);
            let (obstacle, within) = (column.wrapping_sub(5) / step, column.wrapping_sub(5) % step);
            let is_occupied = (9..12).contains(&row) && obstacle < number && within < width;
            match (is_border, is_occupied) {
                (true, _) => Cell::Unknown,
                (_, true) => Cell::Occupied,
                _ => Cell::Free,
            }
        };
        let cells = (0..columns * rows).map(cell).collect();
        Grid { columns, cell: 0.15, origin: Point2::origin(), cells }
    }

    fn occupied(grid: &Grid) -> usize {
        grid.cells.iter().filter(|&&cell| cell == Cell::Occupied).count()
    }

    #[test]
    fn the_mullions_of_a_glass_front_are_a_wall_and_people_and_chairs_are_none() {
        let left = |number: usize, width: usize, step: usize| {
            let mut grid = with_obstacles(number, width, step);
            let before = occupied(&grid);
            grid.clean(&LocalMapParams::default());
            (before, occupied(&grid))
        };
        assert_eq!(left(10, 2, 5), (60, 60), "mullions each 0.75 m");
        assert_eq!(left(1, 2, 5), (6, 0), "a person");
        assert_eq!(left(5, 2, 5), (30, 0), "a row of 3.3 m");
        assert_eq!(left(10, 1, 5), (30, 0), "specks");
        assert_eq!(left(7, 3, 10), (63, 0), "pillars with ways of 1.2 m between them");
    }

    #[test]
    fn obstacles_beside_each_other_that_stand_in_no_line_are_no_wall() {
        let mut grid = with_obstacles(10, 2, 5);
        // Every other one stands 0.45 m aside.
        for column in 0..grid.columns {
            for row in 9..12 {
                let at = row * grid.columns + column;
                if (column.wrapping_sub(5) / 5) % 2 == 1 && grid.cells[at] == Cell::Occupied {
                    grid.cells.swap(at, at - 3 * grid.columns);
                }
            }
        }
        assert_eq!(occupied(&grid), 60);
        grid.clean(&LocalMapParams::default());
        assert_eq!(occupied(&grid), 0);
    }

    #[test]
    fn a_row_of_mullions_is_a_wall_in_any_direction() {
        let mut grid = Grid {
            cells: vec![Cell::Free; 60 * 60],
            columns: 60,
            cell: 0.15,
            origin: Point2::origin(),
        };
        for number in 0..12_usize {
            let (column, row) = (5 + 4 * number, 10 + 2 * number);
            for at in [
                row * 60 + column,
                row * 60 + column + 1,
                (row + 1) * 60 + column,
                (row + 1) * 60 + column + 1,
            ] {
                grid.cells[at] = Cell::Occupied;
            }
        }
        grid.clean(&LocalMapParams::default());
        assert_eq!(occupied(&grid), 12 * 4);
    }
}
