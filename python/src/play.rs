//! Pages on which a person is the robot.

use pyo3::prelude::*;
use toposlam_draw::page::{MOST_VERTICES, NoGame, games_of, play_page, random_games};

use crate::{
    error::{error, guarded, interrupted},
    long_work::run_watched,
    starts::named_class,
    world::{CoreWorld, named_marker},
};

/// The page of a world, from a start and from others.
#[pyfunction]
pub(crate) fn world_page(
    py: Python<'_>,
    world: &CoreWorld,
    facing: u32,
    marker: &str,
) -> PyResult<String> {
    let (marker, facing) = (named_marker(py, marker)?, world.dart(py, facing)?);
    let count = world.0.graph.vertex_count();
    if count > MOST_VERTICES {
        let text = format!("the world has {count} vertices; a page can have {MOST_VERTICES}");
        return Err(error(py, "SizeError", text));
    }
    guarded(py, || Ok(py.detach(|| play_page(&games_of(&world.0, facing), marker))))
}

/// The page of random worlds.
#[pyfunction]
pub(crate) fn random_page(
    py: Python<'_>,
    class_: &str,
    edges: usize,
    seed: u64,
    marker: &str,
) -> PyResult<String> {
    let (marker, class) = (named_marker(py, marker)?, named_class(py, class_)?);
    let page = run_watched(py, None, None, |watcher| {
        Ok(play_page(&random_games(class, edges, seed, watcher)?, marker))
    })?;
    page.map_err(|none| match none {
        NoGame::Interrupted => interrupted(),
        none => error(py, "SizeError", none),
    })
}
