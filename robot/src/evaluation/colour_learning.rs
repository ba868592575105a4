//! Colours for every look, learned from rendered images that are judged nowhere.

use thiserror::Error;
use toposlam_vision::{
    camera::Camera,
    colour::{ColourModel, ExampleError, Training, TrainingError},
};

use super::view_sampler::{ViewError, ViewSampler};
use crate::simulator::{BuildingLook, Rig, label_mask, labels};

/// From so many images the colours of a look are learned.
const IMAGES: u64 = 16;

/// Why the colours of a look are not learned.
#[derive(Debug, Error)]
pub enum LearningError {
    /// There is nothing to look at.
    #[error(transparent)]
    View(#[from] ViewError),
    /// Of no image the light is known.
    #[error("look {look}: {cause}")]
    Training {
        /// The look.
        look: &'static str,
        /// What is wrong.
        cause: TrainingError,
    },
    /// An image does not fit.
    #[error("look {look}: {cause}")]
    Example {
        /// The look.
        look: &'static str,
        /// What is wrong.
        cause: ExampleError,
    },
}

/// The colours of a look, learned with a camera and its rig.
///
/// # Errors
/// Where too little is to be seen.
pub fn learned(
    views: &ViewSampler,
    look: &'static BuildingLook,
    camera: &Camera,
    rig: &Rig,
) -> Result<ColourModel, LearningError> {
    let mut training = Training::new(look.stripe);
    for number in 0..IMAGES {
        let view = views.to_learn_from(look, camera.image, number)?;
        let building = view.building();
        let classes = labels(rig, &building, view.pose, &view.effects);
        let mask = label_mask(rig, &classes);
        match training.add(camera, &view.picture(rig, &building), &mask) {
            // An image that is too dark to tell its light teaches nothing.
            Ok(()) | Err(ExampleError::Light(_)) => {}
            Err(cause) => return Err(LearningError::Example { look: look.name, cause }),
        }
    }
    training.model().map_err(|cause| LearningError::Training { look: look.name, cause })
}
