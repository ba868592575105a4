//! The events and the visits of a report.

use serde::Serialize;
use toposlam_model::{embedded_graph::Dart, percept::Sighting};

use super::super::{
    check::{CheckedLog, LogSource},
    events::{CheckedEvent, CheckedKind, EventSource, RunEvents},
    known_world::Known,
};

#[derive(Clone, Debug, PartialEq)]
pub struct ReportedEvent {
    /// From 1.
    pub number: usize,
    pub source: EventSource,
    /// Seconds since the first message.
    pub time: f64,
    pub kind: CheckedKind,
    /// The robot's pose in the known world after it, if only one fits.
    pub pose: Option<Dart>,
    /// What is known of its pose after it, where that has changed.
    pub then: Option<EventPose>,
}

/// What is known of the robot's pose in the known world.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EventPose {
    At(PoseName),
    Candidates(usize),
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PoseName {
    pub vertex: String,
    /// The neighbour or the edge that the robot came from.
    pub from: String,
}

/// A junction that the robot visited.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReportedVisit {
    pub index: usize,
    /// In seconds, by the clock of the log.
    pub stamp: f64,
    /// The number of doors; `None` if the visit is undecided.
    pub degree: Option<u32>,
    /// The door by which the robot left; `None` if the log ends there.
    pub door: Option<u32>,
    /// `None` if that is not recorded.
    pub marker: Option<MarkerSeen>,
    /// Whether the robot turned back on its way there.
    pub turned_back: bool,
    /// The length of the hallway by which it came, by odometry, in metres; `None` if it was not measured.
    pub length: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum MarkerSeen {
    /// The door along which it points, or -1 without a marker.
    Door(i64),
    /// It is there, and points along no door.
    Seen(bool),
}

impl MarkerSeen {
    pub(in super::super) fn from_sighting(sighting: Sighting) -> Option<Self> {
        match sighting {
            Sighting::Pointing(door) => Some(Self::Door(door.0.into())),
            Sighting::Nothing => Some(Self::Door(-1)),
            Sighting::Lying(_) => Some(Self::Seen(true)),
            _ => None,
        }
    }
}

impl Known {
    pub(super) fn pose_name(&self, pose: Dart) -> PoseName {
        let vertex = self.world.at_text(pose).to_owned();
        PoseName { vertex, from: self.world.leads_to(pose).to_owned() }
    }
}

impl CheckedLog {
    pub(super) fn reported_events(&self, source: &LogSource) -> Vec<ReportedEvent> {
        let judgement = &self.judgement;
        let begun = source.log.start().unwrap_or(0);
        let mut before = None;
        let event = |(index, event): (usize, &CheckedEvent)| {
            let place = judgement.trace.index_of(index);
            let poses = judgement.poses.as_ref();
            let pose = poses.and_then(|poses| Some(poses.alone.get(place)?.as_ref()?.pose));
            // After a door it is not known where the robot is until it arrives.
            let there = poses.zip(self.known.as_ref()).filter(|_| event.arrival().is_some());
            let there = there.and_then(|(poses, known)| {
                let left = *poses.left.get(place)?;
                Some(pose.map_or(EventPose::Candidates(left), |pose| {
                    EventPose::At(known.pose_name(pose))
                }))
            });
            let then = there.filter(|there| before.as_ref() != Some(there));
            if then.is_some() {
                before.clone_from(&then);
            }
            ReportedEvent {
                number: index + 1,
                source: event.source,
                time: event.source.time.saturating_sub(begun) as f64 / 1e9,
                kind: event.kind.clone(),
                pose,
                then,
            }
        };
        judgement.events.events.iter().enumerate().map(event).collect()
    }
}

impl ReportedVisit {
    /// The junctions that a robot visited.
    pub(super) fn all(events: &RunEvents) -> Vec<Self> {
        let mut visits: Vec<Self> = Vec::new();
        let mut turned_back = false;
        for CheckedEvent { source, kind } in &events.events {
            let (degree, marker, length) = match kind {
                CheckedKind::Arrival { arrival, hallway, .. } => (
                    Some(arrival.degree),
                    arrival.sighting.and_then(MarkerSeen::from_sighting),
                    hallway.map(|hallway| hallway.length),
                ),
                CheckedKind::Undecided(_) => (None, None, None),
                CheckedKind::Door { door, .. } => {
                    if let Some(visit) = visits.last_mut() {
                        visit.door = Some(door.0);
                    }
                    continue;
                }
                CheckedKind::TurnedBack => {
                    turned_back = true;
                    continue;
                }
                CheckedKind::LeftBetweenDoors { .. } => continue,
            };
            visits.push(Self {
                index: visits.len(),
                stamp: source.time as f64 / 1e9,
                degree,
                door: None,
                marker,
                turned_back: std::mem::take(&mut turned_back),
                length,
            });
        }
        visits
    }
}
