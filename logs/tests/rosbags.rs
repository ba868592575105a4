//! The same scans, written by PyPI's rosbags as a database of rosbag2, as MCAP, compressed, and as a ROS 1
//! bag.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

use toposlam_logs::{
    Format,
    entries::Content,
    reader::Log,
    record::EventKind,
    topic_map::{Role, TopicMap},
};
use toposlam_vision::laser::scan::Reading;

use super::entries;

fn written(name: &str) -> Option<PathBuf> {
    written_by("write_scans.py", name)
}

/// The folder of the logs that a script writes; `None`, and why, where Python has no rosbags.
pub(super) fn written_by(script: &str, name: &str) -> Option<PathBuf> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/oracle").join(script);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let has = Command::new("python3").args(["-c", "import rosbags"]).output();
    if !has.is_ok_and(|output| output.status.success()) {
        let required = env::var("TOPOSLAM_PYTHON_LOGS").is_ok_and(|is| is == "required");
        assert!(!required, "there is no python3 with rosbags");
        eprintln!("skipped: there is no python3 with rosbags");
        return None;
    }
    let output = Command::new("python3").arg("-B").arg(script).arg(&folder).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(folder)
}

type Found = (Vec<(u64, Vec<u32>, [f64; 3])>, Vec<(u64, [f64; 3])>);

fn read(log: &Log) -> Found {
    let mapping = TopicMap::from_log(log).unwrap();
    let topic = |role| &*mapping.carrier(role).unwrap().topic;
    assert_eq!((topic(Role::Scan), topic(Role::Odometry)), ("/scan", "/tf"));
    let (mut scans, mut odometry) = (Vec::new(), Vec::new());
    for entry in entries(log) {
        let stamp = entry.stamp.nanoseconds();
        match entry.content {
            Content::Event(EventKind::Frame(frame)) => {
                let scan = frame.scan.unwrap();
                let bits = scan.ranges().iter().map(|range| range.to_bits()).collect();
                let [x, y] = scan.scanner().into();
                scans.push((stamp, bits, [x, y, scan.heading()]));
                let kinds: Vec<_> = scan.readings().map(|(_, reading)| reading).collect();
                let [Reading::Hit(_), rest @ ..] = &kinds[..] else { panic!("{kinds:?}") };
                let [invalid, none] = [Reading::Invalid, Reading::NoReturn];
                assert_eq!(rest, [invalid, none, invalid, none]);
            }
            Content::Event(EventKind::Odometry(at)) => {
                odometry.push((stamp, [at.position[0], at.position[1], at.heading]));
            }
            other => panic!("{other:?}"),
        }
    }
    (scans, odometry)
}

#[test]
fn the_same_scans_are_read_from_every_format() {
    let Some(folder) = written("rosbags_scans") else { return };
    let mut logs = vec![
        ("mcap", Format::Folder),
        ("ros1.bag", Format::Bag),
        ("mcap/mcap.mcap", Format::Mcap),
        ("mcap-file-compressed", Format::Folder),
    ];
    if cfg!(feature = "sqlite") {
        logs.extend([
            ("database", Format::Folder),
            ("file-compressed", Format::Folder),
            ("message-compressed", Format::Folder),
            ("database/database.db3", Format::Database),
            ("file-compressed/file-compressed.db3.zstd", Format::Database),
        ]);
    }
    let found = logs.into_iter().map(|(name, format)| {
        let log = Log::open(&folder.join(name)).unwrap();
        let found = (log.format(), log.truncation(), log.messages_total());
        assert_eq!(found, (format, None, 15), "{name}");
        read(&log)
    });
    let found: Vec<Found> = found.collect();
    let (scans, odometry) = &found[0];
    assert_eq!((scans.len(), odometry.len()), (7, 7));
    let both = scans.iter().zip(odometry).enumerate();
    for (index, ((stamp, ranges, [x, y, heading]), (time, at))) in both {
        let nanoseconds = (index as u64 + 1) * 1_000_000_000;
        assert_eq!((*stamp, *time), (nanoseconds + 5, nanoseconds));
        assert_eq!(f32::from_bits(ranges[0]), 1.5 + index as f32);
        // Half a metre ahead of the centre, looking to the left; also before this was published.
        assert_eq!([*x, *y], [0.5, 0.0]);
        assert!((heading - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        let index = index as f64;
        assert_eq!(at[..2], [index / 2.0, -index / 4.0]);
        assert!((at[2] - index / 8.0).abs() < 1e-12);
    }
    assert!(found.iter().all(|other| *other == found[0]), "{found:?}");
    fs::remove_dir_all(folder).unwrap();
}

/// What a recorder leaves that crashes: no `metadata.yaml`.
#[test]
fn a_folder_without_metadata_is_all_its_files() {
    let Some(folder) = written("rosbags_crashed") else { return };
    let mcap = folder.join("mcap");
    fs::remove_file(mcap.join("metadata.yaml")).unwrap();
    assert_eq!(Log::open(&mcap).unwrap().messages_total(), 15);
    let bytes = fs::read(mcap.join("mcap.mcap")).unwrap();
    fs::write(mcap.join("mcap.mcap"), &bytes[..bytes.len() / 2]).unwrap();
    let truncation = Log::open(&mcap).unwrap().truncation().unwrap().to_string();
    assert!(truncation.starts_with("mcap.mcap: truncated at byte "), "{truncation}");
    for empty in ["", " \n"] {
        fs::write(mcap.join("metadata.yaml"), empty).unwrap();
        assert!(Log::open(&mcap).is_ok());
    }
    fs::write(mcap.join("metadata.yaml"), "a: [1").unwrap();
    let error = |folder: &Path| Log::open(folder).map(|_| ()).unwrap_err().to_string();
    assert!(error(&mcap).starts_with("metadata.yaml: line "), "{}", error(&mcap));
    fs::write(mcap.join("metadata.yaml"), "relative_file_paths: [gone.mcap]").unwrap();
    assert!(error(&mcap).starts_with("gone.mcap: cannot be read: "), "{}", error(&mcap));
    let empty = folder.join("empty");
    fs::create_dir(&empty).unwrap();
    assert_eq!(error(&empty), "this folder has no metadata.yaml, and no .db3 or .mcap file");
    if cfg!(feature = "sqlite") {
        let database = folder.join("database/database.db3");
        let mut bytes = fs::read(&database).unwrap();
        let middle = bytes.len() / 2;
        bytes.truncate(middle);
        let cut = Log::of_bytes(bytes).map(|_| ()).map_err(|error| error.to_string());
        assert!(cut.is_err_and(|error| error.starts_with("byte 0: the database: ")));
    }
    fs::remove_dir_all(folder).unwrap();
}
