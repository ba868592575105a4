//! Databases of rosbag2 with any rows.

use rusqlite::{Connection, MAIN_DB};

/// The tables, with a topic of scans and one of transforms, which the file does not define, and one that is
/// not known.
const TABLES: &str = "
    CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT,
        offered_qos_profiles TEXT);
    CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);
    INSERT INTO topics VALUES (1, '/scan', 'sensor_msgs/msg/LaserScan', 'cdr', ''),
        (2, '/tf', 'tf2_msgs/msg/TFMessage', 'cdr', ''), (3, '/x', 'a/msg/B', 'cdr', '');";

/// The file of a database with some rows: the bytes of a number, a topic, a time and a length, and as many
/// bytes of a message as the length, or as there are.
///
/// # Errors
/// Returns an error if SQLite does.
pub fn of_rows(bytes: &[u8]) -> Result<Vec<u8>, rusqlite::Error> {
    let connection = Connection::open_in_memory()?;
    connection.execute_batch(TABLES)?;
    let mut insert = connection.prepare("INSERT OR REPLACE INTO messages VALUES (?, ?, ?, ?)")?;
    let mut rest = bytes;
    while let [id, topic, time, length, message @ ..] = rest {
        let (message, next) = message.split_at(message.len().min(usize::from(*length)));
        // The highest numbers are negative.
        let id = i64::from(id.cast_signed()) + 100;
        insert.execute((id, topic, i64::from(time.cast_signed()) + 100, message))?;
        rest = next;
    }
    drop(insert);
    Ok(connection.serialize(MAIN_DB)?.to_vec())
}
