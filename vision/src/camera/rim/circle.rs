//! Circles, and the circle through points with outliers.

use nalgebra::{Point2, Vector3, distance};

use crate::{
    camera::scaled_place,
    least_squares::{NormalEquations, median},
};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Circle {
    pub(super) centre: Point2<f64>,
    pub(super) radius: f64,
}

impl Circle {
    /// The distance of a point outside of the circle; negative inside.
    pub(super) fn off(&self, at: Point2<f64>) -> f64 {
        distance(&at, &self.centre) - self.radius
    }

    /// The same circle in an image in which each pixel is this many here.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self { centre: scaled_place(self.centre, factor), radius: self.radius * factor }
    }

    /// The circle between this one, at 0, and another one, at 1.
    pub(super) fn towards(&self, other: &Self, part: f64) -> Self {
        Self {
            centre: self.centre + part * (other.centre - self.centre),
            radius: self.radius + part * (other.radius - self.radius),
        }
    }

    /// Whether the circles differ by at most this part of the radius in their centre, and in their radius.
    pub(super) fn is_near(&self, other: &Self, part: f64) -> bool {
        let near = part * self.radius.max(other.radius);
        distance(&self.centre, &other.centre) <= near && (self.radius - other.radius).abs() <= near
    }

    /// The circle that fits points with outliers best: least squares, weighted by Tukey's function.
    pub(super) fn through(self, places: &[Point2<f64>]) -> Self {
        let mut circle = self;
        for _ in 0..30 {
            let sizes = places.iter().map(|&place| circle.off(place).abs());
            let Some(median) = median(sizes) else { return self };
            let far = (4.685 * 1.4826 * median).max(0.5);
            let mut equations = NormalEquations::<3>::with_pull(0.0);
            for &place in places {
                let off = circle.off(place);
                if off.abs() < far {
                    let weight = (1.0 - (off / far).powi(2)).powi(2);
                    let from_centre = place - circle.centre;
                    let slope = from_centre / from_centre.norm().max(1.0);
                    equations.add(weight, [slope.x, slope.y, 1.0], off);
                }
            }
            let Some(step) = equations.solve().map(Vector3::from) else { return circle };
            circle.centre += step.xy();
            circle.radius += step.z;
            if step.norm() < 1e-6 {
                break;
            }
        }
        circle
    }
}
