//! The picture of a run that was inferred from laser scans: what they hit, the robot's way, and its visits.

use std::path::Path;

use toposlam_conform::{AddedMarker, ConformVerdict, Evidence, ExtractedRun, VisitedJunction};
use toposlam_logs::topic_map::Role;
use toposlam_vision::{
    laser::params::NetworkParams,
    place::{Certainty, PlaceArm},
    visits::network_fit::NetworkFault,
};

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
    let extracted = &judged.checked.extracted;
    picture.visits = visits(extracted);
    if extracted.network.is_some_and(|network| network.fault == Some(NetworkFault::Wide)) {
        picture.wide = extracted.wide.iter().map(|&place| place.into()).collect();
    }
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
        picture.add(entry.map_err(|error| failed(&error))?, &judged.checked.extracted.poses);
    }
    Ok(picture)
}

/// The visits, with what is certain and what is possible of each.
fn visits(run: &ExtractedRun) -> Vec<DrawnVisit> {
    let has_halls =
        run.network.is_some_and(|network| network.fault == Some(NetworkFault::ManyDoors));
    let many_doors = NetworkParams::DEFAULT.many_doors;
    let visit = |(junction, arms): (&VisitedJunction, &Vec<PlaceArm>)| {
        let VisitedJunction { centre, ref doors, ref alternatives, exit, .. } = *junction;
        let of = |certainty| {
            let arms = arms.iter().filter(move |arm| arm.certainty == certainty);
            arms.map(|arm| arm.direction).collect::<Vec<_>>()
        };
        let is_certain = !doors.is_empty();
        let most = alternatives.iter().flatten().map(|seen| seen.degree).max();
        DrawnVisit {
            centre,
            doors: if is_certain { doors.clone() } else { of(Certainty::Certain) },
            possible: if is_certain { Vec::new() } else { of(Certainty::Possible) },
            is_certain,
            is_hall: has_halls && most.is_some_and(|most| most as usize >= many_doors),
            exit,
        }
    };
    run.junctions.iter().zip(&run.arms).map(visit).collect()
}
