//! The mirror's rim in images: a circle with an edge all along it.
//!
//! The images are averaged, which leaves little of the scene; the edge may be of either sign. Of a dark ring around
//! the mirror, the rim is the inner border. No circle is better than a wrong one: the rim must be seen on enough
//! bearings, no other circle may be seen about as well, and it must stay the same if any part of it is left out.
//!
//! Lengths are in pixels. A *unit* is a pixel in a circle of radius 450, and more in a larger one. Brightness is that of
//! images whose mean is 64.

mod brightness;
mod circle;
mod edges;
mod search;

use std::f64::consts::TAU;

use image::GrayImage;
use nalgebra::{Point2, distance};
use thiserror::Error;

use brightness::Brightness;
use circle::Circle;
use edges::{BEARINGS, CircleEdge, CircleEdges, unit};

use crate::{geometry, least_squares::median};

/// Edges are searched for up to this many units from a circle, ... Views.
const REACH: f64 = 8.0;
/// ... and the steepest one must be within this many. Views.
const NEAR: f64 = 1.0;
/// The least part of the full circle that must be seen. Views.
const LEAST_SEEN: f64 = 0.14;
/// The least part of the circle in the image that must be seen. Views.
const LEAST_OF_VISIBLE: f64 = 0.45;
/// The least part of the edges that must be brighter inside than outside. Views.
const LEAST_FALLS: f64 = 0.15;
/// Another circle must have less than this part of the rim's score. Views.
const LEAD: f64 = 0.6;
/// Circles that differ by less, as a part of the radius, are the same. Geometry: a calibration allows the rim to be off
/// by 2 %.
const SAME: f64 = 0.02;
/// The greatest change of centre and radius if a part of what is seen is left out, as a part of the radius. Views.
const CERTAIN: f64 = 0.01;
/// The number of parts of which each is left out once. Views.
const PARTS: usize = 8;
/// The number of directions in which other circles that share an arc are tried. Views.
const SIDES: usize = 12;
/// A dark ring around the mirror is at most this part of the outer radius wide. Views.
const WIDEST_RING: f64 = 0.12;
/// The inner border of a dark ring is seen on at least this part of the bearings of the outer one. Views.
const LEAST_INNER: f64 = 0.25;
/// Smaller differences of brightness are noise. Views.
const NOISE: f64 = 6.0;
/// Many circles are compared on one bearing in this many. Views: faster, with the same results.
const EVERY: usize = 4;

#[derive(Clone, Debug, PartialEq)]
pub struct Rim {
    pub centre: Point2<f64>,
    pub radius: f64,
    /// The share of the full circle that was seen.
    pub seen: f64,
    /// The root mean square distance of its points from the circle, in pixels.
    pub spread: f64,
    pub places: Vec<Point2<f64>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum RimError {
    #[error("there is no image")]
    NoImage,
    #[error(
        "image {number} is {} by {} pixels, the first is {} by {}",
        .found[0], .found[1], .expected[0], .expected[1]
    )]
    Sizes { number: usize, found: [u32; 2], expected: [u32; 2] },
    #[error("the images are {} by {} pixels, too few to find a mirror", .0[0], .0[1])]
    TooSmall([u32; 2]),
    #[error(
        "no mirror is seen in the images: no circle has an edge along enough of its circumference"
    )]
    NoRim,
    #[error(
        "the rim is not certain: a circle of radius {:.0} around {:.0}, {:.0} is seen about as well as \
         one of radius {:.0} around {:.0}, {:.0}",
        .other[2], .other[0], .other[1], .best[2], .best[0], .best[1]
    )]
    Ambiguous { best: [f64; 3], other: [f64; 3] },
    #[error(
        "the rim is not certain: an edge is seen along {:.0} % of a circle of radius {:.0}, which does \
         not give its radius within {} %", 100.0 * .seen, .radius, 100.0 * CERTAIN
    )]
    Uncertain { radius: f64, seen: f64 },
}

/// The rim in images of one camera.
///
/// # Errors
/// Returns an error if there is none, if it is not certain, or if the images differ in size.
pub fn find(images: &[GrayImage]) -> Result<Rim, RimError> {
    let mean = Brightness::mean(images)?;
    let mut fits: Vec<CircleFit> = search::candidates(&mean)
        .into_iter()
        .map(|circle| CircleFit::fitted(&mean, circle, EVERY))
        .collect();
    fits.retain(|fit| fit.is_plausible(&mean));
    fits.sort_by(|one, other| other.score().total_cmp(&one.score()));
    let first = fits.first().ok_or(RimError::NoRim)?.circle;
    let best = CircleFit::fitted(&mean, first, 1);
    if !best.is_seen() {
        return Err(RimError::NoRim);
    }
    let rim = best.inside_of_ring(&mean).unwrap_or_else(|| best.clone());
    if rim.falls() < LEAST_FALLS {
        return Err(RimError::NoRim);
    }
    let is_ring = rim.circle != best.circle;
    // The inner border of a ring must be seen as well as any rim: dark furniture has an edge, too.
    // Of a narrow ring, both borders are near enough.
    let is_narrow = rim.circle.is_near(&best.circle, SAME);
    if is_ring && !is_narrow && rim.seen < LEAST_SEEN {
        return Err(ambiguous(&best.circle, &rim.circle));
    }
    let is_other = |fit: &CircleFit| {
        !fit.circle.is_near(&rim.circle, SAME)
            && !fit.circle.is_near(&best.circle, SAME)
            && fit.score() > LEAD * best.score()
            && !fit.is_outside_of_ring(&mean, &rim.circle)
    };
    if let Some(other) = fits.iter().find(|fit| is_other(fit)) {
        return Err(ambiguous(&best.circle, &other.circle));
    }
    if (!is_ring || is_narrow)
        && let Some(other) = best.beside(&mean).into_iter().find(is_other)
    {
        return Err(ambiguous(&best.circle, &other.circle));
    }
    if !best.is_certain() {
        return Err(RimError::Uncertain { radius: rim.circle.radius, seen: best.seen });
    }
    Ok(rim.rim())
}

fn ambiguous(best: &Circle, other: &Circle) -> RimError {
    let numbers = |circle: &Circle| [circle.centre.x, circle.centre.y, circle.radius];
    RimError::Ambiguous { best: numbers(best), other: numbers(other) }
}

/// What is seen of a rim that is given: its centre and its radius, in pixels.
///
/// # Errors
/// Returns an error if there is no image, or if the images differ in size.
pub fn given(images: &[GrayImage], centre: Point2<f64>, radius: f64) -> Result<Rim, RimError> {
    let mean = Brightness::mean(images)?;
    let circle = Circle { centre, radius };
    // What is given by hand is not exact.
    let near = 0.01 * radius;
    let edges = CircleEdges::near(&mean, &circle, (near / unit(&circle)).max(REACH), 1);
    let on = edges.edges.into_iter().filter(|edge| circle.off(edge.at).abs() < near.max(1.5));
    let edges: Vec<CircleEdge> = on.collect();
    let seen = edges.len() as f64 / BEARINGS as f64;
    Ok(CircleFit { circle, edges, seen, visible: 1.0 }.rim())
}

#[derive(Clone, Debug)]
struct CircleFit {
    circle: Circle,
    edges: Vec<CircleEdge>,
    seen: f64,
    /// The share of the full circle that is in the image.
    visible: f64,
}

impl CircleFit {
    /// The circle through the edges near a circle, on one bearing in `every`.
    fn fitted(image: &Brightness, mut circle: Circle, every: usize) -> Self {
        for reach in [6.0, 4.0, 4.0] {
            let places = CircleEdges::near(image, &circle, reach, every).places();
            circle = circle.through(&places);
        }
        let mut fit = Self::on(image, circle, every);
        // Once more, without the edges that are not on the circle.
        let places: Vec<_> = fit.edges.iter().map(|edge| edge.at).collect();
        if places.len() >= PARTS {
            fit = Self::on(image, circle.through(&places), every);
        }
        fit
    }

    /// A circle and the edges on it, on one bearing in `every`.
    fn on(image: &Brightness, circle: Circle, every: usize) -> Self {
        let found = CircleEdges::near(image, &circle, REACH, every);
        let near = NEAR * unit(&circle);
        let on = found.edges.into_iter().filter(|edge| circle.off(edge.at).abs() < near);
        let edges: Vec<CircleEdge> = on.collect();
        let all = (BEARINGS / every) as f64;
        let (seen, visible) = (edges.len() as f64 / all, found.visible as f64 / all);
        Self { circle, edges, seen, visible }
    }

    /// Whether it can be a mirror: its centre is in the image, and it is neither small nor huge.
    fn is_plausible(&self, image: &Brightness) -> bool {
        let Circle { centre, radius } = self.circle;
        let (width, height) = (image.width as f64, image.height as f64);
        (0.0..width).contains(&centre.x)
            && (0.0..height).contains(&centre.y)
            && (0.2 * width.min(height)..0.75 * width.max(height)).contains(&radius)
    }

    fn is_seen(&self) -> bool {
        self.seen >= LEAST_SEEN && self.seen >= LEAST_OF_VISIBLE * self.visible
    }

    /// How well it is seen: on many bearings, and on most of those on which it is in the image.
    fn score(&self) -> f64 {
        self.seen * self.seen / self.visible.max(LEAST_SEEN)
    }

    /// The part of its edges that are brighter inside than outside.
    fn falls(&self) -> f64 {
        let falls = self.edges.iter().filter(|edge| edge.fall > 0.0).count();
        falls as f64 / self.edges.len().max(1) as f64
    }

    /// If this is the outer border of a dark ring, the inner one.
    ///
    /// Only its radius is fitted: the centre is that of the outer border, which is seen better.
    fn inside_of_ring(&self, image: &Brightness) -> Option<Self> {
        let outer = self.circle.radius;
        let widths =
            (1..).map(|step| f64::from(step) * 0.004).take_while(|&part| part <= WIDEST_RING);
        let inner = widths.filter_map(|part| {
            let circle = Circle { radius: outer * (1.0 - part), ..self.circle };
            let edges = CircleEdges::near(image, &circle, 3.0, EVERY).edges;
            let falls = edges.iter().filter(|edge| edge.fall > 0.0);
            let radius = circle.radius + median(falls.map(|edge| circle.off(edge.at)))?;
            let fit = Self::on(image, Circle { radius, ..circle }, EVERY);
            let apart = outer - radius > 4.0 * unit(&circle);
            let is_inner = apart
                && fit.seen >= LEAST_INNER * self.seen
                && fit.falls() >= 0.6
                && is_dark_between(image, &fit.circle, &self.circle);
            is_inner.then_some(fit)
        });
        let best = inner.max_by(|one, other| one.seen.total_cmp(&other.seen))?;
        Some(Self::on(image, best.circle, 1))
    }

    /// Whether this is the outer border of a dark ring around a circle.
    fn is_outside_of_ring(&self, image: &Brightness, inner: &Circle) -> bool {
        let width = self.circle.radius - inner.radius;
        distance(&self.circle.centre, &inner.centre) <= SAME * inner.radius
            && width > 0.0
            && width <= WIDEST_RING * self.circle.radius
            && is_dark_between(image, inner, &self.circle)
    }

    /// The circles that share an arc with this one, and are nearer or farther on the opposite side: if it is
    /// the inner border of a ring on one side and the outer border on the other, they are the borders.
    fn beside(&self, image: &Brightness) -> Vec<Self> {
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
                    fits.push(Self::on(image, Self::fitted(image, circle, EVERY).circle, EVERY));
                }
            }
        }
        fits
    }

    /// Whether centre and radius stay the same if any part of the edges is left out.
    fn is_certain(&self) -> bool {
        let count = self.edges.len();
        (0..PARTS).all(|part| {
            let (from, to) = (part * count / PARTS, (part + 1) * count / PARTS);
            let rest = self.edges[..from].iter().chain(&self.edges[to..]);
            let places: Vec<_> = rest.map(|edge| edge.at).collect();
            self.circle.through(&places).is_near(&self.circle, CERTAIN)
        })
    }

    fn rim(&self) -> Rim {
        let places: Vec<_> = self.edges.iter().map(|edge| edge.at).collect();
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

/// Whether the ring between two circles can be a mirror's dark holder: on most bearings it is equally
/// dark, and not brighter than what is outside of it.
fn is_dark_between(image: &Brightness, inner: &Circle, outer: &Circle) -> bool {
    let (mut rings, mut darker) = (Vec::new(), 0_usize);
    for bearing in (0..BEARINGS).step_by(EVERY) {
        let towards = geometry::unit(TAU * bearing as f64 / BEARINGS as f64);
        let at = |radius: f64| image.at(outer.centre + radius * towards);
        let width = outer.radius - inner.radius;
        let samples = [0.5, 1.5].map(|part| at(inner.radius + part * width));
        if let [Some(ring), Some(outside)] = samples {
            rings.push(ring);
            darker += usize::from(ring < outside + NOISE);
        }
    }
    let median = median(rings.iter().copied()).unwrap_or_default();
    let even = |ring: &&f64| (**ring - median).abs() < NOISE + 0.25 * median;
    let most = |count: usize| count as f64 > 0.75 * rings.len() as f64;
    most(darker) && most(rings.iter().filter(even).count())
}
