//! Sensors of simulated robots: one rig, and the colours of each look, which are learned from rendered images that are
//! not used for judging.

use std::sync::Arc;

use rayon::prelude::*;
use thiserror::Error;
use toposlam_model::enumerate::{Interrupted, Watch};
use toposlam_vision::{
    camera::Camera,
    colour::{ColourModel, ExampleError, Training, TrainingError},
    sensing::Sensor,
};

use super::view_sampler::{ViewError, ViewSampler};
use crate::{BuildingLook, Rig, label_mask, labels};

/// The number of images from which the colours of a look are learned.
const IMAGES: u64 = 16;

#[derive(Debug, Error)]
pub enum LearningError {
    #[error(transparent)]
    View(#[from] ViewError),
    #[error("look {look}: {cause}")]
    Training { look: &'static str, cause: TrainingError },
    #[error("look {look}: {cause}")]
    Example { look: &'static str, cause: ExampleError },
    #[error(transparent)]
    Interrupted(#[from] Interrupted),
}

/// Learns the colours of a look with a camera and its rig.
pub fn learned(
    views: &ViewSampler,
    look: &'static BuildingLook,
    camera: &Camera,
    rig: &Rig,
    watch: &dyn Watch,
) -> Result<ColourModel, LearningError> {
    let mut training = Training::new(look.stripe);
    for number in 0..IMAGES {
        watch.check_stop()?;
        let view = views.to_learn_from(look, camera.image, number)?;
        let building = view.building();
        let classes = labels(rig, &building, view.pose, &view.effects);
        let mask = label_mask(rig, &classes);
        watch.check_stop()?;
        match training.add(camera, &view.render(rig, &building), &mask) {
            // Skip images that are too dark to measure their light.
            Ok(()) | Err(ExampleError::Light(_)) => {}
            Err(cause) => return Err(LearningError::Example { look: look.name, cause }),
        }
    }
    training.model().map_err(|cause| LearningError::Training { look: look.name, cause })
}

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
    pub fn new(
        camera: &Camera,
        looks: &[&'static BuildingLook],
        watch: &dyn Watch,
    ) -> Result<Self, LearningError> {
        let views = ViewSampler::from_looks(looks.iter().copied(), camera.image, LEARNING)
            .map_err(|_| ViewError::NoPlan)?;
        Self::from_views(camera, &ViewSampler { random_plans: true, ..views }, watch)
    }

    /// Learns the colours of the looks of views.
    pub fn from_views(
        camera: &Camera,
        views: &ViewSampler,
        watch: &dyn Watch,
    ) -> Result<Self, LearningError> {
        let rig = Rig::new(camera);
        watch.parts(views.looks.len());
        let learn = |&look: &&'static BuildingLook| {
            let colours = learned(views, look, camera, &rig, watch)?;
            watch.part_done(1);
            Ok((look, colours))
        };
        let looks = views.looks.par_iter().map(learn).collect::<Result<Vec<_>, LearningError>>()?;
        if looks.is_empty() {
            return Err(ViewError::NoLook.into());
        }
        Ok(Self { camera: camera.clone(), rig: Arc::new(rig), looks })
    }

    /// Sensors for one look with colours that were learned elsewhere.
    pub fn with_colours(
        camera: &Camera,
        look: &'static BuildingLook,
        colours: ColourModel,
    ) -> Self {
        let rig = Arc::new(Rig::new(camera));
        Self { camera: camera.clone(), rig, looks: vec![(look, colours)] }
    }

    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    pub fn rig(&self) -> &Arc<Rig> {
        &self.rig
    }

    /// The look for a number, in turn.
    pub fn look(&self, number: u64) -> &'static BuildingLook {
        self.looks[(number % self.looks.len() as u64) as usize].0
    }

    /// The colours of a look, or those of the first look if it is unknown.
    pub fn colours(&self, look: &'static BuildingLook) -> &ColourModel {
        let known = self.looks.iter().find(|(known, _)| known.name == look.name);
        &known.unwrap_or(&self.looks[0]).1
    }

    /// A sensor for a look, or for the first look if it is unknown.
    pub fn sensor(&self, look: &'static BuildingLook) -> Sensor {
        Sensor::new(&self.camera, self.colours(look))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LOOKS, question_limit::QuestionLimit};

    /// The watch is asked twice for each image.
    #[test]
    fn learning_ends_at_the_question_at_which_it_is_stopped() {
        let camera = Camera::superscout().sized([640, 480]);
        for at in [1, 2, 5] {
            let watch = QuestionLimit::at(at);
            let stopped = LearnedSensors::new(&camera, &[&LOOKS[0]], &watch);
            assert!(matches!(stopped, Err(LearningError::Interrupted(Interrupted))));
            assert_eq!(watch.asked(), at);
        }
    }
}
