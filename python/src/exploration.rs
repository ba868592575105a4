//! The algorithms of the specification, run on a world.

use pyo3::prelude::*;
use thiserror::Error;
use toposlam_draw::story::{PrintedStory, Story};
use toposlam_model::{
    aid::{Action, AidAction, AidKind, RefusedAction},
    enumerate::Watch,
    folding,
    format::named_world::NamedWorld,
    isomorphism::Candidate,
    mapping::{FACING, MapWalk, MappingAlgorithm, MappingError, MappingEvent, Observer},
    percept::{Door, Percept},
    world::{AidHandler, GraphWorld, World},
};

use crate::{
    error::{error, interrupted},
    long_work::{Watcher, run_watched},
    world::{CoreWorld, check_seen},
};

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
struct StoppableWorld<'g, 'w> {
    world: GraphWorld<'g, AidKind>,
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

impl World for StoppableWorld<'_, '_> {
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

    fn handler(&mut self) -> Option<&mut dyn AidHandler<Error = Halt>> {
        Some(self)
    }
}

impl AidHandler for StoppableWorld<'_, '_> {
    type Error = Halt;

    fn handle(&mut self, action: AidAction) -> Result<(), Halt> {
        Ok(self.world.handle(action)?)
    }
}

/// The story and the actions of a run.
struct Recorder {
    story: PrintedStory<Vec<u8>>,
    actions: Vec<Action>,
}

impl<W> Observer<W> for Recorder {
    fn event(&mut self, world: &mut W, journey: &MapWalk, event: MappingEvent) {
        self.actions.extend(event.action());
        self.story.event(world, journey, event);
    }
}

/// Maps a world with an algorithm: "algorithm1", "folding", or the name of a marking aid that moves.
#[pyfunction]
pub(crate) fn explore(
    py: Python<'_>,
    world: &CoreWorld,
    facing: u32,
    algorithm: &str,
    max_darts: usize,
) -> PyResult<Explored> {
    let (world, facing) = (&world.0, world.dart(py, facing)?);
    let Some(algorithm) = MappingAlgorithm::all().find(|known| known.name() == algorithm) else {
        let names: Vec<_> = MappingAlgorithm::all().map(MappingAlgorithm::name).collect();
        let names = names.join(", ");
        let text = format!("`{algorithm}` is not an algorithm; the algorithms are {names}");
        return Err(error(py, "UnknownAlgorithmError", text));
    };
    check_seen(py, algorithm.aid(), &world.graph)?;
    if algorithm.needs_simple() && !world.graph.is_simple() {
        let text =
            format!("the algorithm {algorithm} needs a world without loops and parallel edges");
        return Err(error(py, "NotSimpleError", text));
    }
    let (mapped, journey, recorder) = run_watched(py, None, None, |watcher| {
        let marked = GraphWorld::with_aid(&world.graph, algorithm.aid(), facing);
        let mut robot = StoppableWorld { world: marked, watcher };
        let story = PrintedStory::new(Story::new(world, facing), Some(Vec::new()));
        let mut recorder = Recorder { story, actions: Vec::new() };
        let (journey, mapped) = algorithm.map_world(&mut robot, max_darts, &mut recorder);
        let judged = mapped.map(|()| {
            let (run, truly) = ((&journey, journey.robot()), robot.world.pose());
            let mut candidate = Candidate::default();
            algorithm.judge(run, (&world.graph, facing), truly, &mut candidate).map(|_| ())
        });
        (judged, journey, recorder)
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
    let story = recorder.story.finish().ok().flatten().unwrap_or_default();
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
