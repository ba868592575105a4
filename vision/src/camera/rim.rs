//! The mirror's rim in images: a circle that is brighter inside than outside.
//!
//! The scene in the mirror changes from image to image, the rim does not. So the images are averaged,
//! which leaves little of the scene but its mean brightness. The search is coarse first: for the circle
//! along which the brightness falls most, outwards (J. Daugman: High confidence visual recognition of
//! persons by a test of statistical independence. PAMI 1993, equation 1). Then it takes the steepest
//! fall near the circle on each bearing, and fits a circle through these points that ignores outliers.
//! If the image's border crops the rim, arcs are enough.

#![allow(clippy::cast_sign_loss, reason = "places inside of an image are not negative")]

use std::f64::consts::TAU;

use image::GrayImage;
use thiserror::Error;

use super::length;
use crate::least_squares::NormalEquations;

/// A mirror's rim in images.
#[derive(Clone, Debug, PartialEq)]
pub struct Rim {
    /// Its centre, in pixels.
    pub centre: [f64; 2],
    /// Its radius, in pixels.
    pub radius: f64,
    /// The share of the full circle that was seen.
    pub seen: f64,
    /// The root mean square distance of its points from the circle, in pixels.
    pub spread: f64,
    /// The points at which it was seen.
    pub places: Vec<[f64; 2]>,
}

/// Why there is no rim.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum RimError {
    /// There is no image.
    #[error("there is no image")]
    NoImage,
    /// The images differ in size.
    #[error(
        "image {number} is {} by {} pixels, the first is {} by {}",
        .found[0], .found[1], .expected[0], .expected[1]
    )]
    Sizes {
        /// The number of the image, from 1.
        number: usize,
        /// Its width and height.
        found: [u32; 2],
        /// Width and height of the first.
        expected: [u32; 2],
    },
    /// The images are too small for a mirror.
    #[error("the images are {} by {} pixels, too few to find a mirror", .0[0], .0[1])]
    TooSmall([u32; 2]),
    /// No circle is bright inside and dark outside.
    #[error(
        "no mirror is seen in the images: no circle is brighter inside than outside over a quarter of \
         its circumference"
    )]
    NoRim,
}

/// The number of bearings on which the rim is searched for.
const BEARINGS: usize = 1440;

/// The least share of the full circle that must be seen.
const LEAST_SEEN: f64 = 0.25;

/// How much darker it must be outside than inside, on average, at a mean brightness of 64.
const LEAST_MEAN_FALL: f64 = 6.0;

/// The greatest distance of a point of the circle from it, in pixels.
const NEAR: f64 = 1.0;

/// The rim in images of one camera.
///
/// # Errors
/// Returns an error if there is none, or if the images differ in size.
pub fn find(images: &[GrayImage]) -> Result<Rim, RimError> {
    let mean = Brightness::mean(images)?;
    let coarse = mean.shrunk(mean.width.max(mean.height).div_ceil(160));
    let mut circle = coarse.steepest_circle();
    let factor = mean.width as f64 / coarse.width as f64;
    circle = Circle {
        centre: circle.centre.map(|at| (at + 0.5) * factor - 0.5),
        radius: circle.radius * factor,
    };
    let mut places = Vec::new();
    // How near the circle must be: first the coarse one, then the finer ones.
    for reach in [3.0 * factor.max(2.0), 8.0, 4.0, 4.0] {
        places = mean.falls(&circle, reach);
        circle = circle.through(&places);
    }
    places.retain(|place| circle.off(place).abs() < NEAR);
    let seen = places.len() as f64 / BEARINGS as f64;
    // Noise falls everywhere, but not all along a circle.
    if seen < LEAST_SEEN || mean.mean_fall(&circle) < LEAST_MEAN_FALL {
        return Err(RimError::NoRim);
    }
    let squares: f64 = places.iter().map(|place| circle.off(place).powi(2)).sum();
    Ok(Rim {
        centre: circle.centre,
        radius: circle.radius,
        seen,
        spread: (squares / places.len() as f64).sqrt(),
        places: places.iter().map(|place| place.at).collect(),
    })
}

/// A point at which the brightness falls.
struct Place {
    at: [f64; 2],
}

#[derive(Clone, Copy, Debug)]
struct Circle {
    centre: [f64; 2],
    radius: f64,
}

impl Circle {
    /// The distance of a point outside of the circle.
    fn off(&self, place: &Place) -> f64 {
        length([place.at[0] - self.centre[0], place.at[1] - self.centre[1]]) - self.radius
    }

    /// The circle that fits points with outliers best: least squares, weighted by Tukey's function.
    fn through(self, places: &[Place]) -> Self {
        let mut circle = self;
        for _ in 0..30 {
            let mut sizes: Vec<f64> = places.iter().map(|place| circle.off(place).abs()).collect();
            sizes.sort_by(f64::total_cmp);
            let Some(median) = sizes.get(sizes.len() / 2) else { return self };
            let far = (4.685 * 1.4826 * median).max(0.5);
            let mut equations = NormalEquations::<3>::with_pull(0.0);
            for place in places {
                let off = circle.off(place);
                if off.abs() < far {
                    let weight = (1.0 - (off / far).powi(2)).powi(2);
                    let [across, down] = [0, 1].map(|axis| place.at[axis] - circle.centre[axis]);
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

/// Brightness by pixel, row by row.
struct Brightness {
    width: usize,
    height: usize,
    pixels: Vec<f32>,
}

impl Brightness {
    /// The mean of images that are first brought to the same mean brightness.
    fn mean(images: &[GrayImage]) -> Result<Self, RimError> {
        let expected = <[u32; 2]>::from(images.first().ok_or(RimError::NoImage)?.dimensions());
        let [width, height] = expected.map(|side| side as usize);
        if width.min(height) < 48 {
            return Err(RimError::TooSmall(expected));
        }
        let mut pixels = vec![0.0; width * height];
        for (image, number) in images.iter().zip(1..) {
            let found = <[u32; 2]>::from(image.dimensions());
            if found != expected {
                return Err(RimError::Sizes { number, found, expected });
            }
            let sum: u64 = image.as_raw().iter().copied().map(u64::from).sum();
            let gain = 64.0 * pixels.len() as f32 / sum.max(1) as f32 / images.len() as f32;
            for (pixel, &value) in pixels.iter_mut().zip(image.as_raw()) {
                *pixel += gain * f32::from(value);
            }
        }
        Ok(Self { width, height, pixels })
    }

    /// The mean of each square of pixels.
    fn shrunk(&self, factor: usize) -> Self {
        let (width, height) = (self.width / factor, self.height / factor);
        let mean = |u: usize, v: usize| {
            let rows = (v * factor..(v + 1) * factor).map(|row| row * self.width + u * factor);
            let sum: f32 = rows.map(|at| self.pixels[at..at + factor].iter().sum::<f32>()).sum();
            sum / (factor * factor) as f32
        };
        let pixels = (0..height).flat_map(|v| (0..width).map(move |u| (u, v)));
        Self { width, height, pixels: pixels.map(|(u, v)| mean(u, v)).collect() }
    }

    /// The circle along which the brightness falls most, outwards.
    fn steepest_circle(&self) -> Circle {
        /// The greatest fall that counts, over two pixels.
        const STEEP: f32 = 24.0;
        let (width, height) = (self.width, self.height);
        let mut falls = Vec::new();
        for v in 1..height - 1 {
            for u in 1..width - 1 {
                let at = v * width + u;
                let right = self.pixels[at - 1] - self.pixels[at + 1];
                let down = self.pixels[at - width] - self.pixels[at + width];
                let size = right.hypot(down);
                if size > 2.0 {
                    let scale = size.min(STEEP) / size;
                    falls.push(([u as f32, v as f32], [scale * right, scale * down]));
                }
            }
        }
        let (least, most) = (0.25 * width.min(height) as f32, 0.6 * width.max(height) as f32);
        let mut best = (0.0, Circle { centre: [0.0; 2], radius: 0.0 });
        let mut rings = vec![0.0_f32; most as usize + 3];
        for v in (height / 6..=height - height / 6).step_by(2) {
            for u in (width / 6..=width - width / 6).step_by(2) {
                let centre = [u as f32, v as f32];
                rings.fill(0.0);
                for (at, fall) in &falls {
                    let out = [at[0] - centre[0], at[1] - centre[1]];
                    let from_centre = (out[0] * out[0] + out[1] * out[1]).sqrt();
                    if from_centre >= least - 2.0 && from_centre < most {
                        let outwards = (fall[0] * out[0] + fall[1] * out[1]) / from_centre;
                        rings[(from_centre + 0.5) as usize] += outwards;
                    }
                }
                for radius in least as usize..most as usize {
                    let sum = rings[radius - 1..=radius + 1].iter().sum::<f32>();
                    let inside = self.share_inside([u, v], radius);
                    // Scaled to the whole circle, but with a preference for whole circles over arcs.
                    let score = sum / (radius as f32 * inside.sqrt());
                    if inside >= 0.3 && score > best.0 {
                        let centre = [u as f64, v as f64];
                        best = (score, Circle { centre, radius: radius as f64 });
                    }
                }
            }
        }
        best.1
    }

    /// The share of a circle inside of the image.
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

    /// The brightness between pixels; `None` outside of the image.
    fn at(&self, [u, v]: [f64; 2]) -> Option<f64> {
        let (column, row) = (u.floor(), v.floor());
        let inside = column >= 0.0
            && row >= 0.0
            && column < (self.width - 1) as f64
            && row < (self.height - 1) as f64;
        if !inside {
            return None;
        }
        let first = row as usize * self.width + column as usize;
        let [upper, lower] = [first, first + self.width].map(|at| {
            let [left, right] = [self.pixels[at], self.pixels[at + 1]].map(f64::from);
            left + (u - column) * (right - left)
        });
        Some(upper + (v - row) * (lower - upper))
    }

    /// How much darker it is just outside of a circle than just inside, on average over the bearings in
    /// the image.
    fn mean_fall(&self, circle: &Circle) -> f64 {
        let fall = |bearing: usize| {
            let (sine, cosine) = (TAU * bearing as f64 / BEARINGS as f64).sin_cos();
            let ring = |off: f64| {
                let radius = circle.radius + off;
                self.at([circle.centre[0] + radius * cosine, circle.centre[1] + radius * sine])
            };
            let [inside, outside] =
                [-1.0, 1.0].map(|side| [2.0, 3.0, 4.0].iter().map(|off| ring(side * off)).sum());
            let difference: Option<f64> = Option::zip(inside, outside)
                .map(|(inside, outside): (f64, f64)| (inside - outside) / 3.0);
            difference
        };
        let falls: Vec<f64> = (0..BEARINGS).filter_map(fall).collect();
        falls.iter().sum::<f64>() / falls.len().max(1) as f64
    }

    /// For each bearing, the point at which the brightness falls most steeply near a circle.
    fn falls(&self, circle: &Circle, reach: f64) -> Vec<Place> {
        /// A fall is the difference between means over this number of half pixels.
        const WIDE: usize = 5;
        /// The least fall, at a mean brightness of 64.
        const LEAST: f64 = 3.0;
        let steps = (2.0 * reach) as usize + WIDE;
        let place = |bearing: usize| {
            let angle = TAU * bearing as f64 / BEARINGS as f64;
            let (sine, cosine) = angle.sin_cos();
            // The mean over a short arc, from inside to outside in half pixels.
            let ring = |step: usize| {
                let radius = circle.radius + 0.5 * (step as f64 - steps as f64);
                let sum: Option<f64> = [-2.0, -1.0, 0.0, 1.0, 2.0]
                    .iter()
                    .map(|along| {
                        let out = [radius * cosine - along * sine, radius * sine + along * cosine];
                        self.at([circle.centre[0] + out[0], circle.centre[1] + out[1]])
                    })
                    .sum();
                sum.map(|sum| (radius, sum / 5.0))
            };
            let profile: Vec<(f64, f64)> = (0..=2 * steps).map(ring).collect::<Option<_>>()?;
            let mean = |from: usize| {
                profile[from..from + WIDE].iter().map(|(_, value)| value).sum::<f64>() / WIDE as f64
            };
            let fall = |at: usize| mean(at - WIDE) - mean(at + 1);
            let steepest = (WIDE..profile.len() - WIDE)
                .max_by(|&one, &other| fall(one).total_cmp(&fall(other)))?;
            if fall(steepest) < LEAST || steepest == WIDE || steepest + WIDE + 1 == profile.len() {
                return None;
            }
            // Interpolated between the half pixels: the top of a parabola.
            let [before, top, after] = [steepest - 1, steepest, steepest + 1].map(fall);
            let curve = before - 2.0 * top + after;
            let shift = if curve < 0.0 { 0.5 * (before - after) / curve } else { 0.0 };
            let radius = profile[steepest].0 + 0.5 * shift;
            let [u, v] = circle.centre;
            Some(Place { at: [u + radius * cosine, v + radius * sine] })
        };
        (0..BEARINGS).filter_map(place).collect()
    }
}
