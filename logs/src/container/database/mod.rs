//! Databases of rosbag2, `.db3`. They are read if the feature `sqlite` is on.
//!
//! In memory a row is a head of 24 bytes (its number, its time, its topic and its length), and the message.

#[cfg(feature = "sqlite")]
mod sqlite;

#[cfg(feature = "sqlite")]
pub(crate) use sqlite::Database;

use super::{Record, u32_at, u64_at};

/// Without the feature there is no open database.
#[cfg(not(feature = "sqlite"))]
pub(crate) enum AbsentDatabase {}

#[cfg(not(feature = "sqlite"))]
pub(crate) use AbsentDatabase as Database;

#[cfg(not(feature = "sqlite"))]
impl AbsentDatabase {
    pub(crate) fn open(
        _: &crate::source::Source,
        _: Option<&std::path::Path>,
    ) -> Result<Self, crate::error::LogErrorKind> {
        Err(crate::error::LogErrorKind::NoDatabases)
    }

    pub(super) fn scan(
        &self,
        _: &mut super::Listener<'_>,
    ) -> Result<super::FileStructure, super::Failure> {
        match *self {}
    }

    pub(super) fn load(
        &self,
        _: std::ops::Range<u64>,
    ) -> Result<Vec<u8>, crate::error::LogErrorKind> {
        match *self {}
    }
}

const HEAD: usize = 24;

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
