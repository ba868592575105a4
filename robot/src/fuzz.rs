//! What fuzzers try to break: what the readers of logs promise of any bytes.
//!
//! Each body is run by a target of cargo-fuzz, in `fuzz/`, and by `tests/fuzz.rs` on stable Rust, on the
//! seeds in `fuzz/corpus/` and on mutations of them. It panics where what it holds does not hold.

use std::fmt;

use crate::log::{
    decode::decode,
    definition::{Definition, Dialect},
    reader::Log,
    topic_map::TopicMap,
    value::Value,
};

/// A body, and its name: that of the target in `fuzz/`, and of the folder of its seeds.
pub type RobotFuzzTarget = (&'static str, fn(&[u8]));

/// All bodies.
pub const TARGETS: &[RobotFuzzTarget] = &[
    ("bag", bag),
    ("mcap", mcap),
    ("ros1_message", ros1_message),
    ("cdr_message", cdr_message),
    ("log_mapping", log_mapping),
];

/// Any bytes are a ROS 1 bag: see [`mcap()`].
///
/// # Panics
/// Where that does not hold.
pub fn bag(bytes: &[u8]) {
    log(bytes);
}

/// Any bytes are an MCAP file, whole or not, whose messages come in the order of their times, each with
/// its number, and what it tells of a run can be read as far as it goes; or there is one message that says
/// why not.
///
/// # Panics
/// Where that does not hold.
pub fn mcap(bytes: &[u8]) {
    log(bytes);
}

fn log(bytes: &[u8]) {
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
        assert!(message.offset < log.size());
        last = message.time;
        if let Some(Ok(definition)) = log.topics().get(message.topic).map(|topic| &topic.definition)
        {
            message_of(definition, &message.bytes);
        }
    }
    if let Some(truncation) = log.truncation() {
        assert!(truncation.offset <= log.size());
        assert_is_a_message(truncation);
    }
    tells(&log, &TopicMap::unambiguous(&log));
}

/// What a log tells, or what is wrong.
fn tells(log: &Log, mapping: &TopicMap) {
    match mapping.bind(log) {
        Ok(bound) => {
            if let Some(Err(error)) = log.entries(&bound).find(Result::is_err) {
                assert_is_a_message(&error);
            }
        }
        Err(error) => assert_is_a_message(&error),
    }
}

/// Any bytes are a definition, and after a zero byte a message of it in the serialisation of ROS 1: no
/// part of it is a message, too; or there is one message that says why not.
///
/// # Panics
/// Where that does not hold.
pub fn ros1_message(bytes: &[u8]) {
    if let Some((definition, message)) = parts(Dialect::Ros1, bytes)
        && message_of(&definition, message)
        && let Some((_, shorter)) = message.split_last()
    {
        assert!(decode(&definition, shorter).is_err(), "{definition:?}");
    }
}

/// The same in CDR.
///
/// # Panics
/// Where that does not hold.
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

/// Whether bytes are a message; then each of its fields is where the definition says.
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

/// Any bytes are a mapping file, which is written so that it reads as the same, and which fits a log or
/// does not; or there is one message that says why not.
///
/// # Panics
/// Where that does not hold.
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
        Ok(log) => tells(&log, &mapping),
        Err(error) => panic!("the log of the seeds: {error}"),
    }
}

fn assert_is_a_message(error: &impl fmt::Display) {
    let message = error.to_string();
    assert!(!message.is_empty(), "an error says nothing");
    assert!(!message.contains(char::is_control), "a message has control characters: {message:?}");
}
