//! Colours of every look, learned from rendered images that are not used for judging.

use thiserror::Error;
use toposlam_vision::{
    camera::Camera,
    colour::{ColourModel, ExampleError, Training, TrainingError},
};

use super::view_sampler::{ViewError, ViewSampler};
use crate::simulator::{BuildingLook, Rig, label_mask, labels};

/// The number of images from which the colours of a look are learned.
const IMAGES: u64 = 16;

/// Why the colours of a look cannot be learned.
#[derive(Debug, Error)]
pub enum LearningError {
    /// The view cannot be sampled.
    #[error(transparent)]
    View(#[from] ViewError),
    /// Too little was seen.
    #[error("look {look}: {cause}")]
    Training {
        /// The look.
        look: &'static str,
        /// The cause.
        cause: TrainingError,
    },
    /// An image does not fit.
    #[error("look {look}: {cause}")]
    Example {
        /// The look.
        look: &'static str,
        /// The cause.
        cause: ExampleError,
    },
}

/// Learns the colours of a look with a camera and its rig.
///
/// # Errors
/// Returns an error if too little is seen.
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
            // Skip images that are too dark to measure their light.
            Ok(()) | Err(ExampleError::Light(_)) => {}
            Err(cause) => return Err(LearningError::Example { look: look.name, cause }),
        }
    }
    training.model().map_err(|cause| LearningError::Training { look: look.name, cause })
}
