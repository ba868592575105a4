//! Folders of rosbag2: `metadata.yaml` names the files of a log, in their order.

use std::{fs, io, path::Path};

use saphyr_parser::{Event, Parser};

use super::error::{LogError, LogErrorKind};

const METADATA: &str = "metadata.yaml";

/// The most files that a log may have.
const MOST_FILES: usize = 10_000;

/// The endings of the files of messages, without that of their compression.
const ENDINGS: [&str; 2] = [".db3", ".mcap"];
const COMPRESSED: &str = ".zstd";

/// The names of the files of a folder. Without `metadata.yaml`, which a recorder writes last, or if that is empty,
/// these are all files with a known ending.
pub(super) fn names(folder: &Path) -> Result<Vec<String>, LogError> {
    let unreadable = |error: io::Error| LogErrorKind::from(error).at(0);
    let metadata = fs::read(folder.join(METADATA));
    // A recorder that crashed may have left an empty one.
    let is_left_out = match &metadata {
        Ok(bytes) => bytes.iter().all(|byte| byte.is_ascii_whitespace() || *byte == 0),
        Err(error) => error.kind() == io::ErrorKind::NotFound,
    };
    match metadata {
        _ if is_left_out => {
            let found = all_names(folder).map_err(unreadable)?;
            if found.is_empty() { Err(LogErrorKind::NoBagFiles.at(0)) } else { Ok(found) }
        }
        Ok(bytes) => file_names(&bytes),
        Err(error) => Err(in_metadata(unreadable(error))),
    }
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
    let mut names = Vec::new();
    // Whether the last word was the key of the list, and how many collections are open in the list.
    let (mut is_key, mut depth) = (false, 0);
    for event in Parser::new_from_str(text) {
        let (event, span) = event.map_err(|error| {
            at_line(error.info().replace(char::is_control, " "), error.marker().line())
        })?;
        match event {
            Event::SequenceStart(..) if is_key && depth == 0 => depth = 1,
            Event::SequenceStart(..) | Event::MappingStart(..) if depth > 0 => depth += 1,
            Event::SequenceEnd | Event::MappingEnd if depth > 0 => depth -= 1,
            Event::Scalar(ref name, ..) if depth == 1 => names.push(name.to_string()),
            Event::DocumentEnd => break,
            _ => {}
        }
        is_key = matches!(event, Event::Scalar(ref word, ..) if word == FILES);
        if names.len() > MOST_FILES {
            let what = format!("it has more than {MOST_FILES} files");
            return Err(at_line(what, span.start.line()));
        }
    }
    if names.is_empty() {
        return Err(at_line(format!("it has no {FILES}"), 1));
    }
    names.iter().map(|path| base(path).map_err(|what| at_line(what, 1))).collect()
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
        let syntax = error(b"a: [1\nb: }");
        assert!(syntax.starts_with("metadata.yaml: line 2: "), "{syntax}");
        assert_eq!(
            error(b"relative_file_paths: [a/..]"),
            "metadata.yaml: line 1: \"a/..\" is not the name of a file"
        );
    }
}
