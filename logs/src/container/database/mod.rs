//! Databases of rosbag2, `.db3`. They are read if the feature `sqlite` is on.

#[cfg(feature = "sqlite")]
mod sqlite;

use std::{ops::Range, path::Path};

use super::{FileStructure, Listener};
use crate::{
    error::{LogError, LogErrorKind},
    source::Source,
};

/// An open database. Without the feature there is none.
pub(crate) struct Database {
    #[cfg(feature = "sqlite")]
    tables: sqlite::Tables,
    #[cfg(not(feature = "sqlite"))]
    tables: std::convert::Infallible,
}

#[cfg(feature = "sqlite")]
impl Database {
    /// Opens a database. One that is compressed or has no path is kept in memory.
    pub(crate) fn open(source: &Source, path: Option<&Path>) -> Result<Self, LogErrorKind> {
        Ok(Self { tables: sqlite::Tables::open(source, path)? })
    }

    /// Its sections.
    pub(super) fn scan(&self, listener: &mut Listener<'_>) -> Result<FileStructure, LogError> {
        self.tables.scan(listener)
    }

    /// Rows with their heads.
    pub(super) fn load(&self, range: Range<u64>) -> Result<Vec<u8>, LogErrorKind> {
        self.tables.load(range)
    }
}

#[cfg(not(feature = "sqlite"))]
impl Database {
    /// Returns an error.
    pub(crate) fn open(_: &Source, _: Option<&Path>) -> Result<Self, LogErrorKind> {
        Err(LogErrorKind::NoDatabases)
    }

    pub(super) fn scan(&self, _: &mut Listener<'_>) -> Result<FileStructure, LogError> {
        match self.tables {}
    }

    pub(super) fn load(&self, _: Range<u64>) -> Result<Vec<u8>, LogErrorKind> {
        match self.tables {}
    }
}
