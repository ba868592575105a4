//! Outlines: the walls of a hallway or a junction, fitted to what the robot sees. Section 3.

use nalgebra::{Point2, Vector2};

use crate::{
    boundary::Boundary,
    least_squares::NormalEquations,
    wall::{Axis, WallFrame},
};

/// A point this near to a wall agrees with it, at the robot. Views.
const NEAR: f64 = 0.05;
/// What each metre from the robot adds to that distance. Geometry: as `cluster::GAP_PER_METRE`.
const NEAR_PER_METRE: f64 = 0.03;
/// The length of a junction's arms, in hallway widths. Geometry: the next junction may begin there.
const ARM: f64 = 1.0;

/// The four directions of a frame, counter-clockwise: x, y, and their opposites.
pub const DIRECTIONS: [Vector2<f64>; 4] = [
    Vector2::new(1.0, 0.0),
    Vector2::new(0.0, 1.0),
    Vector2::new(-1.0, 0.0),
    Vector2::new(0.0, -1.0),
];

/// A place with walls along the axes of a frame: a piece of hallway, or a junction with its arms.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    pub(crate) sides: Vec<OutlineSide>,
    /// The width of its hallways, in metres.
    pub(crate) width: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OutlineSide {
    /// The side of the middle, on the axis across it, on which a wall is: -1 or 1. `None` if it is open.
    wall: Option<f64>,
    /// Its direction from the middle, an index in [`DIRECTIONS`].
    pub(crate) towards: usize,
    pub(crate) along: Axis,
    /// Its coordinate on the other axis, in metres.
    pub(crate) offset: f64,
    from: f64,
    to: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Square {
    /// The turning point of a junction; the point of a hallway's centre line beside the robot.
    pub middle: Point2<f64>,
    /// Half the width between the walls, in metres.
    pub half: f64,
}

const MOST_SIDES: usize = 12;

impl Outline {
    /// A piece of hallway along an axis, between two coordinates along it.
    pub fn hallway(axis: Axis, square: Square, from: f64, to: f64) -> Self {
        let (along, across) = axis.split();
        let [beside, centre] = [square.middle[along], square.middle[across]];
        let number = |axis: Axis, sign: f64| {
            let (first, _) = axis.split();
            if sign > 0.0 { first } else { first + 2 }
        };
        let wall = |sign: f64| OutlineSide {
            wall: Some(sign),
            towards: number(axis.across(), sign),
            along: axis,
            offset: centre + sign * square.half,
            from: beside + from,
            to: beside + to,
        };
        let end = |at: f64| OutlineSide {
            wall: None,
            towards: number(axis, at),
            along: axis.across(),
            offset: beside + at,
            from: centre - square.half,
            to: centre + square.half,
        };
        Self { sides: vec![wall(1.0), wall(-1.0), end(from), end(to)], width: 2.0 * square.half }
    }

    /// A junction with doors in some of the four [`DIRECTIONS`].
    pub fn junction(doors: [bool; 4], Square { middle, half }: Square) -> Self {
        let mut sides = Vec::with_capacity(MOST_SIDES);
        for (towards, (&open, direction)) in doors.iter().zip(DIRECTIONS).enumerate() {
            let sign = direction.sum();
            let arm = if direction.y == 0.0 { Axis::X } else { Axis::Y };
            let (along, across) = arm.split();
            let (edge, end) = (half, half + 2.0 * half * ARM);
            let [near, far] = [edge, end].map(|reach| middle[along] + sign * reach);
            let closing = |wall, offset| OutlineSide {
                wall,
                towards,
                along: arm.across(),
                offset,
                from: middle[across] - half,
                to: middle[across] + half,
            };
            if open {
                sides.push(closing(None, far));
                sides.extend([1.0, -1.0].map(|side| OutlineSide {
                    wall: Some(side),
                    towards,
                    along: arm,
                    offset: middle[across] + side * half,
                    from: near.min(far),
                    to: near.max(far),
                }));
            } else {
                sides.push(closing(Some(sign), near));
            }
        }
        Self { sides, width: 2.0 * half }
    }

    /// The side that a ray from the robot meets first: its range and its index.
    pub(crate) fn first_on(&self, ray: Vector2<f64>) -> Option<(f64, usize)> {
        let mut first: Option<(f64, usize)> = None;
        for (number, side) in self.sides.iter().enumerate() {
            let (along, across) = side.along.split();
            let at = side.offset / ray[across];
            let on = at * ray[along];
            if at > 0.0
                && on >= side.from
                && on <= side.to
                && first.is_none_or(|(nearest, _)| at < nearest)
            {
                first = Some((at, number));
            }
        }
        first
    }

    /// The distance of a point from the nearest wall, in metres.
    pub(crate) fn distance(&self, point: Point2<f64>) -> f64 {
        let walls = self.sides.iter().filter(|side| side.is_wall());
        walls.map(|side| side.distance(point)).fold(f64::INFINITY, f64::min)
    }

    /// The place moved, turned and widened so that its walls fit the boundary points near them best,
    /// by least squares; and the frame turned with it.
    pub fn fitted(
        &self,
        square: Square,
        boundary: &Boundary,
        frame: &WallFrame,
    ) -> (Square, WallFrame) {
        // What is not seen stays as it is: a pull of a thousandth of a point.
        let mut equations = NormalEquations::<4>::with_pull(1e-3);
        for (_, point) in boundary.points() {
            let from_robot = point.coords.norm();
            let point = frame.walls_from_robot() * point;
            let walls =
                self.sides.iter().filter_map(|side| Some((side, side.wall?, side.distance(point))));
            let nearest = walls.min_by(|one, other| one.2.total_cmp(&other.2));
            let near = nearest.filter(|&(_, _, off)| off <= near(from_robot));
            let Some((side, sign, _)) = near else { continue };
            // To first order, turning the frame by `turn` moves the point across the wall by
            // -turn x for a wall along x, and by turn y for one along y.
            let (along, across) = side.along.split();
            let by_turn = if along == 0 { point[0] } else { -point[1] };
            let mut row = [by_turn, 0.0, 0.0, sign];
            row[1 + across] = 1.0;
            let residual = point[across] - side.offset;
            // Pixels that are farther away cover more floor.
            let weight = 1.0 / (1.0 + from_robot.powi(4));
            equations.add(weight, row, residual);
        }
        let Some(moved) = equations.solve() else { return (square, *frame) };
        let square = Square {
            middle: square.middle + Vector2::new(moved[1], moved[2]),
            half: square.half + moved[3],
        };
        (square, WallFrame::along(frame.angle() + moved[0]))
    }
}

impl OutlineSide {
    pub(crate) fn is_wall(&self) -> bool {
        self.wall.is_some()
    }

    /// The distance of a point from it, in metres.
    fn distance(&self, point: Point2<f64>) -> f64 {
        let (along, across) = self.along.split();
        let beyond = (self.from - point[along]).max(point[along] - self.to).max(0.0);
        beyond.hypot(point[across] - self.offset)
    }
}

/// The distance from a wall that counts as near, at this range from the robot.
pub(crate) fn near(range: f64) -> f64 {
    NEAR + NEAR_PER_METRE * range
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawn_place::{self, DrawnPlace};

    #[test]
    fn a_place_is_moved_turned_and_widened_to_where_its_walls_are_seen() {
        let doors = [true, false, true, true];
        let boundary = DrawnPlace::junction(doors, 0.8).boundary([-0.2, 0.1], 0.3);
        let mut frame = WallFrame::along(-0.27);
        let mut square = Square { middle: Point2::new(0.16, -0.06), half: 0.78 };
        for _ in 0..4 {
            (square, frame) = Outline::junction(doors, square).fitted(square, &boundary, &frame);
        }
        let off = [
            square.middle[0] - 0.2,
            square.middle[1] + 0.1,
            square.half - (0.8 - drawn_place::TAPE),
            frame.angle() + 0.3,
        ];
        assert!(off.iter().all(|off| off.abs() < 0.005), "{off:?}");
    }

    #[test]
    fn a_ray_meets_the_nearest_side_first() {
        let square = Square { middle: Point2::origin(), half: 0.8 };
        let dead_end = Outline::junction([false, false, true, false], square);
        let first = |ray: [f64; 2]| {
            dead_end.first_on(ray.into()).map(|(range, side)| (range, dead_end.sides[side]))
        };
        let (ahead, wall) = first([1.0, 0.0]).unwrap();
        assert!((ahead - 0.8).abs() < 1e-12 && wall.is_wall() && wall.towards == 0);
        let (behind, open) = first([-1.0, 0.0]).unwrap();
        assert!((behind - 2.4).abs() < 1e-12 && !open.is_wall() && open.towards == 2);
        let (aside, wall) = first([0.0, -1.0]).unwrap();
        assert!((aside - 0.8).abs() < 1e-12 && wall.is_wall() && wall.towards == 3);
    }
}
