//! How far a rim is from a circle: a mirror that the camera sees a little from the side is an ellipse.

use std::f64::consts::TAU;

use nalgebra::{Point2, Vector2};

use super::{
    circle::Circle,
    edges::{CircleEdge, unit},
};
use crate::geometry;

/// The greatest bulge, as a part of the radius. Geometry: a calibration allows the rim to be off by 2 %.
const MOST: f64 = 0.01;
/// The number of directions in which the longer axis is searched for. Views.
const DIRECTIONS: usize = 12;
/// Edges are on a curve if they are within this many units. Views.
const NEAR: f64 = 1.0;
/// An ellipse has this many times the edges of the circle. Views: by chance it has some more.
const CLEARLY_MORE: f64 = 1.25;

/// What is added to the radius of a circle on bearings twice as far around.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bulge(Vector2<f64>);

impl Bulge {
    pub(super) const NONE: Self = Self(Vector2::new(0.0, 0.0));

    /// The bulge with the most edges, of those that were searched for up to `reach` units from a circle; none if fewer
    /// than `least` are on it.
    pub(super) fn of(circle: &Circle, edges: &[CircleEdge], reach: f64, least: f64) -> Self {
        if (edges.len() as f64) < least {
            return Self::NONE;
        }
        let unit = unit(circle);
        let count = |bulge: Self| {
            edges.iter().filter(|edge| bulge.off(circle, edge.at).abs() < NEAR * unit).count()
        };
        // Steps of a unit, so that no edge is passed over.
        let steps = (MOST * circle.radius / unit).min(reach - NEAR) as usize;
        let bulges = (1..=steps).flat_map(|step| {
            (0..DIRECTIONS).map(move |direction| {
                let towards = geometry::unit(TAU * direction as f64 / DIRECTIONS as f64);
                Self(step as f64 * unit * towards)
            })
        });
        let best = bulges.map(|bulge| (count(bulge), bulge)).max_by_key(|&(count, _)| count);
        let enough = (CLEARLY_MORE * count(Self::NONE) as f64).max(least);
        best.filter(|&(count, _)| count as f64 > enough).map_or(Self::NONE, |(_, bulge)| bulge)
    }

    /// The distance of a point outside of the curve; negative inside.
    pub(super) fn off(self, circle: &Circle, at: Point2<f64>) -> f64 {
        circle.off(at) - self.at(at - circle.centre)
    }

    /// A point as it would be without the bulge.
    pub(super) fn without(self, circle: &Circle, at: Point2<f64>) -> Point2<f64> {
        let out = at - circle.centre;
        at - self.at(out) / out.norm().max(1.0) * out
    }

    /// The bulge in a direction: with its cosine and sine, those of twice the angle.
    fn at(self, out: Vector2<f64>) -> f64 {
        let square = out.norm_squared().max(1.0);
        let [x, y] = out.into();
        (self.0.x * (x * x - y * y) + self.0.y * 2.0 * x * y) / square
    }
}
