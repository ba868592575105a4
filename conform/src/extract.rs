//! Extracts the events of a log: recorded ones, or else those that are inferred from its scenes, images or
//! laser scans and its odometry. Sections 3 to 6.

use rayon::prelude::*;
use serde::{Serialize, Serializer};
use thiserror::Error;
use toposlam_logs::{
    entries::{Content, Entry},
    error::LogError,
    messages,
    reader::Log,
    record::{EventKind, Frame, FrameSensor, SensingError},
    topic_map::{BoundTopicMap, Role, TopicMap, TopicMapError},
};
use toposlam_model::{enumerate::Watch, measurement::MeasurementNoise};
use toposlam_robot::measured_hallway::log_noise;
use toposlam_vision::{
    laser::{
        drift::{DriftMeter, ROUNDS},
        params::LaserParams,
    },
    sensing::Sensor,
};

use super::{
    InferredEvents, LaserEvents, RecordedEvents,
    events::{CheckedEvent, CheckedKind, EventSource, OutOfOrder, RunEvents, UndecidedCause},
    marked_visits::{TimedSighting, VisitedJunction},
    message_clock::MessageClock,
    params::SCENES,
    placed_scenes::{PlacedScenes, SceneClockError, SensedScene},
    scan_odometry::{PlacedScan, ScanOdometry},
};

/// The source of events.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Evidence {
    /// Recorded percepts and doors.
    #[default]
    Recorded,
    /// Recorded scenes and odometry.
    Scenes,
    /// Images and odometry.
    Images,
    /// Laser scans and odometry.
    Laser,
}

/// From what events are extracted, and how.
#[derive(Clone, Copy, Debug)]
pub struct ExtractConfig<'s> {
    /// The source of the events.
    pub evidence: Evidence,
    /// Senses images, if they are the source.
    pub sensor: Option<&'s Sensor>,
    /// Whether the robot puts its marker down at its start. This matters only for inferred events.
    pub marked: bool,
    /// The parameters for laser scans.
    pub laser: LaserParams,
}

/// The events of a log.
#[derive(Clone, Debug)]
pub struct ExtractedRun {
    /// The events, and the end of the run.
    pub events: RunEvents,
    /// Their source.
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
    /// The messages that were skipped.
    pub skipped: SkippedMessages,
    /// The widest field of view of a scan, in radians.
    pub field_of_view: f64,
    /// The drift of the heading of the odometry in 10 m, in radians, if scans were matched because of it.
    pub drift: Option<f64>,
    /// The junctions of the events that are inferred from laser scans.
    pub junctions: Vec<VisitedJunction>,
    /// The sightings of a marker that is a fiducial.
    pub sightings: Vec<TimedSighting>,
}

/// The number of messages that were skipped when events were inferred, by the reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SkippedMessages {
    /// Images, scenes, scans, odometry and sightings whose time is far from that of all other messages.
    pub off_clock: u64,
    /// Scans before which no odometry was recorded, nor soon after.
    pub scans_without_odometry: u64,
}

/// Why events cannot be extracted.
#[derive(Debug, Error)]
pub enum ExtractError {
    /// The log cannot be read.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The topic map does not fit it.
    #[error(transparent)]
    TopicMap(#[from] TopicMapError),
    /// No source of events is mapped.
    #[error(
        "no topics are known for percepts and doors, nor for scenes, images or laser scans with odometry; \
         `toposlam info` lists the topics"
    )]
    NothingMapped,
    /// Images must be sensed without a calibration or colours.
    #[error("its events must be inferred from its images: this needs --calibration and --colours")]
    NoSensor,
    /// There are laser scans, and no odometry.
    #[error("no odometry is recorded with its {scans} laser scans")]
    NoOdometry {
        /// The number of scans.
        scans: u64,
    },
    /// An image is not of the calibrated camera.
    #[error("message {message}: {cause}")]
    Size {
        /// The number of the message.
        message: u64,
        /// Why it cannot be sensed.
        cause: SensingError,
    },
    /// The odometry at the time of an image or a scene is not known.
    #[error(transparent)]
    SceneClock(#[from] SceneClockError),
    /// The time of a percept or door is before that of the last one.
    #[error("message {message}: {order}")]
    OutOfOrder {
        /// The number of the message.
        message: u64,
        /// The times.
        order: OutOfOrder,
    },
}

/// The number of images that are sensed in parallel.
const TOGETHER: usize = 32;

impl Serialize for Evidence {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.name().serialize(serializer)
    }
}

impl Evidence {
    /// Its name in JSON.
    #[must_use]
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
    pub fn of(mapping: &TopicMap) -> Option<Self> {
        [Self::Recorded, Self::Scenes, Self::Images, Self::Laser]
            .into_iter()
            .find(|one| one.is_in(mapping))
    }

    /// Whether a topic map has this source of events.
    #[must_use]
    pub fn is_in(self, mapping: &TopicMap) -> bool {
        let needed = match self {
            Self::Recorded => [Role::Percept, Role::Door],
            Self::Scenes => [Role::Scene, Role::Odometry],
            Self::Images => [Role::Image, Role::Odometry],
            Self::Laser => [Role::Scan, Role::Odometry],
        };
        needed.iter().all(|role| mapping.carrier(*role).is_some())
    }

    fn roles(self) -> &'static [Role] {
        match self {
            Self::Recorded => &[Role::Percept, Role::Door, Role::Odometry],
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
        Self { evidence, sensor: None, marked: false, laser: LaserParams::default() }
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
    let ExtractConfig { evidence, sensor, marked, mut laser } = *config;
    let asked = evidence.roles().iter().chain(&[Role::Run, Role::End, Role::Map]);
    let threads = rayon::current_num_threads();
    let sensors = sensor.map_or_else(Vec::new, |sensor| vec![sensor.clone(); threads]);
    let bound = mapping.only(asked).bind(log)?;
    let is_matched = evidence != Evidence::Laser || laser.matching.rounds > 0;
    let drift = if is_matched { None } else { measured_drift(log, &bound, &laser) };
    let drift = drift.filter(|&drift| drift > laser.matching.max_drift);
    if drift.is_some() {
        laser.matching.rounds = ROUNDS;
    }
    let mut extraction = Extraction {
        recorded: RecordedEvents::default(),
        scenes: PlacedScenes::default(),
        waiting: Vec::new(),
        run: None,
        last: 0,
        events: RunEvents { truncated: log.truncation().is_some(), ..RunEvents::default() },
        sensors,
        watch,
        images: 0,
        unreadable: 0,
        evidence,
        laser: LaserEvents::new(laser),
        placing: ScanOdometry::default(),
        scans: 0,
        field_of_view: 0.0,
        sightings: Vec::new(),
    };
    let mut skipped = extraction.read_entries(log, &bound)?;
    let Extraction {
        recorded,
        scenes,
        run,
        mut events,
        images,
        unreadable,
        laser,
        scans,
        field_of_view,
        sightings,
        ..
    } = extraction;
    let scans = scans - skipped.scans_without_odometry;
    let (seen, scenes_off_clock) = scenes.finish()?;
    skipped.off_clock += scenes_off_clock;
    if run.is_some() {
        let noise = log_noise();
        events.measurement_noise = match evidence {
            Evidence::Recorded => noise,
            Evidence::Scenes | Evidence::Images => {
                MeasurementNoise { standing: SCENES.near, ..noise }
            }
            Evidence::Laser => MeasurementNoise::UNKNOWN,
        };
    }
    let mut junctions = Vec::new();
    if evidence == Evidence::Laser && events.end.is_some() {
        // Corners and dead ends are no visits: the recorded moves and map are those of another graph.
        (events.has_head, events.end, events.map) = (false, None, None);
    }
    events.events = match evidence {
        Evidence::Recorded => recorded.finish(),
        Evidence::Scenes | Evidence::Images => infer_events(&seen, marked),
        Evidence::Laser => {
            let (events, visited) = laser.finish_with_junctions();
            junctions = visited;
            events
        }
    };
    Ok(ExtractedRun {
        events,
        evidence,
        run,
        seen,
        images,
        unreadable,
        scans,
        skipped,
        field_of_view,
        drift,
        junctions,
        sightings,
    })
}

/// The drift of the heading of the odometry of a log with laser scans, in radians in 10 m. `None` if it is too
/// short, up to its end or to what cannot be read.
fn measured_drift(log: &Log, bound: &BoundTopicMap, params: &LaserParams) -> Option<f64> {
    let mut meter = DriftMeter::new(*params);
    let mut placing = ScanOdometry::default();
    let mut take = |Entry { stamp, content, .. }: Entry| {
        let stamp = stamp.nanoseconds();
        let placed: Vec<PlacedScan> = match content {
            Content::Event(EventKind::Odometry(odometry)) => placing.odometry(stamp, odometry),
            Content::Event(EventKind::Frame(Frame { scan: Some(scan), odometry, .. })) => {
                let source = EventSource::default();
                let placed = placing.scan(stamp, PlacedScan { source, scan, odometry });
                placed.into_iter().collect()
            }
            _ => return,
        };
        for placed in &placed {
            meter.see(&placed.scan, &placed.odometry);
        }
    };
    let mut clock = MessageClock::default();
    for entry in log.entries(bound) {
        let Ok(entry) = entry else { break };
        if is_timed(&entry) {
            clock.next(entry.time, entry).into_iter().for_each(&mut take);
        }
    }
    clock.finish().0.into_iter().for_each(take);
    meter.finish()
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
#[must_use]
pub fn infer_events(seen: &[SensedScene], marked: bool) -> Vec<CheckedEvent> {
    let mut derivation = InferredEvents::new(marked);
    for SensedScene { source, scene, odometry } in seen {
        derivation.see(*source, scene, odometry);
    }
    derivation.finish()
}

struct Extraction<'w, W> {
    recorded: RecordedEvents,
    /// The scenes that are the evidence, or those of its images.
    scenes: PlacedScenes,
    /// Frames that have not been sensed, with their times.
    waiting: Vec<(EventSource, u64, Frame)>,
    run: Option<messages::Run>,
    /// The time of the last percept or door.
    last: u64,
    events: RunEvents,
    /// One for each thread.
    sensors: Vec<Sensor>,
    watch: &'w W,
    images: u64,
    unreadable: u64,
    evidence: Evidence,
    laser: LaserEvents,
    /// Scans that wait for their odometry.
    placing: ScanOdometry,
    scans: u64,
    field_of_view: f64,
    sightings: Vec<TimedSighting>,
}

impl<W: Watch> Extraction<'_, W> {
    /// Takes the entries of a log. Returns the number of those that are skipped.
    fn read_entries(
        &mut self,
        log: &Log,
        bound: &BoundTopicMap,
    ) -> Result<SkippedMessages, ExtractError> {
        let mut clock = MessageClock::default();
        for entry in log.entries(bound) {
            let entry = entry?;
            if self.evidence == Evidence::Laser && is_timed(&entry) {
                clock.next(entry.time, entry).into_iter().try_for_each(|entry| self.take(entry))?;
            } else {
                self.take(entry)?;
            }
        }
        let (rest, off_clock) = clock.finish();
        rest.into_iter().try_for_each(|entry| self.take(entry))?;
        self.look()?;
        let scans_without_odometry = self.placing.without_odometry();
        match std::mem::take(&mut self.placing).finish() {
            Some(waiting) => waiting.for_each(|placed| self.see(&placed)),
            None if self.scans > 0 => return Err(ExtractError::NoOdometry { scans: self.scans }),
            None => {}
        }
        Ok(SkippedMessages { off_clock, scans_without_odometry })
    }

    fn take(&mut self, entry: Entry) -> Result<(), ExtractError> {
        let Entry { time, offset, id, stamp, content, .. } = entry;
        let stamp = stamp.nanoseconds();
        let source = EventSource { time, id, offset };
        let kind = match content {
            Content::Run(run) => {
                self.events.has_head = true;
                self.run = Some(run);
                return Ok(());
            }
            Content::Hypothesis(_) => return Ok(()),
            Content::Fiducial(sighting) => {
                self.sightings.push((time, sighting));
                return Ok(());
            }
            Content::TurnedBack | Content::Undecided => {
                let turned = content == Content::TurnedBack;
                let kind = if turned {
                    CheckedKind::TurnedBack
                } else {
                    CheckedKind::Undecided(UndecidedCause::Unclear)
                };
                self.recorded.note(source, kind);
                return Ok(());
            }
            Content::Event(kind) => kind,
        };
        if matches!(kind, EventKind::Arrival(_) | EventKind::Door { .. }) {
            let before = std::mem::replace(&mut self.last, stamp);
            OutOfOrder::check(before, stamp)
                .map_err(|order| ExtractError::OutOfOrder { message: id.0, order })?;
        }
        self.recorded.observe(source, &kind);
        match kind {
            EventKind::Odometry(odometry) => {
                for placed in self.placing.odometry(stamp, odometry) {
                    self.see(&placed);
                }
                if matches!(self.evidence, Evidence::Scenes | Evidence::Images) {
                    self.scenes.add_odometry(id, stamp, odometry);
                }
            }
            EventKind::Frame(Frame { scene: Some(scene), .. }) => {
                self.scenes.add_scene(source, stamp, scene);
            }
            EventKind::Frame(Frame { scan: Some(scan), odometry, .. }) => {
                self.scans += 1;
                self.field_of_view = self.field_of_view.max(scan.field_of_view());
                if let Some(placed) =
                    self.placing.scan(stamp, PlacedScan { source, scan, odometry })
                {
                    self.see(&placed);
                }
            }
            EventKind::Frame(frame) => {
                self.waiting.push((source, stamp, frame));
                if self.waiting.len() >= TOGETHER {
                    self.look()?;
                }
            }
            EventKind::End(end) => self.events.end = Some(end),
            EventKind::Map(map) => self.events.map = Some(map),
            _ => {}
        }
        Ok(())
    }

    /// Senses a laser scan.
    fn see(&mut self, placed: &PlacedScan) {
        let PlacedScan { source, scan, odometry } = placed;
        self.laser.see(*source, scan, odometry);
        self.watch.part_done(1);
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
        self.images += seen.len() as u64;
        for ((source, time, _), scene) in self.waiting.drain(..).zip(seen) {
            match scene {
                Err(SensingError::Image(_)) => self.unreadable += 1,
                Err(cause) => return Err(ExtractError::Size { message: source.id.0, cause }),
                Ok(scene) => self.scenes.add_scene(source, time, scene),
            }
        }
        Ok(())
    }
}
