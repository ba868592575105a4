//! A kind of marker that is a function in Python.

use std::sync::{Mutex, PoisonError};

use pyo3::{prelude::*, types::PyAny};
use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::{Marker, MarkerPart},
    percept::Sighting,
};

/// A marker whose sightings are computed in Python, once for a graph. An exception is kept; from then on nothing
/// is sighted.
pub(crate) struct OwnMarker {
    /// From the doors of a graph to a table: for each facing dart, the number of the sighting at each pose. Its
    /// method `stop` ends a call.
    sightings: Py<PyAny>,
    last: Mutex<Option<Sighted>>,
    failed: Mutex<Option<PyErr>>,
}

struct Sighted {
    graph: EmbeddedGraph,
    table: Vec<Vec<u32>>,
}

impl OwnMarker {
    pub(crate) fn new(sightings: Py<PyAny>) -> Self {
        Self { sightings, last: Mutex::new(None), failed: Mutex::new(None) }
    }

    /// The exception of the function, if it raised one.
    pub(crate) fn failure(&self) -> Option<PyErr> {
        self.failed.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Ends a call of the function, in its thread.
    pub(crate) fn stopper(&self) -> &Py<PyAny> {
        &self.sightings
    }

    pub(crate) fn has_failed(&self) -> bool {
        self.failed.lock().unwrap_or_else(PoisonError::into_inner).is_some()
    }

    fn with<R>(&self, graph: &EmbeddedGraph, get: impl FnOnce(&[Vec<u32>]) -> R) -> R {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if last.as_ref().is_none_or(|known| known.graph != *graph) {
            let table = if self.has_failed() { None } else { self.sighted(graph) };
            let darts = graph.dart_count();
            let table = table
                .filter(|table| table.len() == darts && table.iter().all(|row| row.len() == darts))
                .unwrap_or_else(|| vec![vec![0; darts]; darts]);
            *last = Some(Sighted { graph: graph.clone(), table });
        }
        get(last.as_ref().map_or(&[], |known| &known.table))
    }

    fn sighted(&self, graph: &EmbeddedGraph) -> Option<Vec<Vec<u32>>> {
        let degrees: Vec<u32> = graph.vertices().map(|vertex| graph.degree(vertex)).collect();
        let opposite: Vec<u32> = graph.darts().map(|dart| graph.opposite(dart).0).collect();
        let table = Python::attach(|py| {
            self.sightings.call1(py, (degrees, opposite))?.extract::<Vec<Vec<u32>>>(py)
        });
        match table {
            Ok(table) => Some(table),
            Err(error) => {
                let mut failed = self.failed.lock().unwrap_or_else(PoisonError::into_inner);
                failed.get_or_insert(error);
                None
            }
        }
    }
}

impl Marker for OwnMarker {
    fn name(&self) -> &'static str {
        "own"
    }

    fn about(&self) -> &'static str {
        "a marker whose sightings a function computes"
    }

    fn sighting(&self, graph: &EmbeddedGraph, facing: Dart, pose: Dart) -> Sighting {
        self.with(graph, |table| match table[facing.at()][pose.at()] {
            0 => Sighting::Nothing,
            number => Sighting::Lying(number),
        })
    }

    /// Facing darts with the same sightings at all poses place it alike.
    fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart {
        self.with(graph, |table| {
            let alike = table.iter().position(|row| *row == table[facing.at()]);
            alike.map_or(facing, |first| Dart(first as u32))
        })
    }

    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        self.with(graph, |table| {
            let row = &table[facing.at()];
            graph.darts().filter(|pose| row[pose.at()] == row[facing.at()]).collect()
        })
    }

    fn parts(&self, _: &EmbeddedGraph, _: Dart) -> Vec<MarkerPart> {
        Vec::new()
    }
}
