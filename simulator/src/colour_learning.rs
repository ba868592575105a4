//! Colours of every look, learned from rendered images that are not used for judging.

use thiserror::Error;
use toposlam_model::enumerate::{Interrupted, Watch};
use toposlam_vision::{
    camera::Camera,
    colour::{ColourModel, ExampleError, Training, TrainingError},
};

use super::view_sampler::{ViewError, ViewSampler};
use crate::{BuildingLook, Rig, label_mask, labels};

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
    /// The work was stopped.
    #[error(transparent)]
    Interrupted(#[from] Interrupted),
}

/// Learns the colours of a look with a camera and its rig.
///
/// # Errors
/// Returns an error if too little is seen, or if the watch stops.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LOOKS, LearnedSensors, question_limit::QuestionLimit};

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
