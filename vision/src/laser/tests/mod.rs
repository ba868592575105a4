//! Facts of geometry: rooms with known distances, poses with known scans, corridors of known width. The numbers are
//! worked out by hand.

use nalgebra::Point2;
use toposlam_model::driving::odometry::Odometry;

use super::{
    grid::{Cell, Grid},
    scan::Scan,
};
use crate::geometry::unit;

mod grid;
mod navigation;
mod pictures;
mod poses;
mod ray_counts;
mod rays;
mod views;
mod ways;

/// Walls: each from one point to another, in metres.
struct Walls(Vec<[Point2<f64>; 2]>);

impl Walls {
    /// Walls along lines through these points.
    fn new(lines: &[&[[f64; 2]]]) -> Self {
        let pieces = lines.iter().flat_map(|line| line.windows(2));
        Self(pieces.map(|ends| [ends[0].into(), ends[1].into()]).collect())
    }

    /// The distance to the nearest wall in a direction; infinite if there is none.
    fn range(&self, from: Point2<f64>, direction: f64) -> f64 {
        let ray = unit(direction);
        let range = |&[one, other]: &[Point2<f64>; 2]| {
            let (along, off) = (other - one, one - from);
            let range = off.perp(&along) / ray.perp(&along);
            let part = off.perp(&ray) / ray.perp(&along);
            (range > 0.0 && (0.0..=1.0).contains(&part)).then_some(range)
        };
        self.0.iter().filter_map(range).fold(f64::INFINITY, f64::min)
    }

    /// What a scanner in the middle of a robot reads, with so many readings from this bearing on, one each degree.
    fn scan(&self, robot: &Odometry, first: i32, count: u16) -> Scan {
        let from = Point2::from(robot.position);
        Scan::each_degree(first, count, |bearing| self.range(from, robot.heading + bearing))
    }
}

/// A map with a character for each cell: `.` is free, `#` occupied, and any other one unknown. The first row is the
/// northernmost one. Cells are 0.5 m wide, and the south-west corner of the map lies at (1, 2).
fn drawn(rows: &[&str]) -> Grid {
    let cell = |character| match character {
        '.' => Cell::Free,
        '#' => Cell::Occupied,
        _ => Cell::Unknown,
    };
    let cells = rows.iter().rev().flat_map(|row| row.chars().map(cell)).collect();
    Grid { columns: rows[0].len(), cell: 0.5, origin: Point2::new(1.0, 2.0), cells }
}

/// The rows of [`drawn`] for a map.
fn rows(grid: &Grid) -> Vec<String> {
    let character = |&cell: &Cell| match cell {
        Cell::Free => '.',
        Cell::Occupied => '#',
        Cell::Unknown => ' ',
    };
    grid.cells.chunks(grid.columns).rev().map(|row| row.iter().map(character).collect()).collect()
}

fn near(one: f64, other: f64) -> bool {
    (one - other).abs() < 1e-9
}
