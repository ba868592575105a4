//! The rays of scans in rooms of known size.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Isometry2, Point2};
use toposlam_model::driving::odometry::Odometry;

use super::{Walls, near};
use crate::{
    geometry::{distance, from_robot},
    laser::{
        local_map::{is_near_origin, rays},
        params::LocalMapParams,
        ray_counts::Rays,
        scan::{Scan, ScanGeometry},
    },
};

/// A room of 6 m by 4 m with its corner at the origin.
fn room() -> Walls {
    Walls::new(&[&[[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0], [0.0, 0.0]]])
}

#[test]
fn a_scan_in_a_room_of_6_m_by_4_m_reads_the_distances_of_its_walls() {
    let robot = Odometry { position: [2.0, 1.0], heading: FRAC_PI_2 };
    let scan = room().scan(&robot, -180, 360);
    let hits: Vec<Point2<f64>> = scan.hits().collect();
    assert_eq!(hits.len(), 360);
    // The robot looks north: the north wall is 3 m ahead, the west wall 2 m to the left.
    for (index, [ahead, left]) in
        [(180, [3.0, 0.0]), (270, [0.0, 2.0]), (0, [-1.0, 0.0]), (90, [0.0, -4.0])]
    {
        assert!(distance(hits[index], [ahead, left]) < 1e-6, "{index}: {}", hits[index]);
    }
    assert!(near(scan.field_of_view(), 359_f64.to_radians()));
    let sector = scan.sector();
    assert!(near(sector.first, -PI) && near(sector.angle, 359_f64.to_radians()));
}

#[test]
fn the_rays_of_a_scan_end_on_the_walls_of_the_room() {
    let robot = Odometry { position: [2.0, 1.0], heading: 2.0 };
    let rays = rays(&room().scan(&robot, -180, 360), &LocalMapParams::default());
    assert_eq!(rays.hits.len(), 360);
    for hit in &rays.hits {
        let hit = from_robot(&robot) * hit;
        let off =
            [hit.x, 6.0 - hit.x, hit.y, 4.0 - hit.y].into_iter().fold(f64::INFINITY, f64::min);
        assert!(off.abs() < 1e-5, "{hit}");
    }
    // Where the map ends, 16 m away, a degree is 1.9 cells of 0.15 m wide, but a cell 8.6 m away, and the far corner is 5 m away.
    assert_eq!((rays.free.len(), between(&rays)), (360, Vec::new()));
    for ([from, end], hit) in rays.free.iter().zip(&rays.hits) {
        assert!(from.coords.norm() < 1e-9 && distance(*end, *hit) < 1e-9);
    }
    // Neighbouring ends are farther apart than a cell only on walls that rays meet at a small angle.
    assert!(rays.walls.iter().all(|[one, other]| distance(*one, *other) >= 0.15));
}

#[test]
fn the_ends_of_neighbouring_rays_on_one_wall_are_a_piece_of_it_if_they_are_a_cell_apart() {
    // Two walls, 1 m to the left and to the right. At a bearing b a degree is 0.0175 / sin(b)^2 m along them, which is a
    // cell of 0.15 m at 20 degrees, and 3 m at 4.4 degrees.
    let corridor = Walls::new(&[&[[-40.0, 1.0], [40.0, 1.0]], &[[-40.0, -1.0], [40.0, -1.0]]]);
    let robot = Odometry::default();
    let rays = rays(&corridor.scan(&robot, -180, 360), &LocalMapParams::default());
    let lengths: Vec<f64> = rays.walls.iter().map(|[one, other]| distance(*one, *other)).collect();
    assert!(lengths.iter().all(|length| (0.15..=3.0).contains(length)), "{lengths:?}");
    // From 4 to 20 degrees, in four directions.
    assert_eq!(rays.walls.len(), 4 * 16);
    assert!(rays.walls.iter().flatten().all(|end| (end.y.abs() - 1.0).abs() < 1e-5));
}

#[test]
fn a_wall_goes_on_to_the_next_reading_if_that_is_on_its_line_and_not_if_it_is_of_a_wall_behind() {
    // A wall 1 m to the left, with a reading each degree. Those up to 6 degrees are of something else.
    let goes_on = |others: &dyn Fn(f64) -> f64| {
        let sixth = 6.5_f64.to_radians();
        let range =
            |bearing: f64| if bearing < sixth { others(bearing) } else { 1.0 / bearing.sin() };
        let rays = rays(&Scan::each_degree(4, 6, range), &LocalMapParams::default());
        let is_between = |[one, other]: &[Point2<f64>; 2]| {
            one.y.atan2(one.x) < sixth && other.y.atan2(other.x) > sixth
        };
        rays.walls.iter().any(is_between)
    };
    let onwards = 1.0 / 6_f64.to_radians().sin();
    let gap = onwards - 1.0 / 7_f64.to_radians().sin();
    assert!(goes_on(&|_| onwards + 0.02 * gap), "it ends at the wall of a corridor across");
    for behind in [0.15, 0.3, 1.0] {
        assert!(!goes_on(&|_| onwards + behind * gap), "that wall is farther away: {behind}");
    }
    assert!(goes_on(&|bearing| 1.05 / bearing.sin()), "a door of a room, 5 cm behind the wall");
}

/// Where rays that were not measured begin and end, between others, as the distances from the scanner.
fn between(rays: &Rays) -> Vec<[f64; 2]> {
    let ends = rays.free.iter().map(|ends| ends.map(|end| end.coords.norm()));
    ends.filter(|[from, _]| *from > 1e-9).collect()
}

/// A scan with a reading each degree from 0 on.
fn readings(ranges: &[f32]) -> Scan {
    let geometry = ScanGeometry {
        angle_min: 0.0,
        angle_increment: 1_f64.to_radians(),
        range_min: 0.1,
        range_max: 100.0,
    };
    Scan::new(geometry, ranges.to_vec(), Isometry2::identity()).unwrap()
}

#[test]
fn readings_without_a_return_show_free_space_if_they_are_few() {
    let params = LocalMapParams::default();
    let silent = |count: usize| {
        let mut ranges = vec![10.0; 3];
        ranges.extend(vec![f32::INFINITY; count]);
        ranges.extend([8.0; 3]);
        rays(&readings(&ranges), &params)
    };
    // 0.1 radians are 5.7 degrees: four readings leave a gap of 5 degrees.
    let few = silent(4);
    assert_eq!(few.hits.len(), 6);
    // At 16 m, where the map ends, a degree is 1.9 cells wide, and 5 degrees 9.3 cells. They are a cell wide 8.59 m and
    // 1.72 m away.
    let few = between(&few);
    let from_to = |[from, to]: [f64; 2]| {
        few.iter().filter(|ends| near(ends[0], from) && near(ends[1], to)).count()
    };
    let degree = 1_f64.to_radians();
    assert_eq!(few.len(), 2 + 9);
    assert_eq!(from_to([0.15 / degree, 10.0]), 2);
    assert_eq!(from_to([0.15 / (5.0 * degree), 8.0]), 9, "up to the nearer one");
    assert_eq!(between(&silent(5)).len(), 2, "a gap of 6 degrees shows nothing");
}

#[test]
fn what_is_farther_than_a_map_reaches_while_its_scan_is_remembered_is_no_hit() {
    // Twice 16 m, and 18 m of the way.
    let rays = rays(&readings(&[49.9, 50.1]), &LocalMapParams::default());
    assert_eq!(rays.hits.len(), 1);
    assert!((rays.hits[0].coords.norm() - 49.9).abs() < 1e-5);
    let far: Vec<f64> = rays.free.iter().map(|[_, end]| end.coords.norm()).collect();
    assert!(far.iter().any(|far| near(*far, 50.0)), "{far:?}");
    assert!(far.iter().all(|far| *far < 50.0 + 1e-9));
}

#[test]
fn the_scanner_of_a_robot_may_lie_beside_its_middle() {
    let geometry =
        ScanGeometry { angle_min: 0.0, angle_increment: 0.1, range_min: 0.1, range_max: 100.0 };
    // 0.3 m ahead of the middle, turned to the left.
    let scan =
        Scan::new(geometry, vec![2.0], Isometry2::new([0.3, 0.0].into(), FRAC_PI_2)).unwrap();
    let rays = rays(&scan, &LocalMapParams::default());
    let [from, end] = rays.free[0];
    assert!(distance(from, [0.3, 0.0]) < 1e-9, "{from}");
    assert!(distance(end, [0.3, 2.0]) < 1e-9 && distance(rays.hits[0], end) < 1e-9, "{end}");
}

#[test]
fn odometry_beyond_10000_km_is_wrong() {
    let at = |x, y, heading| is_near_origin(&Odometry { position: [x, y], heading });
    assert!(at(1e7, -1e7, 3.0));
    assert!(!at(1.1e7, 0.0, 0.0) && !at(0.0, -1.1e7, 0.0) && !at(0.0, 0.0, f64::NAN));
}
