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

static FILES: Mutex<CallFiles> = Mutex::new(CallFiles::new());

/// The files of this process, one thread at a time.
pub fn files() -> MutexGuard<'static, CallFiles> {
    FILES.lock().unwrap_or_else(PoisonError::into_inner)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileUse {
    Input,
    /// An output that is not written yet.
    Planned,
    /// An output that grows until the call ends.
    Growing,
    /// An output that replaces the file.
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

    /// Registers a file that is read: from now on it is not written. It is an error if it is an output.
    pub fn read(&mut self, path: &Path) -> Result<(), String> {
        match self.entry(path, FileUse::Input) {
            Some((output, found)) if *found != FileUse::Input => {
                *found = FileUse::Input;
                Err(replaces_input(output, path))
            }
            _ => Ok(()),
        }
    }

    /// Registers a folder that is an input as a whole: from now on nothing is written into it. It is an error if an
    /// output is in it.
    pub fn read_folder(&mut self, path: &Path) -> Result<(), String> {
        let real = real_path(path);
        let mut inside = self.by_path.iter().filter(|(file, _)| file.starts_with(&real));
        if let Some((output, _)) = inside
            .find_map(|(_, &entry)| self.entries.get(entry).filter(|(_, is)| *is != FileUse::Input))
        {
            return Err(is_in_input(output, path));
        }
        self.input_folders.push([real, path.to_owned()]);
        Ok(())
    }

    /// Registers an output. It is an error if it is an input, in a folder that is one, or another output. A planned
    /// one may be written once.
    pub fn write(&mut self, path: &Path, now: FileUse) -> Result<(), String> {
        let real = real_path(path);
        let is_around = |[folder, _]: &&[PathBuf; 2]| real.starts_with(folder);
        if let Some([_, folder]) = self.input_folders.iter().find(is_around) {
            return Err(is_in_input(path, folder));
        }
        let number = number(path);
        match self.entry(path, now) {
            None => {}
            Some((_, found @ FileUse::Planned)) if now != FileUse::Planned => *found = now,
            Some((input, FileUse::Input)) => return Err(replaces_input(path, input)),
            Some((other, _)) => return Err(is_other_output(path, other)),
        }
        // The file with this number is replaced, and another one may get the number.
        if let Some(number) = number.filter(|_| now == FileUse::Written) {
            self.by_number.remove(&number);
        }
        Ok(())
    }

    pub fn fill_folder(&mut self) {
        self.fills_folder = true;
    }

    /// Whether an output is not complete yet.
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

fn replaces_input(output: &Path, input: &Path) -> String {
    let [output, input] = [output, input].map(Path::display);
    format!("{output}: this output would replace the input {input}; choose another name")
}

fn is_other_output(output: &Path, other: &Path) -> String {
    let [output, other] = [output, other].map(Path::display);
    format!("{output}: this is the same file as the output {other}; choose another name")
}

fn is_in_input(output: &Path, folder: &Path) -> String {
    let [output, folder] = [output, folder].map(Path::display);
    format!(
        "{output}: this output would be in the folder {folder}, which is an input; choose another \
         folder"
    )
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

    fn folder() -> tempfile::TempDir {
        tempfile::tempdir().unwrap()
    }

    const OUTPUTS: [FileUse; 3] = [FileUse::Planned, FileUse::Written, FileUse::Growing];

    #[test]
    fn an_input_is_not_an_output_whichever_is_registered_first() {
        let folder = folder();
        let file = folder.path().join("file");
        fs::write(&file, "x").unwrap();
        let dotted = folder.path().join(".").join("file");
        for output in OUTPUTS {
            let mut files = CallFiles::new();
            files.read(&file).unwrap();
            files.read(&dotted).unwrap();
            assert_eq!(files.write(&dotted, output), Err(replaces_input(&dotted, &file)));
            let mut files = CallFiles::new();
            files.write(&dotted, output).unwrap();
            assert_eq!(files.read(&file), Err(replaces_input(&dotted, &file)));
            // Also a verb that goes on with other inputs does not write it.
            assert_eq!(files.write(&file, FileUse::Written), Err(replaces_input(&file, &dotted)));
        }
    }

    #[test]
    fn an_input_folder_gets_no_output() {
        let [folder, other] = [folder(), folder()];
        let (inside, other) = (folder.path().join("new.mcap"), other.path().join("new.mcap"));
        for output in OUTPUTS {
            let mut files = CallFiles::new();
            files.read_folder(folder.path()).unwrap();
            assert_eq!(files.write(&inside, output), Err(is_in_input(&inside, folder.path())));
            files.write(&other, output).unwrap();
            let mut files = CallFiles::new();
            files.write(&inside, output).unwrap();
            assert_eq!(files.read_folder(folder.path()), Err(is_in_input(&inside, folder.path())));
        }
    }

    #[test]
    fn a_planned_output_is_written_once() {
        let folder = folder();
        let [file, other, log] = ["new", "other", "log"].map(|name| folder.path().join(name));
        let mut files = CallFiles::new();
        files.write(&file, FileUse::Planned).unwrap();
        assert!(files.has_open_outputs());
        assert_eq!(files.write(&file, FileUse::Planned), Err(is_other_output(&file, &file)));
        files.write(&file, FileUse::Written).unwrap();
        assert!(!files.has_open_outputs());
        assert_eq!(files.write(&file, FileUse::Written), Err(is_other_output(&file, &file)));
        files.write(&other, FileUse::Written).unwrap();
        assert!(!files.has_open_outputs());
        files.write(&log, FileUse::Growing).unwrap();
        assert!(files.has_open_outputs());
    }

    #[cfg(unix)]
    #[test]
    fn a_device_may_be_several_inputs_and_outputs() {
        let device = Path::new("/dev/null");
        let mut files = CallFiles::new();
        files.read(device).unwrap();
        for output in [FileUse::Planned, FileUse::Written].repeat(2) {
            files.write(device, output).unwrap();
        }
        assert!(!files.has_open_outputs());
    }
}
