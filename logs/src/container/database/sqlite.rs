//! Databases of rosbag2, `.db3`: SQLite with a table of topics, one of messages, and in newer files one of
//! definitions.
//!
//! A section is a range of rows.

use std::{
    cmp::Ordering,
    collections::BTreeMap,
    ffi::OsString,
    fs,
    ops::Range,
    path::Path,
    sync::{Mutex, PoisonError},
};

use rusqlite::{Connection, OpenFlags, limits::Limit, types::ValueRef};

use super::{
    super::{Failure, FileStructure, Listener, Section},
    HEAD, Record,
};
use crate::{
    error::{LogErrorKind, TruncationKind},
    messages::published_schema,
    source::Source,
};

/// The largest size of a section, in bytes, unless it is one row.
const SECTION: u64 = 1 << 20;
const MOST_BYTES: i32 = 1 << 28;

pub(crate) struct Database {
    connection: Mutex<Connection>,
    topics: BTreeMap<i64, u32>,
    list: Vec<StoredTopic>,
    truncation: Option<TruncationKind>,
}

struct StoredTopic {
    name: String,
    type_name: String,
    encoding: String,
    schema: String,
    definition: String,
}

impl From<rusqlite::Error> for LogErrorKind {
    fn from(error: rusqlite::Error) -> Self {
        Self::Database(error.to_string().replace(char::is_control, " "))
    }
}

impl Database {
    /// Opens a database. One that is compressed or has no path is kept in memory.
    pub(crate) fn open(source: &Source, path: Option<&Path>) -> Result<Self, LogErrorKind> {
        let connection = if let Some(path) = path.filter(|_| source.compression.is_none()) {
            let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
            Connection::open_with_flags(path, flags)?
        } else {
            let bytes = source.read(0..source.length())?;
            let mut connection = Connection::open_in_memory()?;
            connection.deserialize_read_exact("main", &*bytes, bytes.len(), true)?;
            connection
        };
        connection.set_limit(Limit::SQLITE_LIMIT_LENGTH, MOST_BYTES)?;
        connection.execute_batch("PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON;")?;
        let truncation = truncation(source, path)?;
        if matches!(truncation, Some(TruncationKind::PagesMissing { .. })) {
            // Without this, SQLite refuses a file with fewer pages than its header counts.
            connection.execute_batch("PRAGMA writable_schema = ON;")?;
        }
        for table in ["topics", "messages"] {
            if !has_table(&connection, table)? {
                return Err(LogErrorKind::Database(format!("it has no table `{table}`")));
            }
        }
        let list = topics(&connection)?;
        let topics = list.iter().zip(0..).map(|((id, _), index)| (*id, index)).collect();
        let list = list.into_iter().map(|(_, topic)| topic).collect();
        Ok(Self { connection: Mutex::new(connection), topics, list, truncation })
    }

    pub(in super::super) fn scan(
        &self,
        listener: &mut Listener<'_>,
    ) -> Result<FileStructure, Failure> {
        for (topic, id) in self.list.iter().zip(0..) {
            listener(&Record::Connection {
                id,
                topic: topic.name.as_bytes(),
                type_name: topic.type_name.as_bytes(),
                encoding: topic.encoding.as_bytes(),
                schema: topic.schema.as_bytes(),
                definition: topic.definition.as_bytes(),
            });
        }
        let mut scan = FileStructure::default();
        let mut last = 0;
        let is_read = self.rows(&mut scan, &mut last);
        match (is_read, &self.truncation) {
            (Ok(()), None) => {
                scan.end_loose();
                Ok(scan)
            }
            (Ok(()), Some(cause)) => Ok(scan.truncated(last, cause.clone())),
            (Err(LogErrorKind::Database(_)), Some(cause)) if self.lacks_pages() => {
                Ok(scan.truncated(last, cause.clone()))
            }
            (Err(cause), _) => Err((cause, last)),
        }
    }

    fn lacks_pages(&self) -> bool {
        matches!(self.truncation, Some(TruncationKind::PagesMissing { .. }))
    }

    /// Adds all rows to the sections; `last` becomes the number of the last row.
    fn rows(&self, scan: &mut FileStructure, last: &mut u64) -> Result<(), LogErrorKind> {
        let connection = self.connection.lock().unwrap_or_else(PoisonError::into_inner);
        // The length of a message is known without reading it, but not whether its pages are missing.
        let data = if self.truncation.is_some() { "data" } else { "length(data)" };
        let select = format!("SELECT id, topic_id, timestamp, {data} FROM messages ORDER BY id");
        let mut statement = connection.prepare(&select)?;
        let mut rows = statement.query(())?;
        while let Some(row) = rows.next()? {
            let id = row_number(row.get(0)?)?;
            *last = id;
            let topic = self.topic(row.get(1)?)?;
            let time = time(row.get(2)?)?;
            let length = match row.get_ref(3)? {
                ValueRef::Integer(length) => u64::try_from(length).unwrap_or_default(),
                data => message(data)?.len() as u64,
            };
            let size = HEAD as u64 + length;
            if scan.loose.as_ref().is_some_and(|section| section.size + size > SECTION) {
                scan.end_loose();
            }
            let section = scan.loose.get_or_insert_with(|| Section::loose(id));
            let before = section.size;
            section.extend(id + 1, Some((topic, time)));
            section.size = before + size;
        }
        Ok(())
    }

    pub(in super::super) fn load(&self, range: Range<u64>) -> Result<Vec<u8>, LogErrorKind> {
        let connection = self.connection.lock().unwrap_or_else(PoisonError::into_inner);
        let mut statement = connection.prepare(
            "SELECT id, topic_id, timestamp, data FROM messages WHERE id >= ?1 AND id < ?2 ORDER BY id",
        )?;
        let [start, end] = [range.start, range.end].map(|id| i64::try_from(id).unwrap_or(i64::MAX));
        let mut rows = statement.query((start, end))?;
        let mut bytes = Vec::new();
        loop {
            let row = match rows.next() {
                Ok(Some(row)) => row,
                // All rows of a section were read before; the page of the next one may be missing.
                Err(_) if self.lacks_pages() => break,
                Ok(None) => break,
                Err(error) => return Err(error.into()),
            };
            let id = row_number(row.get(0)?)?;
            let topic = self.topic(row.get(1)?)?;
            let time = time(row.get(2)?)?;
            let data = message(row.get_ref(3)?)?;
            bytes.extend([id, time].map(u64::to_le_bytes).as_flattened());
            bytes.extend([topic, data.len() as u32].map(u32::to_le_bytes).as_flattened());
            bytes.extend(data);
        }
        Ok(bytes)
    }

    fn topic(&self, id: i64) -> Result<u32, LogErrorKind> {
        let unknown = || LogErrorKind::UnknownConnection(u32::try_from(id).unwrap_or(u32::MAX));
        self.topics.get(&id).copied().ok_or_else(unknown)
    }
}

/// How a file differs from the pages that its header counts: section 1.3 of *Database File Format*
/// (sqlite.org/fileformat.html). `None` if it does not, or if that is not known: an old SQLite counted no pages, or a
/// file beside it has a transaction that did not end.
fn truncation(
    source: &Source,
    path: Option<&Path>,
) -> Result<Option<TruncationKind>, LogErrorKind> {
    let length = source.length();
    let head = source.read(0..length.min(100))?;
    let number = |bytes: Range<usize>| {
        let big_endian = |number, &byte: &u8| (number << 8) | u64::from(byte);
        head.get(bytes).map(|bytes| bytes.iter().fold(0_u64, big_endian))
    };
    let is_counted = number(24..28) == number(92..96);
    let (Some(page @ 1..), Some(counted @ 1..), true) =
        (number(16..18), number(28..32), is_counted)
    else {
        return Ok(None);
    };
    // A page of 65,536 bytes is written as 1.
    let page = if page == 1 { 1 << 16 } else { page };
    let whole = counted * page;
    Ok(match length.cmp(&whole) {
        Ordering::Equal => None,
        _ if path.is_some_and(has_transaction) => None,
        Ordering::Greater => Some(TruncationKind::Continued { bytes: length - whole }),
        Ordering::Less => Some(TruncationKind::PagesMissing { counted, found: length / page }),
    })
}

/// Whether a journal or a write-ahead log lies beside a database.
fn has_transaction(path: &Path) -> bool {
    ["-journal", "-wal"].into_iter().any(|ending| {
        let mut beside = OsString::from(path);
        beside.push(ending);
        fs::metadata(beside).is_ok_and(|file| file.len() > 0)
    })
}

/// The bytes of a message; none if there is none.
fn message(data: ValueRef<'_>) -> Result<&[u8], LogErrorKind> {
    Ok(data.as_bytes_or_null().map_err(rusqlite::Error::from)?.unwrap_or_default())
}

fn row_number(id: i64) -> Result<u64, LogErrorKind> {
    u64::try_from(id).map_err(|_| LogErrorKind::Malformed("its number is negative"))
}

fn time(time: i64) -> Result<u64, LogErrorKind> {
    u64::try_from(time).map_err(|_| LogErrorKind::Malformed("its time is negative"))
}

fn has_table(connection: &Connection, name: &str) -> Result<bool, LogErrorKind> {
    let found = connection.query_row(
        "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name = ?1",
        [name],
        |row| row.get::<_, i64>(0),
    )?;
    Ok(found > 0)
}

/// The topics by their numbers. The definition of a type that the file does not define is the published
/// one, if that is known.
fn topics(connection: &Connection) -> Result<Vec<(i64, StoredTopic)>, LogErrorKind> {
    let mut defined = BTreeMap::new();
    if has_table(connection, "message_definitions")? {
        let mut statement = connection.prepare(
            "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions",
        )?;
        let mut rows = statement.query(())?;
        while let Some(row) = rows.next()? {
            let (name, encoding, text): (String, String, String) =
                (row.get(0)?, row.get(1)?, row.get(2)?);
            defined.insert(name, (encoding, text));
        }
    }
    let mut statement = connection
        .prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id")?;
    let mut rows = statement.query(())?;
    let mut topics = Vec::new();
    while let Some(row) = rows.next()? {
        let (name, type_name, encoding): (String, String, String) =
            (row.get(1)?, row.get(2)?, row.get(3)?);
        let of_file = defined.get(&type_name).filter(|(_, text)| !text.is_empty()).cloned();
        let published = || Some(("ros2msg".to_owned(), published_schema(&type_name)?));
        let (schema, definition) = of_file.or_else(published).unwrap_or_default();
        topics.push((row.get(0)?, StoredTopic { name, type_name, encoding, schema, definition }));
    }
    Ok(topics)
}
