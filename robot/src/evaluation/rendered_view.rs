//! A view: where a robot is, in which building, and what its camera sees there.

use std::sync::Arc;

use image::RgbImage;
use toposlam_model::{embedded_graph::Dart, floor_plan::FloorPlan};

use crate::simulator::{Building, BuildingLook, Effects, Pose, Rig, render};
use crate::truth::{MarkerTruth, Truth};

/// A place for a robot, and what there is to see.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderedView {
    /// Its number among the views of its seed.
    pub number: u64,
    /// The name of the plan.
    pub plan_name: String,
    /// The floor plan.
    pub plan: Arc<FloorPlan>,
    /// What the building looks like.
    pub look: &'static BuildingLook,
    /// What makes the picture harder to read.
    pub effects: Effects,
    /// The dart along which the marker lies, if there is one.
    pub marker: Option<Dart>,
    /// Where the robot is.
    pub pose: Pose,
    /// Width and height of the picture.
    pub image: [u32; 2],
    /// What else there is by chance in the building, and in the picture.
    pub seeds: [u64; 2],
}

impl RenderedView {
    /// What is true there.
    #[must_use]
    pub fn truth(&self) -> Option<Truth> {
        Truth::at(&self.plan, self.pose)
    }

    /// Where the marker lies.
    #[must_use]
    pub fn marker(&self) -> Option<MarkerTruth> {
        self.marker.map(|dart| MarkerTruth::of(&self.plan, dart, self.pose))
    }

    /// The building.
    #[must_use]
    pub fn building(&self) -> Building {
        Building::new(&self.plan, self.look, self.marker, &self.effects, self.seeds[0])
    }

    /// What a rig sees there.
    #[must_use]
    pub fn picture(&self, rig: &Rig, building: &Building) -> RgbImage {
        render(rig, building, self.pose, &self.effects, self.seeds[1])
    }
}

/// Which effects there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhichEffects {
    /// Each drawn from its default range.
    Default,
    /// None.
    None,
}
