//! What can be wrong with a log, and where.

use std::io;

use thiserror::Error;

use super::decode::DecodeError;

/// Why a log cannot be read, or not any further.
#[derive(Debug, Error)]
#[error("{}{cause}", place(*.offset, .cause))]
pub struct LogError {
    /// Where in the file: at which record, or at which chunk; the first byte is 0.
    pub offset: u64,
    /// What is wrong.
    #[source]
    pub cause: LogErrorKind,
}

/// A file that cannot be read cannot be so at any byte.
fn place(offset: u64, cause: &LogErrorKind) -> String {
    match cause {
        LogErrorKind::Unreadable(_) => String::new(),
        _ => format!("byte {offset}: "),
    }
}

/// What is wrong at a byte of a log.
#[derive(Debug, Error)]
pub enum LogErrorKind {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] io::Error),
    /// It is no log.
    #[error("this is not a log; it must be a ROS 1 bag or an MCAP file")]
    NotALog,
    /// It is a bag of another version.
    #[error("this is a bag of version {0}; only version 2.0 can be read")]
    Version(String),
    /// A record that is not as it should be.
    #[error("the record is malformed: {0}")]
    Malformed(&'static str),
    /// A chunk is compressed in another way.
    #[error("the compression {0:?} is not known; known are {1}")]
    Compression(String, &'static str),
    /// A chunk that would be larger than any.
    #[error(
        "{compressed} compressed bytes say that they are {size}; {most} times as many can be read"
    )]
    Growth {
        /// The bytes that are there.
        compressed: u64,
        /// The bytes that they say they are.
        size: u64,
        /// The largest factor that is accepted.
        most: u64,
    },
    /// A chunk cannot be decompressed.
    #[error("the chunk cannot be decompressed: {0}")]
    Undecompressable(String),
    /// A chunk is not as long as it says.
    #[error("the chunk has {found} bytes and says {told}")]
    Size {
        /// What it says.
        told: u64,
        /// What it has; of what is too long, one more than it says.
        found: u64,
    },
    /// A chunk is not what it was when it was written.
    #[error("the checksum of the chunk is wrong")]
    Checksum,
    /// A message of which nobody says on which topic it is.
    #[error("a message of connection {0}, of which there is no record")]
    UnknownConnection(u32),
    /// A message that is older than its chunk says.
    #[error("a message is older than its chunk says")]
    TooOld,
    /// A message is not as its definition says.
    #[error("message {number}, on {topic}: {error}")]
    Message {
        /// The how-manyeth of the log it is; the first is 1.
        number: u64,
        /// Its topic.
        topic: String,
        /// What is wrong.
        error: Box<DecodeError>,
    },
    /// A message does not say what its role needs.
    #[error("message {number}, on {topic}: {what}")]
    Content {
        /// The how-manyeth of the log it is; the first is 1.
        number: u64,
        /// Its topic.
        topic: String,
        /// What is missing.
        what: String,
    },
}

impl LogErrorKind {
    pub(super) fn at(self, offset: u64) -> LogError {
        LogError { offset, cause: self }
    }
}

/// Where a log ends that is not whole, and how that shows.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("truncated at byte {offset}: {cause}")]
pub struct Truncation {
    /// Up to where it can be read.
    pub offset: u64,
    /// What shows that there should be more.
    #[source]
    pub cause: TruncationKind,
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
    /// The index, for the writer did not come to it.
    #[error("it was not closed, and has no index")]
    Index,
    /// The writer did not come to the end of a record.
    #[error("it was not closed, and its last record is malformed: {0}")]
    Malformed(&'static str),
}
