//! The local map: what the last scans have shown around the robot, in the frame of odometry.

use super::params::LaserParams;

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

/// One ray: from the scanner to where it ended.
pub type Ray = [f64; 2];

/// A square of cells, around the robot.
#[derive(Clone, Debug)]
pub struct Grid {
    /// The number of cells on a side.
    pub side: usize,
    /// The side of a cell, in metres.
    pub cell: f64,
    /// The corner with the least coordinates, in metres.
    pub origin: [f64; 2],
    /// The cells, row by row.
    pub cells: Vec<Cell>,
    hits: Vec<u16>,
    passes: Vec<u16>,
}

impl Grid {
    /// An empty map.
    pub fn new(params: &LaserParams) -> Self {
        let side = 2 * (params.reach / params.cell).ceil() as usize + 1;
        let all = side * side;
        Self {
            side,
            cell: params.cell,
            origin: [0.0; 2],
            cells: vec![Cell::Unknown; all],
            hits: vec![0; all],
            passes: vec![0; all],
        }
    }

    /// Forgets everything, and moves the map so that this point is in its middle.
    pub fn centre(&mut self, point: [f64; 2]) {
        let half = self.side as f64 * self.cell / 2.0;
        self.origin = point.map(|at| at - half);
        self.cells.fill(Cell::Unknown);
        self.hits.fill(0);
        self.passes.fill(0);
    }

    /// The column and row of a point.
    pub fn column_row(&self, point: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| (point[axis] - self.origin[axis]) / self.cell)
    }

    /// The index of the cell at a point, if it is on the map.
    pub fn index(&self, point: [f64; 2]) -> Option<usize> {
        let [x, y] = self.column_row(point).map(f64::floor);
        let within = |at: f64| at >= 0.0 && at < self.side as f64;
        (within(x) && within(y)).then(|| y as usize * self.side + x as usize)
    }

    /// The middle of a cell.
    pub fn point(&self, index: usize) -> [f64; 2] {
        let at = [index % self.side, index / self.side];
        [0, 1].map(|axis| self.origin[axis] + (at[axis] as f64 + 0.5) * self.cell)
    }

    /// Adds a ray. If it `hit`, its end is an obstacle.
    pub fn ray(&mut self, from: [f64; 2], to: [f64; 2], hit: bool) {
        let [x, y] = self.column_row(from);
        let [to_x, to_y] = self.column_row(to);
        let (dx, dy) = (to_x - x, to_y - y);
        let steps = dx.abs().max(dy.abs()).ceil().max(1.0);
        let (dx, dy) = (dx / steps, dy / steps);
        let end = (to_x.floor() as i64, to_y.floor() as i64);
        let side = self.side as i64;
        let within = |(x, y): (i64, i64)| x >= 0 && y >= 0 && x < side && y < side;
        let mut last = (i64::MIN, i64::MIN);
        for step in 0..steps as u64 {
            let at = ((x + dx * step as f64).floor() as i64, (y + dy * step as f64).floor() as i64);
            if !within(at) {
                if step > 0 && within(last) {
                    return;
                }
                continue;
            }
            if at != last && at != end {
                let passes = &mut self.passes[(at.1 * side + at.0) as usize];
                *passes = passes.saturating_add(1);
            }
            last = at;
        }
        if within(end) && hit {
            let hits = &mut self.hits[(end.1 * side + end.0) as usize];
            *hits = hits.saturating_add(1);
        }
    }

    /// Adds a piece of wall between two ends of rays.
    pub fn wall(&mut self, from: [f64; 2], to: [f64; 2]) {
        let ([x, y], [to_x, to_y]) = (self.column_row(from), self.column_row(to));
        let (dx, dy) = (to_x - x, to_y - y);
        let steps = (2.0 * dx.abs().max(dy.abs())).ceil().max(1.0);
        let side = self.side as i64;
        let mut last = (i64::MIN, i64::MIN);
        let ends = [(x.floor() as i64, y.floor() as i64), (to_x.floor() as i64, to_y.floor() as i64)];
        for step in 1..steps as u64 {
            let part = step as f64 / steps;
            let at = ((x + dx * part).floor() as i64, (y + dy * part).floor() as i64);
            if at == last || ends.contains(&at) || at.0 < 0 || at.1 < 0 || at.0 >= side || at.1 >= side {
                continue;
            }
            last = at;
            let hits = &mut self.hits[(at.1 * side + at.0) as usize];
            *hits = hits.saturating_add(1);
        }
    }

    /// Decides every cell.
    pub fn decide(&mut self, params: &LaserParams) {
        for ((cell, &hits), &passes) in self.cells.iter_mut().zip(&self.hits).zip(&self.passes) {
            let all = f64::from(hits) + f64::from(passes);
            *cell = if hits > 0 && f64::from(hits) >= params.occupied * all {
                Cell::Occupied
            } else if all > 0.0 {
                Cell::Free
            } else {
                Cell::Unknown
            };
        }
        self.fill_specks();
        self.fill_small_obstacles(params);
    }

    /// Unknown cells between rays are free.
    fn fill_specks(&mut self) {
        let side = self.side;
        let before = self.cells.clone();
        for row in 1..side - 1 {
            for column in 1..side - 1 {
                let at = row * side + column;
                if before[at] != Cell::Unknown {
                    continue;
                }
                let free = neighbours8(at, side).into_iter().filter(|&n| before[n] == Cell::Free);
                if free.count() >= 5 {
                    self.cells[at] = Cell::Free;
                }
            }
        }
    }

    /// Obstacles with free space all around are free if they are small.
    fn fill_small_obstacles(&mut self, params: &LaserParams) {
        let side = self.side;
        let limit = (params.small_obstacle / self.cell).ceil() as usize;
        let mut seen = vec![false; self.cells.len()];
        let mut group = Vec::new();
        for start in 0..self.cells.len() {
            if seen[start] || self.cells[start] == Cell::Free {
                continue;
            }
            group.clear();
            group.push(start);
            seen[start] = true;
            let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
            let mut next = 0;
            while let Some(&at) = group.get(next) {
                next += 1;
                let place = [at % side, at / side];
                for axis in 0..2 {
                    low[axis] = low[axis].min(place[axis]);
                    high[axis] = high[axis].max(place[axis]);
                }
                if place[0] == 0 || place[1] == 0 || place[0] == side - 1 || place[1] == side - 1 {
                    high = [usize::MAX / 2; 2];
                    continue;
                }
                for near in neighbours8(at, side) {
                    if !seen[near] && self.cells[near] != Cell::Free {
                        seen[near] = true;
                        group.push(near);
                    }
                }
            }
            if high[0] - low[0] < limit && high[1] - low[1] < limit {
                for &at in &group {
                    self.cells[at] = Cell::Free;
                }
            }
        }
    }
}

/// The eight neighbours of a cell that is not on the border, clockwise from the upper left.
pub fn neighbours8(at: usize, side: usize) -> [usize; 8] {
    [
        at - side - 1,
        at - side,
        at - side + 1,
        at + 1,
        at + side + 1,
        at + side,
        at + side - 1,
        at - 1,
    ]
}
