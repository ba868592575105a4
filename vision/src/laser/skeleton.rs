//! The generalised Voronoi graph of the free space, on the cells of the local map: homotopic thinning in
//! the order of the distance to the nearest obstacle (Pudney, 1998), which keeps the ends of what was not
//! seen to end and the tips of what was.

use std::collections::VecDeque;

use super::{
    distance::squared_distances,
    grid::{Cell, Grid, neighbours8},
    params::LaserParams,
};

/// The end of an arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArmEnd {
    /// Free space goes on where nothing was seen yet.
    Open,
    /// It was seen to end.
    Closed,
}

/// The cells of the skeleton.
#[derive(Clone, Debug)]
pub struct Skeleton {
    /// Whether a cell belongs to it.
    pub cells: Vec<bool>,
    /// Where arms end.
    pub ends: Vec<(usize, ArmEnd)>,
    /// For each end: cells of the frontier, greatest clearance on it in cells, farthest geodesic.
    pub info: Vec<(usize, f64, f64)>,
    pub geo: Vec<u32>,
    /// The squared distance, in cells, to the nearest obstacle.
    pub clearance: Vec<u32>,
}

impl Skeleton {
    /// The skeleton of the free space that the robot can reach; `None` if it stands in none.
    pub fn of(grid: &Grid, robot: [f64; 2], params: &LaserParams) -> Option<Self> {
        let side = grid.side;
        let border = |at: usize| {
            let (x, y) = (at % side, at / side);
            x == 0 || y == 0 || x == side - 1 || y == side - 1
        };
        let clearance = squared_distances(side, |at| grid.cells[at] == Cell::Occupied);
        let unknown =
            squared_distances(side, |at| grid.cells[at] == Cell::Unknown || border(at));
        let radius = params.min_width / 2.0 / grid.cell;
        let wide = (radius * radius).ceil() as u32;
        let mut way: Vec<bool> = (0..side * side)
            .map(|at| grid.cells[at] == Cell::Free && clearance[at] >= wide && unknown[at] >= 1)
            .collect();
        let start = nearest(&way, grid, robot, 1.5)?;
        let geodesic = geodesic(&mut way, side, start);
        let gaps = gaps(grid, &unknown, &clearance, params);
        let (ends, info) = ends(&way, &geodesic, &unknown, &clearance, &gaps, side, params);
        let mut cells = way;
        let order: Vec<u32> =
            (0..side * side).map(|at| clearance[at].min(unknown[at])).collect();
        thin(&mut cells, &order, &ends, side);
        Some(Self { cells, ends, info, clearance, geo: geodesic })
    }
}

/// The nearest cell of a set within a distance, in metres.
fn nearest(set: &[bool], grid: &Grid, point: [f64; 2], within: f64) -> Option<usize> {
    let [x, y] = grid.column_row(point).map(|at| at.floor() as i64);
    let reach = (within / grid.cell).ceil() as i64;
    let side = grid.side as i64;
    let mut best: Option<(i64, usize)> = None;
    for row in (y - reach).max(0)..=(y + reach).min(side - 1) {
        for column in (x - reach).max(0)..=(x + reach).min(side - 1) {
            let at = (row * side + column) as usize;
            let off = (row - y).pow(2) + (column - x).pow(2);
            if set[at] && best.is_none_or(|(least, _)| off < least) {
                best = Some((off, at));
            }
        }
    }
    best.map(|(_, at)| at)
}

/// Lengths of steps in a fifth of a cell: straight, diagonal.
const STEP: [u32; 2] = [5, 7];

/// The length of the shortest way from a cell to each that it reaches, in fifths of a cell. Removes the
/// others from the set.
fn geodesic(way: &mut [bool], side: usize, start: usize) -> Vec<u32> {
    let mut length = vec![u32::MAX; way.len()];
    length[start] = 0;
    // A ring of buckets: no step is longer than 7.
    let mut buckets: [VecDeque<usize>; 8] = Default::default();
    buckets[0].push_back(start);
    let (mut value, mut waiting) = (0_u32, 1_usize);
    while waiting > 0 {
        while let Some(at) = buckets[value as usize % 8].pop_front() {
            waiting -= 1;
            if length[at] != value {
                continue;
            }
            for (number, near) in neighbours8(at, side).into_iter().enumerate() {
                let step = STEP[usize::from(number % 2 == 0 && number != 7 || number == 0)];
                let step = if matches!(number, 1 | 3 | 5 | 7) { STEP[0] } else { step };
                if way[near] && length[near] > value + step {
                    length[near] = value + step;
                    buckets[(value + step) as usize % 8].push_back(near);
                    waiting += 1;
                }
            }
        }
        value += 1;
    }
    for (known, &length) in way.iter_mut().zip(&length) {
        *known &= length != u32::MAX;
    }
    length
}

/// Where ways end: one cell for each stretch of border to what is unknown, and the tips of what was seen
/// to end, which are maxima of the distance from the robot.
fn ends(
    way: &[bool],
    geodesic: &[u32],
    unknown: &[u32],
    clearance: &[u32],
    gaps: &[bool],
    side: usize,
    params: &LaserParams,
) -> (Vec<(usize, ArmEnd)>, Vec<(usize,f64,f64)>) {
    let mut ends = Vec::new(); let mut info = Vec::new();
    let mut seen = vec![false; way.len()];
    let is_border = |at: usize| way[at] && unknown[at] <= params.frontier_near;
    let mut group = Vec::new();
    for start in 0..way.len() {
        if seen[start] || !is_border(start) {
            continue;
        }
        group.clear();
        group.push(start);
        seen[start] = true;
        let mut next = 0;
        while let Some(&at) = group.get(next) {
            next += 1;
            for near in neighbours8(at, side) {
                if is_border(near) && !seen[near] {
                    seen[near] = true;
                    group.push(near);
                }
            }
        }
        if group.len() >= params.min_frontier {
            let end = group.iter().copied().max_by_key(|&at| (clearance[at], geodesic[at], at));
            ends.extend(end.map(|end| (end, ArmEnd::Open)));
            let far = group.iter().map(|&at| geodesic[at]).max().unwrap();
            info.push((group.len(), f64::from(clearance[end.unwrap()]).sqrt()*params.cell, f64::from(far)/5.0*params.cell));
        }
    }
    let prominence = (1.0 / params.cell * f64::from(STEP[0])) as u32;
    for tip in prominent_maxima(way, geodesic, side, prominence) {
        if !seen[tip] {
            let reach = (params.gap_near / params.cell) as usize;
            let (x, y) = (tip % side, tip / side);
            let near = (y.saturating_sub(reach)..(y + reach).min(side)).any(|row| (x.saturating_sub(reach)..(x + reach).min(side)).any(|column| gaps[row * side + column] && (row.abs_diff(y)).pow(2) + column.abs_diff(x).pow(2) <= reach * reach));
            ends.push((tip, if near { ArmEnd::Open } else { ArmEnd::Closed }));
            info.push((0, f64::from(clearance[tip]).sqrt() * params.cell, f64::from(geodesic[tip])/5.0*params.cell));
        }
    }
    (ends, info)
}

/// Free cells at gaps: stretches of border to what is unknown that are at least so long.
fn gaps(grid: &Grid, unknown: &[u32], clearance: &[u32], params: &LaserParams) -> Vec<bool> {
    let side = grid.side;
    let border = |at: usize| grid.cells[at] == Cell::Free && unknown[at] == 1 && clearance[at] >= 2;
    let mut gaps = vec![false; unknown.len()];
    let mut seen = vec![false; unknown.len()];
    let mut group = Vec::new();
    for start in 0..unknown.len() {
        if seen[start] || !border(start) { continue; }
        group.clear();
        group.push(start);
        seen[start] = true;
        let mut next = 0;
        while let Some(&at) = group.get(next) {
            next += 1;
            let (x, y) = (at % side, at / side);
            if x == 0 || y == 0 || x == side - 1 || y == side - 1 { continue; }
            for near in neighbours8(at, side) {
                if border(near) && !seen[near] { seen[near] = true; group.push(near); }
            }
        }
        if group.len() as f64 * params.cell >= params.gap {
            for &at in &group { gaps[at] = true; }
        }
    }
    gaps
}

/// The maxima of a function on a set of cells from which one must descend this far to reach a greater one.
fn prominent_maxima(set: &[bool], value: &[u32], side: usize, prominence: u32) -> Vec<usize> {
    let mut order: Vec<usize> = (0..set.len()).filter(|&at| set[at]).collect();
    order.sort_unstable_by_key(|&at| (std::cmp::Reverse(value[at]), at));
    let mut parent = vec![usize::MAX; set.len()];
    fn root(parent: &mut [usize], mut at: usize) -> usize {
        while parent[at] != at {
            parent[at] = parent[parent[at]];
            at = parent[at];
        }
        at
    }
    let mut maxima = Vec::new();
    for at in order {
        parent[at] = at;
        for near in neighbours8(at, side) {
            if parent[near] == usize::MAX {
                continue;
            }
            // A root is its component's maximum.
            let (one, other) = (root(&mut parent, at), root(&mut parent, near));
            if one == other {
                continue;
            }
            let (low, high) = if value[one] < value[other] { (one, other) } else { (other, one) };
            if value[low] - value[at] >= prominence {
                maxima.push(low);
            }
            parent[low] = high;
        }
    }
    let highest = (0..set.len()).filter(|&at| set[at]).max_by_key(|&at| value[at]);
    maxima.extend(highest);
    maxima
}

/// Removes cells whose removal does not change the topology, those nearest to an obstacle first.
fn thin(cells: &mut [bool], order: &[u32], ends: &[(usize, ArmEnd)], side: usize) {
    let mut fixed = vec![false; cells.len()];
    for &(end, _) in ends {
        fixed[end] = true;
    }
    let mut left: Vec<usize> = (0..cells.len()).filter(|&at| cells[at] && !fixed[at]).collect();
    left.sort_unstable_by_key(|&at| (order[at], at));
    loop {
        let before = left.len();
        left.retain(|&at| {
            let remove = is_simple(cells, at, side);
            cells[at] &= !remove;
            !remove
        });
        if left.len() == before {
            return;
        }
    }
}

/// Whether a cell can be removed: the number of 8-connected parts of its neighbourhood is one, and it is
/// not inside (Yokoi's connectivity number is one).
fn is_simple(cells: &[bool], at: usize, side: usize) -> bool {
    let around = neighbours8(at, side).map(|near| cells[near]);
    // Yokoi's number for 8-connectivity of the set: over the four direct neighbours.
    let empty = around.map(|cell| !cell);
    let mut number = 0;
    for direct in [1, 3, 5, 7] {
        let (next, after) = ((direct + 1) % 8, (direct + 2) % 8);
        number += i32::from(empty[direct])
            - i32::from(empty[direct] && empty[next] && empty[after]);
    }
    number == 1
}
