//! Logs that tests write.

use std::{
    borrow::Cow,
    collections::{BTreeMap, BTreeSet},
    io::{Cursor, Write},
};

use mcap::{Compression, WriteOptions, Writer, records::MessageHeader};
use toposlam_logs::{Format, RawMessage, reader::Log, topic::Encoding};

/// A message to write: its topic, its time, its number.
pub(crate) type Said = (u32, u64, u32);

const DEFINITION: &str = "uint32 number\nstring word\n";

fn ros1_body(number: u32) -> Vec<u8> {
    [&number.to_le_bytes()[..], b"\x04\0\0\0word"].concat()
}

fn cdr_body(number: u32) -> Vec<u8> {
    [&[0, 1, 0, 0], &number.to_le_bytes()[..], b"\x05\0\0\0word\0"].concat()
}

/// `many` messages in order, on three topics.
pub(crate) fn in_order(many: u32) -> Vec<Said> {
    (0..many).map(|number| (number % 3, 1_000_000_000 + 7 * u64::from(number), number)).collect()
}

fn field(name: &str, value: &[u8]) -> Vec<u8> {
    let length = (name.len() + 1 + value.len()) as u32;
    [&length.to_le_bytes(), name.as_bytes(), b"=", value].concat()
}

fn record(op: u8, header: &[(&str, &[u8])], body: &[u8]) -> Vec<u8> {
    let header = header.iter().flat_map(|(name, value)| field(name, value));
    let header: Vec<u8> = field("op", &[op]).into_iter().chain(header).collect();
    let lengths = [header.len(), body.len()].map(|length| (length as u32).to_le_bytes());
    [&lengths[0], &header[..], &lengths[1], body].concat()
}

fn time(nanoseconds: u64) -> Vec<u8> {
    let parts = [nanoseconds / 1_000_000_000, nanoseconds % 1_000_000_000];
    parts.map(|part| (part as u32).to_le_bytes()).concat()
}

fn connection(id: u32) -> Vec<u8> {
    let topic = format!("/t{id}");
    let definition = field("message_definition", DEFINITION.as_bytes());
    let body = [field("type", b"a/Said"), field("md5sum", b"*"), definition].concat();
    record(7, &[("conn", &id.to_le_bytes()), ("topic", topic.as_bytes())], &body)
}

fn bag_head(index: u64, connections: u32, chunks: u32) -> Vec<u8> {
    let counts = [connections, chunks].map(u32::to_le_bytes);
    let fields: [(&str, &[u8]); 3] = [
        ("index_pos", &index.to_le_bytes()),
        ("conn_count", &counts[0]),
        ("chunk_count", &counts[1]),
    ];
    record(3, &fields, b"    ")
}

fn compressed(bytes: &[u8], compression: &str) -> Vec<u8> {
    match compression {
        "none" => bytes.to_vec(),
        "bz2" => {
            let mut encoder = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::best());
            encoder.write_all(bytes).unwrap();
            encoder.finish().unwrap()
        }
        "lz4" => {
            let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
            encoder.write_all(bytes).unwrap();
            encoder.finish().unwrap()
        }
        _ => bytes.iter().map(|byte| !byte).collect(),
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Closed {
    Yes,
    No,
}

pub(crate) fn bag(chunks: &[&[Said]], compression: &str, closed: Closed) -> Vec<u8> {
    let magic = b"#ROSBAG V2.0\n";
    let mut bag = [&magic[..], &bag_head(0, 0, 0)].concat();
    let mut infos = Vec::new();
    let mut ids = BTreeSet::new();
    for said in chunks {
        let mut whole = Vec::new();
        // Of each connection, the times and places of its messages.
        let mut index: BTreeMap<u32, Vec<u8>> = BTreeMap::new();
        for &(id, at, number) in *said {
            if ids.insert(id) {
                whole.extend(connection(id));
            }
            let place = (whole.len() as u32).to_le_bytes();
            index.entry(id).or_default().extend([time(at), place.into()].concat());
            let header: [(&str, &[u8]); 2] = [("conn", &id.to_le_bytes()), ("time", &time(at))];
            whole.extend(record(2, &header, &ros1_body(number)));
        }
        let [one, size, count] = [1, whole.len(), index.len()].map(|it| (it as u32).to_le_bytes());
        let times = said.iter().map(|said| said.1);
        let info: [(&str, &[u8]); 5] = [
            ("ver", &one),
            ("chunk_pos", &(bag.len() as u64).to_le_bytes()),
            ("start_time", &time(times.clone().min().unwrap())),
            ("end_time", &time(times.max().unwrap())),
            ("count", &count),
        ];
        let counts = index.iter().map(|(id, list)| [*id, list.len() as u32 / 12]);
        let counts: Vec<_> = counts.flat_map(|count| count.map(u32::to_le_bytes)).collect();
        infos.push(record(6, &info, &counts.concat()));
        let header: [(&str, &[u8]); 2] = [("compression", compression.as_bytes()), ("size", &size)];
        bag.extend(record(5, &header, &compressed(&whole, compression)));
        for (id, list) in index.into_iter().filter(|_| closed == Closed::Yes) {
            let [id, count] = [id, list.len() as u32 / 12].map(u32::to_le_bytes);
            bag.extend(record(4, &[("ver", &one), ("conn", &id), ("count", &count)], &list));
        }
    }
    if closed == Closed::Yes {
        let head = bag_head(bag.len() as u64, ids.len() as u32, chunks.len() as u32);
        bag[magic.len()..magic.len() + head.len()].copy_from_slice(&head);
        bag.extend(ids.into_iter().flat_map(connection));
        bag.extend(infos.concat());
    }
    bag
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    pub(crate) ros1: bool,
    pub(crate) compression: Option<Compression>,
    pub(crate) chunked: bool,
    pub(crate) summary: bool,
}

pub(crate) fn ways() -> Vec<Way> {
    let mut ways = Vec::new();
    for ros1 in [false, true] {
        for summary in [false, true] {
            for compression in [None, Some(Compression::Lz4), Some(Compression::Zstd)] {
                ways.push(Way { ros1, compression, chunked: true, summary });
            }
            ways.push(Way { ros1, compression: None, chunked: false, summary });
        }
    }
    ways
}

/// A file with one chunk for each list of messages.
pub(crate) struct File {
    pub(crate) name: String,
    pub(crate) format: Format,
    pub(crate) encoding: Encoding,
    pub(crate) chunked: bool,
    pub(crate) bytes: Vec<u8>,
}

pub(crate) fn bags(chunks: &[&[Said]], closed: Closed) -> [File; 3] {
    ["none", "bz2", "lz4"].map(|compression| File {
        name: format!("bag, {compression}"),
        format: Format::Bag,
        encoding: Encoding::Ros1,
        chunked: true,
        bytes: bag(chunks, compression, closed),
    })
}

/// Whole files of every format, with all options.
pub(crate) fn files(chunks: &[&[Said]]) -> Vec<File> {
    let mcap = |way: Way| File {
        name: format!("{way:?}"),
        format: Format::Mcap,
        encoding: if way.ros1 { Encoding::Ros1 } else { Encoding::Cdr },
        chunked: way.chunked,
        bytes: mcap_file(chunks, way),
    };
    ways().into_iter().map(mcap).chain(bags(chunks, Closed::Yes)).collect()
}

pub(crate) type McapWriter = Writer<Cursor<Vec<u8>>>;

pub(crate) fn mcap(options: WriteOptions, write: impl FnOnce(&mut McapWriter)) -> Vec<u8> {
    let mut writer = options.create(Cursor::new(Vec::new())).unwrap();
    write(&mut writer);
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

pub(crate) fn without_index() -> WriteOptions {
    WriteOptions::new()
        .emit_statistics(false)
        .emit_summary_offsets(false)
        .emit_message_indexes(false)
        .emit_chunk_indexes(false)
        .repeat_channels(false)
        .repeat_schemas(false)
}

pub(crate) fn add_message(writer: &mut McapWriter, channel_id: u16, log_time: u64, body: &[u8]) {
    let header = MessageHeader { channel_id, sequence: 0, log_time, publish_time: 0 };
    writer.write_to_known_channel(&header, body).unwrap();
}

pub(crate) fn mcap_file(chunks: &[&[Said]], way: Way) -> Vec<u8> {
    let options = if way.summary { WriteOptions::new() } else { without_index() };
    let [schema_encoding, encoding, type_name] =
        if way.ros1 { ["ros1msg", "ros1", "a/Said"] } else { ["ros2msg", "cdr", "a/msg/Said"] };
    let body = if way.ros1 { ros1_body } else { cdr_body };
    mcap(options.compression(way.compression).use_chunks(way.chunked), |writer| {
        let schema = writer.add_schema(type_name, schema_encoding, DEFINITION.as_bytes()).unwrap();
        for said in chunks {
            for &(id, time, number) in *said {
                let topic = format!("/t{id}");
                let channel =
                    writer.add_channel(schema, &topic, encoding, &BTreeMap::new()).unwrap();
                add_message(writer, channel, time, &body(number));
            }
            writer.flush().unwrap();
        }
    })
}

/// Checks the messages of a log one by one, and its answers to queries.
pub(crate) fn said(log: &Log) -> Vec<Said> {
    log.read_all().enumerate().map(|(nth, message)| one(log, nth, &message.unwrap())).collect()
}

fn one(log: &Log, nth: usize, message: &RawMessage) -> Said {
    assert_eq!(message.number, nth as u64 + 1);
    assert!(message.offset < log.size());
    let topic = &log.topics()[message.topic];
    let value = topic.decode(&message.bytes).unwrap().unwrap();
    assert_eq!(value.at("word").unwrap().text(), Some(Cow::Borrowed("word")));
    let id = topic.name.strip_prefix("/t").unwrap().parse().unwrap();
    (id, message.time, value.at("number").unwrap().u64().unwrap() as u32)
}
