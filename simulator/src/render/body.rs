//! The robot in its own camera's image: its body with a laptop on it, the mirror's two struts, and
//! the camera in the middle of the mirror. Section 2.5.
//!
//! A closed laptop lies within the body's outline. An open one stands across it, so that the outline is
//! irregular.

use std::f32::consts::TAU;

use toposlam_vision::params::ROBOT_RADIUS;

use crate::render::{effects::Effects, optics::RayPath, rig::PixelRay};

/// Radius of the robot's body and height of its top, in metres.
const RADIUS: f32 = ROBOT_RADIUS as f32;
const TOP: f32 = 0.35;

/// Half the laptop's length and width, and its height, in metres.
const LAPTOP: [f32; 2] = [0.150, 0.105];
const LAPTOP_TOP: f32 = 0.37;

/// Half the length and width of an open laptop, the top and the thickness of its screen, in metres, and
/// the direction in which it sticks out, in radians from ahead to the left.
const OPEN: [f32; 2] = [0.17, 0.12];
const SCREEN_TOP: f32 = 0.58;
const SCREEN: f32 = 0.02;
const OPEN_AT: f32 = 2.6;

/// Distance of the struts from the axis, and of their feet below the pinhole, in metres.
const STRUT_AT: f32 = 0.055;
const STRUT_FOOT: f32 = 0.03;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RobotPart {
    Lens,
    Housing,
    Strut,
    LaptopEdge,
    Laptop,
    BodyEdge,
    Body,
    Screen,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Body {
    seen: bool,
    lens: f32,
    /// Half the angle that a strut hides, and its direction, in 1/65,536 of a turn.
    strut_half: i32,
    strut_at: u16,
    /// Half a strut's least width, in pixels.
    strut_width: f32,
    /// The distance of an open laptop's far edge from the axis, in metres; 0 if the laptop is closed.
    laptop: f32,
    /// Height of the pinhole, in metres.
    height: f32,
}

impl Body {
    /// The robot under a camera at this height, with images of this width.
    pub(crate) fn new(height: f64, width: u32, effects: &Effects) -> Self {
        let turn = |degrees: f64| degrees / 360.0 * 65_536.0;
        Self {
            seen: effects.body >= 0.5,
            lens: effects.lens as f32,
            strut_half: turn(effects.struts / 2.0) as i32,
            strut_at: turn(effects.strut_bearing) as u32 as u16,
            strut_width: (effects.strut_width / 2.0 * f64::from(width) / 1280.0) as f32,
            laptop: if effects.laptop > 0.0 { RADIUS + effects.laptop as f32 } else { 0.0 },
            height: height as f32,
        }
    }

    /// The part of the robot that a ray meets; `from_middle` is the distance of its pixel from the
    /// middle of the mirror.
    #[inline]
    pub(crate) fn met(&self, ray: &PixelRay, from_middle: impl Fn() -> f32) -> Option<RobotPart> {
        if self.strut_half > 0 || self.strut_width > 0.0 {
            // The struts are opposite each other: half a turn makes no difference.
            let away = i32::from((ray.turn.wrapping_sub(self.strut_at) << 1).cast_signed()) / 2;
            let hides = away.abs() <= self.strut_half && self.strut_half > 0
                || self.strut_width > 0.0
                    && (away as f32 / 65_536.0 * TAU).sin().abs() * from_middle()
                        <= self.strut_width;
            if hides && self.strut_reaches(ray) {
                return Some(RobotPart::Strut);
            }
        }
        // The body is visible only in steep rays downwards.
        if ray.by == RayPath::Direct || ray.direction[2] > -0.7 {
            return self.on_open_laptop(ray);
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
        let part = self.on_open_laptop(ray);
        if part.is_some() || !self.seen {
            return part;
        }
        let [x, y] = at_height(ray, LAPTOP_TOP).map(f32::abs);
        let inside = (LAPTOP[0] - x).min(LAPTOP[1] - y);
        if inside > 0.0 && self.laptop == 0.0 {
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

    fn on_open_laptop(&self, ray: &PixelRay) -> Option<RobotPart> {
        // It is visible only in rays that go down at least this steeply.
        if self.laptop == 0.0 || ray.by == RayPath::Direct || ray.direction[2] > -0.5 {
            return None;
        }
        // Along the laptop's side, and outwards.
        let (sine, cosine) = OPEN_AT.sin_cos();
        let turned = |[x, y, _]: [f32; 3]| [y * cosine - x * sine, x * cosine + y * sine];
        let ([along, out], [aside, outwards]) = (turned(ray.origin), turned(ray.direction));
        // Its screen stands on its far edge.
        let far = self.laptop;
        let at = |height: f32| {
            let length = (height - ray.origin[2]) / ray.direction[2];
            [along + length * aside, out + length * outwards]
        };
        let length = (far - SCREEN - out) / outwards;
        let [on, height] = [along + length * aside, ray.origin[2] + length * ray.direction[2]];
        let on_screen =
            length > 0.0 && on.abs() < OPEN[0] && (LAPTOP_TOP..SCREEN_TOP).contains(&height);
        let [on_top, beyond] = at(SCREEN_TOP);
        if on_screen || on_top.abs() < OPEN[0] && (far - SCREEN..far).contains(&beyond) {
            return Some(RobotPart::Screen);
        }
        let [on, beyond] = at(LAPTOP_TOP);
        let inside = (OPEN[0] - on.abs()).min(OPEN[1] - (beyond - far + OPEN[1]).abs());
        (inside > 0.0).then_some(if inside < 0.012 {
            RobotPart::LaptopEdge
        } else {
            RobotPart::Laptop
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
    pub(crate) fn colour(self) -> [f32; 3] {
        match self {
            Self::Lens => [0.01, 0.01, 0.015],
            Self::Housing => [0.06, 0.06, 0.065],
            Self::Strut => [0.05, 0.05, 0.05],
            Self::LaptopEdge => [0.72, 0.74, 0.76],
            Self::Laptop => [0.035, 0.037, 0.045],
            Self::BodyEdge => [0.30, 0.05, 0.04],
            Self::Body => [0.075, 0.08, 0.09],
            Self::Screen => [0.025, 0.025, 0.03],
        }
    }
}
