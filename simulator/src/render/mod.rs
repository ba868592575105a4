//! A simulated building, and the images that a camera with a mirror takes in it. Section 2.4.
//!
//! A [`Building`] is built from a floor plan, one of the [`LOOKS`] and a seed; a [`Rig`] from a
//! calibrated camera. [`render`] returns the image that the rig takes from a pose, and
//! [`labels`] the class of each of its pixels. [`Effects`] make images harder to read. A simulation takes all that is
//! random from a [`stream`].

mod body;
mod building;
mod cables;
mod effects;
mod exposure;
mod furniture;
mod labels;
mod light_map;
mod lights;
mod looks;
mod optics;
mod overhead;
mod random_stream;
mod renderer;
mod rig;
mod sight_lines;
mod squares;
mod surfaces;

pub use building::Building;
pub use effects::{EffectScope, EffectSettings, Effects, KNOBS, Knob, KnobError};
pub use exposure::file;
pub use labels::{label_mask, labels};
pub use looks::{BuildingLook, Colour, FloorCovering, LOOKS};
pub use optics::{CameraRay, RayPath, RigErrors};
pub use random_stream::{StreamPurpose, about, clouds, stream};
pub use renderer::{exposed, render};
pub use rig::Rig;
pub use squares::Squares;
