//! What happened in a recorded run, as far as the specification knows it: percepts and doors, and what
//! a robot should not do. Raw measurements stay beside their discrete labels.

use thiserror::Error;
use toposlam_model::{
    driving::visit::JunctionShape,
    percept::{Door, Percept},
    trace::{Trace, TraceEvent, TraceOrderError},
};

/// Where in the log something stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Source {
    /// When it was written, in nanoseconds.
    pub time: u64,
    /// Which message of the file it is, counted from 1.
    pub message: u64,
    /// Where its record begins in the file, in bytes.
    pub offset: u64,
}

/// An event.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Where it stands in the log.
    pub source: Source,
    /// What happened.
    pub kind: Kind,
}

/// What happened.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// The robot stood at a junction.
    Perceived(Perceived),
    /// The robot left a junction.
    Left {
        /// By which door.
        door: Door,
        /// Which move the log says that it is, counted from 1.
        number: Option<u32>,
        /// By how much it then drove in another direction than that of the door, in radians, as odometry
        /// has it; `None` where it does not tell.
        off: Option<f64>,
    },
    /// The robot drove off in a direction that is that of no door.
    Aside {
        /// By how much it is off the nearest, in radians.
        off: f64,
    },
    /// The robot turned back without having been at a junction.
    TurnedBack,
    /// The robot was at a junction that its pictures did not tell.
    Undecided,
}

/// What a robot perceived at a junction, and what that was made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Perceived {
    /// The percept.
    pub percept: Percept,
    /// After how many moves the log says that it was.
    pub number: Option<u32>,
    /// Which of the four directions, clockwise from the entry door, are doors, if that is known.
    pub form: Option<JunctionShape>,
    /// The direction of the entry door in the frame of odometry, in radians, if that is known.
    pub entry: Option<f64>,
    /// By how much that differs from where odometry says that the robot came from, in radians.
    pub entry_off: Option<f64>,
}

/// What a log says of itself at its beginning.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Head {
    /// The name of the world.
    pub world: String,
    /// Its hash.
    pub world_hash: String,
    /// Where the robot starts.
    pub start: String,
    /// The kind of marker.
    pub marker: String,
}

/// How a log says that its run ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ending {
    /// `mapped`, `gave-up` or `stopped`.
    pub ending: String,
    /// Why, where it gave up.
    pub cause: String,
    /// The moves made.
    pub moves: u32,
}

/// All that is judged of a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Events {
    /// What happened, in order.
    pub events: Vec<Event>,
    /// What the log says of itself, if it does.
    pub head: Option<Head>,
    /// How it says that it ended, if it does.
    pub ending: Option<Ending>,
    /// The last map in it: the degrees of its vertices, and of each dart the other end, -1 where that
    /// is unexplored.
    pub map: Option<(Vec<u32>, Vec<i32>)>,
    /// Whether the log was cut off.
    pub truncated: bool,
}

/// Events that are earlier than those before them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("event {event} is at {:.3} s, before the one ahead of it at {:.3} s", seconds(*.time), seconds(*.before))]
pub struct OutOfOrder {
    /// Which event, counted from 1.
    pub event: usize,
    /// Its time.
    pub time: u64,
    /// That of the event before it.
    pub before: u64,
}

/// Nanoseconds in seconds.
fn seconds(time: u64) -> f64 {
    time as f64 / 1e9
}

impl Events {
    /// The trace of the percepts and doors, and for each of its events which of these it is, from 0.
    ///
    /// # Errors
    /// Where percepts and doors do not take turns: the first that does not, by its place here.
    pub fn trace(&self) -> Result<(Trace, Vec<usize>), TraceOrderError> {
        let mut places = Vec::new();
        let mut taken = Vec::new();
        for (place, event) in self.events.iter().enumerate() {
            let event = match &event.kind {
                Kind::Perceived(perceived) => TraceEvent::Perceived(perceived.percept),
                Kind::Left { door, .. } => TraceEvent::Left(*door),
                Kind::Aside { .. } | Kind::TurnedBack | Kind::Undecided => continue,
            };
            places.push(place);
            taken.push(event);
        }
        let at = |event: usize| places.get(event).copied().unwrap_or(event);
        match Trace::new(taken) {
            Ok(trace) => Ok((trace, places)),
            Err(TraceOrderError::Empty) => Err(TraceOrderError::Empty),
            Err(TraceOrderError::NoDoor { event }) => {
                Err(TraceOrderError::NoDoor { event: at(event) })
            }
            Err(TraceOrderError::NoPercept { event }) => {
                Err(TraceOrderError::NoPercept { event: at(event) })
            }
        }
    }

    /// Whether each event is no earlier than those before it.
    ///
    /// # Errors
    /// The first that is.
    pub fn in_order(&self) -> Result<(), OutOfOrder> {
        for (place, two) in self.events.windows(2).enumerate() {
            let [before, time] = [two[0].source.time, two[1].source.time];
            if time < before {
                return Err(OutOfOrder { event: place + 2, time, before });
            }
        }
        Ok(())
    }

    /// The events up to and with one, from 0.
    #[must_use]
    pub fn up_to(&self, event: usize) -> Self {
        let events = self.events.iter().take(event + 1).cloned().collect();
        Self { events, head: self.head.clone(), ..Self::default() }
    }
}
