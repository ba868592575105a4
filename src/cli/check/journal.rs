//! The journal of a check: the units that are finished, so that a check that was killed can go on.
//!
//! One file for each number of edges. Each line has the CRC-32 of its JSON object in hexadecimal, a space, and
//! the object. The first object describes the check. Each other one is a finished unit. Lines are only appended,
//! by one process at a time: the file is locked. The check stops at the first line that cannot be written.

use std::{
    collections::{BTreeMap, btree_map::Entry},
    fmt::Display,
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
};

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use toposlam_model::{
    check::{FinishedUnits, PartTally},
    enumerate::Watch,
};

use crate::cli::{CliError, output, version::release};

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
            ("the version", release(&self.version).to_owned()),
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
    counts: PartTally,
}

/// An open journal.
pub(super) struct CheckJournal {
    path: PathBuf,
    finished: BTreeMap<usize, PartTally>,
    file: Mutex<Result<fs::File, io::Error>>,
    /// Whether a line could not be written.
    is_broken: AtomicBool,
}

/// Stops a check when another watch does, or when its journal cannot be written.
pub(super) struct JournalWatch<'a> {
    journal: &'a CheckJournal,
    other: &'a dyn Watch,
}

/// The lines of a journal.
struct JournalLines {
    finished: BTreeMap<usize, PartTally>,
    /// The number of bytes in whole lines.
    length: usize,
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

/// Whether the results of two runs of a unit agree. Which of its starts is noted as the worst one depends on the
/// other units that have run, and each of the two is right.
fn have_equal_counts(one: &PartTally, other: &PartTally) -> bool {
    let counts = |tally: &PartTally| PartTally { worst: None, ..tally.clone() };
    counts(one) == counts(other)
}

/// The cause if a file is not a journal.
const NOT_A_JOURNAL: &str = "line 1: this is not the first line of a journal";

impl JournalLines {
    /// The lines of the journal of a check. A line without an end was being written when the check was killed.
    fn read(bytes: &[u8], header: &JournalHeader, header_line: &str) -> Result<Self, String> {
        let length = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
        let mut finished = BTreeMap::new();
        let mut lines = bytes[..length].split_inclusive(|&byte| byte == b'\n');
        let Some(first) = lines.next() else {
            let is_beginning = header_line.as_bytes().starts_with(bytes);
            let empty = Self { finished, length };
            return is_beginning.then_some(empty).ok_or_else(|| NOT_A_JOURNAL.to_owned());
        };
        let found: JournalHeader = object_of(&first[..first.len() - 1]).ok_or(NOT_A_JOURNAL)?;
        if let Some(difference) = found.difference(header) {
            return Err(format!("this is the journal of another check: {difference}"));
        }
        for (number, line) in (2..).zip(lines) {
            let corrupt = |what: &str| format!("line {number}: the journal is corrupt: {what}");
            let FinishedUnit { unit, counts } = object_of(&line[..line.len() - 1])
                .ok_or_else(|| corrupt("the checksum is wrong"))?;
            if unit >= header.units {
                return Err(corrupt("there is no such unit"));
            }
            match finished.entry(unit) {
                Entry::Vacant(entry) => {
                    entry.insert(counts);
                }
                Entry::Occupied(entry) if have_equal_counts(entry.get(), &counts) => {}
                Entry::Occupied(_) => {
                    return Err(corrupt("a unit occurs twice, with different counts"));
                }
            }
        }
        Ok(Self { finished, length })
    }
}

impl CheckJournal {
    /// Opens the journal of a check in a folder, or begins it. No other process can open it meanwhile.
    ///
    /// # Errors
    /// Returns an error if the file is not a journal, if it is of another check, corrupt or used by another
    /// process, or if it cannot be written. It is not changed then.
    pub(super) fn open(folder: &Path, header: &JournalHeader) -> Result<Self, CliError> {
        output::make_folder(folder)?;
        let path = folder.join(format!("{}-edges.journal", header.edges));
        let at = |cause: &dyn Display| CliError::in_file(&path, cause);
        let (mut file, bytes) = output::open_growing_alone(&path)?;
        let header_line = text_of(header).map_err(|error| at(&error))?;
        let JournalLines { finished, length } =
            JournalLines::read(&bytes, header, &header_line).map_err(|cause| at(&cause))?;
        file.set_len(length as u64).map_err(|error| at(&error))?;
        if length == 0 {
            file.write_all(header_line.as_bytes()).map_err(|error| at(&error))?;
        }
        Ok(Self::new(path, finished, file))
    }

    fn new(path: PathBuf, finished: BTreeMap<usize, PartTally>, file: fs::File) -> Self {
        Self { path, finished, file: Mutex::new(Ok(file)), is_broken: AtomicBool::new(false) }
    }

    /// A watch that also stops the check when the journal cannot be written.
    pub(super) fn watch<'a>(&'a self, other: &'a dyn Watch) -> JournalWatch<'a> {
        JournalWatch { journal: self, other }
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
        synced.map_err(|error| {
            let cause = format!(
                "the journal cannot be written: {error}. The same command continues the check from it"
            );
            CliError::in_file(&self.path, cause)
        })
    }
}

impl FinishedUnits for CheckJournal {
    fn finished(&self, unit: usize) -> Option<PartTally> {
        self.finished.get(&unit).cloned()
    }

    fn finish(&self, unit: usize, tally: &PartTally) {
        let line = text_of(&FinishedUnit { unit, counts: tally.clone() });
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        if let Ok(open) = file.as_mut()
            && let Err(error) = line.and_then(|line| open.write_all(line.as_bytes()))
        {
            *file = Err(error);
            self.is_broken.store(true, Ordering::Relaxed);
        }
    }
}

impl Watch for JournalWatch<'_> {
    fn parts(&self, count: usize) {
        self.other.parts(count);
    }

    fn part_done(&self, cases: u64) {
        self.other.part_done(cases);
    }

    fn stop(&self) -> bool {
        // Both are asked: after Ctrl-C, the other one has to know that the work will stop.
        self.other.stop() || self.journal.is_broken.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_check_stops_at_the_first_unit_that_cannot_be_written() {
        // This file is open for reading only.
        let path = PathBuf::from(file!());
        let journal =
            CheckJournal::new(path, BTreeMap::new(), fs::File::open("Cargo.toml").unwrap());
        let watch = journal.watch(&());
        assert!(!watch.stop());
        journal.finish(0, &PartTally::default());
        assert!(watch.stop());
        assert!(journal.close().is_err());
    }
}
