//! Where a scan was taken, and in which directions: where a scanner that does not look all around did not look, and
//! what it looked at without seeing it.

use nalgebra::Point2;
use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use super::{
    clearances::Clearances,
    grid::Cell,
    scan::{Reading, Scan},
};
use crate::geometry::{direction, distance, from_robot, unit};

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Viewpoint {
    /// The place of the scanner, in metres in the frame of the local map.
    point: Point2<f64>,
    /// The direction of the sector's middle, and half of its angle, in radians.
    middle: f64,
    half: f64,
    /// Whether a reading of the scan and a neighbour of it are invalid, counter-clockwise: a part of the robot may hide
    /// what is there. One reading alone is a failure of the scanner.
    blind: Vec<bool>,
    /// The angle from one ray to the next, in radians.
    step: f64,
    range: f64,
}

/// Whether a scanner looked at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    /// It did: one of its rays went there.
    At,
    /// It did not: the point lies beyond the edge of the sector, or where readings are invalid.
    Aside,
    /// It could not: the point lies behind a wall, or is too far away.
    Hidden,
}

/// No scan looks at what is farther away, in metres: at long range a ray is as wide as a cell.
const FARTHEST: f64 = 10.0;

impl Viewpoint {
    pub(super) fn new(scan: &Scan, robot: &Odometry) -> Self {
        let half = scan.field_of_view() / 2.0;
        let invalid: Vec<bool> =
            scan.readings().map(|(_, reading)| reading == Reading::Invalid).collect();
        let is_invalid = |index: usize| invalid.get(index).copied().unwrap_or(false);
        let is_blind = |index: usize| {
            is_invalid(index) && (is_invalid(index + 1) || index > 0 && is_invalid(index - 1))
        };
        Self {
            point: from_robot(robot) * scan.scanner(),
            middle: robot.heading + scan.heading() + scan.geometry().angle_min + half,
            half,
            blind: (0..invalid.len()).map(is_blind).collect(),
            step: scan.geometry().angle_increment,
            range: scan.geometry().range_max,
        }
    }

    pub(super) fn point(&self) -> Point2<f64> {
        self.point
    }

    /// Whether the scan looked at a point. What is unknown hides nothing: a surface that reflects no ray back may be
    /// why it is unknown.
    pub(super) fn look(&self, point: Point2<f64>, map: &Clearances) -> Look {
        let off = distance(self.point, point);
        // Farther away, rays are wider apart than cells.
        let range = FARTHEST.min(self.range).min(map.grid.cell / self.step);
        let towards = direction(self.point, point);
        if off > range || is_wall_within(off - map.grid.cell, self.point, towards, map) {
            return Look::Hidden;
        }
        let ray = ((wrapped(towards - self.middle) + self.half) / self.step).round();
        let is_at = ray >= 0.0 && self.blind.get(ray as usize) == Some(&false);
        if is_at { Look::At } else { Look::Aside }
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

/// Whether there is a wall on the map within so many metres of a point in a direction.
fn is_wall_within(length: f64, from: Point2<f64>, direction: f64, map: &Clearances) -> bool {
    let ray = unit(direction);
    let mut at = 0.0;
    while at < length {
        let (free, cell) = map.sight(from + at * ray, direction, length - at);
        at += free;
        if cell == Cell::Occupied {
            return at < length;
        }
        at += map.grid.cell / 2.0;
    }
    false
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_4;

    use super::*;
    use crate::laser::grid::Grid;

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

    #[test]
    fn a_scan_looks_at_what_is_in_its_sector_and_neither_behind_a_wall_nor_too_far_away() {
        let (viewpoint, mut grid) = viewpoint(181, |_| 1.0);
        let look = |viewpoint: &Viewpoint, point: [f64; 2], grid: &Grid| {
            viewpoint.look(point.into(), &Clearances::new(grid.clone()))
        };
        let ahead = [8.05, 5.05];
        assert_eq!(look(&viewpoint, ahead, &grid), Look::At);
        assert_eq!(look(&viewpoint, [2.05, 5.05], &grid), Look::Aside);
        let between = grid.index([6.55, 5.05].into()).unwrap();
        grid.cells[between] = Cell::Unknown;
        assert_eq!(look(&viewpoint, ahead, &grid), Look::At, "what is unknown hides nothing");
        grid.cells[between] = Cell::Occupied;
        assert_eq!(look(&viewpoint, ahead, &grid), Look::Hidden, "behind a wall");
        let near = Viewpoint { range: 2.0, ..viewpoint.clone() };
        let sparse = Viewpoint { step: 0.1, ..viewpoint };
        for viewpoint in [near, sparse] {
            assert_eq!(look(&viewpoint, [8.05, 6.05], &grid), Look::Hidden);
        }
    }

    #[test]
    fn a_scan_does_not_look_where_readings_are_invalid_and_one_alone_is_a_failure() {
        for (invalid, expected) in [(0..0, Look::At), (80..100, Look::Aside), (90..91, Look::At)] {
            let is_invalid =
                |bearing: f64| invalid.contains(&((bearing.to_degrees() + 90.0).round() as i32));
            let range = |bearing| if is_invalid(bearing) { 0.0 } else { f64::INFINITY };
            let (viewpoint, grid) = viewpoint(181, range);
            let look = viewpoint.look([8.05, 5.05].into(), &Clearances::new(grid));
            assert_eq!(look, expected);
        }
    }
}
