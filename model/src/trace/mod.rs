//! Recorded explorations, held against the specification: a known world, some world, Algorithm 1.
//! Sections 2.1 and 2.3.

mod algorithm_match;
mod coverage;
mod known_world;
mod shorten;
mod world_search;

use thiserror::Error;

pub use algorithm_match::{
    Allowed, Choosing, Claim, Departure, Followed, Purpose, Reached, TraceWorld, TraceWorldError,
    follow,
};
pub use coverage::{AlgorithmCase, AlgorithmCoverage, reachable};
pub use known_world::{Misfit, MisfitReason, Poses, anywhere, poses};
pub use shorten::shortened;
pub use world_search::{SmallestWorld, WorldSearch, smallest};

use crate::percept::{Door, Percept};

/// What a robot perceived and which doors it took, in turn; it begins with the percept at the start.
///
/// Its events are numbered from 0: event `2i` is the percept after `i` moves, event `2i + 1` the door
/// of the next move.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trace {
    percepts: Vec<Percept>,
    doors: Vec<Door>,
}

/// Something that a robot perceived or did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TraceEvent {
    /// It stood at a vertex and perceived this.
    Perceived(Percept),
    /// It left by this door.
    Left(Door),
}

/// Events that do not take turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum TraceOrderError {
    /// There is none.
    #[error("there is no event")]
    Empty,
    /// A percept where a door is due.
    #[error("a percept follows a percept: no door was taken in between")]
    NoDoor {
        /// Which event, from 0.
        event: usize,
    },
    /// A door where a percept is due.
    #[error("a door is taken where no percept has come since the last one")]
    NoPercept {
        /// Which event, from 0.
        event: usize,
    },
}

impl Trace {
    /// A trace of events that take turns.
    ///
    /// # Errors
    /// The first event that is not in turn.
    pub fn new(events: impl IntoIterator<Item = TraceEvent>) -> Result<Self, TraceOrderError> {
        let (mut percepts, mut doors) = (Vec::new(), Vec::new());
        for (number, event) in events.into_iter().enumerate() {
            match event {
                TraceEvent::Perceived(_) if number % 2 == 1 => {
                    return Err(TraceOrderError::NoDoor { event: number });
                }
                TraceEvent::Left(_) if number % 2 == 0 => {
                    return Err(TraceOrderError::NoPercept { event: number });
                }
                TraceEvent::Perceived(percept) => percepts.push(percept),
                TraceEvent::Left(door) => doors.push(door),
            }
        }
        if percepts.is_empty() { Err(TraceOrderError::Empty) } else { Ok(Self { percepts, doors }) }
    }

    /// The number of events; never 0.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "it is never empty")]
    pub fn len(&self) -> usize {
        self.percepts.len() + self.doors.len()
    }

    /// The events in order.
    pub fn events(&self) -> impl Iterator<Item = TraceEvent> + '_ {
        (0..self.len()).map(|number| self.event(number))
    }

    /// What was perceived: at the start, and after each move.
    #[must_use]
    pub fn percepts(&self) -> &[Percept] {
        &self.percepts
    }

    /// The doors that were taken.
    #[must_use]
    pub fn doors(&self) -> &[Door] {
        &self.doors
    }

    /// The trace up to and with an event.
    #[must_use]
    pub fn up_to(&self, event: usize) -> Self {
        let percepts = self.percepts.len().min(event / 2 + 1);
        let doors = self.doors.len().min(event.div_ceil(2));
        Self { percepts: self.percepts[..percepts].to_vec(), doors: self.doors[..doors].to_vec() }
    }

    /// An event of the trace, below its length.
    fn event(&self, number: usize) -> TraceEvent {
        if number.is_multiple_of(2) {
            TraceEvent::Perceived(self.percepts[number / 2])
        } else {
            TraceEvent::Left(self.doors[number / 2])
        }
    }

    /// The trace without the moves from one to another: after so many moves the robot does what it
    /// did after so many others. What it perceives in between is the later percept.
    fn without(&self, from: usize, to: usize) -> Self {
        let percepts = [&self.percepts[..from], &self.percepts[to..]].concat();
        let doors = [&self.doors[..from], &self.doors[to..]].concat();
        Self { percepts, doors }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::{
        embedded_graph::{Dart, EmbeddedGraph},
        mapping::{Exploration, Journey, MappingEvent, Nearest, map_world},
        percept::Sighting,
        world::{GraphWorld, World},
    };

    /// What a robot perceives on a walk from a start.
    pub(crate) fn walked(graph: &EmbeddedGraph, facing: Dart, doors: &[Door]) -> Trace {
        let mut world = GraphWorld::new(graph, facing);
        let mut events = vec![TraceEvent::Perceived(world.sensed())];
        for &door in doors {
            world.traverse(door).unwrap();
            events.extend([TraceEvent::Left(door), TraceEvent::Perceived(world.sensed())]);
        }
        Trace::new(events).unwrap()
    }

    /// A run of Algorithm 1.
    pub(crate) fn explored(graph: &EmbeddedGraph, facing: Dart) -> Trace {
        let mut doors = Vec::new();
        let mut listen = |_: &mut GraphWorld, _: &Journey, event: MappingEvent| {
            if let MappingEvent::Moved { door, .. } = event {
                doors.push(door);
            }
        };
        let mut exploration = Exploration::new(graph.dart_count());
        let mut world = GraphWorld::new(graph, facing);
        map_world(&mut world, &mut Nearest, &mut exploration, &mut listen).unwrap();
        walked(graph, facing, &doors)
    }

    /// A triangle with a tail; dart 0 is the end of the tail.
    pub(crate) fn lollipop() -> EmbeddedGraph {
        EmbeddedGraph::from_neighbour_lists(&[
            ("end", vec!["a"]),
            ("a", vec!["end", "b", "c"]),
            ("b", vec!["a", "c"]),
            ("c", vec!["b", "a"]),
        ])
        .unwrap()
    }

    #[test]
    fn percepts_and_doors_take_turns() {
        let percept = TraceEvent::Perceived(Percept { degree: 1, sighting: Sighting::Nothing });
        let door = TraceEvent::Left(Door::BACK);
        let trace = |events: &[TraceEvent]| Trace::new(events.iter().copied());
        assert_eq!(trace(&[]), Err(TraceOrderError::Empty));
        assert_eq!(trace(&[door]), Err(TraceOrderError::NoPercept { event: 0 }));
        assert_eq!(trace(&[percept, percept]), Err(TraceOrderError::NoDoor { event: 1 }));
        assert_eq!(trace(&[percept, door, door]), Err(TraceOrderError::NoPercept { event: 2 }));
        let whole = [percept, door, percept, door];
        for length in 1..=whole.len() {
            let trace = trace(&whole[..length]).unwrap();
            assert_eq!(trace.len(), length);
            assert_eq!(trace.events().collect::<Vec<_>>(), whole[..length]);
            for event in 0..length {
                assert_eq!(trace.up_to(event).len(), event + 1);
            }
        }
    }
}
