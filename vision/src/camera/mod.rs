//! Cameras: the point of the floor that a pixel shows. Section 3.
//!
//! Pixels are (u, v), u to the right and v down; pixel centres are integers. Floor coordinates have the robot's centre
//! as origin, x ahead and y to the left, in metres; z is up. Every camera is above the robot's centre, and its axis is
//! vertical, so that the middle of the image shows what is straight below; that of a fisheye may be tilted.

pub mod calibration;
mod fit_picture;
mod hidden;
mod kannala_brandt;
mod mask;
mod mei;
mod morphology;
mod ocam;
mod optics_file;
mod pixel_matrix;
pub mod rim;
mod root;
mod spherical;
pub mod unchanging;
mod xml;
mod yaml;

use std::f64::consts::TAU;

use nalgebra::{Matrix2, Point2, Point3, Vector3};

use crate::geometry::unit;

pub use fit_picture::fit_picture;
pub use hidden::{HiddenFloor, Polygon};
pub use kannala_brandt::KannalaBrandt;
pub use mask::{Mask, MaskError};
pub use mei::Mei;
pub use ocam::OCam;
pub use optics_file::OpticsFileError;
pub use spherical::SphericalMirror;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeenFrom {
    /// It looks up into the mirror: with ahead up, the image's right is the robot's left.
    Below,
    /// It looks down: with ahead up, the image's right is the robot's right.
    Above,
}

#[derive(Clone, Debug, PartialEq)]
pub enum OpticsModel {
    SphericalMirror(SphericalMirror),
    OCamCalib(OCam),
    Mei(Mei),
    KannalaBrandt(KannalaBrandt),
}

/// [`Camera::hidden_radius`] looks at this many bearings ... Geometry: every 3 degrees.
const HIDDEN_BEARINGS: u32 = 120;
/// ... and at ranges this far apart, in metres ... Geometry: half a centimetre.
const HIDDEN_STEP: f64 = 0.005;
/// ... up to this number of steps. Geometry: 1.5 m.
const HIDDEN_STEPS: u32 = 300;

/// A place in an image that is scaled by a factor: pixel centres are integers, so an image begins at
/// -0.5.
fn scaled_place(place: Point2<f64>, factor: f64) -> Point2<f64> {
    place.map(|at| (at + 0.5) * factor - 0.5)
}

#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Width and height of its images, in pixels.
    pub image: [u32; 2],
    /// The direction of ahead in the image, in radians counter-clockwise from u.
    pub ahead: f64,
    pub seen_from: SeenFrom,
    pub optics: OpticsModel,
    /// The pixels in which the floor can be seen, if they are known.
    pub mask: Option<Mask>,
    pub hidden: HiddenFloor,
}

/// The ray along which a pixel looks, in floor coordinates and metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewingRay {
    /// The point at which it leaves the mirror; the viewpoint of a camera with a single one.
    pub origin: Point3<f64>,
    pub direction: Vector3<f64>,
}

impl ViewingRay {
    /// The point at which it meets the floor; `None` if it does not go down.
    pub fn floor(&self) -> Option<Point2<f64>> {
        let length = -self.origin.z / self.direction.z;
        (self.direction.z < 0.0).then(|| (self.origin + length * self.direction).xy())
    }
}

impl OpticsModel {
    /// The ray of a pixel, in the image's axes: x to its right, y to its top, z up from the floor.
    fn ray(&self, pixel: Point2<f64>) -> Option<ViewingRay> {
        match self {
            Self::SphericalMirror(mirror) => mirror.ray(pixel),
            Self::OCamCalib(ocam) => ocam.ray(pixel),
            Self::Mei(mei) => mei.ray(pixel),
            Self::KannalaBrandt(fisheye) => fisheye.ray(pixel),
        }
    }

    /// The pixel that shows a point of the floor, in the image's axes.
    fn pixel(&self, ground: Point2<f64>) -> Option<Point2<f64>> {
        match self {
            Self::SphericalMirror(mirror) => mirror.pixel(ground),
            Self::OCamCalib(ocam) => ocam.pixel(ground),
            Self::Mei(mei) => mei.pixel(ground),
            Self::KannalaBrandt(fisheye) => fisheye.pixel(ground),
        }
    }
}

impl Camera {
    /// The SuperScout's camera: a spherical mirror seen from below, 1280 by 960 pixels.
    pub fn superscout() -> Self {
        Self {
            image: [1280, 960],
            ahead: std::f64::consts::FRAC_PI_2,
            seen_from: SeenFrom::Below,
            optics: OpticsModel::SphericalMirror(SphericalMirror {
                centre: Point2::new(640.0, 480.0),
                focal: 1272.8,
                mirror_radius: 0.05,
                mirror_distance: 0.15,
                camera_height: 0.90,
            }),
            mask: None,
            hidden: HiddenFloor::default(),
        }
    }

    /// The same camera with another size of image. Both images show the same, so their proportions
    /// should be the same.
    #[must_use]
    pub fn sized(&self, image: [u32; 2]) -> Self {
        let factor = f64::from(image[0]) / f64::from(self.image[0]);
        let optics = match &self.optics {
            OpticsModel::SphericalMirror(mirror) => {
                OpticsModel::SphericalMirror(mirror.scaled(factor))
            }
            OpticsModel::OCamCalib(ocam) => OpticsModel::OCamCalib(ocam.scaled(factor, image)),
            OpticsModel::Mei(mei) => OpticsModel::Mei(mei.scaled(factor, image)),
            OpticsModel::KannalaBrandt(fisheye) => {
                OpticsModel::KannalaBrandt(fisheye.scaled(factor, image))
            }
        };
        let mask = self.mask.as_ref().map(|mask| mask.sized(image));
        let hidden = self.hidden.scaled(factor);
        Self { image, optics, mask, hidden, ..*self }
    }

    /// The pixel that looks straight down.
    pub fn middle(&self) -> Point2<f64> {
        match &self.optics {
            OpticsModel::SphericalMirror(mirror) => mirror.centre,
            OpticsModel::OCamCalib(ocam) => ocam.centre,
            OpticsModel::Mei(mei) => mei.matrix.centre,
            OpticsModel::KannalaBrandt(fisheye) => fisheye.middle(),
        }
    }

    /// The height of the pinhole or the single viewpoint above the floor, in metres.
    pub fn height(&self) -> f64 {
        match &self.optics {
            OpticsModel::SphericalMirror(mirror) => mirror.camera_height,
            OpticsModel::OCamCalib(ocam) => ocam.viewpoint_height,
            OpticsModel::Mei(mei) => mei.viewpoint_height,
            OpticsModel::KannalaBrandt(fisheye) => fisheye.viewpoint_height,
        }
    }

    // paper: hardware.height
    /// The height from which the floor is seen, in metres: that of the mirror's middle, or of the single
    /// viewpoint.
    pub fn eye_height(&self) -> f64 {
        match &self.optics {
            OpticsModel::SphericalMirror(mirror) => mirror.camera_height + mirror.mirror_distance,
            _ => self.height(),
        }
    }

    /// The ray along which a pixel looks; `None` outside of the mirror or of the calibration.
    pub fn ray(&self, pixel: impl Into<Point2<f64>>) -> Option<ViewingRay> {
        let ViewingRay { origin, direction } = self.optics.ray(pixel.into())?;
        let robot_from_image = self.robot_from_image().to_homogeneous();
        Some(ViewingRay {
            origin: robot_from_image * origin,
            direction: robot_from_image * direction,
        })
    }

    /// The point of the floor that a pixel shows; `None` above the horizon and outside of the mirror.
    pub fn pixel_to_ground(&self, pixel: impl Into<Point2<f64>>) -> Option<Point2<f64>> {
        self.optics.ray(pixel.into())?.floor().map(|ground| self.robot_from_image() * ground)
    }

    /// The pixel that shows a point of the floor, which may lie outside of the image; `None` if none
    /// does.
    pub fn ground_to_pixel(&self, ground: impl Into<Point2<f64>>) -> Option<Point2<f64>> {
        let ground: Point2<f64> = ground.into();
        self.optics.pixel(self.robot_from_image().transpose() * ground)
    }

    /// The index of the image's pixel, row by row, that shows a point of the floor; `None` if none does, or something
    /// is in the way.
    pub fn seen_pixel(&self, ground: Point2<f64>) -> Option<u32> {
        let [u, v] = self.ground_to_pixel(ground)?.map(f64::round).into();
        let [width, height] = self.image;
        let inside = (0.0..f64::from(width)).contains(&u) && (0.0..f64::from(height)).contains(&v);
        let pixel = [u as u32, v as u32];
        (inside && self.sees(pixel)).then(|| pixel[1] * width + pixel[0])
    }

    /// Whether the floor can be seen in a pixel: neither body, strut nor rim is in the way.
    pub fn sees(&self, pixel: [u32; 2]) -> bool {
        let inside = pixel[0] < self.image[0] && pixel[1] < self.image[1];
        let place = Point2::from(pixel.map(f64::from));
        inside
            && self.mask.as_ref().is_none_or(|mask| mask.sees(pixel))
            && !self.hidden.polygons.iter().any(|polygon| polygon.contains(place))
            && self
                .pixel_to_ground(place)
                .is_some_and(|ground| self.mask.is_some() || !self.is_below_body(ground))
    }

    /// Whether a point of the floor is so near that the robot's body hides it.
    pub fn is_below_body(&self, ground: Point2<f64>) -> bool {
        ground.coords.norm() < self.hidden.radius
    }

    /// The radius around the robot's centre, in metres, from which on most of the floor is seen: what is nearer is hidden by
    /// the body, or by what carries the camera.
    pub fn hidden_radius(&self) -> f64 {
        let is_seen = |range: f64| {
            let bearings =
                (0..HIDDEN_BEARINGS).map(|nth| TAU * f64::from(nth) / f64::from(HIDDEN_BEARINGS));
            let seen = bearings
                .filter(|&bearing| self.seen_pixel(Point2::from(range * unit(bearing))).is_some());
            2 * seen.count() >= HIDDEN_BEARINGS as usize
        };
        let HiddenFloor { radius, polygons } = &self.hidden;
        let by_body = if self.mask.is_none() { *radius } else { 0.0 };
        if self.mask.is_none() && polygons.is_empty() {
            return by_body;
        }
        let mut ranges = (0..=HIDDEN_STEPS).map(|step| by_body + f64::from(step) * HIDDEN_STEP);
        ranges.find(|&range| is_seen(range)).unwrap_or(*radius)
    }

    /// From the image's axes, right and top, to the robot's, ahead and left: a turn, or a turn and a reflection. Its
    /// inverse is its transpose.
    fn robot_from_image(&self) -> Matrix2<f64> {
        let (sine, cosine) = self.ahead.sin_cos();
        match self.seen_from {
            SeenFrom::Below => Matrix2::new(cosine, sine, sine, -cosine),
            SeenFrom::Above => Matrix2::new(cosine, sine, -sine, cosine),
        }
    }
}
