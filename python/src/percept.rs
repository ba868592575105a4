//! What a robot senses, for Python.

use pyo3::{IntoPyObjectExt, prelude::*};
use toposlam_model::percept::{Percept as ModelPercept, Sighting};

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
    /// undirected markers here, or a word.
    #[getter]
    fn marker(&self, py: Python<'_>) -> PyResult<Option<Py<PyAny>>> {
        let word = match self.0.sighting {
            Sighting::Nothing => return Ok(None),
            Sighting::Pointing(door) => return door.0.into_py_any(py).map(Some),
            Sighting::Lying(count) => return count.into_py_any(py).map(Some),
            Sighting::First => "first",
            Sighting::Second => "second",
            Sighting::Both => "both",
            Sighting::Passed => "passed",
            Sighting::PassedAlong => "along",
            Sighting::PassedAgainst => "against",
        };
        word.into_py_any(py).map(Some)
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
