//! The floor from straight above. Section 3, Figure 6(c).
//!
//! The pixel of the image that shows a point of the floor never changes. So one table of pixels, computed
//! once from the calibration, unwraps and classifies an image in one pass, and only where there is floor.

use image::RgbImage;
use nalgebra::Point2;

use crate::{
    camera::Camera,
    colour::{LitTable, PixelClass},
};

/// The floor around the robot, seen from straight above: the robot in the middle, ahead up, left to the
/// left.
// paper: sense.orthographic
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GroundView {
    /// Rows from ahead to behind, each from left to right.
    pub classes: Vec<PixelClass>,
    /// The indices in `classes` of the marker, ascending.
    pub marker: Vec<u32>,
}

impl GroundView {
    pub const SIDE: usize = 800;
    /// Metres per pixel.
    pub const SCALE: f64 = 0.0075;
    /// Metres from the robot to the middle of each side.
    pub const REACH: f64 = Self::SCALE * Self::SIDE as f64 / 2.0;
    /// The pixels from the robot to the middle of the first row's pixels, and of the first column's.
    const MIDDLE: f64 = (Self::SIDE as f64 - 1.0) / 2.0;

    pub fn unseen() -> Self {
        Self { classes: vec![PixelClass::Unseen; Self::SIDE * Self::SIDE], marker: Vec::new() }
    }

    /// The point of the floor in the middle of a pixel.
    pub fn ground(index: usize) -> Point2<f64> {
        let (row, column) = (index / Self::SIDE, index % Self::SIDE);
        Point2::new(row, column).map(|at| (Self::MIDDLE - at as f64) * Self::SCALE)
    }

    /// The pixel that contains a point of the floor; `None` outside of the view.
    pub fn index(point: Point2<f64>) -> Option<usize> {
        let [row, column] = point.map(|at| (Self::MIDDLE - at / Self::SCALE).round()).into();
        let inside = 0.0..Self::SIDE as f64;
        (inside.contains(&row) && inside.contains(&column))
            .then(|| row as usize * Self::SIDE + column as usize)
    }
}

/// For each pixel of the ground view, the pixel of a camera's images that shows it.
#[derive(Clone, Debug)]
pub struct Unwrapping {
    /// For each pixel of the ground view, the index of the image's pixel, or [`Self::UNSEEN`].
    pixels: Vec<u32>,
}

impl Unwrapping {
    /// Stands for a pixel of the ground view that no pixel of the image shows.
    const UNSEEN: u32 = u32::MAX;

    pub fn new(camera: &Camera) -> Self {
        let pixels: Vec<u32> = (0..GroundView::SIDE * GroundView::SIDE)
            .map(|index| camera.seen_pixel(GroundView::ground(index)).unwrap_or(Self::UNSEEN))
            .collect();
        Self { pixels }
    }

    /// Fills a ground view from an image of the camera's size.
    pub fn view(&self, image: &RgbImage, colours: &LitTable<'_>, view: &mut GroundView) {
        let (pixels, _) = image.as_raw().as_chunks::<3>();
        view.marker.clear();
        for (index, (class, &pixel)) in view.classes.iter_mut().zip(&self.pixels).enumerate() {
            *class = if pixel == Self::UNSEEN {
                PixelClass::Unseen
            } else {
                colours.class(pixels.get(pixel as usize).copied().unwrap_or_default())
            };
            if *class == PixelClass::Marker {
                view.marker.push(index as u32);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // paper: sense.orthographic
    #[test]
    fn a_pixel_is_where_its_middle_is() {
        for index in [0, 1, 799, 800, 320_400, 639_999] {
            assert_eq!(GroundView::index(GroundView::ground(index)), Some(index));
        }
        let [x, y] = GroundView::ground(0).into();
        assert!(x > 2.99 && y > 2.99, "the first pixel is far ahead to the left: {x}, {y}");
        assert_eq!(GroundView::index(Point2::new(GroundView::REACH + 0.01, 0.0)), None);
    }
}
