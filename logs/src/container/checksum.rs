//! The checksums that a log stores of its parts.

use std::{io, ops::Range};

use crc32fast::Hasher;

use crate::{
    error::{CheckedPart, LogError, LogErrorKind},
    source::Source,
};

/// A CRC-32 of bytes as they stand in the file.
pub(crate) struct StoredChecksum {
    /// The offset of the record in which it is stored.
    pub(super) offset: u64,
    pub(super) part: CheckedPart,
    pub(crate) bytes: Range<u64>,
    pub(super) value: u32,
}

/// The number of bytes that are read at once.
const PIECE: u64 = 1 << 16;

impl StoredChecksum {
    /// Compares it with the bytes; `None` if they agree.
    pub(crate) fn error(&self, source: &Source) -> io::Result<Option<LogError>> {
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
