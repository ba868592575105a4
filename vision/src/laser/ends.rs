//! The ends of the ways around the robot: where free space goes on unseen, and where it was seen to end.

use super::{
    clearances::Clearances,
    grid::{Grid, in_order_of},
    params::LaserParams,
};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WayEnd {
    /// Free space goes on where nothing was seen yet.
    Open,
    /// It was seen to end, but for a stretch of its border.
    Unclear,
    /// It was seen to end.
    Closed,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    pub cell: usize,
    pub kind: WayEnd,
    /// The width of the gap behind it, in metres.
    pub gap: f64,
    /// How much farther from the robot than the cell the way is known, in metres.
    pub beyond: f64,
}

/// The lengths of a straight and of a diagonal step, in fifths of a cell.
const STRAIGHT: u32 = 5;
const DIAGONAL: u32 = 7;

/// The length of the shortest way to each cell of a set from one of them, in fifths of a cell. The cells
/// that cannot be reached are removed from the set.
pub(super) fn way_lengths(ways: &mut [bool], grid: &Grid, start: usize) -> Vec<u32> {
    let mut lengths = vec![u32::MAX; ways.len()];
    lengths[start] = 0;
    // Cells wait in a ring of buckets by their length: no step is longer than the ring.
    let mut buckets: [Vec<usize>; 8] = Default::default();
    buckets[0].push(start);
    let (mut length, mut waiting) = (0_u32, 1_usize);
    while waiting > 0 {
        while let Some(at) = buckets[length as usize % 8].pop() {
            waiting -= 1;
            if lengths[at] != length {
                continue;
            }
            for (number, near) in grid.neighbours(at).into_iter().enumerate() {
                let to = length + if number % 2 == 0 { DIAGONAL } else { STRAIGHT };
                if ways[near] && lengths[near] > to {
                    lengths[near] = to;
                    buckets[to as usize % 8].push(near);
                    waiting += 1;
                }
            }
        }
        length += 1;
    }
    for (way, &length) in ways.iter_mut().zip(&lengths) {
        *way &= length != u32::MAX;
    }
    lengths
}

/// The ends of the ways: one cell for each stretch of border to the unknown, and the maxima of the distance
/// from the robot. The ways are the indices of cells, in their order.
pub(super) fn ends(
    ways: &[usize],
    lengths: &[u32],
    map: &Clearances,
    params: &LaserParams,
) -> Vec<End> {
    let grid = &map.grid;
    let metres = |length: u32| f64::from(length) / f64::from(STRAIGHT) * grid.cell;
    let mut at_gap = vec![false; grid.cells.len()];
    let mut ends = Vec::new();
    let near_border: Vec<usize> = ways.iter().copied().filter(|&at| map.border[at] <= 4).collect();
    for gap in grid.groups(&near_border) {
        for &at in &gap {
            at_gap[at] = true;
        }
        let Some(&cell) = gap.iter().max_by_key(|&&at| (map.wall[at], lengths[at], at)) else {
            continue;
        };
        let farthest = gap.iter().map(|&at| lengths[at]).max().unwrap_or_default();
        ends.push(End {
            cell,
            kind: WayEnd::Open,
            // The cells of the gap are two rows, and end half a way before its sides.
            gap: params.map.min_width + gap.len() as f64 / 2.0 * grid.cell,
            beyond: metres(farthest - lengths[cell]),
        });
    }
    let borders = unknown_borders(map, params);
    let prominence = (params.arm.min_prominence / grid.cell * f64::from(STRAIGHT)) as u32;
    for cell in maxima(ways, lengths, grid, prominence) {
        if !at_gap[cell] {
            // The number of whole cells.
            let near = (params.arm.border_near / grid.cell).floor() * grid.cell + 1e-9;
            let goes_on = grid.cells_near(grid.point(cell), near).any(|at| borders[at]);
            let end = if goes_on { WayEnd::Unclear } else { WayEnd::Closed };
            ends.push(End { cell, kind: end, gap: params.map.min_width, beyond: 0.0 });
        }
    }
    ends
}

/// The free cells on long stretches of border to the unknown.
fn unknown_borders(map: &Clearances, params: &LaserParams) -> Vec<bool> {
    let grid = &map.grid;
    let mut borders = vec![false; grid.cells.len()];
    let all = (0..grid.cells.len()).filter(|&at| map.is_unknown_border(at));
    for border in grid.groups(&all.collect::<Vec<_>>()) {
        let is_long = border.len() as f64 * grid.cell >= params.arm.border;
        for at in border {
            borders[at] = is_long;
        }
    }
    borders
}

/// The maxima of a function on a set of cells from which one must descend at least this far to reach a
/// greater one.
fn maxima(set: &[usize], value: &[u32], grid: &Grid, prominence: u32) -> Vec<usize> {
    let highest = set.iter().map(|&at| value[at]).max().unwrap_or_default();
    let order = in_order_of(|at| highest - value[at], set);
    // Components of the cells so far, each with its maximum as its root.
    let mut parent: Vec<u32> = vec![NONE; value.len()];
    let mut maxima: Vec<usize> = order.first().copied().into_iter().collect();
    for at in order {
        parent[at] = at as u32;
        // The root of the component of this cell.
        let mut one = at;
        for near in grid.neighbours(at) {
            if parent[near] == NONE {
                continue;
            }
            let other = root(&mut parent, near);
            if one == other {
                continue;
            }
            let (low, high) = if value[one] < value[other] { (one, other) } else { (other, one) };
            if value[low] - value[at] >= prominence {
                maxima.push(low);
            }
            parent[low] = high as u32;
            one = high;
        }
    }
    maxima
}

/// A cell that belongs to no component yet.
const NONE: u32 = u32::MAX;

fn root(parent: &mut [u32], mut at: usize) -> usize {
    while parent[at] as usize != at {
        let above = parent[at] as usize;
        parent[at] = parent[above];
        at = above;
    }
    at
}
