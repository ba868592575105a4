//! ROS 1 bags, version 2.0, as `rosbag` writes them (wiki.ros.org/Bags/Format/2.0).
//!
//! A record is the length of its header, the header, the length of its body and the body. A header is
//! fields `name=value`, each behind its length. Behind each chunk stand the records that index it; at
//! the end the connections are repeated, and where each chunk is.

use std::{collections::BTreeMap, ops::Range};

use super::{
    Compression, Failure, FileStructure, Listener, Record, Section, u32_at, u64_at, unreadable,
};
use crate::{
    error::{LogErrorKind, TruncationKind},
    source::{Source, Window},
};

pub(crate) const MAGIC: &[u8] = b"#ROSBAG V2.0\n";

const MESSAGE: u8 = 2;
const HEADER: u8 = 3;
const INDEX: u8 = 4;
const CHUNK: u8 = 5;
const CHUNK_INFO: u8 = 6;
const CONNECTION: u8 = 7;

#[derive(Clone, Copy)]
struct Fields<'a>(&'a [u8]);

impl<'a> Fields<'a> {
    fn get(self, name: &str) -> Option<&'a [u8]> {
        let mut rest = self.0;
        while let Some(length) = u32_at(rest, 0) {
            let end = 4_usize.checked_add(length as usize)?;
            let field = rest.get(4..end)?;
            rest = rest.get(end..)?;
            let equals = field.iter().position(|&byte| byte == b'=')?;
            if field.get(..equals)? == name.as_bytes() {
                return field.get(equals + 1..);
            }
        }
        None
    }

    fn u32(self, name: &str) -> Option<u32> {
        self.get(name).filter(|value| value.len() == 4).and_then(|value| u32_at(value, 0))
    }

    fn u64(self, name: &str) -> Option<u64> {
        self.get(name).filter(|value| value.len() == 8).and_then(|value| u64_at(value, 0))
    }

    fn op(self) -> Option<u8> {
        match self.get("op") {
            Some(&[op]) => Some(op),
            _ => None,
        }
    }
}

/// Seconds and nanoseconds, in nanoseconds.
fn time(bytes: &[u8]) -> Option<u64> {
    let [sec, nanosec] = [u32_at(bytes, 0)?, u32_at(bytes, 4)?].map(u64::from);
    Some(sec * 1_000_000_000 + nanosec)
}

const MESSAGE_HEADER: &str = "a message without conn and time";
const CONNECTION_HEADER: &str = "a connection without conn, topic, type and message_definition";

fn message(header: Fields<'_>) -> Result<(u32, u64), &'static str> {
    let found = header.u32("conn").zip(header.get("time").and_then(time));
    found.ok_or(MESSAGE_HEADER)
}

fn connection<'a>(header: Fields<'a>, body: Fields<'a>) -> Result<Record<'a>, &'static str> {
    let read = || {
        Some(Record::Connection {
            id: header.u32("conn")?,
            topic: header.get("topic")?,
            type_name: body.get("type")?,
            encoding: b"ros1",
            schema: b"ros1msg",
            definition: body.get("message_definition")?,
        })
    };
    read().ok_or(CONNECTION_HEADER)
}

pub(super) fn record(bytes: &[u8]) -> Result<(Record<'_>, usize), &'static str> {
    let read = || {
        let header_end = 4_usize.checked_add(u32_at(bytes, 0)? as usize)?;
        let header = bytes.get(4..header_end)?;
        let body = header_end + 4;
        let end = body.checked_add(u32_at(bytes, header_end)? as usize)?;
        bytes.get(body..end)?;
        Some((Fields(header), body..end))
    };
    let (header, body) = read().ok_or("it ends after its chunk")?;
    let length = body.end;
    Ok((
        match header.op().ok_or("its type is missing")? {
            MESSAGE => {
                let (connection, time) = message(header)?;
                Record::Message { connection, time, bytes: body }
            }
            CONNECTION => connection(header, Fields(bytes.get(body).unwrap_or_default()))?,
            _ => Record::Other,
        },
        length,
    ))
}

struct Head {
    index: u64,
    connections: u32,
    chunks: u32,
}

pub(super) fn scan(source: &Source, listener: &mut Listener<'_>) -> Result<FileStructure, Failure> {
    let mut scan = FileStructure::default();
    let mut window = Window::new(source);
    let mut at = MAGIC.len() as u64;
    let mut head = None;
    let [mut connections, mut chunks] = [0, 0];
    while at < source.length() {
        // Lengths that go beyond the end of the file.
        let Some((header, body)) = lengths(&mut window, at).map_err(unreadable(at))? else {
            return Ok(scan.truncated(at, TruncationKind::RestOfRecord));
        };
        match read_record(&mut window, at, header, body.clone(), &mut scan, listener) {
            Ok(CONNECTION) if head.as_ref().is_some_and(|head: &Head| at >= head.index) => {
                connections += 1;
            }
            Ok(CHUNK_INFO) => chunks += 1,
            Ok(HEADER) => head = head_of(&mut window, at).map_err(unreadable(at))?,
            Ok(_) => {}
            // A recorder that crashed has not written the length of its last chunk.
            Err(LogErrorKind::Malformed(what)) if matches!(head, Some(Head { index: 0, .. })) => {
                return Ok(scan.truncated(at, TruncationKind::Malformed(what)));
            }
            Err(cause) => return Err((cause, at)),
        }
        at = body.end;
    }
    let cause = match head {
        None => TruncationKind::End,
        Some(Head { index: 0, .. }) => TruncationKind::Index,
        Some(head) if head.connections != connections || head.chunks != chunks => {
            TruncationKind::End
        }
        Some(_) => {
            scan.end_loose();
            return Ok(scan);
        }
    };
    Ok(scan.truncated(at, cause))
}

/// The length of a record's header, and the place of its body; `None` if the file ends before it.
fn lengths(window: &mut Window<'_>, at: u64) -> std::io::Result<Option<(u32, Range<u64>)>> {
    let Some(header) = window.u32(at)? else { return Ok(None) };
    let header_end = at + 4 + u64::from(header);
    // The last byte of the file is asked for, so that no window is made for a length that lies.
    let Some(body) = window.u32(header_end)? else { return Ok(None) };
    let body = header_end + 4..header_end + 4 + u64::from(body);
    Ok(window.within(body.end).then_some((header, body)))
}

fn head_of(window: &mut Window<'_>, at: u64) -> std::io::Result<Option<Head>> {
    let Some(length) = window.u32(at)? else { return Ok(None) };
    let header = Fields(window.get(at + 4, length.into())?.unwrap_or_default());
    Ok(Some(Head {
        index: header.u64("index_pos").unwrap_or_default(),
        connections: header.u32("conn_count").unwrap_or_default(),
        chunks: header.u32("chunk_count").unwrap_or_default(),
    }))
}

/// Reads one record, and returns its type.
fn read_record(
    window: &mut Window<'_>,
    at: u64,
    header_length: u32,
    body: Range<u64>,
    scan: &mut FileStructure,
    listener: &mut Listener<'_>,
) -> Result<u8, LogErrorKind> {
    let header = Fields(window.get(at + 4, header_length.into())?.unwrap_or_default());
    let length = body.end - body.start;
    let op = header.op().ok_or(LogErrorKind::Malformed("its type is missing"))?;
    match op {
        HEADER => match header.get("encryptor").map(String::from_utf8_lossy) {
            Some(name) if !name.is_empty() && !name.ends_with("NoEncryptor") => {
                let name = name.escape_debug().to_string();
                return Err(LogErrorKind::Encrypted(name));
            }
            _ => {}
        },
        MESSAGE => {
            let message = message(header).map_err(LogErrorKind::Malformed)?;
            scan.add_loose(at..body.end, Some(message));
        }
        CONNECTION => {
            let start = header_length as usize + 8;
            let bytes = window.get(at, body.end - at)?.unwrap_or_default();
            let header = Fields(bytes.get(4..start - 4).unwrap_or_default());
            let fields = Fields(bytes.get(start..).unwrap_or_default());
            listener(&connection(header, fields).map_err(LogErrorKind::Malformed)?);
            scan.add_loose(at..body.end, None);
        }
        CHUNK => {
            scan.end_loose();
            let found = header.get("compression").zip(header.u32("size"));
            let missing = LogErrorKind::Malformed("a chunk without compression and size");
            let (compression, size) = found.ok_or(missing)?;
            let compression = Compression::of_bag(compression)?;
            let size = u64::from(size);
            if compression == Compression::None && size != length {
                let what = "an uncompressed chunk has another length than its header states";
                return Err(LogErrorKind::Malformed(what));
            }
            scan.sections.push(Section {
                bytes: body,
                compression,
                size,
                // Of an empty one there is no index.
                counts: (size == 0).then(BTreeMap::new),
                in_chunk: true,
                ..Section::loose(at)
            });
        }
        INDEX => {
            let found = header.u32("ver").zip(header.u32("conn"));
            let bytes = window.get(body.start, length)?.unwrap_or_default();
            if let (Some((1, connection)), Some(chunk)) = (found, scan.sections.last_mut()) {
                let counts = chunk.counts.get_or_insert_default();
                *counts.entry(connection).or_default() += length / 12;
                bytes.chunks_exact(12).filter_map(time).for_each(|time| chunk.add_time(time));
            }
        }
        _ => {}
    }
    Ok(op)
}
