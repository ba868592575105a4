//! The robot in its own camera's image: its body with a laptop on it, the mirror's two struts, and
//! the camera in the middle of the mirror. Section 2.5.

use super::effects::Effects;
use super::optics::RayPath;
use super::rig::PixelRay;

/// Radius of the robot's body and height of its top, in metres.
const RADIUS: f32 = 0.205;
const TOP: f32 = 0.35;

/// Half the laptop's length and width, and its height, in metres.
const LAPTOP: [f32; 2] = [0.150, 0.105];
const LAPTOP_TOP: f32 = 0.37;

/// Distance of the struts from the axis, and of their feet below the pinhole, in metres.
const STRUT_AT: f32 = 0.055;
const STRUT_FOOT: f32 = 0.03;

/// A part of the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RobotPart {
    Lens,
    Housing,
    Strut,
    LaptopEdge,
    Laptop,
    BodyEdge,
    Body,
}

/// The parts of the robot that are visible in one image.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body {
    seen: bool,
    lens: f32,
    /// Half the angle that a strut hides, and its direction, in 1/65,536 of a turn.
    strut_half: i32,
    strut_at: u16,
    /// Height of the pinhole, in metres.
    height: f32,
}

impl Body {
    pub(super) fn new(height: f64, effects: &Effects) -> Self {
        let turn = |degrees: f64| degrees / 360.0 * 65_536.0;
        Self {
            seen: effects.body >= 0.5,
            lens: effects.lens as f32,
            strut_half: turn(effects.struts / 2.0) as i32,
            strut_at: turn(effects.strut_bearing) as u32 as u16,
            height: height as f32,
        }
    }

    /// The part of the robot that a ray meets.
    #[inline]
    pub(super) fn met(&self, ray: &PixelRay) -> Option<RobotPart> {
        if self.strut_half > 0 {
            // The struts are opposite each other: half a turn makes no difference.
            let away = i32::from((ray.turn.wrapping_sub(self.strut_at) << 1).cast_signed()) / 2;
            if away.abs() <= self.strut_half && self.strut_reaches(ray) {
                return Some(RobotPart::Strut);
            }
        }
        // The body is visible only in steep rays downwards.
        if ray.by == RayPath::Direct || ray.direction[2] > -0.7 {
            return None;
        }
        if self.lens > 0.0 {
            let [x, y] = at_height(ray, self.height);
            if x * x + y * y < 0.3 * self.lens * self.lens {
                return Some(RobotPart::Lens);
            }
            if x.abs().max(y.abs()) < self.lens {
                return Some(RobotPart::Housing);
            }
        }
        if !self.seen {
            return None;
        }
        let [x, y] = at_height(ray, LAPTOP_TOP).map(f32::abs);
        let inside = (LAPTOP[0] - x).min(LAPTOP[1] - y);
        if inside > 0.0 {
            return Some(if inside < 0.012 { RobotPart::LaptopEdge } else { RobotPart::Laptop });
        }
        let [x, y] = at_height(ray, TOP);
        let from_middle = (x * x + y * y).sqrt();
        (from_middle < RADIUS).then_some(if from_middle > RADIUS - 0.012 {
            RobotPart::BodyEdge
        } else {
            RobotPart::Body
        })
    }

    /// Whether a ray is at the height of the struts where they stand.
    fn strut_reaches(&self, ray: &PixelRay) -> bool {
        let [x, y, z] = ray.origin;
        let level = ray.direction[0].hypot(ray.direction[1]);
        let ahead = (STRUT_AT - x.hypot(y)).max(0.0) / level.max(1e-6);
        z + ahead * ray.direction[2] > self.height - STRUT_FOOT
    }
}

/// The place where a descending ray has this height.
fn at_height(ray: &PixelRay, height: f32) -> [f32; 2] {
    let length = (height - ray.origin[2]) / ray.direction[2];
    [0, 1].map(|axis| ray.origin[axis] + length * ray.direction[axis])
}

impl RobotPart {
    /// The reflectance of the part.
    pub(super) fn colour(self) -> [f32; 3] {
        match self {
            Self::Lens => [0.01, 0.01, 0.015],
            Self::Housing => [0.06, 0.06, 0.065],
            Self::Strut => [0.05, 0.05, 0.05],
            Self::LaptopEdge => [0.72, 0.74, 0.76],
            Self::Laptop => [0.035, 0.037, 0.045],
            Self::BodyEdge => [0.30, 0.05, 0.04],
            Self::Body => [0.075, 0.08, 0.09],
        }
    }
}
