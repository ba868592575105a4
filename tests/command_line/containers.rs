//! A log of this project with other messages, times or stamps, as an MCAP file or a database of rosbag2.

use std::{fs, io::Cursor, path::Path};

use mcap::{Message, MessageStream, Writer};

/// Writes the messages of an MCAP file that are kept, in the container that the ending names. A message is changed
/// first.
pub(super) fn rewritten(
    log: &Path,
    changed: &Path,
    mut keep: impl FnMut(usize, &mut Message<'_>) -> bool,
) {
    let bytes = fs::read(log).unwrap();
    let mut messages = Vec::new();
    for (index, message) in MessageStream::new(&bytes).unwrap().enumerate() {
        let mut message = message.unwrap();
        if keep(index, &mut message) {
            messages.push(message);
        }
    }
    let _ = fs::remove_file(changed);
    match changed.extension().and_then(|ending| ending.to_str()) {
        Some("mcap") => write_mcap(changed, &messages),
        #[cfg(feature = "sqlite")]
        Some("db3") => database::write(changed, &messages),
        other => panic!("{other:?}"),
    }
}

/// Sets the stamp, which is the first field of a message or of its header, in whole seconds.
pub(super) fn set_stamp(message: &mut Message<'_>, seconds: i32) {
    let data = message.data.to_mut();
    // Behind the head of CDR.
    data[4..8].copy_from_slice(&seconds.to_le_bytes());
    data[8..12].fill(0);
}

fn write_mcap(path: &Path, messages: &[Message<'_>]) {
    let mut writer = Writer::new(Cursor::new(Vec::new())).unwrap();
    for message in messages {
        writer.write(message).unwrap();
    }
    writer.finish().unwrap();
    fs::write(path, writer.into_inner().into_inner()).unwrap();
}

/// Databases as rosbag2 writes them since ROS 2 Iron. The first row is 101.
#[cfg(feature = "sqlite")]
mod database {
    use std::{collections::BTreeMap, path::Path};

    use mcap::Message;
    use rusqlite::Connection;

    const TABLES: &str = "
        CREATE TABLE topics (id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
            serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);
        CREATE TABLE messages (id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,
            timestamp INTEGER NOT NULL, data BLOB NOT NULL);
        CREATE TABLE message_definitions (id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL,
            encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL);";

    pub(super) fn write(path: &Path, messages: &[Message<'_>]) {
        let mut connection = Connection::open(path).unwrap();
        connection.execute_batch(TABLES).unwrap();
        let rows = connection.transaction().unwrap();
        let mut topics = BTreeMap::new();
        for (message, row) in messages.iter().zip(101_i64..) {
            let channel = &message.channel;
            let next = i64::try_from(topics.len()).unwrap() + 1;
            let topic = *topics.entry(channel.id).or_insert_with(|| {
                let schema = channel.schema.as_ref().unwrap();
                let insert = "INSERT INTO topics VALUES (?1, ?2, ?3, 'cdr', '')";
                rows.execute(insert, (next, &channel.topic, &schema.name)).unwrap();
                let insert = "INSERT INTO message_definitions VALUES (?1, ?2, 'ros2msg', ?3)";
                let text = str::from_utf8(&schema.data).unwrap();
                rows.execute(insert, (next, &schema.name, text)).unwrap();
                next
            });
            let insert = "INSERT INTO messages VALUES (?1, ?2, ?3, ?4)";
            let time = i64::try_from(message.log_time).unwrap();
            rows.execute(insert, (row, topic, time, &*message.data)).unwrap();
        }
        rows.commit().unwrap();
    }
}
