//! The run of an explorer that failed, and the other world of a guess.

use pyo3::{prelude::*, types::PyDict};
use toposlam_draw::{
    explorer_run::{Beside, ExplorerRun},
    page::explorer_page,
};
use toposlam_model::{
    aid::Action, check::other_world as find_other_world, embedded_graph::Dart,
    folding::SmallestWorld, format::named_world::NamedWorld, percept::Door,
};

use crate::{
    error::{error, guarded},
    long_work::run_watched,
    world::{CoreWorld, named_aid},
};

/// The smallest other world in which a robot that takes these doors from a start senses the same, and whether it is
/// known to be the smallest. None if there is none, or with a marker for which that is not known.
#[pyfunction]
pub(crate) fn other_world(
    py: Python<'_>,
    world: &CoreWorld,
    facing: u32,
    marker: &str,
    doors: Vec<u32>,
) -> PyResult<Option<(CoreWorld, bool)>> {
    let facing = world.dart(py, facing)?;
    let marker = named_aid(py, marker)?;
    let doors: Vec<Door> = doors.into_iter().map(Door).collect();
    let graph = world.0.graph.clone();
    let found = run_watched(py, None, None, move |watcher| {
        find_other_world((&graph, facing), marker, &doors, watcher)
    })?;
    Ok(match found {
        Some(SmallestWorld::World { graph, limit, .. }) => {
            let about = "A robot that takes the same doors in it senses the same";
            let world = NamedWorld::discovered("other", about, &graph, Dart(0));
            Some((CoreWorld(world), limit.is_none()))
        }
        _ => None,
    })
}

/// A run from the start of a world as a text, a picture and a page. `beside` is the map that the explorer returned
/// ("map"), or another world with the same run ("smallest" or "other"). `percepts` are texts in place of those of
/// the marker.
#[pyfunction]
pub(crate) fn explorer_run<'py>(
    py: Python<'py>,
    world: &CoreWorld,
    marker: &str,
    actions: Vec<String>,
    percepts: Option<Vec<String>>,
    beside: Option<(PyRef<'py, CoreWorld>, String)>,
    ending: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let marker = named_aid(py, marker)?;
    let parsed = actions.iter().map(|action| action.parse::<Action>());
    let actions = parsed.collect::<Result<Vec<_>, _>>();
    let actions = actions.map_err(|unknown| error(py, "InternalError", unknown))?;
    let kind = |kind: &str| match kind {
        "map" => Beside::ReturnedMap,
        kind => Beside::OtherWorld { is_smallest: kind == "smallest" },
    };
    let beside = beside.as_ref().map(|(world, name)| (kind(name), &world.0));
    let run = ExplorerRun {
        world: &world.0,
        marker,
        actions: &actions,
        percepts: percepts.as_deref(),
        beside,
    };
    guarded(py, || {
        let mut story = Vec::new();
        run.print(&mut story).map_err(|fault| error(py, "InternalError", fault))?;
        let found = PyDict::new(py);
        found.set_item("story", String::from_utf8_lossy(&story))?;
        found.set_item("picture", run.picture())?;
        found.set_item("page", explorer_page(ending, &run))?;
        Ok(found)
    })
}
