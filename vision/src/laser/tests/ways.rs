//! The ways on maps of known corridors: their middle lines, their ends, and where they meet.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Point2;
use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use crate::{
    geometry::{angle, distance, unit},
    laser::{
        arm_view::{ArmView, wall_behind},
        clearances::Clearances,
        ends::{WayEnd, way_lengths},
        grid::{Cell, Grid},
        params::LaserParams,
        scan::Scan,
        skeleton::Skeleton,
        viewpoint::Viewpoint,
        way_graph::{ArmJudge, CountedArms, Way, WayGraph},
    },
    place::SeenPlace,
};

/// The side of a cell, in metres.
const CELL: f64 = 0.125;

/// A rectangle: from west to east and from south to north, in metres.
type Rectangle = [[f64; 2]; 2];

fn is_in([x, y]: [f64; 2], [[west, east], [south, north]]: Rectangle) -> bool {
    (west..east).contains(&x) && (south..north).contains(&y)
}

/// A map of 40 m by 30 m with its corner at the origin: walls everywhere but in free rectangles and in unknown ones.
fn map(free: &[Rectangle], unknown: &[Rectangle]) -> Clearances {
    let (columns, rows) = (320, 240);
    let cell = |at: usize| {
        let (column, row) = (at % columns, at / columns);
        let point = [column, row].map(|at| (at as f64 + 0.5) * CELL);
        let is_border = column % (columns - 1) == 0 || row % (rows - 1) == 0;
        if is_border || unknown.iter().any(|area| is_in(point, *area)) {
            Cell::Unknown
        } else if free.iter().any(|area| is_in(point, *area)) {
            Cell::Free
        } else {
            Cell::Occupied
        }
    };
    let cells = (0..columns * rows).map(cell).collect();
    Clearances::new(Grid { columns, cell: CELL, origin: Point2::origin(), cells })
}

fn ways(map: &Clearances, robot: [f64; 2]) -> (Skeleton, WayGraph) {
    let skeleton = Skeleton::new(map, robot.into(), &LaserParams::default()).unwrap();
    let graph = WayGraph::new(&skeleton, map);
    (skeleton, graph)
}

/// A corridor from west to east, 2 m wide, with its middle 10 m north.
const CORRIDOR: Rectangle = [[5.0, 35.0], [9.0, 11.0]];
/// Nothing was seen of its last metres, to the west and to the east.
const WEST: Rectangle = [[5.0, 6.0], [0.0, 30.0]];
const EAST: Rectangle = [[34.0, 35.0], [0.0, 30.0]];

#[test]
fn the_middle_line_of_a_corridor_is_half_of_its_width_from_its_walls() {
    let map = map(&[CORRIDOR], &[WEST, EAST]);
    let robot = [20.0, 9.5];
    let (skeleton, graph) = ways(&map, robot);
    let [way] = &graph.ways[..] else { panic!("{graph:?}") };
    assert_eq!(graph.nodes.len(), 2);
    assert!((way.length - 28.0).abs() < 0.5, "{}", way.length);
    // Its ends are those of the farthest cells.
    for (point, clearance) in way.line.iter().filter(|(point, _)| (8.0..32.0).contains(&point.x)) {
        assert!((point.y - 10.0).abs() < 0.2, "{point}");
        assert!((clearance - 1.0).abs() < 0.15, "{clearance}");
    }
    let width = skeleton.width_at(robot.into(), &map, &LaserParams::default().map).unwrap();
    assert!((width - 2.0).abs() < 0.2, "{width}");
    let far = skeleton.width_at([20.0, 27.0].into(), &map, &LaserParams::default().map);
    assert_eq!(far, None, "17 m from the corridor");
}

#[test]
fn a_way_ends_open_where_nothing_was_seen_and_closed_at_a_wall() {
    for (unknown, kinds) in [
        (&[WEST, EAST][..], [WayEnd::Open, WayEnd::Open]),
        (&[WEST], [WayEnd::Closed, WayEnd::Open]),
        (&[], [WayEnd::Closed, WayEnd::Closed]),
    ] {
        let (skeleton, graph) = ways(&map(&[CORRIDOR], unknown), [20.0, 10.0]);
        let mut ends = skeleton.ends.clone();
        ends.sort_by_key(|end| (end.kind != WayEnd::Closed, end.cell));
        assert_eq!(ends.iter().map(|end| end.kind).collect::<Vec<_>>(), kinds);
        for end in ends.iter().filter(|end| end.kind == WayEnd::Open) {
            // As wide as the corridor, which is known up to there.
            assert!((end.gap - 2.0).abs() < 0.4, "{end:?}");
            assert!(end.beyond < 0.4, "{end:?}");
        }
        assert!(graph.nodes.iter().all(|node| node.end.is_some()));
    }
}

#[test]
fn an_end_is_unclear_if_its_border_goes_on_around_a_corner() {
    // At the end of a corridor there is a window in its wall.
    for (width, kind) in [(0.375, WayEnd::Closed), (0.75, WayEnd::Unclear)] {
        let window = [[33.0 - width, 33.0], [11.0, 12.0]];
        let map = map(&[[[5.0, 34.0], [9.0, 11.0]]], &[WEST, window]);
        let (skeleton, _) = ways(&map, [20.0, 10.0]);
        let east = skeleton.ends.iter().find(|end| map.grid.point(end.cell).x > 30.0);
        assert_eq!(east.map(|end| end.kind), Some(kind), "{width}: {:?}", skeleton.ends);
    }
}

#[test]
fn a_way_that_is_narrower_than_the_robot_needs_is_none() {
    for (width, is_way) in [(1.0, false), (1.5, true)] {
        let branch = [[20.0 - width / 2.0, 20.0 + width / 2.0], [11.0, 25.0]];
        let (_, graph) = ways(&map(&[CORRIDOR, branch], &[WEST, EAST]), [20.0, 10.0]);
        let is_there = graph.nodes.iter().any(|node| node.point.y > 20.0);
        assert_eq!(is_there, is_way, "{width}");
    }
}

#[test]
fn there_is_no_way_where_the_robot_is_far_from_one() {
    let map = map(&[CORRIDOR], &[WEST, EAST]);
    let skeleton = |y: f64| Skeleton::new(&map, [20.0, y].into(), &LaserParams::default());
    // 1.5 m from what is 0.6 m from a wall.
    assert!(skeleton(11.8).is_some() && skeleton(12.4).is_none() && skeleton(7.6).is_none());
}

/// A T: a corridor, and one of 2 m that leaves it to the north at 20 m.
fn tee() -> Clearances {
    map(&[CORRIDOR, [[19.0, 21.0], [11.0, 28.0]]], &[WEST, EAST, [[0.0, 40.0], [27.0, 30.0]]])
}

#[test]
fn three_ways_meet_in_a_t() {
    let (_, graph) = ways(&tee(), [14.0, 10.0]);
    let degrees = graph.degrees();
    let meets: Vec<usize> = (0..degrees.len()).filter(|&node| degrees[node] == 3).collect();
    let [meet] = meets[..] else { panic!("{degrees:?}") };
    let node = graph.nodes[meet];
    assert!(distance(node.point, [20.0, 10.2]) < 0.4, "{}", node.point);
    assert!((node.clearance - 1.2).abs() < 0.3, "{}", node.clearance);
    assert_eq!(node.end, None);
    let mut lengths: Vec<f64> =
        graph.at(meet).into_iter().map(|way| graph.ways[way].length).collect();
    lengths.sort_by(f64::total_cmp);
    // To the unknown: 14 m west and east, 17 m north.
    for (length, expected) in lengths.iter().zip([14.0, 14.0, 17.0]) {
        assert!((length - expected).abs() < 0.6, "{lengths:?}");
    }
    assert_eq!(degrees.iter().filter(|&&degree| degree == 1).count(), 3);
    for way in graph.at(meet) {
        let way = graph.ways[way].clone().from_node(meet);
        assert_eq!(way.nodes[0], meet);
        assert!(distance(way.line[0].0, node.point) < 1e-9);
        let end = graph.nodes[way.nodes[1]].point;
        assert!(distance(way.line[way.line.len() - 1].0, end) < 1e-9);
        let [there, back] = way.lines();
        assert!(there == way.line && back.iter().rev().eq(&way.line));
    }
}

/// The places of a graph with all of its ways.
fn places(map: &Clearances, robot: [f64; 2], corners: bool) -> Vec<SeenPlace> {
    let mut params = LaserParams::default();
    params.corner.corners = corners;
    ways(map, robot).1.places(&params)
}

/// Whether a place has these arms, in degrees and clockwise from the west.
fn has_arms(place: &SeenPlace, degrees: &[f64]) -> bool {
    let arms: Vec<f64> = place.directions().collect();
    arms.len() == degrees.len()
        && arms
            .iter()
            .zip(degrees)
            .all(|(arm, degrees)| wrapped(arm - degrees.to_radians()).abs() < 0.25)
}

#[test]
fn a_t_is_a_junction_with_three_certain_arms_at_right_angles() {
    let places = places(&tee(), [14.0, 10.0], false);
    let [junction] = &places[..] else { panic!("{places:?}") };
    assert!(distance(junction.centre, [20.0, 10.2]) < 0.4, "{}", junction.centre);
    assert!(
        has_arms(junction, &[180.0, 90.0, 0.0]) || has_arms(junction, &[90.0, 0.0, -180.0]),
        "{junction:?}"
    );
    assert!(junction.arms.iter().all(crate::place::PlaceArm::is_certain));
}

#[test]
fn corridors_that_leave_beside_each_other_meet_in_one_junction_and_farther_apart_in_two() {
    let crossing = |apart: f64| {
        let north = [[19.0, 21.0], [11.0, 28.0]];
        let south = [[19.0 + apart, 21.0 + apart], [1.0, 9.0]];
        let unknown = [WEST, EAST, [[0.0, 40.0], [27.0, 30.0]], [[0.0, 40.0], [0.0, 2.0]]];
        places(&map(&[CORRIDOR, north, south], &unknown), [14.0, 10.0], false)
    };
    for (apart, arms) in [(0.0, &[4][..]), (1.0, &[4]), (2.25, &[3, 3]), (3.0, &[3, 3])] {
        let found: Vec<usize> = crossing(apart).iter().map(|place| place.arms.len()).collect();
        assert_eq!(found, arms, "{apart} m");
    }
    let one = &crossing(1.0)[0];
    assert!(distance(one.centre, [20.5, 10.0]) < 0.4, "{}", one.centre);
}

/// A corridor that comes from the west and turns to the north 20 m east.
fn bend() -> Clearances {
    let unknown = [WEST, [[0.0, 40.0], [27.0, 30.0]]];
    map(&[[[5.0, 21.0], [9.0, 11.0]], [[19.0, 21.0], [9.0, 28.0]]], &unknown)
}

#[test]
fn a_bend_is_a_corner_where_corners_are_vertices() {
    assert!(places(&bend(), [14.0, 10.0], false).is_empty());
    let places = places(&bend(), [14.0, 10.0], true);
    let [corner] = &places[..] else { panic!("{places:?}") };
    assert!(distance(corner.centre, [20.0, 10.0]) < 0.8, "{}", corner.centre);
    let arms: Vec<f64> = corner.directions().collect();
    let [one, other] = arms[..] else { panic!("{arms:?}") };
    let turn = wrapped(one - other).abs();
    assert!((turn - FRAC_PI_2).abs() < 0.35, "{arms:?}");
    for arm in [FRAC_PI_2, PI] {
        assert!(arms.iter().any(|seen| wrapped(seen - arm).abs() < 0.3), "{arms:?}");
    }
}

#[test]
fn a_straight_corridor_has_no_corner() {
    let map = map(&[CORRIDOR], &[WEST, EAST]);
    assert!(places(&map, [20.0, 10.0], true).is_empty());
}

#[test]
fn the_end_of_a_long_way_is_a_dead_end_where_dead_ends_are_vertices() {
    // It ends 30 m east.
    let closed = map(&[[[5.0, 30.0], [9.0, 11.0]]], &[WEST]);
    assert!(places(&closed, [14.0, 10.0], false).is_empty());
    let places_there = places(&closed, [14.0, 10.0], true);
    let [end] = &places_there[..] else { panic!("{places_there:?}") };
    assert!((end.centre.y - 10.0).abs() < 0.7 && (28.5..30.0).contains(&end.centre.x), "{end:?}");
    assert!(has_arms(end, &[180.0]) || has_arms(end, &[-180.0]), "{end:?}");
    assert!(end.arms[0].is_certain());
    // Less than 5 m from the beginning of the way.
    let short = map(&[[[5.0, 10.0], [9.0, 11.0]]], &[WEST]);
    assert!(places(&short, [7.0, 10.0], true).is_empty());
}

#[test]
fn a_way_around_a_block_ends_where_it_begins() {
    // A ring of corridors, and one that leads to it.
    let ring = [
        [[18.0, 33.0], [9.0, 11.0]],
        [[18.0, 33.0], [20.0, 22.0]],
        [[18.0, 20.0], [9.0, 22.0]],
        [[31.0, 33.0], [9.0, 22.0]],
        [[5.0, 18.0], [9.0, 11.0]],
    ];
    let map = map(&ring, &[WEST]);
    let arm = &LaserParams::default().arm;
    let judge = ArmJudge { map: &map, viewpoints: &[], driven: &[], params: arm };
    let (graph, _) = ways(&map, [10.0, 10.0]).1.pruned(&judge, CountedArms::Seen);
    let degrees = graph.degrees();
    let meet = degrees.iter().position(|&degree| degree == 3).unwrap();
    let loops: Vec<&Way> = graph.ways.iter().filter(|way| way.nodes == [meet; 2]).collect();
    let [around] = loops[..] else { panic!("{degrees:?}") };
    // Along the middle lines: 13 m by 11 m, with corners that are cut.
    assert!((around.length - 46.0).abs() < 3.0, "{}", around.length);
    assert_eq!(graph.at(meet).len(), 3, "the loop is there twice");
    assert_eq!(graph.ways.len(), 2);
}

/// What is seen from a meet point at 10 m along an arm to the east, with 1 m between the meet point and the walls.
fn arm_view(map: &Clearances, far: f64) -> ArmView {
    let line: Vec<_> =
        (0..200).map(|at| (Point2::new(10.0 + 0.1 * f64::from(at), 10.0), 1.0)).collect();
    ArmView::new(&line, (line[0].0, 1.0), map, far)
}

#[test]
fn one_sees_along_a_corridor_as_far_as_it_goes_between_its_walls() {
    // 15 m from the meet point to the end.
    let map = map(&[[[5.0, 25.0], [9.0, 11.0]]], &[WEST]);
    for (far, is_far) in [(9.5, true), (14.8, true), (15.3, false)] {
        let view = arm_view(&map, far);
        assert_eq!((view.is_far, view.walled), (is_far, [1.0, 1.0]), "{far}");
        // Farther than the end, one sees the wall there from one side of the corridor to the other.
        let facing = if is_far { 0.0..0.1 } else { 1.5..2.1 };
        assert!(facing.contains(&view.facing_wall), "{far}: {view:?}");
        assert!((view.length - far.min(15.0)).abs() < 0.2, "{far}: {view:?}");
    }
}

#[test]
fn a_wall_that_is_missing_on_one_side_is_not_beside_the_arm() {
    // From 17 m on, which is 5.7 m from where lines of sight begin, the corridor opens to the north.
    let hall = [[17.0, 30.0], [9.0, 20.0]];
    let view = arm_view(&map(&[[[5.0, 30.0], [9.0, 11.0]], hall], &[WEST]), 9.5);
    assert!(view.is_far);
    let [less, more] = view.walled;
    assert!(more == 1.0 && (0.6..0.8).contains(&less), "{view:?}");
    // The same for one that is not far enough, by its longest line of sight.
    let [less, _] = arm_view(&map(&[[[5.0, 30.0], [9.0, 11.0]], hall], &[WEST]), 30.0).walled;
    assert!((0.1..0.8).contains(&less), "{less}");
    // Through glass on both sides nothing is a wall.
    let glass = [[[5.0, 30.0], [11.0, 11.5]], [[5.0, 30.0], [8.5, 9.0]]];
    let view = arm_view(&map(&[[[5.0, 30.0], [9.0, 11.0]]], &[&[WEST][..], &glass].concat()), 9.5);
    assert_eq!((view.is_far, view.facing_wall, view.walled), (true, 0.0, [0.0; 2]));
    assert!((9.5..9.7).contains(&view.length), "{view:?}");
}

#[test]
fn walls_at_changing_distances_are_not_straight() {
    // Niches of 1 m in both walls, every other metre.
    let mut free = vec![[[5.0, 30.0], [9.0, 11.0]]];
    free.extend((0..10).map(|niche| {
        [[10.0 + 2.0 * f64::from(niche), 11.0 + 2.0 * f64::from(niche)], [8.0, 12.0]]
    }));
    let [less, more] = arm_view(&map(&free, &[WEST]), 9.5).walled;
    assert!((0.4..0.65).contains(&less) && (0.4..0.65).contains(&more), "{less} and {more}");
}

#[test]
fn an_arm_that_bends_a_little_is_seen_by_a_line_of_sight_beside_its_middle() {
    // A corridor of 2 m that goes on 1.75 m farther north or south from 18 m on: lines of sight that are turned by 6 to 10
    // degrees pass the step. Those in its own direction end there.
    for north in [1.75, -1.75] {
        let beside = [[18.0, 30.0], [9.0 + north, 11.0 + north]];
        let map = map(&[[[5.0, 18.5], [9.0, 11.0]], beside], &[WEST]);
        assert!(arm_view(&map, 15.0).is_far && !arm_view(&map, 21.0).is_far, "{north}");
    }
    // To the side where it is 0.3 m wider lines of sight that begin 0.3 m aside go farther.
    for aside in [0.2, -0.2] {
        let slit = [[14.0, 30.0], [9.9 + aside, 10.1 + aside]];
        let map = map(&[[[5.0, 14.0], [9.0, 11.0]], slit], &[WEST]);
        assert!(arm_view(&map, 6.0).is_far, "{aside}");
    }
}

#[test]
fn one_looks_along_an_arm_from_behind_the_walls_of_its_junction() {
    // A hall of 8 m by 4 m around the meet point, whose walls are 2 m away.
    let map = map(&[[[5.0, 30.0], [9.0, 11.0]], [[8.0, 12.0], [6.0, 14.0]]], &[WEST]);
    let line: Vec<_> =
        (0..200).map(|at| (Point2::new(10.0 + 0.1 * f64::from(at), 10.0), 1.0)).collect();
    let view = ArmView::new(&line, (line[0].0, 2.0), &map, 9.5);
    assert_eq!((view.is_far, view.facing_wall, view.walled), (true, 0.0, [1.0; 2]));
    assert!((9.5..9.7).contains(&view.length), "{view:?}");
}

#[test]
fn the_length_of_a_way_is_measured_in_straight_and_diagonal_steps() {
    let grid = map(&[[[0.0, 40.0], [0.0, 30.0]]], &[]).grid;
    let mut set: Vec<bool> = grid.cells.iter().map(|&cell| cell == Cell::Free).collect();
    // A wall from south to north that leaves no way around.
    (0..240).for_each(|row| set[row * 320 + 200] = false);
    let at = |column: usize, row: usize| row * 320 + column;
    let lengths = way_lengths(&mut set, &grid, at(100, 100));
    // In fifths of a cell: 5 for a straight step, and 7 for a diagonal one.
    for (column, row, length) in [
        (100, 100, 0),
        (103, 100, 15),
        (100, 90, 50),
        (103, 103, 21),
        (97, 103, 21),
        (102, 101, 12),
    ] {
        assert_eq!(lengths[at(column, row)], length, "{column}, {row}");
    }
    assert!(set[at(199, 50)] && !set[at(200, 50)] && !set[at(201, 50)], "behind the wall");
}

#[test]
fn what_is_known_beyond_the_end_of_a_way_is_as_far_as_its_gap_is_slanted() {
    // The corridor is known up to a line from (33, 9) to (31, 11).
    let slanted: Vec<Rectangle> = (0..16)
        .map(|row| {
            let [west, south] = [33.0 - CELL * f64::from(row), 9.0 + CELL * f64::from(row)];
            [[west, 35.0], [south, south + CELL]]
        })
        .collect();
    let map = map(&[CORRIDOR], &[&[WEST][..], &slanted].concat());
    let (skeleton, _) = ways(&map, [20.0, 10.0]);
    let east = skeleton.ends.iter().find(|end| map.grid.point(end.cell).x > 25.0).unwrap();
    assert!((0.4..0.7).contains(&east.beyond), "{east:?}");
}

#[test]
fn a_dent_in_a_wall_is_no_end_of_a_way() {
    for (depth, ends) in [(0.875, 2), (2.5, 3)] {
        let dent = [[19.0, 21.0], [11.0, 11.0 + depth]];
        let (skeleton, _) = ways(&map(&[CORRIDOR, dent], &[WEST, EAST]), [12.0, 10.0]);
        assert_eq!(skeleton.ends.len(), ends, "{depth} m: {:?}", skeleton.ends);
    }
}

#[test]
fn nothing_is_seen_from_outside_of_a_map() {
    let map = map(&[CORRIDOR], &[WEST, EAST]);
    for from in [[-1.0, 10.0], [41.0, 10.0], [20.0, -1.0], [20.0, 31.0]] {
        assert_eq!(map.sight(from.into(), 0.0, 5.0), (0.0, Cell::Unknown), "{from:?}");
    }
}

#[test]
fn nothing_is_seen_along_a_way_of_no_length() {
    let map = map(&[CORRIDOR], &[WEST, EAST]);
    let none = ArmView::new(&[], (Point2::new(10.0, 10.0), 1.0), &map, 9.5);
    let nothing = ArmView { is_far: false, length: 0.0, facing_wall: 0.0, walled: [0.0; 2] };
    assert_eq!(none, nothing);
}

#[test]
fn a_point_is_hidden_where_a_wall_is_nearer() {
    let map = map(&[CORRIDOR], &[WEST, EAST]);
    let sight = |direction: f64, limit: f64| map.sight([20.0, 10.0].into(), direction, limit);
    // 1 m to the walls, 14 m to what is unknown.
    for direction in [FRAC_PI_2, -FRAC_PI_2] {
        let (length, cell) = sight(direction, 30.0);
        assert!((length - 1.0).abs() <= CELL && cell == Cell::Occupied, "{length}");
    }
    for direction in [0.0, PI] {
        let (length, cell) = sight(direction, 30.0);
        assert!((length - 14.0).abs() <= CELL && cell == Cell::Unknown, "{length}");
        let (length, cell) = sight(direction, 5.0);
        assert!((length - 5.0).abs() <= CELL && cell == Cell::Free, "{length}");
    }
    let slanted = angle(unit(PI / 6.0));
    assert!((sight(slanted, 30.0).0 - 2.0).abs() < 0.2, "1 m across at 30 degrees");
}

#[test]
fn a_cell_is_at_the_border_of_the_unknown_if_it_is_not_at_a_wall() {
    let map = map(&[CORRIDOR], &[WEST, EAST]);
    let is_border = |x: f64, y: f64| map.is_unknown_border(map.grid.index([x, y].into()).unwrap());
    assert!(is_border(33.95, 10.0) && is_border(6.05, 10.0));
    assert!(!is_border(33.8, 10.0), "the second cell");
    assert!(!is_border(33.95, 9.05), "beside a wall, too");
    assert!(!is_border(34.05, 10.0), "it is unknown");
}

/// What is known of an arm, the least first.
const STATUSES: [&str; 5] = ["ended", "unseen", "in doubt", "seen", "driven"];

/// What is known of the only way that leaves the corridor, for a robot that drove along the corridor and along these points.
fn status(
    free: &[Rectangle],
    unknown: &[Rectangle],
    driven: &[[f64; 2]],
    viewpoints: &[Viewpoint],
) -> &'static str {
    let map = map(&[&[CORRIDOR], free].concat(), &[&[WEST, EAST], unknown].concat());
    let along = (13..=67).map(|half| Point2::new(f64::from(half) / 2.0, 10.0));
    let driven: Vec<_> = along.chain(driven.iter().map(|&point| point.into())).collect();
    let params = LaserParams::default();
    let judge = ArmJudge { map: &map, viewpoints, driven: &driven, params: &params.arm };
    let (_, graph) = ways(&map, [12.0, 10.0]);
    let all =
        [CountedArms::NotEnded, CountedArms::SeenOrInDoubt, CountedArms::Seen, CountedArms::Driven];
    let is_arm = |counted: &CountedArms| {
        let (graph, any_in_doubt) = graph.clone().pruned(&judge, *counted);
        let places = graph.places(&params);
        for arm in places.iter().flat_map(|place| &place.arms) {
            // The arms of the corridor itself were driven.
            let is_north = (arm.direction - FRAC_PI_2).abs() < 0.8;
            assert!(
                arm.is_certain() || is_north && any_in_doubt || *counted == CountedArms::NotEnded
            );
        }
        places.iter().any(|place| place.arms.len() == 3)
    };
    let number = all.iter().take_while(|counted| is_arm(counted)).count();
    assert!(!all.iter().skip(number).any(is_arm), "who counts more counts all of these");
    STATUSES[number]
}

/// A way to the north, 20 m east, of this width and length behind the corridor; and the area behind it.
fn north(width: f64, length: f64) -> (Rectangle, Rectangle) {
    let sides = [20.0 - width / 2.0, 20.0 + width / 2.0];
    ([sides, [11.0, 11.0 + length]], [sides, [11.0 + length, 11.5 + length]])
}

/// [`status`] of a way that goes on unseen, or that ends at a wall.
fn status_of(width: f64, length: f64, goes_on: bool, driven: &[[f64; 2]]) -> &'static str {
    let (way, behind) = north(width, length);
    let unknown = [behind];
    status(&[way], if goes_on { &unknown } else { &[] }, driven, &[])
}

#[test]
fn a_way_of_a_corridors_width_may_be_an_arm_from_4_m_on_and_is_one_if_it_is_seen_for_9_5_m() {
    // Lengths are measured from the middle of the junction, 1.1 m south of where the way begins.
    for (length, expected) in [
        (0.3, "unseen"),
        (1.2, "unseen"),
        (2.5, "unseen"),
        (3.4, "in doubt"),
        (7.5, "in doubt"),
        (9.5, "seen"),
        (12.0, "seen"),
    ] {
        assert_eq!(status_of(2.0, length, true, &[]), expected, "{length} m");
    }
}

#[test]
fn a_narrow_way_is_a_door_and_a_wide_one_a_hall() {
    for (width, expected) in [
        (1.35, "unseen"),
        (1.75, "in doubt"),
        (2.25, "in doubt"),
        (2.75, "unseen"),
        (4.0, "unseen"),
    ] {
        assert_eq!(status_of(width, 6.0, true, &[]), expected, "{width} m");
    }
}

#[test]
fn a_way_that_is_seen_to_end_is_none_unless_it_is_as_long_as_an_arm() {
    for (length, expected) in [(1.0, "ended"), (4.0, "ended"), (7.5, "ended"), (9.5, "seen")] {
        assert_eq!(status_of(2.0, length, false, &[]), expected, "{length} m");
    }
    // It bends after 5 m, so that one does not see as far as it goes.
    let (way, _) = north(2.0, 5.0);
    let around = |length: f64| status(&[way, [[19.0, 19.0 + length], [14.0, 16.0]]], &[], &[], &[]);
    assert_eq!(around(4.0), "ended", "8 m");
    assert_eq!(around(9.0), "in doubt", "12 m");
}

#[test]
fn a_way_that_opens_into_what_was_not_seen_is_a_room_behind_a_door() {
    let (way, _) = north(2.0, 4.5);
    // It widens to 6 m, and nothing is known of what is behind.
    let opens = |width: f64| {
        let sides = [20.0 - width / 2.0, 20.0 + width / 2.0];
        status(&[way, [sides, [15.0, 15.6]]], &[[sides, [15.6, 16.5]]], &[], &[])
    };
    assert_eq!(opens(2.0), "in doubt");
    assert_eq!(opens(6.0), "unseen");
}

/// Points of the way to the north, one each 0.5 m, up to this far behind the corridor.
fn drove(length: f64) -> Vec<[f64; 2]> {
    (0..=((length + 1.0) / 0.5) as u32).map(|half| [20.0, 10.0 + 0.5 * f64::from(half)]).collect()
}

#[test]
fn a_way_was_driven_if_the_robot_drove_it_for_10_m_and_is_seen_if_it_drove_what_is_known_of_it() {
    for (length, driven, expected) in [
        (16.0, 9.5, "driven"),
        (16.0, 7.0, "seen"),
        (7.0, 6.5, "seen"),
        (7.0, 2.5, "in doubt"),
        // 4 m at least.
        (3.8, 3.5, "in doubt"),
    ] {
        assert_eq!(
            status_of(2.0, length, true, &drove(driven)),
            expected,
            "{driven} m of {length} m"
        );
    }
    assert_eq!(status_of(2.0, 7.0, false, &drove(6.5)), "ended", "a room");
    assert_eq!(status_of(2.0, 10.5, false, &drove(9.8)), "driven");
    // Beside the way, behind its wall.
    let beside: Vec<_> = drove(9.5).into_iter().map(|[x, y]| [x + 1.8, y]).collect();
    assert_eq!(status_of(2.0, 16.0, true, &beside), "seen");
}

/// [`status`] of a way to the north of this width, 2 m behind the corridor, whose last 1.2 m are so wide, and behind which
/// nothing was seen: by a scanner in the corridor, half a circle, that would have to turn by so much, in radians.
fn status_of_unseen(width: f64, opening: f64, turn: f64) -> &'static str {
    let (way, _) = north(width, 2.0);
    let sides = [20.0 - opening / 2.0, 20.0 + opening / 2.0];
    let scan = Scan::each_degree(-90, 181, |_| 1.0);
    let robot = Odometry { position: [20.0, 10.0], heading: PI + turn };
    let viewpoints = [Viewpoint::new(&scan, &robot)];
    status(&[way, [sides, [12.2, 13.4]]], &[[sides, [13.4, 14.0]]], &[], &viewpoints)
}

#[test]
fn a_short_way_may_be_an_arm_if_the_scanner_did_not_look_at_its_end() {
    assert_eq!(status_of_unseen(2.0, 3.25, 1.1), "in doubt");
    assert_eq!(status_of_unseen(2.0, 3.25, -0.1), "unseen", "it looked nearly there");
    assert_eq!(status_of_unseen(2.0, 2.0, 1.1), "unseen", "the gap is as wide as the way");
    // The doors of rooms are narrower, and one sees more than their width behind them.
    assert_eq!(status_of_unseen(1.375, 3.0, 1.1), "in doubt");
    assert_eq!(status_of_unseen(1.375, 7.0, 1.1), "unseen", "a room");
    assert_eq!(status_of_unseen(2.75, 5.0, 1.1), "unseen", "a hall");
}

/// What is unseen of a way to the north that is 2 m wide: 0.25 m of it from so far north on, beside its west wall, and 0.25 m
/// more after each rise.
fn unseen_side(south: f64, rise: f64) -> impl Iterator<Item = Rectangle> {
    (0..7).map(f64::from).map(move |step| {
        [[19.0, 19.25 + 0.25 * step], [south + rise * step, south + rise * (step + 1.0)]]
    })
}

/// [`status`] of this way with these unknown areas. The scanner is that of [`status_of_unseen`].
fn status_of_wedge(
    length: f64,
    unseen: impl Iterator<Item = Rectangle>,
    turn: f64,
) -> &'static str {
    let (way, behind) = north(2.0, length);
    let unknown: Vec<Rectangle> = unseen.chain([behind]).collect();
    let scan = Scan::each_degree(-90, 181, |_| 1.0);
    let robot = Odometry { position: [20.0, 10.0], heading: PI + turn };
    status(&[way], &unknown, &[], &[Viewpoint::new(&scan, &robot)])
}

#[test]
fn one_straight_wall_that_leads_away_beside_free_space_may_be_that_of_an_arm() {
    let unseen = || unseen_side(11.5, 1.0);
    assert_eq!(status_of_wedge(8.0, unseen(), 1.1), "in doubt");
    let wall = [[21.0, 22.0], [11.0, 20.0]];
    assert_eq!(status_of_wedge(8.0, unseen().chain([wall]), 1.1), "unseen", "no wall is seen");
    assert_eq!(status_of_wedge(8.0, unseen(), -0.1), "unseen", "the scanner looked there");
}

/// [`status`] of a way to the north of this width, of which the edge of the field of view shows so much so far behind the corridor.
/// There it ends at a wall, or goes on. The scanner is that of [`status_of_unseen`].
fn status_of_mouth(width: f64, depth: f64, seen: f64, goes_on: bool) -> &'static str {
    let (way, behind) = north(width, depth);
    let west = 20.0 - width / 2.0;
    let rows = (0..(depth / CELL) as u32).map(|row| CELL * f64::from(row));
    let unseen = rows.map(|row| {
        let edge = west + (width - seen) * (row + CELL) / depth;
        [[west, edge], [11.0 + row, 11.0 + row + CELL]]
    });
    let unknown: Vec<Rectangle> = unseen.chain(goes_on.then_some(behind)).collect();
    let scan = Scan::each_degree(-90, 181, |_| 1.0);
    let robot = Odometry { position: [20.0, 10.0], heading: PI + 1.1 };
    status(&[way], &unknown, &[], &[Viewpoint::new(&scan, &robot)])
}

#[test]
fn the_back_of_a_niche_faces_its_junction_and_the_walls_of_an_arm_do_not() {
    let (way, behind) = north(2.0, 2.0);
    let meet = [20.0, 10.0].into();
    let width = |unknown: &[Rectangle], towards: f64, least: f64| {
        wall_behind(meet, towards, least, &map(&[CORRIDOR, way], unknown))
    };
    // Its corners are seen, too.
    for askew in [-0.5, 0.0, 0.5] {
        let back = width(&[], FRAC_PI_2 + askew, 1.5);
        assert!((back - 2.0).abs() < 0.4, "{back}");
    }
    assert!(width(&[], FRAC_PI_2, 3.5) < 0.1, "it is nearer");
    let sides = width(&[behind], FRAC_PI_2, 1.5);
    assert!(sides < 0.8, "{sides} of an arm");
    assert!(width(&[], -FRAC_PI_2, 1.5) < 0.1, "the wall of the corridor");
}

#[test]
fn a_mouth_may_be_that_of_an_arm_unless_a_wall_faces_the_junction_behind_it() {
    for seen in [0.5, 0.75, 1.0] {
        assert_eq!(status_of_mouth(2.0, 1.0, seen, true), "in doubt", "{seen} m");
        assert_eq!(status_of_mouth(2.0, 1.0, seen, false), "unseen", "{seen} m");
    }
    for seen in [1.5, 1.8, 2.1] {
        assert_eq!(status_of_mouth(3.0, 2.0, seen, false), "unseen", "a niche, {seen} m of it");
    }
}

#[test]
fn a_way_reaches_as_far_behind_its_junction_as_what_is_seen_of_one_side() {
    // Its middle line ends 1.5 m from the junction, and 1.7 m are needed.
    assert_eq!(status_of_wedge(1.375, unseen_side(10.625, 0.25), 1.1), "in doubt");
    assert_eq!(status_of_wedge(0.7, unseen_side(10.625, 0.15), 1.1), "unseen");
}
