//! The mean brightness of images.

#![allow(clippy::cast_sign_loss, reason = "places inside of an image are not negative")]

use image::GrayImage;
use nalgebra::Point2;

use super::RimError;

/// Brightness by pixel, row by row; its mean is about 64.
pub(super) struct Brightness {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels: Vec<f32>,
}

impl Brightness {
    /// The mean of images that are first brought to the same mean brightness.
    pub(super) fn mean(images: &[GrayImage]) -> Result<Self, RimError> {
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

    pub(super) fn shrunk(&self, factor: usize) -> Self {
        let (width, height) = (self.width / factor, self.height / factor);
        let mean = |u: usize, v: usize| {
            let rows = (v * factor..(v + 1) * factor).map(|row| row * self.width + u * factor);
            let sum: f32 = rows.map(|at| self.pixels[at..at + factor].iter().sum::<f32>()).sum();
            sum / (factor * factor) as f32
        };
        let pixels = (0..height).flat_map(|v| (0..width).map(move |u| (u, v)));
        Self { width, height, pixels: pixels.map(|(u, v)| mean(u, v)).collect() }
    }

    /// Whether a place is between pixels.
    pub(super) fn contains(&self, place: Point2<f64>) -> bool {
        let [u, v] = place.into();
        u >= 0.0 && v >= 0.0 && u < (self.width - 1) as f64 && v < (self.height - 1) as f64
    }

    /// The brightness between pixels; `None` outside of the image.
    pub(super) fn at(&self, place: Point2<f64>) -> Option<f64> {
        self.contains(place).then(|| self.between(place))
    }

    /// The brightness at a place that the image contains.
    #[inline]
    pub(super) fn between(&self, place: Point2<f64>) -> f64 {
        let [u, v] = place.into();
        // Neither is negative, so this rounds down, faster than `floor`.
        let [column, row] = [u as i32, v as i32];
        let first = row as usize * self.width + column as usize;
        let along = u - f64::from(column);
        let [upper, lower] = [first, first + self.width].map(|at| {
            let [left, right] = [self.pixels[at], self.pixels[at + 1]].map(f64::from);
            left + along * (right - left)
        });
        upper + (v - f64::from(row)) * (lower - upper)
    }
}
