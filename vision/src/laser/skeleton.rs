//! The generalised Voronoi graph of the free space (Choset and Nagatani, 2001) on the cells of the local
//! map: homotopic thinning in the order of the distance to the nearest obstacle (Pudney, 1998). It keeps
//! the ends of the ways, and so has no branches into corners.

use super::{
    clearances::Clearances,
    ends::{End, ends, way_lengths},
    grid::{Cell, Grid},
    params::LaserParams,
};

/// The cells in the middle of the ways that the robot can take.
#[derive(Clone, Debug)]
pub struct Skeleton {
    /// Whether a cell belongs to it.
    pub cells: Vec<bool>,
    /// Where ways end.
    pub ends: Vec<End>,
    /// The distances of all cells.
    pub clearances: Clearances,
}

/// The robot stands at most this far from a place that is wide enough for it, in metres.
const BESIDE: f64 = 1.5;

impl Skeleton {
    /// The skeleton of the ways from a robot at a point; `None` if there is none.
    #[must_use]
    pub fn new(grid: &Grid, robot: [f64; 2], params: &LaserParams) -> Option<Self> {
        let clearances = Clearances::new(grid);
        let radius = params.map.min_width / 2.0 / grid.cell;
        let is_way = |at: usize| {
            grid.cells[at] == Cell::Free && f64::from(clearances.wall[at]) >= radius * radius
        };
        let mut cells: Vec<bool> = (0..grid.cells.len()).map(is_way).collect();
        let start = nearest(&cells, grid, robot, BESIDE)?;
        let lengths = way_lengths(&mut cells, grid, start);
        let ends = ends(&cells, &lengths, &clearances, grid, params);
        thin(&mut cells, &clearances, &ends, grid);
        Some(Self { cells, ends, clearances })
    }
}

/// The cell of a set that is nearest to a point, within a distance in metres.
fn nearest(set: &[bool], grid: &Grid, point: [f64; 2], within: f64) -> Option<usize> {
    let reach = (within / grid.cell).ceil() as i64;
    let [x, y] = grid.column_row(point);
    let around = |at: i64, count: usize| {
        let last = count as i64 - 1;
        (at - reach).clamp(0, last)..=(at + reach).clamp(0, last)
    };
    around(y, grid.rows())
        .flat_map(|row| around(x, grid.columns).map(move |column| (row, column)))
        .map(|(row, column)| {
            let off = (row - y).pow(2) + (column - x).pow(2);
            (off, (row * grid.columns as i64 + column) as usize)
        })
        .filter(|&(_, at)| set[at])
        .min()
        .map(|(_, at)| at)
}

/// Removes cells whose removal does not change the topology, those nearest to a wall or to the unknown first.
fn thin(cells: &mut [bool], clearances: &Clearances, ends: &[End], grid: &Grid) {
    let mut is_end = vec![false; cells.len()];
    for end in ends {
        is_end[end.cell] = true;
    }
    let all = (0..cells.len()).filter(|&at| cells[at] && !is_end[at]);
    let mut left: Vec<(u32, usize)> = all.map(|at| (clearances.border[at], at)).collect();
    left.sort_unstable();
    loop {
        let before = left.len();
        left.retain(|&(_, at)| {
            let keep = !is_simple(cells, at, grid);
            cells[at] = keep;
            keep
        });
        if left.len() == before {
            return;
        }
    }
}

/// Whether the removal of a cell changes no topology: Yokoi's connectivity number of its neighbourhood is
/// one.
fn is_simple(cells: &[bool], at: usize, grid: &Grid) -> bool {
    let empty = grid.neighbours(at).map(|near| !cells[near]);
    let number = |direct: usize| {
        let all = empty[direct] && empty[(direct + 1) % 8] && empty[(direct + 2) % 8];
        i32::from(empty[direct]) - i32::from(all)
    };
    [1, 3, 5, 7].into_iter().map(number).sum::<i32>() == 1
}
