//! What happens in a run.

use toposlam_model::{
    aid::AidAction,
    driving::{
        algorithm2::{Command, JunctionState, PathState},
        odometry::Odometry,
        pose::Pose,
        visit::JunctionShape,
    },
    mapping::MappingEvent,
    percept::{Door, Percept, Sighting},
};

use super::{Frame, MapRecord};

/// The number of an event in a running robot, or of the log message that it came from; counted from 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EventId(pub u64);

#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    pub id: EventId,
    /// When it happened, in nanoseconds since the robot was switched on, or by the clock of the log.
    pub time: u64,
    pub truth: Option<Pose>,
    pub kind: EventKind,
}

#[derive(Clone, Debug, PartialEq)]
pub enum EventKind {
    /// The sensors gave something. A log has images and scenes in frames of their own.
    Frame(Frame),
    Command {
        state: PathState,
        /// What the robot does; `None` if the path has ended.
        command: Option<Command>,
    },
    Door {
        /// Which move begins, counted from 1, if known.
        number: Option<u32>,
        door: Door,
    },
    /// The robot did something with its marking aid, at the junction of the last arrival.
    Action {
        /// After how many moves, if known.
        number: Option<u32>,
        action: AidAction,
    },
    Arrival(Arrival),
    Hypothesis {
        moves: u64,
        event: MappingEvent,
    },
    Map(MapRecord),
    Motion {
        /// Metres a second ahead.
        forward: f64,
        /// Radians a second, counter-clockwise.
        turn: f64,
    },
    Odometry(Odometry),
    End(RunEnd),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    pub number: Option<u32>,
    pub degree: u32,
    /// What was seen of the marker; `None` if that is not recorded.
    pub sighting: Option<Sighting>,
    /// The junction's shape, seen from the entry door, if known.
    pub shape: Option<JunctionShape>,
    /// The direction of the entry door in the frame of odometry, in radians, if known.
    pub entry: Option<f64>,
}

impl Arrival {
    pub fn new(moves: u64, at: &JunctionState) -> Self {
        let &JunctionState { shape, percept, entry } = at;
        let number = Some(u32::try_from(moves).unwrap_or(u32::MAX));
        let Percept { degree, sighting } = percept;
        Self { number, degree, sighting: Some(sighting), shape: Some(shape), entry: Some(entry) }
    }

    /// The percept; `None` if it is not recorded whether the marker was seen.
    pub fn percept(&self) -> Option<Percept> {
        Some(Percept { degree: self.degree, sighting: self.sighting? })
    }

    /// Whether the robot stands before an obstacle, where it sees no junction.
    pub fn is_at_obstacle(&self) -> bool {
        self.degree == 1 && self.shape.is_none() && self.entry.is_some()
    }

    /// Whether another arrival can be at the same junction, entered by a door of this one.
    pub fn is_same_from(&self, other: &Self, door: Door) -> bool {
        if self.degree != other.degree || door.0 >= self.degree {
            return false;
        }
        let turned = |sighting: Sighting| match sighting {
            Sighting::Pointing(along) => Sighting::Pointing(along.seen_from(door, self.degree)),
            other => other,
        };
        let sightings = self.sighting.map(turned).zip(other.sighting);
        sightings.is_none_or(|(one, other)| one == other)
    }

    pub fn agrees(&self, percept: &Percept) -> bool {
        self.degree == percept.degree
            && self.sighting.is_none_or(|sighting| sighting == percept.sighting)
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunEnd {
    pub moves: u64,
    pub ending: RunEnding,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RunEnding {
    Mapped,
    Stopped,
    GaveUp(String),
    OutOfBudget(String),
}

/// Seconds since the robot was switched on, in nanoseconds.
pub fn nanoseconds(seconds: f64) -> u64 {
    (seconds * 1e9).round() as u64
}
