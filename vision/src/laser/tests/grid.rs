//! The cells of a map of known size.

use nalgebra::Point2;

use super::{drawn, near, rows};
use crate::laser::{
    grid::{Cell, Grid, floor},
    params::LocalMapParams,
};

#[test]
fn floor_is_the_whole_number_below() {
    for (number, below) in [(1.5, 1), (-1.5, -2), (0.25, 0), (-0.25, -1), (3.0, 3), (-3.0, -3)] {
        assert_eq!(floor(number), below, "{number}");
    }
}

#[test]
fn the_cells_of_a_map_of_2_m_by_1_5_m_are_counted_from_its_corner() {
    let grid = drawn(&["....", "....", "...."]);
    assert_eq!(grid.rows(), 3);
    for (index, [x, y]) in
        [(0, [1.25, 2.25]), (3, [2.75, 2.25]), (4, [1.25, 2.75]), (11, [2.75, 3.25])]
    {
        let middle = grid.point(index);
        assert!(near(middle.x, x) && near(middle.y, y), "{index}: {middle}");
        assert_eq!(grid.index(middle), Some(index));
    }
    assert_eq!(grid.index([1.0, 2.0].into()), Some(0), "the corner");
    assert_eq!(grid.index([2.99, 3.49].into()), Some(11));
    for outside in [[0.99, 2.5], [3.0, 2.5], [2.0, 1.99], [2.0, 3.5], [0.99, 3.5]] {
        assert_eq!(grid.index(outside.into()), None, "{outside:?}");
    }
    assert_eq!(grid.column_row([0.9, 4.1].into()), [-1, 4]);
}

#[test]
fn a_wall_that_stopped_a_robot_is_on_the_map_with_free_space_before_it_and_not_on_the_border() {
    let mut grid = drawn(&["        ", " ....   ", " ..#    ", " ...    ", " ....   ", "        "]);
    // From 1.5 m east of the robot to beyond the map.
    grid.build([2.25, 3.75].into(), [[3.75, 3.25], [3.75, 6.0]].map(Point2::from));
    let built = ["        ", " ....#  ", " ..#.#  ", " ....#  ", " ....   ", "        "];
    assert_eq!(rows(&grid), built, "what was seen stays");
}

#[test]
fn the_cells_near_a_point_are_those_whose_middles_are() {
    let grid = drawn(&["......"; 5]);
    let middle = grid.point(2 * 6 + 3);
    let near = |within: f64| grid.cells_near(middle, within).collect::<Vec<_>>();
    assert_eq!(near(0.4), [15]);
    assert_eq!(near(0.5), [9, 14, 15, 16, 21], "a cell is 0.5 m wide");
    assert_eq!(near(0.75), [8, 9, 10, 14, 15, 16, 20, 21, 22], "a diagonal step is 0.71 m");
    let around = |point: [f64; 2], within: f64| {
        grid.cells_around(Point2::from(point), within).collect::<Vec<_>>()
    };
    assert_eq!(around([2.75, 3.25], 0.5), [8, 9, 10, 14, 15, 16, 20, 21, 22]);
    assert_eq!(around([1.25, 2.25], 0.5), [0, 1, 6, 7], "at the corner");
    assert_eq!(around([3.75, 4.25], 0.9), [15, 16, 17, 21, 22, 23, 27, 28, 29], "at the other one");
}

#[test]
fn neighbours_are_clockwise_and_touch_at_a_side_or_a_corner() {
    let grid = drawn(&["....."; 4]);
    let at = grid.point(7);
    let off = grid.neighbours(7).map(|near| {
        let off = (grid.point(near) - at) / grid.cell;
        [off.x.round() as i32, off.y.round() as i32]
    });
    // The map is seen from above, and rows go north, so this is counter-clockwise in the plane.
    assert_eq!(off, [[-1, -1], [0, -1], [1, -1], [1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0]]);
}

#[test]
fn cells_that_touch_are_one_group() {
    let grid = drawn(&["......"; 6]);
    // Two on a diagonal, and one two cells away.
    let groups = grid.groups(&[7, 14, 28, 16]);
    assert_eq!(groups, [vec![7, 14], vec![28], vec![16]]);
    assert_eq!(grid.groups(&[7, 8, 15, 22, 21]).len(), 1, "around a corner");
}

/// The rows of a map after it was cleaned, with other parameters of its obstacles.
fn cleaned(map: &[&str], params: &LocalMapParams) -> Vec<String> {
    let mut grid = drawn(map);
    grid.clean(params);
    rows(&grid)
}

#[test]
fn what_no_ray_reached_is_free_if_five_neighbours_are_and_one_is_beside_it() {
    // Obstacles of any size stay.
    let params = LocalMapParams { small_obstacle: 0.0, ..LocalMapParams::default() };
    for (map, is_freed) in [
        (["       ", " ..... ", " .. .. ", " ..... ", "       "], true),
        // Five of eight, one of which is beside it.
        (["       ", " ..... ", " .# #. ", " ..#.. ", "       "], true),
        // Four of eight.
        (["       ", " ..### ", " .. #. ", " ...#. ", "       "], false),
    ] {
        let row = &cleaned(&map, &params)[2];
        assert_eq!(row.chars().nth(3) == Some('.'), is_freed, "{map:?}");
    }
}

#[test]
fn an_obstacle_stays_if_it_is_as_long_as_a_small_one_along_an_axis_or_reaches_the_border() {
    // Small obstacles are narrower than 1 m, which is two cells.
    let params = LocalMapParams { small_obstacle: 1.0, ..LocalMapParams::default() };
    let map = [
        "          ",
        " ........ ",
        " .##..#.. ",
        " .##..#.. ",
        " .....#.. ",
        " ........ ",
        " .###..#. ",
        " .......# ",
        "          ",
    ];
    let expected = [
        "          ",
        " ........ ",
        " .....#.. ",
        " .....#.. ",
        " .....#.. ",
        " ........ ",
        " .###..#. ",
        " .......# ",
        "          ",
    ];
    assert_eq!(cleaned(&map, &params), expected);
    let all: Vec<&str> = expected.to_vec();
    assert_eq!(cleaned(&all, &params), expected, "nothing is left to clean");
}

#[test]
fn any_of_the_four_cells_beside_an_unknown_one_can_make_it_free() {
    let params = LocalMapParams { small_obstacle: 0.0, ..LocalMapParams::default() };
    // The four on the diagonals, and one beside it.
    for map in [
        ["       ", " ..... ", " .# #. ", " ..#.. ", "       "],
        ["       ", " ..#.. ", " .. #. ", " ..#.. ", "       "],
        ["       ", " ..#.. ", " .# .. ", " ..#.. ", "       "],
        ["       ", " ..#.. ", " .# #. ", " ..... ", "       "],
    ] {
        assert_eq!(cleaned(&map, &params)[2].chars().nth(3), Some('.'), "{map:?}");
    }
}

#[test]
fn specks_from_south_to_north_are_no_wall_and_mullions_are() {
    // Ten obstacles of three columns, each 0.75 m north of the one before, of so many rows.
    let left = |height: usize| {
        let cell = |at: usize| {
            let (column, row) = (at % 20, at / 20);
            let is_obstacle =
                (8..11).contains(&column) && (5..55).contains(&row) && (row - 5) % 5 < height;
            match (column % 19 == 0 || row % 69 == 0, is_obstacle) {
                (true, _) => Cell::Unknown,
                (_, true) => Cell::Occupied,
                _ => Cell::Free,
            }
        };
        let cells = (0..20 * 70).map(cell).collect();
        let mut grid = Grid { columns: 20, cell: 0.15, origin: Point2::origin(), cells };
        grid.clean(&LocalMapParams::default());
        grid.cells.iter().filter(|&&cell| cell == Cell::Occupied).count()
    };
    assert_eq!([left(1), left(2)], [0, 60]);
}
