//! Logs that tests write.

use std::{
    borrow::Cow,
    collections::BTreeMap,
    io::{Cursor, Write},
};

use mcap::{Compression, WriteOptions, Writer, records::MessageHeader};
use toposlam_logs::{Format, RawMessage, reader::Log, topic::Encoding};

/// A message to write: its topic, its time, its number.
pub(crate) type Said = (u32, u64, u32);

pub(crate) const DEFINITION: &str = "uint32 number\nstring word\n";

pub(crate) fn ros1_body(number: u32) -> Vec<u8> {
    let mut body = number.to_le_bytes().to_vec();
    body.extend(*b"\x04\0\0\0word");
    body
}

pub(crate) fn cdr_body(number: u32) -> Vec<u8> {
    let mut body = vec![0, 1, 0, 0];
    body.extend(number.to_le_bytes());
    body.extend(*b"\x05\0\0\0word\0");
    body
}

/// `many` messages in order, on three topics.
pub(crate) fn in_order(many: u32) -> Vec<Said> {
    (0..many).map(|number| (number % 3, 1_000_000_000 + 7 * u64::from(number), number)).collect()
}

fn field(name: &str, value: &[u8]) -> Vec<u8> {
    let length = (name.len() + 1 + value.len()) as u32;
    [&length.to_le_bytes(), name.as_bytes(), b"=", value].concat()
}

fn record(header: &[(&str, &[u8])], body: &[u8]) -> Vec<u8> {
    let header: Vec<u8> = header.iter().flat_map(|(name, value)| field(name, value)).collect();
    let lengths = [header.len(), body.len()].map(|length| (length as u32).to_le_bytes());
    [&lengths[0], &header[..], &lengths[1], body].concat()
}

fn time(nanoseconds: u64) -> Vec<u8> {
    let parts = [nanoseconds / 1_000_000_000, nanoseconds % 1_000_000_000];
    parts.map(|part| (part as u32).to_le_bytes()).concat()
}

fn connection(id: u32) -> Vec<u8> {
    let topic = format!("/t{id}");
    let header: [(&str, &[u8]); 3] =
        [("op", &[7]), ("conn", &id.to_le_bytes()), ("topic", topic.as_bytes())];
    let body = [
        field("type", b"a/Said"),
        field("md5sum", b"*"),
        field("message_definition", DEFINITION.as_bytes()),
    ];
    record(&header, &body.concat())
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Closed {
    Yes,
    No,
}

pub(crate) fn bag(chunks: &[&[Said]], compression: &str, closed: Closed) -> Vec<u8> {
    let mut ids: Vec<u32> = chunks.iter().flat_map(|said| said.iter().map(|said| said.0)).collect();
    ids.sort_unstable();
    ids.dedup();
    let head = |index: u64, connections: u32, chunks: u32| {
        record(
            &[
                ("op", &[3]),
                ("index_pos", &index.to_le_bytes()),
                ("conn_count", &connections.to_le_bytes()),
                ("chunk_count", &chunks.to_le_bytes()),
            ],
            b"    ",
        )
    };
    let magic = b"#ROSBAG V2.0\n";
    let mut bag = [&magic[..], &head(0, 0, 0)].concat();
    let mut infos = Vec::new();
    let mut declared = Vec::new();
    for said in chunks {
        let mut whole = Vec::new();
        let mut index: BTreeMap<u32, Vec<u8>> = BTreeMap::new();
        for &(id, at, number) in *said {
            if !declared.contains(&id) {
                declared.push(id);
                whole.extend(connection(id));
            }
            index
                .entry(id)
                .or_default()
                .extend([time(at), (whole.len() as u32).to_le_bytes().into()].concat());
            whole.extend(record(
                &[("op", &[2]), ("conn", &id.to_le_bytes()), ("time", &time(at))],
                &ros1_body(number),
            ));
        }
        let body = match compression {
            "none" => whole.clone(),
            "bz2" => {
                let mut encoder =
                    bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::best());
                encoder.write_all(&whole).unwrap();
                encoder.finish().unwrap()
            }
            "lz4" => {
                let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
                encoder.write_all(&whole).unwrap();
                encoder.finish().unwrap()
            }
            _ => whole.iter().map(|byte| !byte).collect(),
        };
        let times = said.iter().map(|said| said.1);
        infos.push(record(
            &[
                ("op", &[6]),
                ("ver", &1_u32.to_le_bytes()),
                ("chunk_pos", &(bag.len() as u64).to_le_bytes()),
                ("start_time", &time(times.clone().min().unwrap())),
                ("end_time", &time(times.max().unwrap())),
                ("count", &(index.len() as u32).to_le_bytes()),
            ],
            &index
                .iter()
                .flat_map(|(id, list)| [*id, list.len() as u32 / 12].map(u32::to_le_bytes))
                .collect::<Vec<_>>()
                .concat(),
        ));
        let size = (whole.len() as u32).to_le_bytes();
        bag.extend(record(
            &[("op", &[5]), ("compression", compression.as_bytes()), ("size", &size)],
            &body,
        ));
        for (id, list) in index {
            if closed == Closed::Yes {
                let count = (list.len() as u32 / 12).to_le_bytes();
                bag.extend(record(
                    &[
                        ("op", &[4]),
                        ("ver", &1_u32.to_le_bytes()),
                        ("conn", &id.to_le_bytes()),
                        ("count", &count),
                    ],
                    &list,
                ));
            }
        }
    }
    if closed == Closed::Yes {
        let head = head(bag.len() as u64, ids.len() as u32, chunks.len() as u32);
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

/// The compressions of bags.
pub(crate) const COMPRESSIONS: [&str; 3] = ["none", "bz2", "lz4"];

fn named_bag(chunks: &[&[Said]], compression: &str, closed: Closed) -> File {
    let name = format!("bag, {compression}");
    let bytes = bag(chunks, compression, closed);
    File { name, format: Format::Bag, encoding: Encoding::Ros1, chunked: true, bytes }
}

pub(crate) fn crashed_bag(chunks: &[&[Said]], compression: &str) -> File {
    named_bag(chunks, compression, Closed::No)
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
    let bags = COMPRESSIONS.map(|compression| named_bag(chunks, compression, Closed::Yes));
    ways().into_iter().map(mcap).chain(bags).collect()
}

pub(crate) fn mcap_file(chunks: &[&[Said]], way: Way) -> Vec<u8> {
    let mut options = WriteOptions::new().compression(way.compression).use_chunks(way.chunked);
    if !way.summary {
        options = options
            .emit_statistics(false)
            .emit_summary_offsets(false)
            .emit_message_indexes(false)
            .emit_chunk_indexes(false)
            .repeat_channels(false)
            .repeat_schemas(false);
    }
    let mut writer: Writer<Cursor<Vec<u8>>> = options.create(Cursor::new(Vec::new())).unwrap();
    let [schema_encoding, encoding, type_name] =
        if way.ros1 { ["ros1msg", "ros1", "a/Said"] } else { ["ros2msg", "cdr", "a/msg/Said"] };
    let schema = writer.add_schema(type_name, schema_encoding, DEFINITION.as_bytes()).unwrap();
    for said in chunks {
        for &(id, log_time, number) in *said {
            let topic = format!("/t{id}");
            let channel_id =
                writer.add_channel(schema, &topic, encoding, &BTreeMap::new()).unwrap();
            let header = MessageHeader { channel_id, sequence: number, log_time, publish_time: 0 };
            let body = if way.ros1 { ros1_body(number) } else { cdr_body(number) };
            writer.write_to_known_channel(&header, &body).unwrap();
        }
        writer.flush().unwrap();
    }
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

/// Checks the messages of a log one by one, and its answers to queries.
pub(crate) fn said(log: &Log) -> Vec<Said> {
    log.read_all().enumerate().map(|(nth, message)| one(log, nth, &message.unwrap())).collect()
}

fn one(log: &Log, nth: usize, message: &RawMessage) -> Said {
    assert_eq!(message.number, nth as u64 + 1);
    assert!(message.offset < log.size());
    let topic = &log.topics()[message.topic];
    let definition = topic.definition.as_ref().unwrap();
    let value = toposlam_logs::decode::decode(definition, &message.bytes).unwrap();
    assert_eq!(value.at("word").unwrap().text(), Some(Cow::Borrowed("word")));
    let id = topic.name.strip_prefix("/t").unwrap().parse().unwrap();
    (id, message.time, value.at("number").unwrap().u64().unwrap() as u32)
}
