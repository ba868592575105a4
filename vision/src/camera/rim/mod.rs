//! The mirror's rim in images: a circle with an edge all along it.
//!
//! The images are averaged, which leaves little of the scene; the edge may be of either sign. Of a dark ring around
//! the mirror, the rim is the inner border. No circle is better than a wrong one: the rim must be seen on enough
//! bearings, no other circle may be seen about as well, and it must stay the same if any part of it is left out.

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

use super::params::RimParams;
use crate::geometry;

#[derive(Clone, Debug, PartialEq)]
pub struct Rim {
    /// Its centre, in pixels.
    pub centre: Point2<f64>,
    /// Its radius, in pixels.
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
         not give its radius within {} %", 100.0 * .seen, .radius, 100.0 * RIM.certain
    )]
    Uncertain { radius: f64, seen: f64 },
}

const RIM: RimParams = RimParams::DEFAULT;

/// The rim in images of one camera.
///
/// # Errors
/// Returns an error if there is none, if it is not certain, or if the images differ in size.
pub fn find(images: &[GrayImage]) -> Result<Rim, RimError> {
    let mean = Brightness::mean(images)?;
    let mut fits: Vec<CircleFit> = search::candidates(&mean)
        .into_iter()
        .map(|circle| CircleFit::near(&mean, circle))
        .collect();
    fits.retain(|fit| fit.is_plausible(&mean));
    fits.sort_by(|one, other| other.score().total_cmp(&one.score()));
    let first = fits.first().ok_or(RimError::NoRim)?.circle;
    let best = CircleFit::exact(&mean, first);
    if !best.is_seen() {
        return Err(RimError::NoRim);
    }
    let rim = best.inside_of_ring(&mean).unwrap_or_else(|| best.clone());
    if rim.falls() < RIM.least_falls {
        return Err(RimError::NoRim);
    }
    let is_ring = rim.circle != best.circle;
    // The inner border of a ring must be seen as well as any rim: dark furniture has an edge, too.
    // Of a narrow ring, both borders are near enough.
    let is_narrow = rim.circle.is_near(&best.circle, RIM.same);
    if is_ring && !is_narrow && rim.seen < RIM.least_seen {
        return Err(ambiguous(&best.circle, &rim.circle));
    }
    let is_other = |fit: &CircleFit| {
        !fit.circle.is_near(&rim.circle, RIM.same)
            && !fit.circle.is_near(&best.circle, RIM.same)
            && fit.score() > RIM.lead * best.score()
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
    let edges = CircleEdges::near(&mean, &circle, (near / unit(&circle)).max(RIM.reach), 1);
    let seen = edges.edges.into_iter().filter(|edge| circle.off(edge.at).abs() < near.max(1.5));
    Ok(CircleFit::of(circle, seen.collect()).rim())
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
    fn of(circle: Circle, edges: Vec<CircleEdge>) -> Self {
        let seen = edges.len() as f64 / BEARINGS as f64;
        Self { circle, edges, seen, visible: 1.0 }
    }

    /// The circle through the edges near a circle; on some of the bearings only.
    fn near(image: &Brightness, circle: Circle) -> Self {
        Self::fitted(image, circle, RIM.every)
    }

    fn exact(image: &Brightness, circle: Circle) -> Self {
        Self::fitted(image, circle, 1)
    }

    fn fitted(image: &Brightness, mut circle: Circle, every: usize) -> Self {
        for reach in [6.0, 4.0, 4.0] {
            let places = CircleEdges::near(image, &circle, reach, every).places();
            circle = circle.through(&places);
        }
        let mut fit = Self::on(image, circle, every);
        // Once more, without the edges that are not on the circle.
        let places: Vec<_> = fit.edges.iter().map(|edge| edge.at).collect();
        if places.len() >= RIM.parts {
            fit = Self::on(image, circle.through(&places), every);
        }
        fit
    }

    /// A circle and the edges on it, on one bearing in `every`.
    fn on(image: &Brightness, circle: Circle, every: usize) -> Self {
        let found = CircleEdges::near(image, &circle, RIM.reach, every);
        let near = RIM.near * unit(&circle);
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
        self.seen >= RIM.least_seen && self.seen >= RIM.least_of_visible * self.visible
    }

    /// How well it is seen: on many bearings, and on most of those on which it is in the image.
    fn score(&self) -> f64 {
        self.seen * self.seen / self.visible.max(RIM.least_seen)
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
            (1..).map(|step| f64::from(step) * 0.004).take_while(|&part| part <= RIM.widest_ring);
        let inner = widths.filter_map(|part| {
            let circle = Circle { radius: outer * (1.0 - part), ..self.circle };
            let edges = CircleEdges::near(image, &circle, 3.0, RIM.every).edges;
            let mut off: Vec<f64> = edges
                .iter()
                .filter(|edge| edge.fall > 0.0)
                .map(|edge| circle.off(edge.at))
                .collect();
            off.sort_by(f64::total_cmp);
            let radius = circle.radius + off.get(off.len() / 2)?;
            let fit = Self::on(image, Circle { radius, ..circle }, RIM.every);
            let apart = outer - radius > 4.0 * unit(&circle);
            let is_inner = apart
                && fit.seen >= RIM.least_inner * self.seen
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
        distance(&self.circle.centre, &inner.centre) <= RIM.same * inner.radius
            && width > 0.0
            && width <= RIM.widest_ring * self.circle.radius
            && is_dark_between(image, inner, &self.circle)
    }

    /// The circles that share an arc with this one, and are nearer or farther on the opposite side: if it is
    /// the inner border of a ring on one side and the outer border on the other, they are the borders.
    fn beside(&self, image: &Brightness) -> Vec<Self> {
        let Circle { centre, radius } = self.circle;
        let mut fits = Vec::new();
        for side in 0..RIM.sides {
            let towards = geometry::unit(TAU * side as f64 / RIM.sides as f64);
            for step in 1..=6 {
                for sign in [-1.0, 1.0] {
                    // Half of the difference between the borders, and the same arc on this side.
                    let shift = 0.01 * f64::from(step) * radius * sign;
                    let centre = centre - shift * towards;
                    let circle = Circle { centre, radius: radius + shift };
                    fits.push(Self::on(
                        image,
                        Self::fitted(image, circle, RIM.every).circle,
                        RIM.every,
                    ));
                }
            }
        }
        fits
    }

    /// Whether centre and radius stay the same if any part of the edges is left out.
    fn is_certain(&self) -> bool {
        let count = self.edges.len();
        (0..RIM.parts).all(|part| {
            let (from, to) = (part * count / RIM.parts, (part + 1) * count / RIM.parts);
            let rest = self.edges[..from].iter().chain(&self.edges[to..]);
            let places: Vec<_> = rest.map(|edge| edge.at).collect();
            self.circle.through(&places).is_near(&self.circle, RIM.certain)
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
    for bearing in (0..BEARINGS).step_by(RIM.every) {
        let towards = geometry::unit(TAU * bearing as f64 / BEARINGS as f64);
        let at = |radius: f64| image.at(outer.centre + radius * towards);
        let width = outer.radius - inner.radius;
        let samples = [0.5, 1.5].map(|part| at(inner.radius + part * width));
        if let [Some(ring), Some(outside)] = samples {
            rings.push(ring);
            darker += usize::from(ring < outside + RIM.noise);
        }
    }
    rings.sort_by(f64::total_cmp);
    let median = rings.get(rings.len() / 2).copied().unwrap_or_default();
    let even = |ring: &&f64| (**ring - median).abs() < RIM.noise + 0.25 * median;
    let most = |count: usize| count as f64 > 0.75 * rings.len() as f64;
    most(darker) && most(rings.iter().filter(even).count())
}
