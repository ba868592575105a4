//! A view: a pose in a building, and all that its image depends on.

use std::sync::Arc;

use image::RgbImage;
use toposlam_model::{driving::pose::Pose, embedded_graph::Dart, floor_plan::FloorPlan};

use crate::{
    Building, BuildingLook, Effects, Rig, render,
    truth::{MarkerTruth, Truth},
};

/// A pose in a building, and all that its image depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderedView {
    /// Its number among the views of the seed.
    pub number: u64,
    /// The plan's name.
    pub plan_name: String,
    /// The floor plan.
    pub plan: Arc<FloorPlan>,
    /// The look of the building.
    pub look: &'static BuildingLook,
    /// The effects that make the image harder to read.
    pub effects: Effects,
    /// The dart along which the marker lies, if there is a marker.
    pub marker: Option<Dart>,
    /// The robot's pose.
    pub pose: Pose,
    /// Width and height of the image, in pixels.
    pub image: [u32; 2],
    /// Random seeds of the building and of the image.
    pub seeds: [u64; 2],
}

impl RenderedView {
    /// The ground truth; `None` if the pose is not on the floor.
    #[must_use]
    pub fn truth(&self) -> Option<Truth> {
        Truth::at(&self.plan, self.pose)
    }

    /// The marker's true place, relative to the robot.
    #[must_use]
    pub fn marker(&self) -> Option<MarkerTruth> {
        self.marker.map(|dart| MarkerTruth::of(&self.plan, dart, self.pose))
    }

    /// The building.
    #[must_use]
    pub fn building(&self) -> Building {
        Building::new(&self.plan, self.look, self.marker, &self.effects, self.seeds[0])
    }

    /// The image that a rig takes.
    #[must_use]
    pub fn render(&self, rig: &Rig, building: &Building) -> RgbImage {
        render(rig, building, self.pose, &self.effects, self.seeds[1])
    }
}

/// The effects of views.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhichEffects {
    /// Each effect is drawn from its default range.
    Default,
    /// No effects.
    None,
}
