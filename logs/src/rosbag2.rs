//! Folders of rosbag2: `metadata.yaml` names the files of a log, in their order.

use std::{
    fs::{self, File},
    io,
    path::{Path, PathBuf},
};

use saphyr_parser::{Event, Parser};

use super::{
    compressed::Storage,
    error::{LogError, LogErrorKind},
};

pub const METADATA: &str = "metadata.yaml";

/// The most files that a log may have.
const MOST_FILES: usize = 10_000;

/// The endings of the files of messages, without that of their compression.
const ENDINGS: [&str; 2] = [".db3", ".mcap"];
const COMPRESSED: &str = ".zstd";

pub(super) struct BagFile {
    pub(super) name: String,
    pub(super) path: PathBuf,
    pub(super) storage: Box<dyn Storage>,
}

/// Opens the files of a folder. Without `metadata.yaml`, which a recorder writes last, these are all files
/// with a known ending.
pub(super) fn open(folder: &Path) -> Result<Vec<BagFile>, LogError> {
    let unreadable = |error: io::Error| LogErrorKind::from(error).at(0);
    let names = match fs::read(folder.join(METADATA)) {
        Ok(bytes) => file_names(&bytes)?,
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            let found = all_names(folder).map_err(unreadable)?;
            if found.is_empty() {
                return Err(LogErrorKind::NoBagFiles.at(0));
            }
            found
        }
        Err(error) => return Err(in_metadata(unreadable(error))),
    };
    let open = |name: String| {
        let path = folder.join(&name);
        match File::open(&path) {
            Ok(file) => Ok(BagFile { name, path, storage: Box::new(file) }),
            Err(error) => Err(LogError { file: Some(name), ..unreadable(error) }),
        }
    };
    names.into_iter().map(open).collect()
}

/// The names of the files with a known ending. Numbers in names are compared as numbers.
fn all_names(folder: &Path) -> io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        let Ok(name) = entry?.file_name().into_string() else { continue };
        let inner = name.strip_suffix(COMPRESSED).unwrap_or(&name);
        if ENDINGS.iter().any(|ending| inner.ends_with(ending)) {
            names.push(name);
        }
    }
    names.sort_by_cached_key(|name| (name.len(), name.clone()));
    names.truncate(MOST_FILES);
    Ok(names)
}

/// The names of the files of messages in a `metadata.yaml`. Folders in them are left out: older recorders
/// wrote that of the log itself.
///
/// Takes at most 512 bytes of memory for each byte of it, and 4096 besides.
///
/// # Errors
/// Returns an error with its line if this is not YAML, or names no files. No bytes make it panic.
pub fn file_names(metadata: &[u8]) -> Result<Vec<String>, LogError> {
    let at_line =
        |what: String, line: usize| in_metadata(LogErrorKind::Metadata { line, what }.at(0));
    let Ok(text) = std::str::from_utf8(metadata) else {
        return Err(at_line("this is not UTF-8 text".to_owned(), 1));
    };
    let mut reading = Reading::default();
    for event in Parser::new_from_str(text) {
        let (event, span) = event.map_err(|error| {
            at_line(error.info().replace(char::is_control, " "), error.marker().line())
        })?;
        let line = span.start.line();
        match event {
            Event::Scalar(word, ..) => reading.word(&word),
            Event::MappingStart(..) => reading.begin(true),
            Event::SequenceStart(..) => reading.begin(false),
            Event::MappingEnd | Event::SequenceEnd => reading.end(),
            Event::Alias(_) => {
                reading.begin(false);
                reading.end();
            }
            Event::DocumentEnd => break,
            _ => {}
        }
        if reading.names.len() > MOST_FILES {
            return Err(at_line(format!("it has more than {MOST_FILES} files"), line));
        }
    }
    if reading.names.is_empty() {
        return Err(at_line(format!("it has no {FILES}"), 1));
    }
    reading.names.into_iter().map(|path| base(&path).map_err(|what| at_line(what, 1))).collect()
}

fn base(path: &str) -> Result<String, String> {
    let name = path.rsplit(['/', '\\']).next().unwrap_or_default();
    if name.is_empty() || name == "." || name == ".." || name.contains(char::is_control) {
        return Err(format!(
            "{:?} is not the name of a file",
            path.chars().take(80).collect::<String>()
        ));
    }
    Ok(name.to_owned())
}

fn in_metadata(error: LogError) -> LogError {
    LogError { file: Some(METADATA.to_owned()), ..error }
}

const FILES: &str = "relative_file_paths";

#[derive(Default)]
struct Reading {
    /// Of each mapping the key that was read last; of each list nothing.
    path: Vec<Option<Key>>,
    names: Vec<String>,
}

#[derive(Clone, Copy, PartialEq)]
enum Key {
    None,
    Files,
    Other,
}

impl Reading {
    fn begin(&mut self, is_mapping: bool) {
        self.path.push(is_mapping.then_some(Key::None));
    }

    fn end(&mut self) {
        self.path.pop();
        self.value_ended();
    }

    fn value_ended(&mut self) {
        if let Some(Some(key)) = self.path.last_mut() {
            *key = Key::None;
        }
    }

    fn word(&mut self, word: &str) {
        if let Some(Some(key @ Key::None)) = self.path.last_mut() {
            *key = if word == FILES { Key::Files } else { Key::Other };
            return;
        }
        if matches!(self.path[..], [.., Some(Key::Files), None]) {
            self.names.push(word.to_owned());
        }
        self.value_ended();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_are_those_of_the_list() {
        let text = "rosbag2_bagfile_information:\n  version: 9\n  files:\n  - path: other.db3\n  \
            relative_file_paths:\n    - run/run_0.db3.zstd\n    - run_1.db3.zstd\n  duration:\n    \
            nanoseconds: 3\n";
        assert_eq!(file_names(text.as_bytes()).unwrap(), ["run_0.db3.zstd", "run_1.db3.zstd"]);
        let error = |text: &[u8]| file_names(text).unwrap_err().to_string();
        assert_eq!(error(b"a: 1"), "metadata.yaml: line 1: it has no relative_file_paths");
        assert_eq!(error(b"\xff"), "metadata.yaml: line 1: this is not UTF-8 text");
        assert!(
            error(b"a: [1\nb: }").starts_with("metadata.yaml: line 2: "),
            "{}",
            error(b"a: [1\nb: }")
        );
        assert_eq!(
            error(b"relative_file_paths: [a/..]"),
            "metadata.yaml: line 1: \"a/..\" is not the name of a file"
        );
    }
}
