//! Outlines: the walls that a robot would see at a place of a given form, held against what it sees.
//! Section 3.
//!
//! A place is decided on by its walls *and* by its floor: where floor is seen through a wall that an
//! outline has, or a wall where it has floor, the outline is wrong.

use nalgebra::{Matrix4, Vector4};

use crate::{
    boundary::{BEARINGS, Boundary, Edge, direction},
    cluster::range,
    wall::{Axis, Frame},
};

/// The four directions of a frame, counter-clockwise: x, y, and their opposites.
pub const DIRECTIONS: [[f64; 2]; 4] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];

/// A place with walls along the axes of a frame: a piece of hallway, or a junction with its arms.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    sides: Vec<Side>,
}

/// A side of an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Side {
    /// What is there.
    kind: Kind,
    along: Axis,
    /// Its coordinate on the other axis, in metres.
    offset: f64,
    from: f64,
    to: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// A wall, on this side of the place's middle on the axis across it: -1 or 1.
    Wall(f64),
    /// The outline says nothing of what comes behind.
    Open,
}

/// A hallway or a junction in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Square {
    /// Of a junction, the turning point; of a hallway, the point of its centre line beside the robot.
    pub middle: [f64; 2],
    /// Half the width between the walls, in metres.
    pub half: f64,
}

/// How an outline agrees with what is seen: a count of bearings for each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Agreement {
    /// A wall is seen where the outline has one.
    pub support: u32,
    /// The floor ends where the outline has a wall, though at no stripe: at a door, or a gap.
    pub ended: u32,
    /// The outline has a wall, and nothing is seen there.
    pub silent: u32,
    /// Floor is seen behind a wall of the outline: it may be a door of the floor's colour.
    pub through: u32,
    /// A wall is seen where the outline has floor.
    pub against: u32,
    /// How many of its walls are not seen at all, though many bearings lead there.
    pub blank: u32,
}

/// A point agrees with a wall that is so near, in metres,
const NEAR: f64 = 0.05;
/// and so much farther for each metre from the robot.
const NEAR_BY_RANGE: f64 = 0.03;
/// How many bearings in support one weighs on which the floor ends without a stripe;
const ENDED: f64 = 0.5;
/// how many one weighs on which floor is seen through a wall;
const THROUGH: f64 = 1.5;
/// and one on which a wall is seen before it.
const AGAINST: f64 = 3.0;
/// Walls are seen where there are none on this part of the bearings in support, at most.
const STRAY: f64 = 0.12;
/// Walls that are farther away are not looked for, in metres: a pixel covers as much as a stripe.
const FAR: f64 = 2.1;
/// A wall to which so few bearings lead need not be seen, as a part of all;
const NARROW: f64 = 0.02;
/// of others, at least this part is.
const BLANK: f64 = 0.25;
/// A junction has at most so many sides: a T, with three at each door and the wall opposite.
const MOST_SIDES: usize = 12;
/// How far the arms of a junction reach from its square, in its widths: there the next one may begin.
const ARM: f64 = 1.0;

impl Outline {
    /// A piece of hallway along an axis, from a coordinate along it to another.
    #[must_use]
    pub fn hallway(axis: Axis, square: Square, from: f64, to: f64) -> Self {
        let (along, across) = axis.split();
        let [beside, centre] = [square.middle[along], square.middle[across]];
        let wall = |sign: f64| Side {
            kind: Kind::Wall(sign),
            along: axis,
            offset: centre + sign * square.half,
            from: beside + from,
            to: beside + to,
        };
        let end = |at: f64| Side {
            kind: Kind::Open,
            along: axis.across(),
            offset: beside + at,
            from: centre - square.half,
            to: centre + square.half,
        };
        Self { sides: vec![wall(1.0), wall(-1.0), end(from), end(to)] }
    }

    /// A junction with doors in some of the four [`DIRECTIONS`].
    #[must_use]
    pub fn junction(doors: [bool; 4], Square { middle, half }: Square) -> Self {
        let mut sides = Vec::with_capacity(12);
        for (&open, [x, y]) in doors.iter().zip(DIRECTIONS) {
            let sign = x + y;
            let arm = if y == 0.0 { Axis::X } else { Axis::Y };
            let (along, across) = arm.split();
            let (edge, end) = (half, half + 2.0 * half * ARM);
            let [near, far] = [edge, end].map(|reach| middle[along] + sign * reach);
            let closing = |kind, offset| Side {
                kind,
                along: arm.across(),
                offset,
                from: middle[across] - half,
                to: middle[across] + half,
            };
            if open {
                sides.push(closing(Kind::Open, far));
                sides.extend([1.0, -1.0].map(|side| Side {
                    kind: Kind::Wall(side),
                    along: arm,
                    offset: middle[across] + side * half,
                    from: near.min(far),
                    to: near.max(far),
                }));
            } else {
                sides.push(closing(Kind::Wall(sign), near));
            }
        }
        Self { sides }
    }

    /// How the outline agrees with what is seen, on every so many bearings.
    #[must_use]
    pub fn agreement(&self, boundary: &Boundary, frame: &Frame, every: usize) -> Agreement {
        let mut agreement = Agreement::default();
        // For each side, on how many bearings it should be seen, and is.
        let mut seen = [(0, 0); MOST_SIDES];
        for (bearing, sight) in boundary.sights.iter().enumerate().step_by(every) {
            let ray = frame.framed(direction(bearing));
            let Some((at, number)) = self.first_on(ray) else { continue };
            if at > FAR {
                continue;
            }
            let side = &self.sides[number];
            // How far in front of the side something is, perpendicular to it.
            let (_, across) = side.along.split();
            let before = |range: f64| (at - range) * ray[across].abs();
            let is_wall = side.kind != Kind::Open;
            let fits = |range: f64| {
                let near = near(range);
                is_wall && before(range).abs() < near
                    || self.distance(ray.map(|part| range * part)) < near
            };
            let is_stripe = |edge: &Edge| edge.width * ray[across].abs() <= 1.0;
            let fitting = sight.edges().find(|edge| fits(edge.range));
            let ends = is_wall && before(sight.floor).abs() < near(at);
            if is_wall {
                seen[number].0 += 1;
                seen[number].1 += u32::from(fitting.is_some() || ends);
            }
            if let Some(edge) = fitting {
                if is_stripe(&edge) {
                    agreement.support += 1;
                } else {
                    agreement.silent += 1;
                }
            } else if sight.sure().is_some_and(|wall| wall < at) {
                agreement.against += 1;
            } else if ends {
                agreement.ended += 1;
            } else if is_wall && before(sight.floor) < -near(at) {
                agreement.through += 1;
            } else if is_wall {
                agreement.silent += 1;
            }
        }
        agreement.blank = seen
            .iter()
            .filter(|&&(due, seen)| {
                f64::from(due) > bearings(NARROW, every) && f64::from(seen) < BLANK * f64::from(due)
            })
            .count() as u32;
        agreement
    }

    /// How far away a ray from the robot meets a side first, and which.
    fn first_on(&self, ray: [f64; 2]) -> Option<(f64, usize)> {
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

    /// How far a point is from the nearest wall, in metres.
    fn distance(&self, point: [f64; 2]) -> f64 {
        let walls = self.sides.iter().filter(|side| side.kind != Kind::Open);
        walls.map(|side| side.distance(point)).fold(f64::INFINITY, f64::min)
    }

    /// The place moved, turned and widened so that its walls lie best on the boundary points near
    /// them, by least squares; and the frame turned with it.
    #[must_use]
    pub fn fitted(&self, square: Square, boundary: &Boundary, frame: &Frame) -> (Square, Frame) {
        let mut normal = Matrix4::zeros();
        let mut right = Vector4::zeros();
        // What is not seen stays as it is: a weak pull, in parts of one point.
        let pull = Vector4::new(1e-3, 1e-3, 1e-3, 1e-3);
        normal += Matrix4::from_diagonal(&pull);
        for (_, point) in boundary.points() {
            let from_robot = range(point);
            let point = frame.framed(point);
            let near = near(from_robot);
            let walls = self.sides.iter().filter_map(|side| match side.kind {
                Kind::Wall(sign) => Some((side, sign, side.distance(point))),
                Kind::Open => None,
            });
            let Some((side, sign, off)) = walls.min_by(|one, other| one.2.total_cmp(&other.2))
            else {
                continue;
            };
            if off > near {
                continue;
            }
            // To first order, turning the frame by `turn` moves the point across the wall by
            // -turn x for a wall along x, and by turn y for one along y.
            let (along, across) = side.along.split();
            let by_turn = if along == 0 { point[0] } else { -point[1] };
            let mut row = Vector4::new(by_turn, 0.0, 0.0, sign);
            row[1 + across] = 1.0;
            let residual = point[across] - side.offset;
            // A pixel covers more where it is farther away.
            let weight = 1.0 / (1.0 + from_robot.powi(4));
            normal += weight * row * row.transpose();
            right += weight * residual * row;
        }
        let Some(inverse) = normal.cholesky() else { return (square, *frame) };
        let moved = inverse.solve(&right);
        let square = Square {
            middle: [square.middle[0] + moved[1], square.middle[1] + moved[2]],
            half: square.half + moved[3],
        };
        (square, Frame::along(frame.angle() + moved[0]))
    }
}

impl Side {
    /// How far a point is from it, in metres.
    fn distance(&self, point: [f64; 2]) -> f64 {
        let (along, across) = self.along.split();
        let beyond = (self.from - point[along]).max(point[along] - self.to).max(0.0);
        beyond.hypot(point[across] - self.offset)
    }
}

impl Agreement {
    /// What supports the outline, less what does not, which weighs more.
    #[must_use]
    pub fn balance(&self) -> f64 {
        self.good() - THROUGH * f64::from(self.through) - AGAINST * f64::from(self.against)
    }

    /// The part of what is seen that supports the outline, from 0 to 1.
    #[must_use]
    pub fn trust(&self) -> f64 {
        self.good() / (self.good() + f64::from(self.through + self.against)).max(1.0)
    }

    /// The part of the outline's walls that is seen, from 0 to 1.
    #[must_use]
    pub fn cover(&self) -> f64 {
        let all = self.support + self.ended + self.silent + self.through + self.against;
        self.good() / f64::from(all.max(1))
    }

    /// In bearings on which a stripe is seen where it should be.
    fn good(&self) -> f64 {
        f64::from(self.support) + ENDED * f64::from(self.ended)
    }

    /// Whether so much of what is seen supports the outline, and little of it stands against it.
    #[must_use]
    pub fn holds(&self, trust: f64) -> bool {
        self.trust() >= trust && f64::from(self.against) <= STRAY * self.good()
    }
}

/// What counts as near a wall, so far from the robot.
fn near(range: f64) -> f64 {
    NEAR + NEAR_BY_RANGE * range
}

/// A number of bearings as a part of all.
#[must_use]
pub fn bearings(part: f64, every: usize) -> f64 {
    part * (BEARINGS / every) as f64
}
