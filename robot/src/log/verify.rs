//! Reads all of a log, and compares it with its checksums and its index.
//!
//! What no checksum covers is checked for its structure only: `docs/logs.md` lists it.

use std::{collections::BTreeMap, ops::Range};

use toposlam_model::enumerate::Watch;

use super::{
    container::{self, Format, Record, Section, describe},
    error::{LogError, LogErrorKind},
    reader::Log,
    topic::Topics,
};

/// What was read of a log, and what is wrong with it.
#[derive(Debug, Default)]
pub struct Verification {
    /// The number of chunks that were read.
    pub chunks: u64,
    /// The number of messages that were read.
    pub messages: u64,
    /// The number of bytes of the file that a checksum covers.
    pub covered: u64,
    /// What is damaged.
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
    /// The bytes that a checksum covers; they may overlap.
    covered: Vec<Range<u64>>,
    found: Verification,
}

impl Verifier<'_> {
    fn run(&mut self, watch: &dyn Watch) -> Result<(), LogError> {
        let (format, source) = (self.log.format, &self.log.source);
        let scan = container::scan(format, source, &mut |record| self.topics.add_record(record))?;
        watch.parts(scan.sections.len());
        for section in &scan.sections {
            if watch.stop() {
                return Ok(());
            }
            self.section(section)?;
            watch.part_done(1);
        }
        if format == Format::Mcap && scan.truncation.is_none() {
            self.mcap_end()?;
        }
        self.found.complete = true;
        Ok(())
    }

    /// Reads a chunk, or messages outside of chunks.
    fn section(&mut self, section: &Section) -> Result<(), LogError> {
        let bytes = match section.load(&self.log.source) {
            Ok(bytes) => bytes,
            Err(error) if error.cause.is_damage() => {
                self.found.damage.push(error);
                return Ok(());
            }
            Err(error) => return Err(error),
        };
        self.found.chunks += u64::from(section.is_chunk());
        self.covered.extend(section.covered(&self.log.source)?);
        let mut counts: BTreeMap<u32, u64> = BTreeMap::new();
        for read in section.records(self.log.format, &bytes) {
            let (at, record) = match read {
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
            let wrong = if !self.topics.connections.contains_key(&connection) {
                LogErrorKind::UnknownConnection(connection)
            } else if section.times.is_some_and(|[first, last]| time < first || time > last) {
                LogErrorKind::OutsideTimes
            } else {
                continue;
            };
            self.found.damage.push(wrong.at(section.place(at)));
            return Ok(());
        }
        // An index need not list the topics without a message.
        let indexed = section.counts.as_ref().map(|counts| counts.values().sum());
        let found = counts.values().sum();
        let differs = section.counts.as_ref().is_some_and(|indexed| {
            indexed.iter().filter(|(_, count)| **count > 0).ne(counts.iter())
        });
        if let Some(indexed) = indexed.filter(|_| differs) {
            self.found.damage.push(LogErrorKind::Count { indexed, found }.at(section.offset));
        }
        Ok(())
    }

    /// The checksums of an MCAP file outside of its chunks, and its statistics.
    fn mcap_end(&mut self) -> Result<(), LogError> {
        let source = &self.log.source;
        let wrong = |error| LogErrorKind::Unreadable(error).at(0);
        let description = describe(source).map_err(wrong)?;
        for checksum in description.checksums {
            self.found.damage.extend(checksum.error(source).map_err(wrong)?);
            self.covered.push(checksum.bytes);
        }
        let whole = self.found.damage.is_empty();
        self.found.damage.extend(description.damage);
        let found = self.found.messages;
        match description.messages {
            Some((offset, indexed)) if whole && indexed != found => {
                self.found.damage.push(LogErrorKind::Count { indexed, found }.at(offset));
            }
            _ => {}
        }
        Ok(())
    }
}

/// The number of bytes in ranges that may overlap.
fn total(mut ranges: Vec<Range<u64>>) -> u64 {
    ranges.sort_by_key(|range| range.start);
    let (mut sum, mut reached) = (0, 0);
    for Range { start, end } in ranges {
        sum += end.saturating_sub(start.max(reached));
        reached = reached.max(end);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_that_two_checksums_cover_count_once() {
        assert_eq!(total(vec![20..30, 0..10, 5..12, 6..7]), 22);
        assert_eq!(total(Vec::new()), 0);
    }
}
