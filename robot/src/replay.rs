//! The off-line version on a log: sensing, Algorithm 2 and the mapping algorithm run on the recorded frames,
//! without a robot that moves, and their results are compared with the recorded ones. Section 6.

use std::{collections::HashMap, fmt};

use thiserror::Error;
use toposlam_logs::{
    entries::{Content, Entries},
    error::LogError,
    reader::Log,
    record::{Arrival, CameraImage, Event, EventKind, Frame, MapRecord, RunObserver},
    topic_map::{Role, TopicMap},
};
use toposlam_model::{
    driving::{algorithm2::Command, scene::Scene},
    format::document::DocumentError,
    mapping::{MapWalk, MappingError},
    percept::{Door, Percept},
};
use toposlam_vision::sensing::{Sensor, WrongSize};

use crate::{
    explorer::{ExplorerError, RobotExplorer},
    recording::RecordedRobot,
    run_settings::RunSettings,
};

/// How many of the recorded results were reproduced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Agreement {
    pub agree: u64,
    pub of: u64,
}

impl Agreement {
    pub fn is_whole(self) -> bool {
        self.agree == self.of
    }
}

/// The result of the off-line version on a log.
#[derive(Debug)]
pub struct Replay {
    pub mapping: MapWalk,
    /// Why the run ended early, if it did.
    pub error: Option<MappingError<ExplorerError>>,
    pub comparison: ReplayComparison,
    /// How long the recorded run took.
    pub recorded_seconds: f64,
    /// The recorded frames that were used: images or scenes.
    pub frames: Role,
}

/// How a replay compares with the recorded run.
#[derive(Clone, Debug, Default)]
pub struct ReplayComparison {
    /// The number of frames that were used, and when the last one was taken.
    pub frames: u64,
    time: f64,
    pub scenes: Agreement,
    pub commands: Agreement,
    pub percepts: Agreement,
    pub doors: Agreement,
    /// Whether the map is the last recorded one; `None` if none was recorded, or if the replay reached the
    /// bound on darts.
    pub map: Option<bool>,
    /// The first result that differs from the recorded one.
    pub difference: Option<ReplayDifference>,
}

/// A result that differs from the recorded one.
#[derive(Clone, Debug, PartialEq)]
pub struct ReplayDifference {
    /// The number of the frame, counted from 1.
    pub frame: u64,
    /// When it was taken, in seconds since the first message of the log.
    pub time: f64,
    pub what: &'static str,
    pub recorded: String,
    pub found: String,
}

#[derive(Debug, Error)]
pub enum ReplayError {
    #[error(transparent)]
    Log(#[from] LogError),
    #[error(transparent)]
    TopicMap(#[from] DocumentError),
    #[error("the calibration is not that of its camera: {0}")]
    Calibration(#[from] WrongSize),
    #[error("sensing its images needs --calibration and --colours: the log does not have both")]
    NoSensor,
    #[error(
        "it has neither images nor scenes together with odometry and the commands of Algorithm 2; \
         check the run of another robot with `toposlam conform`"
    )]
    Nothing,
}

/// Runs the off-line version on a log.
///
/// # Errors
/// Returns an error if the log cannot be read or has nothing to replay, or if its first image is not of
/// the calibrated camera's size.
// paper: exp.off-line
pub fn replay(
    log: &Log,
    topics: &TopicMap,
    sensor: Option<Sensor>,
    settings: &RunSettings,
) -> Result<Replay, ReplayError> {
    let has = |role| topics.carrier(role).is_some();
    let frames = if has(Role::Image) { Role::Image } else { Role::Scene };
    if !has(frames) || !has(Role::Odometry) || !has(Role::Command) {
        return Err(ReplayError::Nothing);
    }
    let roles =
        [frames, Role::Scene, Role::Odometry, Role::Command, Role::Percept, Role::Door, Role::Map];
    let bound = topics.only(&roles).bind(log)?;
    let start = log.start().unwrap_or(0);
    let robot = RecordedRobot::new(LogFrames {
        entries: log.entries(&bound),
        of_images: frames == Role::Image,
        last: 0,
        recorded: RecordedResults::default(),
        failure: None,
    });
    if let Some(image) = robot.next.as_ref().and_then(|frame| frame.image.as_ref()) {
        check_size(sensor.as_ref().ok_or(ReplayError::NoSensor)?, image)?;
    }
    let mut explorer = RobotExplorer::new(robot, sensor, Results::default());
    let (mapping, mapped) = explorer.map(settings);
    let error = mapped.err();
    let (RecordedRobot { frames: mut rest, .. }, results) = explorer.into_parts();
    // The results after the last frame that was used are compared, too.
    rest.by_ref().for_each(drop);
    if let Some(failure) = rest.failure {
        return Err(failure.into());
    }
    let mut comparison = rest.recorded.compare(&results.0);
    let map = MapRecord::from_walk(&mapping);
    // A map that may not grow any more is not compared with the recorded one.
    let ended = !matches!(error, Some(MappingError::Bound { .. }));
    let recorded = rest.recorded.map.filter(|_| ended);
    comparison.map = recorded.map(|recorded| recorded.same_map(&map));
    let length = log.end().unwrap_or(0).saturating_sub(start);
    Ok(Replay { error, comparison, recorded_seconds: length as f64 / 1e9, mapping, frames })
}

/// Checks that an image has the size of the calibrated camera's. A damaged image has none.
fn check_size(sensor: &Sensor, image: &CameraImage) -> Result<(), WrongSize> {
    let Ok(pixels) = image.pixels() else { return Ok(()) };
    let (found, expected) = ([pixels.width(), pixels.height()], sensor.camera().image);
    if found == expected { Ok(()) } else { Err(WrongSize { found, expected }) }
}

/// The frames of a log. Collects the recorded results between them.
struct LogFrames<'l> {
    entries: Entries<'l>,
    /// Whether frames are made of images, and not of scenes.
    of_images: bool,
    /// The last frame: what follows it is its result.
    last: u64,
    recorded: RecordedResults,
    failure: Option<LogError>,
}

impl Iterator for LogFrames<'_> {
    type Item = Frame;

    fn next(&mut self) -> Option<Frame> {
        while self.failure.is_none() {
            let entry = match self.entries.next()? {
                Ok(entry) => entry,
                Err(error) => {
                    self.failure = Some(error);
                    return None;
                }
            };
            let Content::Event(kind) = entry.content else { continue };
            match kind {
                EventKind::Frame(frame) if frame.image.is_some() == self.of_images => {
                    self.last = frame.id;
                    return Some(frame);
                }
                EventKind::Frame(Frame { scene: Some(scene), .. }) => {
                    self.recorded.scenes.insert(self.last, scene);
                }
                EventKind::Command { command: Some(command), .. } => {
                    self.recorded.commands.insert(self.last, command);
                }
                EventKind::Arrival(arrival) => self.recorded.arrivals.push(arrival),
                EventKind::Door { door, .. } => self.recorded.doors.push(door),
                EventKind::Map(map) => self.recorded.map = Some(map),
                _ => {}
            }
        }
        None
    }
}

/// The results of a replay: its events, without images.
#[derive(Default)]
struct Results(Vec<Event>);

impl RunObserver for Results {
    fn event(&mut self, event: &Event) {
        let mut event = event.clone();
        if let EventKind::Frame(frame) = &mut event.kind {
            frame.image = None;
        }
        self.0.push(event);
    }
}

#[derive(Default)]
struct RecordedResults {
    /// By the frame before.
    scenes: HashMap<u64, Scene>,
    commands: HashMap<u64, Command>,
    arrivals: Vec<Arrival>,
    doors: Vec<Door>,
    map: Option<MapRecord>,
}

/// Commands may differ by this much: a log stores odometry as a quaternion.
const SAME: f64 = 1e-6;

impl RecordedResults {
    fn compare(&self, results: &[Event]) -> ReplayComparison {
        let mut to = ReplayComparison::default();
        let mut id = 0;
        for event in results {
            match &event.kind {
                EventKind::Frame(frame) => {
                    to.frames += 1;
                    (id, to.time) = (frame.id, frame.taken);
                    if let (Some(recorded), Some(found)) = (self.scenes.get(&id), &frame.scene) {
                        to.note(|to| &mut to.scenes, recorded == found, "scene", recorded, found);
                    }
                }
                EventKind::Command { command: Some(found), .. } => {
                    if let Some(recorded) = self.commands.get(&id) {
                        let same = (recorded.turn - found.turn).abs() <= SAME
                            && (recorded.forward - found.forward).abs() <= SAME;
                        to.note(|to| &mut to.commands, same, "command", recorded, found);
                    }
                }
                EventKind::Door { door: found, .. } => {
                    let recorded = self.doors.get(to.doors.of as usize);
                    let same = recorded == Some(found);
                    to.note(|to| &mut to.doors, same, "door", &recorded, found);
                }
                EventKind::Arrival(arrival) => {
                    let Some(percept) = arrival.percept() else { continue };
                    let recorded = self.arrivals.get(to.percepts.of as usize);
                    let same = recorded.is_some_and(|recorded| recorded.agrees(&percept));
                    // What is not recorded cannot differ.
                    let recorded = recorded.map(|recorded| Percept {
                        degree: recorded.degree,
                        sighting: recorded.sighting.unwrap_or(percept.sighting),
                    });
                    to.note(|to| &mut to.percepts, same, "percept", &recorded, &percept);
                }
                _ => {}
            }
        }
        // Recorded results that were not reached do not agree.
        to.percepts.of = to.percepts.of.max(self.arrivals.len() as u64);
        to.doors.of = to.doors.of.max(self.doors.len() as u64);
        to
    }
}

impl ReplayComparison {
    /// Counts a result, and keeps the first one that differs.
    fn note(
        &mut self,
        results: fn(&mut Self) -> &mut Agreement,
        same: bool,
        what: &'static str,
        recorded: &impl fmt::Debug,
        found: &impl fmt::Debug,
    ) {
        let results = results(self);
        results.of += 1;
        results.agree += u64::from(same);
        if !same && self.difference.is_none() {
            let (frame, time) = (self.frames, self.time);
            let (recorded, found) = (format!("{recorded:?}"), format!("{found:?}"));
            self.difference = Some(ReplayDifference { frame, time, what, recorded, found });
        }
    }
}
