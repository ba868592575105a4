//! The matrix from a plane at distance one from the viewpoint to pixels.

use nalgebra::{Point2, Vector2};

use super::{
    optics_file::{OpticsFileError, within},
    scaled_place,
};

#[derive(Clone, Debug, PartialEq)]
pub(super) struct PixelMatrix {
    focal: [f64; 2],
    skew: f64,
    pub(super) centre: Point2<f64>,
}

impl PixelMatrix {
    /// The variable numbers of a matrix that is given row by row.
    pub(super) fn numbers([focal_u, skew, u, _, focal_v, v, ..]: [f64; 9]) -> [f64; 5] {
        [focal_u, skew, u, focal_v, v]
    }

    /// The matrix with these variable numbers, row by row.
    pub(super) fn new([focal_u, skew, u, focal_v, v]: [f64; 5]) -> Result<Self, OpticsFileError> {
        let (focal, place) = ([1.0, 1e6], [0.0, 16384.0]);
        Ok(Self {
            focal: [
                within("the focal length across", focal_u, focal)?,
                within("the focal length down", focal_v, focal)?,
            ],
            skew: within("the skew", skew, [-100.0, 100.0])?,
            centre: Point2::new(
                within("the centre's u", u, place)?,
                within("the centre's v", v, place)?,
            ),
        })
    }

    /// The matrix for images that are larger by a factor.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self {
            focal: self.focal.map(|focal| factor * focal),
            skew: factor * self.skew,
            centre: scaled_place(self.centre, factor),
        }
    }

    /// The place in the plane of a pixel.
    pub(super) fn plane(&self, pixel: Point2<f64>) -> Vector2<f64> {
        let off = pixel - self.centre;
        let y = off.y / self.focal[1];
        Vector2::new((off.x - self.skew * y) / self.focal[0], y)
    }

    pub(super) fn pixel(&self, at: Vector2<f64>) -> Point2<f64> {
        let u = self.focal[0] * at.x + self.skew * at.y + self.centre.x;
        Point2::new(u, self.focal[1] * at.y + self.centre.y)
    }
}
