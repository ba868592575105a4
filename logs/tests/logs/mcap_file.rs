//! MCAP files.

use toposlam_logs::{Format, error::TruncationKind, reader::Log, topic::Encoding};

use super::written::{Said, Way, in_order, mcap_file, said, ways};

#[test]
fn an_mcap_file_is_read_with_any_options() {
    let all = in_order(40);
    for way in ways() {
        let log = Log::of_bytes(mcap_file(&[&all[..15], &all[15..]], way)).unwrap();
        assert_eq!((log.format(), log.truncation()), (Format::Mcap, None), "{way:?}");
        assert_eq!(log.messages_total(), 40);
        assert_eq!((log.start(), log.end()), (Some(all[0].1), Some(all[39].1)));
        let encoding = if way.ros1 { Encoding::Ros1 } else { Encoding::Cdr };
        assert!(log.topics().iter().all(|topic| topic.encoding == encoding));
        assert_eq!(log.topics()[0].short_type(), "a/Said");
        assert_eq!(
            log.topics().iter().map(|topic| topic.messages).collect::<Vec<_>>(),
            [14, 13, 13]
        );
        assert_eq!(said(&log), all, "{way:?}");
    }
}

#[test]
fn messages_come_in_order_of_time_for_any_order_in_the_file() {
    let chunks: [&[Said]; 3] =
        [&[(0, 50, 0), (1, 10, 1), (0, 10, 2)], &[(1, 10, 3), (0, 5, 4), (0, 60, 5)], &[(0, 1, 6)]];
    for way in ways() {
        let numbers = said(&Log::of_bytes(mcap_file(&chunks, way)).unwrap());
        let numbers: Vec<_> = numbers.into_iter().map(|(_, _, number)| number).collect();
        assert_eq!(numbers, [6, 4, 1, 2, 3, 0, 5], "{way:?}");
    }
}

#[test]
fn a_truncated_mcap_file_is_read_up_to_the_cut() {
    let all = in_order(12);
    for way in ways() {
        let bytes = mcap_file(&[&all[..4], &all[4..8], &all[8..]], way);
        let mut most = 0;
        for length in 8..bytes.len() {
            let log = Log::of_bytes(bytes[..length].to_vec()).unwrap();
            let truncation = log.truncation().unwrap();
            assert!(truncation.offset <= length as u64, "{length}: {truncation}");
            let said = said(&log);
            assert_eq!(said, all[..said.len()], "{way:?}: {length}");
            assert!(said.len() >= most, "{length}");
            assert!(!way.chunked || said.len().is_multiple_of(4), "{length}");
            most = said.len();
        }
        assert_eq!(most, 12);
    }
    let whole = mcap_file(&[&all], ways()[0]);
    let cut = Log::of_bytes(whole[..whole.len() - 1].to_vec()).unwrap();
    assert_eq!(cut.truncation().unwrap().cause, TruncationKind::End);
}

#[test]
fn topics_that_cannot_be_decoded_are_still_listed() {
    use std::{collections::BTreeMap, io::Cursor};
    let mut writer = mcap::Writer::new(Cursor::new(Vec::new())).unwrap();
    for (name, schema, encoding, text) in [
        ("/json", "jsonschema", "json", "{}"),
        ("/wrong", "ros2msg", "cdr", "int32"),
        ("/idl", "ros2idl", "cdr", "module a {};"),
    ] {
        let schema = writer.add_schema("a/msg/A", schema, text.as_bytes()).unwrap();
        writer.add_channel(schema, name, encoding, &BTreeMap::new()).unwrap();
    }
    writer.add_channel(0, "/none", "cdr", &BTreeMap::new()).unwrap();
    writer.finish().unwrap();
    let log = Log::of_bytes(writer.into_inner().into_inner()).unwrap();
    let why: Vec<_> = log
        .topics()
        .iter()
        .map(|topic| format!("{}: {}", topic.name, topic.definition.as_ref().unwrap_err()))
        .collect();
    assert_eq!(
        why,
        [
            "/json: messages in \"json\" by a schema in \"jsonschema\" cannot be read",
            "/wrong: line 1 of the definition: `int32` is neither a field nor a constant",
            "/idl: messages in \"cdr\" by a schema in \"ros2idl\" cannot be read",
            "/none: the log does not define its messages",
        ]
    );
    assert_eq!((log.messages_total(), log.start()), (0, None));
}

#[test]
fn overlapping_chunks_beyond_the_memory_limit_are_read_again() {
    // Ten chunks of 10 MB with the same times.
    use std::{collections::BTreeMap, io::Cursor};
    let way = Way { ros1: false, compression: None, chunked: true, summary: true };
    let mut writer = mcap::WriteOptions::new()
        .compression(way.compression)
        .create(Cursor::new(Vec::new()))
        .unwrap();
    let channel_id = writer.add_channel(0, "/large", "x", &BTreeMap::new()).unwrap();
    for chunk in 0..10_u32 {
        for nth in 0..5_u32 {
            let header = mcap::records::MessageHeader {
                channel_id,
                sequence: 0,
                log_time: u64::from(10 * nth + chunk),
                publish_time: 0,
            };
            let mut body = vec![0; 2_000_000];
            body[..4].copy_from_slice(&(10 * nth + chunk).to_le_bytes());
            writer.write_to_known_channel(&header, &body).unwrap();
        }
        writer.flush().unwrap();
    }
    writer.finish().unwrap();
    let log = Log::of_bytes(writer.into_inner().into_inner()).unwrap();
    for (nth, message) in log.read_all().enumerate() {
        let message = message.unwrap();
        assert_eq!(message.time, nth as u64);
        assert_eq!(message.bytes[..4], (nth as u32).to_le_bytes());
    }
}
