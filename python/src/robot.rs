//! A simulated robot in a world, for explorers in Python.

use std::sync::Arc;

use pyo3::{IntoPyObjectExt, prelude::*};
use toposlam_model::{
    aid::{Action, AidAction, AidKind, Places, RefusedAction, State},
    check::determines_world,
    embedded_graph::{Dart, EmbeddedGraph},
    marker::NoMarker,
    percept::{Door, Percept as ModelPercept},
    world::GraphWorld,
};

use crate::{
    error::{error, guarded},
    percept::Percept,
    world::{CoreWorld, check_seen, named_aid},
};

/// A robot that senses and moves in a world, and nothing else. It counts its moves.
#[pyclass(module = "toposlam")]
pub(crate) struct Robot {
    graph: Arc<EmbeddedGraph>,
    marker: AidKind,
    /// What it senses at each pose, if a function in Python computed that. Then there is no other marker.
    percepts: Option<Vec<Py<PyAny>>>,
    facing: Dart,
    state: State<Places>,
    sensed: ModelPercept,
    /// The most moves, pick-ups and drops.
    bound: usize,
    moves: u64,
    actions: Vec<Action>,
    /// The first action that was not possible. In a check it ends the run.
    refusal: Option<PyErr>,
    ends_at_refusal: bool,
    /// Whether its run has ended. Then it does nothing more.
    is_ended: bool,
}

impl Robot {
    /// A robot at a start. `marker` is the name of a kind, or a list of what the robot senses at each pose.
    pub(crate) fn new(
        graph: Arc<EmbeddedGraph>,
        facing: Dart,
        marker: &Bound<'_, PyAny>,
        bound: usize,
    ) -> PyResult<Self> {
        let py = marker.py();
        let (marker, percepts) = match marker.extract::<Vec<Py<PyAny>>>() {
            Ok(percepts) if percepts.len() == graph.dart_count() => {
                (NoMarker.into(), Some(percepts))
            }
            _ => (named_aid(py, &marker.extract::<String>()?)?, None),
        };
        check_seen(py, marker, &graph)?;
        let world = GraphWorld::with_aid(&graph, marker, facing);
        let (state, sensed) = (world.state(), world.sensed());
        Ok(Self {
            graph,
            marker,
            percepts,
            facing,
            state,
            sensed,
            bound,
            moves: 0,
            actions: Vec::new(),
            refusal: None,
            ends_at_refusal: false,
            is_ended: false,
        })
    }

    /// A robot whose run ends with the first action that is not possible, whatever the explorer does then.
    pub(crate) fn ending_at_refusal(self) -> Self {
        Self { ends_at_refusal: true, ..self }
    }

    /// Whether the walk so far determines the world; `None` if that is not known.
    pub(crate) fn determines_world(&self) -> Option<bool> {
        if self.percepts.is_some() {
            return None;
        }
        let door = |action: &Action| match action {
            Action::Take(door) => Some(*door),
            Action::Do(_) => None,
        };
        let doors: Vec<Door> = self.actions.iter().filter_map(door).collect();
        determines_world((&self.graph, self.facing), self.marker, &doors)
    }

    /// The robot's pose in the world.
    pub(crate) fn pose(&self) -> Dart {
        self.state.pose
    }

    /// Does something, or keeps the exception. After the end of its run a robot does nothing.
    fn attempt<R>(
        &mut self,
        py: Python<'_>,
        act: impl FnOnce(&mut Self) -> PyResult<R>,
    ) -> PyResult<R> {
        if self.is_ended {
            let text = "a robot of an earlier run was kept; each run has a robot of its own";
            return Err(error(py, "EndedRunError", text));
        }
        if let Some(refusal) = self.refusal.as_ref().filter(|_| self.ends_at_refusal) {
            return Err(refusal.clone_ref(py));
        }
        let done = guarded(py, || act(self));
        if let Err(refusal) = &done {
            self.refusal.get_or_insert_with(|| refusal.clone_ref(py));
        }
        done
    }

    fn act(&mut self, py: Python<'_>, action: Action) -> PyResult<()> {
        if self.actions.len() >= self.bound {
            let refused = RefusedAction::OutOfMoves { bound: self.bound as u64 };
            return Err(error(py, class_of(&refused), refused));
        }
        let world = GraphWorld::with_aid(&self.graph, self.marker, self.state.pose);
        let mut world = world.at(self.state.clone());
        world.act(action).map_err(|refused| error(py, class_of(&refused), refused))?;
        (self.state, self.sensed) = (world.state(), world.sensed());
        self.moves += action.moves();
        self.actions.push(action);
        Ok(())
    }
}

/// The class of the exception for an action that is not possible.
fn class_of(refused: &RefusedAction) -> &'static str {
    match refused {
        RefusedAction::NoSuchDoor { .. } => "NoSuchDoorError",
        RefusedAction::NothingToPickUp | RefusedAction::NothingToDrop => "NoMarkerError",
        RefusedAction::OutOfMoves { .. } => "OutOfMovesError",
        RefusedAction::StringTooShort
        | RefusedAction::TooManyDoors { .. }
        | RefusedAction::NotOfThisAid { .. } => "NotPossibleError",
        // Of a world that is decided while a robot explores, which this one is not.
        RefusedAction::NoWorldLeft => "ExplorerError",
    }
}

#[pymethods]
impl Robot {
    #[new]
    fn from_world(
        py: Python<'_>,
        world: &CoreWorld,
        facing: u32,
        marker: &Bound<'_, PyAny>,
        max_moves: usize,
    ) -> PyResult<Self> {
        let facing = world.dart(py, facing)?;
        Self::new(Arc::new(world.0.graph.clone()), facing, marker, max_moves)
    }

    /// What the robot senses where it is.
    #[getter]
    fn percept(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        match &self.percepts {
            Some(percepts) => Ok(percepts[self.state.pose.at()].clone_ref(py)),
            None => Percept(self.sensed).into_py_any(py),
        }
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

    /// The exception of the first action that was not possible.
    #[getter]
    fn refusal(&self, py: Python<'_>) -> Option<Py<PyAny>> {
        self.refusal.as_ref().map(|refusal| refusal.clone_ref(py).into_value(py).into_any())
    }

    /// Leaves by a door, and returns what the robot senses behind it.
    fn go(&mut self, py: Python<'_>, door: &Bound<'_, PyAny>) -> PyResult<Py<PyAny>> {
        self.attempt(py, |robot| robot.take(py, door))?;
        self.percept(py)
    }

    /// Picks the marker up here, to carry it.
    fn pick_up(&mut self, py: Python<'_>) -> PyResult<()> {
        self.attempt(py, |robot| robot.act(py, Action::Do(AidAction::PickUp)))
    }

    /// Drops the marker here.
    fn drop(&mut self, py: Python<'_>) -> PyResult<()> {
        self.attempt(py, |robot| robot.act(py, Action::Do(AidAction::Drop)))
    }

    /// Does an action with the marking aid, as "pick-up-2" or "send-2:1", and returns what the robot senses then.
    #[pyo3(name = "act")]
    fn act_aid(&mut self, py: Python<'_>, action: &str) -> PyResult<Py<PyAny>> {
        let action: AidAction =
            action.parse().map_err(|unknown| error(py, "UnknownActionError", unknown))?;
        self.attempt(py, |robot| robot.act(py, Action::Do(action)))?;
        self.percept(py)
    }

    /// Ends its run.
    fn end_run(&mut self) {
        self.is_ended = true;
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (moves, sensed) = (self.moves, self.percept(py)?);
        let plural = if moves == 1 { "" } else { "s" };
        Ok(format!("<Robot after {moves} move{plural}: {sensed}>"))
    }
}

impl Robot {
    /// Leaves by a door, which may be any value.
    fn take(&mut self, py: Python<'_>, door: &Bound<'_, PyAny>) -> PyResult<()> {
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
        let Some(door) = u32::try_from(number).ok().filter(|&door| door < degree) else {
            let text = format!("door {number} was taken at a vertex with {degree} doors");
            return Err(error(py, "NoSuchDoorError", text));
        };
        self.act(py, Action::Take(Door(door)))
    }
}
