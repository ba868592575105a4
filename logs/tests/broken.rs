//! Damaged logs: one error message with its place. The fuzz targets read any bytes.

use toposlam_logs::reader::Log;

use super::{
    position,
    written::{Closed, Said, Way, bag, in_order, mcap_file},
};

/// The error of a log that is opened and read.
fn error_of(bytes: Vec<u8>) -> String {
    match Log::of_bytes(bytes) {
        Ok(log) => log.read_all().find_map(Result::err).unwrap().to_string(),
        Err(error) => error.to_string(),
    }
}

type Change = fn(&mut [u8]);

/// The error of a log that is changed from so many bytes before a place on.
fn changed(mut bytes: Vec<u8>, place: &[u8], before: usize, change: Change) -> String {
    let at = position(&bytes, place) - before;
    change(&mut bytes[at..]);
    error_of(bytes)
}

const ZSTD: Way =
    Way { ros1: false, compression: Some(mcap::Compression::Zstd), chunked: true, summary: true };
const PLAIN: Way = Way { compression: None, ..ZSTD };

#[test]
fn other_files_are_refused() {
    let no_log = "byte 0: this is not a log; it must be a ROS 1 bag, an MCAP file, a rosbag2 folder or .db3 \
        file, a CARMEN log, or events as JSON lines or CSV";
    for bytes in [&b""[..], b"name = \"x\"", b"\x89MCAP", b"\x89PNG\r\n\x1a\n", b"#ROSBAG"] {
        assert_eq!(error_of(bytes.to_vec()), no_log);
    }
    let older = "byte 0: this is a bag of version 1.2; only version 2.0 can be read";
    assert_eq!(error_of(b"#ROSBAG V1.2\nx".to_vec()), older);
}

#[test]
fn damaged_chunks_are_reported() {
    // The size of the chunk; behind it its length and its bytes.
    let all = in_order(9);
    let bag = |compression| bag(&[&all], compression, Closed::Yes);
    let growth = "claim a size of 4294967295; the limit is a factor of 1000";
    let cases: [(&[&str], Change, &str); 5] = [
        (&["zip"], |_| {}, "the compression \"zip\" is not known; known are none, bz2 and lz4"),
        (&["bz2", "lz4"], |at| at[5..9].fill(255), growth),
        (&["bz2", "lz4"], |at| at[5] ^= 1, " bytes and claims "),
        (&["bz2", "lz4"], |at| at[17..37].fill(9), "the chunk cannot be decompressed: "),
        (
            &["none"],
            |at| at[5] ^= 1,
            "an uncompressed chunk has another length than its header states",
        ),
    ];
    for (compressions, change, expected) in cases {
        for compression in compressions {
            let message = changed(bag(compression), b"size=", 0, change);
            assert!(message.contains(expected), "{compression}: {message}");
        }
    }
}

#[test]
fn damaged_mcap_files_are_reported() {
    let all = in_order(9);
    let unknown = "the compression \"Zstd\" is not known; known are lz4 and zstd";
    let growth = "claim a size of 18446744073709551615; the limit is a factor of 1000";
    // The name of the compression is behind the times, the size and the checksum of the chunk.
    let cases: [(Way, &[u8], usize, Change, &str); 4] = [
        (PLAIN, b"word\0", 0, |at| at[0] = b'W', "the checksum of the chunk is wrong"),
        (ZSTD, b"zstd", 0, |at| at[0] = b'Z', unknown),
        (ZSTD, b"zstd", 16, |at| at[..8].fill(255), growth),
        (ZSTD, b"zstd", 32, |at| at[0] += 1, "a message has an earlier time than its chunk"),
    ];
    for (way, place, before, change, expected) in cases {
        let message = changed(mcap_file(&[&all], way), place, before, change);
        assert!(message.ends_with(expected), "{message}");
    }
}

#[test]
fn messages_of_unknown_connections_are_reported() {
    let said: [Said; 2] = [(0, 1, 0), (1, 2, 1)];
    // The first place is in the record of the connection, the second in that of the message.
    let message = changed(bag(&[&said], "none", Closed::No), b"conn=\x01", 0, |record| {
        let message = 1 + position(&record[1..], b"conn=\x01");
        record[message + 5] = 7;
    });
    assert!(message.contains("a message of connection 7, which has no record"), "{message}");
}
