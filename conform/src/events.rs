//! The events of a recorded run that are checked. They are concluded from what the robot recorded: some exist in no
//! log, such as a visit that is not recognised, and each has what odometry measured on the way to it.

use thiserror::Error;
use toposlam_logs::record::{Arrival, EventId, MapRecord, RunEnd};
use toposlam_model::{
    aid::{AidAction, AidKind, markers::MOVABLE, pointer::MovablePointer},
    mapping::ArrivalMeasurement,
    marker::{Directional, NoMarker, Undirected},
    measurement::{HallwayMeasurement, MeasurementNoise},
    percept::{Door, Percept, Sighting},
    trace::{RecordedVisit, Trace, TraceEvent, TraceEventKind, TraceOrderError},
};
pub use toposlam_vision::visits::UndecidedCause;

/// The log message that an event came from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct EventSource {
    /// When it was written, in nanoseconds.
    pub time: u64,
    pub id: EventId,
    /// The offset of its record in the file, in bytes.
    pub offset: u64,
}

#[derive(Clone, Debug, PartialEq)]
pub struct CheckedEvent {
    pub source: EventSource,
    pub kind: CheckedKind,
}

#[derive(Clone, Debug, PartialEq)]
pub enum CheckedKind {
    /// The robot stood at a junction.
    Arrival {
        arrival: Arrival,
        /// The angle between the entry door and the direction that the robot came from by odometry, in
        /// radians; `None` if it is not known.
        entry_off: Option<f64>,
        /// What odometry measured since the arrival before; `None` if it is not known.
        hallway: Option<HallwayMeasurement>,
    },
    Door {
        /// The number of the move in the log, counted from 1.
        number: Option<u32>,
        door: Door,
        /// The angle between the door and the direction in which the robot drove by odometry, in radians;
        /// `None` if it is not known.
        off: Option<f64>,
    },
    /// The robot did something with its marking aid where it stood.
    Action {
        /// After how many moves by the log.
        number: Option<u32>,
        action: AidAction,
    },
    /// The robot left a junction in a direction without a door.
    LeftBetweenDoors {
        /// The angle to the nearest door, in radians.
        off: f64,
    },
    /// The robot turned back without having been at a junction.
    TurnedBack,
    /// The robot was, or may have been, at a junction that could not be recognised.
    Undecided(UndecidedCause),
}

/// The part of a run that is checked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunEvents {
    pub events: Vec<CheckedEvent>,
    pub has_head: bool,
    /// How the run ended, if that is recorded.
    pub end: Option<RunEnd>,
    /// The last recorded map.
    pub map: Option<MapRecord>,
    pub truncated: bool,
    /// Whether the robot may turn back between junctions. The excursions that fit are not among the events.
    pub may_turn_back: bool,
    /// The uncertainty of the measurements of hallways.
    pub measurement_noise: MeasurementNoise,
}

/// An event that is earlier than the one before it. Times are in nanoseconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the events are out of order: this one is at {:.3} s, the one before it at {:.3} s", *.time as f64 / 1e9, *.before as f64 / 1e9)]
pub struct OutOfOrder {
    pub time: u64,
    pub before: u64,
}

impl OutOfOrder {
    pub(crate) fn check(before: u64, time: u64) -> Result<(), Self> {
        if time < before { Err(Self { time, before }) } else { Ok(()) }
    }
}

/// Why arrivals are not those of a robot with a marker of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum SightingError {
    #[error("its percepts do not record whether the robot saw its marker")]
    NotRecorded,
    #[error("its percepts do not record along which door the marker points")]
    NoDoor,
    /// In an event, counted from 1.
    #[error("in event {event} its robot sees `{sighting}`, which is nothing that a robot with `{0}` sees", .aid.name())]
    OfAnotherAid { event: usize, sighting: Sighting, aid: AidKind },
    /// An event, counted from 1.
    #[error("after event {event}, it does not record what the robot then perceived where it stood")]
    NotRecordedAfter { event: usize },
}

/// An arrival of which only the percept is known.
impl From<Percept> for CheckedKind {
    fn from(Percept { degree, sighting }: Percept) -> Self {
        let sighting = Some(sighting);
        let arrival = Arrival { number: None, degree, sighting, shape: None, entry: None };
        Self::Arrival { arrival, entry_off: None, hallway: None }
    }
}

impl From<Door> for CheckedKind {
    fn from(door: Door) -> Self {
        Self::Door { door, number: None, off: None }
    }
}

impl CheckedEvent {
    /// What the robot perceived, if it stood at a junction.
    pub fn arrival(&self) -> Option<&Arrival> {
        match &self.kind {
            CheckedKind::Arrival { arrival, .. } => Some(arrival),
            _ => None,
        }
    }

    pub(crate) fn arrival_mut(&mut self) -> Option<&mut Arrival> {
        match &mut self.kind {
            CheckedKind::Arrival { arrival, .. } => Some(arrival),
            _ => None,
        }
    }

    /// The number of moves that the log records with it.
    pub(crate) fn number_mut(&mut self) -> Option<&mut u32> {
        match &mut self.kind {
            CheckedKind::Arrival { arrival: Arrival { number, .. }, .. }
            | CheckedKind::Door { number, .. }
            | CheckedKind::Action { number, .. } => number.as_mut(),
            _ => None,
        }
    }
}

impl RunEvents {
    #[cfg(test)]
    pub(crate) fn arrivals_mut(&mut self) -> impl Iterator<Item = &mut Arrival> {
        self.events.iter_mut().filter_map(CheckedEvent::arrival_mut)
    }

    /// Completes the arrivals that do not record whether the marker was seen: without a marker, none was. A door
    /// along which an undirected marker points is left out.
    pub(crate) fn complete_sightings(&mut self, aid: AidKind) -> Result<(), SightingError> {
        let is_none = aid == NoMarker.into();
        let is_undirected = [Undirected.into(), MOVABLE.into()].contains(&aid);
        // Of a marker it follows what is seen of it where it was dropped or picked up.
        let is_marker = matches!(
            aid,
            AidKind::Fixed(_)
                | AidKind::Markers(_)
                | AidKind::Pointer(_)
                | AidKind::DirectionalAndMovable(_)
        );
        if let Some(event) = self.unseen_action().filter(|_| !is_marker) {
            return Err(SightingError::NotRecordedAfter { event: event + 1 });
        }
        let is_directional = [Directional.into(), AidKind::Pointer(MovablePointer)].contains(&aid);
        for (event, checked) in (1..).zip(&mut self.events) {
            let Some(arrival) = checked.arrival_mut() else { continue };
            match arrival.sighting {
                None if is_none => arrival.sighting = Some(Sighting::Nothing),
                None => return Err(SightingError::NotRecorded),
                Some(Sighting::Pointing(_)) if is_undirected => {
                    arrival.sighting = Some(Sighting::Lying(1));
                }
                Some(Sighting::Lying(_)) if is_directional => return Err(SightingError::NoDoor),
                // Without a marker the judgement reports that one is seen.
                Some(sighting) if !is_none && !aid.shows(sighting) => {
                    return Err(SightingError::OfAnotherAid { event, sighting, aid });
                }
                Some(_) => {}
            }
        }
        Ok(())
    }

    /// Whether a marker is perceived, or may be: if that is not recorded, the judgement reports it.
    pub(crate) fn may_show_marker(&self) -> bool {
        let mut sightings = self.events.iter().filter_map(|event| Some(event.arrival()?.sighting));
        sightings.any(|sighting| sighting != Some(Sighting::Nothing))
    }

    /// The index of the first action with the marking aid after which nothing is recorded before the next action or door.
    fn unseen_action(&self) -> Option<usize> {
        let is_unseen = |two: &[CheckedEvent]| {
            let is_action = |event: &CheckedEvent| matches!(event.kind, CheckedKind::Action { .. });
            is_action(&two[0]) && two[1].arrival().is_none()
        };
        self.events.windows(2).position(is_unseen)
    }

    /// What the robot first did with its marking aid, and its index.
    pub(crate) fn first_action(&self) -> Option<(usize, AidAction)> {
        self.events.iter().enumerate().find_map(|(index, event)| match event.kind {
            CheckedKind::Action { action, .. } => Some((index, action)),
            _ => None,
        })
    }

    /// The trace of the arrivals, actions and doors. The id of an event is its index here. An arrival that does not
    /// record whether the marker was seen counts as one without it. The error is the first event that is out of turn.
    pub(crate) fn trace(&self) -> Result<Trace, TraceOrderError> {
        let event = |(id, event): (usize, &CheckedEvent)| {
            let kind = match &event.kind {
                CheckedKind::Arrival { arrival: Arrival { degree, sighting, .. }, .. } => {
                    let sighting = sighting.unwrap_or(Sighting::Nothing);
                    TraceEventKind::Percept(Percept { degree: *degree, sighting })
                }
                CheckedKind::Door { door, .. } => TraceEventKind::Door(*door),
                CheckedKind::Action { action, .. } => TraceEventKind::Action(*action),
                _ => return None,
            };
            Some(TraceEvent { id, kind })
        };
        let trace = Trace::from_events(self.events.iter().enumerate().filter_map(event))?;
        Ok(trace.with_relocations(self.relocations()))
    }

    /// The arrivals of a robot that got lost before, by their indices. A log of this project counts the moves to all
    /// others. In logs of other programs numbers may be missing.
    pub(crate) fn relocations(&self) -> impl Iterator<Item = usize> + '_ {
        let number = |event: &CheckedEvent| event.arrival().map(|arrival| arrival.number);
        let is_counted =
            self.has_head && self.events.iter().any(|event| matches!(number(event), Some(Some(_))));
        let is_lost = move |event: &CheckedEvent| is_counted && number(event) == Some(None);
        self.events.iter().enumerate().filter(move |(_, event)| is_lost(event)).map(|(at, _)| at)
    }

    /// What is recorded of the visits of a trace of these events, besides their percepts.
    pub(super) fn recorded_visits(&self, trace: &Trace) -> Vec<RecordedVisit> {
        let visit = |number| {
            let event = self.events.get(trace.percept_event(number).id).map(|event| &event.kind);
            let Some(CheckedKind::Arrival { arrival, hallway, .. }) = event else {
                return RecordedVisit::default();
            };
            RecordedVisit {
                measured: ArrivalMeasurement { hallway: *hallway, shape: arrival.shape },
                is_blocked: arrival.is_at_obstacle(),
            }
        };
        (0..trace.percepts().len()).map(visit).collect()
    }

    /// The events without the excursions of a robot that left a junction, turned back and entered it again:
    /// it has stood there all the time, and takes the door that it takes in the end. An excursion stays if
    /// the two percepts contradict each other.
    #[must_use]
    pub fn without_excursions(&self) -> Self {
        let mut events: Vec<CheckedEvent> = Vec::new();
        // By how many doors clockwise the next door is farther from the entry of the last arrival.
        let mut turned = Door::BACK;
        // The number of moves that are left out.
        let mut left_out = 0;
        for event in &self.events {
            let mut event = event.clone();
            match (&mut event.kind, &events[..]) {
                (CheckedKind::Arrival { arrival: again, .. }, [.., before, left, back])
                    if back.kind == CheckedKind::TurnedBack =>
                {
                    if let (Some(arrival), &CheckedKind::Door { door, .. }) =
                        (before.arrival(), &left.kind)
                        && arrival.is_same_from(again, door)
                    {
                        turned = door;
                        left_out += 1;
                        events.truncate(events.len() - 2);
                        continue;
                    }
                    turned = Door::BACK;
                }
                (CheckedKind::Door { door, .. }, [.., before]) => {
                    let entry = std::mem::replace(&mut turned, Door::BACK);
                    if let Some(&Arrival { degree, .. }) = before.arrival()
                        && door.0 < degree
                    {
                        *door = door.seen_from(entry.inverse(degree), degree);
                    }
                }
                _ => turned = Door::BACK,
            }
            if let Some(number) = event.number_mut() {
                *number = number.saturating_sub(left_out);
            }
            events.push(event);
        }
        // A robot that has turned back at the end has not arrived again.
        events.pop_if(|event| event.kind == CheckedKind::TurnedBack);
        Self { events, may_turn_back: true, ..self.clone() }
    }

    /// The events up to and including one, by its index.
    pub(crate) fn up_to(&self, index: usize) -> Self {
        let events = self.events.iter().take(index + 1).cloned().collect();
        self.with_events(events)
    }

    /// Other events of the same robot, without an end.
    pub(crate) fn with_events(&self, events: Vec<CheckedEvent>) -> Self {
        let Self { has_head, may_turn_back, measurement_noise, .. } = *self;
        Self { events, has_head, may_turn_back, measurement_noise, ..Self::default() }
    }
}
