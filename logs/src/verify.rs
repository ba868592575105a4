//! Reads all of a log, and compares it with its checksums and its index.
//!
//! What no checksum covers is checked for its structure only: `docs/logs.md` lists it.

use std::{collections::BTreeMap, ops::Range};

use toposlam_model::enumerate::Watch;

use super::{
    container::{self, Format, LogFile, PlacedRecord, Record, Section, describe},
    error::{LogError, LogErrorKind, TruncationKind},
    reader::Log,
    topic::Topics,
};

#[derive(Debug, Default)]
pub struct Verification {
    pub chunks: u64,
    pub messages: u64,
    pub covered: u64,
    pub damage: Vec<LogError>,
    /// Whether everything was read: the watch did not stop it.
    pub complete: bool,
}

impl Log {
    /// Reads all of the log: decompresses each chunk, reads its records, and compares them with the
    /// index and with every checksum in the file. Messages are not decoded.
    ///
    /// Takes as much memory as [`Log::new`].
    ///
    /// # Errors
    /// Returns an error if the file cannot be read. Damage is not an error, but part of the result.
    pub fn verify(&self, watch: &dyn Watch) -> Result<Verification, LogError> {
        let mut verifier = Verifier {
            log: self,
            topics: Topics::default(),
            covered: Vec::new(),
            found: Verification::default(),
        };
        verifier.run(watch)?;
        let Verifier { covered, mut found, .. } = verifier;
        found.covered = total(covered);
        found.damage.sort_by_key(|error| error.offset);
        Ok(found)
    }
}

struct Verifier<'l> {
    log: &'l Log,
    topics: Topics,
    /// The bytes of each file that a checksum covers; they may overlap.
    covered: Vec<(usize, Range<u64>)>,
    found: Verification,
}

impl Verifier<'_> {
    fn run(&mut self, watch: &dyn Watch) -> Result<(), LogError> {
        for (index, file) in self.log.files.iter().enumerate() {
            let topics = self.topics.in_file(index);
            let (scan, _) = container::scan(file, &mut |record| topics.add_record(record))?;
            watch.parts(scan.sections.len());
            let before = self.found.messages;
            for mut section in scan.sections {
                if watch.stop() {
                    return Ok(());
                }
                section.file = index;
                self.section(&section, file)?;
                watch.part_done(1);
            }
            let is_cut = scan.truncation.is_some_and(|(_, cause)| {
                matches!(cause, TruncationKind::RestOfRecord | TruncationKind::End)
            });
            if file.format == Format::Mcap && !is_cut {
                self.mcap_end(file, before)?;
            }
        }
        self.found.complete = true;
        Ok(())
    }

    fn section(&mut self, section: &Section, file: &LogFile) -> Result<(), LogError> {
        let bytes = match section.load(file) {
            Ok(bytes) => bytes,
            Err(error) if error.cause.is_damage() => {
                self.found.damage.push(error);
                return Ok(());
            }
            Err(error) => return Err(error),
        };
        self.found.chunks += u64::from(section.is_chunk());
        let covered = section.covered(file)?;
        self.covered.extend(covered.map(|range| (section.file, range)));
        let mut counts: BTreeMap<u32, u64> = BTreeMap::new();
        for read in section.records(file, &bytes) {
            let PlacedRecord { place, record, .. } = match read {
                Ok(read) => read,
                Err(error) => {
                    self.found.damage.push(error);
                    return Ok(());
                }
            };
            self.topics.add_record(&record);
            let Record::Message { connection, time, .. } = record else { continue };
            self.found.messages += 1;
            *counts.entry(connection).or_default() += 1;
            let wrong = if !self.topics.connections.contains_key(&(section.file, connection)) {
                LogErrorKind::UnknownConnection(connection)
            } else if section.times.is_some_and(|[first, last]| time < first || time > last) {
                LogErrorKind::OutsideTimes
            } else {
                continue;
            };
            self.found.damage.push(file.error(wrong, place));
            return Ok(());
        }
        // An index need not list the topics without a message.
        let indexed = section.counts.as_ref().map(|counts| counts.values().sum());
        let found = counts.values().sum();
        let differs = section.counts.as_ref().is_some_and(|indexed| {
            indexed.iter().filter(|(_, count)| **count > 0).ne(counts.iter())
        });
        if let Some(indexed) = indexed.filter(|_| differs) {
            self.found
                .damage
                .push(file.error(LogErrorKind::Count { indexed, found }, section.first()));
        }
        Ok(())
    }

    /// The checksums of an MCAP file outside of its chunks, and its statistics.
    fn mcap_end(&mut self, file: &LogFile, before: u64) -> Result<(), LogError> {
        let source = &file.source;
        let unreadable = |error| file.error(LogErrorKind::Unreadable(error), 0);
        let placed = |(cause, offset)| file.error(cause, offset);
        let description = describe(source).map_err(unreadable)?;
        for checksum in description.checksums {
            let error = checksum.error(source).map_err(unreadable)?;
            self.found.damage.extend(error.map(placed));
            self.covered.push((self.topics.present_file(), checksum.bytes));
        }
        let whole = self.found.damage.is_empty();
        self.found.damage.extend(description.damage.into_iter().map(placed));
        let found = self.found.messages - before;
        if let Some((offset, indexed)) = description.messages
            && whole
            && indexed != found
        {
            self.found.damage.push(file.error(LogErrorKind::Count { indexed, found }, offset));
        }
        Ok(())
    }
}

/// The number of bytes in ranges of several files, which may overlap.
fn total(mut ranges: Vec<(usize, Range<u64>)>) -> u64 {
    ranges.sort_by_key(|(file, range)| (*file, range.start));
    let (mut sum, mut reached) = (0, (0, 0));
    for (file, Range { start, end }) in ranges {
        let until = if reached.0 == file { reached.1 } else { 0 };
        sum += end.saturating_sub(start.max(until));
        reached = (file, until.max(end));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_that_two_checksums_cover_count_once() {
        let ranges = [(0, 20..30), (0, 0..10), (1, 0..4), (0, 5..12), (0, 6..7)];
        assert_eq!(total(ranges.into()), 26);
        assert_eq!(total(Vec::new()), 0);
    }
}
