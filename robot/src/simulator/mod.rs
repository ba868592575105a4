//! A simulated building, the images of a camera in it, and a simulated robot. Sections 2.4 and 2.5.
//!
//! A [`Building`] is built from a floor plan, one of the [`LOOKS`] and a seed; a [`Rig`] from a
//! calibrated camera. [`render`] returns the image that the rig takes from a [`Pose`], and
//! [`labels`] the class of each of its pixels. [`Effects`] make images harder to read. A
//! [`SimulatedRobot`] drives in the building, with [`MotionNoise`] and [`RobotFault`]s. It has a camera, a
//! [`LaserScanner`], or both.

#![allow(clippy::cast_sign_loss, reason = "positions in meshes and tables are not negative")]

mod body;
mod building;
mod cables;
mod cameras;
mod config;
mod effects;
mod exposure;
mod faults;
mod furniture;
mod labels;
mod light_map;
mod lights;
mod looks;
mod motion;
mod optics;
mod overhead;
mod random_stream;
mod renderer;
mod rig;
mod scanner;
mod sight_lines;
mod simulated_robot;
mod squares;
mod surfaces;
mod surroundings;
mod walls;
mod world_ray;

pub use crate::pose::Pose;
pub use building::Building;
pub use cameras::{MarkerDetector, RenderingCamera, SceneCamera, SimulatedCamera};
pub use config::{IMAGE_TIME, SimulationConfig, start_pose};
pub use effects::{EffectScope, EffectSettings, Effects, KNOBS, Knob, KnobError};
pub use faults::{FAULTS, FOR_EVER, FaultError, FaultKind, RobotFault};
pub use labels::{label_mask, labels};
pub use looks::{BuildingLook, Colour, FloorCovering, LOOKS};
pub use motion::{MotionNoise, SimulatedBase};
pub use optics::{CameraRay, RayPath, RigErrors};
pub use renderer::render;
pub use rig::Rig;
pub use scanner::{
    ConvexPolygon, Corridor, CorridorPlan, LaserScanner, Lobby, ScannedBuilding, ScannedWall,
    ScannerParams, WallSurface,
};
pub use simulated_robot::SimulatedRobot;
pub use walls::{BuildingWall, walls};
