//! Renders the camera's image of a building from a pose. Section 2.5.

use image::RgbImage;
use toposlam_model::driving::pose::Pose;

use crate::render::{
    body::Body,
    building::Building,
    effects::Effects,
    exposure::{Light, compressed, expose},
    furniture::BlocksAround,
    optics::RayPath,
    rig::{PixelRay, Rig, WorldRay},
    sight_lines::SightLines,
    surfaces::{BuildingView, Surface},
};

/// The number of rays along and across a pixel in which several surfaces meet.
const FINE: usize = 3;

/// The share of the light that reaches the camera past the mirror.
const BESIDE_MIRROR: f32 = 0.35;

/// The image of a building that a rig takes from a pose.
///
/// The same arguments give the same image, byte for byte. From a pose that is not on the floor, the
/// image is meaningless.
pub fn render(
    rig: &Rig,
    building: &Building,
    pose: Pose,
    effects: &Effects,
    seed: u64,
) -> RgbImage {
    compressed(exposed(rig, building, pose, effects, seed), effects)
}

/// The image before it is compressed.
pub fn exposed(
    rig: &Rig,
    building: &Building,
    pose: Pose,
    effects: &Effects,
    seed: u64,
) -> RgbImage {
    expose(Shot::new(rig, building, pose, effects).light(), rig, effects, seed)
}

pub(crate) struct Shot<'a> {
    rig: &'a Rig,
    view: BuildingView<'a>,
    body: Body,
    /// The robot's position, its heading as cosine and sine, and its heading in 1/65,536 of a turn.
    position: [f32; 2],
    heading: [f32; 2],
    turn: u16,
    light: f32,
    holder: f32,
}

impl<'a> Shot<'a> {
    pub(crate) fn new(rig: &'a Rig, building: &'a Building, pose: Pose, effects: &Effects) -> Self {
        let position = pose.position.map(|coordinate| coordinate as f32);
        let (sine, cosine) = pose.heading.sin_cos();
        let turns = (pose.heading / std::f64::consts::TAU).rem_euclid(1.0);
        Self {
            rig,
            view: BuildingView {
                building,
                lines: SightLines::from(pose.position, rig.off_axis, building.walls()),
                blocks: BlocksAround::new(pose.position, rig.off_axis, &building.furniture),
            },
            body: Body::new(rig.optics.height, rig.image()[0], effects),
            position,
            heading: [cosine as f32, sine as f32],
            turn: (turns * 65_536.0) as u32 as u16,
            light: building.light.on_floor(position),
            holder: rig.optics.rim() as f32 * (1.0 + effects.holder) as f32,
        }
    }

    /// The light of the image: one ray per pixel, and more rays where its neighbours show other surfaces.
    fn light(&self) -> Light {
        let [width, height] = self.rig.image().map(|length| length as usize);
        let mut seen = Vec::with_capacity(width * height);
        for (v, rays) in self.rig.rays.chunks(width.max(1)).enumerate() {
            for (u, ray) in rays.iter().enumerate() {
                let (surface, light) = self.seen(ray, [u as f32, v as f32], 1.0);
                seen.push((surface.number(), light));
            }
        }
        let some =
            (0..height).step_by(16).flat_map(|v| (0..width).step_by(16).map(move |u| (u, v)));
        let mean = mean(some.map(|(u, v)| seen[v * width + u].1));
        let surface = |u: usize, v: usize| seen[v * width + u].0;
        let mut pixels = Vec::with_capacity(3 * width * height);
        for v in 0..height {
            for u in 0..width {
                let (here, light) = seen[v * width + u];
                let other = (here ^ surface(u, v.saturating_sub(1)))
                    | (here ^ surface(u, (v + 1).min(height - 1)))
                    | (here ^ surface(u.saturating_sub(1), v))
                    | (here ^ surface((u + 1).min(width - 1), v));
                pixels.extend(if other == 0 { light } else { self.finely(u, v) });
            }
        }
        Light { pixels, mean }
    }

    /// The surface that a ray through a place in the image meets, and its light; for a pixel of
    /// this size.
    #[inline]
    pub(crate) fn seen(&self, ray: &PixelRay, place: [f32; 2], size: f32) -> (Surface, [f32; 3]) {
        if let Some(part) = self.body.met(ray, || self.off_middle(place)) {
            let light = self.light;
            return (Surface::Robot(part), part.colour().map(|channel| channel * light));
        }
        if ray.by == RayPath::Direct {
            if self.off_middle(place) < self.holder {
                return (Surface::Holder, [0.01; 3]);
            }
            let (surface, colour) = self.view.seen(&self.world(ray), || [0.0; 2]);
            return (surface, colour.map(|channel| channel * BESIDE_MIRROR));
        }
        let world = self.world(ray);
        if let Some(piece) = self.view.building.overhead.met(&world) {
            return (Surface::Overhead(piece.number), piece.colour());
        }
        self.view.seen(&world, || {
            let from_middle = self.off_middle(place);
            let [x, y, down] = ray.direction;
            let range = -ray.origin[2] / down * (x * x + y * y).sqrt();
            [self.rig.stride(from_middle) * size, range / from_middle.max(1.0) * size]
        })
    }

    #[cold]
    fn finely(&self, u: usize, v: usize) -> [f32; 3] {
        let bundle = Bundle::new(self.rig, u, v);
        let step = |number: usize| (number as f32 + 0.5) / FINE as f32 - 0.5;
        mean((0..FINE * FINE).map(|ray| {
            let [right, down] = [step(ray % FINE), step(ray / FINE)];
            let place = [u as f32 + right, v as f32 + down];
            self.seen(&bundle.ray(right, down), place, 1.0 / FINE as f32).1
        }))
    }

    fn off_middle(&self, place: [f32; 2]) -> f32 {
        let [u, v] = self.rig.optics.centre;
        let [u, v] = [place[0] - u as f32, place[1] - v as f32];
        (u * u + v * v).sqrt()
    }

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

enum Bundle<'a> {
    /// Linear interpolation between the pixel's neighbours, which is exact enough within a pixel.
    Straight { middle: PixelRay, rightwards: [f32; 7], downwards: [f32; 7] },
    /// At the mirror's rim and the image's border, each ray is computed.
    Each { rig: &'a Rig, pixel: [f64; 2] },
}

impl<'a> Bundle<'a> {
    fn new(rig: &'a Rig, u: usize, v: usize) -> Self {
        let [width, height] = rig.image().map(|length| length as usize);
        let each = Self::Each { rig, pixel: [u as f64, v as f64] };
        if u == 0 || v == 0 || u + 1 >= width || v + 1 >= height {
            return each;
        }
        let at = v * width + u;
        let around = [at - 1, at + 1, at - width, at + width].map(|at| rig.rays[at]);
        let middle = rig.rays[at];
        // In the middle of the mirror, interpolation is not exact enough.
        if around.iter().any(|ray| ray.by != middle.by) || middle.direction[2] < -0.98 {
            return each;
        }
        let [left, right, above, below] = around;
        Self::Straight {
            middle,
            rightwards: change(&left, &right),
            downwards: change(&above, &below),
        }
    }

    fn ray(&self, right: f32, down: f32) -> PixelRay {
        match self {
            Self::Each { rig, pixel: [u, v] } => {
                rig.optics.ray([u + f64::from(right), v + f64::from(down)]).into()
            }
            Self::Straight { middle, rightwards, downwards } => {
                let by = |number: usize| right * rightwards[number] + down * downwards[number];
                PixelRay {
                    origin: [0, 1, 2].map(|axis| middle.origin[axis] + by(axis)),
                    direction: [0, 1, 2].map(|axis| middle.direction[axis] + by(3 + axis)),
                    turn: middle.turn.wrapping_add_signed(by(6) as i16),
                    by: middle.by,
                }
            }
        }
    }
}

/// Half of the difference of two rays: origin, direction and turn.
fn change(one: &PixelRay, other: &PixelRay) -> [f32; 7] {
    let half = |one: f32, other: f32| (other - one) / 2.0;
    let [x, y, z] = [0, 1, 2].map(|axis| half(one.origin[axis], other.origin[axis]));
    let [along, left, up] = [0, 1, 2].map(|axis| half(one.direction[axis], other.direction[axis]));
    let turn = f32::from(other.turn.wrapping_sub(one.turn).cast_signed()) / 2.0;
    [x, y, z, along, left, up, turn]
}

fn mean(light: impl Iterator<Item = [f32; 3]>) -> [f32; 3] {
    let (mut sum, mut count) = ([0.0; 3], 0);
    for light in light {
        for (sum, channel) in sum.iter_mut().zip(light) {
            *sum += channel;
        }
        count += 1;
    }
    sum.map(|sum: f32| sum / count.max(1) as f32)
}

#[cfg(test)]
mod tests {
    use toposlam_vision::camera::Camera;

    use super::*;
    use crate::render::{RigErrors, sight_lines::TURN_ERROR};

    fn apart(one: &PixelRay, other: &PixelRay) -> f32 {
        let square = |axis: usize| (one.direction[axis] - other.direction[axis]).powi(2);
        (0..3).map(square).sum::<f32>().sqrt()
    }

    #[test]
    fn interpolated_rays_are_exact_enough() {
        for width in [640, 1280] {
            let camera = Camera::superscout().sized([width, width * 3 / 4]);
            let errors = RigErrors { tilt: 0.03, towards: 1.0, ..RigErrors::default() };
            let rig = Rig::with_errors(&camera, &errors);
            let [width, height] = rig.image();
            let mut straight = 0;
            let pixels =
                (0..width).step_by(7).flat_map(|u| (0..height).step_by(5).map(move |v| [u, v]));
            for [u, v] in pixels {
                let bundle = Bundle::new(&rig, u as usize, v as usize);
                straight += u32::from(matches!(bundle, Bundle::Straight { .. }));
                let [u, v] = [u, v].map(f64::from);
                let exact = |right, down| PixelRay::from(rig.ray([u + right, v + down]));
                let here = exact(0.0, 0.0);
                let pixel = apart(&here, &exact(1.0, 0.0)).max(apart(&here, &exact(0.0, 1.0)));
                // At the rim the mirror is curved more and more.
                let [middle_u, middle_v] = rig.optics.centre;
                let within = (u - middle_u).hypot(v - middle_v) < 0.97 * rig.optics.rim();
                let allowed = if within { 0.03 } else { 0.5 };
                for [right, down] in [[-0.375, 0.25], [0.5, 0.5], [0.0, -0.5]] {
                    let ray = bundle.ray(right as f32, down as f32);
                    let exact = exact(right, down);
                    assert!(apart(&ray, &exact) < allowed * pixel, "{u} {v}");
                    let turned = ray.turn.wrapping_sub(exact.turn).cast_signed();
                    assert!(i64::from(turned.abs()) < TURN_ERROR, "{u} {v}: {turned}");
                }
            }
            assert!(straight > width * height / 70, "{straight}");
        }
    }
}
