//! How rough the brightness is around a circle's centre: a mirror shows a building, a holder is smooth.

use std::f64::consts::TAU;

use nalgebra::Vector2;

use super::{
    brightness::Brightness,
    circle::Circle,
    edges::{ARC, BEARINGS, unit},
    fit::EVERY,
};
use crate::{
    geometry,
    least_squares::{NormalEquations, median},
};

/// The number of circles in a ring along which the brightness is compared.
const CIRCLES: usize = 5;
/// The least part of a circle that must be in the image, so that it counts. Geometry: the waves of a shorter arc fit
/// anything.
const LEAST_INSIDE: f64 = 0.14;
/// Brightness that is off by less is noise, ... Views.
const NOISE: f64 = 4.0;
/// ... and so is this part of the brightness. Views.
const NOISE_PART: f64 = 0.1;
/// A ring is smooth if at most this part of it is rough. Views: holders are up to 0.06.
const MOST_SMOOTH: f64 = 0.1;
/// What is seen in a mirror is rough in more than this part. Views: from 0.028 on.
const LEAST_ROUGH: f64 = 0.025;
/// What is just inside of a rim begins at this part of the radius. Views.
const INSIDE: f64 = 0.9;

/// Whether what is just inside of a circle can be seen in a mirror.
pub(super) fn is_rough_inside(image: &Brightness, circle: &Circle) -> bool {
    let inner = Circle { radius: INSIDE * circle.radius, ..*circle };
    roughness(image, &inner, circle).is_some_and(|share| share > LEAST_ROUGH)
}

/// Whether what is between two circles can be a holder.
pub(super) fn is_smooth_between(image: &Brightness, inner: &Circle, outer: &Circle) -> bool {
    roughness(image, inner, outer).is_some_and(|share| share <= MOST_SMOOTH)
}

/// The share of what is between two circles in which the brightness is not that of a smooth surface: a constant and two
/// waves around the centre, for the light that comes from one side. A margin at both circles does not count. `None` if
/// too little of it is in the image.
fn roughness(image: &Brightness, inner: &Circle, outer: &Circle) -> Option<f64> {
    let width = outer.radius - inner.radius;
    let margin = (4.0 * unit(outer) / width.max(1.0)).min(0.25);
    let shares: Vec<f64> = (0..CIRCLES)
        .filter_map(|number| {
            let part = number as f64 / (CIRCLES - 1) as f64;
            along(image, &inner.towards(outer, margin + part * (1.0 - 2.0 * margin)))
        })
        .collect();
    (2 * shares.len() > CIRCLES).then(|| shares.iter().sum::<f64>() / shares.len() as f64)
}

/// The share of a circle in the image in which the brightness is not smooth.
fn along(image: &Brightness, circle: &Circle) -> Option<f64> {
    let samples: Vec<([f64; 5], f64)> = (0..BEARINGS)
        .step_by(EVERY)
        .filter_map(|bearing| {
            let angle = TAU * bearing as f64 / BEARINGS as f64;
            let towards = geometry::unit(angle);
            let across = Vector2::new(-towards.y, towards.x);
            let place = |along: &f64| {
                circle.centre + circle.radius * towards + along * unit(circle) * across
            };
            let places = ARC.iter().map(place);
            let sum: Option<f64> = places.map(|place| image.at(place)).sum();
            let twice = geometry::unit(2.0 * angle);
            let light = sum? / ARC.len() as f64;
            Some(([1.0, towards.x, towards.y, twice.x, twice.y], light))
        })
        .collect();
    if (samples.len() * EVERY) as f64 <= LEAST_INSIDE * BEARINGS as f64 {
        return None;
    }
    let level = median(samples.iter().map(|&(_, light)| light))?;
    let mut waves = [level, 0.0, 0.0, 0.0, 0.0];
    let off = |waves: &[f64; 5], row: &[f64; 5], light: f64| {
        light - row.iter().zip(waves).map(|(part, wave)| part * wave).sum::<f64>()
    };
    for _ in 0..8 {
        let sizes = samples.iter().map(|(row, light)| off(&waves, row, *light).abs());
        let far = 4.685 * 1.4826 * median(sizes)?.max(0.5);
        let mut equations = NormalEquations::with_pull(1e-6);
        for (row, light) in &samples {
            let share = off(&waves, row, *light) / far;
            if share.abs() < 1.0 {
                equations.add((1.0 - share * share).powi(2), *row, *light);
            }
        }
        waves = equations.solve()?;
    }
    let is_rough = |(row, light): &&([f64; 5], f64)| {
        off(&waves, row, *light).abs() > NOISE + NOISE_PART * light
    };
    Some(samples.iter().filter(is_rough).count() as f64 / samples.len() as f64)
}
