//! Bags and MCAP files, whole and truncated.

use std::collections::BTreeMap;

use mcap::WriteOptions;
use toposlam_logs::{Format, error::TruncationKind, reader::Log};

use super::{
    position,
    written::{Closed, Said, add_message, bag, bags, files, in_order, mcap, mcap_file, said, ways},
};

#[test]
fn a_file_is_read_with_any_options() {
    let all = in_order(40);
    for file in files(&[&all[..15], &all[15..]]) {
        let name = file.name;
        let log = Log::of_bytes(file.bytes).unwrap();
        assert_eq!((log.format(), log.truncation()), (file.format, None), "{name}");
        assert_eq!(log.messages_total(), 40);
        assert_eq!((log.start(), log.end()), (Some(all[0].1), Some(all[39].1)));
        assert!(log.topics().iter().all(|topic| topic.encoding == file.encoding), "{name}");
        assert_eq!(log.topics()[0].short_type(), "a/Said");
        let counts: Vec<_> = log.topics().iter().map(|topic| topic.messages).collect();
        assert_eq!(counts, [14, 13, 13]);
        assert_eq!(said(&log), all, "{name}");
        // The messages of one topic keep their numbers.
        let one: Vec<_> = log.read(&[1]).map(|message| message.unwrap().number).collect();
        assert_eq!(one, (2..40).step_by(3).collect::<Vec<_>>());
    }
}

#[test]
fn a_bag_without_an_index_is_read_and_reported_as_not_closed() {
    let all = in_order(40);
    for file in bags(&[&all[..15], &all[15..]], Closed::No) {
        let length = file.bytes.len() as u64;
        let log = Log::of_bytes(file.bytes).unwrap();
        let truncation = log.truncation().unwrap();
        assert_eq!((truncation.offset, &truncation.cause), (length, &TruncationKind::Index));
        assert_eq!(log.messages_total(), 40);
        assert_eq!(said(&log), all);
    }
}

#[test]
fn messages_come_in_order_of_time_for_any_order_in_the_file() {
    let chunks: [&[Said]; 4] = [
        &[(0, 50, 0), (1, 10, 1), (0, 10, 2)],
        &[(1, 10, 3), (0, 5, 4), (0, 60, 5)],
        &[(0, 1, 6)],
        &[(0, 50, 7)],
    ];
    for file in files(&chunks) {
        let said = said(&Log::of_bytes(file.bytes).unwrap());
        let numbers: Vec<_> = said.into_iter().map(|(_, _, number)| number).collect();
        assert_eq!(numbers, [6, 4, 1, 2, 3, 0, 7, 5], "{}", file.name);
    }
}

#[test]
fn a_truncated_file_is_read_up_to_the_cut() {
    let all = in_order(12);
    let chunks: [&[Said]; 3] = [&all[..4], &all[4..8], &all[8..]];
    let crashed = bags(&chunks, Closed::No).map(|file| (file, 8));
    for (file, expected) in files(&chunks).into_iter().map(|file| (file, 12)).chain(crashed) {
        let name = file.name;
        let magic = if file.format == Format::Bag { 13 } else { 8 };
        let mut most = 0;
        for length in magic..file.bytes.len() {
            let log = Log::of_bytes(file.bytes[..length].to_vec()).unwrap();
            let truncation = log.truncation().unwrap();
            assert!(truncation.offset <= length as u64, "{name}: {length}: {truncation}");
            let said = said(&log);
            assert_eq!(said, all[..said.len()], "{name}: {length}");
            assert_eq!(said.len() as u64, log.messages_total(), "{name}: {length}");
            assert!(said.len() >= most, "{name}: {length}");
            assert!(!file.chunked || said.len().is_multiple_of(4), "{name}: {length}");
            most = said.len();
        }
        assert_eq!(most, expected, "{name}");
    }
    let whole = mcap_file(&[&all], ways()[0]);
    let cut = Log::of_bytes(whole[..whole.len() - 1].to_vec()).unwrap();
    assert_eq!(cut.truncation().unwrap().cause, TruncationKind::End);
}

#[test]
fn what_follows_the_end_of_a_log_is_not_read_and_is_reported() {
    let all = in_order(12);
    for file in files(&[&all[..6], &all[6..]]) {
        let (name, length) = (file.name, file.bytes.len());
        let log = Log::of_bytes([&file.bytes[..], &file.bytes].concat()).unwrap();
        assert_eq!(said(&log), all, "{name}");
        let truncation = log.truncation().unwrap_or_else(|| panic!("{name}"));
        assert_eq!(truncation.offset, length as u64, "{name}: {truncation}");
        if file.format == Format::Mcap {
            let cause = TruncationKind::Continued { bytes: length as u64 };
            assert_eq!(truncation.cause, cause, "{name}");
        }
        let verified = log.verify(&()).unwrap();
        assert_eq!(verified.damage.is_empty(), file.format != Format::Mcap, "{name}: {verified:?}");
    }
}

#[test]
fn an_index_that_lists_a_chunk_that_was_cut_out_is_reported() {
    let all = in_order(12);
    let way = ways().into_iter().find(|way| way.summary && way.chunked).unwrap();
    let bytes = mcap_file(&[&all[..4], &all[4..8], &all[8..]], way);
    assert_eq!(Log::of_bytes(bytes.clone()).unwrap().truncation(), None);
    // The second chunk with the indices of its messages: records 6 and 7.
    let records: Vec<(u8, usize, usize)> = std::iter::successors(Some((0, 0, 8)), |&(.., at)| {
        let length = bytes.get(at + 1..at + 9)?.try_into().ok()?;
        Some((bytes[at], at, at + 9 + u64::from_le_bytes(length) as usize))
    })
    .collect();
    let second = records.iter().enumerate().filter(|(_, record)| record.0 == 6).nth(1).unwrap().0;
    let indices = records[second + 1..].iter().take_while(|record| record.0 == 7);
    let end = indices.last().unwrap().2;
    let cut = [&bytes[..records[second].1], &bytes[end..]].concat();
    let log = Log::of_bytes(cut).unwrap();
    let cause = TruncationKind::ChunksMissing { listed: 3, found: 2 };
    assert_eq!(log.truncation().unwrap().cause, cause);
    assert_eq!(said(&log), [&all[..4], &all[8..]].concat());
    assert!(!log.verify(&()).unwrap().damage.is_empty());
}

#[test]
fn a_chunk_of_a_crashed_recorder_is_read() {
    // The placeholder that rosbag writes as the length of a chunk before the length is known.
    let all = in_order(8);
    let mut bytes = bag(&[&all], "none", Closed::No);
    let size = position(&bytes, b"size=") + 5;
    bytes[size..size + 8].fill(0);
    assert_eq!(said(&Log::of_bytes(bytes.clone()).unwrap()), all);
    // The compressed rest is lost.
    let mut bytes = bag(&[&all[..4], &all[4..]], "bz2", Closed::No);
    let first = position(&bytes, b"BZh");
    let second = first + 3 + position(&bytes[first + 3..], b"BZh");
    bytes[second - 8..second].fill(0);
    let log = Log::of_bytes(bytes).unwrap();
    assert_eq!(said(&log), all[..4]);
    assert_eq!(log.truncation().unwrap().offset, second as u64);
}

#[test]
fn topics_that_cannot_be_decoded_are_still_listed() {
    let bytes = mcap(WriteOptions::new(), |writer| {
        for (name, schema, encoding, text) in [
            ("/json", "jsonschema", "json", "{}"),
            ("/wrong", "ros2msg", "cdr", "int32"),
            ("/idl", "ros2idl", "cdr", "module a {};"),
        ] {
            let schema = writer.add_schema("a/msg/A", schema, text.as_bytes()).unwrap();
            writer.add_channel(schema, name, encoding, &BTreeMap::new()).unwrap();
        }
        writer.add_channel(0, "/none", "cdr", &BTreeMap::new()).unwrap();
    });
    let log = Log::of_bytes(bytes).unwrap();
    for (topic, why) in log.topics().iter().zip([
        "/json: messages in \"json\" by a schema in \"jsonschema\" cannot be read",
        "/wrong: line 1 of the definition: `int32` is neither a field nor a constant",
        "/idl: messages in \"cdr\" by a schema in \"ros2idl\" cannot be read",
        "/none: the log does not define its messages",
    ]) {
        assert_eq!(format!("{}: {}", topic.name, topic.definition.as_ref().unwrap_err()), why);
    }
    assert_eq!(log.topics().len(), 4);
    assert_eq!((log.messages_total(), log.start()), (0, None));
}

#[test]
fn overlapping_chunks_beyond_the_memory_limit_are_read_again() {
    // Ten chunks of 10 MB with the same times.
    let bytes = mcap(WriteOptions::new().compression(None), |writer| {
        let channel = writer.add_channel(0, "/large", "x", &BTreeMap::new()).unwrap();
        let mut body = vec![0; 2_000_000];
        for chunk in 0..10_u64 {
            for time in (chunk..50).step_by(10) {
                body[..8].copy_from_slice(&time.to_le_bytes());
                add_message(writer, channel, time, &body);
            }
            writer.flush().unwrap();
        }
    });
    for (time, message) in (0_u64..).zip(Log::of_bytes(bytes).unwrap().read_all()) {
        let message = message.unwrap();
        assert_eq!((message.time, &message.bytes[..8]), (time, &time.to_le_bytes()[..]));
    }
}
