//! A simulated robot. Sections 2.4 and 2.5.
//!
//! A [`SimulatedRobot`] drives in a [`Building`], with [`MotionNoise`] and [`RobotFault`]s. It has a camera, a
//! [`LaserScanner`], or both. The building and its images are those of the crate `toposlam_render`.

#![allow(clippy::cast_sign_loss, reason = "positions in meshes and tables are not negative")]

mod cameras;
mod config;
mod faults;
mod motion;
mod scanner;
mod simulated_robot;
mod surroundings;

pub use cameras::{MarkerDetector, RenderingCamera, SceneCamera, SimulatedCamera};
pub use config::{IMAGE_TIME, SimulationConfig, start_pose};
pub use faults::{FAULTS, FOR_EVER, FaultError, FaultKind, RobotFault};
pub use motion::{MotionNoise, SimulatedBase};
pub use scanner::{
    ConvexPolygon, Corridor, CorridorPlan, LaserScanner, Lobby, ScannedBuilding, ScannedWall,
    ScannerParams, WallSurface,
};
pub use simulated_robot::SimulatedRobot;
pub use toposlam_render::{
    Building, BuildingLook, BuildingWall, CameraRay, Colour, EffectScope, EffectSettings, Effects,
    FloorCovering, KNOBS, Knob, KnobError, LOOKS, RayPath, Rig, RigErrors, label_mask, labels,
    render, walls,
};
