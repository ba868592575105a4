//! The rows of a database in memory: a head of 24 bytes, and the message.

use super::{Record, u32_at, u64_at};

const HEAD: usize = 24;

/// Appends a row.
#[cfg(feature = "sqlite")]
pub(super) fn put_row(bytes: &mut Vec<u8>, id: u64, topic: u32, time: u64, data: &[u8]) {
    bytes.extend(id.to_le_bytes());
    bytes.extend(time.to_le_bytes());
    bytes.extend(topic.to_le_bytes());
    bytes.extend((data.len() as u32).to_le_bytes());
    bytes.extend(data);
}

/// The first row of some bytes with its number, and how long it is.
pub(super) fn row(bytes: &[u8]) -> Option<(u64, Record<'_>, usize)> {
    let end = HEAD + u32_at(bytes, 20)? as usize;
    bytes.get(HEAD..end)?;
    let record = Record::Message {
        connection: u32_at(bytes, 16)?,
        time: u64_at(bytes, 8)?,
        bytes: HEAD..end,
    };
    Some((u64_at(bytes, 0)?, record, end))
}
