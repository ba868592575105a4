//! How a report was made: the version, the command, and the hashes of the files.

use std::{env, io, path::Path};

use sha2::{Digest, Sha256};

use toposlam_conform::SourceFile;
use toposlam_logs::hexadecimal;

use super::CliError;
use crate::{
    cli::{input, text::quoted, version},
    page::ReportOrigin,
};

/// This version, and the command line of this process.
pub(super) fn origin() -> ReportOrigin {
    let words = env::args_os().skip(1).map(|word| quoted(&word.to_string_lossy()));
    let command = [vec!["toposlam".to_owned()], words.collect()].concat().join(" ");
    ReportOrigin { version: version::version().to_owned(), command }
}

/// A log and the world in which it was checked, with their hashes.
pub(super) fn sources(log: &Path, world: Option<&Path>) -> Result<Vec<SourceFile>, CliError> {
    let files = [("log", Some(log)), ("world", world)];
    let files = files.into_iter().filter_map(|(role, path)| Some((role, path?)));
    files
        .map(|(role, path)| {
            let sha256 = sha256(path).map_err(|error| CliError::in_file(path, error))?;
            Ok(SourceFile { role, path: path.display().to_string(), sha256 })
        })
        .collect()
}

/// The SHA-256 hash of a file, in hexadecimal.
fn sha256(path: &Path) -> io::Result<String> {
    let mut digest = HashWriter(Sha256::new());
    io::copy(&mut input::open_again(path)?, &mut digest)?;
    Ok(hexadecimal(&digest.0.finalize()))
}

/// What is written is hashed.
struct HashWriter(Sha256);

impl io::Write for HashWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
