//! Output files. They are written completely or not at all, except logs, which grow. No output replaces
//! an input or another output.

use std::{
    ffi::{OsStr, OsString},
    fs,
    io::{self, BufWriter, Read, Write},
    path::{Path, PathBuf},
    process,
    sync::{Mutex, MutexGuard, PoisonError},
};

use toposlam_model::format::{dot, named_world::NamedWorld, plantri, world_file};

use super::{
    CliError, children,
    files::{FileUse, files},
    input,
};

/// Locked while a file is written.
static WRITING: Mutex<()> = Mutex::new(());

/// The temporary files of those that are not complete.
static PARTIAL: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn partial_files() -> MutexGuard<'static, Vec<PathBuf>> {
    PARTIAL.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends the program, and those that it started, when no file is being written. Of a file that is written in parts
/// nothing is left.
pub fn exit_between_files(code: i32) -> ! {
    children::end_all();
    let _not_writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    for partial in partial_files().iter() {
        // Another process may have removed it.
        let _ = fs::remove_file(partial);
    }
    process::exit(code)
}

/// Writes a file completely or not at all.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), CliError> {
    let _writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    let mut file = create_whole(path)?;
    file.write_all(bytes).map_err(|error| not_writable(path, &error))?;
    file.complete()
}

/// A file that is written in parts, completely or not at all: until it is complete it is a temporary file beside its place.
#[derive(Debug)]
pub struct WholeFile {
    file: BufWriter<fs::File>,
    path: PathBuf,
    /// `None` if it is a device or a pipe, which is not replaced, or complete.
    partial: Option<PathBuf>,
}

/// Creates a file that is written in parts.
pub fn create_whole(path: &Path) -> Result<WholeFile, CliError> {
    let Some(name) = path.file_name() else {
        return Err(CliError::in_file(path, "this is not a file name"));
    };
    files().write(path, FileUse::Written).map_err(CliError::Input)?;
    let is_replaced = !fs::metadata(path).is_ok_and(|metadata| !metadata.is_file());
    let partial = is_replaced.then(|| {
        let mut partial_name = OsString::from(".");
        partial_name.push(name);
        partial_name.push(format!(".{}.partial", process::id()));
        path.with_file_name(partial_name)
    });
    partial_files().extend(partial.clone());
    let file = fs::File::create(partial.as_deref().unwrap_or(path)).map(BufWriter::new);
    let file = file.map_err(|error| {
        forget(partial.as_deref());
        not_writable(path, &error)
    })?;
    Ok(WholeFile { file, path: path.to_owned(), partial })
}

/// A temporary file is no more.
fn forget(partial: Option<&Path>) {
    partial_files().retain(|known| Some(known.as_path()) != partial);
}

impl WholeFile {
    /// Gives the file its name.
    ///
    /// # Errors
    /// Returns an error if it cannot be written. Then nothing is left of it.
    pub fn complete(mut self) -> Result<(), CliError> {
        let named = self.file.flush().and_then(|()| match &self.partial {
            Some(partial) => fs::rename(partial, &self.path),
            None => Ok(()),
        });
        named.map_err(|error| not_writable(&self.path, &error))?;
        forget(self.partial.take().as_deref());
        Ok(())
    }
}

impl Drop for WholeFile {
    fn drop(&mut self) {
        let Some(partial) = self.partial.take() else { return };
        // If this fails, the first error is the one to report.
        let _ = fs::remove_file(&partial);
        forget(Some(&partial));
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// A file that grows. The beginning of a log is useful even if its writer was killed.
#[derive(Debug)]
pub struct GrowingFile {
    file: fs::File,
    path: PathBuf,
    /// The name until it is complete, if it replaces a file.
    partial: Option<PathBuf>,
}

/// Creates a file that grows: under its own name, or beside the file that it replaces when it is complete.
pub fn create_growing(path: &Path) -> Result<GrowingFile, CliError> {
    files().write(path, FileUse::Growing).map_err(CliError::Input)?;
    let partial = path.is_file().then(|| partial_path(path));
    let file = fs::File::create(partial.as_deref().unwrap_or(path));
    let file = file.map_err(|error| not_writable(path, &error))?;
    Ok(GrowingFile { file, path: path.to_owned(), partial })
}

/// The name of a growing file that replaces another one, until it is complete: `run.partial.mcap` for `run.mcap`.
pub fn partial_path(path: &Path) -> PathBuf {
    let ending = path.extension().unwrap_or_default();
    path.with_extension([OsStr::new("partial"), ending].join(OsStr::new(".")))
}

impl GrowingFile {
    /// Gives the complete file its name.
    ///
    /// # Errors
    /// Returns an error if the file that it replaces cannot be replaced.
    pub fn complete(self) -> Result<(), CliError> {
        let Some(partial) = self.partial else { return Ok(()) };
        fs::rename(partial, &self.path).map_err(|error| not_writable(&self.path, &error))
    }
}

impl Write for GrowingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Opens a file to append to, or creates it, and returns what it contains. It is locked until it is closed.
pub fn open_growing_alone(path: &Path) -> Result<(fs::File, Vec<u8>), CliError> {
    files().write(path, FileUse::Growing).map_err(CliError::Input)?;
    if fs::metadata(path).is_ok_and(|metadata| !metadata.is_file()) {
        return Err(CliError::in_file(path, "this is not a file"));
    }
    let open = fs::OpenOptions::new().read(true).append(true).create(true).open(path);
    let mut file = open.map_err(|error| not_writable(path, &error))?;
    match file.try_lock() {
        Ok(()) => {}
        Err(fs::TryLockError::WouldBlock) => {
            return Err(CliError::in_file(path, "another process is writing this file"));
        }
        Err(fs::TryLockError::Error(error)) => {
            return Err(CliError::in_file(path, format!("cannot be locked: {error}")));
        }
    }
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).map_err(|error| CliError::in_file(path, error))?;
    Ok((file, bytes))
}

/// Creates the folder if it does not exist.
pub fn make_folder(folder: &Path) -> Result<(), CliError> {
    files().fill_folder();
    fs::create_dir_all(folder).map_err(|error| {
        CliError::in_file(folder, format!("the folder cannot be created: {error}"))
    })
}

/// Checks, before long work begins, that a file, if it is wanted, can be written to a path: it is no folder, no input
/// and no other output, its folder exists, and its extension is in the list.
pub fn check_place<'p>(
    path: impl Into<Option<&'p PathBuf>>,
    extensions: &[&str],
) -> Result<(), CliError> {
    let Some(path) = path.into() else { return Ok(()) };
    if path.is_dir() {
        return Err(CliError::in_file(path, "this is a folder, not a file"));
    }
    if input::is_standard(path) {
        return Err(CliError::in_file(path, "an output is a file; only an input can be `-`"));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
        return Err(CliError::in_file(path, format!("there is no folder {}", folder.display())));
    }
    // A device has no extension.
    let fits = path.exists() && !path.is_file()
        || path
            .extension()
            .and_then(OsStr::to_str)
            .is_some_and(|found| extensions.contains(&found));
    if !fits {
        let extensions: Vec<_> = extensions.iter().map(|name| format!(".{name}")).collect();
        let cause = format!("the name must end in {}", extensions.join(" or "));
        return Err(CliError::in_file(path, cause));
    }
    files().write(path, FileUse::Planned).map_err(CliError::Input)
}

/// The extensions of plantri's `planar_code`, which is for simple graphs only.
const PLANAR_CODE: [&str; 3] = ["pc", "plc", "planar_code"];

/// Does [`check_place`] for a world that may or may not be simple.
pub fn check_world_place<'p>(
    path: impl Into<Option<&'p PathBuf>>,
    simple: bool,
) -> Result<(), CliError> {
    let extensions = ["toml", "json", "dot", "ec", "edge_code"];
    if simple {
        check_place(path, &[&extensions[..], &PLANAR_CODE].concat())
    } else {
        check_place(path, &extensions)
    }
}

/// As [`check_world_place`], or for a picture.
pub fn check_map_place(path: &PathBuf, simple: bool) -> Result<(), CliError> {
    match path.extension().and_then(OsStr::to_str) {
        Some(ending @ ("svg" | "png")) => check_place(path, &[ending]),
        _ => check_world_place(path, simple),
    }
}

/// Writes a world in the format of the file's extension: `.toml`, `.json`, Graphviz's `.dot`, plantri's
/// `.ec` and `.pc` (also `.edge_code` and `.planar_code`).
pub fn write_world(path: &Path, world: &NamedWorld) -> Result<(), CliError> {
    let graph = std::slice::from_ref(&world.graph);
    let coded = |code| plantri::write(graph, code).map_err(|error| CliError::in_file(path, error));
    let bytes = match path.extension().and_then(OsStr::to_str) {
        Some("json") => world_file::to_json_text(world).into_bytes(),
        Some("dot") => dot::write(world).into_bytes(),
        Some("ec" | "edge_code") => coded(plantri::PlantriCode::Edge)?,
        Some(ending) if PLANAR_CODE.contains(&ending) => coded(plantri::PlantriCode::Planar)?,
        _ => world_file::to_toml(world).into_bytes(),
    };
    write_whole(path, &bytes)
}

/// The error if a file cannot be written.
pub fn not_writable(path: &Path, error: &io::Error) -> CliError {
    CliError::in_file(path, format!("cannot be written: {error}"))
}
