//! The spherical mirror above a camera that looks up, in closed form.

/// A pinhole camera under a spherical mirror, both on a vertical axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalMirror {
    /// Where the axis meets the image, in pixels.
    pub centre: [f64; 2],
    /// Focal length, in pixels.
    pub focal: f64,
    /// Radius of the sphere, in metres.
    pub mirror_radius: f64,
    /// From the pinhole up to the sphere's centre, in metres.
    pub mirror_distance: f64,
    /// From the floor up to the pinhole, in metres.
    pub camera_height: f64,
}

impl SphericalMirror {
    /// How far from the axis the floor is that is seen so many pixels from the centre, in metres.
    #[must_use]
    pub fn range(&self, radius: f64) -> Option<f64> {
        let alpha = (radius / self.focal).atan();
        let sine = self.mirror_distance / self.mirror_radius * alpha.sin();
        if sine > 1.0 {
            return None;
        }
        self.range_at(sine.asin() - alpha, alpha)
    }

    /// The same, by the angle at the sphere's centre and that at the pinhole.
    fn range_at(&self, theta: f64, alpha: f64) -> Option<f64> {
        let psi = alpha + 2.0 * theta;
        let height = self.camera_height + self.mirror_distance;
        let reflected = height - self.mirror_radius * theta.cos();
        (psi < std::f64::consts::FRAC_PI_2)
            .then(|| self.mirror_radius * theta.sin() + reflected * psi.tan())
    }

    /// How many pixels from the centre the floor is seen that is so far from the axis.
    #[must_use]
    pub fn radius(&self, range: f64) -> Option<f64> {
        let rim = self.focal * (self.mirror_radius / self.mirror_distance).asin().tan();
        let (mut near, mut far) = (0.0, rim);
        for _ in 0..60 {
            let middle = f64::midpoint(near, far);
            if self.range(middle).is_some_and(|found| found < range) {
                near = middle;
            } else {
                far = middle;
            }
        }
        (range >= 0.0).then_some(near)
    }
}
