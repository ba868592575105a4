//! Points of the picture: x to the right, y down, so that growing angles turn clockwise on screen.

use std::{
    f64::consts::TAU,
    ops::{Add, Mul, Sub},
};

pub(super) use toposlam_model::driving::scene::wrapped;

/// A point, or a step from one point to another.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Point {
    pub(crate) x: f64,
    pub(crate) y: f64,
}

impl Point {
    pub(super) fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// The step of the given length in the direction of the angle.
    pub(super) fn polar(angle: f64, length: f64) -> Self {
        Self::new(angle.cos() * length, angle.sin() * length)
    }

    pub(super) fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y
    }

    /// Positive if `other` is clockwise of `self`.
    pub(super) fn cross(self, other: Self) -> f64 {
        self.x * other.y - self.y * other.x
    }

    pub(super) fn length(self) -> f64 {
        self.dot(self).sqrt()
    }

    pub(super) fn angle(self) -> f64 {
        self.y.atan2(self.x)
    }

    /// The step of length 1 in the same direction; zero if there is no direction.
    pub(super) fn direction(self) -> Self {
        let length = self.length();
        if length > 0.0 { self * (1.0 / length) } else { Self::default() }
    }

    /// A quarter turn clockwise.
    pub(super) fn quarter_turn(self) -> Self {
        Self::new(-self.y, self.x)
    }

    pub(super) fn distance(self, other: Self) -> f64 {
        (self - other).length()
    }

    /// The distance to the nearest point of the segment from `a` to `b`.
    pub(super) fn distance_to_segment(self, a: Self, b: Self) -> f64 {
        let along = b - a;
        let square = along.dot(along);
        if square == 0.0 {
            return self.distance(a);
        }
        let t = ((self - a).dot(along) / square).clamp(0.0, 1.0);
        self.distance(a + along * t)
    }
}

impl Add for Point {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y)
    }
}

impl Sub for Point {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y)
    }
}

impl Mul<f64> for Point {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self::new(self.x * factor, self.y * factor)
    }
}

/// The clockwise turn from one direction to another, in `[0, 2 pi)`.
pub(super) fn turn(from: f64, to: f64) -> f64 {
    let rest = (to - from).rem_euclid(TAU);
    if rest >= TAU { 0.0 } else { rest }
}

/// The point where the segments from `a` to `b` and from `c` to `d` cross in their interiors.
#[expect(clippy::many_single_char_names, reason = "the usual names of the ends")]
pub(super) fn crossing(a: Point, b: Point, c: Point, d: Point) -> Option<Point> {
    let (along, other) = (b - a, d - c);
    let denominator = along.cross(other);
    if denominator == 0.0 {
        return None;
    }
    let t = (c - a).cross(other) / denominator;
    let s = (c - a).cross(along) / denominator;
    ((0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&s)).then(|| a + along * t)
}

/// An upright box, initially empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Extent {
    pub(crate) least: Point,
    pub(super) most: Point,
}

impl Extent {
    pub(super) const EMPTY: Self = Self {
        least: Point { x: f64::INFINITY, y: f64::INFINITY },
        most: Point { x: f64::NEG_INFINITY, y: f64::NEG_INFINITY },
    };

    /// The box with this centre and these half sides.
    pub(super) fn around(centre: Point, half_width: f64, half_height: f64) -> Self {
        let half = Point::new(half_width, half_height);
        Self { least: centre - half, most: centre + half }
    }

    pub(super) fn from_points(points: impl IntoIterator<Item = Point>) -> Self {
        let mut extent = Self::EMPTY;
        for point in points {
            extent.include(point);
        }
        extent
    }

    pub(super) fn include(&mut self, point: Point) {
        self.least.x = self.least.x.min(point.x);
        self.least.y = self.least.y.min(point.y);
        self.most.x = self.most.x.max(point.x);
        self.most.y = self.most.y.max(point.y);
    }

    /// The box around this one and others.
    pub(super) fn joined(mut self, others: impl IntoIterator<Item = Self>) -> Self {
        for other in others {
            self.include(other.least);
            self.include(other.most);
        }
        self
    }

    pub(super) fn contains(&self, point: Point) -> bool {
        (self.least.x..=self.most.x).contains(&point.x)
            && (self.least.y..=self.most.y).contains(&point.y)
    }

    pub(super) fn meets(&self, other: &Self) -> bool {
        self.least.x <= other.most.x
            && other.least.x <= self.most.x
            && self.least.y <= other.most.y
            && other.least.y <= self.most.y
    }

    /// The area of the intersection of two boxes.
    pub(super) fn shared_area(&self, other: &Self) -> f64 {
        let width = self.most.x.min(other.most.x) - self.least.x.max(other.least.x);
        let height = self.most.y.min(other.most.y) - self.least.y.max(other.least.y);
        width.max(0.0) * height.max(0.0)
    }

    /// The box that is larger by a margin on all sides.
    pub(super) fn widened(&self, margin: f64) -> Self {
        let margin = Point::new(margin, margin);
        Self { least: self.least - margin, most: self.most + margin }
    }

    pub(crate) fn size(&self) -> Point {
        self.most - self.least
    }

    pub(super) fn centre(&self) -> Point {
        (self.least + self.most) * 0.5
    }
}
