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

/// The light of an image; at 1 the sensor is saturated.
pub(crate) struct Light {
    /// Red, green and blue of each pixel, row by row.
    pub(crate) pixels: Vec<f32>,
    /// The mean of some pixels.
    pub(crate) mean: [f32; 3],
}

pub(crate) fn expose(light: Light, rig: &Rig, effects: &Effects, seed: u64) -> RgbImage {
    let [width, height] = rig.image();
    let row = (3 * width as usize).max(1);
    let gain = gain(effects);
    let glare = effects.glare as f32;
    let veil = if glare > 0.0 { light.mean.map(|mean| glare * mean) } else { [0.0; 3] };
    let mut pixels = blurred(light.pixels, row, effects.blur * f64::from(width) / 1280.0);
    let mut rng = stream(seed, StreamPurpose::Sensor, 0);
    let [middle_u, middle_v] = rig.optics.centre.map(|at| at as f32);
    let rim = rig.optics.rim() as f32;
    let darker = effects.vignetting as f32 / (rim * rim);
    for (v, row) in pixels.chunks_exact_mut(row).enumerate() {
        let down = v as f32 - middle_v;
        for (u, pixel) in row.as_chunks_mut::<3>().0.iter_mut().enumerate() {
            let across = u as f32 - middle_u;
            let left = (1.0 - darker * (across * across + down * down)).max(0.05);
            for (channel, value) in pixel.iter_mut().enumerate() {
                *value = (*value * (1.0 - glare) + veil[channel]) * left * gain[channel];
            }
        }
        add_noise(row, effects.noise as f32, &mut rng);
    }
    let bytes = pixels.into_iter().map(response).collect();
    RgbImage::from_raw(width, height, bytes).unwrap_or_default()
}

/// Encodes an image as JPEG, or as PNG if compression is lossless.
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

fn gain(effects: &Effects) -> [f32; 3] {
    let exposure = effects.exposure.exp2();
    let green = (1.0 - 0.2 * effects.cast) * (1.0 + effects.tint);
    [exposure, exposure * green, exposure * (1.0 - effects.cast)].map(|gain| gain as f32)
}

/// An image whose rows have this length, blurred along both axes. Beyond its border are the pixels of the border.
fn blurred(mut pixels: Vec<f32>, row: usize, deviation: f64) -> Vec<f32> {
    let reach = (2.5 * deviation).ceil().min((row / 3) as f64) as usize;
    if reach == 0 {
        return pixels;
    }
    let weight = |away: usize| (-0.5 * (away as f64 / deviation.max(1e-9)).powi(2)).exp();
    let weights: Vec<f64> = (0..=reach).map(weight).collect();
    let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
    let weights: Vec<f32> = weights.into_iter().map(|weight| (weight / sum) as f32).collect();

    let mut across = vec![0.0; pixels.len()];
    // A row with its ends repeated.
    let (begin, end) = (3 * reach, 3 * reach + row);
    let mut source = vec![0.0; end + 3 * reach];
    for (out, pixels) in across.chunks_exact_mut(row).zip(pixels.chunks_exact(row)) {
        source[begin..end].copy_from_slice(pixels);
        for at in (0..begin).rev() {
            source[at] = source[at + 3];
        }
        for at in end..source.len() {
            source[at] = source[at - 3];
        }
        set_weighted(&weights, out, |away| &source[begin.saturating_add_signed(3 * away)..]);
    }
    let last = (pixels.len() / row).saturating_sub(1);
    for (v, out) in pixels.chunks_exact_mut(row).enumerate() {
        set_weighted(&weights, out, |away| {
            &across[v.saturating_add_signed(away).min(last) * row..]
        });
    }
    pixels
}

/// The weighted sum of values and of those at the same distance on both sides.
fn set_weighted<'s>(weights: &[f32], out: &mut [f32], values: impl Fn(isize) -> &'s [f32]) {
    for (out, &value) in out.iter_mut().zip(values(0)) {
        *out = weights[0] * value;
    }
    for (away, &weight) in (0..).zip(weights).skip(1) {
        for ((out, &one), &other) in out.iter_mut().zip(values(-away)).zip(values(away)) {
            *out += weight * (one + other);
        }
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

/// Adds photon noise, which grows with the square root of the light, and sensor noise.
fn add_noise(row: &mut [f32], deviation: f32, rng: &mut Xoshiro256PlusPlus) {
    if deviation == 0.0 {
        return;
    }
    let normal = NORMAL.as_slice();
    for values in row.chunks_mut(4) {
        let bits = rng.next_u64();
        for (number, value) in values.iter_mut().enumerate() {
            let chance = normal[(bits >> (16 * number)) as usize % normal.len()];
            let light = value.clamp(0.0, 1.0);
            *value += deviation * (0.9 * light + 0.1).sqrt() * chance;
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

#[cfg(test)]
mod tests {
    use toposlam_vision::camera::Camera;

    use super::*;

    const WIDTH: usize = 40;
    const HEIGHT: usize = 30;

    fn even(light: [f32; 3]) -> Vec<[f32; 3]> {
        vec![light; WIDTH * HEIGHT]
    }

    fn spotted() -> Vec<[f32; 3]> {
        let mut table = even([0.1, 0.2, 0.3]);
        for (at, light) in [(0, 0.9), (15 * WIDTH + 20, 0.8), (15 * WIDTH + 21, 0.1)] {
            table[at] = [light, light / 2.0, light / 3.0];
        }
        table
    }

    fn photograph(light: &[[f32; 3]], settings: &[(&str, f64)]) -> RgbImage {
        let mut effects = Effects::plain();
        for (name, value) in settings {
            effects.set(name, *value).unwrap();
        }
        let rig = Rig::new(&Camera::superscout().sized([WIDTH as u32, HEIGHT as u32]));
        let mean =
            [0, 1, 2].map(|c| light.iter().map(|light| light[c]).sum::<f32>() / light.len() as f32);
        let light = Light { pixels: light.as_flattened().to_vec(), mean };
        compressed(expose(light, &rig, &effects, 5), &effects)
    }

    #[test]
    fn without_effects_every_pixel_is_its_light_in_the_response_of_srgb() {
        let expected: Vec<u8> =
            spotted().as_flattened().iter().map(|&light| response(light)).collect();
        assert_eq!(photograph(&spotted(), &[]).into_raw(), expected);
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
        for (name, value, light) in [
            ("exposure", 1.0, [0.4; 3]),
            ("exposure", -2.0, [0.05; 3]),
            ("cast", 0.5, [0.2, 0.2 * 0.9, 0.2 * 0.5]),
            ("glare", 0.1, [0.2; 3]),
        ] {
            let pixel = photograph(&even([0.2; 3]), &[(name, value)]).get_pixel(9, 9).0;
            assert_eq!(pixel, light.map(response), "{name} {value}");
        }
        let image = photograph(&even([0.2; 3]), &[("cast", 0.77)]);
        let [red, _, blue] = image.get_pixel(9, 9).0.map(f64::from);
        assert!((blue / red - 0.5).abs() < 0.02, "{blue} {red}");
    }

    #[test]
    fn blur_is_a_weighted_mean_of_the_neighbours() {
        let clear = spotted();
        for deviation in [0.4, 1.0, 2.5] {
            let found = blurred(clear.as_flattened().to_vec(), 3 * WIDTH, deviation);
            let reach = (2.5 * deviation).ceil() as isize;
            let weight = |away: isize| (-0.5 * (away as f64 / deviation).powi(2)).exp();
            let sum: f64 = (-reach..=reach).map(weight).sum();
            for (at, &found) in found.iter().enumerate() {
                let (u, v, channel) = (at / 3 % WIDTH, at / 3 / WIDTH, at % 3);
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

    #[test]
    fn noise_has_the_standard_deviation_of_its_effect() {
        let mut rng = stream(1, StreamPurpose::Sensor, 0);
        for light in [0.1_f32, 0.5, 1.0] {
            let mut row = vec![light; 60_000];
            add_noise(&mut row, 0.02, &mut rng);
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
        let clear = photograph(&spotted(), &[]);
        let off = [5.0, 50.0, 95.0].map(|loss| -> u64 {
            let lossy = photograph(&spotted(), &[("jpeg-loss", loss)]);
            clear.iter().zip(lossy.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum()
        });
        assert!(off[0] > 0 && off[0] < off[1] && off[1] < off[2], "{off:?}");
    }
}
