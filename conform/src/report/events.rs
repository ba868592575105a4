//! The events and the visits of a report.

use serde::Serialize;
use toposlam_model::{
    embedded_graph::Dart,
    percept::{Door, Sighting},
};
use toposlam_vision::visits::VisitPercept;

use super::super::{
    check::{CheckedLog, LogSource},
    events::{CheckedEvent, CheckedKind, EventSource},
    extract::ExtractedRun,
    known_world::Known,
    possible_visits::PossibleVisits,
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
    /// The number of its scan, from 0; `None` if it was not inferred from one.
    pub scan: Option<usize>,
    /// Its centre in the frame of odometry, in metres; `None` if it is not known.
    pub position: Option<[f64; 2]>,
    /// The number of doors; `None` if the visit is undecided.
    pub degree: Option<u32>,
    /// The door by which the robot left; `None` if the log ends there, or if the visit is undecided.
    pub door: Option<u32>,
    /// The direction in which it left, in the frame of odometry, in radians; `None` if it is not known.
    pub exit: Option<f64>,
    /// `through`, or `back` if the robot left the way that it came; `None` if it is not known.
    pub way: Option<&'static str>,
    /// Degrees and doors that the sensor cannot exclude, of which `None` is no junction; empty if nothing is known.
    pub alternatives: Vec<Option<(u32, Option<u32>)>>,
    /// Why several are left.
    pub doubt: Option<&'static str>,
    /// Whether the known world leaves one of several.
    pub decided_by_world: bool,
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
            let pose = poses.and_then(|poses| *poses.alone.get(place)?);
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
    pub(super) fn all(run: &ExtractedRun, possible: Option<&PossibleVisits>) -> Vec<Self> {
        let mut visits: Vec<Self> = Vec::new();
        let mut turned_back = false;
        for (event, CheckedEvent { source, kind }) in run.events.events.iter().enumerate() {
            let before = event.checked_sub(1).and_then(|before| run.events.events.get(before));
            let has_acted = before.is_some_and(|it| matches!(it.kind, CheckedKind::Action { .. }));
            let (degree, marker, length, doubt) = match kind {
                // It has perceived again where it stands.
                CheckedKind::Arrival { .. } if has_acted => continue,
                CheckedKind::Arrival { arrival, hallway, .. } => (
                    Some(arrival.degree),
                    arrival.sighting.and_then(MarkerSeen::from_sighting),
                    hallway.map(|hallway| hallway.length),
                    None,
                ),
                CheckedKind::Undecided(cause) => (None, None, None, Some(cause.name())),
                CheckedKind::Door { door, .. } => {
                    if let Some(visit) = visits.last_mut() {
                        visit.door = Some(door.0);
                        for alternative in visit.alternatives.iter_mut().flatten() {
                            alternative.1 = Some(door.0);
                        }
                        visit.way = Some(if *door == Door::BACK { "back" } else { "through" });
                    }
                    continue;
                }
                CheckedKind::TurnedBack => {
                    turned_back = true;
                    continue;
                }
                CheckedKind::Action { .. } | CheckedKind::LeftBetweenDoors { .. } => continue,
            };
            let junction = run.junctions.iter().find(|junction| junction.event == event);
            let undecided = junction.filter(|_| degree.is_none());
            let alternatives = match (degree, undecided) {
                (Some(degree), _) => vec![Some((degree, None))],
                (None, Some(junction)) => {
                    let alternative = |seen: &VisitPercept| (seen.degree, seen.door);
                    junction.alternatives.iter().map(|it| it.as_ref().map(alternative)).collect()
                }
                (None, None) => Vec::new(),
            };
            let index = visits.len();
            visits.push(Self {
                index,
                stamp: source.time as f64 / 1e9,
                scan: run.scan_messages.iter().position(|&scan| scan == source.id),
                position: junction.map(|junction| junction.centre),
                degree,
                door: None,
                exit: junction.and_then(|junction| junction.exit),
                way: undecided.map(|it| if it.goes_back { "back" } else { "through" }),
                alternatives,
                doubt,
                decided_by_world: possible.is_some_and(|it| it.decided_by_world.contains(&index)),
                marker,
                turned_back: std::mem::take(&mut turned_back),
                length,
            });
        }
        visits
    }
}
