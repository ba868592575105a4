//! The containers of logs. ROS 1 bags and MCAP files consist of records, most of them in chunks; other logs consist of
//! lines or rows.
//!
//! Each is first looked through from record to record, without its index, for a list of sections: chunks, and
//! stretches of messages outside of chunks.

mod bag;
mod clock;
mod compression;
mod database;
mod mcap;
mod mcap_end;
mod text;

use std::{collections::BTreeMap, io, ops::Range};

pub(super) use bag::MAGIC as BAG_MAGIC;
use clock::{Clock, TimedLine};
pub use compression::MOST_GROWTH;
use compression::{Compression, ZSTANDARD, decompress, decompress_message};
pub(super) use database::Database;
pub(super) use mcap::MAGIC as MCAP_MAGIC;
pub(super) use mcap_end::describe;
pub(super) use text::{EVENT, HEAD as TEXT_HEAD, TextState, recognise};

use super::{
    error::{LogError, LogErrorKind, OffsetUnit, TruncationKind},
    source::Source,
};

toposlam_model::words! {
    Format {
        Bag = "bag",
        Mcap = "mcap",
        Carmen = "carmen",
        Events = "events",
        Database = "db3",
        Folder = "rosbag2",
    }
}

impl Format {
    pub(super) fn unit(self) -> OffsetUnit {
        match self {
            Self::Bag | Self::Mcap | Self::Folder => OffsetUnit::Byte,
            Self::Carmen | Self::Events => OffsetUnit::Line,
            Self::Database => OffsetUnit::Row,
        }
    }
}

/// One file of a log; it has a name if the log has several.
pub(super) struct LogFile {
    pub(super) name: Option<String>,
    pub(super) format: Format,
    pub(super) source: Source,
    pub(super) database: Option<Database>,
    pub(super) text: TextState,
}

impl LogFile {
    pub(super) fn error(&self, cause: LogErrorKind, offset: u64) -> LogError {
        LogError { offset, unit: self.format.unit(), file: self.name.clone(), cause }
    }

    /// The bytes of a message. rosbag2 may compress each; CDR never begins as a compressed message does.
    pub(super) fn message(&self, bytes: Vec<u8>) -> Result<Vec<u8>, LogErrorKind> {
        let is_rosbag2 = self.name.is_some() || self.database.is_some();
        if is_rosbag2 && bytes.starts_with(ZSTANDARD) {
            return decompress_message(&bytes);
        }
        Ok(bytes)
    }
}

pub(super) enum Record<'a> {
    Message {
        connection: u32,
        time: u64,
        bytes: Range<usize>,
    },
    /// A topic, the encoding of its messages, and their definition in the language of a schema.
    Connection {
        id: u32,
        topic: &'a [u8],
        type_name: &'a [u8],
        encoding: &'a [u8],
        schema: &'a [u8],
        definition: &'a [u8],
    },
    Schema {
        id: u16,
        name: &'a [u8],
        encoding: &'a [u8],
        text: &'a [u8],
    },
    Channel {
        id: u16,
        schema: u16,
        topic: &'a [u8],
        encoding: &'a [u8],
    },
    Other,
}

/// A chunk, or a stretch of the file outside of chunks; sections do not overlap, and stand in the order
/// of the file.
#[derive(Clone, Debug)]
pub(super) struct Section {
    pub(super) file: usize,
    pub(super) offset: u64,
    bytes: Range<u64>,
    compression: Compression,
    size: u64,
    /// The checksum of the decompressed bytes; 0: unknown.
    checksum: u32,
    pub(super) times: Option<[u64; 2]>,
    /// The number of messages of each connection, if known.
    pub(super) counts: Option<BTreeMap<u32, u64>>,
    in_chunk: bool,
    /// Of a log of lines: the number of its first line, and the clock before it.
    text: Option<(u64, Clock)>,
}

#[derive(Default)]
pub(super) struct FileStructure {
    pub(super) sections: Vec<Section>,
    /// Where the file ends too early, and why.
    pub(super) truncation: Option<(u64, TruncationKind)>,
    loose: Option<Section>,
}

/// Receives the records of topics, each once or several times.
pub(super) type Listener<'l> = dyn FnMut(&Record<'_>) + 'l;

pub(super) fn scan(
    file: &LogFile,
    listener: &mut Listener<'_>,
) -> Result<(FileStructure, TextState), LogError> {
    let LogFile { format, source, database, .. } = file;
    let wrong = |(cause, offset)| file.error(cause, offset);
    let scan = match (format, database) {
        (Format::Bag, _) => bag::scan(source, listener),
        (Format::Mcap, _) => mcap::scan(source, listener),
        (Format::Carmen | Format::Events, _) => {
            return text::scan(*format, source, listener).map_err(wrong);
        }
        (Format::Database | Format::Folder, Some(database)) => database.scan(listener),
        (Format::Database | Format::Folder, None) => Ok(FileStructure::default()),
    };
    Ok((scan.map_err(wrong)?, TextState::default()))
}

/// An error and its offset in a file.
type Failure = (LogErrorKind, u64);

/// The largest size of a section outside of chunks.
const LOOSE: u64 = 1 << 20;

impl FileStructure {
    fn add_loose(&mut self, record: Range<u64>, message: Option<(u32, u64)>) {
        let fits = |section: &Section| {
            section.bytes.end == record.start && record.end - section.offset <= LOOSE
        };
        if self.loose.as_ref().is_some_and(|section| !fits(section)) {
            self.end_loose();
        }
        let section = self.loose.get_or_insert_with(|| Section::loose(record.start));
        section.extend(record.end, message);
    }

    fn end_loose(&mut self) {
        self.sections.extend(self.loose.take().filter(|section| section.times.is_some()));
    }

    fn truncated(mut self, offset: u64, cause: TruncationKind) -> Self {
        self.end_loose();
        // Some of its index may be missing.
        if let Some(last) = self.sections.last_mut() {
            last.counts = None;
        }
        self.truncation = Some((offset, cause));
        self
    }
}

impl Section {
    fn loose(start: u64) -> Self {
        Self {
            file: 0,
            offset: start,
            bytes: start..start,
            compression: Compression::None,
            size: 0,
            checksum: 0,
            times: None,
            counts: Some(BTreeMap::new()),
            in_chunk: false,
            text: None,
        }
    }

    fn extend(&mut self, end: u64, message: Option<(u32, u64)>) {
        self.bytes.end = end;
        self.size = self.bytes.end - self.bytes.start;
        let Some((connection, time)) = message else { return };
        self.add_time(time);
        if let Some(counts) = &mut self.counts {
            *counts.entry(connection).or_default() += 1;
        }
    }

    fn add_time(&mut self, time: u64) {
        let [first, last] = self.times.unwrap_or([time; 2]);
        self.times = Some([first.min(time), last.max(time)]);
    }

    /// Its records, decompressed.
    ///
    /// Takes at most [`MOST_GROWTH`] bytes for each byte that it has in the file, and 16 MiB besides.
    pub(super) fn load(&self, file: &LogFile) -> Result<Vec<u8>, LogError> {
        let wrong = |cause: LogErrorKind| file.error(cause, self.first());
        if let Some(database) = &file.database {
            return database.load(self.bytes.clone()).map_err(wrong);
        }
        let bytes = file.source.read(self.bytes.clone()).map_err(|error| wrong(error.into()))?;
        decompress(self.compression, bytes, self.size, self.checksum).map_err(wrong)
    }

    pub(super) fn first(&self) -> u64 {
        self.text.map_or(self.offset, |(line, _)| line)
    }

    /// Whether it is a chunk, and not a stretch of the file outside of chunks.
    pub(super) fn is_chunk(&self) -> bool {
        self.in_chunk
    }

    /// The bytes in the file that a checksum of its own covers, of the records or of their compression.
    pub(super) fn covered(&self, file: &LogFile) -> Result<Option<Range<u64>>, LogError> {
        let Range { start, end } = self.bytes;
        let source = &file.source;
        if file.database.is_some() {
            return Ok(None);
        }
        let head = source.read(start..end.min(start.saturating_add(5)));
        let head = head.map_err(|error| file.error(error.into(), start))?;
        let covers = self.checksum != 0 || self.compression.has_checksum(&head);
        Ok(covers.then(|| self.bytes.clone()))
    }

    pub(super) fn size(&self) -> u64 {
        self.size
    }

    /// The offset in the file of a byte of its records; of the section if it is compressed.
    fn place(&self, at: usize) -> u64 {
        match self.compression {
            Compression::None => self.bytes.start + at as u64,
            _ => self.offset,
        }
    }

    pub(super) fn records<'a>(
        &'a self,
        file: &'a LogFile,
        bytes: &'a [u8],
    ) -> impl Iterator<Item = Result<PlacedRecord<'a>, LogError>> {
        let mut at = 0;
        let mut text = self.text;
        std::iter::from_fn(move || {
            let rest = bytes.get(at..).filter(|rest| !rest.is_empty())?;
            let start = at;
            let mut place = self.place(start);
            let read = match (file.format, &mut text) {
                (Format::Bag, _) => bag::record(rest),
                (Format::Mcap, _) => mcap::record(rest),
                (Format::Carmen | Format::Events, Some((line, clock))) => {
                    place = *line;
                    *line += 1;
                    Ok(text::record(file.format, &file.text, clock, rest))
                }
                (Format::Database, _) => match database::row(rest) {
                    Some((number, record, length)) => {
                        place = number;
                        Ok((record, length))
                    }
                    None => Err("a row is not whole"),
                },
                (Format::Carmen | Format::Events | Format::Folder, _) => return None,
            };
            Some(match read {
                Ok((record, length)) => {
                    at = at.saturating_add(length);
                    Ok(PlacedRecord { at: start, place, record })
                }
                Err(what) => {
                    at = usize::MAX;
                    Err(file.error(LogErrorKind::Malformed(what), place))
                }
            })
        })
    }
}

pub(super) struct PlacedRecord<'a> {
    pub(super) at: usize,
    /// Its offset in the file: see [`LogError::offset`].
    pub(super) place: u64,
    pub(super) record: Record<'a>,
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..at.checked_add(4)?)?.try_into().ok().map(u32::from_le_bytes)
}

fn u64_at(bytes: &[u8], at: usize) -> Option<u64> {
    bytes.get(at..at.checked_add(8)?)?.try_into().ok().map(u64::from_le_bytes)
}

fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    bytes.get(at..at.checked_add(2)?)?.try_into().ok().map(u16::from_le_bytes)
}

fn unreadable(offset: u64) -> impl Fn(io::Error) -> Failure {
    move |error| (error.into(), offset)
}
