//! Places of buildings with right angles, as Algorithm 2 needs them, in scans of known walls.

use std::f64::consts::{FRAC_PI_2, PI};

use toposlam_model::driving::{
    odometry::Odometry,
    scene::{HallwayView, JunctionView, Place, wrapped},
};

use super::Walls;
use crate::laser::{scan::Scan, scene::ScanPlaceSensor};

fn pose(x: f64, y: f64, heading: f64) -> Odometry {
    Odometry { position: [x, y], heading }
}

/// A hallway of 1.6 m from 8 m west to 8 m east.
fn hallway() -> Walls {
    Walls::new(&[&[[-8.0, -0.8], [8.0, -0.8], [8.0, 0.8], [-8.0, 0.8], [-8.0, -0.8]]])
}

/// A T: a hallway of 1.6 m that comes from the west and ends in one from south to north, whose middle is 3 m east.
fn tee() -> Walls {
    Walls::new(&[
        &[[-8.0, 0.8], [2.2, 0.8], [2.2, 8.0], [3.8, 8.0], [3.8, -8.0], [2.2, -8.0]],
        &[[2.2, -8.0], [2.2, -0.8], [-8.0, -0.8], [-8.0, 0.8]],
    ])
}

fn nothing() -> Scan {
    Scan::each_degree(0, 1, |_| f64::NAN)
}

fn as_hallway(place: &Place) -> HallwayView {
    let Place::Hallway(view) = place else { panic!("{place:?}") };
    *view
}

fn as_junction(place: Place) -> JunctionView {
    let Place::Junction(view) = place else { panic!("{place:?}") };
    view
}

#[test]
fn a_hallway_is_as_far_on_both_sides_as_its_walls() {
    for (y, heading) in [(0.0, 0.0), (0.2, 0.1), (-0.3, -0.15), (0.1, PI), (0.2, 2.9)] {
        let there = pose(0.0, y, heading);
        let mut sensor = ScanPlaceSensor::default();
        let view = as_hallway(&sensor.sense(&hallway().scan(&there, -180, 360), &there));
        // To the east, or to the west for a robot that looks there.
        let looks_east = heading.cos() > 0.0;
        let direction = if looks_east { 0.0 } else { PI };
        assert!(wrapped(view.heading + heading - direction).abs() < 0.02, "{heading}: {view:?}");
        let left = if looks_east { 0.8 - y } else { 0.8 + y };
        assert!((view.left - left).abs() < 0.03, "{y}, {heading}: {view:?}");
        assert!((view.right - (1.6 - left)).abs() < 0.03, "{y}, {heading}: {view:?}");
    }
}

#[test]
fn a_t_has_three_doors_around_the_point_where_the_middle_lines_meet() {
    for x in [2.2, 2.4, 2.7, 3.0] {
        let there = pose(x, 0.0, 0.0);
        let mut sensor = ScanPlaceSensor::default();
        let view = as_junction(sensor.sense(&tee().scan(&there, -180, 360), &there));
        let doors: Vec<f64> = view.doors.iter().map(|door| door.direction).collect();
        assert_eq!(doors.len(), 3, "{x}: {doors:?}");
        // Clockwise from the door behind: north and south.
        for (door, expected) in doors.iter().zip([PI, FRAC_PI_2, -FRAC_PI_2]) {
            assert!(wrapped(door - expected).abs() < 0.05, "{x}: {doors:?}");
        }
        let [ahead, aside] = view.turning_point;
        assert!((ahead - (3.0 - x)).abs() < 0.1 && aside.abs() < 0.1, "{x}: {view:?}");
    }
}

#[test]
fn a_robot_with_half_a_circle_turns_to_both_sides_until_it_has_seen_a_circle() {
    let headings = |count: u16| {
        let scan = Scan::each_degree(-i32::from(count) / 2, count, |_| 2.0);
        ScanPlaceSensor::default().headings_to_look_around(&scan, &Odometry::default())
    };
    // Two scans overlap by 0.17 radians. Half a circle is turned by a quarter and the overlap to both sides.
    let half = FRAC_PI_2 + 0.17;
    let expected = [half, 0.0, -half, 0.0];
    let found = headings(181);
    assert_eq!(found.len(), 4, "{found:?}");
    assert!(found.iter().zip(expected).all(|(one, other)| (one - other).abs() < 1e-9), "{found:?}");
    // A quarter of a circle, by 2.53 radians in steps of at most 1.40.
    let most = 0.75 * PI + 0.17;
    let expected = [most / 2.0, most, 0.0, -most / 2.0, -most, 0.0];
    let found = headings(91);
    assert_eq!(found.len(), 6, "{found:?}");
    assert!(found.iter().zip(expected).all(|(one, other)| (one - other).abs() < 1e-9), "{found:?}");
    // A gap of two degrees is none.
    assert!(headings(358).is_empty() && !headings(355).is_empty());
}

/// A sensor that has looked around at a pose, with half a circle.
fn looked_around(walls: &Walls, there: &Odometry) -> ScanPlaceSensor {
    let mut sensor = ScanPlaceSensor::default();
    sensor.begin_to_look_around(there);
    for turn in [0.0, FRAC_PI_2 + 0.17, 0.0, -FRAC_PI_2 - 0.17, 0.0] {
        let turned = there.moved(turn, 0.0);
        sensor.remember(&walls.scan(&turned, -90, 181), &turned);
    }
    sensor
}

#[test]
fn a_robot_that_has_looked_around_sees_what_one_with_a_full_circle_sees() {
    let there = pose(2.4, 0.0, 0.0);
    let scan = tee().scan(&there, -90, 181);
    let mut sensor = looked_around(&tee(), &there);
    assert!(sensor.headings_to_look_around(&scan, &there).is_empty());
    let view = as_junction(sensor.sense(&scan, &there));
    let whole = ScanPlaceSensor::default().sense(&tee().scan(&there, -180, 360), &there);
    let whole = as_junction(whole);
    assert_eq!(view.doors.len(), 3);
    for (one, other) in view.doors.iter().zip(&whole.doors) {
        assert!(wrapped(one.direction - other.direction).abs() < 0.03, "{view:?}");
    }
    let off = [0, 1].map(|axis| view.turning_point[axis] - whole.turning_point[axis]);
    assert!(off[0].hypot(off[1]) < 0.05, "{view:?} and {whole:?}");
}

#[test]
fn a_robot_at_a_junction_looks_around_again_if_it_has_moved() {
    let there = pose(2.4, 0.0, 0.0);
    let sensor = looked_around(&tee(), &there);
    for (turn, forward, looks) in [
        (0.0, 0.09, false),
        (0.0, 0.12, true),
        (0.45, 0.0, false),
        (-0.45, 0.0, false),
        (0.55, 0.0, true),
        (-0.55, 0.0, true),
    ] {
        let moved = there.moved(turn, forward);
        let scan = tee().scan(&moved, -90, 181);
        let headings = sensor.headings_to_look_around(&scan, &moved);
        assert_eq!(!headings.is_empty(), looks, "{turn}, {forward}");
    }
}

#[test]
fn a_robot_in_a_hallway_looks_around_once() {
    let there = pose(0.0, 0.0, 0.0);
    let scan = hallway().scan(&there, -90, 181);
    assert!(!ScanPlaceSensor::default().headings_to_look_around(&scan, &there).is_empty());
    let mut sensor = looked_around(&hallway(), &there);
    for step in 0..8 {
        let moved = there.moved(0.0, 0.25 * f64::from(step));
        let scan = hallway().scan(&moved, -90, 181);
        assert!(sensor.headings_to_look_around(&scan, &moved).is_empty(), "{moved:?}");
        let view = as_hallway(&sensor.sense(&scan, &moved));
        assert!((view.left - 0.8).abs() < 0.05 && (view.right - 0.8).abs() < 0.05, "{view:?}");
    }
}

#[test]
fn the_last_24_scans_are_remembered() {
    let there = Odometry::default();
    let place = |later: usize| {
        let mut sensor = ScanPlaceSensor::default();
        sensor.remember(&hallway().scan(&there, -180, 360), &there);
        (0..later).for_each(|_| sensor.remember(&nothing(), &there));
        sensor.sense(&nothing(), &there)
    };
    assert!((as_hallway(&place(0)).left - 0.8).abs() < 0.05);
    assert!((as_hallway(&place(23)).left - 0.8).abs() < 0.05);
    assert!(matches!(place(24), Place::Unknown(_)));
}

#[test]
fn looking_around_forgets_the_scans_of_the_way() {
    let there = Odometry::default();
    let mut sensor = ScanPlaceSensor::default();
    sensor.remember(&hallway().scan(&there, -180, 360), &there);
    sensor.begin_to_look_around(&there);
    assert!(matches!(sensor.sense(&nothing(), &there), Place::Unknown(_)));
}

#[test]
fn what_moves_is_where_it_was_seen_last_and_from_elsewhere_the_nearer_counts() {
    let narrow = Walls::new(&[&[[-8.0, -0.8], [8.0, -0.8]], &[[-8.0, 0.5], [8.0, 0.5]]]);
    let sensed = |first: (&Walls, f64), second: (&Walls, f64)| {
        let mut sensor = ScanPlaceSensor::default();
        for (walls, x) in [first, second] {
            let there = pose(x, 0.0, 0.0);
            sensor.remember(&walls.scan(&there, -180, 360), &there);
        }
        as_hallway(&sensor.sense(&nothing(), &Odometry::default())).left
    };
    let wide = hallway();
    for (first, second, left) in [
        ((&narrow, 0.0), (&wide, 0.0), 0.8),
        ((&wide, 0.0), (&narrow, 0.0), 0.5),
        ((&narrow, -0.5), (&wide, -0.5), 0.5),
        ((&wide, -0.5), (&narrow, -0.5), 0.5),
    ] {
        let sensed = sensed(first, second);
        assert!((sensed - left).abs() < 0.05, "{sensed} and not {left}");
    }
}

#[test]
fn a_scan_is_remembered_each_0_2_m_and_each_0_2_radians() {
    // What a robot with half a circle sees behind itself is what it saw on its way.
    let behind = |step: &dyn Fn(Odometry) -> Odometry, times: usize| {
        let mut sensor = ScanPlaceSensor::default();
        let mut at = pose(-3.0, 0.0, 0.0);
        for _ in 0..times {
            sensor.sense(&hallway().scan(&at, -90, 181), &at);
            at = step(at);
        }
        sensor.sense(&nothing(), &at)
    };
    // 24 scans cover 4.8 m of the way.
    let view = as_hallway(&behind(&|at| at.moved(0.0, 0.2), 30));
    assert!((view.left - 0.8).abs() < 0.05 && (view.right - 0.8).abs() < 0.05, "{view:?}");
}

/// What a robot senses that saw a hallway of 1.6 m, and then this at each bearing, at another pose.
fn then_sensed(there: Odometry, range: impl Fn(f64) -> f64) -> Option<HallwayView> {
    let mut sensor = ScanPlaceSensor::default();
    let first = pose(0.0, 0.0, 0.0);
    as_hallway(&sensor.sense(&hallway().scan(&first, -180, 360), &first));
    match sensor.sense(&Scan::each_degree(-180, 360, range), &there) {
        Place::Hallway(view) => Some(view),
        Place::Junction(_) | Place::Unknown(_) => None,
    }
}

/// Furniture on both sides of a direction, up to 29 degrees from what is beside it: hits that are on no line, at most so far
/// from the middle of the robot; elsewhere nothing returns.
fn furniture(bearing: f64, ahead: f64, [left, right]: [f64; 2]) -> f64 {
    let aside = wrapped(bearing - ahead);
    let is_beside = (aside.abs() - FRAC_PI_2).abs() < 29_f64.to_radians();
    let part = if (bearing.to_degrees().round() as i64).rem_euclid(2) == 0 { 1.0 } else { 0.55 };
    let across = part * if aside > 0.0 { left } else { right };
    if is_beside { across / aside.sin().abs() } else { f64::INFINITY }
}

#[test]
fn a_hallway_whose_walls_are_hidden_is_where_it_was_before() {
    for (x, y, heading) in [(0.0, 0.0, 0.0), (1.0, 0.1, 0.2), (2.0, -0.2, -0.3), (4.9, 0.1, 0.1)] {
        let view =
            then_sensed(pose(x, y, heading), |bearing| furniture(bearing, -heading, [0.6; 2]));
        let view = view.unwrap();
        assert!((view.heading + heading).abs() < 0.01, "{heading}: {view:?}");
        assert!((view.left - (0.8 - y)).abs() < 0.02, "{y}: {view:?}");
        assert!((view.right - (0.8 + y)).abs() < 0.02, "{y}: {view:?}");
    }
    let far = then_sensed(pose(5.1, 0.1, 0.0), |bearing| furniture(bearing, 0.0, [0.6; 2]));
    assert_eq!(far, None, "it goes on for 5 m");
}

#[test]
fn a_hidden_hallway_ends_where_something_beside_it_is_farther_than_its_walls() {
    // Its walls are 0.8 m away on both sides, and 0.25 m more are still a wall.
    for (sides, is_hidden) in [
        ([0.8, 0.8], true),
        ([1.02, 0.8], true),
        ([0.8, 1.02], true),
        ([1.1, 0.8], false),
        ([0.8, 1.1], false),
    ] {
        let view = then_sensed(pose(1.0, 0.0, 0.0), |bearing| furniture(bearing, 0.0, sides));
        assert_eq!(view.is_some(), is_hidden, "{sides:?}");
        // 0.2 m farther left, the left wall is 0.2 m nearer.
        let [left, right] = sides;
        let aside = [left - 0.2, right + 0.2];
        let view = then_sensed(pose(1.0, 0.2, 0.0), |bearing| furniture(bearing, 0.0, aside));
        assert_eq!(view.is_some(), is_hidden, "{aside:?}");
    }
}

#[test]
fn a_hidden_hallway_needs_something_on_both_sides_and_free_space_ahead() {
    let with = |also: &dyn Fn(f64) -> Option<f64>| {
        let range = |bearing| also(bearing).unwrap_or_else(|| furniture(bearing, 0.0, [0.6; 2]));
        then_sensed(pose(1.0, 0.0, 0.0), range).is_some()
    };
    assert!(with(&|_| None));
    // A thing at a bearing of so many degrees.
    let thing = |degrees: f64, range: f64| {
        move |bearing: f64| ((bearing.to_degrees() - degrees).abs() < 0.5).then_some(range)
    };
    for (degrees, range, is_free) in [
        (0.0, 0.7, false),
        (0.0, 0.9, true),
        // 0.24 m and 0.36 m aside.
        (20.0, 0.7, false),
        (-20.0, 0.7, false),
        (31.0, 0.7, true),
        (-31.0, 0.7, true),
        (180.0, 0.3, true),
    ] {
        assert_eq!(with(&thing(degrees, range)), is_free, "{degrees} degrees, {range} m");
    }
    let nothing_left = |bearing: f64| (bearing > 0.0).then_some(f64::INFINITY);
    let nothing_right = |bearing: f64| (bearing < 0.0).then_some(f64::INFINITY);
    assert!(!with(&nothing_left) && !with(&nothing_right));
}
