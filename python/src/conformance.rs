//! A log, checked against the specification.

use pyo3::{prelude::*, types::PyDict};
use toposlam_conform::{
    CheckError, CheckedKind, DoorChooser, Evidence, ExtractError, LogCheck, LogReport, LogSource,
    MarkerPlaceError, Quirks, RESUMED_REMARK, ReportedEvent, RobotStart, words,
};
use toposlam_logs::topic_map::TopicMap;
use toposlam_model::{
    aid, folding::WorldSearch, mapping::MappingAlgorithm, percept::Percept as ModelPercept,
    percept::Sighting, trace::AlgorithmCase,
};
use toposlam_vision::{
    camera::calibration, colour::ColourModel, laser::params::LaserParams, sensing::Sensor,
};

use crate::{
    error::{error, interrupted},
    log::LogReader,
    long_work::{Watcher, run_watched},
    percept::Percept,
    world::CoreWorld,
};

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
    let known = |name| aid::named(name).map_err(|unknown| error(py, "UnknownMarkerError", unknown));
    let aid = marker.map(known).transpose()?;
    let doors = match driver {
        "anyone" => DoorChooser::Anyone,
        "algorithm" => DoorChooser::Algorithm(None),
        name => {
            let algorithm = name.parse::<MappingAlgorithm>();
            let unknown = |cause| error(py, "UnknownAlgorithmError", cause);
            DoorChooser::Algorithm(Some(algorithm.map_err(unknown)?))
        }
    };
    let class = class_.parse().map_err(|unknown| error(py, "UnknownClassError", unknown))?;
    let mut laser = LaserParams::default();
    laser.corner.corners = corners;
    let quirks = Quirks::default();
    let mut check = LogCheck {
        evidence: Evidence::Recorded,
        laser,
        world: world.map(|world| &world.0),
        start: RobotStart::Recorded,
        aid,
        assumes_marker: assumed,
        doors,
        search: WorldSearch { class, max_edges, steps: max_steps },
        max_darts,
        quirks: &quirks,
    };
    let report = run_watched(py, progress, None, |watcher| {
        let report = checked(log, &mut check, watcher);
        (report, toposlam_model::enumerate::Watch::stop(watcher))
    })?;
    let log_error = |cause: String| log.error(py, &cause);
    match report {
        (_, true) => Err(interrupted()),
        (Ok((report, is_resumed)), false) => fields(py, &report, is_resumed),
        (Err(cause), false) => Err(match cause {
            NotChecked::Sensor(cause) => log_error(cause),
            NotChecked::Check(CheckError::Aid(cause)) => error(py, "UnknownMarkerError", cause),
            NotChecked::Check(CheckError::Algorithm(head)) => {
                let cause = format!(
                    "the algorithm `{head}` of the log is unknown; use driver=\"algorithm1\""
                );
                error(py, "UnknownAlgorithmError", cause)
            }
            NotChecked::Check(cause @ CheckError::MarkerNotShown(_)) => log_error(format!(
                "{cause}; for a run without a marker add driver=\"anyone\", marker=\"none\""
            )),
            NotChecked::Check(CheckError::MarkerPlace(MarkerPlaceError::AssumedWithoutLaser)) => {
                log_error("no junction is visited".to_owned())
            }
            NotChecked::Check(cause) => log_error(cause.to_string()),
        }),
    }
}

/// Why a log is not checked.
enum NotChecked {
    Sensor(String),
    Check(CheckError),
}

/// The report on a log, and whether its robot went on from an earlier run.
fn checked(
    log: &LogReader,
    check: &mut LogCheck,
    watcher: &Watcher,
) -> Result<(LogReport, bool), NotChecked> {
    check.evidence = Evidence::from_topics(&log.mapping).ok_or_else(|| {
        let ambiguous = TopicMap::from_log(&log.log).err();
        let cause = ambiguous.map_or(ExtractError::NothingMapped, ExtractError::TopicMap);
        NotChecked::Check(cause.into())
    })?;
    let sensor = sensor(log).map_err(NotChecked::Sensor)?;
    let source = LogSource {
        log: &log.log,
        topics: &log.mapping,
        head: log.run.as_ref(),
        sensor: sensor.as_ref(),
    };
    let checked = check.run(&source, watcher, || ()).map_err(NotChecked::Check)?;
    Ok((checked.report(&source, String::new()), checked.is_resumed))
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
fn fields<'py>(
    py: Python<'py>,
    report: &LogReport,
    is_resumed: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let LogReport { facts, .. } = report;
    let fields = PyDict::new(py);
    let resumed = is_resumed.then(|| RESUMED_REMARK.to_owned());
    let remarks = words::remarks(report).into_iter().chain(resumed);
    fields.set_item("remarks", remarks.collect::<Vec<_>>())?;
    fields.set_item("verdict", report.verdict.name())?;
    fields.set_item("evidence", facts.evidence.name())?;
    let begun = report.events.first().map_or(0, |event| event.source.time);
    let events = report.events.iter().map(|event| event_fields(event, begun));
    fields.set_item("events", events.collect::<Vec<_>>())?;
    if let Some(divergence) = &report.divergence {
        let found = PyDict::new(py);
        found.set_item("event", divergence.event)?;
        found.set_item("cause", divergence.cause.name())?;
        found.set_item("fault", divergence.fault.name())?;
        found.set_item("why", divergence.cause.to_string())?;
        fields.set_item("divergence", found)?;
    }
    let coverage = PyDict::new(py);
    for case in AlgorithmCase::ALL {
        let covered = report.coverage.iter().find(|covered| covered.case == case.name());
        coverage.set_item(case.name(), covered.map_or(0, |covered| covered.count))?;
    }
    fields.set_item("coverage", coverage)?;
    fields.set_item("determines_world", facts.unique)?;
    fields.set_item("candidates", report.candidates)?;
    let lengths = facts.lengths;
    fields.set_item("hallways", (lengths.moves, lengths.measured, lengths.compared))?;
    if let Some(smallest) = &facts.smallest {
        let mut world = smallest.world.clone();
        world.marker = None;
        fields.set_item("smallest", Py::new(py, CoreWorld(world))?)?;
        fields.set_item("is_least", smallest.least)?;
    }
    Ok(fields)
}

/// An event: seconds since the first one, kind, percept, door, and the pose in the known world if only one fits.
type EventFields = (f64, &'static str, Option<Percept>, Option<u32>, Option<u32>);

fn event_fields(event: &ReportedEvent, begun: u64) -> EventFields {
    let time = event.source.time.saturating_sub(begun) as f64 / 1e9;
    let (percept, door) = match &event.kind {
        CheckedKind::Arrival { arrival, .. } => {
            let sighting = arrival.sighting.unwrap_or(Sighting::Nothing);
            (Some(Percept(ModelPercept { degree: arrival.degree, sighting })), None)
        }
        CheckedKind::Door { door, .. } => (None, Some(door.0)),
        _ => (None, None),
    };
    (time, event.kind.name(), percept, door, event.pose.map(|pose| pose.0))
}
