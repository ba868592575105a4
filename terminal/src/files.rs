//! The files of a call: an output never replaces an input or another output.
//!
//! [`input`](super::input) registers each file that is read, and [`output`](super::output) each file that
//! is planned or written. The second use of a file is refused if one of the two uses is an output. All
//! verbs read and write through these two modules, so none can forget the check.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    sync::{Mutex, MutexGuard, PoisonError},
};

use thiserror::Error;

/// The files of this process.
static FILES: Mutex<CallFiles> = Mutex::new(CallFiles::new());

/// The files of this process, one thread at a time.
pub fn files() -> MutexGuard<'static, CallFiles> {
    FILES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Why a file cannot be used as an output.
#[allow(missing_docs, reason = "the names say it")]
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum FileConflict {
    /// It is an input.
    #[error(
        "{}: this output would replace the input {}; choose another name",
        output.display(), input.display()
    )]
    Input { output: PathBuf, input: PathBuf },
    /// It is another output.
    #[error(
        "{}: this is the same file as the output {}; choose another name",
        output.display(), other.display()
    )]
    Output { output: PathBuf, other: PathBuf },
    /// It would become a part of an input.
    #[error(
        "{}: this output would be in the folder {}, which is an input; choose another folder",
        output.display(), folder.display()
    )]
    Folder { output: PathBuf, folder: PathBuf },
}

/// The use of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FileUse {
    Input,
    /// An output that is not written yet.
    Planned,
    /// An output that grows until the call ends.
    Growing,
    Written,
}

/// The files of a call with their uses. Devices and pipes are not in it: they are not replaced.
#[derive(Debug)]
pub struct CallFiles {
    /// Each file by the path that was given.
    entries: Vec<(PathBuf, FileUse)>,
    /// The entry of each absolute path without symbolic links.
    by_path: BTreeMap<PathBuf, usize>,
    /// The entry of each existing file by device and number, which hard links share.
    by_number: BTreeMap<[u64; 2], usize>,
    /// The folders that are inputs as a whole: absolute paths, and as they were given.
    input_folders: Vec<[PathBuf; 2]>,
    /// Whether files are written into a folder.
    fills_folder: bool,
}

impl CallFiles {
    const fn new() -> Self {
        Self {
            entries: Vec::new(),
            by_path: BTreeMap::new(),
            by_number: BTreeMap::new(),
            input_folders: Vec::new(),
            fills_folder: false,
        }
    }

    /// Registers a file that is read. From now on it is not written.
    ///
    /// # Errors
    /// Returns an error if it is an output.
    pub fn read(&mut self, path: &Path) -> Result<(), FileConflict> {
        match self.entry(path, FileUse::Input) {
            Some((output, found)) if *found != FileUse::Input => {
                *found = FileUse::Input;
                Err(FileConflict::Input { output: output.clone(), input: path.to_owned() })
            }
            _ => Ok(()),
        }
    }

    /// Registers a folder that is an input as a whole. From now on nothing is written into it.
    ///
    /// # Errors
    /// Returns an error if an output is in it.
    pub fn read_folder(&mut self, path: &Path) -> Result<(), FileConflict> {
        let real = real_path(path);
        let mut inside = self.by_path.iter().filter(|(file, _)| file.starts_with(&real));
        if let Some((output, _)) = inside
            .find_map(|(_, &entry)| self.entries.get(entry).filter(|(_, is)| *is != FileUse::Input))
        {
            return Err(FileConflict::Folder { output: output.clone(), folder: path.to_owned() });
        }
        self.input_folders.push([real, path.to_owned()]);
        Ok(())
    }

    /// Checks that an output is in no folder that is an input.
    fn check_folder(&self, output: &Path) -> Result<(), FileConflict> {
        let real = real_path(output);
        match self.input_folders.iter().find(|[folder, _]| real.starts_with(folder)) {
            Some([_, folder]) => {
                Err(FileConflict::Folder { output: output.to_owned(), folder: folder.clone() })
            }
            None => Ok(()),
        }
    }

    /// Registers a file that is written later.
    ///
    /// # Errors
    /// Returns an error if it is an input or another output.
    pub fn plan(&mut self, path: &Path) -> Result<(), FileConflict> {
        self.check_folder(path)?;
        match self.entry(path, FileUse::Planned) {
            Some((other, found)) => Err(conflict(path, other, *found)),
            None => Ok(()),
        }
    }

    /// Registers a file that is replaced now; it may be planned.
    ///
    /// # Errors
    /// Returns an error if it is an input, or was written before.
    pub fn write(&mut self, path: &Path) -> Result<(), FileConflict> {
        self.begin(path, FileUse::Written)
    }

    /// Registers a file that is created now and grows; it may be planned.
    ///
    /// # Errors
    /// Returns an error if it is an input, or was written before.
    pub fn grow(&mut self, path: &Path) -> Result<(), FileConflict> {
        self.begin(path, FileUse::Growing)
    }

    fn begin(&mut self, path: &Path, now: FileUse) -> Result<(), FileConflict> {
        self.check_folder(path)?;
        let number = number(path);
        match self.entry(path, now) {
            Some((_, found @ FileUse::Planned)) => *found = now,
            Some((other, found)) => return Err(conflict(path, other, *found)),
            None => {}
        }
        // The file with this number is replaced, and another one may get the number.
        if let Some(number) = number.filter(|_| now == FileUse::Written) {
            self.by_number.remove(&number);
        }
        Ok(())
    }

    /// Registers that files are written into a folder.
    pub fn fill_folder(&mut self) {
        self.fills_folder = true;
    }

    /// Whether an output is not complete yet.
    #[must_use]
    pub fn has_open_outputs(&self) -> bool {
        let is_open =
            |(_, found): &(_, FileUse)| matches!(found, FileUse::Planned | FileUse::Growing);
        self.fills_folder || self.entries.iter().any(is_open)
    }

    /// The known entry of a file. A new file is registered with this use.
    fn entry(&mut self, path: &Path, now: FileUse) -> Option<&mut (PathBuf, FileUse)> {
        if fs::metadata(path).is_ok_and(|metadata| !metadata.is_file()) {
            return None;
        }
        let (real, number) = (real_path(path), number(path));
        let by_number = number.and_then(|number| self.by_number.get(&number));
        if let Some(&known) = self.by_path.get(&real).or(by_number) {
            return self.entries.get_mut(known);
        }
        let new = self.entries.len();
        self.entries.push((path.to_owned(), now));
        self.by_path.insert(real, new);
        if let Some(number) = number {
            self.by_number.insert(number, new);
        }
        None
    }
}

fn conflict(output: &Path, other: &Path, found: FileUse) -> FileConflict {
    let (output, other) = (output.to_owned(), other.to_owned());
    match found {
        FileUse::Input => FileConflict::Input { output, input: other },
        _ => FileConflict::Output { output, other },
    }
}

/// The absolute path without symbolic links. For a file that does not exist, that of its folder, with its
/// name.
fn real_path(path: &Path) -> PathBuf {
    if let Ok(real) = path.canonicalize() {
        return real;
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new(".")).canonicalize();
    match (folder, path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    }
}

/// The device and the number of an existing file.
#[cfg(unix)]
fn number(path: &Path) -> Option<[u64; 2]> {
    use std::os::unix::fs::MetadataExt;
    let metadata = fs::metadata(path).ok()?;
    Some([metadata.dev(), metadata.ino()])
}

/// Other systems have no such number; hard links are not recognised there.
#[cfg(not(unix))]
fn number(_: &Path) -> Option<[u64; 2]> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An empty folder for a test.
    fn folder(name: &str) -> PathBuf {
        let folder =
            std::env::temp_dir().join(format!("toposlam-files-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    type Step = fn(&mut CallFiles, &Path) -> Result<(), FileConflict>;

    #[test]
    fn an_input_is_not_an_output_whichever_is_registered_first() {
        let folder = folder("either_order");
        let file = folder.join("file");
        fs::write(&file, "x").unwrap();
        let dotted = folder.join(".").join("file");
        for output in [CallFiles::plan as Step, CallFiles::write, CallFiles::grow] {
            let mut files = CallFiles::new();
            files.read(&file).unwrap();
            files.read(&dotted).unwrap();
            let conflict = FileConflict::Input { output: dotted.clone(), input: file.clone() };
            assert_eq!(output(&mut files, &dotted), Err(conflict));
            let mut files = CallFiles::new();
            output(&mut files, &dotted).unwrap();
            let conflict = FileConflict::Input { output: dotted.clone(), input: file.clone() };
            assert_eq!(files.read(&file), Err(conflict.clone()));
            // Also a verb that goes on with other inputs does not write it.
            let conflict = FileConflict::Input { output: file.clone(), input: dotted.clone() };
            assert_eq!(files.write(&file), Err(conflict));
        }
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn an_input_folder_gets_no_output() {
        let folder = folder("input_folder");
        let (inside, other) = (folder.join("new.mcap"), folder.with_extension("other"));
        let conflict = FileConflict::Folder { output: inside.clone(), folder: folder.clone() };
        for output in [CallFiles::plan as Step, CallFiles::write, CallFiles::grow] {
            let mut files = CallFiles::new();
            files.read_folder(&folder).unwrap();
            assert_eq!(output(&mut files, &inside), Err(conflict.clone()));
            output(&mut files, &other).unwrap();
            let mut files = CallFiles::new();
            output(&mut files, &inside).unwrap();
            assert_eq!(files.read_folder(&folder), Err(conflict.clone()));
        }
    }

    #[test]
    fn a_planned_output_is_written_once() {
        let folder = folder("once");
        let (file, other) = (folder.join("new"), folder.join("other"));
        let mut files = CallFiles::new();
        files.plan(&file).unwrap();
        assert!(files.has_open_outputs());
        let same = FileConflict::Output { output: file.clone(), other: file.clone() };
        assert_eq!(files.plan(&file), Err(same.clone()));
        files.write(&file).unwrap();
        assert!(!files.has_open_outputs());
        assert_eq!(files.write(&file), Err(same));
        files.write(&other).unwrap();
        assert!(!files.has_open_outputs());
        files.grow(&folder.join("log")).unwrap();
        assert!(files.has_open_outputs());
        fs::remove_dir_all(&folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn links_are_recognised() {
        let folder = folder("links");
        let file = folder.join("file");
        fs::write(&file, "x").unwrap();
        let (soft, hard) = (folder.join("soft"), folder.join("hard"));
        std::os::unix::fs::symlink("file", &soft).unwrap();
        fs::hard_link(&file, &hard).unwrap();
        for link in [soft, hard] {
            let mut files = CallFiles::new();
            files.read(&file).unwrap();
            assert!(matches!(files.plan(&link), Err(FileConflict::Input { .. })));
        }
        fs::remove_dir_all(&folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn a_device_may_be_several_inputs_and_outputs() {
        let device = Path::new("/dev/null");
        let mut files = CallFiles::new();
        files.read(device).unwrap();
        for _ in 0..2 {
            files.plan(device).unwrap();
            files.write(device).unwrap();
        }
        assert!(!files.has_open_outputs());
    }
}
