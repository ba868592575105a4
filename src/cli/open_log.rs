//! An open log, with the meaning of its topics and the sensor for its images.

use std::path::{Path, PathBuf};

use toposlam_conform::{Evidence, ExtractError, LogSource};
use toposlam_logs::{
    entries::Content,
    messages::Run,
    reader::Log,
    record::{EventId, EventKind},
    recorder::ANNOTATED,
    topic_map::{Role, TopicMap},
};
use toposlam_model::format::document::DocumentError;
use toposlam_vision::{
    annotate,
    camera::{Camera, calibration},
    colour::ColourModel,
    sensing::{Sensor, WrongSize},
};

use super::{CliError, input};

/// What the log itself may not contain.
#[derive(Clone, Default, clap::Args)]
pub(super) struct LogOptions {
    /// What each topic carries [default: by the message types; see `toposlam info`]
    #[arg(long, value_name = "FILE")]
    topics: Option<PathBuf>,
    /// The camera calibration, for images [default: the one in the log]
    #[arg(long, value_name = "FILE")]
    calibration: Option<PathBuf>,
    /// The colours of the building, for images [default: those in the log]
    #[arg(long, value_name = "FILE")]
    colours: Option<PathBuf>,
}

pub(super) struct OpenLog {
    pub(super) log: Log,
    pub(super) topics: TopicMap,
    options: LogOptions,
    pub(super) run: Option<Run>,
    sensing: Option<(Camera, ColourModel)>,
}

impl OpenLog {
    pub(super) fn new(path: &Path, options: &LogOptions) -> Result<Self, CliError> {
        let log = input::open_log(path)?;
        let topics = match &options.topics {
            None => TopicMap::unambiguous(&log),
            Some(file) => TopicMap::read(&input::read(file)?)
                .map_err(|error| CliError::in_file(file, error))?
                .completed(&log),
        };
        let mut opened = Self { log, topics, options: options.clone(), run: None, sensing: None };
        let bound = opened.topics.bind(&opened.log);
        bound.map_err(|error| opened.wrong_topics(path, &error))?;
        opened.run = head(path, &opened.log, &opened.topics)?;
        opened.check_used(path)?;
        opened.sensing = opened.sensing(path)?;
        Ok(opened)
    }

    /// Returns an error for a calibration or colours without effect.
    fn check_used(&self, path: &Path) -> Result<(), CliError> {
        let LogOptions { topics, calibration, colours } = &self.options;
        let given = [("--calibration", calibration), ("--colours", colours)];
        let Some((option, _)) = given.into_iter().find(|(_, file)| file.is_some()) else {
            return Ok(());
        };
        // Of several topics one may carry images; then another error names them.
        let ambiguous = topics.is_none() && TopicMap::from_log(&self.log).is_err();
        if self.topics.carrier(Role::Image).is_none() && !ambiguous {
            let cause = format!("this is for images, and {} has none", path.display());
            return Err(CliError::at(option, cause));
        }
        Ok(())
    }

    /// The evidence from which events are inferred.
    ///
    /// # Errors
    /// Returns an error if there is none, for example because several topics could carry the same data.
    pub(super) fn evidence(&self, path: &Path) -> Result<Evidence, CliError> {
        if let Some(evidence) = Evidence::from_topics(&self.topics) {
            return Ok(evidence);
        }
        if self.has_one_percept() {
            return Ok(Evidence::Recorded);
        }
        if self.log.messages_total() == 0 {
            return Err(CliError::in_file(path, "the log is empty: it has no messages"));
        }
        if self.options.topics.is_none() {
            TopicMap::from_log(&self.log).map_err(|error| CliError::in_file(path, error))?;
        }
        let cause = format!("{}. {}", ExtractError::NothingMapped, self.contents());
        Err(CliError::in_file(path, cause))
    }

    /// Why events cannot be derived from a source: what is missing, what the log has, and what to do.
    pub(super) fn lacks(&self, source: Evidence) -> String {
        let is_missing = |role: &&Role| self.topics.carrier(**role).is_none();
        let missing = source.needs().iter().filter(is_missing).map(|role| role.name());
        let missing: Vec<_> = missing.collect();
        let needs: Vec<_> = source.needs().iter().map(|role| role.name()).collect();
        let ambiguous = match TopicMap::from_log(&self.log) {
            Err(error) if self.options.topics.is_none() => format!("{error}. "),
            _ => String::new(),
        };
        format!(
            "this needs {}, and {} is missing. {ambiguous}{}",
            needs.join(" and "),
            missing.join(" and "),
            self.contents()
        )
    }

    /// What the log has, and how to state what its topics carry.
    fn contents(&self) -> String {
        const SHOWN: usize = 8;
        let role_of = |name: &str| {
            let mut roles = self.topics.carriers().filter(|(_, carrier)| carrier.topic == name);
            roles.next().map_or(String::new(), |(role, _)| format!("{}: ", role.name()))
        };
        let with_messages = self.log.topics().iter().filter(|topic| topic.messages > 0);
        let mut topics: Vec<_> = with_messages
            .map(|topic| format!("{}{} ({})", role_of(&topic.name), topic.name, topic.type_name))
            .map(|text| text.escape_debug().to_string())
            .collect();
        if topics.len() > SHOWN {
            topics.truncate(SHOWN);
            topics.push("...".to_owned());
        }
        if topics.is_empty() {
            topics.push("no messages that are read".to_owned());
        }
        let skipped = self.log.skipped();
        let skipped = skipped.map_or(String::new(), |skipped| format!("; other {skipped}"));
        format!(
            "The log has {}{skipped}. A topics file (--topics) states what a topic carries; `toposlam info \
             --write-topics` writes one",
            topics.join(", ")
        )
    }

    /// Whether the log has one percept and no doors: then its robot did not move.
    fn has_one_percept(&self) -> bool {
        let Some(percept) = self.topics.carrier(Role::Percept) else { return false };
        let topics = self.log.topics();
        topics.iter().any(|topic| topic.name == percept.topic && topic.messages == 1)
    }

    /// The camera and the colours: those that are given, or else those in the log.
    fn sensing(&self, path: &Path) -> Result<Option<(Camera, ColourModel)>, CliError> {
        let recorded =
            |text: fn(&Run) -> &String| self.run.as_ref().map(text).filter(|text| !text.is_empty());
        let LogOptions { calibration: camera_file, colours, .. } = &self.options;
        let camera = match (camera_file, recorded(|run| &run.calibration)) {
            (Some(path), _) => Some(input::read_camera(path)?),
            (None, Some(text)) => {
                let no_file = |_: &str| Err(std::io::ErrorKind::NotFound.into());
                let camera = calibration::read(text.as_bytes(), &mut { no_file });
                Some(camera.map_err(|error| {
                    CliError::in_file(path, format!("its calibration: {error}"))
                })?)
            }
            (None, None) => None,
        };
        let colours = match (colours, recorded(|run| &run.colours)) {
            (Some(path), _) => Some(input::read_colours(path)?),
            (None, Some(text)) => Some(
                ColourModel::read(text.as_bytes())
                    .map_err(|error| CliError::in_file(path, format!("its colours: {error}")))?,
            ),
            (None, None) => None,
        };
        Ok(camera.zip(colours))
    }

    /// The log and how its messages are read, with the sensor for its images if they are sensed.
    pub(super) fn source<'l>(&'l self, sensor: Option<&'l Sensor>) -> LogSource<'l> {
        LogSource { log: &self.log, topics: &self.topics, head: self.run.as_ref(), sensor }
    }

    /// The sensor that makes scenes of its images.
    pub(super) fn sensor(&self) -> Option<Sensor> {
        self.sensing.as_ref().map(|(camera, colours)| Sensor::new(camera, colours))
    }

    /// The error for a topic map that does not fit its log.
    pub(super) fn wrong_topics(&self, log: &Path, error: &DocumentError) -> CliError {
        match &self.options.topics {
            Some(path) => CliError::in_file(path, format!("{error} ({})", log.display())),
            None => CliError::in_file(log, error),
        }
    }

    /// The error for a calibration that does not fit the images of its log.
    pub(super) fn wrong_calibration(&self, log: &Path, error: &WrongSize) -> CliError {
        match &self.options.calibration {
            Some(path) => CliError::in_file(path, format!("{error} ({})", log.display())),
            None => CliError::in_file(log, format!("its calibration: {error}")),
        }
    }

    /// The last image up to a message, with its scene drawn over it if it is known.
    pub(super) fn image(&self, last_message: EventId) -> Option<Vec<u8>> {
        let annotated = self.log.topics().iter().position(|topic| topic.name == ANNOTATED);
        let topics = match annotated {
            Some(_) => TopicMap::with_topic(Role::Image, ANNOTATED),
            None => self.topics.only(&[Role::Image]),
        };
        let bound = topics.bind(&self.log).ok()?;
        let mut last = None;
        for entry in self.log.entries(&bound) {
            match entry.ok()? {
                entry if entry.id > last_message => break,
                entry => last = Some(entry.content),
            }
        }
        let Some(Content::Event(EventKind::Frame(frame))) = last else { return None };
        let taken = frame.image?;
        if let (Some(file), true) = (taken.file(), annotated.is_some() || self.sensing.is_none()) {
            return Some(file.to_vec());
        }
        let image = taken.pixels().ok()?;
        let drawn = match (&self.sensing, self.sensor()) {
            (Some((camera, _)), Some(mut sensor)) => {
                annotate::over(image, camera, &sensor.sense(image).ok()?)
            }
            _ => image.clone(),
        };
        let mut bytes = Vec::new();
        drawn.write_with_encoder(image::codecs::jpeg::JpegEncoder::new(&mut bytes)).ok()?;
        Some(bytes)
    }
}

/// The description of the run at the beginning of a log.
fn head(path: &Path, log: &Log, topics: &TopicMap) -> Result<Option<Run>, CliError> {
    let failed = |error| CliError::in_file(path, error);
    let Ok(bound) = topics.only(&[Role::Run]).bind(log) else { return Ok(None) };
    for entry in log.entries(&bound) {
        if let Content::Run(run) = entry.map_err(failed)?.content {
            return Ok(Some(run));
        }
    }
    Ok(None)
}
