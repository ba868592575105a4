//! How a robot goes on along ways of known length.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Point2;

use crate::{
    geometry::distance,
    laser::{
        clearances::Clearances,
        ends::{End, WayEnd},
        grid::{Cell, Grid},
        local_map::LocalMap,
        navigation::{LineEnd, OpeningLimits, WayAhead, WayChoice, along},
        way_graph::{Way, WayGraph, WayNode},
    },
};

/// A map of free cells with these ways: nodes, each with what ends there, and straight ways between them.
fn map(nodes: &[([f64; 2], Option<WayEnd>)], ways: &[[usize; 2]]) -> LocalMap {
    let grid = Grid {
        columns: 400,
        cell: 0.15,
        origin: Point2::new(-30.0, -30.0),
        cells: vec![Cell::Free; 400 * 400],
    };
    let node = |&(point, kind): &([f64; 2], Option<WayEnd>)| WayNode {
        point: point.into(),
        clearance: 1.0,
        end: kind.map(|kind| End { cell: 0, kind, gap: 2.0, beyond: 0.0 }),
    };
    let way = |&[from, to]: &[usize; 2]| {
        let [one, other] = [from, to].map(|node| Point2::from(nodes[node].0));
        let length = distance(one, other);
        let steps = (length / 0.15).round().max(1.0) as u32;
        let at = |step: u32| one + f64::from(step) / f64::from(steps) * (other - one);
        let line = (0..=steps).map(|step| (at(step), 1.0)).collect();
        Way { nodes: [from, to], line, length, is_certain: true }
    };
    let ways =
        WayGraph { nodes: nodes.iter().map(node).collect(), ways: ways.iter().map(way).collect() };
    LocalMap { clearances: Clearances::new(grid), skeleton: None, graph: ways.clone(), ways }
}

const EAST: WayChoice = WayChoice { towards: 0.0, aside: 0.6, measured: 2.5 };

/// The end of the line by which a robot goes on to the east, and what is there.
fn end(map: &LocalMap, from: [f64; 2]) -> Option<([f64; 2], LineEnd)> {
    let WayAhead { line, end } = map.way_ahead(from.into(), &EAST)?;
    line.last().map(|&point| (point.into(), end))
}

#[test]
fn a_point_of_a_line_is_found_by_its_length() {
    let line = [[0.0, 0.0], [3.0, 0.0], [3.0, 4.0]].map(Point2::from);
    for (length, point) in [
        (0.0, [0.0, 0.0]),
        (1.0, [1.0, 0.0]),
        (3.0, [3.0, 0.0]),
        (5.5, [3.0, 2.5]),
        (9.0, [3.0, 4.0]),
    ] {
        assert!(distance(along(&line, length).unwrap(), point) < 1e-9, "{length}");
    }
    assert_eq!(along(&[], 1.0), None);
}

#[test]
fn a_way_is_followed_over_its_end_until_it_is_5_m_long() {
    let open = Some(WayEnd::Open);
    // Four ways of 3 m in a row.
    let nodes =
        [0.0, 3.0, 6.0, 9.0, 12.0].map(|x| ([x, 0.0], if x % 12.0 == 0.0 { open } else { None }));
    // Each may be recorded in either direction.
    for ways in [[[0, 1], [1, 2], [2, 3], [3, 4]], [[1, 0], [2, 1], [3, 2], [4, 3]]] {
        let map = map(&nodes, &ways);
        // From 0.5 m it is 2.5 m to the next node, and 5.5 m to the one after that.
        let (point, _) = end(&map, [0.45, 0.2]).unwrap();
        assert!(distance(point, [6.0, 0.0]) < 1e-9, "{point:?}");
        let (point, _) = end(&map, [1.5, 0.2]).unwrap();
        assert!(distance(point, [9.0, 0.0]) < 1e-9, "{point:?}");
        let (point, what) = end(&map, [8.0, 0.2]).unwrap();
        assert!(distance(point, [12.0, 0.0]) < 1e-9 && what == LineEnd::Unknown, "{point:?}");
    }
}

#[test]
fn a_robot_goes_straight_on_where_ways_meet() {
    let open = Some(WayEnd::Open);
    let nodes = [
        ([0.0, 0.0], open),
        ([4.0, 0.0], None),
        ([12.0, 2.0], open),
        ([5.0, 8.0], open),
        ([5.0, -8.0], open),
    ];
    for ways in [[[0, 1], [1, 2], [1, 3], [1, 4]], [[1, 4], [3, 1], [2, 1], [1, 0]]] {
        let (point, _) = end(&map(&nodes, &ways), [2.0, 0.0]).unwrap();
        assert!(distance(point, [12.0, 2.0]) < 1e-9, "{point:?}");
    }
    // To turn back is no way to go on.
    let back = [([0.0, 0.0], open), ([4.0, 0.0], None), ([0.0, 0.6], open)];
    let (point, _) = end(&map(&back, &[[0, 1], [1, 2]]), [2.0, -0.1]).unwrap();
    assert!(distance(point, [0.0, 0.6]) < 1e-9 || distance(point, [4.0, 0.0]) < 1e-9, "{point:?}");
}

#[test]
fn a_robot_that_drives_north_goes_straight_on_to_the_north() {
    let open = Some(WayEnd::Open);
    let nodes = [
        ([0.0, 0.0], open),
        ([0.0, 4.0], None),
        ([-2.0, 12.0], open),
        ([-8.0, 5.0], open),
        ([8.0, 5.0], open),
    ];
    let map = map(&nodes, &[[0, 1], [1, 3], [1, 4], [1, 2]]);
    let choice = WayChoice { towards: FRAC_PI_2, ..EAST };
    let ahead = map.way_ahead([0.0, 1.5].into(), &choice).unwrap();
    assert!(distance(ahead.line[ahead.line.len() - 1], [-2.0, 12.0]) < 1e-9, "{ahead:?}");
}

#[test]
fn a_niche_is_taken_only_if_the_others_bend_much_more() {
    // A wall 2 m straight on, and a way that turns by 60 or by 90 degrees.
    let open = Some(WayEnd::Open);
    let with = |niche: f64, kind: WayEnd, turn: f64| {
        let other = [4.0 + 9.0 * turn.cos(), 9.0 * turn.sin()];
        let nodes = [
            ([0.0, 0.0], open),
            ([4.0, 0.0], None),
            ([4.0 + niche, 0.0], Some(kind)),
            (other, open),
        ];
        let (point, what) = end(&map(&nodes, &[[0, 1], [1, 2], [1, 3]]), [2.0, 0.0]).unwrap();
        (distance(point, other) < 1e-9, what)
    };
    assert_eq!(with(2.0, WayEnd::Closed, 1.0), (true, LineEnd::Unknown));
    assert_eq!(with(2.0, WayEnd::Closed, 1.4), (false, LineEnd::Wall(1.0)));
    assert_eq!(with(3.5, WayEnd::Closed, 1.0), (false, LineEnd::Wall(1.0)), "it is no niche");
    assert_eq!(with(2.0, WayEnd::Open, 1.0), (false, LineEnd::Unknown), "it may go on");
}

#[test]
fn a_robot_takes_the_way_that_is_near_and_leads_ahead() {
    let open = Some(WayEnd::Open);
    let nodes = [
        ([0.0, 0.0], open),
        ([10.0, 0.0], open),
        // 2 m beside it, and in the direction of the robot.
        ([0.0, 2.0], open),
        ([10.0, 5.0], open),
    ];
    let map = map(&nodes, &[[0, 1], [2, 3]]);
    let towards = |towards: f64, from: [f64; 2]| {
        let choice = WayChoice { towards, aside: 0.6, measured: 2.5 };
        map.way_ahead(from.into(), &choice).map(|way| way.line[way.line.len() - 1])
    };
    let is_at = |point: Option<Point2<f64>>, to: [f64; 2]| {
        point.is_some_and(|point| distance(point, to) < 1e-9)
    };
    // The second one leads 0.29 radians to the left. A metre aside costs 0.3 radians.
    assert!(is_at(towards(0.0, [3.0, 0.2]), [10.0, 0.0]));
    assert!(is_at(towards(0.29, [3.0, 0.5]), [10.0, 0.0]));
    assert!(is_at(towards(0.29, [3.0, 1.6]), [10.0, 5.0]));
    assert!(is_at(towards(0.0, [3.0, 2.6]), [10.0, 5.0]));
    assert!(is_at(towards(PI, [6.0, -0.2]), [0.0, 0.0]));
    assert_eq!(towards(FRAC_PI_2, [3.0, -1.5]), None, "no way leads north");
    let aside = WayChoice { aside: 1.2, ..EAST };
    assert!(map.way_ahead([3.0, -2.9].into(), &aside).is_some());
    assert_eq!(map.way_ahead([3.0, -3.1].into(), &aside), None, "it is more than 3 m away");
    assert_eq!(towards(0.0, [10.0, 0.0]), None, "it is at the end");
}

#[test]
fn straight_ahead_a_robot_goes_up_to_a_limit_and_not_up_to_a_wall() {
    let mut map = map(&[], &[]);
    let grid = &mut map.clearances.grid;
    for row in 0..400 {
        // A wall 6 m east.
        let column = 240;
        grid.cells[row * 400 + column] = Cell::Occupied;
    }
    map.clearances = Clearances::new(map.clearances.grid.clone());
    let ahead = |limit: f64| map.straight_ahead(Point2::new(0.01, 0.01), 0.0, 0.5, limit);
    let near = ahead(3.0);
    assert!(distance(near.line[1], [3.0, 0.0]) < 0.1 && near.end == LineEnd::Unknown, "{near:?}");
    // At 5.6 m the limit and the distance before the wall reach it.
    let before = ahead(5.6);
    assert!(distance(before.line[1], [5.5, 0.0]) < 0.1, "{before:?}");
    assert_eq!(before.end, LineEnd::Wall(0.5));
    assert_eq!(ahead(5.3).end, LineEnd::Unknown);
}

#[test]
fn ways_that_meet_near_each_other_are_one_opening() {
    let open = Some(WayEnd::Open);
    // Two meet points, 1.4 m apart, with two ways each besides the one between them; and a third far away.
    let nodes = [
        ([0.0, 0.0], None),
        ([1.4, 0.0], None),
        ([-9.0, 0.0], open),
        ([0.0, 9.0], open),
        ([1.4, -9.0], open),
        ([12.0, 0.0], None),
        ([12.0, 9.0], open),
        ([12.0, -9.0], open),
    ];
    let ways = [[0, 1], [0, 2], [3, 0], [1, 4], [1, 5], [5, 6], [5, 7]];
    let map = map(&nodes, &ways);
    let opening = |robot: [f64; 2], together: f64| {
        map.opening(robot.into(), OpeningLimits { near: 1.5, together })
    };
    let one = opening([0.2, 0.3], 0.6).unwrap();
    assert!(distance(one.centre, [0.7, 0.0]) < 1e-9, "{one:?}");
    let degrees = |place: &crate::place::SeenPlace| {
        let mut degrees: Vec<i32> =
            place.directions().map(|arm| arm.to_degrees().round() as i32 / 10 * 10).collect();
        degrees.sort_unstable();
        degrees
    };
    let arms = degrees(&one);
    assert_eq!(arms.len(), 4, "{arms:?}");
    assert_eq!([arms[1], arms[3]], [0, 180], "{arms:?}");
    // Meet points at most 1.3 m from each other are together.
    let two = opening([0.2, 0.3], 0.3).unwrap();
    assert!(distance(two.centre, [0.0, 0.0]) < 1e-9, "{two:?}");
    assert_eq!(two.arms.len(), 3);
    assert!(opening([-1.6, 0.0], 0.6).is_none() && opening([-1.4, 0.0], 0.6).is_some());
    assert!(map.meets_near([2.8, 0.0].into(), 1.5) && !map.meets_near([2.8, 0.0].into(), 1.3));
}
