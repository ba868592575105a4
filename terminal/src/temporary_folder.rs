//! Folders for temporary files. None is left behind, also after Ctrl-C.

use std::{
    env,
    fmt::Display,
    fs,
    path::PathBuf,
    sync::{Mutex, PoisonError},
};

use tempfile::TempDir;

/// The folders that exist now.
static FOLDERS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A folder for temporary files, in `$TMPDIR`. It is removed when it is dropped or the program ends.
pub struct TemporaryFolder(TempDir);

impl TemporaryFolder {
    pub fn new() -> Result<Self, String> {
        let mut folders = FOLDERS.lock().unwrap_or_else(PoisonError::into_inner);
        let folder = tempfile::Builder::new().prefix("toposlam-").tempdir().map_err(|error| {
            let place = env::temp_dir();
            format!("no folder for temporary files can be created in {}: {error}", place.display())
        })?;
        folders.push(folder.path().to_owned());
        Ok(Self(folder))
    }

    pub fn directory(&self) -> &TempDir {
        &self.0
    }

    /// The message of a failure in this folder.
    pub fn failure(&self, error: &impl Display) -> String {
        let advice = "TMPDIR=DIR chooses another folder for temporary files";
        format!("{}: {error}; {advice}", self.0.path().display())
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        let mut folders = FOLDERS.lock().unwrap_or_else(PoisonError::into_inner);
        folders.retain(|folder| folder != self.0.path());
    }
}

/// Removes all folders, at the end of the program.
pub fn remove_all() {
    let folders = FOLDERS.lock().unwrap_or_else(PoisonError::into_inner);
    for folder in folders.iter() {
        // There is nobody to report a failure to.
        let _ = fs::remove_dir_all(folder);
    }
}
