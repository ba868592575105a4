//! Convex polygons: the pieces of a floor, and what stands on it.

use std::f64::consts::TAU;

use nalgebra::{Point2, Vector2, center};
use toposlam_vision::geometry::{direction, unit};

/// A convex polygon, in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexPolygon {
    /// Counter-clockwise.
    corners: Vec<Point2<f64>>,
}

/// The ends of a straight line.
pub type Segment = [Point2<f64>; 2];

/// What is nearer to the border than this is on it, in metres.
const TOLERANCE: f64 = 1e-6;
/// A shorter piece of wall comes from rounding, in metres.
const SHORTEST: f64 = 1e-3;

impl ConvexPolygon {
    /// The rectangle around a straight line, with this width across it, and longer by `beyond` at both ends.
    pub fn along([from, to]: Segment, width: f64, beyond: f64) -> Self {
        let half = [length([from, to]) / 2.0 + beyond, width / 2.0];
        Self::rectangle(center(&from, &to), half, direction(from, to))
    }

    /// A rectangle with this middle and these half sides, its first side in this direction.
    pub fn rectangle(middle: Point2<f64>, half: [f64; 2], direction: f64) -> Self {
        let ahead = unit(direction);
        let left = Vector2::new(-ahead.y, ahead.x);
        let corner = |[x, y]: [f64; 2]| middle + x * half[0] * ahead + y * half[1] * left;
        let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        Self { corners: signs.map(corner).to_vec() }
    }

    /// A regular polygon with so many corners on a circle.
    pub fn round(middle: Point2<f64>, radius: f64, corners: u32) -> Self {
        let direction = |number: u32| TAU * f64::from(number) / f64::from(corners);
        let corner = |number| middle + radius * unit(direction(number));
        Self { corners: (0..corners).map(corner).collect() }
    }

    pub fn sides(&self) -> impl Iterator<Item = Segment> + '_ {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next).map(|(&from, &to)| [from, to])
    }

    /// Whether a point is inside, and not on the border.
    pub fn holds(&self, point: impl Into<Point2<f64>>) -> bool {
        let point = point.into();
        self.sides().all(|side| depth(side, point) > TOLERANCE)
    }

    /// Where a straight line is inside, as shares of its length.
    pub fn inside(&self, [from, to]: Segment) -> Option<[f64; 2]> {
        let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
        for side in self.sides() {
            let [begin, end] = [from, to].map(|point| depth(side, point) - TOLERANCE);
            if begin <= 0.0 && end <= 0.0 {
                return None;
            }
            let crossing = begin / (begin - end);
            if begin < 0.0 {
                enters = enters.max(crossing);
            } else if end < 0.0 {
                leaves = leaves.min(crossing);
            }
        }
        (enters < leaves).then_some([enters, leaves])
    }

    /// Whether two polygons have inner points in common.
    pub fn meets(&self, other: &Self) -> bool {
        let is_apart = |one: &Self, other: &Self| {
            one.sides()
                .any(|side| other.corners.iter().all(|&corner| depth(side, corner) <= TOLERANCE))
        };
        !is_apart(self, other) && !is_apart(other, self)
    }
}

/// How far a point is to the left of a side, in metres.
fn depth([from, to]: Segment, point: Point2<f64>) -> f64 {
    (to - from).perp(&(point - from)) / length([from, to])
}

/// The border of the union of polygons: the pieces of their sides that are inside no other one, each with the
/// index of its polygon.
pub(super) fn border(polygons: &[ConvexPolygon]) -> Vec<(usize, Segment)> {
    let mut border = Vec::new();
    for (number, polygon) in polygons.iter().enumerate() {
        for side in polygon.sides() {
            let others = polygons.iter().enumerate().filter(|&(other, _)| other != number);
            let mut hidden: Vec<_> = others.filter_map(|(_, other)| other.inside(side)).collect();
            hidden.sort_by(|one, other| one[0].total_cmp(&other[0]));
            hidden.push([1.0, 1.0]);
            let mut seen = 0.0;
            for [from, to] in hidden {
                border.extend((from > seen).then(|| (number, part(side, seen, from))));
                seen = to.max(seen);
            }
        }
    }
    border.retain(|&(_, segment)| length(segment) > SHORTEST);
    border
}

/// A part of a segment, given as shares of its length.
pub(super) fn part([from, to]: Segment, begin: f64, end: f64) -> Segment {
    [begin, end].map(|share| from + share * (to - from))
}

/// The length of a segment, in metres.
pub(super) fn length([from, to]: Segment) -> f64 {
    (to.x - from.x).hypot(to.y - from.y)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn polygons_that_touch_do_not_meet() {
        let square = |x: f64| ConvexPolygon::rectangle(Point2::new(x, 0.0), [1.0, 1.0], 0.0);
        assert!(square(0.0).meets(&square(1.9)));
        assert!(!square(0.0).meets(&square(2.0)));
        let turned = ConvexPolygon::rectangle(Point2::new(2.2, 0.0), [1.0, 1.0], PI / 4.0);
        assert!(square(0.0).meets(&turned), "its corner is at 2.2 - 1.41");
    }

    #[test]
    fn a_line_is_inside_between_its_crossings() {
        let square = ConvexPolygon::rectangle(Point2::origin(), [1.0, 1.0], 0.0);
        let [enters, leaves] =
            square.inside([Point2::new(-2.0, 0.0), Point2::new(2.0, 0.0)]).unwrap();
        assert!((enters - 0.25).abs() < 1e-5 && (leaves - 0.75).abs() < 1e-5);
        assert_eq!(
            square.inside([Point2::new(-2.0, 1.0), Point2::new(2.0, 1.0)]),
            None,
            "along a side"
        );
        assert_eq!(square.inside([Point2::new(2.0, 0.0), Point2::new(3.0, 0.0)]), None);
    }
}
