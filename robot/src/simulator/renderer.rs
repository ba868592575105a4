//! What the robot's camera sees: a picture of a building from a pose. Section 2.5.

use image::RgbImage;

use super::body::Body;
use super::building::Building;
use super::effects::Effects;
use super::exposure::{Light, expose};
use super::optics::By;
use super::pose::Pose;
use super::rig::{PixelRay, Rig};
use super::sight_lines::SightLines;
use super::surfaces::{Surface, View, WorldRay};

/// How many rays along and across a pixel there are where different things meet in it.
const FINE: u32 = 4;

/// How much of the light that passes the mirror by reaches the camera.
const BESIDE_MIRROR: f32 = 0.35;

/// How much wider than the mirror its holder is.
const HOLDER: f64 = 1.03;

/// A rig in a building, at a pose.
pub(super) struct Shot<'a> {
    rig: &'a Rig,
    view: View<'a>,
    body: Body,
    /// Where the robot is, and its heading as cosine and sine and in 65,536 to a full turn.
    position: [f32; 2],
    heading: [f32; 2],
    turn: u16,
    /// The light on the robot's body.
    light: f32,
    rim: f32,
}

/// The picture that a rig takes of a building from a pose.
///
/// The same arguments give the same picture, byte for byte. From a pose that is not on the building's
/// floor there is a picture too, of no use.
#[must_use]
pub fn render(
    rig: &Rig,
    building: &Building,
    pose: Pose,
    effects: &Effects,
    seed: u64,
) -> RgbImage {
    let lines = SightLines::from(pose.position, rig.off_axis, building.walls());
    let shot = Shot::new(rig, building, &lines, pose, effects);
    expose(shot.light(), rig, effects, seed)
}

impl<'a> Shot<'a> {
    pub(super) fn new(
        rig: &'a Rig,
        building: &'a Building,
        lines: &'a SightLines,
        pose: Pose,
        effects: &Effects,
    ) -> Self {
        let position = pose.position.map(|coordinate| coordinate as f32);
        let (sine, cosine) = pose.heading.sin_cos();
        let turns = (pose.heading / std::f64::consts::TAU).rem_euclid(1.0);
        Self {
            rig,
            view: View { building, lines },
            body: Body::new(rig.optics.height, effects),
            position,
            heading: [cosine as f32, sine as f32],
            turn: (turns * 65_536.0) as u32 as u16,
            light: building.light.on_floor(position),
            rim: rig.optics.rim() as f32,
        }
    }

    /// The light that comes to every pixel.
    fn light(&self) -> Light {
        let [width, height] = self.rig.image();
        let mut surfaces = Vec::with_capacity(self.rig.rays.len());
        let mut light = Vec::with_capacity(self.rig.rays.len());
        let mut rays = self.rig.rays.iter();
        for v in 0..height {
            for (u, ray) in (0..width).zip(&mut rays) {
                let (surface, colour) = self.seen(ray, [u as f32, v as f32], 1.0);
                surfaces.push(surface);
                light.push(colour);
            }
        }
        self.refine(&surfaces, &mut light);
        Light { width: width as usize, pixels: light }
    }

    /// Looks more closely where neighbouring pixels show different things.
    fn refine(&self, surfaces: &[Surface], light: &mut [[f32; 3]]) {
        let [width, height] = self.rig.image().map(|length| length as usize);
        for v in 0..height {
            for u in 0..width {
                let at = v * width + u;
                let here = surfaces[at];
                let edge = (u > 0 && surfaces[at - 1] != here)
                    || (u + 1 < width && surfaces[at + 1] != here)
                    || (v > 0 && surfaces[at - width] != here)
                    || (v + 1 < height && surfaces[at + width] != here);
                if edge {
                    light[at] = self.finely([u as f64, v as f64]);
                }
            }
        }
    }

    /// The light that comes to a pixel, as the mean of many rays.
    fn finely(&self, pixel: [f64; 2]) -> [f32; 3] {
        let mut sum = [0.0; 3];
        let step = |number: u32| (f64::from(number) + 0.5) / f64::from(FINE) - 0.5;
        for row in 0..FINE {
            for column in 0..FINE {
                let place = [pixel[0] + step(column), pixel[1] + step(row)];
                let ray = self.rig.optics.ray(place).into();
                let place = place.map(|at| at as f32);
                let (_, colour) = self.seen(&ray, place, 1.0 / FINE as f32);
                for (sum, channel) in sum.iter_mut().zip(colour) {
                    *sum += channel;
                }
            }
        }
        sum.map(|channel| channel / (FINE * FINE) as f32)
    }

    /// What the ray of a place in the image meets, and the light that comes back; of a pixel so large.
    #[inline]
    fn seen(&self, ray: &PixelRay, place: [f32; 2], size: f32) -> (Surface, [f32; 3]) {
        if let Some(part) = self.body.met(ray) {
            let light = self.light;
            return (Surface::Robot(part), part.colour().map(|channel| channel * light));
        }
        if ray.by == By::Itself {
            if self.from_middle(place) < self.rim * HOLDER as f32 {
                return (Surface::Holder, [0.01; 3]);
            }
            let (surface, colour) = self.view.seen(&self.world(ray), || [0.0; 2]);
            return (surface, colour.map(|channel| channel * BESIDE_MIRROR));
        }
        let world = self.world(ray);
        self.view.seen(&world, || {
            let from_middle = self.from_middle(place);
            let drop = -ray.origin[2] / ray.direction[2];
            let range = drop * ray.direction[0].hypot(ray.direction[1]);
            [self.rig.stride(from_middle) * size, range / from_middle.max(1.0) * size]
        })
    }

    /// What a pixel shows in its middle.
    pub(super) fn surface(&self, u: u32, v: u32) -> Surface {
        let ray = &self.rig.rays[(v * self.rig.image()[0] + u) as usize];
        if let Some(part) = self.body.met(ray) {
            Surface::Robot(part)
        } else if ray.by == By::Itself {
            Surface::Holder
        } else {
            self.view.surface(&self.world(ray))
        }
    }

    fn from_middle(&self, place: [f32; 2]) -> f32 {
        let [u, v] = self.rig.optics.centre;
        (place[0] - u as f32).hypot(place[1] - v as f32)
    }

    /// A ray in the building's coordinates.
    #[inline]
    fn world(&self, ray: &PixelRay) -> WorldRay {
        let [cosine, sine] = self.heading;
        let turned = |[x, y, z]: [f32; 3]| [x * cosine - y * sine, x * sine + y * cosine, z];
        let [x, y, z] = turned(ray.origin);
        WorldRay {
            origin: [x + self.position[0], y + self.position[1], z],
            direction: turned(ray.direction),
            turn: ray.turn.wrapping_add(self.turn),
        }
    }
}
