//! Readers of logs, messages and topic maps stay within their memory limits, whatever the bytes.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

#[path = "../../tests/memory/peak.rs"]
#[expect(dead_code, reason = "it is for readers of one kind of file, too")]
mod peak;

use std::{
    collections::BTreeMap,
    fs,
    io::{Cursor, Write},
    path::Path,
};

use flate2::{Compression, write::GzEncoder};
use mcap::{WriteOptions, records::MessageHeader};
use peak::{keep, peak};
use toposlam_logs::{
    decode::decode,
    definition::{Definition, Dialect},
    reader::Log,
    topic_map::TopicMap,
};

/// What it takes, which is no more than this.
fn peak_within(most: usize, run: impl FnOnce()) -> usize {
    let taken = peak(run);
    assert!(taken <= most, "{taken}, and {most} are stated");
    taken
}

/// The limit of [`Log::new`] and [`Log::read`], if all bytes are those of the largest chunk.
fn log_holds(bytes: &[u8]) -> usize {
    peak_within(1101 * bytes.len() + (32 << 20), || {
        // It is in memory twice.
        if let Ok(log) = Log::of_bytes(bytes.to_vec()) {
            log.read_all().for_each(keep);
        }
    })
}

fn definition_holds(dialect: Dialect, text: &str) {
    peak_within(256 * (text.len() + 3) + 4096, || keep(Definition::read(dialect, "a/A", text)));
}

fn message_holds(dialect: Dialect, text: &str, bytes: &[u8]) {
    let definition = Definition::read(dialect, "a/A", text).unwrap();
    let most = 256 * (bytes.len() + definition.root().fields.len()) + 4096;
    peak_within(most, || keep(decode(&definition, bytes)));
}

fn mapping_holds(text: &str) {
    peak_within(512 * text.len() + 4096, || keep(TopicMap::read(text.as_bytes())));
}

fn main() {
    peak::run("reading_takes_no_more_memory_than_stated", reading_takes_no_more_memory_than_stated);
}

fn reading_takes_no_more_memory_than_stated() {
    seeds_hold();
    zeros_hold();
    lines_hold();
    for length in [0, 1, 7, 8, 30, 127, 260, 1030, 4100, 33_000] {
        for part in ["int8 a\n", "int8 a", "\n", "===\nMSG: a/B\n", "int8 A=1\n", "#", "B b\n", "a"]
        {
            let text = part.repeat(length / part.len() + 1);
            definition_holds(Dialect::Ros1, &text);
            definition_holds(Dialect::Ros2, &text);
        }
        let fields: Vec<_> = (0..length / 8).map(|nth| format!("int8 a{nth}\n")).collect();
        let fields = fields.concat();
        definition_holds(Dialect::Ros1, &fields);
        definition_holds(Dialect::Ros2, &fields);
        let sections = (0..length / 20).map(|nth| format!("===\nMSG: a/B{nth}\nint8 x\n"));
        let sections = sections.collect::<Vec<_>>().concat();
        definition_holds(Dialect::Ros1, &sections);
        for part in "[image]\n|a=|\n|[|{|[a.|image.a.b=1\n|\"|#|[[a]]\n|a=1\n".split('|') {
            mapping_holds(&part.repeat(length / part.len() + 1));
            mapping_holds(&format!("image=[{}", part.repeat(length / part.len() + 1)));
        }
        let bytes = vec![0; length];
        for text in [
            "bool a",
            "string[] s",
            "B[] b\n===\nMSG: a/B\nbool x",
            "C[] c\n===\nMSG: a/C\nB b\n===\nMSG: a/B\nbool x",
            "time[] t",
            "bool[100] b",
        ] {
            for many in [0, length as u32, length as u32 / 4, u32::MAX] {
                message_holds(Dialect::Ros1, text, &[&many.to_le_bytes()[..], &bytes].concat());
                let head = [&[0, 1, 0, 0], &many.to_le_bytes()[..], &bytes].concat();
                if !text.contains("time") {
                    message_holds(Dialect::Ros2, text, &head);
                }
            }
        }
    }
}

/// The seeds of fuzzers, and the same with every four bytes set to the maximum.
fn seeds_hold() {
    for target in ["bag", "mcap"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus").join(target);
        for entry in fs::read_dir(folder).unwrap() {
            let bytes = fs::read(entry.unwrap().path()).unwrap();
            log_holds(&bytes);
            for at in (0..bytes.len().saturating_sub(4)).step_by(3) {
                let mut large = bytes.clone();
                large[at..at + 4].copy_from_slice(&[255, 255, 255, 127]);
                log_holds(&large);
            }
        }
    }
}

fn zeros_hold() {
    for (compression, read) in [(mcap::Compression::Lz4, true), (mcap::Compression::Zstd, false)] {
        let options = WriteOptions::new().compression(Some(compression)).chunk_size(None);
        let mut writer = options.create(Cursor::new(Vec::new())).unwrap();
        let channel_id = writer.add_channel(0, "/a", "x", &BTreeMap::new()).unwrap();
        let header = MessageHeader { channel_id, sequence: 0, log_time: 1, publish_time: 1 };
        writer.write_to_known_channel(&header, &vec![0; 100_000_000]).unwrap();
        writer.finish().unwrap();
        let bytes = writer.into_inner().into_inner();
        let taken = log_holds(&bytes);
        // With LZ4 it is 255 times as large, and is read. With Zstandard it is far larger, and is
        // refused.
        assert_eq!(taken > 100_000_000, read, "{taken}");
    }
}

fn lines_hold() {
    let line = format!("FLASER 180{} 1 2 3 1 2 3", " 12.5".repeat(180));
    for (lines, format) in [(9000, "log"), (18_000, "log"), (18_000, "gzip")] {
        let numbered = (0..lines).map(|time| format!("{line} {time} host {time}\n"));
        let text = numbered.collect::<String>().into_bytes();
        let bytes = if format == "gzip" { gzip(&text) } else { text };
        let size = bytes.len();
        let taken = peak(|| {
            // The bytes themselves are in memory already.
            let log = Log::new(Cursor::new(bytes)).unwrap();
            assert_eq!(log.messages_total(), lines);
            let read = log.read_all().map(Result::unwrap).count();
            assert_eq!(read as u64, lines);
        });
        assert!(taken < 2 << 20, "{taken} for {lines} lines, {size} bytes");
    }
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}
