//! The generalised Voronoi graph of the free space (Choset and Nagatani, 2001) on the cells of the local
//! map: homotopic thinning in the order of the distance to the nearest obstacle (Pudney, 1998). It keeps
//! the ends of the ways, and so has no branches into corners.

use nalgebra::Point2;

use super::{
    clearances::Clearances,
    counting_sort::sorted_by_key,
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
}

impl Skeleton {
    /// The skeleton of the ways from a robot at a point; `None` if there is none.
    #[must_use]
    pub fn new(
        grid: &Grid,
        clearances: &Clearances,
        robot: Point2<f64>,
        params: &LaserParams,
    ) -> Option<Self> {
        let radius = params.map.min_width / 2.0 / grid.cell;
        let is_way = |at: usize| {
            grid.cells[at] == Cell::Free && f64::from(clearances.wall[at]) >= radius * radius
        };
        let mut cells: Vec<bool> = (0..grid.cells.len()).map(is_way).collect();
        let start = nearest(&cells, grid, robot, params.map.beside_robot)?;
        let lengths = way_lengths(&mut cells, grid, start);
        let ways: Vec<usize> = (0..cells.len()).filter(|&at| cells[at]).collect();
        let ends = ends(&ways, &lengths, clearances, grid, params);
        thin(&mut cells, &ways, clearances, &ends, grid);
        Some(Self { cells, ends })
    }
}

/// The cell of a set that is nearest to a point, within a distance in metres.
fn nearest(set: &[bool], grid: &Grid, point: Point2<f64>, within: f64) -> Option<usize> {
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
fn thin(cells: &mut [bool], ways: &[usize], clearances: &Clearances, ends: &[End], grid: &Grid) {
    let is_end = |at: usize| ends.iter().any(|end| end.cell == at);
    let mut left = sorted_by_key(ways, |at| clearances.border[at]);
    loop {
        let before = left.len();
        left.retain(|&at| {
            let keep = !is_simple(cells, at, grid) || is_end(at);
            cells[at] = keep;
            keep
        });
        if left.len() == before {
            return;
        }
    }
}

/// Whether the removal of a cell changes no topology.
fn is_simple(cells: &[bool], at: usize, grid: &Grid) -> bool {
    let near = grid.neighbours(at);
    let around =
        (0..8).fold(0, |around, number| around | usize::from(cells[near[number]]) << number);
    IS_SIMPLE[around]
}

/// Whether a cell may be removed, by which of its eight neighbours there are: Yokoi's connectivity number of the
/// neighbourhood is one.
const IS_SIMPLE: [bool; 256] = {
    let mut is_simple = [false; 256];
    let mut around = 0;
    while around < 256 {
        let mut number = 0;
        let mut direct = 1;
        while direct < 8 {
            let empty = [direct, (direct + 1) % 8, (direct + 2) % 8];
            let mut all = true;
            let mut next = 0;
            while next < 3 {
                all &= around >> empty[next] & 1 == 0;
                next += 1;
            }
            if around >> direct & 1 == 0 && !all {
                number += 1;
            }
            direct += 2;
        }
        is_simple[around] = number == 1;
        around += 1;
    }
    is_simple
};
