//! From light to a photograph: glare, blur, colour cast, exposure, noise, the camera's response, JPEG.

use std::sync::LazyLock;

use image::codecs::jpeg::JpegEncoder;
use image::{ImageFormat, RgbImage};
use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::chance::{For, stream};
use super::effects::Effects;
use super::rig::Rig;

/// The light that comes to every pixel, as red, green and blue; at 1 the sensor is full.
pub(super) trait Scan {
    /// A row of it; rows are asked for in order.
    fn row(&mut self, v: usize, out: &mut [f32]);

    /// What it is on average.
    fn mean(&self) -> [f32; 3];
}

/// The photograph of this light.
pub(super) fn expose(light: &mut impl Scan, rig: &Rig, effects: &Effects, seed: u64) -> RgbImage {
    let [width, height] = rig.image().map(|length| length as usize);
    let gain = gain(effects);
    let glare = effects.glare as f32;
    let veil = if glare > 0.0 { light.mean().map(|mean| glare * mean) } else { [0.0; 3] };
    let mut blur = Blur::new([width, height], effects.blur * width as f64 / 1280.0);
    let mut noise = Noise::new(effects.noise as f32, stream(seed, For::Sensor, 0));
    let [middle_u, middle_v] = rig.optics.centre.map(|at| at as f32);
    let rim = rig.optics.rim() as f32;
    let darker = effects.vignetting as f32 / (rim * rim);
    let mut bytes = vec![0; width * height * 3];
    let mut row = vec![0.0; width * 3];
    for (v, out) in bytes.chunks_exact_mut((width * 3).max(1)).enumerate() {
        blur.row(light, v, &mut row);
        let down = v as f32 - middle_v;
        for (u, pixel) in row.as_chunks_mut::<3>().0.iter_mut().enumerate() {
            let across = u as f32 - middle_u;
            let left = (1.0 - darker * (across * across + down * down)).max(0.05);
            for (channel, value) in pixel.iter_mut().enumerate() {
                *value = (*value * (1.0 - glare) + veil[channel]) * left * gain[channel];
            }
        }
        noise.add(&mut row);
        for (byte, &value) in out.iter_mut().zip(&row) {
            *byte = response(value);
        }
    }
    let image = RgbImage::from_raw(width as u32, height as u32, bytes).unwrap_or_default();
    if effects.jpeg_loss > 0.0 { compressed(image, effects.jpeg_loss) } else { image }
}

/// By what each channel is multiplied.
fn gain(effects: &Effects) -> [f32; 3] {
    let exposure = effects.exposure.exp2();
    let green = (1.0 - 0.2 * effects.cast) * (1.0 + effects.tint);
    [exposure, exposure * green, exposure * (1.0 - effects.cast)].map(|gain| gain as f32)
}

/// Rows of a picture, blurred.
struct Blur {
    width: usize,
    height: usize,
    /// The weights from the middle outwards.
    weights: Vec<f32>,
    /// The latest rows, blurred along themselves, and the number of the next.
    across: Vec<Vec<f32>>,
    next: usize,
    /// A row as it comes, with its ends repeated.
    source: Vec<f32>,
}

impl Blur {
    fn new([width, height]: [usize; 2], deviation: f64) -> Self {
        let reach = (2.5 * deviation).ceil().min(width as f64) as usize;
        let weight = |away: usize| (-0.5 * (away as f64 / deviation.max(1e-9)).powi(2)).exp();
        let weights: Vec<f64> = (0..=reach).map(weight).collect();
        let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
        Self {
            width,
            height,
            weights: weights.into_iter().map(|weight| (weight / sum) as f32).collect(),
            across: vec![vec![0.0; width * 3]; 2 * reach + 1],
            next: 0,
            source: vec![0.0; (width + 2 * reach) * 3],
        }
    }

    /// A row of this light; rows are asked for in order.
    fn row(&mut self, light: &mut impl Scan, v: usize, out: &mut [f32]) {
        let reach = self.weights.len() - 1;
        if reach == 0 {
            light.row(v, out);
            return;
        }
        while self.next < self.height.min(v + reach + 1) {
            self.along(light);
        }
        let row = |v: usize| &self.across[v % self.across.len()];
        for (out, &value) in out.iter_mut().zip(row(v)) {
            *out = self.weights[0] * value;
        }
        for (away, &weight) in self.weights.iter().enumerate().skip(1) {
            let (above, below) =
                (row(v.saturating_sub(away)), row((v + away).min(self.height - 1)));
            for ((out, &one), &other) in out.iter_mut().zip(above).zip(below) {
                *out += weight * (one + other);
            }
        }
    }

    /// Takes the next row, and blurs it along itself.
    fn along(&mut self, light: &mut impl Scan) {
        let (reach, width) = (3 * (self.weights.len() - 1), 3 * self.width);
        light.row(self.next, &mut self.source[reach..reach + width]);
        for at in (0..reach).rev() {
            self.source[at] = self.source[at + 3];
        }
        for at in reach + width..self.source.len() {
            self.source[at] = self.source[at - 3];
        }
        let slot = self.next % self.across.len();
        let out = &mut self.across[slot];
        for (out, &value) in out.iter_mut().zip(&self.source[reach..]) {
            *out = self.weights[0] * value;
        }
        for (away, &weight) in self.weights.iter().enumerate().skip(1) {
            let (left, right) =
                (&self.source[reach - 3 * away..], &self.source[reach + 3 * away..]);
            for ((out, &one), &other) in out.iter_mut().zip(left).zip(right) {
                *out += weight * (one + other);
            }
        }
        self.next += 1;
    }
}

/// Numbers of a normal distribution, in random order.
static NORMAL: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    (0..1 << 13)
        .flat_map(|_| {
            // Box and Muller.
            let (one, other): (f64, f64) = (rng.random(), rng.random());
            let (away, angle) = ((-2.0 * (1.0 - one).ln()).sqrt(), std::f64::consts::TAU * other);
            [(away * angle.cos()) as f32, (away * angle.sin()) as f32]
        })
        .collect()
});

/// The sensor's noise.
struct Noise {
    deviation: f32,
    rng: Xoshiro256PlusPlus,
}

impl Noise {
    fn new(deviation: f32, rng: Xoshiro256PlusPlus) -> Self {
        Self { deviation, rng }
    }

    /// Adds noise: of the photons, which grows with the root of the light, and of the sensor itself.
    fn add(&mut self, row: &mut [f32]) {
        if self.deviation == 0.0 {
            return;
        }
        let normal = NORMAL.as_slice();
        for values in row.chunks_mut(4) {
            let bits = self.rng.next_u64();
            for (number, value) in values.iter_mut().enumerate() {
                let chance = normal[(bits >> (16 * number)) as usize % normal.len()];
                let light = value.clamp(0.0, 1.0);
                *value += self.deviation * (0.9 * light + 0.1).sqrt() * chance;
            }
        }
    }
}

/// Steps of the table of the camera's response.
const STEPS: usize = 4096;

static RESPONSE: LazyLock<Vec<u8>> = LazyLock::new(|| {
    (0..=STEPS)
        .map(|step| {
            let light = step as f64 / STEPS as f64;
            let value = if light <= 0.003_130_8 {
                12.92 * light
            } else {
                1.055 * light.powf(1.0 / 2.4) - 0.055
            };
            (255.0 * value).round() as u8
        })
        .collect()
});

/// What the camera makes of this light: sRGB's curve.
#[inline]
fn response(light: f32) -> u8 {
    RESPONSE[(light.clamp(0.0, 1.0) * STEPS as f32 + 0.5) as i32 as usize]
}

/// What JPEG leaves of a picture.
fn compressed(image: RgbImage, loss: f64) -> RgbImage {
    let quality = (100.0 - loss).round().clamp(1.0, 100.0) as u8;
    let mut bytes = Vec::new();
    let written = JpegEncoder::new_with_quality(&mut bytes, quality).encode_image(&image);
    let read =
        written.and_then(|()| image::load_from_memory_with_format(&bytes, ImageFormat::Jpeg));
    // Only an image without pixels cannot be written; there is nothing to lose in it.
    read.map_or(image, image::DynamicImage::into_rgb8)
}
