//! The picture of a run that was inferred from laser scans: what they hit, the robot's way, and its visits.

use std::path::Path;

use toposlam_conform::{
    AddedMarker, CheckedKind, ConformVerdict, Evidence, RunEvents, VisitedJunction,
};
use toposlam_logs::topic_map::Role;

use super::{CliError, JudgedLog};
use crate::{
    cli::{text::counted, write_drawing},
    picture::{DrawnVisit, LaserRunPicture, laser_run_svg},
};

/// Writes the picture of a run as SVG or PNG.
pub(super) fn write(path: &Path, log: &Path, judged: &JudgedLog) -> Result<(), CliError> {
    if judged.checked.extracted.evidence != Evidence::Laser {
        let cause = "this is for events that are inferred from laser scans";
        return Err(CliError::at("--picture", cause));
    }
    let mut picture = scanned(log, judged)?;
    picture.visits = visits(&judged.checked.extracted.events, &judged.checked.extracted.junctions);
    let name = log.file_name().unwrap_or(log.as_os_str()).to_string_lossy();
    name.trim_end_matches(".gz").trim_end_matches(".log").clone_into(&mut picture.title);
    let verdict = match judged.checked.judgement.verdict() {
        ConformVerdict::Conforms => "conforms",
        ConformVerdict::Diverged => "diverges",
        ConformVerdict::NotKnown => "is not known to conform",
    };
    let count = counted(picture.visits.len(), "visit");
    picture.caption = format!("{count} of junctions; the log {verdict}");
    picture.marker = match judged.checked.added {
        Some(AddedMarker::Assumed { position, heading, .. }) => Some((position, heading)),
        _ => None,
    };
    write_drawing(path, &laser_run_svg(&picture))
}

/// What the scans hit, and the robot's way.
fn scanned(path: &Path, judged: &JudgedLog) -> Result<LaserRunPicture, CliError> {
    let failed = |error: &dyn std::error::Error| CliError::in_file(path, error);
    let log = &judged.opened.log;
    let mapping = judged.opened.topics.only(&[Role::Scan, Role::Odometry]);
    let bound = mapping.bind(log).map_err(|error| failed(&error))?;
    let mut picture = LaserRunPicture::default();
    for entry in log.entries(&bound) {
        picture.add(entry.map_err(|error| failed(&error))?);
    }
    Ok(picture)
}

/// The visits, with the door of each.
fn visits(events: &RunEvents, junctions: &[VisitedJunction]) -> Vec<DrawnVisit> {
    let visit = |junction: &VisitedJunction| {
        let VisitedJunction { event, centre, ref doors, .. } = *junction;
        let exit = match events.events.get(event + 1).map(|event| &event.kind) {
            Some(CheckedKind::Door { door, .. }) => Some(door.0 as usize),
            _ => None,
        };
        DrawnVisit { centre, doors: doors.clone(), exit }
    };
    junctions.iter().map(visit).collect()
}
