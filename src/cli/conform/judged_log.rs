//! Reads a log, and checks it with the options of `toposlam conform`.

use std::path::Path;

use toposlam_conform::{
    CheckError, CheckedLog, Evidence, ExtractError, JudgeError, LogCheck, LogHead,
    MarkerPlaceError, Quirks, RESUMED_REMARK, RobotStart, SightingError,
};
use toposlam_model::{folding::WorldSearch, format::named_world::NamedWorld};

use super::ConformArguments;
use crate::cli::{CliError, open_log::OpenLog, progress::Progress};

/// A log and its judgement.
pub(super) struct JudgedLog {
    pub(super) opened: OpenLog,
    pub(super) checked: CheckedLog,
}

/// The option for a run without a marker.
const WITHOUT_MARKER: &str = "; for a run without a marker add --driver anyone --marker none";
/// The option for a run with a marker that points nowhere.
const WITHOUT_DOOR: &str = "; for an undirected marker add --driver anyone --marker undirected";

impl ConformArguments {
    pub(super) fn robot_start(&self) -> RobotStart<'_> {
        match self.start.as_deref() {
            None => RobotStart::Recorded,
            Some("any") => RobotStart::Anywhere,
            Some(start) => RobotStart::At(start),
        }
    }

    /// Reads and judges a log.
    pub(super) fn judge(
        &self,
        path: &Path,
        world: Option<&NamedWorld>,
        quirks: &Quirks,
    ) -> Result<JudgedLog, CliError> {
        let opened = OpenLog::new(path, &self.sources)?;
        let evidence = self.evidence(path, &opened)?;
        self.laser.check_used(evidence)?;
        let settings = LogHead(opened.run.as_ref()).settings(None);
        let recorded = settings.ok().and_then(|settings| settings.laser);
        let check = LogCheck {
            evidence,
            laser: self.laser.params(recorded)?,
            world,
            start: self.robot_start(),
            aid: self.aid,
            assumes_marker: self.assume_marker,
            doors: self.driver.chooser(self.algorithm),
            search: WorldSearch {
                class: self.class,
                max_edges: self.max_edges,
                steps: self.max_steps,
            },
            max_darts: self.max_darts,
            quirks,
        };
        let progress = Progress::endless("reading", "images and scans")?;
        let checked = check.run(&opened.source(opened.sensor().as_ref()), &progress, || {
            progress.next("judging");
        });
        progress.finish();
        let checked = checked.map_err(|error| not_checked(path, &opened, error))?;
        if checked.is_resumed {
            remark!("{}: {RESUMED_REMARK}", path.display());
        }
        Ok(JudgedLog { opened, checked })
    }

    /// What the events are derived from: as chosen, or else the best that the log has.
    fn evidence(&self, path: &Path, opened: &OpenLog) -> Result<Evidence, CliError> {
        match self.events {
            Some(source) if source.is_in(&opened.topics) => Ok(source),
            Some(source) => {
                let cause = format!("{}: {}", path.display(), opened.lacks(source));
                Err(CliError::at(format!("--events {}", source.option()), cause))
            }
            None => opened.evidence(path),
        }
    }
}

/// Why a log could not be checked, with the options that help.
fn not_checked(path: &Path, opened: &OpenLog, error: CheckError) -> CliError {
    match error {
        CheckError::Aid(error) => CliError::in_file(path, error),
        error @ CheckError::Algorithm(_) => {
            CliError::in_file(path, format!("{error}; use --algorithm"))
        }
        CheckError::Start(error) => CliError::at("--start", error),
        error @ CheckError::TooManyStates => {
            CliError::at("--world", format!("{error}; give --start"))
        }
        CheckError::MarkerPlace(error) => match error {
            MarkerPlaceError::AssumedWithoutLaser => CliError::at("--assume-marker", error),
            MarkerPlaceError::AssumedBesideSightings => {
                let cause = "the log has sightings of a marker: [marker] of --topics";
                CliError::at("--assume-marker", cause)
            }
            MarkerPlaceError::MappedWithoutLaser => CliError::at("[marker] of --topics", error),
            MarkerPlaceError::PlaceNotAssumed => {
                let cause = format!("{error}; to assume one, add --assume-marker");
                CliError::at("[marker] at of --topics", cause)
            }
            MarkerPlaceError::SightingsWithoutMarker => {
                CliError::at("[marker] of --topics", format!("{error}: --marker none"))
            }
            MarkerPlaceError::Assumed(error) => CliError::at("[marker] at of --topics", error),
        },
        CheckError::Extract(ExtractError::TopicMap(error)) => opened.wrong_topics(path, &error),
        error @ CheckError::Judge(JudgeError::Marker(SightingError::NoDoor)) => {
            CliError::in_file(path, format!("{error}{WITHOUT_DOOR}"))
        }
        error @ CheckError::Judge(JudgeError::Marker(
            SightingError::OfAnotherAid { .. } | SightingError::NotRecordedAfter { .. },
        )) => CliError::in_file(path, error),
        error @ (CheckError::MarkerNotShown(_)
        | CheckError::Judge(JudgeError::Marker(_) | JudgeError::Algorithm { .. })) => {
            CliError::in_file(path, format!("{error}{WITHOUT_MARKER}"))
        }
        error => CliError::in_file(path, error),
    }
}
