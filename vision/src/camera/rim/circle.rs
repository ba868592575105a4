//! Circles, and the circle through points with outliers.

use crate::{camera::length, least_squares::NormalEquations};

/// A circle in an image, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Circle {
    pub(super) centre: [f64; 2],
    pub(super) radius: f64,
}

impl Circle {
    /// The distance of a point outside of the circle; negative inside.
    pub(super) fn off(&self, at: [f64; 2]) -> f64 {
        length([at[0] - self.centre[0], at[1] - self.centre[1]]) - self.radius
    }

    /// The same circle in an image in which each pixel is this many here.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        let centre = self.centre.map(|at| (at + 0.5) * factor - 0.5);
        Self { centre, radius: self.radius * factor }
    }

    /// Whether the circles differ by at most this part of the radius in their centre, and in their radius.
    pub(super) fn is_near(&self, other: &Self, part: f64) -> bool {
        let [across, down] = [0, 1].map(|axis| self.centre[axis] - other.centre[axis]);
        let near = part * self.radius.max(other.radius);
        length([across, down]) <= near && (self.radius - other.radius).abs() <= near
    }

    /// The circle that fits points with outliers best: least squares, weighted by Tukey's function.
    pub(super) fn through(self, places: &[[f64; 2]]) -> Self {
        let mut circle = self;
        for _ in 0..30 {
            let mut sizes: Vec<f64> = places.iter().map(|&place| circle.off(place).abs()).collect();
            sizes.sort_by(f64::total_cmp);
            let Some(median) = sizes.get(sizes.len() / 2) else { return self };
            let far = (4.685 * 1.4826 * median).max(0.5);
            let mut equations = NormalEquations::<3>::with_pull(0.0);
            for &place in places {
                let off = circle.off(place);
                if off.abs() < far {
                    let weight = (1.0 - (off / far).powi(2)).powi(2);
                    let [across, down] = [0, 1].map(|axis| place[axis] - circle.centre[axis]);
                    let from_centre = length([across, down]).max(1.0);
                    let slope = [across / from_centre, down / from_centre, 1.0];
                    equations.add(weight, slope, off);
                }
            }
            let Some(step) = equations.solve() else { return circle };
            circle.centre = [circle.centre[0] + step[0], circle.centre[1] + step[1]];
            circle.radius += step[2];
            if step.iter().map(|part| part * part).sum::<f64>().sqrt() < 1e-6 {
                break;
            }
        }
        circle
    }
}
