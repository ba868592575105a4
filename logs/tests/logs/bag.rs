//! ROS 1 bags.

use toposlam_logs::{Format, error::TruncationKind, reader::Log};

use super::written::{Closed, Said, bag, in_order, said};

const COMPRESSIONS: [&str; 3] = ["none", "bz2", "lz4"];

#[test]
fn a_bag_is_read_with_any_compression() {
    let all = in_order(40);
    for compression in COMPRESSIONS {
        let log = Log::of_bytes(bag(&[&all[..15], &all[15..]], compression, Closed::Yes)).unwrap();
        assert_eq!((log.format(), log.truncation()), (Format::Bag, None));
        assert_eq!(log.messages_total(), 40);
        assert_eq!((log.start(), log.end()), (Some(all[0].1), Some(all[39].1)));
        assert_eq!(
            log.topics().iter().map(|topic| topic.messages).collect::<Vec<_>>(),
            [14, 13, 13]
        );
        assert_eq!(said(&log), all);
        // The messages of one topic keep their numbers.
        let one: Vec<_> = log.read(&[1]).map(|message| message.unwrap().number).collect();
        assert_eq!(one, (2..40).step_by(3).collect::<Vec<_>>());
    }
}

#[test]
fn a_bag_without_an_index_is_read_and_reported_as_not_closed() {
    let all = in_order(40);
    for compression in COMPRESSIONS {
        let bytes = bag(&[&all[..15], &all[15..]], compression, Closed::No);
        let length = bytes.len() as u64;
        let log = Log::of_bytes(bytes).unwrap();
        let truncation = log.truncation().unwrap();
        assert_eq!((truncation.offset, &truncation.cause), (length, &TruncationKind::Index));
        assert_eq!(log.messages_total(), 40);
        assert_eq!(said(&log), all);
    }
}

#[test]
fn messages_come_in_order_of_time_for_any_order_of_chunks() {
    let chunks: [&[Said]; 4] = [
        &[(0, 50, 0), (1, 10, 1), (0, 10, 2)],
        &[(1, 10, 3), (0, 5, 4), (0, 60, 5)],
        &[(0, 1, 6)],
        &[(0, 50, 7)],
    ];
    let log = Log::of_bytes(bag(&chunks, "none", Closed::Yes)).unwrap();
    let numbers: Vec<_> = said(&log).into_iter().map(|(_, _, number)| number).collect();
    assert_eq!(numbers, [6, 4, 1, 2, 3, 0, 7, 5]);
}

#[test]
fn a_truncated_bag_is_read_up_to_the_cut() {
    let all = in_order(12);
    for compression in COMPRESSIONS {
        for closed in [Closed::Yes, Closed::No] {
            let bytes = bag(&[&all[..4], &all[4..8], &all[8..]], compression, closed);
            let mut most = 0;
            for length in 13..bytes.len() {
                let log = Log::of_bytes(bytes[..length].to_vec()).unwrap();
                let truncation = log.truncation().unwrap();
                assert!(truncation.offset <= length as u64, "{length}: {truncation}");
                let said = said(&log);
                assert_eq!(said, all[..said.len()], "{length}");
                assert_eq!(said.len() as u64, log.messages_total());
                assert!(said.len() >= most && said.len().is_multiple_of(4), "{length}");
                most = said.len();
            }
            assert_eq!(most, if closed == Closed::Yes { 12 } else { 8 });
        }
    }
}

#[test]
fn a_chunk_of_a_crashed_recorder_is_read() {
    // The placeholder that rosbag writes as the length of a chunk before the length is known.
    let all = in_order(8);
    let mut bytes = bag(&[&all], "none", Closed::No);
    let find = |bytes: &[u8], what: &[u8]| {
        bytes.windows(what.len()).position(|part| part == what).unwrap()
    };
    let size = find(&bytes, b"size=") + 5;
    bytes[size..size + 8].fill(0);
    assert_eq!(said(&Log::of_bytes(bytes.clone()).unwrap()), all);
    // The compressed rest is lost.
    let mut bytes = bag(&[&all[..4], &all[4..]], "bz2", Closed::No);
    let first = find(&bytes, b"BZh");
    let second = first + 3 + find(&bytes[first + 3..], b"BZh");
    bytes[second - 8..second].fill(0);
    let log = Log::of_bytes(bytes).unwrap();
    assert_eq!(said(&log), all[..4]);
    assert_eq!(log.truncation().unwrap().offset, second as u64);
}
