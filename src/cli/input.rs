//! What files hold: worlds, whatever their format; cameras; colours.

use std::{
    fs,
    io::{self, Read},
    path::Path,
};

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    floor_plan::FloorPlan,
    format::{named_world::NamedWorld, plantri, world_file},
};
use toposlam_vision::{
    camera::{Camera, calibration},
    colour::ColourModel,
};

use super::Failure;

/// The world of a world file (TOML or JSON), or the only one of a file in plantri's codes. Where the
/// file does not name it, it has the file's name.
pub(crate) fn read_world(path: &Path) -> Result<NamedWorld, Failure> {
    let bytes = read(path)?;
    let mut world = match plantri_code(path, &bytes) {
        None => world_file::read(&bytes).map_err(|error| Failure::in_file(path, error))?,
        Some(code) => match <[_; 1]>::try_from(read_plantri(path, &bytes, code)?) {
            Ok([graph]) => NamedWorld::numbered("", "", graph, None),
            Err(graphs) => {
                let cause = format!("one world is needed here, and there are {}", graphs.len());
                return Err(Failure::in_file(path, cause));
            }
        },
    };
    if world.name.is_empty() {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let fits = |letter: char| letter.is_ascii_alphanumeric() || "_-".contains(letter);
        world.name = stem.chars().map(|letter| if fits(letter) { letter } else { '_' }).collect();
    }
    Ok(world)
}

/// The colours of a building.
pub(crate) fn read_colours(path: &Path) -> Result<ColourModel, Failure> {
    ColourModel::read(&read(path)?).map_err(|error| Failure::in_file(path, error))
}

/// The floor plan that a world is.
pub(crate) fn floor_plan<'w>(path: &Path, world: &'w NamedWorld) -> Result<&'w FloorPlan, Failure> {
    let cause = "this world is no floor plan: there is no [floor] in it";
    world.plan.as_ref().ok_or_else(|| Failure::in_file(path, cause))
}

/// The camera of a calibration file. The files that it names are those beside it.
pub(crate) fn read_camera(path: &Path) -> Result<Camera, Failure> {
    let folder = path.parent().unwrap_or(Path::new(""));
    calibration::read(&read(path)?, &mut |name| fs::read(folder.join(name)))
        .map_err(|error| Failure::in_file(path, error))
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
    if let Some(code) = plantri_code(path, &bytes) {
        return read_plantri(path, &bytes, code);
    }
    let world = world_file::read(&bytes).map_err(|error| Failure::in_file(path, error))?;
    Ok(vec![world.graph])
}

fn read_plantri(
    path: &Path,
    bytes: &[u8],
    code: plantri::PlantriCode,
) -> Result<Vec<EmbeddedGraph>, Failure> {
    let graphs: Result<Vec<_>, _> = plantri::read_headerless(bytes, code).collect();
    match graphs {
        Ok(graphs) if graphs.is_empty() => Err(Failure::in_file(path, "there is no world in it")),
        Ok(graphs) => Ok(graphs),
        Err(error) => Err(Failure::in_file(path, error)),
    }
}

/// Which of plantri's codes a file holds, by its header or else by its extension; `None` for a
/// world file.
fn plantri_code(path: &Path, bytes: &[u8]) -> Option<plantri::PlantriCode> {
    if bytes.starts_with(b">>edge_code") {
        return Some(plantri::PlantriCode::Edge);
    }
    if bytes.starts_with(b">>planar_code") {
        return Some(plantri::PlantriCode::Planar);
    }
    match path.extension()?.to_str()? {
        "ec" | "edge_code" => Some(plantri::PlantriCode::Edge),
        "pc" | "plc" | "planar_code" => Some(plantri::PlantriCode::Planar),
        _ => None,
    }
}

/// The bytes of a file; `-` is standard input.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    let bytes = if path == Path::new("-") {
        let mut bytes = Vec::new();
        io::stdin().lock().read_to_end(&mut bytes).map(|_| bytes)
    } else {
        fs::read(path)
    };
    bytes.map_err(|error| Failure::in_file(path, format!("cannot be read: {error}")))
}
