//! The algorithms of the specification, run on a world.

use pyo3::prelude::*;
use toposlam::story::{Story, StoryDetail, head};
use toposlam_model::{
    check::{Algorithm, Algorithm1, Flaw, Folding, MovableMarker, RunState, judge},
    embedded_graph::Dart,
    folding,
    format::named_world::NamedWorld,
    isomorphism::Candidate,
    mapping::{FACING, Journey, MappingError, MappingEvent},
    world::{Action, GraphWorld},
};

use crate::{error::error, watched::watched, world::CoreWorld};

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

/// Maps a world with an algorithm: "algorithm1", "folding" or "movable".
#[pyfunction]
pub(crate) fn explore(
    py: Python<'_>,
    world: &CoreWorld,
    facing: u32,
    algorithm: &str,
    max_darts: usize,
) -> PyResult<Explored> {
    let facing = world.dart(py, facing)?;
    match algorithm {
        "algorithm1" => run(py, &Algorithm1, &world.0, facing, max_darts),
        "folding" => run(py, &Folding, &world.0, facing, max_darts),
        "movable" if !world.0.graph.is_simple() => {
            let text =
                "the movable marker algorithm needs a world without loops and parallel edges";
            Err(error(py, "NotSimpleError", text))
        }
        "movable" => run(py, &MovableMarker, &world.0, facing, max_darts),
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
    world: &NamedWorld,
    facing: Dart,
    max_darts: usize,
) -> PyResult<Explored> {
    let ended = watched(py, None, |_| {
        let mut state = A::State::new(max_darts);
        let mut robot = GraphWorld::with_marker(&world.graph, A::Marker::default(), facing);
        let detail = StoryDetail { every_hypothesis: false, doors: false };
        let mut story = Story::with_head(Vec::new(), &head(world, facing), detail);
        let mut actions: Vec<Action> = Vec::new();
        let mut observer = |world: &mut GraphWorld<_>, journey: &Journey, event: MappingEvent| {
            actions.extend(event.action());
            toposlam_model::mapping::Observer::event(&mut story, world, journey, event);
        };
        let run = algorithm.run(&mut robot, &mut state, &mut observer);
        let mut candidate = Candidate::default();
        let judged = run
            .map_err(Flaw::from)
            .and_then(|()| judge(algorithm, &state, facing, &robot, &mut candidate).map(|_| ()));
        let journey = state.journey().clone();
        let text = story.finish().map(|text| String::from_utf8_lossy(&text).into_owned());
        (judged, journey, actions, text.unwrap_or_default())
    })?;
    let (judged, journey, actions, story) = ended;
    judged.map_err(|flaw| match flaw {
        Flaw::Error(MappingError::Bound { .. }) => error(py, "MapTooLargeError", flaw),
        flaw => error(py, "InternalError", flaw),
    })?;
    let graph = journey.map().complete().cloned();
    let graph = graph.ok_or_else(|| error(py, "InternalError", "the map is not complete"))?;
    let about = format!("The map of {}, made in {} moves", world.name, journey.moves());
    let map = NamedWorld::numbered(&format!("{}-map", world.name), &about, graph, Some(FACING));
    Ok(Explored {
        moves: journey.moves(),
        actions: crate::comparison::actions(py, &actions)?,
        map: CoreWorld(map),
        pose: journey.robot().0,
        story,
    })
}

/// A shortest walk that proves a map of the world.
#[pyfunction]
pub(crate) fn certificate(py: Python<'_>, world: &CoreWorld, facing: u32) -> PyResult<Vec<u32>> {
    let facing = world.dart(py, facing)?;
    let walk = watched(py, None, |_| folding::certificate(&world.0.graph, facing))?;
    Ok(walk.into_iter().map(|door| door.0).collect())
}
