//! Views and visits, rendered, sensed and judged.

use std::{
    collections::BTreeMap,
    f64::consts::TAU,
    sync::{Mutex, PoisonError},
};

use image::RgbImage;
use rayon::prelude::*;
use thiserror::Error;
use toposlam_model::{
    driving::{
        scene::Scene,
        visit::{Form, Visit},
    },
    enumerate::Watch,
    percept::{Percept, Sighting},
};
use toposlam_vision::{
    camera::Camera,
    sensing::{Sensor, Stages, WrongSize},
};

use super::{
    class::Class,
    learning::{LearningError, learned},
    truth::{JunctionTruth, MarkerTruth, Truth},
    verdict::{MarkerVerdict, Verdict, judge, judge_marker},
    view::{NoView, View, Views},
};
use crate::simulator::{Look, Rig, RigErrors};

/// Whether the camera is as its calibration says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Calibration {
    /// It is.
    Right,
    /// Its middle is 5 pixels (of an image 1280 wide) off, it is 2 cm too high or too low, and leans
    /// by one degree.
    Wrong,
}

/// So many cameras that are not as their calibration says.
const WRONG_RIGS: usize = 6;
/// How far the middle of the mirror is off, as a part of the image's width.
const CENTRE_OFF: f64 = 5.0 / 1280.0;
/// How much too high or too low it is, in metres.
const HEIGHT_OFF: f64 = 0.02;
/// How far it leans, in degrees.
const TILT: f64 = 1.0;

/// Why views cannot be judged.
#[derive(Debug, Error)]
pub enum JudgingError {
    /// The colours are not known.
    #[error(transparent)]
    Learning(#[from] LearningError),
    /// There is nothing to look at.
    #[error(transparent)]
    View(#[from] NoView),
    /// The camera is another.
    #[error(transparent)]
    Size(#[from] WrongSize),
    /// A view is where there is no floor.
    #[error("view {number} of {plan} is not on the floor")]
    OffTheFloor {
        /// The number of the view.
        number: u64,
        /// Its plan.
        plan: String,
    },
}

/// Where a view is, as it matters to what is asked of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Zone {
    /// 1.5 m or more from any junction.
    Hallway,
    /// Nearer, but not yet at a junction.
    Between,
    /// At a junction, up to 0.1 m past its turning point.
    Before,
    /// At a junction, farther past its turning point.
    Past,
    /// At a junction, and turned away from the door by which it was entered.
    Turned,
}

/// So far past the turning point a junction is to be made out, in metres.
const PAST: f64 = 0.1;

/// A view, and what sensing made of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// What was to be seen.
    pub view: View,
    /// What is true there.
    pub truth: Truth,
    /// What sensing says.
    pub scene: Scene,
    /// Whether it is right about the place,
    pub verdict: Verdict,
    /// and about the marker.
    pub marker: MarkerVerdict,
}

/// A visit to a junction, and what came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedVisit {
    /// Its pictures.
    pub pictures: Vec<Judged>,
    /// What the junction looks like from its entry.
    pub form: Form,
    /// What the robot should perceive.
    pub percept: Percept,
    /// As what the junction was made out, once two pictures agreed.
    pub decided: Option<(Form, Percept)>,
}

/// All that judging takes: rigs and sensors for each size of picture, made once.
pub struct Judge {
    stations: BTreeMap<[u32; 2], Station>,
}

/// What belongs to one size of picture.
struct Station {
    right: Rig,
    wrong: Vec<Rig>,
    /// For each look.
    sensors: Vec<Sensors>,
}

/// Sensors for one look: as many as there are threads at work.
struct Sensors {
    look: &'static str,
    model: Sensor,
    idle: Mutex<Vec<Sensor>>,
}

impl Judge {
    /// Learns the colours of all looks of the views, for all sizes of their pictures, with a calibrated
    /// camera.
    ///
    /// # Errors
    /// Where the colours cannot be learned.
    pub fn new(
        camera: &Camera,
        views: &Views,
        calibrations: &[Calibration],
        watch: &impl Watch,
    ) -> Result<Self, JudgingError> {
        watch.parts(views.sizes.len() * views.looks.len());
        let station = |&size: &[u32; 2]| {
            let camera = camera.sized(size);
            let right = Rig::new(&camera);
            let wrong = if calibrations.contains(&Calibration::Wrong) { WRONG_RIGS } else { 0 };
            let sensors = views.looks.par_iter().map(|look| {
                let sensors = Sensors::new(views, look, &camera, &right);
                watch.part_done(1);
                sensors
            });
            let sensors = sensors.collect::<Result<_, LearningError>>()?;
            let wrong = (0..wrong)
                .into_par_iter()
                .map(|number| Rig::with_errors(&camera, &errors(size, number)));
            Ok((size, Station { wrong: wrong.collect(), right, sensors }))
        };
        Ok(Self { stations: views.sizes.iter().map(station).collect::<Result<_, JudgingError>>()? })
    }

    /// Judges views by their numbers, on all threads; the result does not depend on their number. Where
    /// the watch breaks off, some are missing.
    ///
    /// # Errors
    /// Where there is nothing to look at.
    pub fn views(
        &self,
        views: &Views,
        numbers: std::ops::Range<u64>,
        calibration: Calibration,
        watch: &impl Watch,
    ) -> Result<Vec<Judged>, JudgingError> {
        in_turn(numbers, watch, |number| self.view(views.view(number)?, calibration))
    }

    /// Judges visits by their numbers, likewise.
    ///
    /// # Errors
    /// Where there is nothing to look at.
    pub fn visits(
        &self,
        views: &Views,
        numbers: std::ops::Range<u64>,
        calibration: Calibration,
        watch: &impl Watch,
    ) -> Result<Vec<JudgedVisit>, JudgingError> {
        let visits =
            in_turn(numbers, watch, |number| self.visit(views.visit(number)?, calibration))?;
        Ok(visits.into_iter().flatten().collect())
    }

    /// Judges one view.
    ///
    /// # Errors
    /// Where it is not on the floor.
    pub fn view(&self, view: View, calibration: Calibration) -> Result<Judged, JudgingError> {
        let image = view.picture(self.rig(&view, calibration), &view.building());
        self.judged(view, &image)
    }

    /// Judges one visit; `None` for one without pictures.
    ///
    /// # Errors
    /// As [`Self::view`].
    pub fn visit(
        &self,
        pictures: Vec<View>,
        calibration: Calibration,
    ) -> Result<Option<JudgedVisit>, JudgingError> {
        let Some(last) = pictures.last() else { return Ok(None) };
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
        let judged = pictures.into_iter().map(|view| {
            let image = view.picture(rig, &building);
            self.judged(view, &image)
        });
        let pictures = judged.collect::<Result<Vec<_>, _>>()?;
        let mut visit = Visit::default();
        for picture in &pictures {
            visit.see(&picture.scene);
        }
        let decided = visit.form().zip(visit.percept());
        Ok(Some(JudgedVisit { pictures, form, percept, decided }))
    }

    /// The picture of a view, what sensing says of it, and a picture of each of its steps.
    ///
    /// # Errors
    /// Where the view's size is none of the sizes.
    pub fn stages(
        &self,
        view: &View,
        calibration: Calibration,
    ) -> Result<(RgbImage, Scene, Stages), JudgingError> {
        let image = view.picture(self.rig(view, calibration), &view.building());
        let (scene, stages) = self.with_sensor(view, |sensor| sensor.stages(&image))?;
        Ok((image, scene, stages))
    }

    fn judged(&self, view: View, image: &RgbImage) -> Result<Judged, JudgingError> {
        let truth = view.truth().ok_or_else(|| off_the_floor(&view))?;
        let scene = self.with_sensor(&view, |sensor| sensor.sense(image))?;
        let verdict = judge(&truth, &scene);
        let marker = judge_marker(view.marker().as_ref(), scene.marker.as_ref());
        Ok(Judged { view, truth, scene, verdict, marker })
    }

    fn station(&self, view: &View) -> &Station {
        &self.stations[&view.image]
    }

    fn rig(&self, view: &View, calibration: Calibration) -> &Rig {
        let station = self.station(view);
        match calibration {
            Calibration::Wrong if !station.wrong.is_empty() => {
                &station.wrong[(view.number % station.wrong.len() as u64) as usize]
            }
            Calibration::Right | Calibration::Wrong => &station.right,
        }
    }

    fn with_sensor<R>(&self, view: &View, work: impl FnOnce(&mut Sensor) -> R) -> R {
        let sensors = &self.station(view).sensors;
        let mine = sensors.iter().find(|sensors| sensors.look == view.look.name);
        mine.unwrap_or(&sensors[0]).with(work)
    }
}

impl Sensors {
    fn new(
        views: &Views,
        look: &'static Look,
        camera: &Camera,
        rig: &Rig,
    ) -> Result<Self, LearningError> {
        let colours = learned(views, look, camera, rig)?;
        let model = Sensor::new(camera, &colours);
        Ok(Self { look: look.name, model, idle: Mutex::default() })
    }

    /// Works with a sensor that nobody else has meanwhile.
    fn with<R>(&self, work: impl FnOnce(&mut Sensor) -> R) -> R {
        let idle = || self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let taken = idle().pop();
        let mut sensor = taken.unwrap_or_else(|| self.model.clone());
        let result = work(&mut sensor);
        idle().push(sensor);
        result
    }
}

/// Works on numbers on all threads; the results are in the order of the numbers.
fn in_turn<R: Send>(
    numbers: std::ops::Range<u64>,
    watch: &impl Watch,
    work: impl Fn(u64) -> Result<R, JudgingError> + Sync,
) -> Result<Vec<R>, JudgingError> {
    watch.parts((numbers.end.saturating_sub(numbers.start)) as usize);
    let numbers: Vec<_> = numbers.collect();
    let results = numbers.into_par_iter().with_max_len(1).map(|number| {
        if watch.stop() {
            return Ok(None);
        }
        let result = work(number)?;
        watch.part_done(1);
        Ok(Some(result))
    });
    let results = results.collect::<Result<Vec<_>, JudgingError>>()?;
    Ok(results.into_iter().flatten().collect())
}

/// The error of a camera: all of them as large as they are to be, in directions all around.
fn errors([width, _]: [u32; 2], number: usize) -> RigErrors {
    let around = |turns: f64| (TAU * (number as f64 * turns + 0.11)).sin_cos();
    let (v, u) = around(1.0 / WRONG_RIGS as f64);
    let centre = CENTRE_OFF * f64::from(width);
    RigErrors {
        tilt: TILT.to_radians(),
        // The golden section: no leaning is together with the same centre twice.
        towards: TAU * number as f64 * 0.618_034,
        centre: [centre * u, centre * v],
        height: if number.is_multiple_of(2) { HEIGHT_OFF } else { -HEIGHT_OFF },
    }
}

fn off_the_floor(view: &View) -> JudgingError {
    JudgingError::OffTheFloor { number: view.number, plan: view.plan_name.clone() }
}

impl Zone {
    /// Where a view with this truth is.
    #[must_use]
    pub fn of(truth: &Truth) -> Self {
        match truth {
            Truth::Hallway(_) => Self::Hallway,
            Truth::Between(..) => Self::Between,
            Truth::Junction(junction) => match junction.distance() {
                None => Self::Turned,
                Some(distance) if distance >= -PAST => Self::Before,
                Some(_) => Self::Past,
            },
        }
    }
}

impl Judged {
    /// Where it is.
    #[must_use]
    pub fn zone(&self) -> Zone {
        Zone::of(&self.truth)
    }

    /// What the image shows; `None` where different answers are right.
    #[must_use]
    pub fn class(&self) -> Option<Class> {
        match &self.truth {
            Truth::Hallway(_) => Some(Class::Hallway),
            Truth::Between(..) => None,
            Truth::Junction(junction) => junction.form.map(Class::Junction),
        }
    }

    /// Whether the marker is just where it should be seen, on the approach to its L.
    #[must_use]
    pub fn marker_ahead(&self) -> Option<MarkerTruth> {
        let marker = self.view.marker()?;
        let junction = match &self.truth {
            Truth::Junction(junction) => std::slice::from_ref(junction),
            Truth::Between(_, junctions) => junctions.as_slice(),
            Truth::Hallway(_) => &[],
        };
        let vertex = self.view.plan.graph().vertex(self.view.marker?);
        let here = junction.iter().any(|junction| junction.vertex == vertex);
        let distance = marker.distance.filter(|distance| (0.2..=0.8).contains(distance));
        (here && distance.is_some()).then_some(marker)
    }
}

impl JudgedVisit {
    /// Whether the junction was made out as another.
    #[must_use]
    pub fn is_wrong(&self) -> bool {
        self.decided.is_some_and(|(form, _)| form != self.form)
    }
}
