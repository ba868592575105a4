//! Which point of the floor a pixel shows. Section 3.
//!
//! Pixels are (u, v), u to the right and v down; pixel centres are integers. Floor coordinates have
//! the robot's centre as origin, x ahead and y to the left, in metres.

mod spherical;

pub use spherical::SphericalMirror;

/// From where the camera sees what it sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeenFrom {
    /// It looks up into the mirror: with ahead up, the image's right is the robot's left.
    Below,
    /// It looks down.
    Above,
}

/// A calibrated camera on the robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Width and height of its images, in pixels.
    pub image: [u32; 2],
    /// Where ahead is in the image, in radians counter-clockwise from u.
    pub ahead: f64,
    /// Whether the image is mirrored.
    pub seen_from: SeenFrom,
    /// How it sees.
    pub optics: SphericalMirror,
}

impl Camera {
    /// The camera of the design page: a spherical mirror seen from below, 1280 by 960 pixels.
    #[must_use]
    pub fn superscout() -> Self {
        Self {
            image: [1280, 960],
            ahead: std::f64::consts::FRAC_PI_2,
            seen_from: SeenFrom::Below,
            optics: SphericalMirror {
                centre: [640.0, 480.0],
                focal: 1272.8,
                mirror_radius: 0.05,
                mirror_distance: 0.15,
                camera_height: 0.90,
            },
        }
    }

    /// How high above the floor the eye is that sees the floor, in metres.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.optics.camera_height + self.optics.mirror_distance
    }

    /// The point of the floor that a pixel shows; `None` above the horizon and off the mirror.
    #[must_use]
    pub fn pixel_to_ground(&self, pixel: [f64; 2]) -> Option<[f64; 2]> {
        let [u, v] = [pixel[0] - self.optics.centre[0], pixel[1] - self.optics.centre[1]];
        let range = self.optics.range(u.hypot(v))?;
        let azimuth = self.turned((-v).atan2(u) - self.ahead);
        Some([range * azimuth.cos(), range * azimuth.sin()])
    }

    /// The pixel that shows a point of the floor.
    #[must_use]
    pub fn ground_to_pixel(&self, ground: [f64; 2]) -> Option<[f64; 2]> {
        let radius = self.optics.radius(ground[0].hypot(ground[1]))?;
        let angle = self.turned(ground[1].atan2(ground[0])) + self.ahead;
        let [u, v] = self.optics.centre;
        Some([u + radius * angle.cos(), v - radius * angle.sin()])
    }

    /// Whether the floor can be seen in a pixel: neither body, strut nor rim is in the way.
    #[must_use]
    pub fn sees(&self, pixel: [u32; 2]) -> bool {
        self.pixel_to_ground(pixel.map(f64::from)).is_some_and(|[x, y]| x.hypot(y) >= 0.32)
    }

    /// Image angles to floor angles, and back.
    fn turned(&self, angle: f64) -> f64 {
        match self.seen_from {
            SeenFrom::Below => -angle,
            SeenFrom::Above => angle,
        }
    }
}
