//! What a robot senses, for Python.

use pyo3::{IntoPyObjectExt, prelude::*, types::PyDict};
use toposlam_model::percept::{
    Ball, OtherRobot, Percept as ModelPercept, Sighting, StringView, TeamView, TwoMarkersView,
};

/// What a robot senses on arriving at a vertex: its degree, and what the marker adds.
#[pyclass(frozen, eq, hash, ord, module = "toposlam")]
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Percept(pub(crate) ModelPercept);

#[pymethods]
impl Percept {
    /// The number of doors.
    #[getter]
    fn degree(&self) -> u32 {
        self.0.degree
    }

    /// What the marker adds: None, or the door along which a directional marker points, or the number of
    /// undirected markers here, or a word; of a string a dict with "doors", "fixed_end", "free_end" and "hand";
    /// of a team a dict with "robots"; of two markers a dict with
    /// "along" and "movable"; through binoculars a dict with "ball".
    #[getter]
    fn marker(&self, py: Python<'_>) -> PyResult<Option<Py<PyAny>>> {
        let words = match self.0.sighting {
            Sighting::Nothing => return Ok(None),
            Sighting::Pointing(door) => return door.0.into_py_any(py).map(Some),
            Sighting::Lying(count) => return count.into_py_any(py).map(Some),
            Sighting::These(markers) => markers.names().join("+"),
            Sighting::Passed => "passed".to_owned(),
            Sighting::PassedAlong => "along".to_owned(),
            Sighting::PassedAgainst => "against".to_owned(),
            Sighting::String(view) => return string(py, view).map(Some),
            Sighting::Team(view) => return team(py, view).map(Some),
            Sighting::TwoMarkers(view) => return two_markers(py, view).map(Some),
            Sighting::Ball(view) => return ball(py, view).map(Some),
            Sighting::Compass(view) => view.to_string(),
        };
        words.into_py_any(py).map(Some)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let marker = self.marker(py)?.map_or_else(
            || Ok("None".to_owned()),
            |marker| marker.bind(py).repr().map(|text| text.to_string()),
        )?;
        Ok(format!("Percept(degree={}, marker={marker})", self.0.degree))
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }
}

fn string(py: Python<'_>, view: StringView) -> PyResult<Py<PyAny>> {
    let StringView { doors, fixed_end, free_end, hand } = view;
    let seen = PyDict::new(py);
    seen.set_item("doors", doors.doors().map(|door| door.0).collect::<Vec<_>>())?;
    seen.set_item("fixed_end", fixed_end)?;
    seen.set_item("free_end", free_end)?;
    seen.set_item("hand", hand.map(|door| door.0))?;
    seen.into_py_any(py)
}

fn two_markers(py: Python<'_>, view: TwoMarkersView) -> PyResult<Py<PyAny>> {
    let seen = PyDict::new(py);
    seen.set_item("along", view.along.map(|door| door.0))?;
    seen.set_item("movable", view.movable)?;
    seen.into_py_any(py)
}

fn ball(py: Python<'_>, view: Ball) -> PyResult<Py<PyAny>> {
    let seen = PyDict::new(py);
    seen.set_item("ball", view.behind())?;
    seen.into_py_any(py)
}

fn team(py: Python<'_>, TeamView(others): TeamView) -> PyResult<Py<PyAny>> {
    let mut robots = Vec::new();
    for other in others {
        let seen = PyDict::new(py);
        let (place, along) = match other {
            OtherRobot::Absent => continue,
            OtherRobot::Elsewhere { degree } => {
                seen.set_item("degree", degree)?;
                ("elsewhere", None)
            }
            OtherRobot::Here => ("here", None),
            OtherRobot::HereAlong(door) => ("here", Some(door)),
            OtherRobot::WithSecond => ("with-second", None),
            OtherRobot::WithSecondAlong(door) => ("with-second", Some(door)),
        };
        seen.set_item("place", place)?;
        if place != "elsewhere" {
            seen.set_item("along", along.map(|door| door.0))?;
        }
        robots.push(seen);
    }
    let seen = PyDict::new(py);
    seen.set_item("robots", robots)?;
    seen.into_py_any(py)
}
