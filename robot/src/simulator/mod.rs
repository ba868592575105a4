//! A building, what the robot's camera sees of it, and a robot in it. Sections 2.4 and 2.5.
//!
//! A [`Building`] is made of a floor plan, one of the [`LOOKS`] and a seed; a [`Rig`] of a calibrated
//! camera. [`render`] is the picture that the rig takes from a [`Pose`], and [`labels`] what each pixel
//! of it shows. [`Effects`] make pictures harder to read. A [`SimulatedRobot`] drives in it, with
//! [`MotionNoise`] and [`Fault`]s.

#![allow(clippy::cast_sign_loss, reason = "positions in meshes and tables are not negative")]

mod body;
mod building;
mod cameras;
mod chance;
mod effects;
mod exposure;
mod faults;
mod labels;
mod light_map;
mod lights;
mod looks;
mod motion;
mod optics;
mod renderer;
mod rig;
mod setting;
mod sight_lines;
mod simulated;
mod squares;
mod surfaces;
mod surroundings;
mod walls;

pub use crate::pose::Pose;
pub use building::Building;
pub use cameras::{Camera, RenderingCamera, SceneCamera, ToldScene};
pub use effects::{Effects, KNOBS, Knob, KnobError, Of};
pub use faults::{FAULTS, Fault, FaultKind, NoFault};
pub use labels::{label_mask, labels};
pub use looks::{Colour, Floor, LOOKS, Look};
pub use motion::{MotionNoise, SimulatedBase};
pub use optics::{By, Ray, RigErrors};
pub use renderer::render;
pub use rig::Rig;
pub use setting::{PICTURE_TIME, Setting, start_pose};
pub use simulated::SimulatedRobot;
pub use walls::{Wall, walls};
