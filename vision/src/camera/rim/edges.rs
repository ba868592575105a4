//! The edges of an image along a circle: on each bearing the steepest one near the circle, of either
//! sign.

use std::f64::consts::TAU;

use nalgebra::{Point2, UnitComplex, Vector2};

use super::{brightness::Brightness, circle::Circle};

/// On bearings, an edge is the difference between means over this number of half units, inside and outside. Geometry:
/// the blur of an edge.
const WIDE: usize = 5;
/// The least height of an edge. Views: less is noise.
const LEAST_EDGE: f64 = 3.0;
/// The radius at which a unit is a pixel. Geometry: the rim in images of 1280 by 960 pixels.
const UNIT_RADIUS: f64 = 450.0;

/// The number of bearings on which edges are searched for.
pub(super) const BEARINGS: usize = 1440;

/// The places of an arc over which brightness is averaged, along the circle, in units.
pub(super) const ARC: [f64; 7] = [-6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0];

#[derive(Clone, Copy, Debug)]
pub(super) struct CircleEdge {
    pub(super) at: Point2<f64>,
    pub(super) fall: f64,
}

pub(super) struct CircleEdges {
    pub(super) edges: Vec<CircleEdge>,
    pub(super) visible: usize,
}

pub(super) fn unit(circle: &Circle) -> f64 {
    (circle.radius / UNIT_RADIUS).max(1.0)
}

impl CircleEdges {
    /// On one bearing in `every`, the steepest edge at most `reach` units from a circle.
    pub(super) fn near(image: &Brightness, circle: &Circle, reach: f64, every: usize) -> Self {
        let unit = unit(circle);
        let steps = (2.0 * reach) as usize + WIDE;
        let (mut edges, mut visible) = (Vec::new(), 0);
        for bearing in (0..BEARINGS).step_by(every) {
            let turn = UnitComplex::new(TAU * bearing as f64 / BEARINGS as f64);
            let place = |step: usize, along: f64| {
                let out = circle.radius + 0.5 * unit * (step as f64 - steps as f64);
                circle.centre + turn * Vector2::new(out, along * unit)
            };
            // The image is convex: if the corners of a rectangle are in it, all of the rectangle is.
            let is_inside = [0, 2 * steps].iter().all(|&step| {
                [ARC[0], ARC[6]].iter().all(|&along| image.contains(place(step, along)))
            });
            // The mean over a short arc, from inside to outside in half units.
            let ring = |step: usize| {
                let places = ARC.iter().map(|&along| place(step, along));
                let sum = if is_inside {
                    Some(places.map(|place| image.between(place)).sum::<f64>())
                } else {
                    places.map(|place| image.at(place)).sum()
                };
                sum.map(|sum| sum / ARC.len() as f64)
            };
            let profile: Vec<Option<f64>> = (0..=2 * steps).map(ring).collect();
            visible +=
                usize::from(profile[steps - WIDE..=steps + WIDE].iter().all(Option::is_some));
            let mean = |from: usize| {
                let sum: Option<f64> = profile[from..from + WIDE].iter().copied().sum();
                sum.map(|sum| sum / WIDE as f64)
            };
            let fall = |at: usize| Some(mean(at - WIDE)? - mean(at + 1)?);
            let height = |at: usize| fall(at).map_or(0.0, f64::abs);
            let steepest = (WIDE..profile.len() - WIDE)
                .max_by(|&one, &other| height(one).total_cmp(&height(other)));
            let Some(steepest) = steepest.filter(|&at| height(at) >= LEAST_EDGE) else {
                continue;
            };
            if steepest == WIDE || steepest + WIDE + 1 == profile.len() {
                continue;
            }
            // Interpolated between the half units: the top of a parabola.
            let [before, top, after] = [steepest - 1, steepest, steepest + 1].map(height);
            let curve = before - 2.0 * top + after;
            let shift = if curve < 0.0 { 0.5 * (before - after) / curve } else { 0.0 };
            let step = steepest as f64 - steps as f64 + shift.clamp(-1.0, 1.0);
            let radius = circle.radius + 0.5 * unit * step;
            let at = circle.centre + turn * Vector2::new(radius, 0.0);
            edges.push(CircleEdge { at, fall: fall(steepest).unwrap_or_default() });
        }
        Self { edges, visible }
    }

    pub(super) fn places(&self) -> Vec<Point2<f64>> {
        self.edges.iter().map(|edge| edge.at).collect()
    }
}
