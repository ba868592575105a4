//! The checksums that a log stores of its parts.

use std::{fmt, io, ops::Range};

use crc32fast::Hasher;

use crate::log::{
    error::{LogError, LogErrorKind},
    source::Source,
};

/// A part of a log that has a checksum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CheckedPart {
    /// The decompressed records of a chunk.
    Chunk,
    /// An attachment of an MCAP file.
    Attachment,
    /// The data section of an MCAP file: everything before its summary.
    DataSection,
    /// The summary section of an MCAP file, with most of the footer.
    SummarySection,
}

impl fmt::Display for CheckedPart {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Chunk => "chunk",
            Self::Attachment => "attachment",
            Self::DataSection => "data section",
            Self::SummarySection => "summary section",
        })
    }
}

/// A CRC-32 of bytes as they stand in the file.
pub(in crate::log) struct StoredChecksum {
    /// The offset of the record in which it is stored.
    pub(super) offset: u64,
    pub(super) part: CheckedPart,
    pub(in crate::log) bytes: Range<u64>,
    pub(super) value: u32,
}

/// The number of bytes that are read at once.
const PIECE: u64 = 1 << 16;

impl StoredChecksum {
    /// Compares it with the bytes; `None` if they agree.
    pub(in crate::log) fn error(&self, source: &Source) -> io::Result<Option<LogError>> {
        let mut hasher = Hasher::new();
        let mut at = self.bytes.start;
        while at < self.bytes.end {
            let end = self.bytes.end.min(at + PIECE);
            hasher.update(&source.read(at..end)?);
            at = end;
        }
        let right = hasher.finalize() == self.value;
        Ok((!right).then(|| LogErrorKind::Checksum(self.part).at(self.offset)))
    }
}
