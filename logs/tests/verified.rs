//! Every flipped byte that a checksum covers is noticed.

use std::io::Read;

use bzip2::read::BzDecoder;
use toposlam_logs::{Format, reader::Log, verify::Verification};

use super::written::{Closed, Said, bag, files, in_order, mcap_file, ways};

/// What is found in a log, or `None` if it cannot be opened or is truncated.
fn verified(bytes: Vec<u8>) -> Option<Verification> {
    let log = Log::of_bytes(bytes).ok()?;
    log.truncation().is_none().then(|| log.verify(&()).unwrap())
}

fn is_noticed(bytes: &[u8], at: usize) -> bool {
    let mut bytes = bytes.to_vec();
    bytes[at] ^= 0x55;
    verified(bytes).is_none_or(|found| !found.damage.is_empty())
}

fn chunks() -> [Vec<Said>; 2] {
    let all = in_order(12);
    [all[..5].to_vec(), all[5..].to_vec()]
}

#[test]
fn a_good_log_is_verified() {
    let [one, two] = chunks();
    for file in files(&[&one, &two]) {
        let (name, size) = (file.name, file.bytes.len() as u64);
        let found = verified(file.bytes).unwrap();
        assert!(found.complete && found.damage.is_empty(), "{name}: {found:?}");
        assert_eq!((found.messages, found.chunks), (12, if file.chunked { 2 } else { 0 }));
        if file.format == Format::Mcap {
            // All but the record that ends the data section, the footer's checksum and the end.
            assert!(found.covered + 30 >= size, "{name}: {} of {size}", found.covered);
        } else {
            // Only bzip2 has a checksum: the frames of LZ4 have none here.
            assert_eq!(found.covered > 0, name.ends_with("bz2"));
        }
    }
}

#[test]
fn every_flipped_byte_of_an_mcap_file_is_noticed() {
    let [one, two] = chunks();
    for way in ways() {
        let bytes = mcap_file(&[&one, &two], way);
        let unnoticed: Vec<_> = (0..bytes.len()).filter(|&at| !is_noticed(&bytes, at)).collect();
        assert!(unnoticed.is_empty(), "{way:?}: {unnoticed:?} of {}", bytes.len());
    }
}

/// The places of the records of an MCAP file with an opcode.
fn records(bytes: &[u8], wanted: u8) -> Vec<usize> {
    let (mut at, mut found) = (8, Vec::new());
    while at + 9 <= bytes.len() - 8 {
        if bytes[at] == wanted {
            found.push(at);
        }
        at += 9 + u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap()) as usize;
    }
    found
}

#[test]
fn an_index_that_lists_few_of_the_chunks_is_noticed() {
    let [one, two] = chunks();
    let way = ways().into_iter().find(|way| way.summary && way.chunked).unwrap();
    let mut whole = mcap_file(&[&one, &two], way);
    // Without the checksum of the summary.
    let footer = records(&whole, 2)[0];
    whole[footer + 25..footer + 29].fill(0);
    assert!(verified(whole.clone()).unwrap().damage.is_empty());
    let [first, second] = records(&whole, 8)[..] else { panic!() };
    let mut dropped = whole.clone();
    dropped[second] = 0x80;
    let mut same = whole;
    same.copy_within(first + 25..first + 33, second + 25);
    for bytes in [dropped, same] {
        let damage = verified(bytes).unwrap().damage;
        let expected =
            format!("byte {first}: the index lists 1 of the 2 chunks, or some of them twice");
        assert_eq!(damage.iter().map(ToString::to_string).collect::<Vec<_>>(), [expected]);
    }
}

#[test]
fn zeros_at_the_end_are_a_truncation_and_an_encrypted_bag_is_named() {
    let [one, two] = chunks();
    for file in files(&[&one, &two]) {
        let mut bytes = file.bytes;
        let half = bytes.len() / 2;
        bytes.truncate(half);
        bytes.extend([0; 1000]);
        let log = Log::of_bytes(bytes).unwrap();
        assert!(log.truncation().is_some_and(|cut| cut.offset <= half as u64), "{}", file.name);
    }
    let field = |text: &[u8]| [&(text.len() as u32).to_le_bytes(), text].concat();
    let bag = |name: &str| {
        let fields =
            [field(b"op=\x03"), field(b"index_pos=\0\0\0\0\0\0\0\0"), field(name.as_bytes())];
        let header = field(&fields.concat());
        Log::of_bytes([b"#ROSBAG V2.0\n".to_vec(), header, field(&[b' '; 20])].concat())
    };
    assert!(bag("encryptor=rosbag/NoEncryptor").is_ok());
    let error = bag("encryptor=rosbag/AesCbcEncryptor").err().unwrap();
    assert_eq!(
        error.to_string(),
        "the bag is encrypted (rosbag/AesCbcEncryptor): decrypt it first, with `rosbag decrypt`"
    );
    assert!(!error.cause.is_damage());
}

/// What is compressed, if it can be decompressed.
fn decompressed(chunk: &[u8]) -> Option<Vec<u8>> {
    let mut records = Vec::new();
    BzDecoder::new(chunk).read_to_end(&mut records).ok().map(|_| records)
}

/// A table that no symbol is coded with may be flipped: the records are the same.
#[test]
fn every_flipped_byte_of_a_bz2_chunk_is_noticed_or_changes_no_record() {
    let [one, two] = chunks();
    let bytes = bag(&[&one, &two], "bz2", Closed::Yes);
    let starts: Vec<_> = (0..bytes.len()).filter(|&at| bytes[at..].starts_with(b"BZh")).collect();
    assert_eq!(starts.len(), 2);
    for start in starts {
        let length = u32::from_le_bytes(bytes[start - 4..start].try_into().unwrap()) as usize;
        let chunk = &bytes[start..start + length];
        let mut unnoticed = 0;
        for at in 0..length {
            if !is_noticed(&bytes, start + at) {
                let mut flipped = chunk.to_vec();
                flipped[at] ^= 0x55;
                assert_eq!(decompressed(&flipped), decompressed(chunk), "byte {at} of {length}");
                unnoticed += 1;
            }
        }
        assert!(unnoticed < length / 4, "{unnoticed} of {length}");
    }
}

#[test]
fn a_message_in_a_bag_without_compression_is_not_protected() {
    let [one, two] = chunks();
    let bytes = bag(&[&one, &two], "none", Closed::Yes);
    let word = bytes.windows(4).rposition(|part| part == b"word").unwrap();
    assert!(!is_noticed(&bytes, word));
}

#[test]
fn the_index_is_compared_with_the_messages() {
    let all = in_order(12);
    let mut bytes = bag(&[&all], "none", Closed::Yes);
    // The last message gets another connection; its index has the old one.
    let conn = bytes.windows(5).enumerate().filter(|(_, part)| *part == b"conn=");
    let of_messages: Vec<_> = conn.map(|(at, _)| at + 5).collect();
    let message =
        of_messages.iter().copied().filter(|&at| bytes[at + 4..].starts_with(b"\x0d\0\0\0time="));
    let last = message.max().unwrap();
    bytes[last] = (bytes[last] + 1) % 3;
    let found = verified(bytes).unwrap();
    assert!(found.damage[0].to_string().contains("the index counts "), "{found:?}");
}
