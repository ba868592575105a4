//! Recorded logs, for Python: the head, the topics, and what they record as columns.

use std::path::{Path, PathBuf};

use pyo3::{IntoPyObjectExt, prelude::*, types::PyDict};
use toposlam_draw::picture::{LaserRunPicture, laser_run_svg};
use toposlam_logs::{
    Format,
    entries::{Content, Entry},
    error::LogError,
    messages::Run,
    reader::Log,
    record::{Arrival, EventKind, Frame, RunEnding},
    topic_map::{Role, TopicMap},
};
use toposlam_model::{
    driving::{
        odometry::Odometry,
        scene::{Place, Scene},
    },
    enumerate::Watch,
    percept::{Door, Percept as ModelPercept},
};
use toposlam_vision::geometry::from_robot;

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

/// What a log records, line by line. The columns of a table have the same length.
#[derive(Default)]
struct Tables {
    events: Vec<EventRow>,
    scenes: Vec<SceneRow>,
    poses: Vec<[f64; 4]>,
}

struct EventRow {
    time: f64,
    message: u64,
    kind: &'static str,
    percept: Option<ModelPercept>,
    degree: Option<u32>,
    door: Option<u32>,
    text: String,
}

struct SceneRow {
    time: f64,
    message: u64,
    place: &'static str,
    doors: Vec<f64>,
    heading: Option<f64>,
    left: Option<f64>,
    right: Option<f64>,
    marker: Option<[f64; 2]>,
}

#[pymethods]
impl LogReader {
    #[new]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let failed = |cause: &dyn std::fmt::Display| {
            error(py, "LogError", format!("{}: {cause}", path.display()))
        };
        let opened = run_watched(py, None, None, |_| {
            let log = Log::open(&path)?;
            let mapping = TopicMap::unambiguous(&log);
            let run = head(&log, &mapping)?;
            Ok::<_, LogError>((log, mapping, run))
        })?;
        let (log, mapping, run) = opened.map_err(|cause| failed(&cause))?;
        Ok(Self { path, log, mapping, run })
    }

    /// The format, in words.
    #[getter]
    fn format(&self) -> &'static str {
        match self.log.format() {
            Format::Bag => "bag",
            Format::Mcap => "mcap",
            Format::Carmen => "carmen",
            Format::Events => "events",
            Format::Database => "db3",
            Format::Folder => "rosbag2",
        }
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
        let head = PyDict::new(py);
        if let Some(run) = &self.run {
            let fields = [
                ("world", &run.world),
                ("start", &run.start),
                ("marker", &run.marker),
                ("algorithm", &run.algorithm),
            ];
            for (name, text) in fields {
                if !text.is_empty() {
                    head.set_item(name, text)?;
                }
            }
        }
        Ok(head)
    }

    /// The tables "events", "scenes" and "poses", each as its columns. Times are seconds since the first
    /// message.
    fn tables<'py>(
        &self,
        py: Python<'py>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let read = run_watched(py, progress, None, |watcher| self.read(watcher))?;
        let tables = match read {
            Ok(Some(tables)) => tables,
            Ok(None) => return Err(interrupted()),
            Err(cause) => {
                let text = format!("{}: {cause}", self.path.display());
                return Err(error(py, "LogError", text));
            }
        };
        let all = PyDict::new(py);
        all.set_item("events", tables.event_columns(py)?)?;
        all.set_item("scenes", tables.scene_columns(py)?)?;
        let poses = PyDict::new(py);
        for (column, name) in ["time", "x", "y", "heading"].into_iter().enumerate() {
            let values: Vec<f64> = tables.poses.iter().map(|pose| pose[column]).collect();
            poses.set_item(name, values)?;
        }
        all.set_item("poses", poses)?;
        Ok(all)
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
        let event = |kind, text: String| {
            let (percept, degree, door) = (None, None, None);
            EventRow { time, message, kind, percept, degree, door, text }
        };
        match entry.content {
            Content::TurnedBack => {
                let row = event("turned-back", String::new());
                self.events.push(row);
            }
            Content::Undecided => {
                let row = event("undecided", String::new());
                self.events.push(row);
            }
            Content::Event(EventKind::Door { door: Door(door), .. }) => {
                let row = EventRow { door: Some(door), ..event("door", String::new()) };
                self.events.push(row);
            }
            Content::Event(EventKind::Arrival(arrival)) => {
                let Arrival { degree, .. } = arrival;
                let (percept, degree) = (arrival.percept(), Some(degree));
                let row = EventRow { percept, degree, ..event("percept", String::new()) };
                self.events.push(row);
            }
            Content::Event(EventKind::End(end)) => {
                let how = match end.ending {
                    RunEnding::Mapped => "mapped".to_owned(),
                    RunEnding::Stopped => "stopped".to_owned(),
                    RunEnding::GaveUp(cause) => format!("gave up: {cause}"),
                    RunEnding::OutOfBudget(cause) => format!("out of budget: {cause}"),
                };
                let row = event("end", how);
                self.events.push(row);
            }
            Content::Event(EventKind::Odometry(odometry)) => self.add_pose(time, odometry),
            Content::Event(EventKind::Frame(frame)) => self.add_frame(time, message, &frame),
            Content::Run(_) | Content::Hypothesis(_) | Content::Fiducial(_) | Content::Event(_) => {
            }
        }
    }

    /// Adds a pose, unless the last message recorded it already.
    fn add_pose(&mut self, time: f64, Odometry { position: [x, y], heading }: Odometry) {
        let pose = [time, x, y, heading];
        if self.poses.last() != Some(&pose) {
            self.poses.push(pose);
        }
    }

    fn add_frame(&mut self, time: f64, message: u64, frame: &Frame) {
        if frame.scan.is_some() {
            self.add_pose(time, frame.odometry);
        }
        let Some(Scene { place, marker }) = &frame.scene else { return };
        let marker = marker.map(|marker| marker.position);
        let (doors, heading, left, right) = (Vec::new(), None, None, None);
        let row = SceneRow { time, message, place: "unknown", doors, heading, left, right, marker };
        self.scenes.push(match place {
            Place::Hallway(view) => SceneRow {
                place: "hallway",
                heading: Some(view.heading),
                left: Some(view.left),
                right: Some(view.right),
                ..row
            },
            Place::Junction(view) => SceneRow {
                place: "junction",
                doors: view.doors.iter().map(|door| door.direction).collect(),
                ..row
            },
            Place::Unknown(_) => row,
        });
    }

    fn event_columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        let column = |get: &dyn Fn(&EventRow) -> PyResult<Py<PyAny>>| {
            self.events.iter().map(get).collect::<PyResult<Vec<_>>>()
        };
        columns.set_item("time", column(&|row| row.time.into_py_any(py))?)?;
        columns.set_item("message", column(&|row| row.message.into_py_any(py))?)?;
        columns.set_item("kind", column(&|row| row.kind.into_py_any(py))?)?;
        columns.set_item("degree", column(&|row| row.degree.into_py_any(py))?)?;
        columns.set_item("percept", column(&|row| row.percept.map(Percept).into_py_any(py))?)?;
        columns.set_item("door", column(&|row| row.door.into_py_any(py))?)?;
        columns.set_item("text", column(&|row| row.text.as_str().into_py_any(py))?)?;
        Ok(columns)
    }

    fn scene_columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        let column = |get: &dyn Fn(&SceneRow) -> PyResult<Py<PyAny>>| {
            self.scenes.iter().map(get).collect::<PyResult<Vec<_>>>()
        };
        columns.set_item("time", column(&|row| row.time.into_py_any(py))?)?;
        columns.set_item("message", column(&|row| row.message.into_py_any(py))?)?;
        columns.set_item("place", column(&|row| row.place.into_py_any(py))?)?;
        columns.set_item("doors", column(&|row| row.doors.clone().into_py_any(py))?)?;
        columns.set_item("heading", column(&|row| row.heading.into_py_any(py))?)?;
        columns.set_item("left", column(&|row| row.left.into_py_any(py))?)?;
        columns.set_item("right", column(&|row| row.right.into_py_any(py))?)?;
        columns.set_item("marker", column(&|row| row.marker.into_py_any(py))?)?;
        Ok(columns)
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
            let entry = entry.map_err(|cause| cause.to_string())?;
            add_scan(&mut picture, entry);
        }
        Ok::<_, String>(Some(laser_run_svg(&picture)))
    })?;
    let drawn = drawn
        .map_err(|cause| error(py, "LogError", format!("{}: {cause}", reader.path.display())))?;
    drawn.ok_or_else(interrupted)
}

fn add_scan(picture: &mut LaserRunPicture, entry: Entry) {
    let Content::Event(EventKind::Frame(Frame { scan: Some(scan), odometry, .. })) = entry.content
    else {
        return;
    };
    let [east, north] = odometry.position;
    if [east, north, odometry.heading].iter().all(|number| number.is_finite()) {
        picture.way.push(odometry.position);
        let odometry_from_robot = from_robot(&odometry);
        for hit in scan.hits() {
            picture.hits.add((odometry_from_robot * hit).into());
        }
    }
}

/// The path of a log, for messages.
pub(crate) fn shown(path: &Path) -> String {
    path.display().to_string()
}
