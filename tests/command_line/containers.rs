//! A log of this project with other messages, times or stamps, as an MCAP file, a database of rosbag2 or a ROS 1 bag.

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
        Some("bag") => bag::write(changed, &messages),
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

/// ROS 1 bags of laser scans and odometry: one chunk that is not compressed, and an index.
mod bag {
    use std::{collections::BTreeMap, fs, path::Path};

    use mcap::Message;

    /// A part of a message.
    enum Part {
        /// Numbers of so many bytes each.
        Numbers {
            bytes: usize,
            count: usize,
        },
        /// A list of numbers of four bytes.
        List,
        Text,
    }

    use Part::{List, Numbers, Text};

    const HEADER: &str = "===\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n";
    const SCAN: &str = "Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n\
        float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n\
        float32[] ranges\nfloat32[] intensities\n";
    const SCAN_PARTS: &[Part] = &[Numbers { bytes: 4, count: 7 }, List, List];
    const ODOMETRY: &str = "Header header\nstring child_frame_id\nPoseWithCovariance pose\n\
        TwistWithCovariance twist\n\
        ===\nMSG: geometry_msgs/PoseWithCovariance\nPose pose\nfloat64[36] covariance\n\
        ===\nMSG: geometry_msgs/TwistWithCovariance\nTwist twist\nfloat64[36] covariance\n\
        ===\nMSG: geometry_msgs/Pose\nPoint position\nQuaternion orientation\n\
        ===\nMSG: geometry_msgs/Twist\nVector3 linear\nVector3 angular\n\
        ===\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n\
        ===\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n\
        ===\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";
    const ODOMETRY_PARTS: &[Part] = &[Text, Numbers { bytes: 8, count: 7 + 36 + 6 + 36 }];

    pub(super) fn write(path: &Path, messages: &[Message<'_>]) {
        let mut chunk = Vec::new();
        let mut connections: BTreeMap<u32, Vec<u8>> = BTreeMap::new();
        let mut index: BTreeMap<u32, Vec<u8>> = BTreeMap::new();
        for message in messages {
            let (id, type_name, definition, parts) = match &*message.channel.topic {
                "/scan" => (0_u32, "sensor_msgs/LaserScan", SCAN, SCAN_PARTS),
                "/odom" => (1, "nav_msgs/Odometry", ODOMETRY, ODOMETRY_PARTS),
                _ => continue,
            };
            let id_bytes = id.to_le_bytes();
            connections.entry(id).or_insert_with(|| {
                let topic = message.channel.topic.as_bytes();
                let head = [("op", &[7][..]), ("conn", &id_bytes), ("topic", topic)];
                let definition = [definition, HEADER].concat();
                let body = [
                    field("type", type_name.as_bytes()),
                    field("md5sum", b"*"),
                    field("message_definition", definition.as_bytes()),
                ];
                let connection = record(&head, &body.concat());
                chunk.extend(&connection);
                connection
            });
            let at = time(message.log_time);
            let entry = [&at[..], &(chunk.len() as u32).to_le_bytes()].concat();
            index.entry(id).or_default().extend(entry);
            let head = [("op", &[2][..]), ("conn", &id_bytes), ("time", &at)];
            chunk.extend(record(&head, &ros1_body(&message.data, parts)));
        }
        let magic = b"#ROSBAG V2.0\n";
        let head = |index: u64, connections: u32, chunks: u32| {
            let [index, connections, chunks] =
                [&index.to_le_bytes()[..], &connections.to_le_bytes(), &chunks.to_le_bytes()]
                    .map(<[u8]>::to_vec);
            let fields = [
                ("op", &[3][..]),
                ("index_pos", &index),
                ("conn_count", &connections),
                ("chunk_count", &chunks),
            ];
            record(&fields, b"    ")
        };
        let mut bag = [&magic[..], &head(0, 0, 0)].concat();
        let one = 1_u32.to_le_bytes();
        let times = messages.iter().map(|message| message.log_time);
        let counts = index.iter().flat_map(|(id, list)| [*id, list.len() as u32 / 12]);
        let info = record(
            &[
                ("op", &[6]),
                ("ver", &one),
                ("chunk_pos", &(bag.len() as u64).to_le_bytes()),
                ("start_time", &time(times.clone().min().unwrap())),
                ("end_time", &time(times.max().unwrap())),
                ("count", &(index.len() as u32).to_le_bytes()),
            ],
            &counts.flat_map(u32::to_le_bytes).collect::<Vec<_>>(),
        );
        let size = (chunk.len() as u32).to_le_bytes();
        bag.extend(record(&[("op", &[5]), ("compression", b"none"), ("size", &size)], &chunk));
        for (id, list) in &index {
            let [id, count] = [*id, list.len() as u32 / 12].map(u32::to_le_bytes);
            let fields = [("op", &[4][..]), ("ver", &one), ("conn", &id), ("count", &count)];
            bag.extend(record(&fields, list));
        }
        let head = head(bag.len() as u64, connections.len() as u32, 1);
        bag[magic.len()..magic.len() + head.len()].copy_from_slice(&head);
        bag.extend(connections.into_values().flatten());
        bag.extend(info);
        fs::write(path, bag).unwrap();
    }

    fn field(name: &str, value: &[u8]) -> Vec<u8> {
        let length = (name.len() + 1 + value.len()) as u32;
        [&length.to_le_bytes(), name.as_bytes(), b"=", value].concat()
    }

    fn record(header: &[(&str, &[u8])], body: &[u8]) -> Vec<u8> {
        let header: Vec<u8> = header.iter().flat_map(|(name, value)| field(name, value)).collect();
        let [head, length] = [header.len(), body.len()].map(|length| (length as u32).to_le_bytes());
        [&head, &header[..], &length, body].concat()
    }

    fn time(nanoseconds: u64) -> Vec<u8> {
        let parts = [nanoseconds / 1_000_000_000, nanoseconds % 1_000_000_000];
        parts.map(|part| u32::try_from(part).unwrap().to_le_bytes()).concat()
    }

    /// A message with a header in the serialization of ROS 1, which has no padding, no zero behind a text, and a number
    /// before the stamp.
    fn ros1_body(cdr: &[u8], parts: &[Part]) -> Vec<u8> {
        let cdr = &cdr[4..];
        let mut at = 0_usize;
        let mut body = 0_u32.to_le_bytes().to_vec();
        for part in [Numbers { bytes: 4, count: 2 }, Text].iter().chain(parts) {
            let size = if let Numbers { bytes, count } = part {
                at = at.next_multiple_of(*bytes);
                bytes * count
            } else {
                at = at.next_multiple_of(4);
                let length = u32::from_le_bytes(cdr[at..at + 4].try_into().unwrap()) as usize;
                at += 4;
                let written = if matches!(part, Text) { length - 1 } else { length };
                body.extend((written as u32).to_le_bytes());
                length * if matches!(part, List) { 4 } else { 1 }
            };
            let end = if matches!(part, Text) { at + size - 1 } else { at + size };
            body.extend(&cdr[at..end]);
            at += size;
        }
        body
    }
}
