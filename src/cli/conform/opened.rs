//! A log as it is judged: what its topics carry, of what its events are made, with which eyes.

use std::path::{Path, PathBuf};

use toposlam_model::marker::{self, Marker};
use toposlam_robot::{
    conform::Evidence,
    log::{
        entries::{Content, Picture},
        mapping::{Mapping, MappingError, Role},
        messages::Run,
        reading::Log,
    },
};
use toposlam_vision::{
    annotate,
    camera::{Camera, calibration},
    colour::ColourModel,
    image_file::ImageFile,
    sensing::Sensor,
};

use super::{Arguments, Failure};
use crate::cli::input;

/// A log, open.
pub(in crate::cli) struct Opened {
    pub(in crate::cli) log: Log,
    pub(in crate::cli) mapping: Mapping,
    mapping_path: Option<PathBuf>,
    pub(in crate::cli) evidence: Evidence,
    pub(in crate::cli) run: Option<Run>,
    eyes: Option<(Camera, ColourModel)>,
}

/// The topic of annotated pictures in logs of the project.
const ANNOTATED: &str = toposlam_robot::log::recorder::ANNOTATED;

impl Opened {
    pub(super) fn new(path: &Path, arguments: &Arguments) -> Result<Self, Failure> {
        let log = Log::open(path).map_err(|error| Failure::in_file(path, error))?;
        let mapping = read_mapping(path, &log, arguments.mapping.as_deref())?;
        let evidence = arguments.events.map(Evidence::from).or_else(|| Evidence::of(&mapping));
        let evidence = evidence.ok_or_else(|| nothing(path, &log))?;
        let run = head(path, &log, &mapping)?;
        let mut opened = Self {
            log,
            mapping,
            mapping_path: arguments.mapping.clone(),
            evidence,
            run,
            eyes: None,
        };
        opened.eyes =
            opened.eyes(path, arguments.calibration.as_deref(), arguments.colours.as_deref())?;
        Ok(opened)
    }

    /// The camera and the colours: as they are given, or else as the log says.
    fn eyes(
        &self,
        path: &Path,
        calibration: Option<&Path>,
        colours: Option<&Path>,
    ) -> Result<Option<(Camera, ColourModel)>, Failure> {
        let told =
            |text: fn(&Run) -> &String| self.run.as_ref().map(text).filter(|text| !text.is_empty());
        let camera = match (calibration, told(|run| &run.calibration)) {
            (Some(path), _) => Some(input::read_camera(path)?),
            (None, Some(text)) => {
                let no_file = |_: &str| Err(std::io::ErrorKind::NotFound.into());
                let camera = calibration::read(text.as_bytes(), &mut { no_file });
                Some(camera.map_err(|error| {
                    Failure::in_file(path, format!("the calibration in it: {error}"))
                })?)
            }
            (None, None) => None,
        };
        let colours = match (colours, told(|run| &run.colours)) {
            (Some(path), _) => Some(input::read_colours(path)?),
            (None, Some(text)) => {
                Some(ColourModel::read(text.as_bytes()).map_err(|error| {
                    Failure::in_file(path, format!("the colours in it: {error}"))
                })?)
            }
            (None, None) => None,
        };
        Ok(camera.zip(colours))
    }

    /// What makes scenes of its pictures.
    pub(in crate::cli) fn sensor(&self) -> Option<Sensor> {
        self.eyes.as_ref().map(|(camera, colours)| Sensor::new(camera, colours))
    }

    /// The kind of marker that the log says; directional, if it does not.
    pub(super) fn marker(&self) -> Result<&'static dyn Marker, Failure> {
        let name = self.run.as_ref().map_or("", |run| &run.marker);
        let name = if name.is_empty() { "directional" } else { name };
        marker::named(name).map_err(|error| Failure::at("the log", error))
    }

    /// A mapping that does not fit its log.
    pub(in crate::cli) fn wrong_mapping(&self, log: &Path, error: &MappingError) -> Failure {
        match &self.mapping_path {
            Some(path) => Failure::in_file(path, format!("{error} ({})", log.display())),
            None => Failure::in_file(log, error),
        }
    }

    /// The last picture up to a message, with its scene drawn over it where that is known.
    pub(super) fn picture(&self, message: u64) -> Option<Vec<u8>> {
        let annotated = self.log.topics().iter().position(|topic| topic.name == ANNOTATED);
        let mapping = match annotated {
            Some(_) => Mapping::of(Role::Image, ANNOTATED),
            None => self.mapping.only(&[Role::Image]),
        };
        let bound = mapping.bind(&self.log).ok()?;
        let mut last = None;
        for entry in self.log.entries(&bound) {
            match entry.ok()? {
                entry if entry.number > message => break,
                entry => last = Some(entry.content),
            }
        }
        let Some(Content::Image(picture)) = last else { return None };
        let image = match (picture, annotated) {
            (Picture::File(bytes), Some(_)) => return Some(bytes),
            (Picture::File(bytes), None) => match &self.eyes {
                None => return Some(bytes),
                Some(_) => ImageFile::open(&bytes).ok()?.image().ok()?,
            },
            (Picture::Pixels(image), _) => image,
        };
        let drawn = match (&self.eyes, self.sensor()) {
            (Some((camera, _)), Some(mut sensor)) => {
                annotate::over(&image, camera, &sensor.sense(&image).ok()?)
            }
            _ => image,
        };
        let mut bytes = Vec::new();
        drawn.write_with_encoder(image::codecs::jpeg::JpegEncoder::new(&mut bytes)).ok()?;
        Some(bytes)
    }
}

/// The mapping of a file, or else what the types of the topics say.
fn read_mapping(path: &Path, log: &Log, file: Option<&Path>) -> Result<Mapping, Failure> {
    match file {
        Some(file) => {
            Mapping::read(&input::read(file)?).map_err(|error| Failure::in_file(file, error))
        }
        None => {
            let mapping = Mapping::unambiguous(log);
            if Evidence::of(&mapping).is_none() {
                // Where that is because several topics could carry the same, this says so.
                Mapping::from_log(log).map_err(|error| Failure::in_file(path, error))?;
            }
            Ok(mapping)
        }
    }
}

/// There is nothing in a log that could be judged.
fn nothing(path: &Path, log: &Log) -> Failure {
    if log.messages_total() == 0 {
        return Failure::in_file(path, "it is empty: there is no message in it");
    }
    Failure::in_file(path, toposlam_robot::conform::NoEvents::NothingMapped)
}

/// What a log says of itself at its beginning.
fn head(path: &Path, log: &Log, mapping: &Mapping) -> Result<Option<Run>, Failure> {
    let failed = |error| Failure::in_file(path, error);
    let Ok(bound) = mapping.only(&[Role::Run]).bind(log) else { return Ok(None) };
    for entry in log.entries(&bound) {
        if let Content::Run(run) = entry.map_err(failed)?.content {
            return Ok(Some(run));
        }
    }
    Ok(None)
}
