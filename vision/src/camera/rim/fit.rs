//! A circle and the edges on it.

use std::f64::consts::TAU;

use nalgebra::Point2;

use super::{
    Rim,
    brightness::Brightness,
    bulge::Bulge,
    circle::Circle,
    edges::{BEARINGS, CircleEdge, CircleEdges, unit},
};
use crate::geometry;

/// Edges are searched for up to this many units from a circle, ... Views.
pub(super) const REACH: f64 = 8.0;
/// ... and the steepest one must be within this many. Views.
const NEAR: f64 = 1.0;
/// The least part of the full circle by which what is in the image counts. Views.
const LEAST_VISIBLE: f64 = 0.14;
/// The least part of the full circle on which a bulge is seen. Geometry: on an arc, any centre has one that fits.
const LEAST_BULGING: f64 = 0.6;
/// The greatest change of centre and radius if a part of what is seen is left out, as a part of the radius. Views.
pub(super) const CERTAIN: f64 = 0.01;
/// The number of parts of which each is left out once. Views.
const PARTS: usize = 8;
/// The number of directions in which other circles that share an arc are tried. Views.
const SIDES: usize = 12;
/// Many circles are compared on one bearing in this many. Views: faster, with the same results.
pub(super) const EVERY: usize = 4;
/// The number of parts of a circle in which its edges are counted. Views.
const SECTORS: usize = 32;

#[derive(Clone, Debug)]
pub(super) struct CircleFit {
    pub(super) circle: Circle,
    pub(super) bulge: Bulge,
    pub(super) edges: Vec<CircleEdge>,
    pub(super) seen: f64,
    /// The share of the full circle that is in the image.
    pub(super) visible: f64,
}

impl CircleFit {
    /// The circle through the edges near a circle, on one bearing in `every`.
    pub(super) fn fitted(image: &Brightness, mut circle: Circle, every: usize) -> Self {
        for reach in [6.0, 4.0, 4.0] {
            let places = CircleEdges::near(image, &circle, reach, every).places();
            circle = circle.through(&places);
        }
        Self::on(image, circle, REACH, every).refitted(image, REACH, every)
    }

    /// The circle through the edges on this one, and the edges on it.
    pub(super) fn refitted(self, image: &Brightness, reach: f64, every: usize) -> Self {
        let places = self.round_places();
        if places.len() < PARTS {
            return self;
        }
        Self::on(image, self.circle.through(&places), reach, every)
    }

    /// A circle and the edges on it: the steepest ones at most `reach` units from it, on one bearing in `every`.
    pub(super) fn on(image: &Brightness, circle: Circle, reach: f64, every: usize) -> Self {
        let found = CircleEdges::near(image, &circle, reach, every);
        let all = (BEARINGS / every) as f64;
        let bulge = Bulge::of(&circle, &found.edges, reach, LEAST_BULGING * all);
        let near = NEAR * unit(&circle);
        let is_on = |edge: &CircleEdge| bulge.off(&circle, edge.at).abs() < near;
        let edges: Vec<CircleEdge> = found.edges.into_iter().filter(is_on).collect();
        let (seen, visible) = (edges.len() as f64 / all, found.visible as f64 / all);
        Self { circle, bulge, edges, seen, visible }
    }

    /// The distance of a point outside of the curve that was fitted; negative inside.
    pub(super) fn off(&self, at: Point2<f64>) -> f64 {
        self.bulge.off(&self.circle, at)
    }

    /// Whether it can be a mirror: its centre is in the image, and it is neither small nor huge.
    pub(super) fn is_plausible(&self, image: &Brightness) -> bool {
        let Circle { centre, radius } = self.circle;
        let (width, height) = (image.width as f64, image.height as f64);
        (0.0..width).contains(&centre.x)
            && (0.0..height).contains(&centre.y)
            && (0.2 * width.min(height)..0.75 * width.max(height)).contains(&radius)
    }

    /// How well it is seen: on many bearings, and on most of those on which it is in the image.
    pub(super) fn score(&self) -> f64 {
        self.seen * self.share()
    }

    /// The part of the circle in the image that is seen.
    pub(super) fn share(&self) -> f64 {
        self.seen / self.visible.max(LEAST_VISIBLE)
    }

    /// The part of the full circle that is brighter inside than outside.
    pub(super) fn falling(&self) -> f64 {
        let falls = self.edges.iter().filter(|edge| edge.fall > 0.0).count();
        self.seen * falls as f64 / self.edges.len().max(1) as f64
    }

    /// Whether a good part of its edges are on another circle, too.
    pub(super) fn is_part_of(&self, other: &Self) -> bool {
        let near = 1.5 * unit(&other.circle);
        let common = self.edges.iter().filter(|edge| other.off(edge.at).abs() < near);
        4 * common.count() > self.edges.len()
    }

    /// The part of the sectors in the image in which it is seen: an arc is in few of them.
    pub(super) fn spread_over(&self, image: &Brightness) -> f64 {
        let (mut inside, mut on) = ([0_usize; SECTORS], [0_usize; SECTORS]);
        let bearings = BEARINGS / EVERY;
        for bearing in 0..bearings {
            let towards = geometry::unit(TAU * bearing as f64 / bearings as f64);
            let is_inside = image.contains(self.circle.centre + self.circle.radius * towards);
            inside[bearing * SECTORS / bearings] += usize::from(is_inside);
        }
        for edge in &self.edges {
            let turn = geometry::angle(edge.at - self.circle.centre) / TAU;
            let sector = (turn.rem_euclid(1.0) * SECTORS as f64) as usize;
            on[sector.min(SECTORS - 1)] += 1;
        }
        // A sector counts if a good part of it is in the image.
        let counted = (0..SECTORS).filter(|&sector| 4 * SECTORS * inside[sector] > bearings);
        let is_seen = |sector: &usize| 4 * on[*sector] >= inside[*sector];
        let seen = counted.clone().filter(is_seen).count();
        seen as f64 / counted.count().max(1) as f64
    }

    /// The circles that share an arc with this one, and are nearer or farther on the opposite side: if it is
    /// the inner border of a ring on one side and the outer border on the other, they are the borders.
    pub(super) fn beside(&self, image: &Brightness) -> Vec<Self> {
        let Circle { centre, radius } = self.circle;
        let mut fits = Vec::new();
        for side in 0..SIDES {
            let towards = geometry::unit(TAU * side as f64 / SIDES as f64);
            for step in 1..=6 {
                for sign in [-1.0, 1.0] {
                    // Half of the difference between the borders, and the same arc on this side.
                    let shift = 0.01 * f64::from(step) * radius * sign;
                    let centre = centre - shift * towards;
                    let circle = Circle { centre, radius: radius + shift };
                    fits.push(Self::fitted(image, circle, EVERY));
                }
            }
        }
        fits
    }

    /// Whether centre and radius stay the same if any part of the edges is left out.
    pub(super) fn is_certain(&self) -> bool {
        let places = self.round_places();
        let count = places.len();
        (0..PARTS).all(|part| {
            let (from, to) = (part * count / PARTS, (part + 1) * count / PARTS);
            let rest = [&places[..from], &places[to..]].concat();
            self.circle.through(&rest).is_near(&self.circle, CERTAIN)
        })
    }

    /// The edges as they would be without the bulge.
    fn round_places(&self) -> Vec<Point2<f64>> {
        let Self { circle, bulge, .. } = self;
        self.edges.iter().map(|edge| bulge.without(circle, edge.at)).collect()
    }

    fn places(&self) -> Vec<Point2<f64>> {
        self.edges.iter().map(|edge| edge.at).collect()
    }

    pub(super) fn rim(&self) -> Rim {
        let places = self.places();
        let squares: f64 = places.iter().map(|&place| self.circle.off(place).powi(2)).sum();
        Rim {
            centre: self.circle.centre,
            radius: self.circle.radius,
            seen: self.seen,
            spread: (squares / places.len().max(1) as f64).sqrt(),
            places,
        }
    }
}
