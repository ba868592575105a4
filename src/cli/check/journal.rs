//! The journal of a check: the units that are finished, so that a check that was killed can go on.
//!
//! One file for each number of edges. Each line has the CRC-32 of its JSON object in hexadecimal, a space, and
//! the object. The first object describes the check. Each other one is a finished unit. Lines are only appended.

use std::{
    collections::BTreeMap,
    fmt::Display,
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
};

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use toposlam_model::check::{FinishedUnits, LazyTally};

use crate::cli::{CliError, output};

/// The check that a journal is of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct JournalHeader {
    /// The version of the format.
    pub(super) journal: u32,
    /// The version of the program.
    pub(super) version: String,
    pub(super) class: String,
    pub(super) edges: usize,
    pub(super) marker: String,
    pub(super) algorithm: String,
    pub(super) shard: String,
    /// The number of units.
    pub(super) units: usize,
}

impl JournalHeader {
    /// The version of the format.
    pub(super) const FORMAT: u32 = 1;

    /// The first thing in which a check differs from another.
    fn difference(&self, other: &Self) -> Option<String> {
        let here = self.fields();
        let differs = here.into_iter().zip(other.fields()).find(|(one, other)| one != other);
        differs.map(|((name, one), (_, other))| format!("{name} is {one}, not {other}"))
    }

    fn fields(&self) -> [(&'static str, String); 8] {
        [
            ("the format", self.journal.to_string()),
            ("the version", self.version.clone()),
            ("the class", self.class.clone()),
            ("the number of edges", self.edges.to_string()),
            ("the marker", self.marker.clone()),
            ("the algorithm", self.algorithm.clone()),
            ("the shard", self.shard.clone()),
            ("the number of units", self.units.to_string()),
        ]
    }
}

/// A finished unit.
#[derive(Serialize, Deserialize)]
struct FinishedUnit {
    unit: usize,
    counts: LazyTally,
}

/// An open journal.
pub(super) struct CheckJournal {
    path: PathBuf,
    finished: BTreeMap<usize, LazyTally>,
    file: Mutex<Result<fs::File, io::Error>>,
}

fn text_of(content: &impl Serialize) -> io::Result<String> {
    let json = serde_json::to_string(content)?;
    Ok(format!("{:08x} {json}\n", crc32fast::hash(json.as_bytes())))
}

/// The object of a line, if its checksum is right.
fn object_of<T: DeserializeOwned>(line: &[u8]) -> Option<T> {
    let (checksum, json) = line.split_at_checked(9)?;
    let expected = format!("{:08x} ", crc32fast::hash(json));
    (checksum == expected.as_bytes()).then(|| serde_json::from_slice(json).ok()).flatten()
}

impl CheckJournal {
    /// Opens the journal of a check in a folder, or begins it.
    ///
    /// # Errors
    /// Returns an error if the journal is of another check, if it is corrupt, or if it cannot be written.
    pub(super) fn open(folder: &Path, header: &JournalHeader) -> Result<Self, CliError> {
        output::make_folder(folder)?;
        let path = folder.join(format!("{}-edges.journal", header.edges));
        let at = |cause: &dyn Display| CliError::in_file(&path, cause);
        let (mut file, bytes) = output::open_growing(&path)?;
        // A line without an end was being written when the check was killed.
        let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
        file.set_len(whole as u64).map_err(|error| at(&error))?;
        let mut lines = bytes[..whole].split_inclusive(|&byte| byte == b'\n');
        let mut finished = BTreeMap::new();
        match lines.next() {
            None => {
                let line = text_of(header).map_err(|error| at(&error))?;
                file.write_all(line.as_bytes()).map_err(|error| at(&error))?;
            }
            Some(first) => {
                let found: JournalHeader = object_of(&first[..first.len() - 1])
                    .ok_or_else(|| at(&"line 1: this is not the first line of a journal"))?;
                if let Some(difference) = found.difference(header) {
                    return Err(at(&format!("this is the journal of another check: {difference}")));
                }
            }
        }
        for (number, line) in (2..).zip(lines) {
            let corrupt =
                |what: &str| at(&format!("line {number}: the journal is corrupt: {what}"));
            let FinishedUnit { unit, counts } = object_of(&line[..line.len() - 1])
                .ok_or_else(|| corrupt("the checksum is wrong"))?;
            if unit >= header.units {
                return Err(corrupt("there is no such unit"));
            }
            if finished.insert(unit, counts).is_some() {
                return Err(corrupt("a unit is there twice"));
            }
        }
        Ok(Self { path, finished, file: Mutex::new(Ok(file)) })
    }

    /// The number of units that were finished before.
    pub(super) fn finished_before(&self) -> usize {
        self.finished.len()
    }

    /// Closes the journal.
    ///
    /// # Errors
    /// Returns the first error of writing.
    pub(super) fn close(self) -> Result<(), CliError> {
        let file = self.file.into_inner().unwrap_or_else(PoisonError::into_inner);
        let synced = file.and_then(|file| file.sync_all());
        synced.map_err(|error| CliError::in_file(&self.path, error))
    }
}

impl FinishedUnits for CheckJournal {
    fn finished(&self, unit: usize) -> Option<LazyTally> {
        self.finished.get(&unit).cloned()
    }

    fn finish(&self, unit: usize, tally: &LazyTally) {
        let line = text_of(&FinishedUnit { unit, counts: tally.clone() });
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        if let Ok(open) = file.as_mut()
            && let Err(error) = line.and_then(|line| open.write_all(line.as_bytes()))
        {
            *file = Err(error);
        }
    }
}
