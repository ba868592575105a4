//! Single rays on a map of cells of 1 m.

use nalgebra::{Isometry2, Point2, Vector2};

use super::{near, rows};
use crate::laser::{
    grid::Grid,
    params::LocalMapParams,
    ray_counts::{RayCounts, Rays},
};

/// Counts in a square of 20 m by 20 m with its middle at the origin.
fn counts() -> RayCounts {
    RayCounts::around(Point2::origin(), 20, 1.0, Vector2::zeros())
}

/// A ray from one point that hits another.
fn hit(from: [f64; 2], to: [f64; 2]) -> Rays {
    let [from, to] = [from, to].map(Point2::from);
    Rays { hits: vec![to], free: vec![[from, to]], ..Rays::default() }
}

fn add(counts: &mut RayCounts, rays: &Rays) {
    counts.add(rays, &Isometry2::identity());
}

fn remove(counts: &mut RayCounts, rays: &Rays) {
    counts.remove(rays, &Isometry2::identity());
}

/// What the counts show around the origin, in a square of 15 m by 15 m.
fn seen(counts: &RayCounts) -> Grid {
    counts.window(Point2::new(0.5, 0.5), 15, &LocalMapParams::default())
}

#[test]
fn cells_up_to_a_hit_are_free_and_the_hit_is_occupied() {
    let mut counts = counts();
    add(&mut counts, &hit([0.5, 0.5], [4.5, 0.5]));
    let grid = seen(&counts);
    assert_eq!(rows(&grid), ["       ", " ....# ", "       "]);
    // One unknown cell lies around what is known.
    assert!(near(grid.origin.x, -1.0) && near(grid.origin.y, -1.0), "{}", grid.origin);
    remove(&mut counts, &hit([0.5, 0.5], [4.5, 0.5]));
    assert_eq!(rows(&seen(&counts)), ["   "; 3], "nothing is left");
}

#[test]
fn a_ray_that_would_have_ended_at_the_latest_somewhere_hits_nothing() {
    let mut counts = counts();
    let free = vec![[[0.5, 0.5], [0.5, -3.5]].map(Point2::from)];
    add(&mut counts, &Rays { free, ..Rays::default() });
    // The cell of its end is not passed.
    assert_eq!(rows(&seen(&counts)), ["   ", " . ", " . ", " . ", " . ", "   "]);
}

#[test]
fn a_ray_leaves_the_map_and_what_is_beyond_it_is_lost() {
    let mut counts = counts();
    add(&mut counts, &hit([0.5, 0.5], [0.5, 1e4]));
    add(&mut counts, &hit([-1e4, 0.5], [0.5, 0.5]));
    let grid = seen(&counts);
    assert_eq!(grid.rows(), 9);
    assert_eq!(rows(&grid)[1], "       . ");
    assert_eq!(rows(&grid)[7], " ......# ");
}

#[test]
fn a_ray_from_or_to_no_place_at_all_changes_nothing_else() {
    let far = [1e9, 1e12, 1e300, f64::INFINITY, f64::NAN];
    for far in far.into_iter().flat_map(|far| [far, -far]) {
        let mut counts = counts();
        add(&mut counts, &hit([0.5, 0.5], [2.5, 0.5]));
        for (from, to) in
            [([far, 0.5], [far, far]), ([far, far], [-far, -far]), ([far, -far], [3.5, 0.5])]
        {
            add(&mut counts, &hit(from, to));
            remove(&mut counts, &hit(from, to));
        }
        assert_eq!(rows(&seen(&counts)), ["     ", " ..# ", "     "], "{far}");
    }
}

#[test]
fn a_cell_is_occupied_if_a_fifth_of_the_rays_that_reach_it_end_there() {
    let params = LocalMapParams { occupied: 0.2, ..LocalMapParams::default() };
    for (passes, is_wall) in [(1, true), (4, true), (5, false)] {
        let mut counts = counts();
        add(&mut counts, &hit([0.5, 0.5], [2.5, 0.5]));
        (0..passes).for_each(|_| add(&mut counts, &hit([0.5, 0.5], [4.5, 0.5])));
        let grid = counts.window(Point2::new(0.5, 0.5), 15, &params);
        let row = if is_wall { " ..#.# " } else { " ....# " };
        assert_eq!(rows(&grid)[1], row, "{passes}");
    }
}

#[test]
fn a_piece_of_wall_is_occupied_between_its_ends() {
    let mut counts = counts();
    let wall = [[-3.5, 2.5], [3.5, 2.5]].map(Point2::from);
    add(&mut counts, &Rays { walls: vec![wall], ..Rays::default() });
    // The rays that ended at its ends are counted by themselves.
    assert_eq!(rows(&seen(&counts))[1], " ###### ");
}

#[test]
fn a_window_fits_if_it_lies_on_the_square() {
    let counts = counts();
    for (point, fits) in [([0.5, 0.5], true), ([-5.0, 0.5], true), ([-5.1, 0.5], false)] {
        assert_eq!(counts.covers(point.into(), 10), fits, "{point:?}");
    }
    for (point, fits) in [([4.9, 4.9], true), ([5.1, 0.5], false), ([0.5, 5.1], false)] {
        assert_eq!(counts.covers(point.into(), 10), fits, "{point:?}");
    }
}

#[test]
fn corners_of_cells_are_shifted_from_those_of_the_frame() {
    let half = RayCounts::around([3.2, -1.6].into(), 20, 0.5, Vector2::repeat(0.5));
    assert_eq!(half.cell_at([3.25, -1.75].into()), [10, 10]);
    assert_eq!(half.cell_at([3.24, -1.76].into()), [9, 9]);
    let whole = RayCounts::around([3.2, -1.6].into(), 20, 0.5, Vector2::zeros());
    assert_eq!(whole.cell_at([3.0, -2.0].into()), [10, 10]);
    assert_eq!(whole.cell_at([2.99, -2.01].into()), [9, 9]);
}

#[test]
fn what_is_two_cells_from_a_hit_is_near_and_what_no_ray_reached_is_not_known() {
    let mut counts = counts();
    add(&mut counts, &hit([-5.5, 0.5], [2.5, 0.5]));
    let [hits, walls] = counts.near_hits_and_walls(2, &LocalMapParams::default());
    for near in [hits, walls] {
        let at = |x: f64, y: f64| near.at(counts.cell_at([x, y].into()));
        assert_eq!(at(2.5, 0.5), Some(true));
        assert_eq!(at(0.5, 0.5), Some(true));
        assert_eq!(at(-0.5, 0.5), Some(false));
        assert_eq!(at(2.5, 1.5), None, "no ray was there");
        assert_eq!(at(100.0, 0.5), None);
        assert_eq!(at(0.5, -100.0), None);
    }
    // A hit that most rays pass is no wall.
    (0..9).for_each(|_| add(&mut counts, &hit([-5.5, 0.5], [5.5, 0.5])));
    let [hits, walls] = counts.near_hits_and_walls(0, &LocalMapParams::default());
    let at = counts.cell_at([2.5, 0.5].into());
    assert_eq!([hits.at(at), walls.at(at)], [Some(true), Some(false)]);
}

#[test]
fn rays_begin_and_end_where_the_motion_takes_them() {
    // A quarter turn to the left, and 3 m east.
    let quarter = Isometry2::new(Vector2::new(3.0, 0.0), std::f64::consts::FRAC_PI_2);
    let rays = Rays {
        hits: vec![[3.5, -0.5].into()],
        free: [[3.5, -0.5], [0.5, 2.5]].map(|to| [[0.5, -0.5], to].map(Point2::from)).to_vec(),
        walls: vec![[[-4.5, -0.5], [-4.5, 3.5]].map(Point2::from)],
    };
    let mut counts = counts();
    counts.add(&rays, &quarter);
    assert_eq!(
        rows(&seen(&counts)),
        [
            "      ", "    # ", "    . ", "    . ", "  ... ", "      ", "      ", "      ",
            "      ", " ###  ", "      "
        ]
    );
    counts.remove(&rays, &quarter);
    assert_eq!(rows(&seen(&counts)), ["   "; 3], "nothing is left");
}
