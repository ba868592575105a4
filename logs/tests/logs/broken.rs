//! Damaged logs: one error message with its place, and no bytes make a reader panic.

use proptest::prelude::*;
use toposlam_logs::{decode::decode, reader::Log};

use super::written::{Closed, Said, Way, bag, in_order, mcap_file, ways};

/// Reads everything. Returns the error, if there is one.
fn read(bytes: &[u8]) -> Result<Vec<u64>, String> {
    let log = Log::of_bytes(bytes.to_vec()).map_err(|error| error.to_string())?;
    let mut numbers = Vec::new();
    for message in log.read_all() {
        let message = message.map_err(|error| error.to_string())?;
        let definition = log.topics()[message.topic].definition.as_ref();
        if let Ok(definition) = definition {
            let _ = decode(definition, &message.bytes).map_err(|error| error.to_string());
        }
        numbers.push(message.number);
    }
    Ok(numbers)
}

fn find(bytes: &[u8], what: &[u8]) -> usize {
    bytes.windows(what.len()).position(|part| part == what).unwrap()
}

/// A bag with one compressed chunk whose bytes were changed.
fn changed(mut bytes: Vec<u8>, change: impl FnOnce(&mut Vec<u8>)) -> String {
    change(&mut bytes);
    read(&bytes).unwrap_err()
}

const ZSTD: Way =
    Way { ros1: false, compression: Some(mcap::Compression::Zstd), chunked: true, summary: true };
const PLAIN: Way = Way { compression: None, ..ZSTD };

#[test]
fn other_files_are_refused() {
    let no_log = "byte 0: this is not a log; it must be a ROS 1 bag, an MCAP file, a rosbag2 folder or .db3 \
        file, a CARMEN log, or events as JSON lines or CSV";
    for bytes in [&b""[..], b"name = \"x\"", b"\x89MCAP", b"\x89PNG\r\n\x1a\n", b"#ROSBAG"] {
        assert_eq!(read(bytes).unwrap_err(), no_log);
    }
    assert_eq!(
        read(b"#ROSBAG V1.2\nx").unwrap_err(),
        "byte 0: this is a bag of version 1.2; only version 2.0 can be read"
    );
}

#[test]
fn damaged_chunks_are_reported() {
    let all = in_order(9);
    let bag = |compression| bag(&[&all], compression, Closed::Yes);
    let message = read(&bag("zip")).unwrap_err();
    assert!(
        message.ends_with("the compression \"zip\" is not known; known are none, bz2 and lz4"),
        "{message}"
    );
    let size = |bytes: &[u8]| find(bytes, b"size=") + 5;
    for compression in ["bz2", "lz4"] {
        let message = changed(bag(compression), |bytes| {
            let size = size(bytes);
            bytes[size..size + 4].fill(255);
        });
        assert!(
            message.contains("claim a size of 4294967295; the limit is a factor of 1000"),
            "{message}"
        );
        let message = changed(bag(compression), |bytes| {
            let size = size(bytes);
            bytes[size] ^= 1;
        });
        assert!(
            message.contains("the chunk has ") && message.contains(" bytes and claims "),
            "{message}"
        );
        let message = changed(bag(compression), |bytes| {
            let data = size(bytes) + 12;
            bytes[data..data + 20].fill(9);
        });
        assert!(message.contains("the chunk cannot be decompressed: "), "{message}");
    }
    let message = changed(bag("none"), |bytes| {
        let size = size(bytes);
        bytes[size] ^= 1;
    });
    assert!(
        message.ends_with("an uncompressed chunk has another length than its header states"),
        "{message}"
    );
}

#[test]
fn damaged_mcap_files_are_reported() {
    let all = in_order(9);
    let message = changed(mcap_file(&[&all], PLAIN), |bytes| {
        let word = find(bytes, b"word\0");
        bytes[word] = b'W';
    });
    assert!(message.ends_with("the checksum of the chunk is wrong"), "{message}");
    let message = changed(mcap_file(&[&all], ZSTD), |bytes| {
        let name = find(bytes, b"zstd");
        bytes[name] = b'Z';
    });
    assert!(
        message.ends_with("the compression \"Zstd\" is not known; known are lz4 and zstd"),
        "{message}"
    );
    let message = changed(mcap_file(&[&all], ZSTD), |bytes| {
        let size = find(bytes, b"zstd") - 16;
        bytes[size..size + 8].fill(255);
    });
    assert!(message.contains("claim a size of 18446744073709551615"), "{message}");
    let message = changed(mcap_file(&[&all], ZSTD), |bytes| {
        let chunk = find(bytes, b"zstd") - 32;
        bytes[chunk] += 1;
    });
    assert!(message.ends_with("a message has an earlier time than its chunk"), "{message}");
}

#[test]
fn messages_of_unknown_connections_are_reported() {
    let said: [Said; 2] = [(0, 1, 0), (1, 2, 1)];
    let message = changed(bag(&[&said], "none", Closed::No), |bytes| {
        let conn = b"conn=\x01\0\0\0";
        let record = find(bytes, conn);
        let message = record + 1 + find(&bytes[record + 1..], conn);
        bytes[message + 5] = 7;
    });
    assert!(message.contains("a message of connection 7, which has no record"), "{message}");
}

/// Some bytes of a log are changed.
fn damaged() -> impl Strategy<Value = Vec<u8>> {
    let all = in_order(8);
    let mut logs: Vec<Vec<u8>> =
        ways().into_iter().map(|way| mcap_file(&[&all[..5], &all[5..]], way)).collect();
    for compression in ["none", "bz2", "lz4"] {
        for closed in [Closed::Yes, Closed::No] {
            logs.push(bag(&[&all[..5], &all[5..]], compression, closed));
        }
    }
    let changes = proptest::collection::vec(
        (any::<prop::sample::Index>(), prop_oneof![Just(0), Just(255), any::<u8>()]),
        1..6,
    );
    (prop::sample::select(logs), changes, any::<Option<prop::sample::Index>>()).prop_map(
        |(mut log, changes, cut)| {
            for (at, byte) in changes {
                let at = at.index(log.len());
                log[at] = byte;
            }
            if let Some(cut) = cut {
                log.truncate(cut.index(log.len()));
            }
            log
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn no_damage_makes_a_reader_panic(log in damaged()) {
        if let Err(message) = read(&log) {
            prop_assert!(!message.is_empty() && !message.contains(char::is_control), "{message:?}");
        }
    }

    #[test]
    fn no_bytes_make_a_reader_panic(bytes: Vec<u8>) {
        for magic in [&b"#ROSBAG V2.0\n"[..], b"\x89MCAP0\r\n", b""] {
            let _ = read(&[magic, &bytes].concat());
        }
    }
}
