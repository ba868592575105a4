//! The journal of a check: the units that are finished, so that a check that was killed can go on.
//!
//! One file for each number of edges. Each line has the CRC-32 of its JSON object in hexadecimal, a space, and
//! the object. The first object describes the check. Each other one is a finished unit. Lines are only appended,
//! by one process at a time: the file is locked. The check stops at the first line that cannot be written.

use std::{
    collections::BTreeMap,
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

#[derive(Serialize, Deserialize)]
pub(super) struct JournalHeader {
    pub(super) journal: u32,
    pub(super) version: String,
    pub(super) class: String,
    pub(super) edges: usize,
    pub(super) marker: String,
    pub(super) algorithm: String,
    pub(super) shard: String,
    pub(super) units: usize,
}

impl JournalHeader {
    pub(super) const FORMAT: u32 = 1;

    fn difference(&self, other: &Self) -> Option<String> {
        let fields = |of: &Self| {
            [
                ("the format", of.journal.to_string()),
                ("the version", release(&of.version).to_owned()),
                ("the class", of.class.clone()),
                ("the number of edges", of.edges.to_string()),
                ("the marker", of.marker.clone()),
                ("the algorithm", of.algorithm.clone()),
                ("the shard", of.shard.clone()),
                ("the number of units", of.units.to_string()),
            ]
        };
        let mut pairs = fields(self).into_iter().zip(fields(other));
        let ((name, one), (_, other)) = pairs.find(|(one, other)| one != other)?;
        Some(format!("{name} is {one}, not {other}"))
    }
}

#[derive(Serialize, Deserialize)]
struct FinishedUnit {
    unit: usize,
    counts: PartTally,
}

pub(super) struct CheckJournal {
    path: PathBuf,
    finished: BTreeMap<usize, PartTally>,
    file: Mutex<Result<fs::File, io::Error>>,
    is_broken: AtomicBool,
}

/// Stops a check when another watch does, or when its journal cannot be written.
pub(super) struct JournalWatch<'a> {
    journal: &'a CheckJournal,
    other: &'a dyn Watch,
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

const NOT_A_JOURNAL: &str = "line 1: this is not the first line of a journal";

/// The finished units in the journal of a check, and the bytes of its whole lines. A line without an end was being
/// written when the check was killed.
fn finished_units(
    bytes: &[u8],
    header: &JournalHeader,
    header_line: &str,
) -> Result<(BTreeMap<usize, PartTally>, usize), String> {
    let length = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
    let mut finished = BTreeMap::new();
    let mut lines = bytes[..length].split_inclusive(|&byte| byte == b'\n');
    let Some(first) = lines.next() else {
        let is_beginning = header_line.as_bytes().starts_with(bytes);
        return is_beginning.then_some((finished, 0)).ok_or_else(|| NOT_A_JOURNAL.to_owned());
    };
    let found: JournalHeader = object_of(&first[..first.len() - 1]).ok_or(NOT_A_JOURNAL)?;
    if let Some(difference) = found.difference(header) {
        return Err(format!("this is the journal of another check: {difference}"));
    }
    for (number, line) in (2..).zip(lines) {
        let corrupt = |what: &str| format!("line {number}: the journal is corrupt: {what}");
        let FinishedUnit { unit, counts } =
            object_of(&line[..line.len() - 1]).ok_or_else(|| corrupt("the checksum is wrong"))?;
        if unit >= header.units {
            return Err(corrupt("there is no such unit"));
        }
        // Which of its starts is noted as the worst one depends on the other units that have run.
        let without_worst = |tally: &PartTally| PartTally { worst: None, ..tally.clone() };
        let known = finished.entry(unit).or_insert_with(|| counts.clone());
        if without_worst(known) != without_worst(&counts) {
            return Err(corrupt("a unit occurs twice, with different counts"));
        }
    }
    Ok((finished, length))
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
        let (finished, length) =
            finished_units(&bytes, header, &header_line).map_err(|cause| at(&cause))?;
        file.set_len(length as u64).map_err(|error| at(&error))?;
        if length == 0 {
            file.write_all(header_line.as_bytes()).map_err(|error| at(&error))?;
        }
        Ok(Self::new(path, finished, file))
    }

    fn new(path: PathBuf, finished: BTreeMap<usize, PartTally>, file: fs::File) -> Self {
        Self { path, finished, file: Mutex::new(Ok(file)), is_broken: AtomicBool::new(false) }
    }

    pub(super) fn watch<'a>(&'a self, other: &'a dyn Watch) -> JournalWatch<'a> {
        JournalWatch { journal: self, other }
    }

    pub(super) fn finished_before(&self) -> usize {
        self.finished.len()
    }

    /// Closes the journal, or returns the first error of writing.
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
