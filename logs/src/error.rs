//! Errors in logs, with their offsets.

use std::{fmt, io};

use serde::{Serialize, Serializer, ser::SerializeStruct};
use thiserror::Error;
use toposlam_model::counts::grouped;

use super::decode::DecodeError;

/// Why a log cannot be read, or not further.
#[derive(Debug, Error)]
#[error("{}{cause}", self.place())]
pub struct LogError {
    /// The offset of the record or chunk in the file, in bytes, lines or rows.
    pub offset: u64,
    /// What the offset counts.
    pub unit: OffsetUnit,
    /// The name of the file, if the log has several.
    pub file: Option<String>,
    /// The error.
    #[source]
    pub cause: LogErrorKind,
}

impl LogError {
    /// The place for the message. A file that cannot be read has no offset.
    fn place(&self) -> String {
        let file = self.file.as_ref().map_or(String::new(), |file| format!("{file}: "));
        match self.cause {
            LogErrorKind::Unreadable(_)
            | LogErrorKind::NoBagFiles
            | LogErrorKind::NoDatabases
            | LogErrorKind::Metadata { .. } => file,
            _ => format!("{file}{} {}: ", self.unit.name(), self.offset),
        }
    }
}

/// What the offsets in a file count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OffsetUnit {
    /// Bytes, from 0.
    #[default]
    Byte,
    /// Lines, from 1.
    Line,
    /// Rows of the table of messages, by their number in the database.
    Row,
}

impl OffsetUnit {
    /// Its name in messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Byte => "byte",
            Self::Line => "line",
            Self::Row => "row",
        }
    }
}

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

/// The kind of an error in a log.
#[derive(Debug, Error)]
pub enum LogErrorKind {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] io::Error),
    /// The file is not a log.
    #[error(
        "this is not a log; it must be a ROS 1 bag, an MCAP file, a rosbag2 folder or .db3 file, a CARMEN \
         log, or events as JSON lines or CSV"
    )]
    NotALog,
    /// The bag has another version.
    #[error("this is a bag of version {0}; only version 2.0 can be read")]
    Version(String),
    /// A record is malformed.
    #[error("the record is malformed: {0}")]
    Malformed(&'static str),
    /// The compression of a chunk is not known.
    #[error("the compression {0:?} is not known; known are {1}")]
    Compression(String, &'static str),
    /// A chunk claims to be too large.
    #[error(
        "{compressed} compressed bytes claim a size of {size}; the limit is a factor of {most}"
    )]
    Growth {
        /// Its compressed size, in bytes.
        compressed: u64,
        /// The claimed size, in bytes.
        size: u64,
        /// The largest factor that is accepted.
        most: u64,
    },
    /// A chunk cannot be decompressed.
    #[error("the chunk cannot be decompressed: {0}")]
    Undecompressable(String),
    /// The size of a chunk is wrong.
    #[error("the chunk has {found} bytes and claims {claimed}")]
    Size {
        /// The claimed size.
        claimed: u64,
        /// The size found; one more than claimed if it is too long.
        found: u64,
    },
    /// A checksum is wrong.
    #[error("the checksum of the {0} is wrong")]
    Checksum(CheckedPart),
    /// The index counts other messages than there are.
    #[error("the index counts {indexed} messages, and there are {found}, or on other topics")]
    Count {
        /// The number of messages by the index.
        indexed: u64,
        /// The number of messages found.
        found: u64,
    },
    /// A message lies outside of the times of its chunk.
    #[error("the time of a message is outside of the times of its chunk")]
    OutsideTimes,
    /// A folder has no files of rosbag2.
    #[error("this folder has no metadata.yaml, and no .db3 or .mcap file")]
    NoBagFiles,
    /// The metadata of a folder are not as they should be.
    #[error("line {line}: {what}")]
    Metadata {
        /// The line.
        line: usize,
        /// What is wrong there.
        what: String,
    },
    /// Databases cannot be read.
    #[error(
        "this is a .db3 file; this program was built without the feature `sqlite`, which reads them"
    )]
    NoDatabases,
    /// A database cannot be read.
    #[error("the database: {0}")]
    Database(String),
    /// The end of a compressed database is missing. A part of a database cannot be read.
    #[error("the compressed database ends too early; a part of it cannot be read")]
    CutDatabase,
    /// A line is not as it should be.
    #[error("{0}")]
    Line(String),
    /// A line is too long.
    #[error("the line is longer than {} bytes", grouped(*.0 as u128))]
    LongLine(usize),
    /// The clock of a log of lines jumps, and stays there.
    #[error("the clock jumps from {from:.3} s to {to:.3} s, and stays there")]
    ClockJump {
        /// The time before, in seconds.
        from: f64,
        /// The time of the line, in seconds.
        to: f64,
    },
    /// The topic of a message is unknown.
    #[error("a message of connection {0}, which has no record")]
    UnknownConnection(u32),
    /// A message has an earlier time than its chunk.
    #[error("a message has an earlier time than its chunk")]
    TooOld,
    /// A message does not match its definition.
    #[error("message {number}, on {topic}: {error}")]
    Message {
        /// Its number in the log, counted from 1.
        number: u64,
        /// Its topic.
        topic: String,
        /// The error.
        error: Box<DecodeError>,
    },
    /// A message lacks what its role needs.
    #[error("message {number}, on {topic}: {what}")]
    Content {
        /// Its number in the log, counted from 1.
        number: u64,
        /// Its topic.
        topic: String,
        /// What is missing or wrong.
        what: String,
    },
}

impl LogErrorKind {
    /// Whether the bytes of the log are wrong. Otherwise the file cannot be read, or is of a kind that is
    /// not read.
    #[must_use]
    pub fn is_damage(&self) -> bool {
        !matches!(
            self,
            Self::Unreadable(_)
                | Self::NotALog
                | Self::Version(_)
                | Self::Compression(..)
                | Self::NoDatabases
                | Self::NoBagFiles
        )
    }

    pub(super) fn at(self, offset: u64) -> LogError {
        LogError { offset, unit: OffsetUnit::Byte, file: None, cause: self }
    }
}

/// Where a log is truncated.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{}truncated at {} {offset}: {cause}", file.as_ref().map_or(String::new(), |file| format!("{file}: ")), .unit.name())]
pub struct Truncation {
    /// The offset up to which it can be read.
    pub offset: u64,
    /// What the offset counts.
    pub unit: OffsetUnit,
    /// The name of the file, if the log has several.
    pub file: Option<String>,
    /// What is missing.
    #[source]
    pub cause: TruncationKind,
}

/// The offset and the cause.
impl Serialize for Truncation {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = serializer.serialize_struct("Truncation", 2)?;
        fields.serialize_field("offset", &self.offset)?;
        fields.serialize_field("cause", &self.cause.to_string())?;
        fields.end()
    }
}

impl Truncation {
    pub(super) fn at_byte(offset: u64, cause: TruncationKind) -> Self {
        Self { offset, unit: OffsetUnit::Byte, file: None, cause }
    }
}

/// What is missing at the end of a log.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum TruncationKind {
    /// The rest of a record.
    #[error("it ends in the middle of a record")]
    RestOfRecord,
    /// The end of the file.
    #[error("its end is missing")]
    End,
    /// The end of the compressed data.
    #[error("its compressed data end too early")]
    Compressed,
    /// The index: the log was not closed.
    #[error("it was not closed, and has no index")]
    Index,
    /// The rest of a record: the log was not closed.
    #[error("it was not closed, and its last record is malformed: {0}")]
    Malformed(&'static str),
}
