//! Databases of rosbag2, `.db3`: SQLite with a table of topics, one of messages, and in newer files one of
//! definitions.
//!
//! A section is a range of rows.

use std::{
    collections::BTreeMap,
    ops::Range,
    path::Path,
    sync::{Mutex, PoisonError},
};

use rusqlite::{Connection, OpenFlags, limits::Limit};

use super::{
    super::{Failure, FileStructure, Listener, Section},
    HEAD, Record,
};
use crate::{error::LogErrorKind, messages::published_schema, source::Source};

/// The largest size of a section, in bytes, unless it is one row.
const SECTION: u64 = 1 << 20;
const MOST_BYTES: i32 = 1 << 28;

pub(crate) struct Database {
    connection: Mutex<Connection>,
    topics: BTreeMap<i64, u32>,
    list: Vec<StoredTopic>,
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
        for table in ["topics", "messages"] {
            if !has_table(&connection, table)? {
                return Err(LogErrorKind::Database(format!("it has no table `{table}`")));
            }
        }
        let list = topics(&connection)?;
        let topics = list.iter().zip(0..).map(|((id, _), index)| (*id, index)).collect();
        let list = list.into_iter().map(|(_, topic)| topic).collect();
        Ok(Self { connection: Mutex::new(connection), topics, list })
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
        self.rows(&mut scan, &mut last).map_err(|cause| (cause, last))?;
        scan.end_loose();
        Ok(scan)
    }

    /// Adds all rows to the sections; `last` becomes the number of the last row.
    fn rows(&self, scan: &mut FileStructure, last: &mut u64) -> Result<(), LogErrorKind> {
        let connection = self.connection.lock().unwrap_or_else(PoisonError::into_inner);
        let mut statement = connection
            .prepare("SELECT id, topic_id, timestamp, length(data) FROM messages ORDER BY id")?;
        let mut rows = statement.query(())?;
        while let Some(row) = rows.next()? {
            let id = row_number(row.get(0)?)?;
            *last = id;
            let topic = self.topic(row.get(1)?)?;
            let time = time(row.get(2)?)?;
            let length: Option<i64> = row.get(3)?;
            let size = HEAD as u64 + u64::try_from(length.unwrap_or_default()).unwrap_or_default();
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
        while let Some(row) = rows.next()? {
            let id = row_number(row.get(0)?)?;
            let topic = self.topic(row.get(1)?)?;
            let time = time(row.get(2)?)?;
            let data = row.get_ref(3)?.as_bytes_or_null().map_err(rusqlite::Error::from)?;
            let data = data.unwrap_or_default();
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
