//! Recorded logs, for Python: the head, the topics, and what they record as columns.

use std::{
    collections::BTreeMap,
    fmt::Display,
    path::{Path, PathBuf},
};

use pyo3::{
    prelude::*,
    types::{IntoPyDict, PyDict},
};
use toposlam_draw::picture::{LaserRunPicture, laser_run_svg};
use toposlam_logs::{
    entries::{Content, Entry},
    error::LogError,
    messages::Run,
    reader::Log,
    record::{EventKind, Frame, RunEnding},
    topic_map::{Role, TopicMap},
};
use toposlam_model::{
    driving::{
        odometry::Odometry,
        scene::{Place, Scene},
    },
    enumerate::Watch,
    percept::Door,
};

use crate::{
    error::{error, interrupted},
    long_work::{Watcher, run_watched},
    percept::Percept,
};

/// A log that is open for reading.
#[pyclass(frozen, module = "toposlam._core")]
pub(crate) struct LogReader {
    pub(crate) path: PathBuf,
    pub(crate) log: Log,
    pub(crate) mapping: TopicMap,
    pub(crate) run: Option<Run>,
}

/// What a log records: the columns of each table, which have the same length. Times are seconds since the first
/// message.
#[derive(Default, IntoPyObject)]
pub(crate) struct Tables {
    events: EventColumns,
    scenes: SceneColumns,
    poses: PoseColumns,
}

#[derive(Default, IntoPyObject)]
struct EventColumns {
    time: Vec<f64>,
    message: Vec<u64>,
    kind: Vec<&'static str>,
    degree: Vec<Option<u32>>,
    percept: Vec<Option<Percept>>,
    door: Vec<Option<u32>>,
    text: Vec<String>,
}

#[derive(Default, IntoPyObject)]
struct SceneColumns {
    time: Vec<f64>,
    message: Vec<u64>,
    place: Vec<&'static str>,
    doors: Vec<Vec<f64>>,
    heading: Vec<Option<f64>>,
    left: Vec<Option<f64>>,
    right: Vec<Option<f64>>,
    marker: Vec<Option<[f64; 2]>>,
}

#[derive(Default, IntoPyObject)]
struct PoseColumns {
    time: Vec<f64>,
    x: Vec<f64>,
    y: Vec<f64>,
    heading: Vec<f64>,
}

#[pymethods]
impl LogReader {
    #[new]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let opened = run_watched(py, None, None, |_| {
            let log = Log::open(&path)?;
            let mapping = TopicMap::unambiguous(&log);
            let run = head(&log, &mapping)?;
            Ok::<_, LogError>((log, mapping, run))
        })?;
        let (log, mapping, run) = opened.map_err(|cause| log_error(py, &path, &cause))?;
        Ok(Self { path, log, mapping, run })
    }

    #[getter]
    fn format(&self) -> &'static str {
        self.log.format().name()
    }

    /// Each topic: its name, its type and the number of its messages.
    #[getter]
    fn topics(&self) -> Vec<(String, String, u64)> {
        let topics = self.log.topics().iter();
        topics.map(|topic| (topic.name.clone(), topic.short_type(), topic.messages)).collect()
    }

    /// Why the end of the log is missing, if it is.
    #[getter]
    fn truncation(&self) -> Option<String> {
        self.log.truncation().map(ToString::to_string)
    }

    /// The times of the first and the last message, in nanoseconds.
    #[getter]
    fn times(&self) -> Option<(u64, u64)> {
        self.log.start().zip(self.log.end())
    }

    /// The head of the log: world, start, marker and algorithm, as far as they are recorded.
    #[getter]
    fn head<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let fields = self.run.iter().flat_map(|run| {
            [
                ("world", &run.world),
                ("start", &run.start),
                ("marker", &run.marker),
                ("algorithm", &run.algorithm),
            ]
        });
        fields.filter(|(_, text)| !text.is_empty()).into_py_dict(py)
    }

    fn tables(&self, py: Python<'_>, progress: Option<&Bound<'_, PyAny>>) -> PyResult<Tables> {
        let read = run_watched(py, progress, None, |watcher| self.read(watcher))?;
        let read = read.map_err(|cause| self.error(py, &cause))?;
        read.ok_or_else(interrupted)
    }
}

/// The description of the run at the beginning of a log.
fn head(log: &Log, mapping: &TopicMap) -> Result<Option<Run>, LogError> {
    let Ok(bound) = mapping.only(&[Role::Run]).bind(log) else { return Ok(None) };
    for entry in log.entries(&bound) {
        if let Content::Run(run) = entry?.content {
            return Ok(Some(run));
        }
    }
    Ok(None)
}

impl LogReader {
    /// The exception for a log that cannot be read or checked.
    pub(crate) fn error(&self, py: Python<'_>, cause: &dyn Display) -> PyErr {
        log_error(py, &self.path, cause)
    }

    /// Reads the tables; `None` if the reading was stopped.
    fn read(&self, watcher: &Watcher) -> Result<Option<Tables>, String> {
        let mut tables = Tables::default();
        let bound = self.mapping.bind(&self.log).map_err(|cause| cause.to_string())?;
        let begun = self.log.start().unwrap_or_default();
        for entry in self.log.entries(&bound) {
            if watcher.stop() {
                return Ok(None);
            }
            tables.add(entry.map_err(|cause| cause.to_string())?, begun);
            watcher.count(1);
        }
        Ok(Some(tables))
    }
}

impl Tables {
    fn add(&mut self, entry: Entry, begun: u64) {
        let time = entry.time.saturating_sub(begun) as f64 / 1e9;
        let message = entry.id.0;
        let (kind, degree, percept, door, text) = match entry.content {
            Content::TurnedBack => ("turned-back", None, None, None, String::new()),
            Content::Undecided => ("undecided", None, None, None, String::new()),
            Content::Event(EventKind::Door { door: Door(door), .. }) => {
                ("door", None, None, Some(door), String::new())
            }
            Content::Event(EventKind::Arrival(arrival)) => {
                let percept = arrival.percept().map(Percept);
                ("percept", Some(arrival.degree), percept, None, String::new())
            }
            Content::Event(EventKind::End(end)) => {
                let how = match end.ending {
                    RunEnding::Mapped => "mapped".to_owned(),
                    RunEnding::Stopped => "stopped".to_owned(),
                    RunEnding::GaveUp(cause) => format!("gave up: {cause}"),
                    RunEnding::OutOfBudget(cause) => format!("out of budget: {cause}"),
                };
                ("end", None, None, None, how)
            }
            Content::Event(EventKind::Odometry(odometry)) => return self.poses.add(time, odometry),
            Content::Event(EventKind::Frame(frame)) => return self.add_frame(time, message, frame),
            Content::Run(_) | Content::Hypothesis(_) | Content::Fiducial(_) | Content::Event(_) => {
                return;
            }
        };
        self.events.time.push(time);
        self.events.message.push(message);
        self.events.kind.push(kind);
        self.events.degree.push(degree);
        self.events.percept.push(percept);
        self.events.door.push(door);
        self.events.text.push(text);
    }

    fn add_frame(&mut self, time: f64, message: u64, frame: Frame) {
        if frame.scan.is_some() {
            self.poses.add(time, frame.odometry);
        }
        let Some(Scene { place, marker }) = frame.scene else { return };
        let (place, hallway, doors) = match place {
            Place::Hallway(view) => ("hallway", Some(view), Vec::new()),
            Place::Junction(view) => {
                let place = if view.is_certain() { "junction" } else { "possible-junction" };
                (place, None, view.doors.iter().map(|door| door.direction).collect())
            }
            Place::Unknown(_) => ("unknown", None, Vec::new()),
        };
        self.scenes.time.push(time);
        self.scenes.message.push(message);
        self.scenes.place.push(place);
        self.scenes.doors.push(doors);
        self.scenes.heading.push(hallway.as_ref().map(|view| view.heading));
        self.scenes.left.push(hallway.as_ref().map(|view| view.left));
        self.scenes.right.push(hallway.as_ref().map(|view| view.right));
        self.scenes.marker.push(marker.map(|marker| marker.position));
    }
}

impl PoseColumns {
    /// Adds a pose, unless the last message recorded it already.
    fn add(&mut self, time: f64, Odometry { position: [x, y], heading }: Odometry) {
        let last = [&self.time, &self.x, &self.y, &self.heading].map(|column| column.last());
        if last != [Some(&time), Some(&x), Some(&y), Some(&heading)] {
            self.time.push(time);
            self.x.push(x);
            self.y.push(y);
            self.heading.push(heading);
        }
    }
}

/// What the scans of a laser log hit, and the robot's way, as an SVG document.
#[pyfunction]
pub(crate) fn log_picture(py: Python<'_>, reader: &LogReader, title: &str) -> PyResult<String> {
    let drawn = run_watched(py, None, None, |watcher| {
        let bound = reader.mapping.only(&[Role::Scan, Role::Odometry]).bind(&reader.log);
        let mut picture = LaserRunPicture { title: title.to_owned(), ..LaserRunPicture::default() };
        for entry in reader.log.entries(&bound.map_err(|cause| cause.to_string())?) {
            if watcher.stop() {
                return Ok(None);
            }
            picture.add(entry.map_err(|cause| cause.to_string())?, &BTreeMap::new());
        }
        Ok::<_, String>(Some(laser_run_svg(&picture)))
    })?;
    drawn.map_err(|cause| reader.error(py, &cause))?.ok_or_else(interrupted)
}

fn log_error(py: Python<'_>, path: &Path, cause: &dyn Display) -> PyErr {
    error(py, "LogError", format!("{}: {cause}", path.display()))
}
