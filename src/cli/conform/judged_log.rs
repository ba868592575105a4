//! Reads a log, and judges it with the options of `toposlam conform`.

use std::path::Path;

use toposlam_conform::{
    ConformConfig, Evidence, ExtractConfig, ExtractError, ExtractedRun, JudgeError, Judgement,
    LogHead, Quirks, RESUMED, RunDriver, SightingError, extract, judge,
};
use toposlam_model::{
    folding::WorldSearch,
    format::named_world::NamedWorld,
    mapping::MappingAlgorithm,
    marker::{Marker, NoMarker},
};
use toposlam_robot::{budget::RunBudget, run_settings::RecordedSettings};

use super::{
    ConformArguments, Who, known_world::Known, other_world::OtherWorld, robot_marker::AddedMarker,
};
use crate::cli::{CliError, open_log::OpenLog, progress::Progress};

/// A log and its judgement.
pub(super) struct JudgedLog<'w> {
    pub(super) opened: OpenLog,
    pub(super) gathered: ExtractedRun,
    pub(super) judgement: Judgement,
    pub(super) known: Option<Known<'w>>,
    pub(super) marker: &'static dyn Marker,
    /// Sightings that are not recorded as percepts.
    pub(super) added: Option<AddedMarker>,
    /// Another world that explains the log, and that the marker does not distinguish from the known one or the
    /// smallest.
    pub(super) twin: Option<OtherWorld>,
    /// The algorithm with which the doors are compared, unless anyone may have chosen them.
    pub(super) driver: RunDriver,
    /// What the robot might spend.
    pub(super) budget: RunBudget,
    pub(super) algorithm: MappingAlgorithm,
    /// The limits of the check.
    pub(super) search: WorldSearch,
    pub(super) dart_bound: usize,
}

impl JudgedLog<'_> {
    /// What the robot might spend, and the most darts that the algorithm may know.
    pub(super) fn limits(&self) -> (RunBudget, usize) {
        (self.budget, self.dart_bound)
    }

    /// Whether the doors were compared with the folding explorer.
    pub(super) fn is_folding(&self) -> bool {
        let compared = self.judgement.algorithm.as_ref().map(|followed| followed.algorithm);
        compared == Some(MappingAlgorithm::Folding)
    }
}

impl ConformArguments {
    /// Reads and judges a log, in the known world or in that without its corners.
    pub(super) fn judge<'w>(
        &self,
        path: &Path,
        worlds: Option<(&'w NamedWorld, &'w NamedWorld)>,
        quirks: &Quirks,
    ) -> Result<JudgedLog<'w>, CliError> {
        let opened = OpenLog::new(path, &self.sources)?;
        let evidence = self.evidence(path, &opened)?;
        self.laser.check_used(evidence)?;
        let marker = match self.marker {
            Some(marker) => marker.marker(),
            None => opened.marker()?,
        };
        let settings = match self.driver {
            Who::Algorithm => opened.settings(path, self.algorithm)?,
            Who::Anyone => RecordedSettings::default(),
        };
        let algorithm = settings.method.algorithm();
        let driver = match self.driver {
            Who::Algorithm => RunDriver::from(settings),
            Who::Anyone => RunDriver::Anyone,
        };
        if settings.is_resumed {
            remark!("{}: {RESUMED}", path.display());
        }
        let run = opened.run.as_ref();
        let start = self.start.as_deref();
        let laser = self.laser.params()?;
        // In a laser log bends of corridors are vertices only if that is asked for.
        let smooths = evidence == Evidence::Laser && !laser.corner.corners;
        let world = worlds.map(|(world, smooth)| if smooths { smooth } else { world });
        let marker_start = self.marker_start(&opened, evidence)?;
        let known =
            world.map(|world| Known::new(world, start, (marker, marker_start), run, algorithm));
        let known = known.transpose()?;
        let progress = Progress::endless("reading", "images and scans")?;
        let sensor = opened.sensor();
        let marked = marker.name() != NoMarker.name();
        let config = ExtractConfig { evidence, sensor: sensor.as_ref(), marked, laser };
        let gathered = extract(&opened.log, &opened.mapping, &config, &progress);
        let mut gathered = gathered.map_err(|error| match error {
            ExtractError::TopicMap(error) => opened.wrong_mapping(path, &error),
            error => CliError::in_file(path, error),
        })?;
        let added = self.add_marker(path, &opened, &mut gathered, marker)?;
        if self.marker.is_none() && driver != RunDriver::Anyone {
            let checked = LogHead(run).check_marker(&gathered.events, algorithm);
            checked.map_err(|cause| CliError::in_file(path, format!("{cause}{WITHOUT_MARKER}")))?;
        }
        let dart_bound = self.max_darts.unwrap_or(settings.dart_bound);
        let limits = (settings.budget, dart_bound);
        let question = self.question(known.as_ref(), marker, driver, limits);
        let mut events = gathered.events.clone();
        let completed = events.complete_sightings(marker);
        completed.map_err(|error| not_judged(path, &gathered, error.into()))?;
        // A robot that no algorithm drives may turn back between junctions.
        if driver == RunDriver::Anyone {
            events = events.without_excursions();
        }
        progress.next("judging");
        let judgement = judge(events, &question, quirks, &progress);
        let search = question.search;
        progress.finish();
        let judgement = judgement.map_err(|error| not_judged(path, &gathered, error))?;
        let twin = OtherWorld::of(&judgement, known.as_ref(), marker);
        Ok(JudgedLog {
            opened,
            gathered,
            judgement,
            known,
            marker,
            added,
            twin,
            driver,
            budget: settings.budget,
            algorithm,
            search,
            dart_bound,
        })
    }

    /// What the events are derived from: as chosen, or else the best that the log has.
    fn evidence(&self, path: &Path, opened: &OpenLog) -> Result<Evidence, CliError> {
        match self.events {
            Some(made) if Evidence::from(made).is_in(&opened.mapping) => Ok(made.into()),
            Some(_) => {
                let cause = "the log does not have what this needs";
                Err(CliError::at("--events", format!("{cause} ({})", path.display())))
            }
            None => opened.evidence(path),
        }
    }

    /// What a log is compared with, and the limits of the check.
    pub(super) fn question<'k>(
        &self,
        known: Option<&'k Known>,
        marker: &'static dyn Marker,
        driver: RunDriver,
        (budget, dart_bound): (RunBudget, usize),
    ) -> ConformConfig<'k> {
        ConformConfig {
            world: known.map(Known::question),
            marker,
            driver,
            budget,
            search: WorldSearch {
                class: self.class,
                max_edges: self.max_edges,
                steps: self.max_steps,
            },
            dart_bound,
        }
    }
}

/// The way out for a run without a marker.
const WITHOUT_MARKER: &str = "; for a run without a marker add --driver anyone --marker none";

/// The way out for a run with a marker that points nowhere.
const WITHOUT_DOOR: &str = "; for an undirected marker add --driver anyone --marker undirected";

/// Why a log could not be judged.
fn not_judged(path: &Path, gathered: &ExtractedRun, error: JudgeError) -> CliError {
    let none_in = |count: u64, what: &str| {
        CliError::in_file(path, format!("no junction is visited in its {count} {what}"))
    };
    match error {
        JudgeError::Empty if gathered.pictures > 0 => none_in(gathered.pictures, "images"),
        JudgeError::Empty if gathered.scans > 0 => none_in(gathered.scans, "laser scans"),
        error @ JudgeError::Marker(SightingError::NoDoor) => {
            CliError::in_file(path, format!("{error}{WITHOUT_DOOR}"))
        }
        error @ (JudgeError::Marker(_) | JudgeError::Algorithm { .. }) => {
            CliError::in_file(path, format!("{error}{WITHOUT_MARKER}"))
        }
        error => CliError::in_file(path, error),
    }
}
