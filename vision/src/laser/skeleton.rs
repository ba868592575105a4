//! The generalised Voronoi graph of the free space (Choset and Nagatani, 2001) on the cells of the local
//! map: homotopic thinning in the order of the distance to the nearest obstacle (Pudney, 1998). It keeps
//! the ends of the ways, and so has no branches into corners.

use nalgebra::Point2;

use super::{
    clearances::Clearances,
    ends::{End, ends, way_lengths},
    grid::{Cell, Grid, in_order_of},
    params::{LaserParams, LocalMapParams},
};

/// The cells in the middle of the ways that the robot can take.
#[derive(Clone, Debug)]
pub struct Skeleton {
    /// Whether each cell belongs to it.
    pub cells: Vec<bool>,
    pub ends: Vec<End>,
}

impl Skeleton {
    /// The skeleton of the ways from a robot at a point; `None` if there is none.
    pub(super) fn new(map: &Clearances, robot: Point2<f64>, params: &LaserParams) -> Option<Self> {
        let grid = &map.grid;
        let radius = params.map.min_width / 2.0 / grid.cell;
        let least = (radius * radius).ceil() as u32;
        let is_way = |at: usize| grid.cells[at] == Cell::Free && map.wall[at] >= least;
        let mut cells: Vec<bool> = (0..grid.cells.len()).map(is_way).collect();
        let start = nearest(&cells, grid, robot, params.map.beside_robot)?;
        let lengths = way_lengths(&mut cells, grid, start);
        let ways: Vec<usize> = (0..cells.len()).filter(|&at| cells[at]).collect();
        let ends = ends(&ways, &lengths, map, params);
        thin(&mut cells, &ways, &ends, map);
        Some(Self { cells, ends })
    }

    /// The width of the way in which a robot is, between its walls, in metres.
    pub(super) fn width_at(
        &self,
        robot: Point2<f64>,
        map: &Clearances,
        params: &LocalMapParams,
    ) -> Option<f64> {
        let at = nearest(&self.cells, &map.grid, robot, params.reach)?;
        Some(2.0 * f64::from(map.wall[at]).sqrt() * map.grid.cell)
    }
}

/// The cell of a set that is nearest to a point, within a distance in metres along both axes.
fn nearest(set: &[bool], grid: &Grid, point: Point2<f64>, within: f64) -> Option<usize> {
    let [x, y] = grid.column_row(point);
    let off = |at: usize| {
        let [column, row] = [at % grid.columns, at / grid.columns].map(|at| at as i64);
        ((row - y).pow(2) + (column - x).pow(2), at)
    };
    let cells = grid.cells_around(point, within).filter(|&at| set[at]);
    cells.map(off).min().map(|(_, at)| at)
}

/// Removes cells whose removal does not change the topology, those nearest to a wall or to the unknown first.
fn thin(cells: &mut [bool], ways: &[usize], ends: &[End], map: &Clearances) {
    let is_end = |at: usize| ends.iter().any(|end| end.cell == at);
    let mut left = in_order_of(|at| map.border[at], ways);
    loop {
        let before = left.len();
        left.retain(|&at| {
            let keep = !is_simple(cells, at, &map.grid) || is_end(at);
            cells[at] = keep;
            keep
        });
        if left.len() == before {
            return;
        }
    }
}

/// Whether the removal of a cell changes no topology: Yokoi's connectivity number of its eight neighbours is one.
fn is_simple(cells: &[bool], at: usize, grid: &Grid) -> bool {
    let near = grid.neighbours(at).into_iter().enumerate();
    let around = near.fold(0_u8, |around, (number, near)| around | u8::from(cells[near]) << number);
    // The neighbours beside it, which are those with odd numbers, that are not in the set and before one that is.
    let begin_group = !around & (around.rotate_right(1) | around.rotate_right(2)) & 0b1010_1010;
    begin_group.is_power_of_two()
}
