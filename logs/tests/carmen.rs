//! CARMEN logs: made lines, and the logs of real robots, which are not part of the repository.

use std::{
    f64::consts::{FRAC_PI_2, PI},
    fs::File,
    io::{Read, Write},
    path::PathBuf,
    sync::Arc,
};

use flate2::{Compression, read::GzDecoder, write::GzEncoder};
use nalgebra::Point2;
use toposlam_logs::{
    Format,
    entries::{Content, Entry},
    error::{LogErrorKind, TruncationKind},
    reader::Log,
    record::EventKind,
    topic_map::{Role, TopicMap},
};
use toposlam_vision::laser::scan::{Reading, Scan};

use super::{entries, entries_of, map, recorded_logs};

fn error(text: &str) -> String {
    match Log::of_bytes(text.as_bytes().to_vec()) {
        Err(error) => error.to_string(),
        Ok(log) => entries_of(&log, &TopicMap::from_log(&log).unwrap()).unwrap_err(),
    }
}

/// The scans of a log, with the odometry and the time in nanoseconds of each.
fn scans(log: &Log) -> Vec<(u64, [f64; 3], Arc<Scan>)> {
    let scan = |entry: Entry| match entry.content {
        Content::Event(EventKind::Frame(frame)) => {
            let [x, y] = frame.odometry.position;
            Some((entry.time, [x, y, frame.odometry.heading], frame.scan?))
        }
        _ => None,
    };
    entries(log).into_iter().filter_map(scan).collect()
}

fn gzip(text: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(text).unwrap();
    encoder.finish().unwrap()
}

const SMALL: &str = "\
# message formats defined: PARAM SYNC ODOM FLASER RLASER
PARAM robot_frontlaser_offset 0.25 nohost 0
PARAM robot_rearlaser_offset -0.5 nohost 0
ODOM 1 2 0.5 0 0 0 10.5 host 10.5
FLASER 3 1.5 49.5 50 9 9 9 1 2 3 10.625 host 11
NEFF 0.7
SYNC here
ODOM 2 2 0.5 0 0 0 0 host 0
RLASER 3 1.5 81.9 0 9 9 9 4 5 6 11.5 host 11.5
ODOM 3 2 0.5 0 0 0 12 host 4.29497e+09
ODOM 4 2 0.5 0 0 0 12 host 12
";

#[test]
fn the_lines_of_a_carmen_log_are_scans_and_odometry() {
    for bytes in [SMALL.as_bytes().to_vec(), gzip(SMALL.as_bytes())] {
        let log = Log::of_bytes(bytes).unwrap();
        assert_eq!((log.format(), log.truncation()), (Format::Carmen, None));
        let topics = log.topics().iter().map(|topic| (&*topic.name, topic.messages));
        assert!(topics.eq([("ODOM", 2), ("FLASER", 1), ("RLASER", 1)]));
        let skipped = log.skipped().unwrap();
        assert_eq!(skipped.unknown, ["NEFF", "SYNC"].map(|kind| (kind.to_owned(), 1)).into());
        assert_eq!(skipped.off_clock, 2);
        assert_eq!((log.start(), log.end()), (Some(10_500_000_000), Some(12_000_000_000)));
        // The front scanner is preferred.
        let mapping = TopicMap::from_log(&log).unwrap();
        let topic = |role| &*mapping.carrier(role).unwrap().topic;
        assert_eq!((topic(Role::Scan), topic(Role::Odometry)), ("FLASER", "ODOM"));
        let [(time, odometry, scan)] = &scans(&log)[..] else { panic!() };
        // The logger's clock, and not the sender's.
        assert_eq!((*time, *odometry), (11_000_000_000, [1.0, 2.0, 3.0]));
        assert_eq!((scan.scanner(), scan.heading()), (Point2::new(0.25, 0.0), 0.0));
        let readings: Vec<_> = scan.readings().collect();
        let expected = [Reading::Hit(1.5), Reading::Hit(49.5), Reading::NoReturn];
        for ((bearing, reading), (index, expected)) in readings.iter().zip((0..).zip(expected)) {
            assert!((bearing - (f64::from(index) - 1.0) * FRAC_PI_2).abs() < 1e-12, "{readings:?}");
            assert_eq!(*reading, expected);
        }
        // The odometry of the scan is among that of the other lines.
        let x = |entry: Entry| match entry.content {
            Content::Event(EventKind::Odometry(odometry)) => Some(odometry.position[0]),
            _ => None,
        };
        assert!(entries(&log).into_iter().filter_map(x).eq([1.0, 1.0, 4.0]));
        let rear = entries_of(&log, &map("[scan]\ntopic = \"RLASER\"")).unwrap();
        let Content::Event(EventKind::Frame(frame)) = &rear[0].content else { panic!() };
        let scan = frame.scan.as_ref().unwrap();
        assert_eq!((scan.scanner(), scan.heading()), (Point2::new(-0.5, 0.0), PI));
        assert_eq!(frame.odometry.position, [4.0, 5.0]);
    }
}

#[test]
fn the_newer_message_records_its_angles_and_the_pose_of_its_scanner() {
    let log = "ROBOTLASER1 0 -1 2 1 20 0.01 0 3 1 20 nan 0 1 2.5 1.5707963 1 2 1.5707963 0 0 0 0 0 5 h 5\n";
    let log = Log::of_bytes(log.as_bytes().to_vec()).unwrap();
    let [(time, odometry, scan)] = &scans(&log)[..] else { panic!() };
    assert_eq!((*time, odometry[0], odometry[1]), (5_000_000_000, 1.0, 2.0));
    // Half a metre ahead of a robot that looks along y.
    let [x, y] = scan.scanner().into();
    assert!((x - 0.5).abs() < 1e-6 && y.abs() < 1e-6 && scan.heading().abs() < 1e-12);
    let readings: Vec<_> = scan.readings().collect();
    assert_eq!(
        readings,
        [(-1.0, Reading::Hit(1.0)), (0.0, Reading::NoReturn), (1.0, Reading::Invalid)]
    );
}

#[test]
fn a_wrong_line_is_an_error_with_its_number() {
    let odom = "ODOM 1 2 0 0 0 0 5 h 5\n";
    let ranges =
        "message 2, on FLASER: byte 31 of the message, `ranges`: \"h\" is not a number of its kind";
    let left = "message 2, on ODOM: byte 22 of the message: 1 words are left over";
    for (lines, message) in [
        ("FLASER 180 1 2 3 0 0 0 0 0 0 5 h 5", ranges),
        ("ODOM 1 2 0 0 0 0 5 h five", "its last word is not the time of the logger"),
        ("ODOM 1 2 nan 0 0 0 5 h 5", "message 2, on ODOM: its `theta` is NaN"),
        ("ODOM 1 2 0 0 0 0 5 h 5 5", left),
        ("FLASER 0 0 0 0 0 0 0 5 h 5", "message 2, on FLASER: the scan has no readings"),
    ] {
        let found = error(&format!("{odom}{lines}\n{odom}"));
        assert_eq!(found, format!("line 2: {message}"), "{lines}");
    }
    let jump = |lines| format!("{odom}\n{}", "ODOM 1 2 0 0 0 0 5 h 8000.25\n".repeat(lines));
    assert_eq!(Log::of_bytes(jump(9).into()).unwrap().skipped().unwrap().off_clock, 9);
    let expected = "line 3: the clock jumps from 5.000 s to 8000.250 s, and stays there";
    assert_eq!(error(&jump(10)), expected);
    let long = format!("{odom}FLASER {}", "1 ".repeat(600_000));
    assert_eq!(error(&long), "line 2: the line is longer than 1,048,576 bytes");
}

#[test]
fn a_compressed_database_that_was_cut_is_an_error_with_its_place() {
    let database = [b"SQLite format 3\0", &[7; 5000][..]].concat();
    let whole = gzip(&database);
    let error = |bytes: &[u8]| Log::of_bytes(bytes.to_vec()).err().unwrap();
    let cut = error(&whole[..whole.len() - 9]);
    assert!(matches!(cut.cause, LogErrorKind::CutDatabase) && cut.cause.is_damage(), "{cut}");
    assert!((16..=database.len() as u64).contains(&cut.offset), "{cut}");
    let cause = "the compressed database ends too early; a part of it cannot be read";
    assert_eq!(cut.to_string(), format!("byte {}: {cause}", cut.offset));
    // A whole one that is damaged is another error.
    assert!(!matches!(error(&whole).cause, LogErrorKind::CutDatabase));
}

#[test]
fn a_log_that_was_cut_is_read_up_to_its_last_whole_line() {
    let whole = SMALL.len();
    let cut = Log::of_bytes(SMALL.as_bytes()[..whole - 10].to_vec()).unwrap();
    let truncation = cut.truncation().unwrap();
    assert_eq!(truncation.to_string(), "truncated at line 11: it ends in the middle of a record");
    assert_eq!(cut.messages_total(), 3);
    // Without the end of its last line it is whole.
    let log = Log::of_bytes(SMALL.trim_end().as_bytes().to_vec()).unwrap();
    assert_eq!((log.truncation(), log.messages_total()), (None, 4));
    let text = SMALL.repeat(500);
    let packed = gzip(text.as_bytes());
    let cut = Log::of_bytes(packed[..packed.len() - 20].to_vec()).unwrap();
    assert_eq!(cut.truncation().unwrap().cause, TruncationKind::Compressed);
    assert!(cut.messages_total() > 3, "{}", cut.messages_total());
    let mut broken = packed;
    let middle = broken.len() / 2;
    broken[middle..middle + 8].fill(0xff);
    let error = Log::of_bytes(broken).map(|_| ()).unwrap_err().to_string();
    assert!(error.starts_with("cannot be read: ") && !error.contains('\n'), "{error}");
}

fn folder() -> Option<PathBuf> {
    recorded_logs("carmen", "TOPOSLAM_CARMEN_LOGS", "aces.log.gz")
}

/// The number of scans, of readings in each and of all odometry; of the lines off the clock, which are those
/// that an editor of these logs added with time 0, and a few at the end of the last one.
#[test]
fn the_logs_of_real_robots_are_read_as_awk_reads_them() {
    let Some(folder) = folder() else { return };
    for (name, count, readings, odometry) in
        [("aces", 440, 180, 7814), ("seattle", 241, 361, 19311), ("freiburg-079", 4791, 360, 9725)]
    {
        let path = folder.join(name).with_extension("log.gz");
        let log = Log::open(&path).unwrap();
        assert_eq!((log.format(), log.truncation()), (Format::Carmen, None));
        let found = scans(&log);
        assert_eq!(found.len(), count, "{name}");
        let skipped = log.skipped().unwrap();
        assert_eq!(skipped.unknown["NEFF"], count as u64);
        let messages = log.topics().iter().find(|topic| topic.name == "ODOM").unwrap().messages;
        assert_eq!(messages + skipped.off_clock, odometry, "{name}");
        // By another way: the words of the lines.
        let mut text = String::new();
        GzDecoder::new(File::open(&path).unwrap()).read_to_string(&mut text).unwrap();
        let lines = text.lines().filter(|line| line.starts_with("FLASER "));
        for ((time, odometry, scan), line) in found.iter().zip(lines) {
            let words: Vec<_> = line.split(' ').collect();
            let number = |index: usize| words[index].parse::<f64>().unwrap();
            assert_eq!(scan.ranges().len(), readings);
            let ranges = scan.ranges().iter().zip(&words[2..]);
            assert!(ranges.clone().all(|(range, word)| word.parse() == Ok(*range)), "{line}");
            assert_eq!(odometry[..2], [number(readings + 5), number(readings + 6)]);
            assert!((*time as f64 / 1e9 - number(words.len() - 1)).abs() < 1e-6);
        }
    }
}
