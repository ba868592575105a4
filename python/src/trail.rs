//! What a walk proves about its world, for Python.

use pyo3::prelude::*;
use toposlam_model::{
    folding::{FoldedTrail, TrailError},
    format::named_world::NamedWorld,
    percept::Door,
};

use crate::{
    error::{error, guarded},
    percept::Percept,
    world::CoreWorld,
};

/// What a walk proves about its world.
#[pyclass(module = "toposlam._core")]
pub(crate) struct Trail {
    folded: FoldedTrail,
    /// Why no world explains the walk. Then the trail is of no more use.
    contradiction: Option<TrailError>,
}

fn contradicts(py: Python<'_>, cause: TrailError) -> PyErr {
    error(py, "ContradictionError", cause)
}

#[pymethods]
impl Trail {
    #[new]
    fn new(py: Python<'_>, percept: &Percept) -> PyResult<Self> {
        let folded = FoldedTrail::new(percept.0).map_err(|cause| contradicts(py, cause))?;
        Ok(Self { folded, contradiction: None })
    }

    /// A move: the door taken, and the percept behind it.
    fn step(&mut self, py: Python<'_>, door: u32, percept: &Percept) -> PyResult<()> {
        if self.contradiction.is_none() {
            self.contradiction = guarded(py, || Ok(self.folded.step(Door(door), percept.0).err()))?;
        }
        self.contradiction.map_or(Ok(()), |cause| Err(contradicts(py, cause)))
    }

    #[getter]
    fn moves(&self) -> usize {
        self.folded.moves()
    }

    #[getter]
    fn vertex_count(&self) -> usize {
        self.folded.vertex_count()
    }

    /// The number of ends of edges that were never traversed.
    #[getter]
    fn open_count(&self) -> usize {
        self.folded.open_count()
    }

    /// The trail as it is seen from the robot: two walks with one form have the same future.
    #[getter]
    fn form(&self) -> Vec<u32> {
        self.folded.seen_from_robot()
    }

    /// The trail as a world, with a dead end behind each dart that is open, and the robot's pose in it. The start is
    /// where the marker points. `None` if no world explains the walk.
    fn closed(&self) -> Option<(CoreWorld, u32)> {
        let closed = self.folded.closed().filter(|_| self.contradiction.is_none())?;
        let world = NamedWorld::numbered("trail", "", closed.graph, closed.marker);
        Some((CoreWorld(world), closed.pose.0))
    }
}
