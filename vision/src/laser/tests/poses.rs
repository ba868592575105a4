//! Poses with known scans: where scans were taken, and how much odometry drifts.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Isometry2, Point2, Vector2};
use toposlam_model::driving::odometry::Odometry;

use super::Walls;
use crate::{
    geometry::{distance, from_robot, motion_between, moved},
    laser::{
        drift::DriftMeter,
        local_map::rays,
        matching::ScanMatcher,
        params::{LaserParams, LocalMapParams, MatchingParams},
        passes::{OwnPass, own_walls},
        ray_counts::RayCounts,
        scan::Scan,
        scan_motion::ScanMotion,
    },
};

fn pose(x: f64, y: f64, heading: f64) -> Odometry {
    Odometry { position: [x, y], heading }
}

/// A room of 8 m by 6 m with its corner at the origin.
fn room() -> Walls {
    Walls::new(&[&[[0.0, 0.0], [8.0, 0.0], [8.0, 6.0], [0.0, 6.0], [0.0, 0.0]]])
}

fn matching() -> MatchingParams {
    MatchingParams { rounds: 8, ..MatchingParams::DEFAULT }
}

/// Whether a pose is this near to another one, in metres and radians.
fn is_near(one: &Odometry, other: &Odometry, [metres, radians]: [f64; 2]) -> bool {
    one.distance(other) < metres && one.seen(other.heading).abs() < radians
}

#[test]
fn a_scan_in_a_room_is_placed_where_it_was_taken_although_odometry_is_off() {
    let room = room();
    let true_poses = [pose(3.0, 2.0, 0.3), pose(3.4, 2.1, 0.4), pose(3.8, 2.3, 0.5)];
    // Odometry slips by 3 cm and 0.01 radians on each step of 0.4 m.
    let odometry = [pose(3.0, 2.0, 0.3), pose(3.43, 2.1, 0.41), pose(3.86, 2.3, 0.52)];
    let mut matcher = ScanMatcher::new(matching());
    for (at, (there, odometry)) in true_poses.iter().zip(&odometry).enumerate() {
        let way = 0.4 * at as f64;
        let placed = matcher.add_scan(&room.scan(there, -180, 360), odometry, way, way - 18.0);
        assert!(is_near(&placed, there, [0.01, 0.003]), "{at}: {placed:?}");
        let corrected = moved(&matcher.correction(), odometry);
        assert!(is_near(&corrected, &placed, [1e-9, 1e-9]), "{corrected:?}");
    }
}

#[test]
fn the_way_along_a_corridor_is_that_of_odometry_and_the_way_across_that_of_its_walls() {
    let corridor = Walls::new(&[&[[-50.0, 1.0], [50.0, 1.0]], &[[-50.0, -1.0], [50.0, -1.0]]]);
    let mut matcher = ScanMatcher::new(matching());
    matcher.add_scan(
        &corridor.scan(&pose(0.0, 0.0, 0.0), -90, 181),
        &pose(0.0, 0.0, 0.0),
        0.0,
        -18.0,
    );
    let scan = corridor.scan(&pose(0.5, 0.0, 0.0), -90, 181);
    let placed = matcher.add_scan(&scan, &pose(0.55, 0.06, 0.02), 0.5, -17.5);
    assert!((placed.position[0] - 0.55).abs() < 0.01, "{placed:?}");
    assert!(placed.position[1].abs() < 0.01 && placed.heading.abs() < 0.003, "{placed:?}");
}

#[test]
fn without_rounds_or_walls_or_far_off_odometry_alone_decides() {
    let room = room();
    let first = room.scan(&pose(3.0, 2.0, 0.0), -180, 360);
    let nothing = Scan::each_degree(-180, 360, |_| f64::INFINITY);
    let after = |params: MatchingParams, scan: &Scan, odometry: Odometry| {
        let mut matcher = ScanMatcher::new(params);
        matcher.add_scan(&first, &pose(3.0, 2.0, 0.0), 0.0, -18.0);
        matcher.add_scan(scan, &odometry, 0.1, -18.0)
    };
    let second = room.scan(&pose(3.1, 2.0, 0.0), -180, 360);
    let off = pose(3.16, 2.0, 0.0);
    assert!(is_near(&after(matching(), &second, off), &pose(3.1, 2.0, 0.0), [0.01, 0.003]));
    assert_eq!(after(MatchingParams::DEFAULT, &second, off), off);
    assert_eq!(after(matching(), &nothing, off), off);
    let many = MatchingParams { min_matches: 361, ..matching() };
    assert_eq!(after(many, &second, off), off);
    // Three standard deviations are 0.14 m.
    let far = pose(3.3, 2.0, 0.0);
    assert_eq!(after(matching(), &second, far), far);
}

#[test]
fn the_heading_of_odometry_is_corrected_by_more_after_a_turn_or_a_way() {
    let room = room();
    // Three times 0.01 radians, 0.025 for each metre and 0.1 for each radian.
    for (driven, turned, error, is_corrected) in [
        (0.0, 0.0, 0.025, true),
        (0.0, 0.0, 0.06, false),
        (0.0, 1.0, 0.15, true),
        (0.0, -1.0, -0.15, true),
        (0.0, 1.0, 0.6, false),
        (2.0, 0.0, 0.1, true),
        (2.0, 0.0, 0.3, false),
    ] {
        let first = pose(3.0, 2.0, 0.0);
        let mut matcher = ScanMatcher::new(matching());
        matcher.add_scan(&room.scan(&first, -180, 360), &first, 0.0, -18.0);
        let there = pose(3.0 + driven, 2.0, turned);
        let odometry = pose(3.0 + driven, 2.0, turned + error);
        let placed = matcher.add_scan(&room.scan(&there, -180, 360), &odometry, 1.0, -18.0);
        let expected = if is_corrected { there } else { odometry };
        assert!(
            is_near(&placed, &expected, [0.02, 0.006]),
            "{driven}, {turned}, {error}: {placed:?}"
        );
    }
}

#[test]
fn walls_that_were_last_seen_long_ago_are_forgotten() {
    let room = room();
    let there = pose(3.0, 2.0, 0.0);
    let mut matcher = ScanMatcher::new(matching());
    let points = matcher.wall_points(&room.scan(&there, -180, 360), 5.0);
    matcher.add(&points, &there);
    assert!((matcher.part_on_walls(&points, &there) - 1.0).abs() < 1e-9);
    // The room is symmetric: turned by half a circle around its middle all walls are walls.
    assert!((matcher.part_on_walls(&points, &pose(5.0, 4.0, PI)) - 1.0).abs() < 1e-9);
    // 1 m aside the two walls along the motion are still walls: they are hit by about half of the rays.
    let part = matcher.part_on_walls(&points, &pose(4.0, 2.0, 0.0));
    assert!((0.4..0.75).contains(&part), "{part}");
    matcher.forget(5.0);
    assert!(matcher.part_on_walls(&points, &there) > 0.99);
    matcher.forget(5.1);
    assert_eq!(matcher.part_on_walls(&points, &there), 0.0);
    assert_eq!(matcher.part_on_walls(&[], &there), 0.0);
}

#[test]
fn a_wall_is_matched_from_the_side_from_which_it_was_seen() {
    // A wall of 4 m, 1 m north of the robot.
    let wall = Walls::new(&[&[[-2.0, 1.0], [2.0, 1.0]]]);
    let south = pose(0.0, 0.0, 0.0);
    let matcher = |from: &Odometry| {
        let mut matcher = ScanMatcher::new(matching());
        let points = matcher.wall_points(&wall.scan(from, -180, 360), 0.0);
        matcher.add(&points, from);
        (matcher, points)
    };
    let (known, points) = matcher(&south);
    // 127 rays reach it; at its ends there is no straight line to both sides.
    assert!((100..=127).contains(&points.len()), "{}", points.len());
    assert!((known.part_on_walls(&points, &south) - 1.0).abs() < 1e-9);
    let north = pose(0.0, 2.0, 0.0);
    let (_, seen_from_north) = matcher(&north);
    assert_eq!(known.part_on_walls(&seen_from_north, &north), 0.0, "its other side");
    // 0.25 m is near enough, 0.3 m is not.
    assert!(known.part_on_walls(&points, &pose(0.0, 0.2, 0.0)) > 0.99);
    assert_eq!(known.part_on_walls(&points, &pose(0.0, 0.3, 0.0)), 0.0);
}

#[test]
fn a_wall_is_found_in_the_square_metres_around_a_point() {
    // Walls 5 cm behind the borders between square metres, 1.6 m long.
    let there = pose(0.0, 0.0, 0.0);
    for (x, y) in
        [(0.5, 2.05), (0.5, -2.05), (2.05, 2.05), (-2.05, 2.05), (2.05, 0.5), (-2.05, 0.5)]
    {
        for is_upright in [false, true] {
            let [east, north] = if is_upright { [0.0, 0.8] } else { [0.8, 0.0] };
            let wall = Walls::new(&[&[[x - east, y - north], [x + east, y + north]]]);
            let mut matcher = ScanMatcher::new(matching());
            let points = matcher.wall_points(&wall.scan(&there, -180, 360), 0.0);
            if points.len() < 10 {
                continue;
            }
            matcher.add(&points, &there);
            // Across the border in both directions.
            for aside in [0.1, -0.1] {
                let shifted =
                    if is_upright { pose(aside, 0.0, 0.0) } else { pose(0.0, aside, 0.0) };
                let part = matcher.part_on_walls(&points, &shifted);
                assert!(part > 0.99, "{x}, {y}, {is_upright}: {shifted:?}: {part}");
            }
        }
    }
}

#[test]
fn only_straight_lines_that_are_near_are_walls() {
    let count = |range: &dyn Fn(f64) -> f64| {
        let scan = Scan::each_degree(-180, 360, range);
        ScanMatcher::new(matching()).wall_points(&scan, 0.0).len()
    };
    // A circle of 5 m: a line of 0.4 m is 6 readings long, and 6 mm off.
    assert_eq!(count(&|_| 5.0), 360 - 6);
    // Every other reading is farther: points are half of that from their line. They may be 0.04 m.
    let uneven = |step: f64| {
        count(&|bearing| 5.0 + step * (bearing.to_degrees().round() as i64).rem_euclid(2) as f64)
    };
    assert_eq!([uneven(0.06), uneven(0.1)], [360 - 6, 0]);
    let range = MatchingParams::DEFAULT.range;
    assert_eq!(count(&|_| range + 0.1), 0, "far away");
}

/// The drift that a robot measures whose odometry turns by so much in 10 m of a corridor with niches.
fn measured_drift(per_10_m: f64, length: f64) -> Option<f64> {
    let mut north = vec![[-5.0, 1.0]];
    for niche in 0..12 {
        let west = 5.0 * f64::from(niche);
        north.extend([[west, 1.0], [west, 1.5], [west + 1.0, 1.5], [west + 1.0, 1.0]]);
    }
    north.push([70.0, 1.0]);
    let corridor =
        Walls::new(&[&north, &[[-5.0, -1.0], [70.0, -1.0]], &[[-5.0, -1.0], [-5.0, 1.0]]]);
    let mut meter = DriftMeter::new(LaserParams::default());
    let mut odometry = Odometry::default();
    for step in 0..=(length / 0.5).round() as u32 {
        let there = pose(0.5 * f64::from(step), 0.0, 0.0);
        meter.add_scan(&corridor.scan(&there, -90, 181), &odometry);
        odometry = odometry.moved(per_10_m * 0.05, 0.5);
    }
    meter.finish()
}

#[test]
fn drift_is_how_much_odometry_turns_in_10_m_against_the_walls() {
    for drift in [0.0, 0.03, -0.05] {
        let measured = measured_drift(drift, 35.0).unwrap();
        assert!((measured - f64::abs(drift)).abs() < 0.004, "{drift}: {measured}");
    }
}

#[test]
fn on_less_than_three_stretches_of_10_m_no_drift_is_known() {
    assert!(measured_drift(0.03, 30.5).is_some());
    assert_eq!(measured_drift(0.03, 29.5), None);
}

/// The map of a pass through a room, with cells of 0.15 m, and its walls.
fn own(walls: &Walls, there: &Odometry) -> (RayCounts, ScanMatcher) {
    let scan = walls.scan(there, -180, 360);
    let mut counts = RayCounts::around(Point2::origin(), 215, 0.15, Vector2::zeros());
    counts.add(&rays(&scan, &LocalMapParams::default()), &from_robot(there));
    let points = ScanMatcher::new(matching()).wall_points(&scan, 0.0);
    (counts, own_walls([(&points[..], *there)], &MatchingParams::DEFAULT))
}

#[test]
fn another_pass_through_a_room_lies_on_its_walls_after_a_small_motion() {
    let room = room();
    let (counts, walls) = own(&room, &pose(3.0, 2.0, 0.0));
    let pass = OwnPass::new(&counts, &LocalMapParams::default());
    // Odometry places the other pass 0.15 m and 0.02 radians off.
    let (there, off) = (pose(4.0, 3.0, 1.0), pose(4.1, 2.9, 1.02));
    let points = ScanMatcher::new(matching()).wall_points(&room.scan(&there, -180, 360), 0.0);
    let placed = points.iter().map(|point| point.moved(&from_robot(&off)));
    let motion = pass.correction(&walls, placed);
    let corrected = moved(&motion, &off);
    assert!(is_near(&corrected, &there, [0.02, 0.004]), "{corrected:?}");
    let none = pass.correction(&walls, std::iter::empty());
    assert_eq!(none, Isometry2::identity());
}

/// The cells of points on a map.
fn cells(counts: &RayCounts, points: &[Point2<f64>]) -> Vec<[i64; 2]> {
    points.iter().map(|&point| counts.cell_at(point)).collect()
}

/// The hits of a scan, placed at a pose.
fn hits(scan: &Scan, at: &Odometry) -> Vec<Point2<f64>> {
    scan.hits().map(|hit| from_robot(at) * hit).collect()
}

#[test]
fn a_pass_agrees_with_a_map_by_the_part_of_its_hits_that_lie_on_walls() {
    let room = room();
    let (counts, _) = own(&room, &pose(3.0, 2.0, 0.0));
    let pass = OwnPass::new(&counts, &LocalMapParams::default());
    let there = pose(5.0, 4.0, FRAC_PI_2);
    let scan = room.scan(&there, -180, 360);
    let part = |at: &Odometry| pass.part_on_walls(&cells(&counts, &hits(&scan, at)));
    assert!(part(&there).unwrap() > 0.99);
    // With the motion the hits on two walls go along them, and those on the others are 1 m off.
    let shifted =
        part(&moved(&motion_between(&pose(0.0, 0.0, 0.0), &pose(-1.0, 0.0, 0.0)), &there));
    assert!((0.3..0.8).contains(&shifted.unwrap()), "{shifted:?}");
    assert_eq!(pass.part_on_walls(&cells(&counts, &hits(&scan, &there)[..199])), None, "too few");
    assert!(pass.part_on_walls(&cells(&counts, &hits(&scan, &there)[..240])).is_some());
}

#[test]
fn the_widest_wall_that_another_pass_sees_in_free_space_is_measured() {
    let room = room();
    let (counts, _) = own(&room, &pose(3.0, 2.0, 0.0));
    let pass = OwnPass::new(&counts, &LocalMapParams::default());
    let widest = |there: &Odometry, others: &[[f64; 2]], least: f64| {
        let scan = room.scan(there, -180, 360);
        let others = others.iter().map(|&point| Point2::from(point));
        let all: Vec<_> = hits(&scan, there).into_iter().chain(others).collect();
        pass.widest_astray(&cells(&counts, &all), least)
    };
    let there = pose(5.0, 4.0, 0.0);
    assert_eq!(widest(&there, &[], 0.9), Some(0.0));
    // A board of 0.9 m in the middle of the room.
    let board: Vec<[f64; 2]> = (0..=6).map(|cell| [2.0 + 0.15 * f64::from(cell), 3.0]).collect();
    let width = widest(&there, &board, 0.9).unwrap();
    // Seven cells by one: their diagonal.
    assert!((width - 0.15 * 7_f64.hypot(1.0)).abs() < 1e-9, "{width}");
    // Two boards, 1 m apart: the wider one.
    let two: Vec<[f64; 2]> = board.iter().copied().chain([[4.0, 3.0], [4.0, 3.15]]).collect();
    assert!((widest(&there, &two, 0.9).unwrap() - width).abs() < 1e-9);
    assert_eq!(widest(&there, &board, 0.999), None, "less lies on walls");
}

#[test]
fn a_pass_that_lies_elsewhere_along_a_corridor_is_of_another_place() {
    // A corridor with a niche of 1 m by 1 m.
    let walls = Walls::new(&[
        &[[-9.0, 1.0], [0.0, 1.0], [0.0, 2.0], [1.0, 2.0], [1.0, 1.0], [9.0, 1.0], [9.0, -1.0]],
        &[[-9.0, 1.0], [-9.0, -1.0], [9.0, -1.0]],
    ]);
    let (counts, _) = own(&walls, &pose(0.5, 0.0, 0.0));
    let pass = OwnPass::new(&counts, &LocalMapParams::default());
    let there = pose(1.0, 0.2, 0.0);
    let scan = walls.scan(&there, -180, 360);
    let widest = |at: Odometry| pass.widest_astray(&cells(&counts, &hits(&scan, &at)), 0.5);
    assert!(widest(there).is_some_and(|widest| widest < 0.5));
    // 1.5 m farther along the corridor.
    for shift in [-1.5, 1.5] {
        assert_eq!(widest(pose(1.0 + shift, 0.2, 0.0)), None, "{shift}");
    }
}

#[test]
fn the_hits_of_a_scan_that_is_moved_are_moved() {
    let scan = room().scan(&pose(3.0, 2.0, 0.0), -180, 360);
    let one = hits(&scan, &pose(3.0, 2.0, 0.0));
    // The east wall is 5 m ahead.
    assert!(distance(one[180], [8.0, 2.0]) < 1e-5, "{}", one[180]);
}

/// A room with corners that bend inwards, so that no two of its places look alike.
fn odd_room() -> Walls {
    Walls::new(&[&[
        [0.0, 0.0],
        [9.0, 0.0],
        [9.0, 3.0],
        [6.0, 3.0],
        [6.0, 7.0],
        [2.0, 7.0],
        [2.0, 5.0],
        [0.0, 5.0],
        [0.0, 0.0],
    ]])
}

#[test]
fn without_odometry_a_motion_between_two_scans_is_found_by_the_walls() {
    let first = pose(3.0, 2.0, 0.3);
    for (ahead, aside, turn) in [
        (0.0, 0.0, 0.0),
        (0.5, 0.0, 0.0),
        (1.0, 0.0, 0.3),
        (1.7, 0.0, 0.0),
        (0.0, 0.0, 1.5),
        (0.0, 0.0, -1.5),
        (1.0, 0.5, 1.2),
        (1.0, -0.5, -1.2),
        (-0.7, 0.0, 0.1),
    ] {
        for count in [181, 360] {
            let from = -i32::from(count) / 2;
            let step = Isometry2::new(Vector2::new(ahead, aside), turn);
            let at = from_robot(&first) * step;
            let second = pose(at.translation.x, at.translation.y, at.rotation.angle());
            let mut motion = ScanMotion::new(&MatchingParams::DEFAULT);
            assert_eq!(
                motion.add_scan(&odd_room().scan(&first, from, count)),
                Some(Odometry::default())
            );
            let found = motion.add_scan(&odd_room().scan(&second, from, count)).unwrap();
            let expected = pose(ahead, aside, turn);
            assert!(is_near(&found, &expected, [0.03, 0.01]), "{expected:?}: {found:?}");
        }
    }
}

#[test]
fn along_a_corridor_without_doors_a_robot_without_odometry_drives_on_as_fast() {
    // It begins 2 m from an end, and drives 0.5 m between two scans. What is farther than 15 m is not matched.
    let corridor = Walls::new(&[&[[60.0, 1.0], [0.0, 1.0], [0.0, -1.0], [60.0, -1.0]]]);
    let mut motion = ScanMotion::new(&MatchingParams::DEFAULT);
    for step in 0..36 {
        let x = 0.5 * f64::from(step);
        let found = motion.add_scan(&corridor.scan(&pose(2.0 + x, 0.0, 0.0), -180, 360)).unwrap();
        let [ahead, aside] = found.position;
        // The search has steps of 0.2 m.
        assert!((ahead - x).abs() < 0.1 + 0.2 * x && aside.abs() < 0.05, "{x}: {found:?}");
        assert!(found.heading.abs() < 0.01, "{x}: {found:?}");
    }
}
