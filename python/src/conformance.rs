//! A log, checked against the specification.

use pyo3::{prelude::*, types::PyDict};
use toposlam_model::{embedded_graph::Dart, enumerate::Class, folding::{SmallestWorld, WorldSearch}, format::named_world::NamedWorld, mapping::MappingAlgorithm, marker::{Marker, NoMarker}, percept::{Percept as ModelPercept, Sighting}, trace::{AlgorithmCase, anywhere}, world::{GraphWorld, State}};
use toposlam_conform::{CheckedKind, ConformConfig, Evidence, ExtractConfig, ExtractError, ExtractedRun, Judgement, KnownWorld, LogHead, Quirks, RESUMED, RunDriver, assume_marker, extract, judge, marker_at_start};
use toposlam_logs::topic_map::TopicMap;
use toposlam_robot::run_settings::RecordedSettings;
use toposlam_vision::{camera::calibration, colour::ColourModel, laser::params::LaserParams, sensing::Sensor};

use crate::{error::{error, interrupted}, log::{LogReader, shown}, long_work::{Watcher, run_watched}, percept::Percept, world::{CoreWorld, named_marker}};

/// How a log is checked.
struct Question {
    world: Option<NamedWorld>,
    start: Option<Dart>,
    marker: &'static dyn Marker,
    /// Whether the marker is not given, but that of the log or, without a record, assumed.
    is_assumed: bool,
    driver: RunDriver,
    settings: RecordedSettings,
    class: Class,
    corners: bool,
    assume_marker: bool,
    max_edges: Option<usize>,
    max_steps: u64,
    max_darts: usize,
}

/// A log that was checked.
struct Checked {
    extracted: ExtractedRun,
    judgement: Judgement,
    /// What a reader of the report should know about the run.
    remarks: Vec<String>,
}

/// Checks a log. Returns what the report contains.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
pub(crate) fn conform<'py>(
    py: Python<'py>,
    log: &LogReader,
    world: Option<&CoreWorld>,
    marker: Option<&str>,
    driver: &str,
    class_: &str,
    corners: bool,
    assumed: bool,
    max_edges: Option<usize>,
    max_steps: u64,
    max_darts: Option<usize>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let head = LogHead(log.run.as_ref());
    let is_assumed = marker.is_none();
    let marker = match marker {
        Some(name) => named_marker(py, name)?,
        None => head.marker().map_err(|unknown| error(py, "UnknownMarkerError", unknown))?,
    };
    let unknown = |cause: &dyn std::fmt::Display| error(py, "UnknownAlgorithmError", cause);
    let settings = match driver {
        "anyone" => RecordedSettings::default(),
        "algorithm" => head.settings(None).map_err(|head| {
            unknown(&format!(
                "the algorithm `{head}` of the log is unknown; use driver=\"algorithm1\""
            ))
        })?,
        name => {
            let algorithm: MappingAlgorithm = name.parse().map_err(|cause| unknown(&cause))?;
            head.settings(Some(algorithm)).map_err(|head| unknown(&head))?
        }
    };
    let driver = if driver == "anyone" { RunDriver::Anyone } else { RunDriver::from(settings) };
    let class = class_.parse().map_err(|unknown| error(py, "UnknownClassError", unknown))?;
    let question = Question {
        world: world.map(|world| world.0.clone()),
        start: None,
        marker,
        is_assumed,
        driver,
        settings,
        class,
        corners,
        assume_marker: assumed,
        max_edges,
        max_steps,
        max_darts: max_darts.unwrap_or(settings.dart_bound),
    };
    let checked = run_watched(py, progress, None, |watcher| {
        let checked = check(log, question, watcher);
        (checked, toposlam_model::enumerate::Watch::stop(watcher))
    })?;
    match checked {
        (_, true) => Err(interrupted()),
        (Err(cause), false) => Err(error(py, "LogError", format!("{}: {cause}", shown(&log.path)))),
        (Ok(checked), false) => report(py, &checked),
    }
}

fn check(log: &LogReader, mut question: Question, watcher: &Watcher) -> Result<Checked, String> {
    let text = |cause: &dyn std::fmt::Display| cause.to_string();
    let evidence = Evidence::of(&log.mapping).ok_or_else(|| {
        let ambiguous = TopicMap::from_log(&log.log).err();
        ambiguous.map_or_else(|| ExtractError::NothingMapped.to_string(), |cause| cause.to_string())
    })?;
    let laser = LaserParams::default();
    let laser = LaserParams {
        corner: toposlam_vision::laser::params::CornerParams {
            corners: question.corners,
            ..laser.corner
        },
        ..laser
    };
    let sensor = sensor(log)?;
    let marked = question.marker.name() != NoMarker.name();
    let config = ExtractConfig { evidence, sensor: sensor.as_ref(), marked, laser };
    let mut extracted =
        extract(&log.log, &log.mapping, &config, watcher).map_err(|cause| text(&cause))?;
    if question.assume_marker {
        let place = marker_at_start(&extracted.junctions).ok_or("no junction is visited")?;
        let events = &mut extracted.events.events;
        assume_marker(events, &extracted.junctions, question.marker, place)
            .map_err(|cause| text(&cause))?;
    }
    if evidence == Evidence::Laser && !question.corners {
        // In a laser log bends of corridors are vertices only if that is asked for.
        question.world = question.world.as_ref().map(NamedWorld::smoothed);
    }
    let head = LogHead(log.run.as_ref());
    if question.is_assumed && question.driver != RunDriver::Anyone {
        let algorithm = question.settings.method.algorithm();
        head.check_marker(&extracted.events, algorithm).map_err(|cause| {
            format!("{cause}; for a run without a marker add driver=\"anyone\", marker=\"none\"")
        })?;
    }
    question.start = question.world.as_ref().and_then(|world| head.start(world));
    let resumed = question.settings.is_resumed.then(|| RESUMED.to_owned());
    let other = question.world.as_ref().and_then(|world| head.other_world(&world.graph));
    let skipped = log.log.skipped().map(|skipped| format!("skipped {skipped}"));
    let skipped = skipped.into_iter().chain(extracted.skipped.in_words());
    let remarks = other.into_iter().chain(resumed).chain(skipped).collect();
    let known = question.world.as_ref().map(|world| {
        let start = question.start.or(world.start);
        KnownWorld { graph: &world.graph, states: states(world, question.marker, start) }
    });
    let search = WorldSearch {
        class: question.class,
        max_edges: question.max_edges,
        steps: question.max_steps,
    };
    let config = ConformConfig {
        world: known,
        marker: question.marker,
        driver: question.driver,
        budget: question.settings.budget,
        search,
        dart_bound: question.max_darts,
    };
    // A robot that no algorithm drives may turn back between junctions.
    let mut events = extracted.events.clone();
    events.complete_sightings(question.marker).map_err(|cause| text(&cause))?;
    if question.driver == RunDriver::Anyone {
        events = events.without_excursions();
    }
    let judgement =
        judge(events, &config, &Quirks::default(), watcher).map_err(|cause| text(&cause))?;
    Ok(Checked { extracted, judgement, remarks })
}

/// The possible states of the robot and its marker at the start.
fn states(world: &NamedWorld, marker: &'static dyn Marker, start: Option<Dart>) -> Vec<State> {
    match start {
        None => anywhere(&world.graph, &marker),
        Some(facing) => vec![GraphWorld::with_marker(&world.graph, marker, facing).state()],
    }
}

/// The sensor for the images of a log, if it records a calibration and colours.
fn sensor(log: &LogReader) -> Result<Option<Sensor>, String> {
    let Some(run) = &log.run else { return Ok(None) };
    if run.calibration.is_empty() || run.colours.is_empty() {
        return Ok(None);
    }
    let no_file = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let camera = calibration::read(run.calibration.as_bytes(), &mut { no_file });
    let camera = camera.map_err(|cause| format!("its calibration: {cause}"))?;
    let colours = ColourModel::read(run.colours.as_bytes());
    let colours = colours.map_err(|cause| format!("its colours: {cause}"))?;
    Ok(Some(Sensor::new(&camera, &colours)))
}

/// The fields of the report.
fn report<'py>(py: Python<'py>, checked: &Checked) -> PyResult<Bound<'py, PyDict>> {
    let Checked { extracted, judgement, remarks } = checked;
    let fields = PyDict::new(py);
    fields.set_item("remarks", remarks)?;
    fields.set_item("verdict", judgement.verdict().name())?;
    let evidence = match extracted.evidence {
        Evidence::Recorded => "recorded",
        Evidence::Scenes => "scenes",
        Evidence::Pictures => "pictures",
        Evidence::Laser => "laser",
    };
    fields.set_item("evidence", evidence)?;
    fields.set_item("events", events(judgement))?;
    if let Some(divergence) = &judgement.divergence {
        let found = PyDict::new(py);
        found.set_item("event", divergence.event)?;
        found.set_item("cause", divergence.cause.name())?;
        found.set_item("fault", divergence.fault.name())?;
        found.set_item("why", divergence.cause.to_string())?;
        fields.set_item("divergence", found)?;
    }
    let coverage = PyDict::new(py);
    for case in AlgorithmCase::ALL {
        coverage.set_item(case.name(), judgement.coverage.algorithm.count(case))?;
    }
    fields.set_item("coverage", coverage)?;
    fields.set_item("determines_world", judgement.determines_world())?;
    fields.set_item("candidates", judgement.candidates())?;
    fields.set_item(
        "hallways",
        (judgement.measured.moves, judgement.measured.measured, judgement.measured.compared),
    )?;
    if let Some(SmallestWorld::World { graph, marker, limit }) = &judgement.smallest {
        let start = marker.or(Some(Dart(0)));
        let world = NamedWorld::numbered("smallest", "", graph.clone(), start);
        fields.set_item("smallest", Py::new(py, CoreWorld(world))?)?;
        fields.set_item("is_least", limit.is_none())?;
    }
    Ok(fields)
}

/// The events: seconds, kind, percept, door, and the pose in the known world if only one fits.
type EventFields = (f64, &'static str, Option<Percept>, Option<u32>, Option<u32>);

fn events(judgement: &Judgement) -> Vec<EventFields> {
    let events = &judgement.events.events;
    let begun = events.first().map_or(0, |event| event.source.time);
    let alone = |index: usize| {
        let poses = judgement.poses.as_ref()?;
        let state = poses.alone.get(judgement.trace.index_of(index))?.as_ref()?;
        Some(state.pose.0)
    };
    let fields = |(index, event): (usize, &toposlam_conform::CheckedEvent)| {
        let time = event.source.time.saturating_sub(begun) as f64 / 1e9;
        let (kind, percept, door) = match &event.kind {
            CheckedKind::Arrival { arrival, .. } => {
                let sighting = arrival.sighting.unwrap_or(Sighting::Nothing);
                let percept = ModelPercept { degree: arrival.degree, sighting };
                ("percept", Some(Percept(percept)), None)
            }
            CheckedKind::Door { door, .. } => ("door", None, Some(door.0)),
            CheckedKind::Aside { .. } => ("aside", None, None),
            CheckedKind::TurnedBack => ("turned-back", None, None),
            CheckedKind::Undecided(_) => ("undecided", None, None),
        };
        (time, kind, percept, door, alone(index))
    };
    events.iter().enumerate().map(fields).collect()
}
