//! MCAP files (mcap.dev/spec): a record has an opcode, a length and its content.

use std::{collections::BTreeMap, io, ops::Range};

use super::{
    Compression, Failure, FileStructure, Listener, Record, Section, u16_at, u32_at, u64_at,
    unreadable,
};
use crate::{
    error::{LogErrorKind, TruncationKind},
    source::{Source, Window},
};

pub(crate) const MAGIC: &[u8] = b"\x89MCAP0\r\n";

pub(super) const FOOTER: u8 = 2;
const SCHEMA: u8 = 3;
const CHANNEL: u8 = 4;
const MESSAGE: u8 = 5;
pub(super) const CHUNK: u8 = 6;
const MESSAGE_INDEX: u8 = 7;
pub(super) const CHUNK_INDEX: u8 = 8;
pub(super) const STATISTICS: u8 = 11;
pub(super) const DATA_END: u8 = 15;

const HEAD: usize = 9;
/// The fields before the bytes of a message: channel, sequence, and two times.
const MESSAGE_HEAD: usize = 22;

/// A text or a list of bytes behind its length, and where it ends.
fn text_at(bytes: &[u8], at: usize) -> Option<(&[u8], usize)> {
    let start = at.checked_add(4)?;
    let end = start.checked_add(u32_at(bytes, at)? as usize)?;
    Some((bytes.get(start..end)?, end))
}

fn message(content: &[u8]) -> Option<(u32, u64)> {
    Some((u16_at(content, 0)?.into(), u64_at(content, 6)?))
        .filter(|_| content.len() >= MESSAGE_HEAD)
}

fn schema(content: &[u8]) -> Option<Record<'_>> {
    let id = u16_at(content, 0)?;
    let (name, at) = text_at(content, 2)?;
    let (encoding, at) = text_at(content, at)?;
    let (text, _) = text_at(content, at)?;
    Some(Record::Schema { id, name, encoding, text })
}

fn channel(content: &[u8]) -> Option<Record<'_>> {
    let [id, schema] = [u16_at(content, 0)?, u16_at(content, 2)?];
    let (topic, at) = text_at(content, 4)?;
    let (encoding, _) = text_at(content, at)?;
    Some(Record::Channel { id, schema, topic, encoding })
}

pub(super) fn record(bytes: &[u8]) -> Result<(Record<'_>, usize), &'static str> {
    let read = || {
        let length = usize::try_from(u64_at(bytes, 1)?).ok()?;
        let end = HEAD.checked_add(length)?;
        Some((*bytes.first()?, bytes.get(HEAD..end)?, end))
    };
    let (op, content, end) = read().ok_or("it ends after its chunk")?;
    let record = match op {
        MESSAGE => message(content).map(|(connection, time)| Record::Message {
            connection,
            time,
            bytes: HEAD + MESSAGE_HEAD..end,
        }),
        SCHEMA => schema(content),
        CHANNEL => channel(content),
        _ => Some(Record::Other),
    };
    Ok((record.ok_or("it is shorter than its length field")?, end))
}

pub(super) fn scan(source: &Source, listener: &mut Listener<'_>) -> Result<FileStructure, Failure> {
    let mut scan = FileStructure::default();
    let mut window = Window::new(source);
    let mut at = MAGIC.len() as u64;
    let mut index = Index::default();
    loop {
        let Some((op, content)) = record_at(&mut window, at).map_err(unreadable(at))? else {
            let cause = if at == source.length() {
                TruncationKind::End
            } else {
                TruncationKind::RestOfRecord
            };
            return Ok(scan.truncated(at, cause));
        };
        let record = at..content.end;
        let taken =
            read_record(&mut window, op, &record, &content, &mut scan, listener, &mut index);
        taken.map_err(|cause| (cause, at))?;
        at = content.end;
        if op == FOOTER {
            break;
        }
    }
    let end = window.get(at, MAGIC.len() as u64).map_err(unreadable(at))?;
    if end != Some(MAGIC) {
        return Ok(scan.truncated(at, TruncationKind::End));
    }
    let end = at + MAGIC.len() as u64;
    if let Some(bytes @ 1..) = source.length().checked_sub(end) {
        return Ok(scan.truncated(end, TruncationKind::Continued { bytes }));
    }
    let found = scan.sections.iter().filter(|section| section.in_chunk).count();
    if let Some((place, listed)) = index.chunks.filter(|&(_, listed)| listed > found) {
        return Ok(scan.truncated(place, TruncationKind::ChunksMissing { listed, found }));
    }
    scan.end_loose();
    // An incomplete index is not used.
    let counts = scan.sections.iter().filter_map(|section| section.counts.as_ref());
    let counted: u64 = counts.flat_map(BTreeMap::values).fold(0, |sum, n| sum.saturating_add(*n));
    if index.messages.is_some_and(|total| total != counted) {
        for section in &mut scan.sections {
            section.counts = None;
        }
    }
    Ok(scan)
}

/// The type of the record at an offset, and where its content is; `None` if the file ends before it.
pub(super) fn record_at(window: &mut Window<'_>, at: u64) -> io::Result<Option<(u8, Range<u64>)>> {
    let head = window.get(at, HEAD as u64)?;
    let head = head.and_then(|head| Some((*head.first()?, u64_at(head, 1)?)));
    let start = at + HEAD as u64;
    let content = head.and_then(|(op, length)| Some((op, start..start.checked_add(length)?)));
    Ok(content.filter(|(_, content)| window.within(content.end)))
}

/// What a file has by its index.
#[derive(Default)]
struct Index {
    messages: Option<u64>,
    /// The number of chunks, and where they are listed.
    chunks: Option<(u64, usize)>,
}

/// Reads one record.
fn read_record(
    window: &mut Window<'_>,
    op: u8,
    record: &Range<u64>,
    content: &Range<u64>,
    scan: &mut FileStructure,
    listener: &mut Listener<'_>,
    index: &mut Index,
) -> Result<(), LogErrorKind> {
    let most = match op {
        MESSAGE => MESSAGE_HEAD as u64,
        SCHEMA | CHANNEL => u64::MAX,
        CHUNK => 1 << 10,
        MESSAGE_INDEX => 6,
        CHUNK_INDEX => 0,
        STATISTICS => 8,
        _ => return Ok(()),
    };
    let length = (content.end - content.start).min(most);
    let bytes = window.get(content.start, length)?.unwrap_or_default();
    match op {
        MESSAGE => scan.add_loose(record.clone(), Some(message(bytes).ok_or(SHORT)?)),
        SCHEMA | CHANNEL => {
            let definition = if op == SCHEMA { schema(bytes) } else { channel(bytes) };
            listener(&definition.ok_or(SHORT)?);
            scan.add_loose(record.clone(), None);
        }
        CHUNK => {
            scan.end_loose();
            scan.sections.push(chunk(record.start, content, bytes)?);
        }
        MESSAGE_INDEX => {
            let entry = u16_at(bytes, 0).zip(u32_at(bytes, 2));
            let (channel, length) = entry.ok_or(SHORT)?;
            if let Some(chunk) = scan.sections.last_mut() {
                let counts = chunk.counts.get_or_insert_default();
                *counts.entry(channel.into()).or_default() += u64::from(length) / 16;
            }
        }
        CHUNK_INDEX => index.chunks.get_or_insert((record.start, 0)).1 += 1,
        _ => index.messages = u64_at(bytes, 0),
    }
    Ok(())
}

const SHORT: LogErrorKind = LogErrorKind::Malformed("it is shorter than its length field");

/// The chunk that begins with some bytes.
fn chunk(offset: u64, content: &Range<u64>, bytes: &[u8]) -> Result<Section, LogErrorKind> {
    let number = |at| u64_at(bytes, at).ok_or(SHORT);
    let times = [number(0)?, number(8)?];
    let (size, checksum) = (number(16)?, u32_at(bytes, 24).ok_or(SHORT)?);
    // A longer name is of no known compression.
    let name_length = u32_at(bytes, 28).ok_or(SHORT)? as usize;
    let name = bytes.get(32..).map(|rest| rest.get(..name_length).unwrap_or(rest));
    let compression = Compression::of_mcap(name.ok_or(SHORT)?)?;
    let (_, at) = text_at(bytes, 28).ok_or(SHORT)?;
    let start = content.start + at as u64 + 8;
    let end = start.checked_add(number(at)?).filter(|end| *end <= content.end);
    Ok(Section {
        bytes: start..end.ok_or(SHORT)?,
        compression,
        size,
        checksum,
        // An end before the start is ignored.
        times: (size > 0 && times[0] <= times[1]).then_some(times),
        counts: (size == 0).then(BTreeMap::new),
        in_chunk: true,
        ..Section::loose(offset)
    })
}
