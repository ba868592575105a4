//! The algorithms of the specification, run on a world.

use pyo3::prelude::*;
use thiserror::Error;
use toposlam_draw::story::{Story, StoryDetail, head};
use toposlam_model::{check::{Algorithm, Algorithm1, Folding, MovableMarker, RunState, judge}, embedded_graph::Dart, enumerate::Watch, folding, format::named_world::NamedWorld, isomorphism::Candidate, mapping::{FACING, Journey, MappingError, MappingEvent, Nearest, Observer, map_by_folding, map_with_movable_marker, map_world}, marker::Marker, percept::{Door, Percept}, world::{Action, GraphWorld, MovableMarkerWorld, RefusedAction, World}};

use crate::{error::{error, interrupted}, long_work::{Watcher, run_watched}, world::CoreWorld};

/// A run that mapped its world.
#[derive(IntoPyObject)]
pub(crate) struct Explored {
    moves: u64,
    actions: Vec<Py<PyAny>>,
    map: CoreWorld,
    /// The robot's pose in the map.
    pose: u32,
    story: String,
}

/// A world whose robot can be stopped.
struct StoppableWorld<'g, 'w, M> {
    world: GraphWorld<'g, M>,
    watcher: &'w Watcher,
}

/// Why a robot does not move.
#[derive(Clone, Debug, Error)]
enum Halt {
    #[error("interrupted")]
    Stopped,
    #[error(transparent)]
    RefusedAction(#[from] RefusedAction),
}

impl<M: Marker> World for StoppableWorld<'_, '_, M> {
    type Error = Halt;

    fn percept(&mut self) -> Result<Percept, Halt> {
        Ok(self.world.percept()?)
    }

    fn traverse(&mut self, door: Door) -> Result<(), Halt> {
        if self.watcher.stop() {
            return Err(Halt::Stopped);
        }
        Ok(self.world.traverse(door)?)
    }
}

impl<M: Marker> MovableMarkerWorld for StoppableWorld<'_, '_, M> {
    fn pick_up(&mut self) -> Result<(), Halt> {
        Ok(self.world.pick_up()?)
    }

    fn drop(&mut self) -> Result<(), Halt> {
        Ok(MovableMarkerWorld::drop(&mut self.world)?)
    }
}

/// The story and the actions of a run.
struct Recorder {
    story: Story<Vec<u8>>,
    actions: Vec<Action>,
}

impl<W> Observer<W> for Recorder {
    fn event(&mut self, world: &mut W, journey: &Journey, event: MappingEvent) {
        self.actions.extend(event.action());
        self.story.event(world, journey, event);
    }
}

/// Maps a world with an algorithm: "algorithm1", "folding" or "movable".
#[pyfunction]
pub(crate) fn explore(
    py: Python<'_>,
    world: &CoreWorld,
    facing: u32,
    algorithm: &str,
    max_darts: usize,
) -> PyResult<Explored> {
    let start = (&world.0, world.dart(py, facing)?);
    match algorithm {
        "algorithm1" => run(py, &Algorithm1, start, max_darts, |world, state, observer| {
            map_world(world, &mut Nearest, state, observer)
        }),
        "folding" => run(py, &Folding, start, max_darts, |world, state, observer| {
            map_by_folding(world, state, observer)
        }),
        "movable" if !world.0.graph.is_simple() => {
            let text =
                "the movable marker algorithm needs a world without loops and parallel edges";
            Err(error(py, "NotSimpleError", text))
        }
        "movable" => run(py, &MovableMarker, start, max_darts, |world, state, observer| {
            map_with_movable_marker(world, &mut Nearest, state, observer)
        }),
        _ => {
            let text = format!(
                "`{algorithm}` is not an algorithm; the algorithms are algorithm1, folding and movable"
            );
            Err(error(py, "UnknownAlgorithmError", text))
        }
    }
}

fn run<A: Algorithm>(
    py: Python<'_>,
    algorithm: &A,
    (world, facing): (&NamedWorld, Dart),
    max_darts: usize,
    map: impl Fn(
        &mut StoppableWorld<A::Marker>,
        &mut A::State,
        &mut Recorder,
    ) -> Result<(), MappingError<Halt>>
    + Sync,
) -> PyResult<Explored> {
    let (mapped, journey, recorder) = run_watched(py, None, None, |watcher| {
        let mut state = A::State::new(max_darts);
        let marked = GraphWorld::with_marker(&world.graph, A::Marker::default(), facing);
        let mut robot = StoppableWorld { world: marked, watcher };
        let detail = StoryDetail { every_hypothesis: false, doors: false };
        let story = Story::with_head(Vec::new(), &head(world, facing), detail);
        let mut recorder = Recorder { story, actions: Vec::new() };
        let mapped = map(&mut robot, &mut state, &mut recorder).map(|()| {
            let mut candidate = Candidate::default();
            judge(algorithm, &state, facing, &robot.world, &mut candidate).map(|_| ())
        });
        (mapped, state.journey().clone(), recorder)
    })?;
    match mapped {
        Ok(Ok(())) => {}
        Ok(Err(flaw)) => return Err(error(py, "InternalError", flaw)),
        Err(MappingError::World(Halt::Stopped)) => return Err(interrupted()),
        Err(bound @ MappingError::Bound { .. }) => {
            return Err(error(py, "MapTooLargeError", bound));
        }
        Err(other) => return Err(error(py, "InternalError", other)),
    }
    let graph = journey.map().complete().cloned();
    let graph = graph.ok_or_else(|| error(py, "InternalError", "the map is not complete"))?;
    let about = format!("The map of {}, made in {} moves", world.name, journey.moves());
    let map = NamedWorld::numbered(&format!("{}-map", world.name), &about, graph, Some(FACING));
    let story = recorder.story.finish().unwrap_or_default();
    Ok(Explored {
        moves: journey.moves(),
        actions: crate::comparison::actions(py, &recorder.actions)?,
        map: CoreWorld(map),
        pose: journey.robot().0,
        story: String::from_utf8_lossy(&story).into_owned(),
    })
}

/// A shortest walk that proves a map of the world.
#[pyfunction]
pub(crate) fn certificate(py: Python<'_>, world: &CoreWorld, facing: u32) -> PyResult<Vec<u32>> {
    let facing = world.dart(py, facing)?;
    let walk = run_watched(py, None, None, |_| folding::certificate(&world.0.graph, facing))?;
    Ok(walk.into_iter().map(|door| door.0).collect())
}
