//! The events of a log: those that it tells, or else those that are derived from its scenes or its
//! pictures, and its odometry. Sections 3 to 6.

use rayon::prelude::*;
use thiserror::Error;
use toposlam_model::driving::{
    odometry::Odometry,
    scene::{Scene, wrapped},
};
use toposlam_vision::sensing::Sensor;

use super::{
    InferredEvents, RecordedEvents,
    events::{CheckedEvent, EventSource, RunEvents},
};
use crate::{
    log::{
        entries::{Content, Entry},
        error::LogError,
        messages,
        reader::Log,
        topic_map::{Role, TopicMap, TopicMapError},
    },
    record::{EventKind, Frame, FrameSensor, SensingError},
};

/// What events are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// The percepts and doors that the log tells.
    Told,
    /// The scenes that it tells, and its odometry.
    Scenes,
    /// Its pictures, and its odometry.
    Pictures,
}

/// What was made of a log.
#[derive(Clone, Debug)]
pub struct ExtractedRun {
    /// The events, and what the log says of itself.
    pub events: RunEvents,
    /// What they are made of.
    pub evidence: Evidence,
    /// The head of the log, where it has one.
    pub run: Option<messages::Run>,
    /// What was seen, and where, where events are derived from it.
    pub seen: Vec<Seen>,
    /// How many pictures were looked at.
    pub pictures: u64,
    /// How many of them are no images.
    pub unreadable: u64,
}

/// What was seen in a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// Where it, or its scene, stands in the log.
    pub source: EventSource,
    /// What it shows.
    pub scene: Scene,
    /// Where the robot was when it was taken.
    pub odometry: Odometry,
}

/// Why there are no events.
#[derive(Debug, Error)]
pub enum ExtractError {
    /// The log cannot be read.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The mapping does not fit it.
    #[error(transparent)]
    TopicMap(#[from] TopicMapError),
    /// Nothing that could be judged is mapped.
    #[error(
        "it has neither percepts and doors, nor scenes or pictures together with odometry, as far as the \
         mapping tells; `toposlam info` tells what it has"
    )]
    NothingMapped,
    /// Pictures have to be looked at, and there is no calibration, or there are no colours.
    #[error(
        "its events have to be derived from its pictures: that needs --calibration and --colours"
    )]
    NoEyes,
    /// A picture is not of the calibrated camera.
    #[error("message {message}: {cause}")]
    Size {
        /// Which message, counted from 1.
        message: u64,
        /// What is wrong with it.
        cause: SensingError,
    },
    /// A percept or a door says that it was before the one ahead of it.
    #[error("message {message}: the events are out of order: it is of {:.3} s, the one before it of {:.3} s", *.time as f64 / 1e9, *.before as f64 / 1e9)]
    OutOfOrder {
        /// Which message, counted from 1.
        message: u64,
        /// When it says that it was, in nanoseconds.
        time: u64,
        /// When the one before it was.
        before: u64,
    },
}

/// Watches pictures being looked at, and may break off.
pub trait Looking {
    /// So many more pictures have been looked at.
    fn looked(&self, _pictures: u64) {}
}

impl Looking for () {}

/// So many pictures are looked at together, by as many threads as there are.
const TOGETHER: usize = 32;

impl Evidence {
    /// What events can be made of where such things are mapped: the first in the order of this list.
    #[must_use]
    pub fn of(mapping: &TopicMap) -> Option<Self> {
        [Self::Told, Self::Scenes, Self::Pictures].into_iter().find(|one| one.is_in(mapping))
    }

    /// Whether events can be made of it where such things are mapped.
    #[must_use]
    pub fn is_in(self, mapping: &TopicMap) -> bool {
        let needed = match self {
            Self::Told => [Role::Percept, Role::Door],
            Self::Scenes => [Role::Scene, Role::Odometry],
            Self::Pictures => [Role::Image, Role::Odometry],
        };
        needed.iter().all(|role| mapping.carrier(*role).is_some())
    }

    fn roles(self) -> &'static [Role] {
        match self {
            Self::Told => &[Role::Percept, Role::Door, Role::Odometry],
            Self::Scenes => &[Role::Scene, Role::Odometry],
            Self::Pictures => &[Role::Image, Role::Odometry],
        }
    }
}

/// Makes events of a log. A robot that is `marked` puts its marker down where it begins; that is only
/// asked where events are derived.
///
/// # Errors
/// Where the log cannot be read, and where there is nothing in it of which events could be made.
pub fn extract(
    log: &Log,
    mapping: &TopicMap,
    evidence: Evidence,
    sensor: Option<&Sensor>,
    marked: bool,
    watch: &impl Looking,
) -> Result<ExtractedRun, ExtractError> {
    let asked = evidence.roles().iter().chain(&[Role::Run, Role::End, Role::Map]);
    let threads = rayon::current_num_threads();
    let sensors = sensor.map_or_else(Vec::new, |sensor| vec![sensor.clone(); threads]);
    let bound = mapping.only(asked).bind(log)?;
    let mut gathering = Extraction {
        recorded: RecordedEvents::default(),
        track: Vec::new(),
        seen: Vec::new(),
        waiting: Vec::new(),
        run: None,
        last: 0,
        events: RunEvents { truncated: log.truncation().is_some(), ..RunEvents::default() },
        sensors,
        watch,
        pictures: 0,
        unreadable: 0,
    };
    for entry in log.entries(&bound) {
        gathering.take(entry?)?;
    }
    gathering.look()?;
    let Extraction { recorded, track, seen, run, mut events, pictures, unreadable, .. } = gathering;
    let placed = |(source, time, scene)| {
        let odometry = at(&track, time)?;
        Some(Seen { source, scene, odometry })
    };
    let seen: Vec<_> = seen.into_iter().filter_map(placed).collect();
    events.events = match evidence {
        Evidence::Told => recorded.finish(),
        Evidence::Scenes | Evidence::Pictures => derived(&seen, marked),
    };
    Ok(ExtractedRun { events, evidence, run, seen, pictures, unreadable })
}

/// The events of what was seen.
#[must_use]
pub fn derived(seen: &[Seen], marked: bool) -> Vec<CheckedEvent> {
    let mut derivation = InferredEvents::new(marked);
    for Seen { source, scene, odometry } in seen {
        derivation.see(*source, scene, odometry);
    }
    derivation.finish()
}

struct Extraction<'w, W> {
    recorded: RecordedEvents,
    /// Where the robot was, and when.
    track: Vec<(u64, Odometry)>,
    /// What was seen, and when the picture was taken.
    seen: Vec<(EventSource, u64, Scene)>,
    /// Frames that have not been sensed, with their times.
    waiting: Vec<(EventSource, u64, Frame)>,
    run: Option<messages::Run>,
    /// When the last percept or door was.
    last: u64,
    events: RunEvents,
    /// One for each thread.
    sensors: Vec<Sensor>,
    watch: &'w W,
    pictures: u64,
    unreadable: u64,
}

impl<W: Looking> Extraction<'_, W> {
    fn take(&mut self, entry: Entry) -> Result<(), ExtractError> {
        let Entry { time, offset, id, stamp, content, .. } = entry;
        let stamp = stamp.nanoseconds();
        let kind = match content {
            Content::Run(run) => {
                self.events.has_head = true;
                self.run = Some(run);
                return Ok(());
            }
            Content::Hypothesis(_) => return Ok(()),
            Content::Event(kind) => kind,
        };
        if matches!(kind, EventKind::Arrival(_) | EventKind::Door { .. }) {
            let before = std::mem::replace(&mut self.last, stamp);
            if stamp < before {
                return Err(ExtractError::OutOfOrder { message: id.0, time: stamp, before });
            }
        }
        let source = EventSource { time, id, offset };
        self.recorded.observe(source, &kind);
        match kind {
            EventKind::Odometry(odometry) => self.track.push((stamp, odometry)),
            EventKind::Frame(Frame { scene: Some(scene), .. }) => {
                self.seen.push((source, stamp, scene));
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

    /// Looks at the pictures that wait.
    fn look(&mut self) -> Result<(), ExtractError> {
        if self.waiting.is_empty() {
            return Ok(());
        }
        if self.sensors.is_empty() {
            return Err(ExtractError::NoEyes);
        }
        let share = self.waiting.len().div_ceil(self.sensors.len());
        let shares = self.sensors.par_iter_mut().zip(self.waiting.par_chunks(share));
        let look = |(sensor, frames): (&mut Sensor, &[(EventSource, u64, Frame)])| {
            // Without its pixels, which would be kept until all are sensed.
            let scenes = frames.iter().map(|(_, _, frame)| sensor.scene(&frame.without_pixels()));
            scenes.collect::<Vec<_>>()
        };
        let seen: Vec<_> = shares.flat_map_iter(look).collect();
        self.watch.looked(seen.len() as u64);
        self.pictures += seen.len() as u64;
        for ((source, time, _), scene) in self.waiting.drain(..).zip(seen) {
            match scene {
                Err(SensingError::Image(_)) => self.unreadable += 1,
                Err(cause) => return Err(ExtractError::Size { message: source.id.0, cause }),
                Ok(scene) => self.seen.push((source, time, scene)),
            }
        }
        Ok(())
    }
}

/// Where a robot was at a time, between the two readings nearest to it.
fn at(track: &[(u64, Odometry)], time: u64) -> Option<Odometry> {
    let after = track.partition_point(|&(reading, _)| reading < time);
    match (after.checked_sub(1).and_then(|before| track.get(before)), track.get(after)) {
        (Some(&(begin, from)), Some(&(end, to))) => {
            let part = (time - begin) as f64 / (end - begin) as f64;
            let turned = wrapped(to.heading - from.heading);
            Some(Odometry {
                position: [0, 1].map(|axis| {
                    from.position[axis] + part * (to.position[axis] - from.position[axis])
                }),
                heading: wrapped(from.heading + part * turned),
            })
        }
        (one, other) => one.or(other).map(|&(_, odometry)| odometry),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_two_readings_a_robot_is_between_two_places() {
        let odometry = |x, heading| Odometry { position: [x, 0.0], heading };
        let track = [(10, odometry(0.0, 3.0)), (20, odometry(1.0, -3.0))];
        let at = |time| at(&track, time).unwrap();
        assert_eq!(
            (at(5), at(10), at(20), at(30)),
            (track[0].1, track[0].1, track[1].1, track[1].1)
        );
        let half = at(15);
        assert_eq!(half.position, [0.5, 0.0]);
        assert!((half.heading.abs() - std::f64::consts::PI).abs() < 1e-12, "{half:?}");
        assert_eq!(super::at(&[], 5), None);
    }
}
