//! Readers and writers of logs through their public interface. Logs are whole, cut off, damaged, without an index, in
//! every compression, written by ROS tools or by the `mcap` crate.

// What was written is what is read, to the last bit.
#![allow(clippy::float_cmp)]
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use std::{
    env,
    path::{Path, PathBuf},
};

use toposlam_logs::{entries::Entry, reader::Log, topic_map::TopicMap};

mod broken;
mod carmen;
mod containers;
mod fiducials;
mod recorded;
mod roles;
mod ros1;
mod rosbags;
mod scans;
mod verified;
mod written;

/// A folder of logs that are not part of the repository, if it exists; a variable names it.
fn recorded_logs(folder: &str, variable: &str, example: &str) -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data").join(folder);
    let folder = env::var_os(variable).map_or(beside, PathBuf::from);
    let found = folder.join(example).is_file();
    if !found {
        eprintln!(
            "skipped: there is no {example} in {}; {variable} names a folder",
            folder.display()
        );
    }
    found.then_some(folder)
}

fn map(text: &str) -> TopicMap {
    TopicMap::read(text.as_bytes()).unwrap()
}

/// The entries of a log by a topic map, up to the first error.
fn entries_of(log: &Log, map: &TopicMap) -> Result<Vec<Entry>, String> {
    let bound = map.bind(log).unwrap();
    log.entries(&bound).collect::<Result<_, _>>().map_err(|error| error.to_string())
}

/// All entries of a log by the types of its topics.
fn entries(log: &Log) -> Vec<Entry> {
    entries_of(log, &TopicMap::from_log(log).unwrap()).unwrap()
}

fn position(bytes: &[u8], part: &[u8]) -> usize {
    bytes.windows(part.len()).position(|window| window == part).unwrap()
}
