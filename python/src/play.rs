//! Pages on which a person is the robot.

use pyo3::prelude::*;
use toposlam_draw::page::{MOST_VERTICES, NoGame, games_of, play_page, random_games};
use toposlam_model::{aid::AidKind, format::named_world::NamedWorld};

use crate::{
    error::{error, guarded, internal, interrupted},
    long_work::run_watched,
    starts::named_class,
    world::{CoreWorld, check_seen, named_aid},
};

/// The page of a world, from a start and from others.
#[pyfunction]
pub(crate) fn world_page(
    py: Python<'_>,
    world: &CoreWorld,
    facing: u32,
    marker: &str,
) -> PyResult<String> {
    let (marker, facing) = (marking_aid(py, marker)?, world.dart(py, facing)?);
    let count = world.0.graph.vertex_count();
    if count > MOST_VERTICES {
        let text = format!("the world has {count} vertices; a page can have {MOST_VERTICES}");
        return Err(error(py, "SizeError", text));
    }
    check_seen(py, marker, &world.0.graph)?;
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
    let marker = marking_aid(py, marker)?;
    let games = games(py, class_, edges, seed)?;
    guarded(py, || Ok(py.detach(|| play_page(&games, marker))))
}

/// The first world of the page of random worlds.
#[pyfunction]
pub(crate) fn random_world(
    py: Python<'_>,
    class_: &str,
    edges: usize,
    seed: u64,
) -> PyResult<CoreWorld> {
    let first = games(py, class_, edges, seed)?.into_iter().next();
    first.map(CoreWorld).ok_or_else(|| internal(py))
}

/// The aid with this name, if it marks places.
fn marking_aid(py: Python<'_>, name: &str) -> PyResult<AidKind> {
    let aid = named_aid(py, name)?;
    if !aid.marks() {
        let text = format!("`{name}` does not mark places; a page needs an aid that does");
        return Err(error(py, "UnknownMarkerError", text));
    }
    Ok(aid)
}

fn games(py: Python<'_>, class: &str, edges: usize, seed: u64) -> PyResult<Vec<NamedWorld>> {
    let class = named_class(py, class)?;
    let games = run_watched(py, None, None, |watcher| random_games(class, edges, seed, watcher))?;
    games.map_err(|none| match none {
        NoGame::Interrupted => interrupted(),
        none => error(py, "SizeError", none),
    })
}
