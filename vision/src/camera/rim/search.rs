//! The circles along which an image has the most edges: first all circles of a small image, then the best
//! ones in larger and larger images.

#![allow(clippy::cast_sign_loss, reason = "places inside of an image are not negative")]

use std::{f64::consts::TAU, ops::Range, sync::LazyLock};

use nalgebra::{Point2, Vector2};

use super::{brightness::Brightness, circle::Circle};
use crate::geometry::unit;

/// The longest side of the image in which all circles are compared. Geometry: time grows with its third power.
const COARSE: usize = 160;
/// The number of circles of that image that are followed in larger ones, for each kind of score. Views.
const FOLLOWED: usize = 150;
/// The greatest difference of brightness that counts, over two pixels. Views.
const STEEP: f32 = 24.0;
/// Edges of this height count half. Views.
const HALF: f32 = 6.0;
/// The least part of a circle that must be in the image. Geometry.
const LEAST_INSIDE: f32 = 0.2;

/// The number of kinds of score of a circle.
const KINDS: usize = 3;
/// The number of bearings on which circles of larger images are compared.
const BEARINGS: usize = 240;

static DIRECTIONS: LazyLock<[Vector2<f64>; BEARINGS]> =
    LazyLock::new(|| std::array::from_fn(|bearing| unit(TAU * bearing as f64 / BEARINGS as f64)));

pub(super) fn candidates(image: &Brightness) -> Vec<Circle> {
    let mut factor = image.width.max(image.height).div_ceil(COARSE);
    let mut slopes = Slopes::from_image(&image.shrunk(factor));
    let mut circles = slopes.circles();
    for circle in &mut circles {
        *circle = slopes.best_near(*circle);
    }
    while factor > 1 {
        let finer = factor.div_ceil(2);
        slopes = Slopes::from_image(&image.shrunk(finer));
        for circle in &mut circles {
            *circle = slopes.best_near(circle.scaled(factor as f64 / finer as f64));
        }
        factor = finer;
        circles = different(circles);
    }
    circles
}

/// The circles without those that are almost the same as one before.
fn different(circles: Vec<Circle>) -> Vec<Circle> {
    let mut kept: Vec<Circle> = Vec::new();
    for circle in circles {
        if !kept.iter().any(|other| other.is_near(&circle, 2e-3)) {
            kept.push(circle);
        }
    }
    kept
}

struct Slopes {
    width: usize,
    height: usize,
    /// To the left and upwards, over two pixels.
    falls: Vec<[f32; 2]>,
}

struct Scored {
    score: f32,
    at: [usize; 3],
}

impl Slopes {
    fn from_image(image: &Brightness) -> Self {
        let (width, height) = (image.width, image.height);
        let mut falls = vec![[0.0; 2]; width * height];
        for v in 1..height - 1 {
            for u in 1..width - 1 {
                let at = v * width + u;
                let right = image.pixels[at - 1] - image.pixels[at + 1];
                falls[at] = [right, image.pixels[at - width] - image.pixels[at + width]];
            }
        }
        Self { width, height, falls }
    }

    /// The best circles of the image, best first: those along which the brightness falls most, outwards
    /// (J. Daugman: High confidence visual recognition of persons by a test of statistical independence.
    /// PAMI 1993, equation 1), and those along which it changes most, in either direction.
    fn circles(&self) -> Vec<Circle> {
        let mut edges = Vec::new();
        for v in 1..self.height - 1 {
            for u in 1..self.width - 1 {
                let [right, down] = self.falls[v * self.width + u];
                let size = right.hypot(down);
                if size > 2.0 {
                    let fall = [right / size, down / size];
                    let weights = [size.min(STEEP), size / (size + HALF)];
                    edges.push(([u as f32, v as f32], fall, weights));
                }
            }
        }
        let least = (0.25 * self.width.min(self.height) as f32) as usize;
        let most = (0.65 * self.width.max(self.height) as f32) as usize;
        let mut scored = [(); KINDS].map(|()| Vec::new());
        let mut rings = vec![[0.0_f32; 2]; most + 3];
        let is_middle = |at: usize, side: usize| (side / 6..=side - side / 6).contains(&at);
        for v in (0..self.height).step_by(2) {
            for u in (0..self.width).step_by(2) {
                // The image's border cuts off up to half of a mirror, but not two halves.
                if !is_middle(u, self.width) && !is_middle(v, self.height) {
                    continue;
                }
                let centre = [u as f32, v as f32];
                rings.fill([0.0; 2]);
                for (at, fall, [steep, present]) in &edges {
                    let out = [at[0] - centre[0], at[1] - centre[1]];
                    let from_centre = (out[0] * out[0] + out[1] * out[1]).sqrt();
                    if from_centre >= least as f32 - 2.0 && from_centre < most as f32 {
                        let outwards = (fall[0] * out[0] + fall[1] * out[1]) / from_centre;
                        let ring = &mut rings[(from_centre + 0.5) as usize];
                        let along = outwards * outwards;
                        ring[0] += outwards * steep;
                        // Edges along the circle, whatever their height.
                        ring[1] += along * along * present;
                    }
                }
                for (kind, scored) in scored.iter_mut().enumerate() {
                    let ring = |radius: usize| rings[radius][kind.min(1)];
                    // Scaled to the whole circle; whole circles are preferred to arcs, but not by the last kind.
                    let power = if kind < 2 { 0.5 } else { 1.0 };
                    self.peaks([u, v], least..most, power, ring, scored);
                }
            }
        }
        let mut circles: Vec<Circle> = Vec::new();
        for mut scored in scored {
            scored.sort_by(|one, other| other.score.total_cmp(&one.score));
            let mut kept: Vec<[usize; 3]> = Vec::new();
            for Scored { at, .. } in scored {
                let is_near =
                    |other: &[usize; 3]| (0..3).all(|axis| at[axis].abs_diff(other[axis]) < 3);
                if !kept.iter().any(is_near) {
                    kept.push(at);
                }
                if kept.len() == FOLLOWED {
                    break;
                }
            }
            circles.extend(kept.iter().map(|&[u, v, radius]| Circle {
                centre: Point2::new(u as f64, v as f64),
                radius: radius as f64,
            }));
        }
        circles
    }

    /// Adds the circles around a centre that are better than those a little smaller or larger.
    fn peaks(
        &self,
        [u, v]: [usize; 2],
        radii: Range<usize>,
        power: f32,
        ring: impl Fn(usize) -> f32,
        scored: &mut Vec<Scored>,
    ) {
        let score = |radius: usize| {
            let inside = self.share_inside([u, v], radius);
            let sum: f32 = (radius - 1..=radius + 1).map(&ring).sum();
            if inside < LEAST_INSIDE { 0.0 } else { sum / (radius as f32 * inside.powf(power)) }
        };
        let least = radii.start;
        let scores: Vec<f32> = radii.map(score).collect();
        for (number, &score) in scores.iter().enumerate() {
            let around = number.saturating_sub(2)..(number + 3).min(scores.len());
            if score > 0.0 && scores[around].iter().all(|&other| other <= score) {
                scored.push(Scored { score, at: [u, v, least + number] });
            }
        }
    }

    fn share_inside(&self, [u, v]: [usize; 2], radius: usize) -> f32 {
        let radius = radius as f32;
        let hidden = |distance: usize| {
            let share = distance as f32 / radius;
            if share < 1.0 { 2.0 * share.acos() } else { 0.0 }
        };
        let sides = [u, v, self.width - 1 - u, self.height - 1 - v];
        // Corners count twice, so this is an underestimate.
        1.0 - sides.map(hidden).iter().sum::<f32>() / std::f32::consts::TAU
    }

    /// The circle with the most edges along it among those that differ by at most two pixels in centre
    /// and radius.
    fn best_near(&self, circle: Circle) -> Circle {
        let mut best = (self.score(&circle), circle);
        let shifts = [-2.0, -1.0, 0.0, 1.0, 2.0];
        for u in shifts {
            for v in shifts {
                for out in shifts {
                    let centre = circle.centre + Vector2::new(u, v);
                    let shifted = Circle { centre, radius: circle.radius + out };
                    let score = self.score(&shifted);
                    if score > best.0 {
                        best = (score, shifted);
                    }
                }
            }
        }
        best.1
    }

    fn score(&self, circle: &Circle) -> f64 {
        let (mut sum, mut visible) = (0.0, 0_u32);
        for out in DIRECTIONS.iter() {
            let [u, v] = (circle.centre + circle.radius * out).map(f64::round).into();
            let inside =
                u >= 1.0 && v >= 1.0 && u < (self.width - 1) as f64 && v < (self.height - 1) as f64;
            if !inside {
                continue;
            }
            let [right, down] = self.falls[v as usize * self.width + u as usize];
            let fall = (right * out.x as f32 + down * out.y as f32).abs();
            sum += f64::from(fall / (fall + HALF));
            visible += 1;
        }
        sum / f64::from(visible).max(0.1 * BEARINGS as f64).sqrt()
    }
}
