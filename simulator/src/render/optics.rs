//! The rays of a camera below a spherical mirror: from the pinhole up to the sphere and reflected
//! there. Section 2.5.
//!
//! Coordinates are the robot's: its centre on the floor is the origin, x is ahead, y left, z up, in
//! metres.

use std::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};
use toposlam_vision::camera::{self, Camera, SeenFrom, SphericalMirror};

/// The differences of a camera from its calibration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigErrors {
    /// Tilt of the axis, in radians.
    pub tilt: f64,
    /// Direction of the tilt, in radians counter-clockwise from ahead.
    pub towards: f64,
    /// Offset of the mirror's centre in the image, in pixels.
    pub centre: [f64; 2],
    /// Error of the camera's height, in metres; positive if it is too high.
    pub height: f64,
}

/// The ray that a pixel sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRay {
    /// Its origin: on the mirror, or the pinhole.
    pub origin: Vector3<f64>,
    /// Its direction, of length one.
    pub direction: Vector3<f64>,
    /// Whether it was reflected by the mirror.
    pub by: RayPath,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayPath {
    Mirror,
    Direct,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RigOptics {
    pub(crate) image: [u32; 2],
    /// The pixel that looks straight down.
    pub(crate) centre: [f64; 2],
    /// Height of the pinhole or viewpoint, in metres.
    pub(crate) height: f64,
    kind: Kind,
    errors: RigErrors,
}

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    UnderSphere(UnderSphere),
    /// A camera with a single viewpoint.
    Single(Box<Camera>),
}

/// A pinhole camera that looks up, and a mirrored sphere above it.
// paper: hardware.camera
#[derive(Clone, Debug, PartialEq)]
struct UnderSphere {
    focal: f64,
    radius: f64,
    distance: f64,
    /// The image's right and up, as directions in the plane of the floor.
    right: Vector2<f64>,
    up: Vector2<f64>,
}

impl RigOptics {
    pub(crate) fn new(camera: &Camera, errors: &RigErrors) -> Self {
        let centre: [f64; 2] = camera.middle().into();
        Self {
            image: camera.image,
            centre: [0, 1].map(|axis| centre[axis] + errors.centre[axis]),
            height: camera.height() + errors.height,
            kind: match &camera.optics {
                camera::OpticsModel::SphericalMirror(mirror) => {
                    Kind::UnderSphere(UnderSphere::new(camera, mirror))
                }
                _ => Kind::Single(Box::new(camera.clone())),
            },
            errors: *errors,
        }
    }

    pub(crate) fn ray(&self, pixel: [f64; 2]) -> CameraRay {
        let mut ray = match &self.kind {
            Kind::UnderSphere(rig) => {
                rig.ray([pixel[0] - self.centre[0], self.centre[1] - pixel[1]])
            }
            Kind::Single(camera) => {
                let intended = [0, 1].map(|axis| pixel[axis] - self.errors.centre[axis]);
                let seen = camera.ray(intended).map(|ray| (ray.direction, RayPath::Mirror));
                let (direction, by) = seen.unwrap_or((Vector3::z(), RayPath::Direct));
                CameraRay { origin: Vector3::zeros(), direction, by }
            }
        };
        ray.origin = self.leaning(ray.origin);
        ray.origin.z += self.height;
        ray.direction = self.leaning(ray.direction);
        ray
    }

    /// Turns a vector of the upright rig with the tilt of the axis.
    fn leaning(&self, vector: Vector3<f64>) -> Vector3<f64> {
        let RigErrors { tilt, towards, .. } = self.errors;
        if tilt == 0.0 {
            return vector;
        }
        let ((sine, cosine), (left, ahead)) = (tilt.sin_cos(), towards.sin_cos());
        let along = vector[0] * ahead + vector[1] * left;
        let across = vector[1] * ahead - vector[0] * left;
        let (along, up) = (along * cosine + vector[2] * sine, vector[2] * cosine - along * sine);
        Vector3::new(along * ahead - across * left, along * left + across * ahead, up)
    }

    /// Radius of the view in the image, in pixels: the mirror's rim, or the image's corner.
    pub(crate) fn rim(&self) -> f64 {
        match &self.kind {
            Kind::UnderSphere(rig) => {
                let sine = (rig.radius / rig.distance).min(0.999);
                rig.focal * sine / (1.0 - sine * sine).sqrt()
            }
            Kind::Single(_) => {
                let [width, height] = self.image.map(f64::from);
                width.hypot(height) / 2.0
            }
        }
    }
}

impl UnderSphere {
    fn new(camera: &Camera, mirror: &SphericalMirror) -> Self {
        let (sine, cosine) = camera.ahead.sin_cos();
        // Ahead in the image is (cosine, sine). Seen from below, left is a quarter turn clockwise.
        let [right, up] = match camera.seen_from {
            SeenFrom::Below => [[cosine, sine], [sine, -cosine]],
            SeenFrom::Above => [[cosine, -sine], [sine, cosine]],
        }
        .map(Vector2::from);
        let (radius, distance) = (mirror.mirror_radius, mirror.mirror_distance);
        Self { focal: mirror.focal, radius, distance, right, up }
    }

    /// The ray of a pixel in the upright rig. The pixel is given from the centre, to the right and
    /// up.
    fn ray(&self, [right, top]: [f64; 2]) -> CameraRay {
        let out = right / self.focal * self.right + top / self.focal * self.up;
        let out = unit(out.push(1.0));
        // The sphere's centre is straight above the pinhole, which is the origin here.
        let middle = Vector3::new(0.0, 0.0, self.distance);
        let along = out.dot(&middle);
        let beyond = along * along - (self.distance * self.distance - self.radius * self.radius);
        if beyond > 0.0 {
            let origin = out * (along - beyond.sqrt());
            let normal = (origin - middle) * (1.0 / self.radius);
            let back = out - normal * (2.0 * out.dot(&normal));
            CameraRay { origin, direction: unit(back), by: RayPath::Mirror }
        } else {
            CameraRay { origin: Vector3::zeros(), direction: out, by: RayPath::Direct }
        }
    }
}

impl CameraRay {
    /// The place where it meets the floor, if nothing is in its way.
    pub fn floor(&self) -> Option<[f64; 2]> {
        let length = -self.origin.z / self.direction.z;
        (self.direction.z < 0.0).then(|| (self.origin.xy() + length * self.direction.xy()).into())
    }

    /// Its direction as a share of a full turn from ahead to the left, in [0, 1).
    pub(crate) fn turn(&self) -> f64 {
        (self.direction.y.atan2(self.direction.x) / TAU).rem_euclid(1.0)
    }

    /// Its distance from the robot's axis, seen from above.
    pub(crate) fn off_axis(&self) -> f64 {
        let level = self.direction.x.hypot(self.direction.y);
        if level == 0.0 { 0.0 } else { self.origin.xy().perp(&self.direction.xy()).abs() / level }
    }
}

/// Not [`Vector3::normalize`], which rounds otherwise: images stay as they are to the byte.
fn unit(vector: Vector3<f64>) -> Vector3<f64> {
    vector * (1.0 / vector.norm())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    fn mirror(camera: &Camera) -> SphericalMirror {
        match &camera.optics {
            camera::OpticsModel::SphericalMirror(mirror) => *mirror,
            other => panic!("{other:?} is no mirror"),
        }
    }

    fn cameras() -> [Camera; 3] {
        let below = Camera::superscout();
        let above = Camera { seen_from: SeenFrom::Above, ahead: 0.3, ..below.clone() };
        let off_middle = SphericalMirror { centre: [611.5, 502.25].into(), ..mirror(&below) };
        let optics = camera::OpticsModel::SphericalMirror(off_middle);
        let turned = Camera { ahead: -2.0, optics, ..below.clone() };
        [below, above, turned]
    }

    // paper: hardware.camera
    #[test]
    fn traced_rays_agree_with_the_closed_form_of_the_mirror() {
        for camera in cameras() {
            let optics = RigOptics::new(&camera, &RigErrors::default());
            let mut seen = 0;
            for (u, v) in (0..64).flat_map(|u| (0..48).map(move |v| (u, v))) {
                let pixel = [f64::from(u) * 20.3, f64::from(v) * 20.1];
                let ray = optics.ray(pixel);
                let ground = ray.floor().filter(|_| ray.by == RayPath::Mirror);
                let expected = camera.pixel_to_ground(pixel);
                assert_eq!(ground.is_some(), expected.is_some(), "{pixel:?}");
                if let (Some([x, y]), Some(expected)) = (ground, expected) {
                    let away = (x - expected[0]).hypot(y - expected[1]);
                    // Near the horizon, a small rounding error becomes a large distance.
                    assert!(away < 1e-9 * x.hypot(y).max(1.0).powi(2), "{pixel:?}: {away}");
                    seen += 1;
                }
            }
            assert!(seen > 800, "{seen}");
        }
    }

    #[test]
    fn rays_come_from_the_sphere_and_have_length_one() {
        let camera = Camera::superscout();
        let optics = RigOptics::new(&camera, &RigErrors { tilt: 0.02, ..RigErrors::default() });
        let middle = optics.leaning(Vector3::new(0.0, 0.0, 0.15)) + Vector3::new(0.0, 0.0, 0.90);
        for at in 0..200 {
            let ray = optics.ray([640.0 + f64::from(at) * 2.2, 480.0 - f64::from(at)]);
            assert!((ray.direction.norm() - 1.0).abs() < 1e-12);
            let from_middle = (ray.origin - middle).norm();
            assert!(ray.by == RayPath::Direct || (from_middle - 0.05).abs() < 1e-12);
        }
    }

    #[test]
    fn a_tilted_rig_sees_along_its_tilted_axis() {
        let tilt = 0.05_f64;
        for towards in [0.0, FRAC_PI_2, 2.5] {
            let errors = RigErrors { tilt, towards, ..RigErrors::default() };
            let ray = RigOptics::new(&Camera::superscout(), &errors).ray([640.0, 480.0]);
            // The axis passes through the pinhole, 0.9 m up. It meets the floor this far back.
            let back = 0.90 * tilt.tan();
            let [x, y] = ray.floor().unwrap();
            let off = (x + back * towards.cos()).hypot(y + back * towards.sin());
            assert!(off < 1e-12, "{towards}: {off}");
        }
    }

    #[test]
    fn errors_of_centre_and_height_move_the_view() {
        let camera = Camera::superscout();
        let errors = RigErrors { centre: [4.0, -3.0], height: 0.02, ..RigErrors::default() };
        let [x, y] = RigOptics::new(&camera, &errors).ray([700.0, 300.0]).floor().unwrap();
        let moved = SphericalMirror {
            centre: [644.0, 477.0].into(),
            camera_height: 0.92,
            ..mirror(&camera)
        };
        let optics = camera::OpticsModel::SphericalMirror(moved);
        let as_it_is = Camera { optics, ..camera };
        let expected = as_it_is.pixel_to_ground([700.0, 300.0]).unwrap();
        assert!((x - expected.x).hypot(y - expected.y) < 1e-9);
    }
}
