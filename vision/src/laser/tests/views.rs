//! What a robot sees on its way through a building of known size.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Point2;
use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use super::Walls;
use crate::{
    geometry::{direction, distance, from_robot, moved},
    laser::{params::LaserParams, scan_log::ScanLog, sensor::LaserSensor},
    place::{PlaceSensor, PlaceView, SeenPlace},
};

/// A T: a corridor of 2 m from 20 m west to 20 m east, and one of 2 m for 20 m to the north. Its middle lines meet at the
/// origin.
fn tee() -> Walls {
    Walls::new(&[
        &[[-20.0, 1.0], [-1.0, 1.0], [-1.0, 20.0], [1.0, 20.0], [1.0, 1.0], [20.0, 1.0]],
        &[[-20.0, 1.0], [-20.0, -1.0], [20.0, -1.0], [20.0, 1.0]],
    ])
}

fn pose(x: f64, y: f64, heading: f64) -> Odometry {
    Odometry { position: [x, y], heading }
}

/// The views of a robot that drives east through the corridor, one each 0.5 m. Its odometry begins at another place and with
/// another heading.
fn views(from: &Odometry) -> Vec<PlaceView> {
    let (walls, mut sensor) = (tee(), LaserSensor::new(LaserParams::default()));
    let mut odometry = *from;
    (-10..=6)
        .map(|half| {
            let there = pose(0.5 * f64::from(half), 0.0, 0.0);
            let view = sensor.view(&walls.scan(&there, -180, 360), &odometry).unwrap();
            odometry = odometry.moved(0.0, 0.5);
            view
        })
        .collect()
}

/// Whether a place has three arms: to the west, the north and the east.
fn is_tee(place: &SeenPlace) -> bool {
    let is_seen = |arm: f64| place.directions().any(|seen| wrapped(seen - arm).abs() < 0.2);
    place.arms.len() == 3 && [0.0, FRAC_PI_2, PI].into_iter().all(is_seen)
}

#[test]
fn a_robot_that_drives_past_a_side_corridor_sees_a_junction_with_three_arms() {
    for (view, half) in views(&pose(0.0, 0.0, 0.0)).iter().zip(-10..) {
        // From 2 m west of the junction one sees 2 m into the side corridor.
        let x = 0.5 * f64::from(half);
        if x <= -2.0 {
            assert!(view.places.is_empty(), "{:?}", view.places);
        } else if x >= 0.0 {
            let [place] = &view.places[..] else { panic!("{x}: {:?}", view.places) };
            // The map begins where the robot did, 5 m west of the junction.
            assert!(distance(place.centre, [5.0, 0.1]) < 0.3, "{place:?}");
            assert!(is_tee(place), "{x}: {place:?}");
            assert!((place.clearance - 1.1).abs() < 0.25, "{place:?}");
        }
        // It is wider where the side corridor begins.
        let width = view.width.unwrap();
        assert!((1.7..2.3).contains(&width) || x.abs() < 2.0, "{x}: {width}");
    }
}

#[test]
fn a_view_does_not_depend_on_the_frame_of_odometry() {
    let one = views(&pose(0.0, 0.0, 0.0));
    let other = views(&pose(100.0, -50.0, 2.0));
    let east = Point2::new(5.0 * 2_f64.cos() + 100.0, 5.0 * 2_f64.sin() - 50.0);
    for (one, other) in one.iter().zip(&other) {
        assert_eq!(one.places.len(), other.places.len());
        for (one_place, other_place) in one.places.iter().zip(&other.places) {
            assert!(distance(one.odometry_from_map * one_place.centre, [5.0, 0.1]) < 0.3);
            assert!(distance(other.odometry_from_map * other_place.centre, east) < 0.4);
            assert!(distance(one_place.centre, other_place.centre) < 1e-6);
        }
        assert!(one.robot.distance(&other.robot) < 1e-6);
    }
}

#[test]
fn a_robot_that_has_hardly_moved_or_is_nowhere_sees_nothing_new() {
    let (walls, mut sensor) = (tee(), LaserSensor::new(LaserParams::default()));
    let scan = walls.scan(&pose(-5.0, 0.0, 0.0), -180, 360);
    let mut is_seen = |at: Odometry| sensor.view(&scan, &at).is_some();
    assert!(is_seen(pose(0.0, 0.0, 1.0)));
    assert!(!is_seen(pose(0.39, 0.0, 1.0)) && !is_seen(pose(0.0, 0.0, 1.29)));
    assert!(is_seen(pose(0.41, 0.0, 1.0)));
    assert!(is_seen(pose(0.41, 0.0, 1.31)), "it has turned");
    assert!(!is_seen(pose(2e7, 0.0, 0.0)));
}

#[test]
fn a_robot_is_in_the_middle_cell_of_its_map() {
    // 16 m are 107 cells of 0.15 m.
    assert_eq!(LaserParams::default().map.window(), 107 + 1 + 107);
}

#[test]
fn one_sees_on_the_map_up_to_the_walls() {
    let (walls, mut sensor) = (tee(), LaserSensor::new(LaserParams::default()));
    assert_eq!(sensor.sight(Point2::origin(), 0.0, 5.0), 0.0, "without a map");
    sensor.view(&walls.scan(&pose(0.0, 0.0, 0.0), -180, 360), &Odometry::default()).unwrap();
    for (direction, range) in [(0.0, 9.0), (PI, 9.0), (FRAC_PI_2, 9.0), (-FRAC_PI_2, 1.0)] {
        let sight = sensor.sight(Point2::origin(), direction, 9.0);
        assert!((sight - range).abs() < 0.2, "{direction}: {sight}");
    }
}

#[test]
fn what_was_seen_18_m_ago_is_forgotten() {
    // A crate beside the robot, which is taken away after it was seen. Then the robot drives to and fro.
    let corridor = tee();
    let mut with_crate = tee();
    let ends = [[-5.0, 1.0], [-5.0, 0.2], [-3.5, 0.2], [-3.5, 1.0]].map(Point2::from);
    with_crate.0.extend(ends.windows(2).map(|ends| [ends[0], ends[1]]));
    let mut sensor = LaserSensor::new(LaserParams::default());
    let first = pose(-6.0, -0.3, 0.0);
    sensor.view(&with_crate.scan(&first, -180, 360), &first).unwrap();
    // Sees north from the middle of the corridor, where the crate was.
    let north = |sensor: &LaserSensor| sensor.sight(Point2::new(1.75, 0.0), FRAC_PI_2, 3.0);
    let (mut way, mut seen) = (0.0, Vec::new());
    for step in 0..42 {
        // 1 m each, behind the crate: nothing is seen of where it was.
        let x = if step % 2 == 0 { -13.0 } else { -12.0 };
        way += if step == 0 { 7.0 } else { 1.0 };
        let there = pose(x, -0.3, PI);
        let scan = corridor.scan(&there, -90, 181);
        sensor.view(&scan, &there).unwrap();
        seen.push((way, north(&sensor)));
    }
    let is_known = |sight: f64| (0.2..1.2).contains(&sight);
    for (way, sight) in seen {
        // The crate is 0.5 m north of where the robot began.
        assert_eq!(is_known(sight), way <= 18.0, "after {way} m: {sight}");
    }
}

/// The scans of a robot that drives east through the T, one each 0.3 m.
fn log() -> ScanLog {
    let walls = tee();
    let scans = (-30..=30).map(|step| {
        let there = pose(0.3 * f64::from(step), 0.0, 0.0);
        (std::sync::Arc::new(walls.scan(&there, -180, 360)), there)
    });
    ScanLog::new(scans, LaserParams::default())
}

#[test]
fn each_view_of_a_log_shows_the_junction_where_it_is() {
    let log = log();
    assert_eq!(log.drift(), None);
    // None is nearer to another one than 0.8 m, and each other one is near to one: 18 m are 12 to 23 scans.
    assert!((12..=23).contains(&log.len()), "{}", log.len());
    assert!(!log.is_empty());
    for view in 0..log.len() {
        let number = log.scan(view);
        let seen = log.view(view, true);
        let x = 0.3 * (number as f64 - 30.0);
        assert!(distance(seen.robot.position, [x, 0.0]) < 1e-9);
        let [place] = &seen.places[..] else { panic!("{view}: {:?}", seen.places) };
        assert!(distance(place.centre, [0.0, 0.1]) < 0.3, "{place:?}");
        assert!(is_tee(place), "{place:?}");
        // Two arms were driven for 9 m, which is not enough to be sure; none was seen to end.
        let facts = seen.facts.unwrap();
        assert!(facts.driven.is_empty(), "{:?}", facts.driven);
        assert_eq!(facts.not_ended.len(), 1);
        assert!(log.view(view, false).facts.is_none());
    }
}

#[test]
fn one_sees_around_each_place_of_a_log() {
    let log = log();
    for view in 0..log.len() {
        let sight = |direction: f64| log.sight(view, Point2::origin(), direction, 5.0);
        assert!((sight(-FRAC_PI_2) - 1.0).abs() < 0.2, "{view}");
        assert!((sight(FRAC_PI_2) - 5.0).abs() < 0.2, "{view}");
    }
}

/// The log of a robot that drives these legs, each from one point to another, with a scan each 0.3 m. It sees these walls, and
/// its odometry turns by so much in 10 m.
fn driven_log(legs: &[([f64; 2], [f64; 2], &Walls)], drift: f64) -> (ScanLog, Vec<Odometry>) {
    let (mut scans, mut poses) = (Vec::new(), Vec::new());
    let mut odometry: Option<Odometry> = None;
    for (from, to, walls) in legs {
        let heading = direction(*from, *to);
        let steps = (distance(*from, *to) / 0.3).round() as u32;
        for step in 0..steps {
            let part = f64::from(step) / f64::from(steps);
            let at = [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]));
            let there = pose(at[0], at[1], heading);
            let last = poses.last().copied().unwrap_or(there);
            let before = odometry.unwrap_or(there);
            let motion = from_robot(&before) * from_robot(&last).inverse();
            let now = moved(&motion, &there).moved(drift * last.distance(&there) / 10.0, 0.0);
            odometry = Some(now);
            scans.push((std::sync::Arc::new(walls.scan(&there, -180, 360)), now));
            poses.push(there);
        }
    }
    (ScanLog::new(scans, LaserParams::default()), poses)
}

/// The views of a log that were taken this near to the origin, in metres.
fn views_near_origin(log: &ScanLog, poses: &[Odometry], within: f64) -> Vec<PlaceView> {
    let is_near = |&view: &usize| poses[log.scan(view)].distance(&Odometry::default()) < within;
    (0..log.len()).filter(is_near).map(|view| log.view(view, true)).collect()
}

#[test]
fn what_was_driven_on_other_passes_is_known_on_each_pass() {
    let walls = tee();
    // To the east end and back to the west end, and in again to the north: each pass is more than 18 m after the last.
    let legs = [
        ([-12.0, 0.0], [12.0, 0.0], &walls),
        ([12.0, 0.0], [-12.0, 0.0], &walls),
        ([-12.0, 0.0], [0.0, 0.0], &walls),
        ([0.0, 0.0], [0.0, 12.0], &walls),
    ];
    let (log, poses) = driven_log(&legs, 0.0);
    let views = views_near_origin(&log, &poses, 3.0);
    // Three times through 6 m.
    assert!(views.len() >= 9, "{}", views.len());
    for view in &views {
        let facts = view.facts.as_ref().unwrap();
        let [place] = &facts.driven[..] else { panic!("{:?}: {:?}", view.robot, facts.driven) };
        assert!(is_tee(place), "{place:?}");
    }
    // Without the last leg the way to the north was not driven.
    let (log, poses) = driven_log(&legs[..3], 0.0);
    for view in views_near_origin(&log, &poses, 3.0) {
        let facts = view.facts.unwrap();
        assert!(facts.driven.is_empty(), "{:?}", facts.driven);
        assert!(facts.not_ended.iter().any(is_tee), "{:?}", facts.not_ended);
    }
}

#[test]
fn a_pass_through_other_walls_or_far_away_is_not_of_the_same_place() {
    // Where the T is, there is a hall of 10 m by 30 m on the second pass: its odometry was wrong.
    let (walls, hall) = (
        tee(),
        Walls::new(&[&[[-5.0, -15.0], [5.0, -15.0], [5.0, 15.0], [-5.0, 15.0], [-5.0, -15.0]]]),
    );
    let legs = [
        ([-12.0, 0.0], [12.0, 0.0], &walls),
        ([12.0, 0.0], [12.0, -22.0], &hall),
        ([0.0, 0.0], [0.0, 12.0], &hall),
    ];
    let (log, poses) = driven_log(&legs, 0.0);
    let views = views_near_origin(&log, &poses, 3.0);
    // Those of the first pass.
    let first = views.iter().filter(|view| view.robot.heading.abs() < 0.1);
    let mut count = 0;
    for view in first {
        count += 1;
        let facts = view.facts.as_ref().unwrap();
        assert!(facts.driven.is_empty(), "{:?}", facts.driven);
        let [place] = &view.places[..] else { panic!("{:?}", view.places) };
        assert!(is_tee(place), "{place:?}");
    }
    assert!(count >= 3, "{count}");
}

#[test]
fn a_pass_beside_another_one_is_laid_on_its_walls() {
    let walls = tee();
    // West to east, and back: the odometry lays the way back half a metre to the north.
    let there = (-40..=40).map(|step| (pose(0.3 * f64::from(step), 0.0, 0.0), 0.0));
    let back = (-40..=40).map(|step| (pose(-0.3 * f64::from(step), 0.0, PI), 0.5));
    let scans = there.chain(back).map(|(there, north)| {
        let [x, y] = there.position;
        let odometry = pose(x, y + north, there.heading);
        (std::sync::Arc::new(walls.scan(&there, -180, 360)), odometry)
    });
    let log = ScanLog::new(scans, LaserParams::default());
    let mut count = 0;
    for view in (0..log.len()).filter(|&view| log.scan(view) <= 80) {
        let seen = log.view(view, false);
        let [x, _] = seen.robot.position;
        // The map of a view holds the scans of its own pass up to 18 m before and after it: here, the robot had not turned back.
        if (-8.0..-3.0).contains(&x) {
            count += 1;
            let wall = log.sight(view, Point2::new(x, 0.0), -FRAC_PI_2, 5.0);
            assert!((wall - 1.0).abs() < 0.2, "{x}: {wall}");
            let facts = log.view(view, true).facts.unwrap();
            assert_eq!(facts.not_ended.len(), 1, "{x}");
        }
    }
    assert!(count >= 5, "{count}");
}

#[test]
fn where_odometry_drifts_scans_are_placed_by_their_walls() {
    let walls = tee();
    let legs = [
        ([-18.0, 0.0], [18.0, 0.0], &walls),
        ([18.0, 0.0], [0.0, 0.0], &walls),
        ([0.0, 0.0], [0.0, 12.0], &walls),
    ];
    let (log, poses) = driven_log(&legs, 0.04);
    let drift = log.drift().unwrap();
    assert!((drift - 0.04).abs() < 0.01, "{drift}");
    assert_eq!(log.params().matching.rounds, 8);
    assert_eq!(log.params().map, LaserParams::default().for_matched_scans().map);
    // The frame begins where the robot did, along the walls.
    for view in 0..log.len() {
        let there = poses[log.scan(view)];
        let seen = log.view(view, false).robot;
        let [x, y] = there.position;
        assert!(distance(seen.position, [x + 18.0, y]) < 0.3, "{seen:?} and {there:?}");
        assert!(seen.seen(there.heading).abs() < 0.03, "{seen:?} and {there:?}");
    }
    // With little drift odometry alone decides.
    let (log, _) = driven_log(&legs, 0.01);
    assert_eq!(log.drift(), None);
    assert_eq!(log.params().matching.rounds, 0);
    assert_eq!(log.params().map, LaserParams::default().map);
}

#[test]
fn a_log_without_scans_has_no_view() {
    let log = ScanLog::new([], LaserParams::default());
    assert!(log.is_empty() && log.drift().is_none());
}

#[test]
fn where_a_robot_sees_in_a_log_does_not_depend_on_the_frame_of_odometry() {
    let walls = tee();
    let turned = |degrees: f64| {
        let frame = nalgebra::Isometry2::new([30.0, -7.0].into(), degrees.to_radians());
        let scans = (-20..=20).map(|step| {
            let there = pose(0.3 * f64::from(step), 0.0, 0.0);
            let odometry = moved(&frame, &there);
            (std::sync::Arc::new(walls.scan(&there, -180, 360)), odometry)
        });
        (frame, ScanLog::new(scans, LaserParams::default()))
    };
    for degrees in [0.0, 33.0, 90.0, -140.0] {
        let (frame, log) = turned(degrees);
        for view in 0..log.len() {
            let seen = log.view(view, false);
            let [place] = &seen.places[..] else { panic!("{degrees}: {:?}", seen.places) };
            let centre = frame.inverse() * place.centre;
            assert!(distance(centre, [0.0, 0.1]) < 0.3, "{degrees}: {centre}");
            let sight = |direction: f64| {
                log.sight(view, frame * Point2::origin(), direction + degrees.to_radians(), 5.0)
            };
            assert!((sight(-FRAC_PI_2) - 1.0).abs() < 0.25, "{degrees}");
            assert!((sight(FRAC_PI_2) - 5.0).abs() < 0.25, "{degrees}");
        }
    }
}
