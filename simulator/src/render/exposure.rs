//! Turns light into an image file: glare, blur, colour cast, exposure, noise, response, JPEG.

use std::sync::LazyLock;

use image::{
    ImageFormat, RgbImage,
    codecs::{jpeg::JpegEncoder, png::PngEncoder},
};
use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::render::{
    effects::Effects,
    random_stream::{StreamPurpose, stream},
    rig::Rig,
};

/// The light at every pixel, as red, green and blue; at 1 the sensor is saturated.
pub(crate) trait RowRenderer {
    /// Renders a row. Rows must be requested in order.
    fn row(&mut self, v: usize, out: &mut [f32]);

    /// The mean light.
    fn mean(&self) -> [f32; 3];
}

/// Exposes an image.
pub(crate) fn expose(
    light: &mut impl RowRenderer,
    rig: &Rig,
    effects: &Effects,
    seed: u64,
) -> RgbImage {
    let [width, height] = rig.image().map(|length| length as usize);
    let gain = gain(effects);
    let glare = effects.glare as f32;
    let veil = if glare > 0.0 { light.mean().map(|mean| glare * mean) } else { [0.0; 3] };
    let mut blur = Blur::new([width, height], effects.blur * width as f64 / 1280.0);
    let mut noise = Noise::new(effects.noise as f32, stream(seed, StreamPurpose::Sensor, 0));
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
    RgbImage::from_raw(width as u32, height as u32, bytes).unwrap_or_default()
}

/// Encodes an image as JPEG, or as PNG if compression is lossless.
#[must_use]
pub fn file(image: &RgbImage, effects: &Effects) -> Vec<u8> {
    let mut bytes = Vec::new();
    let written = if effects.jpeg_loss > 0.0 {
        let quality = (100.0 - effects.jpeg_loss).round().clamp(1.0, 100.0) as u8;
        JpegEncoder::new_with_quality(&mut bytes, quality).encode_image(image)
    } else {
        image.write_with_encoder(PngEncoder::new(&mut bytes))
    };
    // Only an image without pixels cannot be encoded.
    written.map_or_else(|_| Vec::new(), |()| bytes)
}

/// The image after it was encoded and decoded.
pub(crate) fn compressed(image: RgbImage, effects: &Effects) -> RgbImage {
    if effects.jpeg_loss <= 0.0 {
        return image;
    }
    let read = image::load_from_memory_with_format(&file(&image, effects), ImageFormat::Jpeg);
    read.map_or(image, image::DynamicImage::into_rgb8)
}

/// The factor of each channel.
fn gain(effects: &Effects) -> [f32; 3] {
    let exposure = effects.exposure.exp2();
    let green = (1.0 - 0.2 * effects.cast) * (1.0 + effects.tint);
    [exposure, exposure * green, exposure * (1.0 - effects.cast)].map(|gain| gain as f32)
}

/// Blurs the rows of an image.
struct Blur {
    width: usize,
    height: usize,
    /// The weights from the middle outwards.
    weights: Vec<f32>,
    /// The latest horizontally blurred rows, and the number of the next one.
    across: Vec<Vec<f32>>,
    next: usize,
    /// A row with its ends repeated.
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

    /// Returns a blurred row. Rows must be requested in order.
    fn row(&mut self, light: &mut impl RowRenderer, v: usize, out: &mut [f32]) {
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

    /// Renders the next row and blurs it horizontally.
    fn along(&mut self, light: &mut impl RowRenderer) {
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

/// Normally distributed random numbers.
static NORMAL: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    (0..1 << 13)
        .flat_map(|_| {
            // The Box-Muller transform.
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

    /// Adds photon noise, which grows with the square root of the light, and sensor noise.
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

/// The number of steps of the response table.
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

/// The camera's response to light: the curve of sRGB.
#[inline]
fn response(light: f32) -> u8 {
    RESPONSE[(light.clamp(0.0, 1.0) * STEPS as f32 + 0.5) as i32 as usize]
}

/// Encodes an image as JPEG and decodes it again.
#[cfg(test)]
mod tests {
    use toposlam_vision::camera::Camera;

    use super::*;

    const WIDTH: usize = 40;
    const HEIGHT: usize = 30;

    /// Light from a table.
    struct Table(Vec<[f32; 3]>);

    impl RowRenderer for Table {
        fn row(&mut self, v: usize, out: &mut [f32]) {
            out.copy_from_slice(self.0[v * WIDTH..][..WIDTH].as_flattened());
        }

        fn mean(&self) -> [f32; 3] {
            [0, 1, 2]
                .map(|c| self.0.iter().map(|light| light[c]).sum::<f32>() / self.0.len() as f32)
        }
    }

    fn even(light: [f32; 3]) -> Table {
        Table(vec![light; WIDTH * HEIGHT])
    }

    fn spotted() -> Table {
        let mut table = even([0.1, 0.2, 0.3]);
        for (at, light) in [(0, 0.9), (15 * WIDTH + 20, 0.8), (15 * WIDTH + 21, 0.1)] {
            table.0[at] = [light, light / 2.0, light / 3.0];
        }
        table
    }

    fn photograph(mut light: Table, effects: &Effects) -> RgbImage {
        let rig = Rig::new(&Camera::superscout().sized([WIDTH as u32, HEIGHT as u32]));
        compressed(expose(&mut light, &rig, effects, 5), effects)
    }

    fn with(settings: &[(&str, f64)]) -> Effects {
        let mut effects = Effects::plain();
        for (name, value) in settings {
            effects.set(name, *value).unwrap();
        }
        effects
    }

    #[test]
    fn without_effects_every_pixel_is_its_light() {
        let table = spotted();
        let expected: Vec<u8> = table.0.iter().flatten().map(|&light| response(light)).collect();
        assert_eq!(photograph(table, &Effects::plain()).into_raw(), expected);
    }

    #[test]
    fn the_response_is_that_of_srgb() {
        let known = [(0.0, 0), (0.002, 7), (0.2140, 127), (0.5, 188), (1.0, 255), (7.0, 255)];
        for (light, value) in known {
            assert!(response(light).abs_diff(value) <= 1, "{light}");
        }
        assert_eq!(response(-1.0), 0);
        for value in 0..=255_u8 {
            let [light, ..] = crate::render::looks::linear([value; 3]);
            assert!(response(light).abs_diff(value) <= 1, "{value}");
        }
    }

    #[test]
    fn a_stop_doubles_the_light_and_a_cast_takes_blue_away() {
        let pixel = |settings: &[(&str, f64)]| {
            photograph(even([0.2, 0.2, 0.2]), &with(settings)).get_pixel(9, 9).0
        };
        assert_eq!(pixel(&[("exposure", 1.0)]), [response(0.4); 3]);
        assert_eq!(pixel(&[("exposure", -2.0)]), [response(0.05); 3]);
        let yellow = [0.2, 0.2 * 0.9, 0.2 * 0.5].map(response);
        assert_eq!(pixel(&[("cast", 0.5)]), yellow);
        let [red, _, blue] = pixel(&[("cast", 0.77)]).map(f64::from);
        assert!((blue / red - 0.5).abs() < 0.02, "{blue} {red}");
        assert_eq!(pixel(&[("glare", 0.1)]), [response(0.2); 3]);
    }

    #[test]
    fn blur_is_a_weighted_mean_of_the_neighbours() {
        for deviation in [0.4, 1.0, 2.5] {
            let mut table = spotted();
            let clear = table.0.clone();
            let mut blur = Blur::new([WIDTH, HEIGHT], deviation);
            let reach = (2.5 * deviation).ceil() as isize;
            let weight = |away: isize| (-0.5 * (away as f64 / deviation).powi(2)).exp();
            let sum: f64 = (-reach..=reach).map(weight).sum();
            let mut row = vec![0.0; WIDTH * 3];
            for v in 0..HEIGHT {
                blur.row(&mut table, v, &mut row);
                for (u, found) in row.as_chunks::<3>().0.iter().enumerate() {
                    for (channel, &found) in found.iter().enumerate() {
                        let mut expected = 0.0;
                        for (down, right) in
                            (-reach..=reach).flat_map(|d| (-reach..=reach).map(move |r| (d, r)))
                        {
                            let v = v.saturating_add_signed(down).min(HEIGHT - 1);
                            let u = u.saturating_add_signed(right).min(WIDTH - 1);
                            let share = weight(down) * weight(right) / (sum * sum);
                            expected += share * f64::from(clear[v * WIDTH + u][channel]);
                        }
                        assert!((f64::from(found) - expected).abs() < 1e-5, "{u} {v}");
                    }
                }
            }
        }
    }

    #[test]
    fn noise_has_the_standard_deviation_of_its_effect() {
        let mut noise = Noise::new(0.02, stream(1, StreamPurpose::Sensor, 0));
        for light in [0.1_f32, 0.5, 1.0] {
            let mut row = vec![light; 60_000];
            noise.add(&mut row);
            let count = row.len() as f64;
            let mean = row.iter().map(|&value| f64::from(value)).sum::<f64>() / count;
            let square = |&value: &f32| (f64::from(value) - mean).powi(2);
            let deviation = (row.iter().map(square).sum::<f64>() / count).sqrt();
            let expected = 0.02 * (0.9 * f64::from(light) + 0.1).sqrt();
            assert!((mean - f64::from(light)).abs() < 5e-4, "{mean}");
            assert!((deviation / expected - 1.0).abs() < 0.03, "{deviation} {expected}");
        }
    }

    #[test]
    fn a_higher_jpeg_loss_loses_more() {
        let off = |loss: f64| -> u64 {
            let clear = photograph(spotted(), &Effects::plain());
            let lossy = photograph(spotted(), &with(&[("jpeg-loss", loss)]));
            clear.iter().zip(lossy.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum()
        };
        assert!(off(5.0) > 0 && off(5.0) < off(50.0) && off(50.0) < off(95.0));
    }
}
