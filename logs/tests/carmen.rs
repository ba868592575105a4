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
    Format, ReadingRemark,
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
        assert!(topics.eq([("ODOM", 4), ("FLASER", 1), ("RLASER", 1)]));
        let skipped = log.skipped().unwrap();
        assert_eq!(skipped.unknown, ["NEFF", "SYNC"].map(|kind| (kind.to_owned(), 1)).into());
        // The lines after scans need no time of their own.
        assert_eq!(log.irregular_times(), None);
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
        assert!(entries(&log).into_iter().filter_map(x).eq([1.0, 1.0, 2.0, 3.0, 4.0]));
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
fn a_wrong_line_is_skipped_unless_all_are_wrong() {
    let odom = "ODOM 1 2 0 0 0 0 5 h 5\n";
    let ranges = "on FLASER: byte 31 of the message, `ranges`: \"h\" is not a number of its kind";
    let five =
        "on ODOM: byte 21 of the message, `logger_timestamp`: \"five\" is not a number of its kind";
    for (line, message) in [
        ("FLASER 180 1 2 3 0 0 0 0 0 0 5 h 5", ranges),
        ("ODOM 1 2 0 0 0 0 5 h five", five),
        ("ODOM 1 2 nan 0 0 0 5 h 5", "on ODOM: its `theta` is NaN"),
        ("ODOM 1e30 2 0 0 0 0 5 h 5", "on ODOM: its pose is 1000000000000000000000000000000, 2, 0"),
        ("ODOM 1 2 0 0 0 0 5 h 5 5", "on ODOM: byte 22 of the message: 1 words are left over"),
        ("FLASER 0 0 0 0 0 0 0 5 h 5", "on FLASER: the scan has no readings"),
    ] {
        assert_eq!(error(&format!("{line}\n")), format!("line 1: message 1, {message}"), "{line}");
        let log = Log::of_bytes(format!("{odom}{line}\n{odom}").into()).unwrap();
        if line.starts_with("ODOM") {
            let map = TopicMap::from_log(&log).unwrap().bind(&log).unwrap();
            let mut read = log.entries(&map);
            assert_eq!(read.by_ref().map(Result::unwrap).count(), 2, "{line}");
            let first = format!("line 2: message 2, {message}");
            assert_eq!(read.remarks(), [ReadingRemark::Unusable { count: 1, first }]);
        }
    }
    // Ten are few.
    let many = |wrong| odom.repeat(20) + &"ODOM nan 2 0 0 0 0 5 h 5\n".repeat(wrong);
    let read = |wrong| {
        let log = Log::of_bytes(many(wrong).into()).unwrap();
        entries_of(&log, &TopicMap::from_log(&log).unwrap()).map(|entries| entries.len())
    };
    assert_eq!(read(10), Ok(20));
    let cause = "its `x` is NaN (at least 11 of 31 messages on the topic cannot be used)";
    assert_eq!(read(11), Err(format!("line 21: message 21, on ODOM: {cause}")));
    let long = format!("{odom}FLASER {}", "1 ".repeat(600_000));
    assert_eq!(error(&long), "line 2: the line is longer than 1,048,576 bytes");
}

/// The order of the lines decides, whatever their times.
#[test]
fn lines_are_read_in_their_order_whatever_their_times() {
    let line = |(number, time): (usize, &&str)| {
        format!("FLASER 2 1 1 0 0 0 {number} 0 0 {time} h {time}\nODOM {number} 0 0 0 0 0 0 h 0\n")
    };
    for (times, counts) in [
        (&["0", "0", "7.5", "1.25", "0", "8"][..], [2, 1, 0, 0]),
        (&["0", "-0.5", "-1", "4.29497e+09", "-2"], [0, 2, 1, 0]),
        (&["1.13486e+09", "1.13486e+09", "1.13487e+09"], [0, 0, 0, 3]),
        (&["5", "5.5", "8000.25", "8000.75", "9"], [0, 0, 2, 0]),
    ] {
        let text: String = times.iter().enumerate().map(line).collect();
        let log = Log::of_bytes(text.into()).unwrap();
        let read = scans(&log);
        assert!(read.iter().map(|(_, at, _)| at[0]).eq((0..times.len()).map(|place| place as f64)));
        assert!(read.is_sorted_by_key(|(time, ..)| *time), "{times:?}");
        let found = log.irregular_times().unwrap();
        assert_eq!([found.missing, found.back, found.ahead, found.rounded], counts, "{times:?}");
        assert!(!found.are_known());
    }
}

/// A scan of three readings, the pose of the robot if the line has it, and its odometry from other lines.
#[test]
fn the_kinds_of_scans_are_read_alike() {
    let odom = "ODOM 1 2 0.5 0 0 0 5 h 5\n";
    let angles = "0 -1.5707963 3.1415927 1.5707963 50 0.01 0 3 1.5 49.5 50 0";
    for (line, topic) in [
        ("FLASER 3 1.5 49.5 50 9 9 9 1 2 0.5 5 h 5".to_owned(), "FLASER"),
        (format!("RAWLASER1 {angles} 5 h 5"), "RAWLASER1"),
        (format!("ROBOTLASER1 {angles} 1 2 0.5 1 2 0.5 0 0 0 0 0 5 h 5"), "ROBOTLASER1"),
        // The corrected pose of the scanner is no mount.
        (format!("ROBOTLASER1 {angles} 9 9 2 1 2 0.5 0 0 0 0 0 5 h 5"), "ROBOTLASER1"),
        ("LASER_READING 3 1.5 49.5 50 1 2 0.5 5".to_owned(), "LASER_READING"),
    ] {
        for odom in [odom, "ODOM 1 2 0.5 5\n"] {
            let log = Log::of_bytes(format!("{odom}{line}\n").into()).unwrap();
            let map = TopicMap::from_log(&log).unwrap();
            assert_eq!(map.carrier(Role::Scan).unwrap().topic, topic);
            let [(time, odometry, scan)] = &scans(&log)[..] else { panic!("{line}") };
            assert_eq!((*time, *odometry), (5_000_000_000, [1.0, 2.0, 0.5]), "{line}");
            assert!(scan.scanner().coords.norm() < 1e-6 && scan.heading().abs() < 1e-6, "{line}");
            let readings: Vec<_> = scan.readings().map(|(_, reading)| reading).collect();
            assert_eq!(readings, [Reading::Hit(1.5), Reading::Hit(49.5), Reading::NoReturn]);
        }
    }
    let offsets = "PARAM robot_frontlaser_offset 0.25 h 0\nPARAM robot_frontlaser_side_offset -0.5 h 0\n\
                   PARAM robot_frontlaser_angular_offset 90 h 0\n";
    let log = Log::of_bytes(format!("{offsets}{odom}RAWLASER1 {angles} 5 h 5\n").into()).unwrap();
    let [(_, _, scan)] = &scans(&log)[..] else { panic!() };
    assert_eq!((scan.scanner(), scan.heading()), (Point2::new(0.25, -0.5), FRAC_PI_2));
}

#[test]
fn a_scanner_sees_nothing_at_a_range_below_the_one_that_its_driver_states() {
    let line = |kind: &str, ranges: &str, tail: &str| {
        format!(
            "ODOM 0 0 0 0 0 0 5 h 5\n{kind} 0 -1.5707963 3.1415927 1.5707963 81.92 0.01 0 3 {ranges} 0 {tail}5 h 5\n"
        )
    };
    for (kind, tail) in [("RAWLASER1", ""), ("ROBOTLASER1", "0 0 0 0 0 0 0 0 0 0 0 ")] {
        for (none, range, wall) in [("50", 50.0, 49.5), ("81.91", 81.91, 60.0)] {
            let one = line(kind, &format!("1.5 2.5 {none}"), tail);
            let text = one.repeat(60) + &line(kind, &format!("1.5 {wall} {none}"), tail);
            let log = Log::of_bytes(text.into()).unwrap();
            let read = scans(&log);
            let (_, _, scan) = read.last().unwrap();
            let last: Vec<_> = scan.readings().map(|(_, reading)| reading).collect();
            assert_eq!(last, [Reading::Hit(1.5), Reading::Hit(wall), Reading::NoReturn], "{kind}");
            // The bin of a centimetre in which the sign is.
            let range_max = scan.geometry().range_max;
            assert!((range - 0.011..=range).contains(&range_max), "{kind}: {range_max}");
        }
    }
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
    assert_eq!(cut.messages_total(), 5);
    // Without the end of its last line it is whole.
    let log = Log::of_bytes(SMALL.trim_end().as_bytes().to_vec()).unwrap();
    assert_eq!((log.truncation(), log.messages_total()), (None, 6));
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

/// The number of scans, of readings in each and of all odometry, with the lines that an editor of these logs added
/// with time 0.
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
        assert_eq!(messages, odometry, "{name}");
        assert_eq!(log.irregular_times(), None, "{name}");
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
