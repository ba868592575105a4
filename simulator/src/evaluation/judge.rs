//! Renders, senses and judges views and visits.

use std::{
    collections::BTreeMap,
    sync::{Mutex, PoisonError},
};

use image::RgbImage;
use rayon::prelude::*;
use thiserror::Error;
use toposlam_model::{
    driving::{scene::Scene, visit::JunctionEstimate},
    enumerate::Watch,
    percept::{Percept, Sighting},
};
use toposlam_vision::{
    annotate::{self, Stages},
    camera::Camera,
    sensing::{Sensor, WrongSize},
};

use super::{
    calibration::{Calibration, wrong_rigs},
    judged_view::{JudgedView, JudgedVisit},
    parallel::in_turn,
    verdict::{judge, judge_marker},
};
use crate::{
    BuildingLook, Rig,
    colour_learning::{LearningError, learned},
    rendered_view::RenderedView,
    truth::{JunctionTruth, Truth},
    view_sampler::{ViewError, ViewSampler},
};

/// Why views cannot be judged.
#[derive(Debug, Error)]
pub enum JudgingError {
    /// The colours were not learned.
    #[error(transparent)]
    Learning(#[from] LearningError),
    /// The view cannot be sampled.
    #[error(transparent)]
    View(#[from] ViewError),
    /// The image has another size than the camera.
    #[error(transparent)]
    Size(#[from] WrongSize),
    /// The view is not on the floor.
    #[error("view {number} of {plan} is not on the floor")]
    OffTheFloor {
        /// The number of the view.
        number: u64,
        /// Its plan.
        plan: String,
    },
}

/// Rigs and sensors for each image size.
pub struct Judge {
    stations: BTreeMap<[u32; 2], Station>,
}

/// What belongs to one image size.
struct Station {
    right: Rig,
    wrong: Vec<Rig>,
    /// One for each look.
    sensors: Vec<Sensors>,
}

/// The sensors for one look, one for each thread at work.
struct Sensors {
    look: &'static str,
    model: Sensor,
    idle: Mutex<Vec<Sensor>>,
}

impl Judge {
    /// Learns the colours of all looks of the views, for all image sizes, with a calibrated camera.
    ///
    /// # Errors
    /// Returns an error if the colours cannot be learned, or if the watch stops.
    pub fn new(
        camera: &Camera,
        views: &ViewSampler,
        calibrations: &[Calibration],
        watch: &dyn Watch,
    ) -> Result<Self, JudgingError> {
        watch.parts(views.sizes.len() * views.looks.len());
        let station = |&size: &[u32; 2]| {
            let camera = camera.sized(size);
            let right = Rig::new(&camera);
            let sensors = views.looks.par_iter().map(|look| {
                let sensors = Sensors::new(views, look, &camera, &right, watch);
                watch.part_done(1);
                sensors
            });
            let sensors = sensors.collect::<Result<_, LearningError>>()?;
            let wrong = if calibrations.contains(&Calibration::Wrong) {
                wrong_rigs(&camera)
            } else {
                Vec::new()
            };
            Ok((size, Station { right, wrong, sensors }))
        };
        Ok(Self { stations: views.sizes.iter().map(station).collect::<Result<_, JudgingError>>()? })
    }

    /// Judges views by their numbers on all threads. The result does not depend on the number of
    /// threads. If the watch stops, some are missing.
    ///
    /// # Errors
    /// Returns an error if a view cannot be sampled or judged.
    pub fn views(
        &self,
        views: &ViewSampler,
        numbers: std::ops::Range<u64>,
        calibration: Calibration,
        watch: &dyn Watch,
    ) -> Result<Vec<JudgedView>, JudgingError> {
        in_turn(numbers, watch, |number| self.view(views.view(number)?, calibration))
    }

    /// Judges visits by their numbers, as [`Self::views`] does.
    ///
    /// # Errors
    /// Returns an error if a visit cannot be sampled or judged.
    pub fn visits(
        &self,
        views: &ViewSampler,
        numbers: std::ops::Range<u64>,
        calibration: Calibration,
        watch: &dyn Watch,
    ) -> Result<Vec<JudgedVisit>, JudgingError> {
        let visits =
            in_turn(numbers, watch, |number| self.visit(views.visit(number)?, calibration, watch))?;
        Ok(visits.into_iter().flatten().collect())
    }

    /// Judges one view.
    ///
    /// # Errors
    /// Returns an error if the view is not on the floor.
    pub fn view(
        &self,
        view: RenderedView,
        calibration: Calibration,
    ) -> Result<JudgedView, JudgingError> {
        let image = view.render(self.rig(&view, calibration), &view.building());
        self.judged(view, &image)
    }

    /// Judges one visit. Returns `None` if it has no images, or if the watch stops.
    ///
    /// # Errors
    /// Returns an error if a view is not on the floor.
    pub fn visit(
        &self,
        views: Vec<RenderedView>,
        calibration: Calibration,
        watch: &dyn Watch,
    ) -> Result<Option<JudgedVisit>, JudgingError> {
        let Some(last) = views.last() else { return Ok(None) };
        let Some(Truth::Junction(JunctionTruth { vertex, form: Some(form), .. })) = last.truth()
        else {
            return Err(off_the_floor(last));
        };
        let here = last.marker.filter(|&dart| last.plan.graph().vertex(dart) == vertex);
        let marker = here.and_then(|_| last.marker()?.door);
        let sighting = marker.map_or(Sighting::Nothing, Sighting::Pointing);
        let percept = Percept { degree: form.degree(), sighting };
        let building = last.building();
        let rig = self.rig(last, calibration);
        let mut judged = Vec::with_capacity(views.len());
        for view in views {
            if watch.stop() {
                return Ok(None);
            }
            let image = view.render(rig, &building);
            judged.push(self.judged(view, &image)?);
        }
        let views = judged;
        let mut visit = JunctionEstimate::default();
        for view in &views {
            visit.see(&view.scene);
        }
        let decided = visit.form().zip(visit.percept());
        Ok(Some(JudgedVisit { views, form, percept, decided }))
    }

    /// The image of a view, its scene, and a picture of each processing stage.
    ///
    /// # Errors
    /// Returns an error if the image does not have one of the sizes.
    pub fn stages(
        &self,
        view: &RenderedView,
        calibration: Calibration,
    ) -> Result<(RgbImage, Scene, Stages), JudgingError> {
        let image = view.render(self.rig(view, calibration), &view.building());
        let (scene, stages) = self.with_sensor(view, |sensor| annotate::stages(sensor, &image))?;
        Ok((image, scene, stages))
    }

    fn judged(&self, view: RenderedView, image: &RgbImage) -> Result<JudgedView, JudgingError> {
        let truth = view.truth().ok_or_else(|| off_the_floor(&view))?;
        let scene = self.with_sensor(&view, |sensor| sensor.sense(image))?;
        let verdict = judge(&truth, &scene);
        let marker = judge_marker(view.marker().as_ref(), scene.marker.as_ref());
        Ok(JudgedView { view, truth, scene, verdict, marker })
    }

    fn station(&self, view: &RenderedView) -> &Station {
        &self.stations[&view.image]
    }

    fn rig(&self, view: &RenderedView, calibration: Calibration) -> &Rig {
        let station = self.station(view);
        match calibration {
            Calibration::Wrong if !station.wrong.is_empty() => {
                &station.wrong[(view.seeds[0] % station.wrong.len() as u64) as usize]
            }
            Calibration::Right | Calibration::Wrong => &station.right,
        }
    }

    fn with_sensor<R>(&self, view: &RenderedView, work: impl FnOnce(&mut Sensor) -> R) -> R {
        let sensors = &self.station(view).sensors;
        let mine = sensors.iter().find(|sensors| sensors.look == view.look.name);
        mine.unwrap_or(&sensors[0]).with(work)
    }
}

impl Sensors {
    fn new(
        views: &ViewSampler,
        look: &'static BuildingLook,
        camera: &Camera,
        rig: &Rig,
        watch: &dyn Watch,
    ) -> Result<Self, LearningError> {
        let colours = learned(views, look, camera, rig, watch)?;
        let model = Sensor::new(camera, &colours);
        Ok(Self { look: look.name, model, idle: Mutex::default() })
    }

    /// Calls a function with a sensor that no other thread uses meanwhile.
    fn with<R>(&self, work: impl FnOnce(&mut Sensor) -> R) -> R {
        let idle = || self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let taken = idle().pop();
        let mut sensor = taken.unwrap_or_else(|| self.model.clone());
        let result = work(&mut sensor);
        idle().push(sensor);
        result
    }
}

fn off_the_floor(view: &RenderedView) -> JudgingError {
    JudgingError::OffTheFloor { number: view.number, plan: view.plan_name.clone() }
}
