//! What an MCAP file stores about itself: checksums, and the number of its messages.

use std::{io, ops::Range};

use crc32fast::Hasher;

use super::{
    Failure,
    mcap::{CHUNK, CHUNK_INDEX, DATA_END, FOOTER, MAGIC, STATISTICS, record_at},
    u32_at, u64_at,
};
use crate::{
    error::LogErrorKind,
    source::{Source, Window},
};

const ATTACHMENT: u8 = 9;

#[derive(Default)]
pub(crate) struct SelfDescription {
    pub(crate) checksums: Vec<StoredChecksum>,
    pub(crate) messages: Option<(u64, u64)>,
    pub(crate) damage: Vec<Failure>,
}

pub(crate) fn describe(source: &Source) -> io::Result<SelfDescription> {
    let mut found = SelfDescription::default();
    let mut window = Window::new(source);
    let mut at = MAGIC.len() as u64;
    let mut data_end = None;
    let mut chunks = Vec::new();
    // Where the index begins, and the chunks that it lists.
    let mut index: Option<(u64, Vec<u64>)> = None;
    while let Some((op, Range { start: content, end })) = record_at(&mut window, at)? {
        let length = end - content;
        match op {
            // The checksum is at the end of the record, and covers the fields before it.
            ATTACHMENT if length >= 4 => {
                let covered = content..end - 4;
                let value = window.u32(covered.end)?.unwrap_or_default();
                found.add(at, "attachment", covered, value);
            }
            DATA_END if length >= 4 => {
                let value = window.u32(content)?.unwrap_or_default();
                found.add(at, "data section", 0..at, value);
                data_end = Some(end);
            }
            CHUNK => chunks.push(at),
            CHUNK_INDEX if length >= 24 => {
                let place = window.get(content, 24)?.and_then(|bytes| u64_at(bytes, 16));
                index.get_or_insert((at, Vec::new())).1.extend(place);
            }
            STATISTICS if length >= 8 => {
                let count = window.get(content, 8)?.and_then(|bytes| u64_at(bytes, 0));
                found.messages = count.map(|count| (at, count));
            }
            FOOTER => {
                let fields = window.get(content, length.min(20))?.unwrap_or_default();
                if let (Some(summary), Some(value)) = (u64_at(fields, 0), u32_at(fields, 16)) {
                    let start = if summary == 0 { at } else { summary };
                    let covered = start.min(content)..content + 16;
                    found.add(at, "summary section", covered, value);
                }
                let rest = end + MAGIC.len() as u64;
                if rest < source.length() {
                    let extra = "it stands after the end of the log";
                    found.damage.push((LogErrorKind::Malformed(extra), rest));
                }
                break;
            }
            _ => {}
        }
        at = end;
    }
    if let Some((at, mut listed)) = index {
        listed.sort_unstable();
        if listed != chunks {
            listed.dedup();
            let right = listed.iter().filter(|place| chunks.binary_search(place).is_ok());
            let cause = LogErrorKind::ChunkIndex { listed: right.count(), all: chunks.len() };
            found.damage.push((cause, at));
        }
    }
    if data_end.is_none() {
        let missing = "no record before it ends the data section";
        found.damage.push((LogErrorKind::Malformed(missing), at));
    }
    Ok(found)
}

impl SelfDescription {
    /// Adds a checksum. The value 0 means that there is none.
    fn add(&mut self, offset: u64, part: &'static str, bytes: Range<u64>, value: u32) {
        if value != 0 {
            self.checksums.push(StoredChecksum { offset, part, bytes, value });
        }
    }
}

pub(crate) struct StoredChecksum {
    offset: u64,
    part: &'static str,
    pub(crate) bytes: Range<u64>,
    value: u32,
}

const PIECE: u64 = 1 << 16;

impl StoredChecksum {
    pub(crate) fn error(&self, source: &Source) -> io::Result<Option<Failure>> {
        let mut hasher = Hasher::new();
        let mut at = self.bytes.start;
        while at < self.bytes.end {
            let end = self.bytes.end.min(at + PIECE);
            hasher.update(&source.read(at..end)?);
            at = end;
        }
        let right = hasher.finalize() == self.value;
        Ok((!right).then_some((LogErrorKind::Checksum(self.part), self.offset)))
    }
}
