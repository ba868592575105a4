//! Errors in logs, with their offsets.

use std::io;

use serde::{Serialize, Serializer};
use thiserror::Error;
use toposlam_model::counts::grouped;

#[derive(Debug, Error)]
#[error("{}{cause}", self.place())]
pub struct LogError {
    /// The offset of the record or chunk in the file, in bytes, lines or rows.
    pub offset: u64,
    pub unit: OffsetUnit,
    /// The name of the file, if the log has several.
    pub file: Option<String>,
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
            | LogErrorKind::Encrypted(_)
            | LogErrorKind::Metadata { .. } => file,
            _ => format!("{file}{} {}: ", self.unit.name(), self.offset),
        }
    }
}

toposlam_model::words! {
    #[derive(Default)]
    OffsetUnit {
        #[default]
        Byte = "byte",
        Line = "line",
        Row = "row",
    }
}

#[derive(Debug, Error)]
pub enum LogErrorKind {
    #[error("cannot be read: {0}")]
    Unreadable(#[from] io::Error),
    #[error(
        "this is not a log; it must be a ROS 1 bag, an MCAP file, a rosbag2 folder or .db3 file, a CARMEN \
         log, or events as JSON lines or CSV"
    )]
    NotALog,
    #[error("this is a bag of version {0}; only version 2.0 can be read")]
    Version(String),
    #[error("the bag is encrypted ({0}): decrypt it first, with `rosbag decrypt`")]
    Encrypted(String),
    #[error("the record is malformed: {0}")]
    Malformed(&'static str),
    #[error("the compression {0:?} is not known; known are {1}")]
    Compression(String, &'static str),
    #[error(
        "{compressed} compressed bytes claim a size of {size}; the limit is a factor of {most}"
    )]
    Growth { compressed: u64, size: u64, most: u64 },
    #[error("the chunk cannot be decompressed: {0}")]
    Undecompressable(String),
    #[error("the chunk has {found} bytes and claims {claimed}")]
    Size { claimed: u64, found: u64 },
    #[error("the checksum of the {0} is wrong")]
    Checksum(&'static str),
    #[error("the index counts {indexed} messages, and there are {found}, or on other topics")]
    Count { indexed: u64, found: u64 },
    #[error("the index lists {listed} of the {all} chunks, or some of them twice")]
    ChunkIndex { listed: usize, all: usize },
    #[error("the time of a message is outside of the times of its chunk")]
    OutsideTimes,
    #[error("this folder has no metadata.yaml, and no .db3 or .mcap file")]
    NoBagFiles,
    #[error("line {line}: {what}")]
    Metadata { line: usize, what: String },
    #[error(
        "this is a .db3 file; this program was built without the feature `sqlite`, which reads them"
    )]
    NoDatabases,
    #[error("the database: {0}")]
    Database(String),
    #[error("the compressed database ends too early; a part of it cannot be read")]
    CutDatabase,
    #[error("{0}")]
    Line(String),
    #[error("the line is longer than {} bytes", grouped(*.0 as u128))]
    LongLine(usize),
    #[error("a message of connection {0}, which has no record")]
    UnknownConnection(u32),
    #[error("a message has an earlier time than its chunk")]
    TooOld,
    #[error("message {number}, on {topic}: {what}")]
    Content { number: u64, topic: String, what: String },
    /// The pose of a scanner on its robot is not known.
    #[error("message {number}, on {topic}: {what}")]
    Frame { number: u64, topic: String, what: String },
    #[error(
        "{first} (at least {} of {} messages on the topic cannot be used)",
        grouped((*count).into()),
        grouped((*all).into())
    )]
    Unusable { first: Box<LogErrorKind>, count: u64, all: u64 },
}

impl LogErrorKind {
    /// Whether the bytes of the log are wrong. Otherwise the file cannot be read, or is of a kind that is
    /// not read.
    pub fn is_damage(&self) -> bool {
        !matches!(
            self,
            Self::Unreadable(_)
                | Self::NotALog
                | Self::Version(_)
                | Self::Encrypted(_)
                | Self::Compression(..)
                | Self::NoDatabases
                | Self::NoBagFiles
        )
    }

    pub(super) fn at(self, offset: u64) -> LogError {
        LogError { offset, unit: OffsetUnit::Byte, file: None, cause: self }
    }
}

#[derive(Clone, Debug, PartialEq, Eq, Error, Serialize)]
#[error("{}truncated at {} {offset}: {cause}", file.as_ref().map_or(String::new(), |file| format!("{file}: ")), .unit.name())]
pub struct Truncation {
    pub offset: u64,
    #[serde(skip)]
    pub unit: OffsetUnit,
    /// The name of the file, if the log has several.
    #[serde(skip)]
    pub file: Option<String>,
    #[source]
    #[serde(serialize_with = "as_text")]
    pub cause: TruncationKind,
}

fn as_text<S: Serializer>(cause: &TruncationKind, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(cause)
}

#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum TruncationKind {
    #[error("it ends in the middle of a record")]
    RestOfRecord,
    #[error("its end is missing")]
    End,
    #[error("its compressed data end too early")]
    Compressed,
    #[error("it was not closed, and has no index")]
    Index,
    #[error("it was not closed, and its last record is malformed: {0}")]
    Malformed(&'static str),
    #[error("it ends there, and {} more bytes follow, perhaps of another log; they are not read", grouped((*bytes).into()))]
    Continued { bytes: u64 },
    #[error("its index lists {listed} chunks, and it has {found}: some are missing")]
    ChunksMissing { listed: usize, found: usize },
    #[error("its header counts {} pages, and it has {}: some are missing", grouped((*counted).into()), grouped((*found).into()))]
    PagesMissing { counted: u64, found: u64 },
}
