//! Sensors of simulated robots: one rig, and the colours that were learned for each look.

use std::sync::Arc;

use rayon::prelude::*;
use toposlam_model::enumerate::Watch;
use toposlam_vision::{camera::Camera, colour::ColourModel, sensing::Sensor};

use super::{
    colour_learning::{LearningError, learned},
    view_sampler::{ViewError, ViewSampler},
};
use crate::{BuildingLook, Rig};

/// The rig and the sensors of robots with one camera in buildings of several looks.
#[derive(Debug)]
pub struct LearnedSensors {
    camera: Camera,
    rig: Arc<Rig>,
    looks: Vec<(&'static BuildingLook, ColourModel)>,
}

/// The seed of the views from which colours are learned. No view of this seed is judged.
const LEARNING: u64 = 1;

impl LearnedSensors {
    /// Learns the colours of looks with a calibrated camera, as `evaluate vision` does.
    ///
    /// # Errors
    /// Returns an error if the colours cannot be learned, or if the watch stops.
    pub fn new(
        camera: &Camera,
        looks: &[&'static BuildingLook],
        watch: &dyn Watch,
    ) -> Result<Self, LearningError> {
        let rig = Rig::new(camera);
        let views = ViewSampler::of(looks.iter().copied(), camera.image, LEARNING)
            .map_err(|_| ViewError::NoPlan)?;
        let views = ViewSampler { random_plans: true, ..views };
        watch.parts(looks.len());
        let learn = |&look: &&'static BuildingLook| {
            let colours = learned(&views, look, camera, &rig, watch)?;
            watch.part_done(1);
            Ok((look, colours))
        };
        let looks = looks.par_iter().map(learn).collect::<Result<Vec<_>, LearningError>>()?;
        if looks.is_empty() {
            return Err(ViewError::NoLook.into());
        }
        Ok(Self { camera: camera.clone(), rig: Arc::new(rig), looks })
    }

    /// Sensors for one look with colours that were learned elsewhere.
    #[must_use]
    pub fn with_colours(
        camera: &Camera,
        look: &'static BuildingLook,
        colours: ColourModel,
    ) -> Self {
        let rig = Arc::new(Rig::new(camera));
        Self { camera: camera.clone(), rig, looks: vec![(look, colours)] }
    }

    /// The camera's rig.
    #[must_use]
    pub fn rig(&self) -> &Arc<Rig> {
        &self.rig
    }

    /// The look for a number, in turn.
    #[must_use]
    pub fn look(&self, number: u64) -> &'static BuildingLook {
        self.looks[(number % self.looks.len() as u64) as usize].0
    }

    /// The colours of a look, or those of the first look if it is unknown.
    #[must_use]
    pub fn colours(&self, look: &'static BuildingLook) -> &ColourModel {
        let known = self.looks.iter().find(|(known, _)| known.name == look.name);
        &known.unwrap_or(&self.looks[0]).1
    }

    /// A sensor for a look, or for the first look if it is unknown.
    #[must_use]
    pub fn sensor(&self, look: &'static BuildingLook) -> Sensor {
        Sensor::new(&self.camera, self.colours(look))
    }
}
