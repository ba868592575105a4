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
