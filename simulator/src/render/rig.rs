//! A camera on a robot, and the ray of each of its pixels. Section 2.5.

use toposlam_vision::camera::Camera;

use crate::render::optics::{CameraRay, RayPath, RigErrors, RigOptics};

/// A camera under its mirror. It is built once and used for any number of images.
#[derive(Clone, Debug)]
pub struct Rig {
    pub(crate) optics: RigOptics,
    pub(crate) rays: Vec<PixelRay>,
    /// Radial size of a pixel on the floor by its distance from the centre in pixels; in metres,
    /// for the upright rig.
    strides: Vec<f32>,
    /// The greatest distance of a ray from the robot's axis, seen from above, in metres.
    pub(crate) off_axis: f64,
}

/// The ray through the middle of a pixel, in the robot's coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PixelRay {
    pub(crate) origin: [f32; 3],
    pub(crate) direction: [f32; 3],
    /// Direction from ahead to the left, in 1/65,536 of a turn.
    pub(crate) turn: u16,
    pub(crate) by: RayPath,
}

/// A ray in the building's coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WorldRay {
    pub(crate) origin: [f32; 3],
    pub(crate) direction: [f32; 3],
    /// Direction counter-clockwise from east, in 1/65,536 of a turn.
    pub(crate) turn: u16,
}

impl WorldRay {
    /// Where it is at this length, seen from above.
    #[inline]
    pub(crate) fn place(&self, length: f32) -> [f32; 2] {
        [0, 1].map(|axis| self.origin[axis] + length * self.direction[axis])
    }
}

impl From<CameraRay> for PixelRay {
    fn from(ray: CameraRay) -> Self {
        Self {
            origin: ray.origin.cast::<f32>().into(),
            direction: ray.direction.cast::<f32>().into(),
            turn: (ray.turn() * 65_536.0) as u32 as u16,
            by: ray.by,
        }
    }
}

impl Rig {
    pub fn new(camera: &Camera) -> Self {
        Self::with_errors(camera, &RigErrors::default())
    }

    pub fn with_errors(camera: &Camera, errors: &RigErrors) -> Self {
        let optics = RigOptics::new(camera, errors);
        let [width, height] = optics.image;
        let mut off_axis: f64 = 0.0;
        let mut rays = Vec::with_capacity(width as usize * height as usize);
        for v in 0..height {
            for u in 0..width {
                let ray = optics.ray([u, v].map(f64::from));
                off_axis = off_axis.max(ray.off_axis());
                rays.push(ray.into());
            }
        }
        let upright = RigOptics::new(camera, &RigErrors::default());
        let range = |pixels: f64| {
            let [u, v] = upright.centre;
            let [x, y] = upright.ray([u + pixels, v]).floor()?;
            Some(x.hypot(y))
        };
        let strides = (0..upright.rim() as u32)
            .map_while(|pixels| {
                let pixels = f64::from(pixels);
                Some((range(pixels + 0.5)? - range((pixels - 0.5).max(0.0))?) as f32)
            })
            .collect();
        Self { optics, rays, strides, off_axis }
    }

    /// Width and height of its images, in pixels.
    pub fn image(&self) -> [u32; 2] {
        self.optics.image
    }

    /// The centre and the radius of the view in the image, in pixels: the mirror's rim, or a circle through the corners.
    pub fn rim(&self) -> ([f64; 2], f64) {
        (self.optics.centre, self.optics.rim())
    }

    pub fn ray(&self, pixel: [f64; 2]) -> CameraRay {
        self.optics.ray(pixel)
    }

    /// Radial size on the floor of a pixel at this distance from the centre, in metres.
    #[inline]
    pub(crate) fn stride(&self, from_middle: f32) -> f32 {
        let last = self.strides.last().copied().unwrap_or(1.0);
        self.strides.get(from_middle as usize).copied().unwrap_or(last)
    }
}
