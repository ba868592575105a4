//! The pixels that never change in images from several places: the robot's body, struts, the lens, the rim.
//!
//! They are the edges that all images have, and the areas inside them in which nothing changes, without small
//! pieces. A strut is a thin rod beside the axis, so it hides the same few bearings at every range.

#![allow(clippy::cast_sign_loss, reason = "sizes are not negative")]

use image::{GrayImage, ImageBuffer, Luma, Rgb, RgbImage};
use nalgebra::Point2;
use thiserror::Error;

use super::{
    Mask,
    morphology::{Colours, close, dilate, open, pieces, smooth},
    rim::Rim,
};
use crate::{geometry::angle, least_squares::median};

/// The least number of images. Geometry: in fewer, edges of the building are in the same place by chance.
pub const FEWEST: usize = 4;
/// The longest side of an image; larger ones are reduced. Geometry: memory and time.
const LONGEST: u32 = 640;
/// The least part of the pixels of a piece that change in some image. Views.
const LEAST_CHANGING: f64 = 0.04;
/// Pieces with a smaller part of the mirror are ignored. Views.
const SMALL: f64 = 0.01;
/// The least part of the mirror that must be seen. Views.
const LEAST_SEEN: f64 = 0.3;
/// Added to the brightness, from 0 to 255, so that its logarithm is finite. Geometry.
const BLACK: f32 = 8.0;
/// The standard deviation of the smoothing. Geometry: the noise of one pixel.
const SIGMA: f32 = 1.0;
/// The least slope of an edge: of the logarithm of the brightness, for each pixel. Views.
const STEEP: f32 = 0.05;
/// The radii at which struts are searched for, as parts of the rim's. Geometry: the lens is nearer to the centre, the
/// rim's own edge farther away.
const STRUT_RADII: [f64; 2] = [0.25, 0.97];
/// The most bearings, of 2048, that one strut hides. Geometry: 7 degrees.
const WIDEST_STRUT: usize = 40;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum UnchangingError {
    #[error(
        "{0} images are too few to find what never changes; take at least {least}, from different \
         places",
        least = FEWEST
    )]
    TooFew(usize),
    #[error(
        "almost nothing changes from image to image; take them from different places and in \
         different directions"
    )]
    Still,
}

/// The mask of the pixels inside the rim that change: they can show floor or walls.
///
/// The images must be of the same size. For each of them, and for each of at most 640 by 640 pixels, it
/// takes some 40 bytes of memory.
///
/// # Errors
/// Returns an error if there are too few images, or if they are all the same.
pub fn mask(file: &str, images: &[RgbImage], rim: &Rim) -> Result<Mask, UnchangingError> {
    if images.len() < FEWEST {
        return Err(UnchangingError::TooFew(images.len()));
    }
    let (width, height) = images[0].dimensions();
    let factor = width.max(height).div_ceil(LONGEST);
    let disc = Disc {
        centre: rim.centre.map(|at| (at + 0.5) / f64::from(factor) - 0.5),
        radius: rim.radius / f64::from(factor),
    };
    let slopes: Vec<Slopes> =
        images.iter().map(|image| Slopes::from_image(image, factor)).collect();
    let seen = seen(&slopes, &disc)?;
    let (last_u, last_v) = (seen.width() - 1, seen.height() - 1);
    let pixels = (0..height).flat_map(|v| (0..width).map(move |u| (u, v)));
    let seen = pixels
        .map(|(u, v)| seen.get_pixel((u / factor).min(last_u), (v / factor).min(last_v))[0] > 0);
    Ok(Mask::new(file, [width, height], seen.collect()))
}

struct Disc {
    centre: Point2<f64>,
    radius: f64,
}

impl Disc {
    /// Whether a pixel is inside of it and not at its border.
    fn holds(&self, u: u32, v: u32) -> bool {
        let off = Point2::new(u, v).map(f64::from) - self.centre;
        off.norm() < self.radius - 1.5
    }
}

fn seen(slopes: &[Slopes], disc: &Disc) -> Result<GrayImage, UnchangingError> {
    let (width, height) = (slopes[0].width, slopes[0].height);
    let changes = Changes::between(slopes);
    let struts = Struts::in_all(slopes, disc);
    // The pixels around edges belong to them.
    let edges = dilate(&close(&changes.stay, 2), 1);
    let free = binary(width, height, |u, v| {
        disc.holds(u, v) && edges.get_pixel(u, v)[0] == 0 && !struts.hide(u, v, disc)
    });
    let pieces = pieces(&free);
    let most = pieces.pixels().map(|piece| piece[0]).max().unwrap_or(0) as usize;
    let (mut sizes, mut changing) = (vec![0_u32; most + 1], vec![0_u32; most + 1]);
    for (piece, moved) in pieces.pixels().zip(changes.moved.pixels()) {
        sizes[piece[0] as usize] += 1;
        changing[piece[0] as usize] += u32::from(moved[0] > 0);
    }
    let all = std::f64::consts::PI * disc.radius * disc.radius;
    let alive = |piece: usize| {
        let size = f64::from(sizes[piece]);
        piece > 0 && size > SMALL * all && f64::from(changing[piece]) > LEAST_CHANGING * size
    };
    let seen = binary(width, height, |u, v| alive(pieces.get_pixel(u, v)[0] as usize));
    let seen = open(&close(&seen, 1), 2);
    let count = seen.pixels().filter(|pixel| pixel[0] > 0).count() as f64;
    if count < LEAST_SEEN * all { Err(UnchangingError::Still) } else { Ok(seen) }
}

fn binary(width: u32, height: u32, is: impl Fn(u32, u32) -> bool) -> GrayImage {
    GrayImage::from_fn(width, height, |u, v| Luma([if is(u, v) { 255 } else { 0 }]))
}

/// The slopes of the logarithms of an image's red, green and blue, to the right and down. No gain
/// changes them.
struct Slopes {
    width: u32,
    height: u32,
    rises: Vec<[f32; 6]>,
    noise: Vec<f32>,
}

impl Slopes {
    fn from_image(image: &RgbImage, factor: u32) -> Self {
        let image = shrunk(image, factor);
        let (width, height) = image.dimensions();
        // The noise of a slope after smoothing, from the noise before it; there are six slopes.
        let share =
            6.0_f32.sqrt() * noise(&image) / (SIGMA * SIGMA * (8.0 * std::f32::consts::PI).sqrt());
        let logarithms = ImageBuffer::from_fn(width, height, |u, v| {
            Rgb(image.get_pixel(u, v).0.map(|channel| (channel + BLACK).ln()))
        });
        let smooth = smooth(&logarithms, SIGMA);
        let at = |u: u32, v: u32| smooth.get_pixel(u.min(width - 1), v.min(height - 1)).0;
        let rise = |(u, v): (u32, u32)| {
            let (right, left) = (at(u + 1, v), at(u.max(1) - 1, v));
            let (below, above) = (at(u, v + 1), at(u, v.max(1) - 1));
            std::array::from_fn(|part| match part {
                0..3 => (right[part] - left[part]) / 2.0,
                _ => (below[part - 3] - above[part - 3]) / 2.0,
            })
        };
        let rises = (0..height).flat_map(|v| (0..width).map(move |u| (u, v))).map(rise).collect();
        let darkest = |colour: [f32; 3]| colour.into_iter().fold(f32::MAX, f32::min);
        let noise = smooth.pixels().map(|pixel| share / darkest(pixel.0).exp()).collect();
        Self { width, height, rises, noise }
    }

    /// The slope of each channel from one bearing to the next, on average over all radii.
    fn across(&self, bearing: usize, disc: &Disc) -> [f32; 3] {
        let angle = std::f64::consts::TAU * (bearing as f64 + 0.5) / Struts::BEARINGS as f64;
        let (sine, cosine) = angle.sin_cos();
        let [first, last] = STRUT_RADII.map(|share| (share * disc.radius) as u32);
        let (mut sum, mut count) = ([0.0; 3], 0.0_f32);
        for radius in first..last {
            let out = [cosine, sine].map(|along| f64::from(radius) * along);
            let [u, v] = [0, 1].map(|axis| (disc.centre[axis] + out[axis]).round());
            if u >= 0.0 && v >= 0.0 && u < f64::from(self.width) && v < f64::from(self.height) {
                let rises = &self.rises[v as usize * self.width as usize + u as usize];
                for (channel, sum) in sum.iter_mut().enumerate() {
                    *sum += rises[channel + 3] * cosine as f32 - rises[channel] * sine as f32;
                }
                count += 1.0;
            }
        }
        sum.map(|sum| sum / count.max(1.0))
    }
}

fn shrunk(image: &RgbImage, factor: u32) -> Colours {
    let [width, height] = [image.width(), image.height()].map(|side| side.div_ceil(factor));
    Colours::from_fn(width, height, |u, v| {
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for row in v * factor..((v + 1) * factor).min(image.height()) {
            for column in u * factor..((u + 1) * factor).min(image.width()) {
                let pixel = image.get_pixel(column, row);
                for (sum, channel) in sum.iter_mut().zip(pixel.0) {
                    *sum += f32::from(channel);
                }
                count += 1.0;
            }
        }
        Rgb(sum.map(|sum: f32| sum / count))
    })
}

/// The standard deviation of an image's noise, in green, from the median difference between a pixel and
/// the mean of its neighbours.
fn noise(image: &Colours) -> f32 {
    let (width, height) = image.dimensions();
    let at = |u: u32, v: u32| image.get_pixel(u, v)[1];
    let inner = (1..height.max(2) - 1).flat_map(|v| (1..width.max(2) - 1).map(move |u| (u, v)));
    let sizes = inner.map(|(u, v)| {
        (4.0 * at(u, v) - at(u - 1, v) - at(u + 1, v) - at(u, v - 1) - at(u, v + 1)).abs()
    });
    let Some(median) = median(sizes.map(f64::from)) else { return 1.0 };
    // The difference between four times a pixel and its four neighbours has sqrt(20) times the noise.
    // Rounding is noise, too.
    (median as f32 * 1.4826 / 20.0_f32.sqrt()).max(0.3)
}

struct Struts {
    hidden: Vec<bool>,
}

impl Struts {
    const BEARINGS: usize = 2048;

    /// The struts that are in most of the images.
    fn in_all(slopes: &[Slopes], disc: &Disc) -> Self {
        let mut rises = [(); 3].map(|()| Vec::with_capacity(Self::BEARINGS));
        for bearing in 0..Self::BEARINGS {
            let of_images: Vec<[f32; 3]> =
                slopes.iter().map(|slopes| slopes.across(bearing, disc)).collect();
            for (channel, rises) in rises.iter_mut().enumerate() {
                let rise = median(of_images.iter().map(|image| image[channel].into()));
                rises.push(rise.unwrap_or_default() as f32);
            }
        }
        let mut struts = Self { hidden: vec![false; Self::BEARINGS] };
        for rises in &rises {
            struts.add(rises);
        }
        struts
    }

    /// The struts in one channel, from its slopes from bearing to bearing.
    fn add(&mut self, rises: &[f32]) {
        let size = median(rises.iter().map(|rise| rise.abs().into())).unwrap_or_default();
        let steep = (8.0 * size as f32).max(0.004);
        // It gets darker and then as bright again, or the other way round.
        for (from, &rise) in rises.iter().enumerate().filter(|(_, rise)| rise.abs() > steep) {
            let back = (1..=WIDEST_STRUT)
                .rev()
                .find(|step| -rise.signum() * rises[(from + step) % Self::BEARINGS] > steep);
            // With a margin on both sides.
            for step in 0..back.map_or(0, |back| back + 3) {
                self.hidden[(from + Self::BEARINGS + step - 1) % Self::BEARINGS] = true;
            }
        }
    }

    fn hide(&self, u: u32, v: u32, disc: &Disc) -> bool {
        let off = Point2::new(u, v).map(f64::from) - disc.centre;
        let turn = angle(off) / std::f64::consts::TAU;
        let bearing = (turn.rem_euclid(1.0) * Self::BEARINGS as f64) as usize;
        self.hidden[bearing % Self::BEARINGS]
    }
}

struct Changes {
    stay: GrayImage,
    moved: GrayImage,
}

impl Changes {
    fn between(slopes: &[Slopes]) -> Self {
        let (width, height) = (slopes[0].width, slopes[0].height);
        let share = 1.0 / slopes.len() as f32;
        let mut along = vec![0.0; slopes.len()];
        let (mut stay, mut moved) = (GrayImage::new(width, height), GrayImage::new(width, height));
        for (at, (stays, moves)) in stay.pixels_mut().zip(moved.pixels_mut()).enumerate() {
            let mut mean = [0.0; 6];
            let mut noise = 0.0;
            for slopes in slopes {
                for (mean, rise) in mean.iter_mut().zip(slopes.rises[at]) {
                    *mean += share * rise;
                }
                noise += share * slopes.noise[at];
            }
            let steep = size(mean);
            for (along, slopes) in along.iter_mut().zip(slopes) {
                let dot: f32 = mean.iter().zip(slopes.rises[at]).map(|(a, b)| a * b).sum();
                *along = dot / steep.max(1e-9);
            }
            // One image in five may differ.
            along.sort_by(f32::total_cmp);
            let low = along[slopes.len() / 5];
            if steep > STEEP.max(4.0 * noise * share.sqrt()) && low > 0.4 * steep {
                stays.0 = [255];
            }
            let moving = |slopes: &Slopes| {
                let off = size(std::array::from_fn(|part| slopes.rises[at][part] - mean[part]));
                off > (1.5 * STEEP).max(5.0 * slopes.noise[at]) && off > steep
            };
            if slopes.iter().any(moving) {
                moves.0 = [255];
            }
        }
        Self { stay, moved }
    }
}

fn size(vector: [f32; 6]) -> f32 {
    vector.iter().map(|part| part * part).sum::<f32>().sqrt()
}
