//! Checks a log: infers its events, completes them with the marker, and judges them in the known world or in the
//! smallest one. Sections 2 to 6.

use thiserror::Error;
use toposlam_logs::{
    messages::Run,
    reader::Log,
    topic_map::{MarkerPlace, Role, TopicMap},
};
use toposlam_model::{
    aid::{AidKind, UnknownAid},
    enumerate::Watch,
    folding::WorldSearch,
    format::named_world::{NamedWorld, StartError},
    mapping::MappingAlgorithm,
    marker::{Directional, MarkerKind, NoMarker, Undirected},
};
use toposlam_robot::run_settings::RecordedSettings;
use toposlam_vision::{laser::params::LaserParams, sensing::Sensor};

use super::{
    config::{ConformConfig, RunDriver},
    extract::{Evidence, ExtractConfig, ExtractError, ExtractedRun, extract},
    frame_content::FrameContents,
    judgement::{JudgeError, Judgement, judge},
    known_world::{Known, KnownWorld, MarkerStart},
    log_head::{LogHead, MarkerNotShown},
    marked_visits::{AddedMarker, MarkedVisitsError, assume_marker, mark_visits, marker_at_start},
    possible_visits::PossibleVisits,
    quirks::Quirks,
    twin::TwinWorld,
};

/// A log, and how its messages are read.
#[derive(Clone, Copy)]
pub struct LogSource<'l> {
    pub log: &'l Log,
    pub topics: &'l TopicMap,
    pub head: Option<&'l Run>,
    /// Senses its images.
    pub sensor: Option<&'l Sensor>,
}

/// What a log is checked against.
#[derive(Clone, Debug)]
pub struct LogCheck<'w> {
    pub evidence: Evidence,
    pub laser: LaserParams,
    pub world: Option<&'w NamedWorld>,
    pub start: RobotStart<'w>,
    /// The robot's marking aid; without one, that of the log, or else a directional marker.
    pub aid: Option<AidKind>,
    /// Whether a marker is assumed that is not in the log: at the place of the topic map, or else at the first
    /// junction.
    pub assumes_marker: bool,
    pub doors: DoorChooser,
    /// The worlds to search if none is known.
    pub search: WorldSearch,
    /// The largest number of darts that the algorithm may know; without one, that of the log.
    pub max_darts: Option<usize>,
    pub quirks: &'w Quirks,
}

/// Where the robot began in a known world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RobotStart<'s> {
    /// Where the log records it, or else at the start of the world, or else anywhere.
    Recorded,
    Anywhere,
    /// As `VERTEX:FACING`.
    At(&'s str),
}

/// What chose the doors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DoorChooser {
    /// This algorithm, or else that of the log.
    Algorithm(Option<MappingAlgorithm>),
    /// Anything, in any way.
    Anyone,
}

#[derive(Clone, Debug)]
pub struct CheckedLog {
    pub extracted: ExtractedRun,
    pub judgement: Judgement,
    pub config: ConformConfig,
    pub known: Option<Known>,
    /// Sightings that the log does not record as percepts.
    pub added: Option<AddedMarker>,
    /// Another world that the marker does not distinguish from the known one or the smallest.
    pub twin: Option<TwinWorld>,
    /// Whether its robot went on from an earlier run.
    pub is_resumed: bool,
    pub quirks: Quirks,
}

#[derive(Debug, Error)]
pub enum CheckError {
    #[error(transparent)]
    Aid(#[from] UnknownAid),
    #[error("logs do not record what a robot sees with `{}`", .aid.name())]
    SightingsNotRecorded { aid: AidKind },
    #[error("its events are inferred, and only recorded ones show what a robot sees of `{0}`, and does with it", .aid.name())]
    OnlyRecorded { aid: AidKind },
    #[error("its algorithm `{0}` is unknown")]
    Algorithm(String),
    #[error(transparent)]
    Start(#[from] StartError),
    #[error("the world is too large for a marker that may lie anywhere")]
    TooManyStates,
    #[error(transparent)]
    MarkerPlace(#[from] MarkerPlaceError),
    #[error(transparent)]
    MarkedVisits(MarkedVisitsError),
    #[error(transparent)]
    Extract(#[from] ExtractError),
    #[error(transparent)]
    MarkerNotShown(#[from] MarkerNotShown),
    /// What the images show is known.
    #[error("no junction is visited in its {count} {frames}{contents}")]
    NoVisit { count: u64, frames: &'static str, contents: FrameContents },
    #[error(transparent)]
    Judge(JudgeError),
}

/// Why a marker of the topic map, or an assumed one, does not fit a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum MarkerPlaceError {
    #[error("this is for events that are inferred from laser scans")]
    AssumedWithoutLaser,
    #[error("this is for events that are inferred from laser scans")]
    MappedWithoutLaser,
    #[error("the log has sightings of a marker: [marker] of the topic map")]
    AssumedBesideSightings,
    #[error("the log has no marker there")]
    PlaceNotAssumed,
    #[error("the robot has no marker")]
    SightingsWithoutMarker,
    #[error(transparent)]
    Assumed(MarkedVisitsError),
}

impl LogCheck<'_> {
    /// Reads and judges a log. `on_events` is called between the two.
    ///
    /// # Errors
    /// Returns an error if the log cannot be read, or does not record what is needed.
    pub fn run(
        &self,
        source: &LogSource,
        watch: &impl Watch,
        on_events: impl FnOnce(),
    ) -> Result<CheckedLog, CheckError> {
        let LogSource { log, topics, head, sensor } = *source;
        let head = LogHead(head);
        let aid = self.aid.map_or_else(|| head.aid(), Ok)?;
        if !aid.marks() {
            return Err(CheckError::SightingsNotRecorded { aid });
        }
        let is_inferred = [Directional, Undirected, NoMarker].map(AidKind::from).contains(&aid);
        if self.evidence != Evidence::Recorded && !is_inferred {
            return Err(CheckError::OnlyRecorded { aid });
        }
        let (settings, driver) = match self.doors {
            DoorChooser::Algorithm(algorithm) => {
                // There is one algorithm for each aid that moves.
                let of_aid = || MappingAlgorithm::all().find(|it| aid.moves() && it.aid() == aid);
                let algorithm = algorithm.or_else(of_aid);
                let settings = head.settings(algorithm).map_err(CheckError::Algorithm)?;
                (settings, RunDriver::from(settings))
            }
            DoorChooser::Anyone => (RecordedSettings::default(), RunDriver::Anyone),
        };
        let algorithm = settings.method.algorithm();
        let marker_start = self.marker_start(topics)?;
        let (known, world) = self.known((aid, marker_start), head, algorithm)?.unzip();
        let config = ConformConfig {
            world,
            aid,
            driver,
            budget: settings.budget,
            search: self.search,
            dart_bound: self.max_darts.unwrap_or(settings.dart_bound),
        };
        let marked = aid != AidKind::Fixed(NoMarker);
        // Whether a corridor bends enough for a corner does not show by driving there.
        let driven = config.world.is_some() && !self.laser.corner.corners;
        let extraction =
            ExtractConfig { evidence: self.evidence, sensor, marked, laser: self.laser, driven };
        let mut extracted = extract(log, topics, &extraction, watch)?;
        let added = match aid.fixed() {
            Some(marker) => self.add_marker(topics, &mut extracted, marker)?,
            None => None,
        };
        if self.aid.is_none() && driver != RunDriver::Anyone {
            head.check_marker(&extracted.events, algorithm)?;
        }
        let mut events = extracted.events.clone();
        events.complete_sightings(aid).map_err(|error| CheckError::Judge(error.into()))?;
        let complete = events.clone();
        // A robot that no algorithm drives may turn back between junctions.
        if driver == RunDriver::Anyone {
            events = events.without_excursions();
        }
        on_events();
        let judgement = judge(events, &config, self.quirks, watch);
        let judgement = judgement.map_err(|error| match (error, &extracted) {
            (JudgeError::Empty, run @ &ExtractedRun { images: count @ 1.., .. }) => {
                let contents = FrameContents::of_images(run);
                CheckError::NoVisit { count, frames: "images", contents }
            }
            (JudgeError::Empty, &ExtractedRun { scans: count @ 1.., .. }) => {
                let contents = FrameContents::default();
                CheckError::NoVisit { count, frames: "laser scans", contents }
            }
            (error, _) => CheckError::Judge(error),
        })?;
        let judgement = match &extracted {
            ExtractedRun {
                evidence: Evidence::Laser,
                junctions,
                driven,
                network,
                matched_scans,
                ..
            } => {
                // Without odometry it is not known where the robot drove.
                let driven = driven.as_ref().filter(|_| matched_scans.is_none());
                let possible = PossibleVisits::judge(&complete, junctions, driven, &config, watch)
                    .in_building(network.unwrap_or_default())
                    .without_odometry(matched_scans.is_some());
                judgement.with_possible(possible)
            }
            ExtractedRun { unproved: Some(why), .. } => judgement.accusing_nobody(*why),
            ExtractedRun { evidence: Evidence::Scenes | Evidence::Images, junctions, .. }
                if judgement.is_open_at_visit() && !complete.has_left_between_doors() =>
            {
                let possible = PossibleVisits::judge(&complete, junctions, None, &config, watch);
                judgement.with_possible(possible)
            }
            _ => judgement,
        };
        let twin = TwinWorld::find(&judgement, &config);
        let (is_resumed, quirks) = (settings.is_resumed, self.quirks.clone());
        Ok(CheckedLog { extracted, judgement, config, known, added, twin, is_resumed, quirks })
    }

    /// The known world with the robot's start, and as it is compared.
    fn known(
        &self,
        aid: (AidKind, MarkerStart),
        head: LogHead,
        algorithm: MappingAlgorithm,
    ) -> Result<Option<(Known, KnownWorld)>, CheckError> {
        let Some(world) = self.world else { return Ok(None) };
        // In a laser log bends of corridors are vertices only if that is asked for.
        let smooths = self.evidence == Evidence::Laser && !self.laser.corner.corners;
        let compared = if smooths { world.smoothed() } else { world.clone() };
        let recorded = head.start(world).map(|start| world.start_text(start));
        let start = match self.start {
            RobotStart::Recorded => {
                let recorded = recorded.and_then(|text| compared.start_from_text(&text).ok());
                recorded.or(compared.start)
            }
            RobotStart::Anywhere => None,
            RobotStart::At(start) => Some(compared.start_from_text(start)?),
        };
        let known = Known::new(compared, start, aid, algorithm);
        let (mut known, compared) = known.ok_or(CheckError::TooManyStates)?;
        known.is_recorded = head.is_recorded_in(&world.graph);
        Ok(Some((known, compared)))
    }

    /// Where the marker may lie at the start, and whether the topic map fits the check.
    fn marker_start(&self, topics: &TopicMap) -> Result<MarkerStart, MarkerPlaceError> {
        let has_place = topics.assumed_marker().is_some();
        let has_sightings = topics.carrier(Role::Marker).is_some();
        match (self.evidence, self.assumes_marker) {
            (Evidence::Laser, true) if has_sightings => {
                Err(MarkerPlaceError::AssumedBesideSightings)
            }
            (Evidence::Laser, false) if has_place => Err(MarkerPlaceError::PlaceNotAssumed),
            (Evidence::Laser, _) if has_place || has_sightings => Ok(MarkerStart::Anywhere),
            (Evidence::Laser, _) => Ok(MarkerStart::Robot),
            (_, true) => Err(MarkerPlaceError::AssumedWithoutLaser),
            (_, false) if has_place || has_sightings => Err(MarkerPlaceError::MappedWithoutLaser),
            (_, false) => Ok(MarkerStart::Robot),
        }
    }

    /// Completes the visits of a laser log with its marker.
    fn add_marker(
        &self,
        topics: &TopicMap,
        extracted: &mut ExtractedRun,
        marker: MarkerKind,
    ) -> Result<Option<AddedMarker>, CheckError> {
        let ExtractedRun { events, junctions, sightings, .. } = extracted;
        let events = &mut events.events;
        if self.assumes_marker {
            let place = topics.assumed_marker().or_else(|| marker_at_start(junctions));
            // Without a visit there is nothing to judge.
            let Some(place) = place else { return Ok(None) };
            let seen = assume_marker(events, junctions, marker, place)
                .map_err(MarkerPlaceError::Assumed)?;
            // The direction of an undirected marker does not matter.
            let heading = place.heading.filter(|_| marker == Directional);
            let MarkerPlace { position, .. } = place;
            return Ok(Some(AddedMarker::Assumed { position, heading, seen }));
        }
        if topics.carrier(Role::Marker).is_none() {
            return Ok(None);
        }
        if marker == NoMarker {
            return Err(MarkerPlaceError::SightingsWithoutMarker.into());
        }
        let elsewhere =
            mark_visits(events, junctions, marker, sightings).map_err(CheckError::MarkedVisits)?;
        Ok(Some(AddedMarker::Fiducial { sightings: sightings.len(), elsewhere }))
    }
}
