//! Masks: the pixels in which the floor can be seen, without body, struts, lens and rim.

use std::io::Cursor;

use image::{
    DynamicImage, GrayImage, ImageDecoder, ImageError, ImageFormat, codecs::png::PngDecoder,
};
use nalgebra::{Point2, distance};
use thiserror::Error;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    /// Its file, as the calibration file names it.
    pub file: String,
    size: [u32; 2],
    seen: Vec<bool>,
}

#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum MaskError {
    #[error("this is not a PNG image: {0}")]
    NotPng(String),
    #[error(
        "the mask is {} by {} pixels, the camera's images are {} by {}",
        .found[0], .found[1], .expected[0], .expected[1]
    )]
    Size { found: [u32; 2], expected: [u32; 2] },
}

impl Mask {
    /// A mask from a PNG. Where the floor can be seen it is white, or at least brighter than middle grey.
    ///
    /// This takes at most sixteen bytes of memory for each pixel of an image of that size.
    ///
    /// # Errors
    /// Returns an error if it is not a PNG of that size. No bytes make it panic.
    pub fn from_png(file: &str, bytes: &[u8], size: [u32; 2]) -> Result<Self, MaskError> {
        let not_png = |error: ImageError| MaskError::NotPng(error.to_string().replace('\n', ", "));
        let decoder = PngDecoder::new(Cursor::new(bytes)).map_err(not_png)?;
        let (width, height) = decoder.dimensions();
        if [width, height] != size {
            return Err(MaskError::Size { found: [width, height], expected: size });
        }
        let image = DynamicImage::from_decoder(decoder).map_err(not_png)?.into_luma8();
        Ok(Self::new(file, size, image.pixels().map(|pixel| pixel.0[0] >= 128).collect()))
    }

    /// A mask from its pixels, row by row.
    ///
    /// # Panics
    /// Panics if their number is not that of an image of this size.
    pub fn new(file: &str, size: [u32; 2], seen: Vec<bool>) -> Self {
        assert_eq!(seen.len(), size[0] as usize * size[1] as usize);
        Self { file: file.to_owned(), size, seen }
    }

    /// The mask of the pixels inside of a circle.
    pub fn circle(file: &str, size: [u32; 2], centre: Point2<f64>, radius: f64) -> Self {
        let pixels = (0..size[1]).flat_map(|v| (0..size[0]).map(move |u| Point2::new(u, v)));
        let inside = pixels.map(|pixel| distance(&pixel.map(f64::from), &centre) < radius);
        Self::new(file, size, inside.collect())
    }

    /// Hides the pixels whose centres are where `hides` is true.
    pub fn hide(&mut self, hides: impl Fn(Point2<f64>) -> bool) {
        let width = self.size[0] as usize;
        for (at, seen) in self.seen.iter_mut().enumerate() {
            let pixel = Point2::new(at % width, at / width).map(|along| along as f64);
            *seen = *seen && !hides(pixel);
        }
    }

    /// The mask as an image: white where the floor can be seen, black elsewhere.
    pub fn to_image(&self) -> GrayImage {
        let [width, height] = self.size;
        GrayImage::from_fn(width, height, |u, v| [if self.sees([u, v]) { 255 } else { 0 }].into())
    }

    /// The mask as a PNG.
    ///
    /// # Errors
    /// Returns an error if there is not enough memory.
    pub fn to_png(&self) -> Result<Vec<u8>, ImageError> {
        let mut bytes = Vec::new();
        self.to_image().write_to(&mut Cursor::new(&mut bytes), ImageFormat::Png)?;
        Ok(bytes)
    }

    /// The same mask in another size: each pixel is its nearest one here.
    pub(super) fn sized(&self, size: [u32; 2]) -> Self {
        let nearest = |at: u32, axis: usize| {
            (u64::from(at) * u64::from(self.size[axis]) / u64::from(size[axis])) as u32
        };
        let pixels = (0..size[1]).flat_map(|v| (0..size[0]).map(move |u| [u, v]));
        let seen = pixels.map(|[u, v]| self.sees([nearest(u, 0), nearest(v, 1)])).collect();
        Self::new(&self.file, size, seen)
    }

    /// Width and height, in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Whether the floor can be seen in a pixel; not outside of the image.
    pub fn sees(&self, [u, v]: [u32; 2]) -> bool {
        let [width, height] = self.size;
        u < width && v < height && self.seen[v as usize * width as usize + u as usize]
    }
}
