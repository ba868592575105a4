//! The logs of earlier runs, from which a robot goes on.

use std::path::PathBuf;

use toposlam_conform::earlier_walks::earlier_walks;
use toposlam_model::mapping::EarlierWalk;

use super::{
    CliError,
    open_log::{LogOptions, OpenLog},
    text::counted,
};

/// The walks that some logs record. If the world is known, each must be of it.
///
/// # Errors
/// Returns an error if a log cannot be read, is of another world, or records no walk.
pub(super) fn earlier_walks_of(
    logs: &[PathBuf],
    world_hash: Option<&str>,
) -> Result<Vec<EarlierWalk>, CliError> {
    let mut walks = Vec::new();
    for path in logs {
        let opened = OpenLog::new(path, &LogOptions::default())?;
        let recorded = opened.run.as_ref().map_or("", |run| &run.world_hash);
        if !recorded.is_empty() && world_hash.is_some_and(|hash| hash != recorded) {
            return Err(CliError::in_file(
                path,
                "it was made in another world, or from another start",
            ));
        }
        let found = earlier_walks(&opened.log, &opened.topics);
        let found = found.map_err(|error| CliError::in_file(path, error))?;
        if found.is_empty() {
            return Err(CliError::in_file(path, "it records no walk"));
        }
        remark!("{}: the robot goes on from {}", path.display(), counted(found.len(), "walk"));
        walks.extend(found);
    }
    Ok(walks)
}
