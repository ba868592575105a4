//! A simulated robot in a simulated building, and the evaluation of sensing, driving and mapping there. Sections
//! 2.4, 2.5 and 4 to 6.
//!
//! A [`SimulatedRobot`] drives in a [`Building`], with [`MotionNoise`] and [`RobotFault`]s. It has a camera, whose images
//! [`mod@render`] makes, a [`LaserScanner`], or both.

// Tests compare exact numbers.
#![cfg_attr(test, allow(clippy::float_cmp))]
#![allow(
    clippy::missing_errors_doc,
    reason = "only the programs of this workspace use this crate, and its error types say what is wrong"
)]
#![allow(clippy::cast_sign_loss, reason = "positions in meshes and tables are not negative")]

mod cameras;
mod config;
pub mod evaluation;
mod faults;
pub mod ground_truth_monitor;
mod learned_sensors;
#[cfg(feature = "live")]
pub mod live;
mod motion;
mod obstacle_judge;
#[cfg(feature = "evaluate")]
pub mod options;
mod plans;
#[cfg(test)]
mod question_limit;
pub mod random_plan;
pub mod render;
pub mod run;
pub mod sample_verdict;
mod scanner;
mod sent_robot;
mod simulated_robot;
mod surroundings;
pub mod truth;
pub mod view_sampler;

pub use crate::render::{
    Building, BuildingLook, CameraRay, Colour, EffectScope, EffectSettings, Effects, FloorCovering,
    KNOBS, Knob, KnobError, LOOKS, RayPath, Rig, RigErrors, label_mask, labels, render,
};
pub use config::{SimulationConfig, corridor_starts_of, start_pose, starts_of};
pub use faults::{FAULTS, FOR_EVER, FaultError, FaultKind, RobotFault};
pub use learned_sensors::{LearnedSensors, LearningError, learned};
pub use motion::{MotionNoise, SimulatedBase};
pub use plans::{NamedPlan, plan_named, plans};
pub use scanner::{
    ConvexPolygon, Corridor, CorridorPlan, LaserScanner, Lobby, NamedScanner, SCANNERS,
    ScannerParams, Segment, ShortRangeError,
};
pub use simulated_robot::{RobotEquipment, SimulatedRobot};
