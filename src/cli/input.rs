//! Input files: worlds in any format, calibrations, colours, logs. All are registered: no output replaces
//! them.

use std::{
    fs,
    io::{self, Read},
    path::{Path, PathBuf},
};

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    floor_plan::FloorPlan,
    format::{named_world::NamedWorld, plantri, world_file},
};
use toposlam_robot::log::{error::LogError, reader::Log};
use toposlam_vision::{
    camera::{Camera, calibration},
    colour::ColourModel,
};

use super::{Failure, files::files};

/// Reads the world of a world file (TOML or JSON) or of a plantri file with one world. If the file gives
/// no name, the world gets the name of the file.
pub(crate) fn read_world(path: &Path) -> Result<NamedWorld, Failure> {
    let bytes = read(path)?;
    let mut world = match plantri_code(path, &bytes) {
        None => world_file::read(&bytes).map_err(|error| Failure::in_file(path, error))?,
        Some(code) => match <[_; 1]>::try_from(read_plantri(path, &bytes, code)?) {
            Ok([graph]) => NamedWorld::numbered("", "", graph, None),
            Err(graphs) => {
                let cause = format!("expected one world, found {}", graphs.len());
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

/// Reads the colours of a building.
pub(crate) fn read_colours(path: &Path) -> Result<ColourModel, Failure> {
    ColourModel::read(&read(path)?).map_err(|error| Failure::in_file(path, error))
}

/// The floor plan of a world.
pub(crate) fn floor_plan<'w>(path: &Path, world: &'w NamedWorld) -> Result<&'w FloorPlan, Failure> {
    let cause = "this world is not a floor plan: it has no [floor]";
    world.plan.as_ref().ok_or_else(|| Failure::in_file(path, cause))
}

/// Reads the camera of a calibration file. Paths in the file are relative to its folder.
pub(crate) fn read_camera(path: &Path) -> Result<Camera, Failure> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let beside = &mut |name: &str| {
        let path = folder.join(name);
        files().read(&path).map_err(io::Error::other)?;
        fs::read(path)
    };
    calibration::read(&read(path)?, beside).map_err(|error| Failure::in_file(path, error))
}

/// The start from the command line, or else from the world file, or else the first dart.
pub(crate) fn start_of(world: &NamedWorld, start: Option<&str>) -> Result<Dart, Failure> {
    match start {
        Some(text) => world.start_from_text(text).map_err(|error| Failure::at("--start", error)),
        None => Ok(world.start.unwrap_or(Dart(0))),
    }
}

/// Reads the embedded graphs of a world file, or of a file in plantri's `planar_code` or `edge_code`.
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
        Ok(graphs) if graphs.is_empty() => {
            Err(Failure::in_file(path, "the file contains no world"))
        }
        Ok(graphs) => Ok(graphs),
        Err(error) => Err(Failure::in_file(path, error)),
    }
}

/// The plantri code of a file, by its header or its extension. `None` for a world file.
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

/// Registers files that are read later, so that an output among them is refused before the work.
pub(crate) fn register(paths: &[PathBuf]) -> Result<(), Failure> {
    Ok(paths.iter().try_for_each(|path| files().read(path))?)
}

/// Opens a log.
pub(crate) fn open_log(path: &Path) -> Result<Log, Failure> {
    log_or_cause(path)?.map_err(|error| Failure::in_file(path, error))
}

/// Opens a log, or returns why it cannot be read.
pub(crate) fn log_or_cause(path: &Path) -> Result<Result<Log, LogError>, Failure> {
    files().read(path)?;
    Ok(Log::open(path))
}

/// Opens a file that was read before, to read it in pieces.
pub(crate) fn open_again(path: &Path) -> io::Result<fs::File> {
    fs::File::open(path)
}

/// Reads a file. `-` is standard input.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    let bytes = if path == Path::new("-") {
        let mut bytes = Vec::new();
        io::stdin().lock().read_to_end(&mut bytes).map(|_| bytes)
    } else {
        files().read(path)?;
        fs::read(path)
    };
    bytes.map_err(|error| Failure::in_file(path, format!("cannot be read: {error}")))
}
