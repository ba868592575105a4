//! Worlds from files, whatever their format.

use std::{fs, path::Path};

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    format::{named_world::NamedWorld, plantri, world_file},
};

use super::Failure;

/// The world of a world file (TOML or JSON).
pub(crate) fn read_world(path: &Path) -> Result<NamedWorld, Failure> {
    let bytes = read(path)?;
    if plantri_code(path, &bytes).is_some() {
        return Err(Failure::in_file(
            path,
            "this holds plantri's code; a world file is needed here",
        ));
    }
    world_file::read(&bytes).map_err(|error| Failure::in_file(path, error))
}

/// The start that the command line names, or else the world's own, or else its first dart.
pub(crate) fn start_of(world: &NamedWorld, start: Option<&str>) -> Result<Dart, Failure> {
    match start {
        Some(text) => world.start_from_text(text).map_err(|error| Failure::at("--start", error)),
        None => Ok(world.start.unwrap_or(Dart(0))),
    }
}

/// The embedded graphs of a world file, or of a file in plantri's `planar_code` or `edge_code`.
pub(crate) fn read_graphs(path: &Path) -> Result<Vec<EmbeddedGraph>, Failure> {
    let bytes = read(path)?;
    let Some(code) = plantri_code(path, &bytes) else {
        let world = world_file::read(&bytes).map_err(|error| Failure::in_file(path, error))?;
        return Ok(vec![world.graph]);
    };
    let graphs: Result<Vec<_>, _> = plantri::read_headerless(&bytes, code).collect();
    match graphs {
        Ok(graphs) if graphs.is_empty() => Err(Failure::in_file(path, "there is no world in it")),
        Ok(graphs) => Ok(graphs),
        Err(error) => Err(Failure::in_file(path, error)),
    }
}

/// Which of plantri's codes a file holds, by its header or else by its extension; `None` for a
/// world file.
fn plantri_code(path: &Path, bytes: &[u8]) -> Option<plantri::Code> {
    if bytes.starts_with(b">>edge_code") {
        return Some(plantri::Code::Edge);
    }
    if bytes.starts_with(b">>planar_code") {
        return Some(plantri::Code::Planar);
    }
    match path.extension()?.to_str()? {
        "ec" | "edge_code" => Some(plantri::Code::Edge),
        "pc" | "plc" | "planar_code" => Some(plantri::Code::Planar),
        _ => None,
    }
}

fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    fs::read(path).map_err(|error| Failure::in_file(path, format!("cannot be read: {error}")))
}
