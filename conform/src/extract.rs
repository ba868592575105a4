//! Extracts the events of a log: recorded ones, or else those that are inferred from its scenes, images or
//! laser scans and its odometry. Sections 3 to 6.

use std::collections::BTreeMap;

use nalgebra::Point2;
use rayon::prelude::*;
use serde::{Serialize, Serializer};
use thiserror::Error;
use toposlam_logs::{
    ReadingRemark,
    entries::{Content, Entry},
    error::LogError,
    messages,
    reader::Log,
    record::{EventId, EventKind, Frame, FrameSensor, SensingError},
    topic_map::{BoundTopicMap, Role, TopicMap},
};
use toposlam_model::{
    aid::AidAction, driving::odometry::Odometry, enumerate::Watch, format::document::DocumentError,
    measurement::MeasurementNoise,
};
use toposlam_robot::measured_hallway::log_noise;
use toposlam_vision::{
    laser::{params::LaserParams, scan_log::ScanLogBuilder},
    place::{PlaceArm, PlaceView},
    sensing::Sensor,
    visits::{
        APPROACH_RANGE, VisitLog, Visits, driven_visits, logged_visits, network_fit::NetworkFit,
    },
};

use super::{
    RecordedEvents,
    events::{CheckedEvent, CheckedKind, EventSource, OutOfOrder, RunEvents, UndecidedCause},
    judgement::Unproved,
    marked_visits::{TimedSighting, VisitedJunction},
    message_clock::MessageClock,
    placed_scenes::{PlacedScenes, SceneClockError, SensedScene},
    scan_odometry::{PlacedScan, ScanOdometry, StampCounts},
    scan_track::{MatchedScans, ScanTrack, UnmatchedScan},
    visit_events::{DrivenVisits, visit_events},
};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Evidence {
    /// Recorded percepts and doors.
    #[default]
    Recorded,
    Scenes,
    Images,
    Laser,
}

/// From what events are extracted, and how.
#[derive(Clone, Copy, Debug)]
pub struct ExtractConfig<'s> {
    pub evidence: Evidence,
    /// Senses images, if they are the source.
    pub sensor: Option<&'s Sensor>,
    /// Whether the robot puts its marker down at its start. This matters only for inferred events.
    pub marked: bool,
    pub laser: LaserParams,
    /// Whether visits are derived from laser scans once more, by what was driven.
    pub driven: bool,
}

#[derive(Clone, Debug, Default)]
pub struct ExtractedRun {
    pub events: RunEvents,
    pub evidence: Evidence,
    /// The head of the log, if it has one.
    pub run: Option<messages::Run>,
    /// The scenes from which events are inferred.
    pub seen: Vec<SensedScene>,
    /// The number of images that were sensed.
    pub images: u64,
    /// The number of them that could not be decoded.
    pub unreadable: u64,
    /// The number of laser scans that were sensed.
    pub scans: u64,
    /// The messages of all scans, in their order.
    pub scan_messages: Vec<EventId>,
    pub skipped: SkippedMessages,
    /// What was repaired in the messages.
    pub remarks: Vec<ReadingRemark>,
    pub stamps: StampCounts,
    /// How scans were placed, if the log has no odometry.
    pub matched_scans: Option<MatchedScans>,
    /// The widest field of view of a scan, in radians.
    pub field_of_view: f64,
    /// The drift of the heading of the odometry in 10 m, in radians, if scans were matched because of it.
    pub drift: Option<f64>,
    /// How well a network of corridors describes the building, by laser scans.
    pub network: Option<NetworkFit>,
    /// The junctions of the events that are inferred from laser scans.
    pub junctions: Vec<VisitedJunction>,
    /// The same visits by what was driven or is seen to end; `None` if that is not known.
    pub driven: Option<DrivenVisits>,
    /// The arms that are seen at each of them, clockwise from the entry door.
    pub arms: Vec<Vec<PlaceArm>>,
    /// Where free space is wider than a corridor, in metres in the frame of odometry.
    pub wide: Vec<Point2<f64>>,
    /// Where each scan was taken, by its message, if the log has no odometry.
    pub poses: BTreeMap<EventId, Odometry>,
    /// The sightings of a marker that is a fiducial.
    pub sightings: Vec<TimedSighting>,
    /// Why events that are inferred from scenes or images accuse nobody: the log records that the robot recovered, which
    /// they do not show.
    pub unproved: Option<Unproved>,
}

/// The number of messages that were skipped when events were inferred, by the reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SkippedMessages {
    /// Images, scenes, scans, odometry and sightings whose time is far from that of all other messages.
    pub off_clock: u64,
    /// Scans before which no odometry was recorded, nor soon after.
    pub scans_without_odometry: u64,
}

#[derive(Debug, Error)]
pub enum ExtractError {
    #[error(transparent)]
    Log(#[from] LogError),
    #[error(transparent)]
    TopicMap(#[from] DocumentError),
    #[error(
        "no topics are known for percepts and doors, nor for scenes or images with odometry, nor for laser scans"
    )]
    NothingMapped,
    /// Images must be sensed without a calibration or colours.
    #[error("its events must be inferred from its images: this needs --calibration and --colours")]
    NoSensor,
    /// The log has no odometry, and its scans do not show where the robot was.
    #[error(transparent)]
    Unmatched(#[from] UnmatchedScan),
    /// An image is not of the calibrated camera.
    #[error("message {message}: {cause}")]
    Size { message: u64, cause: SensingError },
    /// The odometry at the time of an image or a scene is not known.
    #[error(transparent)]
    SceneClock(#[from] SceneClockError),
    /// The time of a percept or door is before that of the last one.
    #[error("message {message}: {order}")]
    OutOfOrder { message: u64, order: OutOfOrder },
    #[error(
        "message {message}: its robot did `{action}`; only logs with a fixed marker are checked"
    )]
    Action { message: u64, action: AidAction },
}

/// The number of images that are sensed in parallel.
const TOGETHER: usize = 32;
/// The number of views of laser scans that are made in parallel.
const VIEWS: usize = 64;

impl Serialize for Evidence {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.name().serialize(serializer)
    }
}

impl Evidence {
    /// Its name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Recorded => "recorded",
            Self::Scenes => "scenes",
            Self::Images => "pictures",
            Self::Laser => "laser",
        }
    }

    /// The first source of events that a topic map has.
    #[must_use]
    pub fn from_topics(mapping: &TopicMap) -> Option<Self> {
        [Self::Recorded, Self::Scenes, Self::Images, Self::Laser]
            .into_iter()
            .find(|one| one.is_in(mapping))
    }

    /// Whether a topic map has this source of events.
    pub fn is_in(self, mapping: &TopicMap) -> bool {
        self.needs().iter().all(|role| mapping.carrier(*role).is_some())
    }

    /// The roles without which there are no events.
    pub fn needs(self) -> &'static [Role] {
        // Without odometry scans are placed by themselves.
        let count = if self == Self::Laser { 1 } else { 2 };
        self.roles().get(..count).unwrap_or_default()
    }

    /// Its name as a value of `--events`.
    pub fn option(self) -> &'static str {
        match self {
            Self::Images => "images",
            other => other.name(),
        }
    }

    /// The roles that it needs, and what it uses besides.
    fn roles(self) -> &'static [Role] {
        match self {
            Self::Recorded => &[Role::Percept, Role::Door, Role::Action, Role::Odometry],
            Self::Scenes => &[Role::Scene, Role::Odometry],
            Self::Images => &[Role::Image, Role::Odometry],
            Self::Laser => &[Role::Scan, Role::Odometry, Role::Marker],
        }
    }
}

impl ExtractConfig<'_> {
    /// Events of a robot without a marker from this source, with the default parameters.
    #[must_use]
    pub fn new(evidence: Evidence) -> Self {
        Self { evidence, sensor: None, marked: false, laser: LaserParams::default(), driven: false }
    }
}

/// Extracts the events of a log.
///
/// # Errors
/// Returns an error if the log cannot be read, or has no source of events.
pub fn extract(
    log: &Log,
    mapping: &TopicMap,
    config: &ExtractConfig,
    watch: &impl Watch,
) -> Result<ExtractedRun, ExtractError> {
    let ExtractConfig { evidence, sensor, marked, laser, driven } = *config;
    // Only the recorded events show that a robot recovered.
    let recorded: &[Role] = match evidence {
        Evidence::Scenes | Evidence::Images => &[Role::Percept, Role::Door, Role::Action],
        Evidence::Recorded | Evidence::Laser => &[],
    };
    let asked = evidence.roles().iter().chain(&[Role::Run, Role::End, Role::Map]).chain(recorded);
    let bound = mapping.only(asked).bind(log)?;
    let threads = rayon::current_num_threads();
    let events = RunEvents { truncated: log.truncation().is_some(), ..RunEvents::default() };
    let extraction = |placing, laser| Extraction {
        run: ExtractedRun { events: events.clone(), evidence, ..ExtractedRun::default() },
        recorded: RecordedEvents::default(),
        scenes: PlacedScenes::default(),
        waiting: Vec::new(),
        last: 0,
        sensors: sensor.map_or_else(Vec::new, |sensor| vec![sensor.clone(); threads]),
        watch,
        scans: LoggedScans { sources: Vec::new(), log: ScanLogBuilder::new(laser) },
        placing,
    };
    let mut read = extraction(Placing::Odometry(ScanOdometry::default()), laser);
    if read.read_entries(log, &bound)? == HasOdometry::No {
        let placing = Placing::Scans(Box::new(ScanTrack::new(&laser.matching)));
        read = extraction(placing, laser.for_matched_scans());
        read.read_entries(log, &bound)?;
    }
    let Extraction { mut run, recorded, scenes, scans, .. } = read;
    run.scans -= run.skipped.scans_without_odometry;
    let (seen, off_clock) = scenes.finish()?;
    run.seen = seen;
    run.skipped.off_clock += off_clock;
    if run.run.is_some() {
        let noise = log_noise();
        run.events.measurement_noise = match evidence {
            Evidence::Recorded => noise,
            Evidence::Scenes | Evidence::Images => {
                MeasurementNoise { standing: APPROACH_RANGE, ..noise }
            }
            Evidence::Laser => MeasurementNoise::UNKNOWN,
        };
    }
    if run.matched_scans.is_some() {
        // The way along a corridor is as the robot drove before.
        run.events.measurement_noise = MeasurementNoise::UNKNOWN;
    }
    if evidence == Evidence::Laser && run.events.end.is_some() {
        // Corners and dead ends are no visits: the recorded moves and map are those of another graph.
        (run.events.has_head, run.events.end, run.events.map) = (false, None, None);
    }
    run.events.events = recorded.finish();
    run.events.events = match evidence {
        Evidence::Recorded => run.events.events,
        Evidence::Scenes | Evidence::Images => {
            run.unproved = Unproved::after_recovery(&run.events);
            let (events, junctions) = infer_visits(&run.seen, marked);
            run.junctions = junctions;
            events
        }
        Evidence::Laser => {
            let SensedLog { visits, driven, drift, network, wide } = scans.visits(driven, watch);
            run.arms = visits.visits.iter().map(|visit| visit.arms.clone()).collect();
            let (events, junctions) = visit_events(visits);
            (run.junctions, run.drift, run.network, run.wide) =
                (junctions, drift, Some(network), wide);
            run.driven = driven.map(DrivenVisits::new);
            events
        }
    };
    Ok(run)
}

/// What the scans of a log show.
struct SensedLog {
    visits: VisitLog<EventSource>,
    /// The visits by what was driven or is seen to end, if that is known.
    driven: Option<VisitLog<EventSource>>,
    /// The drift of the heading of odometry in 10 m, in radians, if scans are matched because of it.
    drift: Option<f64>,
    /// Whether the building is a network of corridors.
    network: NetworkFit,
    /// Where free space is wider than a corridor.
    wide: Vec<Point2<f64>>,
}

/// The scans of a log, each with its source.
struct LoggedScans {
    sources: Vec<EventSource>,
    log: ScanLogBuilder,
}

impl LoggedScans {
    fn add(&mut self, placed: impl IntoIterator<Item = PlacedScan>) {
        for PlacedScan { source, scan, odometry, .. } in placed {
            // Scans are in the order of their stamps.
            let last = self.sources.last().map_or(0, |last| last.time);
            self.sources.push(EventSource { time: source.time.max(last), ..source });
            self.log.add(scan, odometry);
        }
    }

    /// The visits; those by what was `driven`, too, if they are asked for.
    fn visits(self, driven: bool, watch: &impl Watch) -> SensedLog {
        let log = self.log.finish();
        let mut views = Vec::with_capacity(log.len());
        let mut done = 0;
        while views.len() < log.len() {
            let next = views.len()..log.len().min(views.len() + VIEWS);
            views.par_extend(next.into_par_iter().map(|view| log.view(view, driven)));
            let scans = log.scan(views.len() - 1) + 1;
            watch.part_done((scans - done) as u64);
            done = scans;
        }
        let visits = logged_visits(&log, &views, |scan| self.sources[scan]);
        let by_driven = || driven_visits(&log, &views, |scan| self.sources[scan]);
        let driven = driven.then(by_driven).flatten();
        let params = &log.params().network;
        let network = NetworkFit::new(&views, &visits, params);
        let is_wide = |view: &&PlaceView| view.width.is_some_and(|width| width > params.widest);
        let place = |view: &PlaceView| view.odometry_from_map * Point2::from(view.robot.position);
        let wide = views.iter().filter(is_wide).map(place).collect();
        SensedLog { visits, driven, drift: log.drift(), network, wide }
    }
}

/// Whether an entry shows where the robot was at its time.
fn is_timed(entry: &Entry) -> bool {
    matches!(
        entry.content,
        Content::Fiducial(_)
            | Content::Event(
                EventKind::Odometry(_) | EventKind::Frame(Frame { scan: Some(_), .. })
            )
    )
}

/// The events that are inferred from scenes.
pub fn infer_events(seen: &[SensedScene], marked: bool) -> Vec<CheckedEvent> {
    infer_visits(seen, marked).0
}

/// The same, and the junctions that the robot visited.
fn infer_visits(seen: &[SensedScene], marked: bool) -> (Vec<CheckedEvent>, Vec<VisitedJunction>) {
    let mut visits = Visits::by_camera(marked);
    for SensedScene { source, scene, odometry } in seen {
        visits.add_frame(*source, scene, odometry);
    }
    visit_events(visits.finish())
}

struct Extraction<'w, W> {
    /// What is extracted so far.
    run: ExtractedRun,
    recorded: RecordedEvents,
    /// The scenes that are the evidence, or those of its images.
    scenes: PlacedScenes,
    /// Frames that have not been sensed, with their times.
    waiting: Vec<(EventSource, u64, Frame)>,
    /// The time of the last percept or door.
    last: u64,
    /// One for each thread.
    sensors: Vec<Sensor>,
    watch: &'w W,
    scans: LoggedScans,
    placing: Placing,
}

/// How scans are placed.
enum Placing {
    /// Scans wait for their odometry.
    Odometry(ScanOdometry),
    /// By the walls of earlier scans: the log has no odometry.
    Scans(Box<ScanTrack>),
}

/// Whether a log that has scans has odometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum HasOdometry {
    No,
    Yes,
}

impl<W: Watch> Extraction<'_, W> {
    fn read_entries(
        &mut self,
        log: &Log,
        bound: &BoundTopicMap,
    ) -> Result<HasOdometry, ExtractError> {
        let mut clock = MessageClock::default();
        let mut entries = log.entries(bound);
        for entry in entries.by_ref() {
            let entry = entry?;
            if self.run.evidence == Evidence::Laser && is_timed(&entry) {
                clock
                    .next(entry.time, entry)
                    .into_iter()
                    .try_for_each(|entry| self.add_entry(entry))?;
            } else {
                self.add_entry(entry)?;
            }
        }
        let (rest, off_clock) = clock.finish();
        rest.into_iter().try_for_each(|entry| self.add_entry(entry))?;
        self.look()?;
        self.run.skipped.off_clock = off_clock;
        self.run.remarks = entries.remarks();
        let empty = Placing::Odometry(ScanOdometry::default());
        match std::mem::replace(&mut self.placing, empty) {
            Placing::Odometry(placing) => {
                self.run.skipped.scans_without_odometry = placing.without_odometry();
                self.run.stamps = placing.counts();
                match placing.finish() {
                    Some(waiting) => self.scans.add(waiting),
                    None if self.run.scans > 0 => return Ok(HasOdometry::No),
                    None => {}
                }
            }
            Placing::Scans(track) => {
                let (waiting, matched) = track.finish()?;
                self.run.poses.extend(waiting.iter().map(PlacedScan::pose));
                self.scans.add(waiting);
                self.run.matched_scans = Some(matched);
            }
        }
        Ok(HasOdometry::Yes)
    }

    fn add_entry(&mut self, entry: Entry) -> Result<(), ExtractError> {
        let Entry { time, offset, id, stamp, content, .. } = entry;
        let stamp = stamp.nanoseconds();
        let source = EventSource { time, id, offset };
        let kind = match content {
            Content::Event(kind) => kind,
            Content::Run(run) => {
                self.run.events.has_head = true;
                self.run.run = Some(run);
                return Ok(());
            }
            Content::Fiducial(sighting) => {
                self.run.sightings.push((time, sighting));
                return Ok(());
            }
            Content::TurnedBack => {
                self.recorded.note(source, CheckedKind::TurnedBack);
                return Ok(());
            }
            Content::Undecided => {
                self.recorded.note(source, CheckedKind::Undecided(UndecidedCause::Unclear));
                return Ok(());
            }
            Content::Hypothesis(_) => return Ok(()),
        };
        let is_recorded = matches!(
            kind,
            EventKind::Arrival(_) | EventKind::Door { .. } | EventKind::Action { .. }
        );
        if is_recorded && self.run.evidence == Evidence::Recorded {
            let before = std::mem::replace(&mut self.last, stamp);
            OutOfOrder::check(before, stamp)
                .map_err(|order| ExtractError::OutOfOrder { message: id.0, order })?;
        }
        self.recorded.observe(source, &kind);
        match kind {
            EventKind::Odometry(odometry) => {
                if let Placing::Odometry(placing) = &mut self.placing {
                    self.scans.add(placing.odometry(stamp, odometry));
                }
                if matches!(self.run.evidence, Evidence::Scenes | Evidence::Images) {
                    self.scenes.add_odometry(id, stamp, odometry);
                }
            }
            EventKind::Frame(Frame { scene: Some(scene), .. }) => {
                self.scenes.add_scene(source, stamp, scene);
            }
            EventKind::Frame(Frame { scan: Some(scan), odometry, .. }) => {
                self.run.scans += 1;
                self.run.scan_messages.push(id);
                self.run.field_of_view = self.run.field_of_view.max(scan.field_of_view());
                let placed = PlacedScan { source, stamp, scan, odometry };
                self.scans.add(match &mut self.placing {
                    Placing::Odometry(placing) => placing.scan(placed),
                    Placing::Scans(track) => {
                        let placed = track.scan(placed)?;
                        self.run.poses.extend(placed.iter().map(PlacedScan::pose));
                        placed
                    }
                });
            }
            EventKind::Frame(frame) => {
                self.waiting.push((source, stamp, frame));
                if self.waiting.len() >= TOGETHER {
                    self.look()?;
                }
            }
            EventKind::Action { action, .. } if self.run.evidence != Evidence::Recorded => {
                return Err(ExtractError::Action { message: id.0, action });
            }
            EventKind::End(end) => self.run.events.end = Some(end),
            EventKind::Map(map) => self.run.events.map = Some(map),
            _ => {}
        }
        Ok(())
    }

    /// Senses the waiting frames.
    fn look(&mut self) -> Result<(), ExtractError> {
        if self.waiting.is_empty() {
            return Ok(());
        }
        if self.sensors.is_empty() {
            return Err(ExtractError::NoSensor);
        }
        let share = self.waiting.len().div_ceil(self.sensors.len());
        let shares = self.sensors.par_iter_mut().zip(self.waiting.par_chunks(share));
        let look = |(sensor, frames): (&mut Sensor, &[(EventSource, u64, Frame)])| {
            // Without its pixels, which would be kept until all are sensed.
            let scenes = frames.iter().map(|(_, _, frame)| sensor.scene(&frame.without_pixels()));
            scenes.collect::<Vec<_>>()
        };
        let seen: Vec<_> = shares.flat_map_iter(look).collect();
        self.watch.part_done(seen.len() as u64);
        self.run.images += seen.len() as u64;
        for ((source, time, _), scene) in self.waiting.drain(..).zip(seen) {
            match scene {
                Err(SensingError::Image(_)) => self.run.unreadable += 1,
                Err(cause) => return Err(ExtractError::Size { message: source.id.0, cause }),
                Ok(scene) => self.scenes.add_scene(source, time, scene),
            }
        }
        Ok(())
    }
}
