//! Where a scan was taken, and in which directions: what a scanner that does not look all around cannot see, and
//! where no ray came back.

use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use super::{
    clearances::Clearances,
    grid::{Cell, Grid},
    plane::{Motion, direction, distance},
    scan::{Reading, Scan},
};

/// Where a scan was taken, and the sector that it covers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Viewpoint {
    /// The place of the scanner, in metres in the frame of the local map.
    point: [f64; 2],
    /// The direction of the sector's middle, and half of its angle, in radians.
    middle: f64,
    half: f64,
    /// Whether a ray of the scan and a neighbour of it did not come back, counter-clockwise. One ray alone is a
    /// failure of the scanner.
    silent: Vec<bool>,
    /// The angle from one ray to the next, in radians.
    step: f64,
    /// A ray that did not come back shows a surface up to this far from the scanner, in metres.
    silent_range: f64,
}

/// Farther away the rays of a scan are wider apart than cells, in metres.
const SILENT_RANGE: f64 = 10.0;

impl Viewpoint {
    /// The viewpoint of a scan that a robot took.
    pub(super) fn new(scan: &Scan, robot: &Odometry) -> Self {
        let half = scan.field_of_view() / 2.0;
        let mount = scan.mount();
        let lost: Vec<bool> =
            scan.readings().map(|(_, reading)| !matches!(reading, Reading::Hit(_))).collect();
        let is_lost = |index: usize| lost.get(index).copied().unwrap_or(false);
        let is_silent =
            |index: usize| lost[index] && (is_lost(index + 1) || index > 0 && lost[index - 1]);
        Self {
            point: Motion::from_robot(robot).point(mount.position),
            middle: robot.heading + mount.heading + scan.geometry().angle_min + half,
            half,
            silent: (0..lost.len()).map(is_silent).collect(),
            step: scan.geometry().angle_increment,
            silent_range: scan.geometry().range_max.min(SILENT_RANGE),
        }
    }

    /// Whether the scan looked at a point that is near enough, no wall hides it from here, and no ray came back from
    /// there. What is unknown hides nothing: it is unknown because of a surface that no ray showed.
    pub(super) fn is_silent_at(
        &self,
        point: [f64; 2],
        grid: &Grid,
        clearances: &Clearances,
    ) -> bool {
        let off = distance(self.point, point);
        let towards = direction(self.point, point);
        let ray = ((wrapped(towards - self.middle) + self.half) / self.step).round();
        let is_silent = ray >= 0.0 && self.silent.get(ray as usize) == Some(&true);
        is_silent
            && off <= self.silent_range
            && !is_wall_within(off - grid.cell, self.point, towards, grid, clearances)
    }

    /// How far a point lies beyond the edge of the sector, in radians, if nothing hides it from here.
    pub(super) fn turn_to(
        &self,
        point: [f64; 2],
        grid: &Grid,
        clearances: &Clearances,
    ) -> Option<f64> {
        let towards = direction(self.point, point);
        let turn = wrapped(towards - self.middle).abs() - self.half;
        let range = distance(self.point, point);
        let is_free = || clearances.sight(grid, self.point, towards, range).0 >= range - grid.cell;
        (turn > 0.0 && is_free()).then_some(turn)
    }
}

/// Whether there is a wall on the map within so many metres of a point in a direction.
fn is_wall_within(
    length: f64,
    from: [f64; 2],
    direction: f64,
    grid: &Grid,
    clearances: &Clearances,
) -> bool {
    let (sine, cosine) = direction.sin_cos();
    let mut at = 0.0;
    while at < length {
        let point = [from[0] + at * cosine, from[1] + at * sine];
        let (free, cell) = clearances.sight(grid, point, direction, length - at);
        at += free;
        if cell == Cell::Occupied {
            return at < length;
        }
        at += grid.cell / 2.0;
    }
    false
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    use super::*;
    use crate::laser::scan::{ScanGeometry, ScannerPose};

    /// How far a point lies beyond the edge of a sector on a map.
    fn turn_to(viewpoint: &Viewpoint, point: [f64; 2], grid: &Grid) -> Option<f64> {
        viewpoint.turn_to(point, grid, &Clearances::new(grid))
    }

    /// The viewpoint of a robot that looks east from the middle of a free square of 10 m.
    fn viewpoint(readings: usize) -> (Viewpoint, Grid) {
        let geometry = ScanGeometry {
            angle_min: -FRAC_PI_2,
            angle_increment: PI / 180.0,
            range_min: 0.0,
            range_max: 80.0,
        };
        let scan = Scan::new(geometry, vec![1.0; readings], ScannerPose::default()).unwrap();
        let robot = Odometry { position: [5.05, 5.05], heading: 0.0 };
        let cells = vec![Cell::Free; 100 * 100];
        let grid = Grid { columns: 100, cell: 0.1, origin: [0.0; 2], cells };
        (Viewpoint::new(&scan, &robot), grid)
    }

    #[test]
    fn what_is_behind_the_edge_of_the_sector_is_beyond_it_unless_it_is_hidden() {
        let (viewpoint, mut grid) = viewpoint(181);
        assert_eq!(turn_to(&viewpoint, [6.05, 6.05], &grid), None, "ahead");
        let turn = turn_to(&viewpoint, [4.05, 6.05], &grid).unwrap();
        assert!((turn - FRAC_PI_4).abs() < 1e-9, "{turn}");
        let wall = grid.index([4.55, 5.55]).unwrap();
        grid.cells[wall] = Cell::Occupied;
        assert_eq!(turn_to(&viewpoint, [4.05, 6.05], &grid), None, "behind a wall");
    }

    #[test]
    fn nothing_is_beyond_a_sector_that_goes_all_around() {
        let (viewpoint, grid) = viewpoint(361);
        for point in [[4.0, 6.0], [4.0, 5.0], [4.0, 4.0]] {
            assert_eq!(turn_to(&viewpoint, point, &grid), None);
        }
    }

    #[test]
    fn where_rays_do_not_come_back_the_scan_is_silent_and_one_lost_ray_is_not_enough() {
        let (_, mut grid) = viewpoint(181);
        let robot = Odometry { position: [5.05, 5.05], heading: 0.0 };
        let is_silent = |lost: std::ops::Range<usize>, grid: &Grid, range_max: f64| {
            let geometry = ScanGeometry {
                angle_min: -FRAC_PI_2,
                angle_increment: PI / 180.0,
                range_min: 0.0,
                range_max,
            };
            let mut ranges = vec![1.0; 181];
            ranges[lost].fill(f32::INFINITY);
            let scan = Scan::new(geometry, ranges, ScannerPose::default()).unwrap();
            let ahead = [8.05, 5.05];
            Viewpoint::new(&scan, &robot).is_silent_at(ahead, grid, &Clearances::new(grid))
        };
        assert!(is_silent(85..96, &grid, 80.0));
        assert!(!is_silent(90..91, &grid, 80.0), "a failure of the scanner");
        assert!(!is_silent(40..60, &grid, 80.0), "another direction");
        assert!(!is_silent(85..96, &grid, 2.0), "beyond the range of the scanner");
        let between = grid.index([6.55, 5.05]).unwrap();
        grid.cells[between] = Cell::Unknown;
        assert!(is_silent(85..96, &grid, 80.0), "what is unknown hides nothing");
        grid.cells[between] = Cell::Occupied;
        assert!(!is_silent(85..96, &grid, 80.0), "behind a wall");
    }
}
