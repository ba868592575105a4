//! Walls: lines at right angles to each other. Section 2.4.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::{Point2, UnitComplex};
use toposlam_model::driving::scene::wrapped;

use crate::line::WallLine;

/// The largest angle between a wall and its axis. Views.
const MAX_SKEW: f64 = 0.20;
/// No wall is nearer to the robot's centre: such a line is the edge of a strut. Geometry: the radius of the
/// SuperScout's body.
const MIN_OFFSET: f64 = 0.20;
/// A point this near to a wall is on it. Views.
const ON_WALL: f64 = 0.06;
/// A boundary point on a wall of at least this length is sure. Views: the floor's own patterns are shorter.
const LONG_WALL: f64 = 0.60;

/// A frame of reference along the walls of a place. Its x axis is the one nearest to ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallFrame {
    /// The direction of x, in radians counter-clockwise from ahead, in (-pi/4, pi/4].
    angle: f64,
    robot_from_walls: UnitComplex<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    X,
    Y,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallSegment {
    pub along: Axis,
    /// Its coordinate on the other axis, in metres.
    pub offset: f64,
    pub from: f64,
    pub to: f64,
    pub cluster: usize,
}

impl WallFrame {
    /// The frame with an axis in this direction.
    pub fn along(direction: f64) -> Self {
        let angle = wrapped(4.0 * direction) / 4.0;
        Self { angle, robot_from_walls: UnitComplex::new(angle) }
    }

    /// The frame along which the most lines run, by length; `None` without lines.
    // paper: env.right-angles
    pub fn fit(lines: &[WallLine]) -> Option<Self> {
        let angles: Vec<_> =
            lines.iter().map(|line| (Self::along(line.direction()).angle, line.length())).collect();
        let near = |angle: f64| {
            angles
                .iter()
                .map(move |&(other, length)| (wrapped(4.0 * (other - angle)) / 4.0, length))
                .filter(|(off, _)| off.abs() < MAX_SKEW)
        };
        let supported = |angle: f64| near(angle).map(|(_, length)| length).sum::<f64>();
        let (angle, _) = angles
            .iter()
            .map(|&(angle, _)| (angle, supported(angle)))
            .max_by(|one, other| one.1.total_cmp(&other.1))?;
        let weighted = near(angle).fold([0.0; 2], |[sum, weight], (off, length)| {
            let square = length * length;
            [sum + square * off, weight + square]
        });
        Some(Self::along(angle + weighted[0] / weighted[1]))
    }

    /// The direction of x, in radians counter-clockwise from ahead, in (-pi/4, pi/4].
    pub fn angle(&self) -> f64 {
        self.angle
    }

    /// The direction along an axis that is rather ahead than behind: 1 or -1.
    pub fn ahead(&self, axis: Axis) -> f64 {
        if axis == Axis::Y && self.angle > 0.0 { -1.0 } else { 1.0 }
    }

    /// The turn from the frame to the robot's floor coordinates.
    pub fn robot_from_walls(&self) -> UnitComplex<f64> {
        self.robot_from_walls
    }

    /// The turn from the robot's floor coordinates to the frame.
    pub fn walls_from_robot(&self) -> UnitComplex<f64> {
        self.robot_from_walls.inverse()
    }

    pub fn walls(&self, lines: &[WallLine]) -> Vec<WallSegment> {
        lines.iter().filter_map(|line| self.wall(line)).collect()
    }

    fn wall(&self, line: &WallLine) -> Option<WallSegment> {
        let off = wrapped(line.direction() - self.angle).rem_euclid(TAU);
        let quarters = (off / FRAC_PI_2).round();
        if (off - quarters * FRAC_PI_2).abs() > MAX_SKEW {
            return None;
        }
        let along = if (quarters as u32).is_multiple_of(2) { Axis::X } else { Axis::Y };
        let [middle, from, to] =
            [line.middle, line.from, line.to].map(|point| self.walls_from_robot() * point);
        let (on, off) = along.split();
        if middle[off].abs() < MIN_OFFSET {
            return None;
        }
        Some(WallSegment {
            along,
            offset: middle[off],
            from: from[on].min(to[on]),
            to: from[on].max(to[on]),
            cluster: line.cluster,
        })
    }
}

impl Axis {
    /// The index of the coordinate along the axis, and of the one across it.
    pub fn split(self) -> (usize, usize) {
        match self {
            Self::X => (0, 1),
            Self::Y => (1, 0),
        }
    }

    #[must_use]
    pub fn across(self) -> Self {
        match self {
            Self::X => Self::Y,
            Self::Y => Self::X,
        }
    }

    /// The point with this coordinate along the axis, and that across it.
    pub fn point(self, along: f64, across: f64) -> Point2<f64> {
        match self {
            Self::X => Point2::new(along, across),
            Self::Y => Point2::new(across, along),
        }
    }

    /// Its direction in a frame, in radians counter-clockwise from the frame's x.
    pub fn direction(self) -> f64 {
        match self {
            Self::X => 0.0,
            Self::Y => FRAC_PI_2,
        }
    }
}

impl WallSegment {
    /// Whether a boundary point is sure, because it lies on this wall and the wall is long.
    pub(crate) fn confirms(&self, point: Point2<f64>) -> bool {
        let (along, across) = self.along.split();
        self.length() >= LONG_WALL
            && (self.from - ON_WALL..=self.to + ON_WALL).contains(&point[along])
            && (point[across] - self.offset).abs() <= ON_WALL
    }

    pub fn length(&self) -> f64 {
        self.to - self.from
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_4;

    use super::*;

    fn line(from: impl Into<Point2<f64>>, to: impl Into<Point2<f64>>) -> WallLine {
        let (from, to) = (from.into(), to.into());
        let points: Vec<_> =
            (0..=20).map(|step| from + f64::from(step) / 20.0 * (to - from)).collect();
        WallLine::through(&points).unwrap()
    }

    #[test]
    fn walls_at_right_angles_give_one_frame() {
        for turned in [-0.7, -0.3, 0.0, 0.4, 0.78] {
            let frame = WallFrame::along(turned);
            let turned_line = |[from, to]: [[f64; 2]; 2]| {
                let [from, to] = [from, to].map(|end| frame.robot_from_walls() * Point2::from(end));
                line(from, to)
            };
            let lines = [
                turned_line([[-1.0, 0.8], [1.5, 0.8]]),
                turned_line([[1.5, 0.8], [1.5, -0.8]]),
                turned_line([[0.3, 0.4], [0.6, 0.7]]),
            ];
            let found = WallFrame::fit(&lines).unwrap();
            assert!((found.angle() - turned).abs() < 1e-9, "{found:?}");
            let walls = found.walls(&lines);
            assert_eq!(walls.len(), 2, "the slanted line is not a wall");
            assert_eq!(walls[0].along, Axis::X);
            assert!((walls[0].offset - 0.8).abs() < 1e-9);
            assert!((walls[1].offset - 1.5).abs() < 1e-9);
            assert!((walls[1].length() - 1.6).abs() < 1e-9);
        }
    }

    #[test]
    fn a_line_through_the_robots_body_is_the_edge_of_a_strut() {
        let wall = line([-1.0, 0.8], [1.0, 0.8]);
        let strut = line([0.1, 0.4], [0.1, 0.7]);
        let across = line([1.2, 0.4], [1.2, 0.7]);
        let walls = WallFrame::along(0.0).walls(&[wall, strut, across]);
        assert_eq!(walls.iter().map(|wall| wall.along).collect::<Vec<_>>(), [Axis::X, Axis::Y]);
        assert!((walls[1].offset - 1.2).abs() < 1e-9);
    }

    #[test]
    fn the_x_axis_of_a_frame_is_the_one_nearest_to_ahead() {
        assert!((WallFrame::along(FRAC_PI_4 + 0.1).angle() + FRAC_PI_4 - 0.1).abs() < 1e-12);
        assert_eq!(WallFrame::fit(&[]), None);
    }
}
