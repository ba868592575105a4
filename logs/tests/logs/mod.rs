//! Logs: whole, cut off, damaged, without an index, in every compression, written by ROS tools or
//! by the `mcap` crate.

// What was written is what is read, to the last bit.
#![allow(clippy::float_cmp)]
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use std::{
    env,
    path::{Path, PathBuf},
};

mod broken;
mod carmen;
mod containers;
mod fiducials;
mod recorded;
mod roles;
mod rosbags;
mod scans;
mod verified;
mod written;

/// A folder of logs that are not part of the repository, if it exists; a variable names it.
pub(crate) fn recorded_logs(folder: &str, variable: &str, example: &str) -> Option<PathBuf> {
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
