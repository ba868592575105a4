//! The circles around the centre of another one: the borders of the ring that holds a mirror.

use std::f64::consts::TAU;

use nalgebra::distance;

use super::{
    SAME,
    brightness::Brightness,
    circle::Circle,
    edges::{BEARINGS, CircleEdges, unit},
    fit::{CircleFit, EVERY},
    roughness::{is_rough_inside, is_smooth_between},
};
use crate::{geometry, least_squares::median};

/// Circles from this to that part of the radius are searched. Geometry: a robot's body in the mirror is smaller.
const RANGE: [f64; 2] = [0.6, 2.5];
/// The centres differ by at most this part of the radius. Views: rings that a camera sees from the side.
const OFF_CENTRE: f64 = 0.05;
/// Edges are searched for up to this many units from a circle: borders of narrow rings are near to each other. Views.
const REACH: f64 = 3.0;
/// The least part of a circle in the image that is seen if it is fitted, ... Views.
const LEAST_FITTED: f64 = 0.1;
/// ... and if it is a border, ... Views.
const LEAST_SHARE: f64 = 0.4;
/// ... in at least this part of its sectors. Views.
const LEAST_SPREAD: f64 = 0.65;
/// A dark ring around the mirror is at most this part of the outer radius wide. Views.
const WIDEST: f64 = 0.12;
/// The inner border of a dark ring is seen, with the mirror brighter than the ring, on at least this part of the
/// bearings of the outer one. Views.
const LEAST_INNER: f64 = 0.15;
/// The edges of an inner border are more than this many times those of a usual circle beside it. Views.
const CLEARLY_MORE: f64 = 1.5;
/// A black ring has less than this part of the mirror's brightness ... Views.
const BLACK: f64 = 0.3;
/// ... just inside of its inner border, from this part of its radius on. Views.
const FROM: f64 = 0.8;
/// The least part of that border that is seen. Views.
const LEAST_SEEN: f64 = 0.75;
/// Smaller differences of brightness are noise. Views.
const NOISE: f64 = 6.0;

/// The circles around one centre that are seen on most bearings, and this one, if it is not made of parts of them; the
/// smallest first.
pub(super) fn around(image: &Brightness, fit: &CircleFit) -> Vec<CircleFit> {
    let rings = around_centre(image, fit);
    let best = rings.iter().max_by(|one, other| one.score().total_cmp(&other.score()));
    // A circle that is made of parts of two borders has a centre of its own.
    match best.filter(|best| !best.circle.is_near(&fit.circle, SAME / 4.0)) {
        Some(best) => around_centre(image, best),
        None => rings,
    }
}

fn around_centre(image: &Brightness, fit: &CircleFit) -> Vec<CircleFit> {
    let step = 2.0 * unit(&fit.circle);
    let [least, most] = RANGE.map(|part| part * fit.circle.radius);
    let steps = (0..).map(|number| least + step * f64::from(number));
    let mut found: Vec<CircleFit> = steps
        .take_while(|&radius| radius < most)
        .filter_map(|radius| {
            let circle = Circle { radius, ..fit.circle };
            let mut ring = CircleFit::on(image, circle, REACH, 2 * EVERY);
            for _ in 0..2 {
                if ring.share() < LEAST_FITTED {
                    return None;
                }
                ring = ring.refitted(image, REACH, EVERY);
            }
            let off = distance(&ring.circle.centre, &fit.circle.centre);
            let is_border = ring.seen >= super::LEAST_SEEN
                && ring.share() >= LEAST_SHARE
                && off <= OFF_CENTRE * fit.circle.radius
                && ring.spread_over(image) >= LEAST_SPREAD;
            is_border.then_some(ring)
        })
        .collect();
    found.push(fit.clone());
    found.sort_by(|one, other| other.score().total_cmp(&one.score()));
    // The best one of those that have edges in common.
    let mut rings: Vec<CircleFit> = Vec::new();
    for ring in found {
        if !rings.iter().any(|other| ring.is_part_of(other)) {
            rings.push(ring);
        }
    }
    rings.sort_by(|one, other| one.circle.radius.total_cmp(&other.circle.radius));
    rings
}

/// The inner border of a dark ring, and whether its edges are clearly more than those of other circles in between: where
/// it gets darker towards the rim, there are edges everywhere.
pub(super) struct InnerBorder {
    pub(super) fit: CircleFit,
    pub(super) is_clear: bool,
}

/// If a circle is the outer border of a dark ring, the inner one.
///
/// Only its radius is fitted: the centre is that of the outer border, which is seen better.
pub(super) fn inner_border(image: &Brightness, outer: &CircleFit) -> Option<InnerBorder> {
    let radius = outer.circle.radius;
    let widths = (1..).map(|step| f64::from(step) * 0.004).take_while(|&part| part <= WIDEST);
    let fits: Vec<CircleFit> = widths
        .filter_map(|part| {
            let circle = Circle { radius: radius * (1.0 - part), ..outer.circle };
            let edges = CircleEdges::near(image, &circle, REACH, EVERY).edges;
            let falls = edges.iter().filter(|edge| edge.fall > 0.0);
            let radius = circle.radius + median(falls.map(|edge| circle.off(edge.at)))?;
            Some(CircleFit::on(image, Circle { radius, ..circle }, REACH, EVERY))
        })
        .collect();
    let usual = median(fits.iter().map(CircleFit::falling))?;
    let is_inner = |fit: &&CircleFit| {
        outer.circle.radius - fit.circle.radius > 4.0 * unit(&fit.circle)
            && fit.falling() >= LEAST_INNER * outer.seen
            && is_dark_between(image, &fit.circle, &outer.circle)
    };
    let inner = fits.iter().filter(is_inner);
    let best = inner.max_by(|one, other| one.seen.total_cmp(&other.seen))?;
    let is_clear = best.falling() > CLEARLY_MORE * usual;
    Some(InnerBorder { fit: CircleFit::on(image, best.circle, REACH, 1), is_clear })
}

/// Whether circles can be the borders of a narrow dark ring around the mirror.
pub(super) fn is_dark_ring(image: &Brightness, inner: &Circle, outer: &Circle) -> bool {
    let width = outer.radius - inner.radius;
    distance(&outer.centre, &inner.centre) <= (2.0 * SAME * inner.radius).min(width)
        && width > 0.0
        && width <= WIDEST * outer.radius
        && is_dark_between(image, inner, outer)
}

/// Whether the ring between two circles can be a mirror's dark holder: it is smooth, and on most bearings not brighter
/// than what is outside of it.
fn is_dark_between(image: &Brightness, inner: &Circle, outer: &Circle) -> bool {
    let pairs = between(image, [inner, outer], [0.5, 1.5]);
    let darker = pairs.iter().filter(|[ring, outside]| *ring < outside + NOISE).count();
    darker as f64 > 0.75 * pairs.len() as f64 && is_smooth_between(image, inner, outer)
}

/// Of circles around one centre, the one in which the mirror shows its surroundings, with nothing but smooth rings
/// around it.
pub(super) fn held(image: &Brightness, rings: &[CircleFit]) -> Option<CircleFit> {
    let is_smooth =
        |pair: &&[CircleFit]| is_smooth_between(image, &pair[0].circle, &pair[1].circle);
    let smooth = rings.windows(2).rev().take_while(is_smooth).count();
    let held = rings.iter().rev().nth(smooth);
    held.filter(|ring| smooth > 0 && is_rough_inside(image, &ring.circle)).cloned()
}

/// Whether the smooth ring between two circles is black, so that it is no part of what a mirror shows.
pub(super) fn is_black_between(image: &Brightness, inner: &CircleFit, outer: &Circle) -> bool {
    let inside = Circle { radius: FROM * inner.circle.radius, ..inner.circle };
    let level = |circles, part| median(between(image, circles, [part]).into_iter().flatten());
    let [ring, mirror] = [level([&inner.circle, outer], 0.5), level([&inside, &inner.circle], 0.5)];
    let is_black = |(ring, mirror): (f64, f64)| ring < BLACK * mirror;
    inner.share() > LEAST_SEEN && ring.zip(mirror).is_some_and(is_black)
}

/// The brightness at parts of the way from one circle to another, on the bearings on which all of them are in the image.
fn between<const N: usize>(
    image: &Brightness,
    [from, to]: [&Circle; 2],
    parts: [f64; N],
) -> Vec<[f64; N]> {
    let bearings = (0..BEARINGS).step_by(EVERY);
    let samples = bearings.filter_map(|bearing| {
        let towards = geometry::unit(TAU * bearing as f64 / BEARINGS as f64);
        let light = |part: f64| {
            let circle = from.towards(to, part);
            image.at(circle.centre + circle.radius * towards)
        };
        let lights = parts.map(light);
        lights.iter().all(Option::is_some).then(|| lights.map(Option::unwrap_or_default))
    });
    samples.collect()
}
