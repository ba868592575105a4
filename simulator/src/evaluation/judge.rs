//! Renders, senses and judges views and visits.

use std::{
    collections::BTreeMap,
    f64::consts::TAU,
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
    judged_view::{JudgedView, JudgedVisit},
    verdict::{judge, judge_marker},
};
use crate::{
    LearnedSensors, Rig, RigErrors,
    learned_sensors::LearningError,
    truth::{JunctionTruth, Truth},
    view_sampler::RenderedView,
    view_sampler::{ViewError, ViewSampler},
};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Calibration {
    Right,
    /// The mirror's centre is 5 pixels off (in an image 1280 wide), the camera is 2 cm too high or
    /// too low, and its axis leans by one degree.
    Wrong,
}

#[derive(Debug, Error)]
pub enum JudgingError {
    #[error(transparent)]
    Learning(#[from] LearningError),
    #[error(transparent)]
    View(#[from] ViewError),
    #[error(transparent)]
    Size(#[from] WrongSize),
    #[error("view {number} of {plan} is not on the floor")]
    OffTheFloor { number: u64, plan: String },
}

/// Rigs and sensors for each image size.
pub struct Judge {
    stations: BTreeMap<[u32; 2], Station>,
}

struct Station {
    sensors: LearnedSensors,
    wrong: Vec<Rig>,
    /// The sensors that no thread uses at the moment, and their looks.
    idle: Mutex<Vec<(&'static str, Sensor)>>,
}

impl Judge {
    /// Learns the colours of all looks of the views, for all image sizes, with a calibrated camera.
    pub fn new(
        camera: &Camera,
        views: &ViewSampler,
        calibrations: &[Calibration],
        watch: &dyn Watch,
    ) -> Result<Self, JudgingError> {
        let station = |&size: &[u32; 2]| {
            let camera = camera.sized(size);
            let sensors = LearnedSensors::from_views(&camera, views, watch)?;
            let is_wrong = calibrations.contains(&Calibration::Wrong);
            let wrong = if is_wrong { wrong_rigs(&camera) } else { Vec::new() };
            Ok((size, Station { sensors, wrong, idle: Mutex::default() }))
        };
        Ok(Self { stations: views.sizes.iter().map(station).collect::<Result<_, JudgingError>>()? })
    }

    /// Judges one view.
    pub fn view(
        &self,
        view: RenderedView,
        calibration: Calibration,
    ) -> Result<JudgedView, JudgingError> {
        let image = view.render(self.rig(&view, calibration), &view.building());
        self.judged(view, &image)
    }

    /// Judges one visit. Returns `None` if it has no images, or if the watch stops.
    pub fn visit(
        &self,
        views: Vec<RenderedView>,
        calibration: Calibration,
        watch: &dyn Watch,
    ) -> Result<Option<JudgedVisit>, JudgingError> {
        let Some(last) = views.last() else { return Ok(None) };
        let Some(Truth::Junction(JunctionTruth { vertex, shape: Some(shape), .. })) = last.truth()
        else {
            return Err(off_the_floor(last));
        };
        let here = last.marker.filter(|&dart| last.plan.graph().vertex(dart) == vertex);
        let marker = here.and_then(|_| last.marker()?.door);
        let sighting = marker.map_or(Sighting::Nothing, Sighting::Pointing);
        let percept = Percept { degree: shape.degree(), sighting };
        let building = last.building();
        let rig = self.rig(last, calibration);
        let mut judged = Vec::with_capacity(views.len());
        let mut visit = JunctionEstimate::default();
        for view in views {
            if watch.stop() {
                return Ok(None);
            }
            let image = view.render(rig, &building);
            let view = self.judged(view, &image)?;
            visit.add_scene(&view.scene);
            judged.push(view);
        }
        let decided = visit.shape().zip(visit.percept());
        Ok(Some(JudgedVisit { views: judged, shape, percept, decided }))
    }

    /// The image of a view, its scene, and a picture of each processing stage.
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

    fn rig(&self, view: &RenderedView, calibration: Calibration) -> &Rig {
        let Station { sensors, wrong, .. } = &self.stations[&view.image];
        let number = view.seeds[0].checked_rem(wrong.len() as u64);
        match (calibration, number) {
            (Calibration::Wrong, Some(number)) => &wrong[number as usize],
            _ => sensors.rig(),
        }
    }

    /// Calls a function with a sensor that no other thread uses meanwhile.
    fn with_sensor<R>(&self, view: &RenderedView, work: impl FnOnce(&mut Sensor) -> R) -> R {
        let Station { sensors, idle, .. } = &self.stations[&view.image];
        let idle = || idle.lock().unwrap_or_else(PoisonError::into_inner);
        let look = view.look.name;
        let taken = {
            let mut idle = idle();
            let known = idle.iter().position(|(other, _)| *other == look);
            known.map(|known| idle.swap_remove(known).1)
        };
        let mut sensor = taken.unwrap_or_else(|| sensors.sensor(view.look));
        let result = work(&mut sensor);
        idle().push((look, sensor));
        result
    }
}

fn off_the_floor(view: &RenderedView) -> JudgingError {
    JudgingError::OffTheFloor { number: view.number, plan: view.plan_name.clone() }
}

const WRONG_RIGS: usize = 6;
/// Offset of the mirror's centre, as a share of the image's width.
const CENTRE_OFF: f64 = 5.0 / 1280.0;
/// Error of the camera's height, in metres.
const HEIGHT_OFF: f64 = 0.02;
/// Tilt of the axis, in degrees.
const TILT: f64 = 1.0;

/// Rigs whose cameras differ from the calibration, each in another direction and by as much.
fn wrong_rigs(camera: &Camera) -> Vec<Rig> {
    let rig = |number: usize| {
        let (v, u) = (TAU * (number as f64 * (1.0 / WRONG_RIGS as f64) + 0.11)).sin_cos();
        let centre = CENTRE_OFF * f64::from(camera.image[0]);
        let errors = RigErrors {
            tilt: TILT.to_radians(),
            // The golden section keeps directions of tilt and centre from repeating together.
            towards: TAU * number as f64 * 0.618_034,
            centre: [centre * u, centre * v],
            height: if number.is_multiple_of(2) { HEIGHT_OFF } else { -HEIGHT_OFF },
        };
        Rig::with_errors(camera, &errors)
    };
    (0..WRONG_RIGS).into_par_iter().map(rig).collect()
}
