//! The mirror's rim in images: a circle with an edge all along it.
//!
//! The images are averaged, which leaves little of the scene; the edge may be of either sign. Of a narrow dark ring
//! around the mirror, and of a black one of any width, the rim is the inner border. Of other circles around one centre,
//! it is not known which one is the rim. No circle is better than a wrong one: the rim must be seen on enough bearings,
//! no other circle may be seen about as well, it must stay the same if any part of it is left out, and it must not be
//! smooth inside, as a holder is.
//!
//! Lengths are in pixels. A *unit* is a pixel in a circle of radius 450, and more in a larger one. Brightness is that
//! of images whose mean is 64.

mod brightness;
mod bulge;
mod circle;
mod edges;
mod fit;
mod rings;
mod roughness;
mod search;

use std::slice;

use image::GrayImage;
use nalgebra::Point2;
use thiserror::Error;

use brightness::Brightness;
use bulge::Bulge;
use circle::Circle;
use edges::{BEARINGS, CircleEdge, CircleEdges, unit};
use fit::{CERTAIN, CircleFit, EVERY, REACH};
use rings::InnerBorder;
use roughness::is_rough_inside;

/// The least part of the full circle that must be seen. Views.
const LEAST_SEEN: f64 = 0.14;
/// The least part of the circle in the image that must be seen, ... Views.
const LEAST_SHARE: f64 = 0.45;
/// ... and the least one of a circle whose score is so many times that of any other. Views.
const LEAST_LEADING: f64 = 0.3;
const CLEAR_LEAD: f64 = 3.0;
/// The least part of the edges that must be brighter inside than outside. Views.
const LEAST_FALLS: f64 = 0.15;
/// Another circle must have less than this part of the rim's score. Views.
const LEAD: f64 = 0.6;
/// Circles that differ by less, as a part of the radius, are the same. Geometry: a calibration allows the rim to be off
/// by 2 %.
const SAME: f64 = 0.02;
/// Of the circles that are searched, the best ones are fitted exactly. Views.
const KEPT: usize = 40;
/// The most circles that an error names.
const NAMED: usize = 3;

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

/// Why no rim is certain.
#[derive(Clone, Debug, PartialEq, Error)]
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
    #[error("no mirror is seen in the images: no circle has an edge along its circumference")]
    NoRim,
    /// Circles are centre and radius in pixels, the likeliest first.
    #[error("the rim is not certain: {doubt}")]
    Uncertain { doubt: RimDoubt, circles: Vec<[f64; 3]> },
}

/// What is uncertain about a rim.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum RimDoubt {
    #[error("no circle has an edge along enough of its circumference")]
    NoEdge,
    #[error("along the best circle it is darker inside than outside, as in a hole or a holder")]
    Dark,
    #[error(
        "the best circle and another one around the same centre may be the borders of a holder"
    )]
    Nested,
    #[error(
        "just inside of the best circle it is smooth, as a holder is; a mirror shows its surroundings there"
    )]
    Smooth,
    #[error("another circle is seen about as well as the best one")]
    Rival,
    #[error(
        "an edge is seen along {:.0} % of the best circle, which does not give its radius within {} %",
        100.0 * .0, 100.0 * CERTAIN
    )]
    Short(f64),
}

/// The rim in images of one camera.
///
/// # Errors
/// Returns an error if there is none, if it is not certain, or if the images differ in size.
pub fn find(images: &[GrayImage]) -> Result<Rim, RimError> {
    let mean = Brightness::mean(images)?;
    let mut fits = fits(&mean);
    let (mut first_doubt, mut named) = (None, Vec::new());
    while !fits.is_empty() {
        let leader = fits.remove(0);
        let found = rim(&mean, &leader, &fits, first_doubt.is_some());
        match found.and_then(|rim| with_surroundings(images, rim)) {
            // In a dark circle that may be the mirror, a disc may be the robot's body.
            Ok(rim) if named.iter().any(|dark: &Circle| dark.off(rim.circle.centre) < 0.0) => {
                named.push(rim.circle);
                break;
            }
            Ok(rim) => return Ok(rim.rim()),
            Err((doubt, circles)) => {
                first_doubt.get_or_insert(doubt);
                fits.retain(|fit| !circles.iter().any(|circle| fit.circle.is_near(circle, SAME)));
                named.extend(circles);
                // What is darker inside is no mirror, so it is no rival of one either.
                if !matches!(doubt, RimDoubt::Dark) {
                    break;
                }
            }
        }
    }
    if first_doubt != Some(RimDoubt::Nested) {
        named.extend(fits.iter().map(|fit| fit.circle));
    }
    let mut circles: Vec<Circle> = Vec::new();
    for circle in named {
        if !circles.iter().any(|other| other.is_near(&circle, 0.5 * SAME)) {
            circles.push(circle);
        }
    }
    circles.truncate(NAMED);
    let circles = circles.iter().map(|circle| [circle.centre.x, circle.centre.y, circle.radius]);
    let circles = circles.collect();
    Err(first_doubt.map_or(RimError::NoRim, |doubt| RimError::Uncertain { doubt, circles }))
}

/// The circles with the most edges, best first.
fn fits(image: &Brightness) -> Vec<CircleFit> {
    let fitted = |circles: Vec<Circle>, every: usize| {
        let fits = circles.into_iter().map(|circle| CircleFit::fitted(image, circle, every));
        let mut fits: Vec<CircleFit> = fits.filter(|fit| fit.is_plausible(image)).collect();
        fits.sort_by(|one, other| other.score().total_cmp(&one.score()));
        let mut kept: Vec<CircleFit> = Vec::new();
        for fit in fits {
            if !kept.iter().any(|other| fit.circle.is_near(&other.circle, 2e-3)) {
                kept.push(fit);
            }
        }
        kept
    };
    let mut roughly = fitted(search::candidates(image), 3 * EVERY);
    roughly.truncate(KEPT);
    fitted(roughly.iter().map(|fit| fit.circle).collect(), EVERY)
}

/// The rim if the best circle is its, or a doubt about that and the circles that may be the rim.
fn rim(
    image: &Brightness,
    leader: &CircleFit,
    others: &[CircleFit],
    is_second: bool,
) -> Result<CircleFit, (RimDoubt, Vec<Circle>)> {
    let best = CircleFit::fitted(image, leader.circle, 1);
    if best.seen < LEAST_SEEN || best.share() < LEAST_LEADING {
        return Err((RimDoubt::NoEdge, vec![best.circle]));
    }
    let rings = rings::around(image, &best);
    let held = rings::held(image, &rings);
    let (inner, outer) = match (&rings[..], held) {
        ([only], _) => (rings::inner_border(image, only), only),
        ([inner, outer], _) if rings::is_dark_ring(image, &inner.circle, &outer.circle) => {
            (Some(InnerBorder { fit: inner.clone(), is_clear: true }), outer)
        }
        ([.., inner, outer], Some(held))
            if inner.circle == held.circle
                && rings::is_black_between(image, inner, &outer.circle) =>
        {
            (Some(InnerBorder { fit: held, is_clear: true }), outer)
        }
        (_, held) => {
            let held = held.map(|ring| ring.circle);
            let mut rings = rings;
            rings.sort_by(|one, other| other.score().total_cmp(&one.score()));
            let circles = held.into_iter().chain(rings.iter().map(|ring| ring.circle));
            return Err((RimDoubt::Nested, circles.collect()));
        }
    };
    let is_ring = inner.is_some();
    let is_clear = inner.as_ref().is_none_or(|inner| inner.is_clear);
    let rim = inner.map_or_else(|| outer.clone(), |inner| inner.fit);
    let circles = || vec![rim.circle, outer.circle];
    if rim.falling() < LEAST_FALLS * rim.seen {
        return Err((RimDoubt::Dark, circles()));
    }
    let best = if rim.score() > outer.score() { &rim } else { outer };
    let is_other = |fit: &&CircleFit| {
        !fit.circle.is_near(&rim.circle, SAME)
            && !fit.circle.is_near(&outer.circle, SAME)
            && !rings::is_dark_ring(image, &rim.circle, &fit.circle)
    };
    // A circle that has most of its edges in common with the best one is no other.
    let leads = |fit: &CircleFit| best.score() >= CLEAR_LEAD * fit.score();
    let is_leading = !is_second
        && best.share() >= LEAST_LEADING
        && others.iter().filter(is_other).all(|fit| leads(fit) || fit.is_part_of(best));
    if best.seen < LEAST_SEEN || (best.share() < LEAST_SHARE && !is_leading) {
        return Err((RimDoubt::NoEdge, circles()));
    }
    // The inner border of a ring must be seen as well as any rim: dark furniture has an edge, too.
    // Of a narrow ring, both borders are near enough.
    let is_narrow = rim.circle.is_near(&outer.circle, SAME);
    if is_ring && !is_narrow && (rim.seen < LEAST_SEEN || !is_clear) {
        return Err((RimDoubt::Nested, circles()));
    }
    let is_rival = |fit: &&CircleFit| is_other(fit) && fit.score() > LEAD * best.score();
    if let Some(rival) = others.iter().find(is_rival) {
        return Err((RimDoubt::Rival, vec![rim.circle, rival.circle]));
    }
    if (!is_ring || is_narrow)
        && let Some(rival) = outer.beside(image).iter().find(is_rival)
    {
        return Err((RimDoubt::Rival, vec![rim.circle, rival.circle]));
    }
    if !best.is_certain() {
        return Err((RimDoubt::Short(best.seen), circles()));
    }
    Ok(rim)
}

/// The rim if some image shows the mirror's surroundings just inside of it; the mean of many images is smooth.
fn with_surroundings(
    images: &[GrayImage],
    rim: CircleFit,
) -> Result<CircleFit, (RimDoubt, Vec<Circle>)> {
    let is_rough = |image: &GrayImage| {
        let image = Brightness::mean(slice::from_ref(image));
        image.is_ok_and(|image| is_rough_inside(&image, &rim.circle))
    };
    if images.iter().any(is_rough) { Ok(rim) } else { Err((RimDoubt::Smooth, vec![rim.circle])) }
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
    Ok(CircleFit { circle, bulge: Bulge::NONE, edges, seen, visible: 1.0 }.rim())
}
