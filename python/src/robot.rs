//! A simulated robot in a world, for explorers in Python.

use std::sync::Arc;

use pyo3::prelude::*;
use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::Marker,
    percept::{Door, Percept as ModelPercept},
    world::{Action, GraphWorld, Refused, State},
};

use crate::{
    error::error,
    percept::Percept,
    world::{CoreWorld, named_marker},
};

/// A robot that senses and moves in a world, and nothing else. It counts its moves.
#[pyclass(module = "toposlam")]
pub(crate) struct Robot {
    graph: Arc<EmbeddedGraph>,
    marker: &'static dyn Marker,
    state: State,
    sensed: ModelPercept,
    bound: u64,
    moves: u64,
    actions: Vec<Action>,
}

impl Robot {
    pub(crate) fn new(
        graph: Arc<EmbeddedGraph>,
        marker: &'static dyn Marker,
        facing: Dart,
        bound: u64,
    ) -> Self {
        let world = GraphWorld::with_marker(&graph, marker, facing);
        let (state, sensed) = (world.state(), world.sensed());
        Self { graph, marker, state, sensed, bound, moves: 0, actions: Vec::new() }
    }

    /// The robot's pose in the world.
    pub(crate) fn pose(&self) -> Dart {
        self.state.pose
    }

    fn act(&mut self, py: Python<'_>, action: Action) -> PyResult<()> {
        // `with_marker` places the marker; the state is the robot's own.
        let mut world =
            GraphWorld::with_marker(&self.graph, self.marker, self.state.pose).at(self.state);
        world.act(action).map_err(|refused| error(py, class_of(&refused), refused))?;
        (self.state, self.sensed) = (world.state(), world.sensed());
        self.moves += u64::from(matches!(action, Action::Take(_)));
        self.actions.push(action);
        Ok(())
    }
}

/// The class of the exception for an action that is not possible.
fn class_of(refused: &Refused) -> &'static str {
    match refused {
        Refused::NoSuchDoor { .. } => "NoSuchDoorError",
        Refused::NothingToPickUp | Refused::NothingToDrop => "NoMarkerError",
        Refused::OutOfMoves { .. } => "OutOfMovesError",
        // Of a world that is decided while a robot explores, which this one is not.
        Refused::NoWorldLeft => "ExplorerError",
    }
}

#[pymethods]
impl Robot {
    #[new]
    fn from_world(
        py: Python<'_>,
        world: &CoreWorld,
        facing: u32,
        marker: &str,
        max_moves: u64,
    ) -> PyResult<Self> {
        let facing = world.dart(py, facing)?;
        let marker = named_marker(py, marker)?;
        Ok(Self::new(Arc::new(world.0.graph.clone()), marker, facing, max_moves))
    }

    /// What the robot senses where it is.
    #[getter]
    fn percept(&self) -> Percept {
        Percept(self.sensed)
    }

    /// The number of moves made.
    #[getter]
    fn moves(&self) -> u64 {
        self.moves
    }

    /// What the robot has done: doors, "pick-up" and "drop".
    #[getter]
    fn actions(&self, py: Python<'_>) -> PyResult<Vec<Py<PyAny>>> {
        crate::comparison::actions(py, &self.actions)
    }

    /// Leaves by a door, and returns what the robot senses behind it.
    fn go(&mut self, py: Python<'_>, door: &Bound<'_, PyAny>) -> PyResult<Percept> {
        let degree = self.sensed.degree;
        let number: i128 = door.extract().map_err(|_| {
            let kind = door.get_type();
            let text = door.repr().map_or_else(|_| kind.to_string(), |text| text.to_string());
            error(
                py,
                "DoorTypeError",
                format!("a door is a number from 0 to {}, not {text}", degree - 1),
            )
        })?;
        if self.moves >= self.bound {
            let refused = Refused::OutOfMoves { bound: self.bound };
            return Err(error(py, class_of(&refused), refused));
        }
        let Some(door) = u32::try_from(number).ok().filter(|&door| door < degree) else {
            let text = format!("door {number} was taken at a vertex with {degree} doors");
            return Err(error(py, "NoSuchDoorError", text));
        };
        self.act(py, Action::Take(Door(door)))?;
        Ok(Percept(self.sensed))
    }

    /// Picks the marker up here, to carry it.
    fn pick_up(&mut self, py: Python<'_>) -> PyResult<()> {
        self.act(py, Action::PickUp)
    }

    /// Drops the marker here.
    fn drop(&mut self, py: Python<'_>) -> PyResult<()> {
        self.act(py, Action::Drop)
    }

    fn __repr__(&self) -> String {
        let (moves, sensed) = (self.moves, self.sensed);
        format!("<Robot after {moves} move{}: {sensed}>", if moves == 1 { "" } else { "s" })
    }
}
