//! A building, and what the robot's camera sees of it. Section 2.4.
//!
//! A [`Building`] is made of a floor plan, one of the [`LOOKS`] and a seed; a [`Rig`] of a calibrated
//! camera. [`render`] is the picture that the rig takes from a [`Pose`], and [`labels`] what each pixel
//! of it shows. [`Effects`] make pictures harder to read.

#![allow(clippy::cast_sign_loss, reason = "positions in meshes and tables are not negative")]

mod body;
mod building;
mod chance;
mod effects;
mod exposure;
mod labels;
mod light_map;
mod lights;
mod looks;
mod optics;
mod pose;
mod renderer;
mod rig;
mod sight_lines;
mod squares;
mod surfaces;
mod walls;

pub use building::Building;
pub use effects::{Effects, KNOBS, Knob, KnobError, Of};
pub use labels::{label_mask, labels};
pub use looks::{Colour, Floor, LOOKS, Look};
pub use optics::{By, Ray, RigErrors};
pub use pose::Pose;
pub use renderer::render;
pub use rig::Rig;
pub use walls::{Wall, walls};
