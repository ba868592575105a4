//! Input files: worlds in any format, calibrations, colours, logs. All are registered: no output replaces
//! them. The path `-` is standard input, which can be one of the inputs.

use std::{
    ffi::OsString,
    fs,
    io::{self, Cursor, Read},
    path::{Path, PathBuf},
    sync::{Arc, OnceLock},
};

use toposlam_logs::{error::LogError, reader::Log};
use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    floor_plan::FloorPlan,
    format::{named_world::NamedWorld, plantri, world_file},
};
use toposlam_vision::{
    camera::{Camera, calibration},
    colour::ColourModel,
};

use super::{CliError, files::files, foreign_format};

/// Reads the world of a world file (TOML or JSON) or of a plantri file with one world. If the file gives
/// no name, the world gets the name of the file.
pub fn read_world(path: &Path) -> Result<NamedWorld, CliError> {
    let bytes = read_at_most(path, MOST_WORLDS)?;
    let mut world = match plantri::PlantriCode::of_file(path, &bytes) {
        None => world_in_file(path, &bytes)?,
        Some(code) => match <[_; 1]>::try_from(read_plantri(path, &bytes, code)?) {
            Ok([graph]) => NamedWorld::numbered("", "", graph, None),
            Err(graphs) => {
                let cause = format!("expected one world, found {}", graphs.len());
                return Err(CliError::in_file(path, cause));
            }
        },
    };
    if world.name.is_empty() {
        let stem = stem(path);
        world.name = stem.to_string_lossy().into_owned();
        if !world_file::is_name(&world.name) {
            let fits = |letter: char| letter.is_ascii_alphanumeric() || "_-".contains(letter);
            let letters = world.name.chars().map(|letter| if fits(letter) { letter } else { '_' });
            world.name = letters.collect();
        }
    }
    Ok(world)
}

pub fn read_colours(path: &Path) -> Result<ColourModel, CliError> {
    ColourModel::read(&read(path)?).map_err(|error| CliError::in_file(path, error))
}

pub fn floor_plan<'w>(path: &Path, world: &'w NamedWorld) -> Result<&'w FloorPlan, CliError> {
    let cause = "this world is not a floor plan: it has no [floor]";
    world.plan.as_ref().ok_or_else(|| CliError::in_file(path, cause))
}

/// Reads the camera of a calibration file. Paths in the file are relative to its folder.
pub fn read_camera(path: &Path) -> Result<Camera, CliError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let beside = &mut |name: &str| {
        let path = folder.join(name);
        files().read(&path).map_err(io::Error::other)?;
        read_whole(fs::File::open(&path)?, 0, MOST)
    };
    let bytes = read(path)?;
    calibration::read(&bytes, beside).map_err(|error| CliError::in_file(path, error))
}

/// The world of a world file, or of a file of another program that has positions.
fn world_in_file(path: &Path, bytes: &[u8]) -> Result<NamedWorld, CliError> {
    let error = match world_file::read(bytes) {
        Ok(world) => return Ok(world),
        Err(error) => error,
    };
    let other = foreign_format::world_of_other(bytes);
    other.unwrap_or_else(|| Err(error.to_string())).map_err(|cause| CliError::in_file(path, cause))
}

/// The start from the command line, or else from the world file, or else the first dart.
pub fn start_of(world: &NamedWorld, start: Option<&str>) -> Result<Dart, CliError> {
    match start {
        Some(text) => world.start_from_text(text).map_err(|error| CliError::at("--start", error)),
        None => Ok(world.start.unwrap_or(Dart(0))),
    }
}

/// Reads the embedded graphs of a world file, or of a file in plantri's `planar_code` or `edge_code`.
pub fn read_graphs(path: &Path) -> Result<Vec<EmbeddedGraph>, CliError> {
    let bytes = read_at_most(path, MOST_WORLDS)?;
    if let Some(code) = plantri::PlantriCode::of_file(path, &bytes) {
        return read_plantri(path, &bytes, code);
    }
    Ok(vec![world_in_file(path, &bytes)?.graph])
}

fn read_plantri(
    path: &Path,
    bytes: &[u8],
    code: plantri::PlantriCode,
) -> Result<Vec<EmbeddedGraph>, CliError> {
    let graphs: Result<Vec<_>, _> = plantri::read_headerless(bytes, code).collect();
    match graphs {
        Ok(graphs) if graphs.is_empty() => {
            Err(CliError::in_file(path, "the file contains no world"))
        }
        Ok(graphs) => Ok(graphs),
        Err(error) => Err(CliError::in_file(path, error)),
    }
}

/// Registers files that are read later, so that an output among them is refused before the work.
pub fn register(paths: &[PathBuf]) -> Result<(), CliError> {
    let mut files_of_paths = paths.iter().filter(|path| !is_standard(path));
    files_of_paths.try_for_each(|path| files().read(path)).map_err(CliError::Input)
}

/// The name of a file without its ending.
pub fn stem(path: &Path) -> OsString {
    let stem =
        if is_standard(path) { "stdin".as_ref() } else { path.file_stem().unwrap_or_default() };
    stem.to_owned()
}

pub fn open_log(path: &Path) -> Result<Log, CliError> {
    log_or_cause(path)?.map_err(|error| CliError::in_file(path, error))
}

/// Opens a log, or returns why it cannot be read.
pub fn log_or_cause(path: &Path) -> Result<Result<Log, LogError>, CliError> {
    if is_standard(path) {
        return Ok(Log::new(Cursor::new(standard_input(MOST_LOG)?)));
    }
    files().read(path).map_err(CliError::Input)?;
    if path.is_dir() {
        files().read_folder(path).map_err(CliError::Input)?;
    }
    for file in folder_files(path).unwrap_or_default() {
        files().read(&file).map_err(CliError::Input)?;
    }
    Ok(Log::open(path))
}

/// The files in a folder by their names; none if it is not a folder.
fn folder_files(path: &Path) -> io::Result<Vec<PathBuf>> {
    if !path.is_dir() {
        return Ok(Vec::new());
    }
    let files: io::Result<Vec<_>> =
        fs::read_dir(path)?.map(|entry| entry.map(|entry| entry.path())).collect();
    let mut files = files?;
    files.retain(|file| file.is_file());
    files.sort();
    Ok(files)
}

/// Opens a file that was read before, to read it in pieces. A folder is its files, one after the other.
pub fn open_again(path: &Path) -> io::Result<Box<dyn Read>> {
    match STANDARD_INPUT.get().filter(|_| is_standard(path)) {
        Some(bytes) => Ok(Box::new(Cursor::new(bytes.clone()))),
        None if path.is_dir() => {
            let nothing: Box<dyn Read> = Box::new(io::empty());
            folder_files(path)?.into_iter().try_fold(nothing, |before, file| {
                let all: Box<dyn Read> = Box::new(before.chain(fs::File::open(file)?));
                Ok(all)
            })
        }
        None => Ok(Box::new(fs::File::open(path)?)),
    }
}

/// The most bytes of a file of worlds, 1 GiB.
const MOST_WORLDS: u64 = 1 << 30;
/// The most bytes of a log that is standard input, 2 GiB. A log in a file is read in pieces.
const MOST_LOG: u64 = 1 << 31;
/// The most bytes of any other file, 256 MiB.
const MOST: u64 = 1 << 28;

/// Reads a file that is neither of worlds nor a log.
pub fn read(path: &Path) -> Result<Vec<u8>, CliError> {
    read_at_most(path, MOST)
}

fn read_at_most(path: &Path, most: u64) -> Result<Vec<u8>, CliError> {
    if is_standard(path) {
        return Ok(standard_input(most)?.to_vec());
    }
    files().read(path).map_err(CliError::Input)?;
    let file = fs::File::open(path);
    let bytes = file.and_then(|file| {
        let size = file.metadata()?.len();
        if size > most { Err(too_large(most)) } else { read_whole(file, size, most) }
    });
    bytes.map_err(|error| not_readable(path, &error))
}

/// Reads to the end of a file of about a size. A device has no end.
fn read_whole(file: impl Read, size: u64, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(usize::try_from(size).unwrap_or(0));
    file.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(too_large(most)) } else { Ok(bytes) }
}

fn too_large(most: u64) -> io::Error {
    io::Error::other(format!("it has more than {} MiB", most >> 20))
}

/// The content of standard input, once it was read.
static STANDARD_INPUT: OnceLock<Arc<[u8]>> = OnceLock::new();

const STANDARD: &str = "-";

/// Whether a path is that of standard input.
pub fn is_standard(path: &Path) -> bool {
    path == Path::new(STANDARD)
}

/// Reads standard input to its end. A log, too, is kept in memory.
fn standard_input(most: u64) -> Result<Arc<[u8]>, CliError> {
    let read = read_whole(io::stdin().lock(), 0, most);
    let bytes: Arc<[u8]> = read.map_err(|error| not_readable(Path::new(STANDARD), &error))?.into();
    STANDARD_INPUT.set(bytes.clone()).map_err(|_| {
        let cause = "standard input is one input; give the path of a file for the others";
        CliError::at(STANDARD, cause)
    })?;
    Ok(bytes)
}

fn not_readable(path: &Path, error: &io::Error) -> CliError {
    CliError::in_file(path, format!("cannot be read: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_without_an_end_is_read_up_to_the_limit() {
        let error = read_whole(io::repeat(b'a'), 0, 3 << 20).unwrap_err();
        assert_eq!(error.to_string(), "it has more than 3 MiB");
        assert_eq!(read_whole(&b"abc"[..], 3, 3).unwrap(), b"abc");
        assert!(read_whole(&b"abcd"[..], 3, 3).is_err());
    }
}
