//! Fuzz targets: the properties of the log readers on any bytes.
//!
//! cargo-fuzz runs each target from `fuzz/`, and `tests/fuzz.rs` runs it on stable Rust, on the
//! seeds in `fuzz/corpus/` and on mutations of them. A target panics if its property is violated.

#![expect(clippy::missing_panics_doc, reason = "a target panics if its property is violated")]

use std::fmt;

use toposlam_logs::{
    Format,
    decode::decode,
    definition::{Definition, Dialect},
    reader::Log,
    rosbag2,
    topic_map::TopicMap,
    value::Value,
};
use toposlam_model::{
    enumerate::Class,
    folding::WorldSearch,
    mapping::MappingAlgorithm,
    marker::{Directional, MarkerKind, NoMarker},
};
use toposlam_robot::budget::RunBudget;

use crate::{
    ConformConfig, Evidence, ExtractConfig, ExtractedRun, Quirks, RunDriver, extract, judge,
};

/// A target and its name, which is also the name in `fuzz/` and of the folder of its seeds.
pub type LogFuzzTarget = (&'static str, fn(&[u8]));

pub const TARGETS: &[LogFuzzTarget] = &[
    ("bag", bag),
    ("mcap", mcap),
    ("ros1_message", ros1_message),
    ("cdr_message", cdr_message),
    ("log_mapping", log_mapping),
    ("carmen", carmen),
    ("events", events),
    ("rosbag2_metadata", rosbag2_metadata),
    ("database_rows", database_rows),
];

pub use self::{log as bag, log as mcap, log as carmen, log as events};

/// Any bytes are read as a log of any format, whole or truncated, perhaps compressed. Its messages come in the order
/// of their times with consecutive numbers, and the run in it can be read up to its end and judged; or there is
/// one error message.
pub fn log(bytes: &[u8]) {
    let log = match Log::of_bytes(bytes.to_vec()) {
        Ok(log) => log,
        Err(error) => return assert_is_a_message(&error),
    };
    let [mut last, mut number] = [0; 2];
    for message in log.read_all() {
        let message = match message {
            Ok(message) => message,
            Err(error) => {
                assert_is_a_message(&error);
                break;
            }
        };
        number += 1;
        assert_eq!(message.number, number);
        assert!(message.time >= last, "{} comes after {last}", message.time);
        // Offsets are those of the decompressed file, and lines and rows are no bytes.
        let is_plain =
            matches!(log.format(), Format::Bag | Format::Mcap) && log.compression().is_none();
        assert!(!is_plain || message.offset < log.size());
        last = message.time;
        if let Some(Err(error)) =
            log.topics().get(message.topic).and_then(|topic| topic.decode(&message.bytes))
        {
            assert_is_a_message(&error);
        }
    }
    if let Some(truncation) = log.truncation() {
        assert_is_a_message(truncation);
    }
    let mapping = TopicMap::unambiguous(&log);
    read_run(&log, &mapping);
    judge_run(&log, &mapping);
}

/// Any bytes are the metadata of a rosbag2 folder: they name files in it, and no others; or there is one
/// error message.
pub fn rosbag2_metadata(bytes: &[u8]) {
    match rosbag2::file_names(bytes) {
        Ok(names) => {
            assert!(!names.is_empty());
            assert!(
                names.iter().all(|name| !name.contains(['/', '\\']) && name != ".."),
                "{names:?}"
            );
        }
        Err(error) => assert_is_a_message(&error),
    }
}

/// Any bytes are rows of the table of messages in a database of rosbag2: a number, a topic, a time and a
/// length of a byte each, and the message. They are read as in [`log`].
pub fn database_rows(bytes: &[u8]) {
    #[cfg(feature = "sqlite")]
    match database::of_rows(bytes) {
        Ok(file) => log(&file),
        Err(error) => panic!("the database of the rows: {error}"),
    }
    #[cfg(not(feature = "sqlite"))]
    let _ = bytes;
}

#[cfg(feature = "sqlite")]
pub mod database;

fn read_run(log: &Log, mapping: &TopicMap) {
    match mapping.bind(log) {
        Ok(bound) => {
            if let Some(Err(error)) = log.entries(&bound).find(Result::is_err) {
                assert_is_a_message(&error);
            }
        }
        Err(error) => assert_is_a_message(&error),
    }
}

/// Judges the run in a log without images, whatever chose its doors: it diverges at one of its events or at
/// its end, or not; or there is an error.
fn judge_run(log: &Log, mapping: &TopicMap) {
    let Some(evidence) = Evidence::from_topics(mapping) else { return };
    let config = ExtractConfig { marked: true, ..ExtractConfig::new(evidence) };
    let ExtractedRun { events, .. } = match extract(log, mapping, &config, &()) {
        Ok(run) => run,
        Err(error) => return assert_is_a_message(&error),
    };
    let by = |driver: RunDriver, marker: MarkerKind| ConformConfig {
        world: None,
        aid: marker.into(),
        driver,
        budget: RunBudget::default(),
        search: WorldSearch { class: Class::Multigraph, max_edges: None, steps: 100 },
        dart_bound: 50,
    };
    for config in [
        by(MappingAlgorithm::Algorithm1.into(), Directional),
        by(MappingAlgorithm::Folding.into(), Directional),
        by(RunDriver::Anyone, NoMarker),
    ] {
        match judge(events.clone(), &config, &Quirks::default(), &()) {
            Ok(judgement) => {
                if let Some(divergence) = judgement.divergence {
                    assert!(divergence.event <= events.events.len());
                    assert_is_a_message(&divergence.cause);
                }
            }
            Err(error) => assert_is_a_message(&error),
        }
    }
}

/// Any bytes are a message definition and, after a zero byte, a message of it in the serialization
/// of ROS 1. No prefix of the message is a message too. Or there is one error message.
pub fn ros1_message(bytes: &[u8]) {
    if let Some((definition, message)) = parts(Dialect::Ros1, bytes)
        && message_of(&definition, message)
        && let Some((_, shorter)) = message.split_last()
    {
        assert!(decode(&definition, shorter).is_err(), "{definition:?}");
    }
}

/// The same for CDR.
pub fn cdr_message(bytes: &[u8]) {
    if let Some((definition, message)) = parts(Dialect::Ros2, bytes) {
        message_of(&definition, message);
    }
}

fn parts(dialect: Dialect, bytes: &[u8]) -> Option<(Definition, &[u8])> {
    let mut parts = bytes.splitn(2, |&byte| byte == 0);
    let (text, message) = (parts.next()?, parts.next().unwrap_or_default());
    match Definition::read(dialect, "a/A", &String::from_utf8_lossy(text)) {
        Ok(definition) => Some((definition, message)),
        Err(error) => {
            assert_is_a_message(&error);
            None
        }
    }
}

/// Whether bytes are a message. If so, each of its fields is where the definition says.
fn message_of(definition: &Definition, bytes: &[u8]) -> bool {
    let value = match decode(definition, bytes) {
        Ok(value) => value,
        Err(error) => {
            assert!(error.offset <= bytes.len());
            assert_is_a_message(&error);
            return false;
        }
    };
    for field in &definition.root().fields {
        assert!(value.at(&field.name).is_some() && definition.at(&field.name).is_some());
        let Some(found) = value.at(&field.name) else { continue };
        let _ = (found.f64(), found.i64(), found.u64(), found.text(), found.stamp(), found.bytes());
        if let Value::Numbers(numbers) = found {
            assert_eq!(numbers.iter().count(), numbers.len());
        }
    }
    true
}

/// A log with a topic of every kind.
const LOG: &[u8] = include_bytes!("../../fuzz/corpus/mcap/of-a-run");

/// Any bytes are a topic map file. It is written so that it reads as the same, and fits a log or
/// does not; or there is one error message.
pub fn log_mapping(bytes: &[u8]) {
    let mapping = match TopicMap::read(bytes) {
        Ok(mapping) => mapping,
        Err(error) => return assert_is_a_message(&error),
    };
    let text = mapping.to_toml();
    match TopicMap::read(text.as_bytes()) {
        Ok(again) => assert_eq!(again.to_toml(), text),
        Err(error) => panic!("{error}\n{text}"),
    }
    match Log::of_bytes(LOG.to_vec()) {
        Ok(log) => read_run(&log, &mapping),
        Err(error) => panic!("the log of the seeds: {error}"),
    }
}

fn assert_is_a_message(error: &impl fmt::Display) {
    let message = error.to_string();
    assert!(!message.is_empty(), "an error says nothing");
    assert!(!message.contains(char::is_control), "a message has control characters: {message:?}");
}
