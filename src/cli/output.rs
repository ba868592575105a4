//! Files are written whole or not at all; but for logs, which grow.

use std::{
    ffi::{OsStr, OsString},
    fs, io,
    path::Path,
};

use toposlam_model::format::{dot, named_world::NamedWorld, plantri, world_file};

use super::Failure;

/// Writes a file by way of a neighbour that then takes its name, so that nothing half-written is
/// left behind.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let Some(name) = path.file_name() else {
        return Err(Failure::in_file(path, "this is not the name of a file"));
    };
    // A device or a pipe is written to, not replaced.
    if fs::metadata(path).is_ok_and(|metadata| !metadata.is_file()) {
        return fs::write(path, bytes).map_err(|error| unwritable(path, &error));
    }
    let mut partial_name = OsString::from(".");
    partial_name.push(name);
    partial_name.push(format!(".{}.partial", std::process::id()));
    let partial = path.with_file_name(partial_name);
    fs::write(&partial, bytes).and_then(|()| fs::rename(&partial, path)).map_err(|error| {
        // Best effort: the error that is reported is the one that matters.
        let _ = fs::remove_file(&partial);
        unwritable(path, &error)
    })
}

/// A file that grows while somebody writes it, under its own name: what is written of a log is worth
/// reading even where its writer was killed.
pub(crate) fn grow(path: &Path) -> Result<fs::File, Failure> {
    fs::File::create(path).map_err(|error| unwritable(path, &error))
}

/// Makes the folder, if it is not there.
pub(crate) fn make_folder(folder: &Path) -> Result<(), Failure> {
    fs::create_dir_all(folder)
        .map_err(|error| Failure::in_file(folder, format!("cannot be made a folder: {error}")))
}

/// Refuses a path that cannot become a file, before long work begins: a folder, or in a folder that
/// does not exist, or with an ending that is none of these.
pub(crate) fn check_place(path: &Path, endings: &[&str]) -> Result<(), Failure> {
    if path.is_dir() {
        return Err(Failure::in_file(path, "this is a folder; name a file"));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
        return Err(Failure::in_file(path, format!("there is no folder {}", folder.display())));
    }
    // A device has no ending.
    let fits = path.exists() && !path.is_file()
        || path.extension().and_then(OsStr::to_str).is_some_and(|found| endings.contains(&found));
    if fits {
        Ok(())
    } else {
        let endings: Vec<_> = endings.iter().map(|ending| format!(".{ending}")).collect();
        Err(Failure::in_file(path, format!("the name must end in {}", endings.join(" or "))))
    }
}

/// The endings of plantri's `planar_code`, which can tell simple graphs only.
const PLANAR_CODE: [&str; 3] = ["pc", "plc", "planar_code"];

/// Refuses a path as [`check_place`] does, for a world that may or may not be simple.
pub(crate) fn check_world_place(path: &Path, simple: bool) -> Result<(), Failure> {
    let endings = ["toml", "json", "dot", "ec", "edge_code"];
    if simple {
        check_place(path, &[&endings[..], &PLANAR_CODE].concat())
    } else {
        check_place(path, &endings)
    }
}

/// Writes a world as the ending of the name says: `.toml`, `.json`, Graphviz's `.dot`, plantri's
/// `.ec` and `.pc` (also `.edge_code` and `.planar_code`).
pub(crate) fn write_world(path: &Path, world: &NamedWorld) -> Result<(), Failure> {
    let graph = std::slice::from_ref(&world.graph);
    let coded = |code| plantri::write(graph, code).map_err(|error| Failure::in_file(path, error));
    let bytes = match path.extension().and_then(OsStr::to_str) {
        Some("json") => world_file::to_json_text(world).into_bytes(),
        Some("dot") => dot::write(world).into_bytes(),
        Some("ec" | "edge_code") => coded(plantri::PlantriCode::Edge)?,
        Some(ending) if PLANAR_CODE.contains(&ending) => coded(plantri::PlantriCode::Planar)?,
        _ => world_file::to_toml(world).into_bytes(),
    };
    write_whole(path, &bytes)
}

fn unwritable(path: &Path, error: &io::Error) -> Failure {
    Failure::in_file(path, format!("cannot be written: {error}"))
}
