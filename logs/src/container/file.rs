//! One file of a log.

use super::{
    Database, Format, TextState,
    compression::{ZSTANDARD, decompress_message},
};
use crate::{
    error::{LogError, LogErrorKind},
    source::Source,
};

/// One file of a log.
pub(crate) struct LogFile {
    /// Its name, if the log has several.
    pub(crate) name: Option<String>,
    pub(crate) format: Format,
    pub(crate) source: Source,
    /// Its database, if it is one.
    pub(crate) database: Option<Database>,
    /// What a log of lines states for all of them.
    pub(crate) text: TextState,
}

impl LogFile {
    /// An error in the file.
    pub(crate) fn error(&self, cause: LogErrorKind, offset: u64) -> LogError {
        LogError { offset, unit: self.format.unit(), file: self.name.clone(), cause }
    }

    /// An error of its container.
    pub(crate) fn in_file(&self, error: LogError) -> LogError {
        LogError { file: self.name.clone(), ..error }
    }

    /// The bytes of a message. rosbag2 may compress each; CDR never begins as a compressed message does.
    pub(crate) fn message(&self, bytes: Vec<u8>) -> Result<Vec<u8>, LogErrorKind> {
        let is_rosbag2 = self.name.is_some() || self.database.is_some();
        if is_rosbag2 && bytes.starts_with(ZSTANDARD) {
            return decompress_message(&bytes);
        }
        Ok(bytes)
    }
}
