//! Benchmark of log readers: `cargo bench -p toposlam-logs --bench logs`.

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use std::{collections::BTreeMap, hint::black_box, io::Cursor};

use divan::{
    Bencher,
    counter::{BytesCount, ItemsCount},
};
use mcap::{Compression, WriteOptions, records::MessageHeader};
use toposlam_logs::{decode::decode, reader::Log};

fn main() {
    divan::main();
}

const DEFINITION: &str = "builtin_interfaces/Time stamp\nfloat64[9] numbers\nuint8[] data\n";

fn message(data: u32) -> Vec<u8> {
    let mut message = vec![0; 88];
    message[1] = 1;
    message[84..88].copy_from_slice(&data.to_le_bytes());
    let mut state = 1_u64;
    message.extend((0..data).map(|_| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 56) as u8
    }));
    message
}

fn log(messages: u64, data: u32, compression: Option<Compression>) -> Log {
    let options = WriteOptions::new().compression(compression);
    let mut writer = options.create(Cursor::new(Vec::new())).unwrap();
    let schema = writer.add_schema("a/msg/A", "ros2msg", DEFINITION.as_bytes()).unwrap();
    let channel_id = writer.add_channel(schema, "/a", "cdr", &BTreeMap::new()).unwrap();
    let message = message(data);
    for nth in 0..messages {
        let log_time = nth * 1_000_000;
        let header = MessageHeader { channel_id, sequence: 0, log_time, publish_time: log_time };
        writer.write_to_known_channel(&header, &message).unwrap();
    }
    writer.finish().unwrap();
    Log::of_bytes(writer.into_inner().into_inner()).unwrap()
}

fn read(bencher: Bencher<'_, '_>, messages: u64, data: u32, compression: Option<Compression>) {
    let log = log(messages, data, compression);
    let counted = bencher.counter(ItemsCount::new(messages)).counter(BytesCount::new(log.size()));
    counted.bench(|| {
        let definition = log.topics()[0].definition.as_ref().unwrap();
        let decoded = log.read_all().map(|message| {
            black_box(decode(definition, &message.unwrap().bytes).unwrap());
        });
        assert_eq!(decoded.count() as u64, messages);
    });
}

const COMPRESSIONS: [Option<Compression>; 2] = [None, Some(Compression::Zstd)];

#[divan::bench(args = COMPRESSIONS)]
fn small_messages(bencher: Bencher<'_, '_>, compression: Option<Compression>) {
    read(bencher, 300_000, 20, compression);
}

#[divan::bench(args = COMPRESSIONS)]
fn pictures(bencher: Bencher<'_, '_>, compression: Option<Compression>) {
    read(bencher, 1000, 150_000, compression);
}
