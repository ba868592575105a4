//! Where a scan was taken, and in which directions: where a scanner that does not look all around did not look.

use nalgebra::Point2;
use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use super::{clearances::Clearances, scan::Scan};
use crate::geometry::{direction, distance, from_robot};

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Viewpoint {
    /// The place of the scanner, in metres in the frame of the local map.
    point: Point2<f64>,
    /// The direction of the sector's middle, and half of its angle, in radians.
    middle: f64,
    half: f64,
}

impl Viewpoint {
    pub(super) fn new(scan: &Scan, robot: &Odometry) -> Self {
        let half = scan.field_of_view() / 2.0;
        Self {
            point: from_robot(robot) * scan.scanner(),
            middle: robot.heading + scan.heading() + scan.geometry().angle_min + half,
            half,
        }
    }

    pub(super) fn point(&self) -> Point2<f64> {
        self.point
    }

    /// How far a point lies beyond the edge of the sector, in radians, if nothing hides it from here.
    pub(super) fn turn_to(&self, point: Point2<f64>, map: &Clearances) -> Option<f64> {
        let towards = direction(self.point, point);
        let turn = wrapped(towards - self.middle).abs() - self.half;
        let range = distance(self.point, point);
        let is_free = || map.sight(self.point, towards, range).0 >= range - map.grid.cell;
        (turn > 0.0 && is_free()).then_some(turn)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_4;

    use super::*;
    use crate::laser::grid::{Cell, Grid};

    /// The viewpoint of a robot that looks east, with so many readings, from the middle of a free square of 10 m.
    fn viewpoint(readings: u16, range: impl Fn(f64) -> f64) -> (Viewpoint, Grid) {
        let scan = Scan::each_degree(-90, readings, range);
        let robot = Odometry { position: [5.05, 5.05], heading: 0.0 };
        let cells = vec![Cell::Free; 100 * 100];
        let grid = Grid { columns: 100, cell: 0.1, origin: Point2::origin(), cells };
        (Viewpoint::new(&scan, &robot), grid)
    }

    #[test]
    fn what_is_behind_the_edge_of_the_sector_is_beyond_it_unless_it_is_hidden() {
        let turn_to = |viewpoint: &Viewpoint, point: [f64; 2], grid: &Grid| {
            viewpoint.turn_to(point.into(), &Clearances::new(grid.clone()))
        };
        let (half, mut grid) = viewpoint(181, |_| 1.0);
        assert_eq!(turn_to(&half, [6.05, 6.05], &grid), None, "ahead");
        let turn = turn_to(&half, [4.05, 6.05], &grid).unwrap();
        assert!((turn - FRAC_PI_4).abs() < 1e-9, "{turn}");
        let wall = grid.index([4.55, 5.55].into()).unwrap();
        grid.cells[wall] = Cell::Occupied;
        assert_eq!(turn_to(&half, [4.05, 6.05], &grid), None, "behind a wall");
        let (all_around, grid) = viewpoint(361, |_| 1.0);
        for point in [[4.0, 6.0], [4.0, 5.0], [4.0, 4.0]] {
            assert_eq!(turn_to(&all_around, point, &grid), None);
        }
    }
}
