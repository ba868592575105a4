//! Walks: percepts and doors in turn.

use super::{NotProved, text};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    mapping::{MapWalk, MappingEvent, MovableEvent, Observer, SafeguardEvent},
    marker::MarkerKind,
    percept::{Door, Percept},
    world::GraphWorld,
};

/// What a robot perceived, and the doors that it took: one percept more than doors.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PerceivedWalk {
    percepts: Vec<Percept>,
    doors: Vec<Door>,
}

impl PerceivedWalk {
    /// Percepts and doors in turn, up to the last percept. A door after it is left out.
    ///
    /// # Errors
    /// Returns an error if there is no percept, or a sighting that is not of a fixed marker.
    pub fn new(percepts: &[Percept], doors: &[Door]) -> Result<Self, NotProved> {
        let visits = percepts.len().min(doors.len() + 1);
        let percepts = &percepts[..visits];
        if let Some(other) = percepts.iter().find(|percept| text::word(percept.sighting).is_none())
        {
            return Err(NotProved::Sighting(other.sighting));
        }
        let moves = visits.checked_sub(1).ok_or(NotProved::NoPercept)?;
        Ok(Self { percepts: percepts.to_vec(), doors: doors[..moves].to_vec() })
    }

    /// The walk in a world by these doors, up to the first that does not exist. The marker lies at the facing dart, and the
    /// robot begins with the pose `from`.
    pub fn in_world(
        (graph, facing): (&EmbeddedGraph, Dart),
        marker: MarkerKind,
        from: Dart,
        doors: &[Door],
    ) -> Self {
        let start = GraphWorld::with_aid(graph, marker, facing);
        let mut state = start.state();
        state.pose = from;
        let mut walk = Self { percepts: vec![start.clone().at(state).sensed()], doors: Vec::new() };
        for &door in doors {
            if door.0 >= graph.degree_around(state.pose) {
                break;
            }
            state.pose = graph.opposite(graph.behind(state.pose, door));
            walk.doors.push(door);
            walk.percepts.push(start.clone().at(state).sensed());
        }
        walk
    }

    /// The first visit with another percept than in a world, or to which no door leads there; `None` if the walk is one in
    /// this world.
    pub fn first_difference(
        &self,
        start: (&EmbeddedGraph, Dart),
        marker: MarkerKind,
        from: Dart,
    ) -> Option<usize> {
        let there = Self::in_world(start, marker, from, &self.doors);
        let differs = |(one, other)| one != other;
        let first = self.percepts.iter().zip(&there.percepts).position(differs);
        first.or_else(|| {
            (there.percepts.len() < self.percepts.len()).then_some(there.percepts.len())
        })
    }

    pub fn percepts(&self) -> &[Percept] {
        &self.percepts
    }

    pub fn doors(&self) -> &[Door] {
        &self.doors
    }

    /// The walk up to a visit, counted from 0.
    #[must_use]
    pub fn up_to(mut self, visit: usize) -> Self {
        self.percepts.truncate(visit + 1);
        self.doors.truncate(visit);
        self
    }
}

/// Records the walk of a run.
#[derive(Clone, Debug, Default)]
pub struct WalkRecorder {
    percepts: Vec<Percept>,
    doors: Vec<Door>,
    /// Why the run is not one walk, if it is not.
    broken: Option<NotProved>,
}

impl WalkRecorder {
    /// An event of the run.
    pub fn event(&mut self, event: MappingEvent) {
        match event {
            MappingEvent::Started { percept } => self.percepts.push(percept),
            MappingEvent::Moved { door, percept } => {
                self.doors.push(door);
                self.percepts.push(percept);
            }
            MappingEvent::Movable(MovableEvent::Did(action)) => {
                self.broken.get_or_insert(NotProved::Action(action));
            }
            MappingEvent::Safeguard(
                SafeguardEvent::Contradicted(_)
                | SafeguardEvent::TooLarge { .. }
                | SafeguardEvent::Relocated
                | SafeguardEvent::MarkerFound { .. },
            ) => {
                self.broken.get_or_insert(NotProved::Lost);
            }
            _ => {}
        }
    }

    /// The walk so far.
    ///
    /// # Errors
    /// Returns an error if the run is not one walk with a fixed marker.
    pub fn walk(&self) -> Result<PerceivedWalk, NotProved> {
        match &self.broken {
            None => PerceivedWalk::new(&self.percepts, &self.doors),
            Some(why) => Err(why.clone()),
        }
    }
}

impl<W: ?Sized> Observer<W> for WalkRecorder {
    fn event(&mut self, _: &mut W, _: &MapWalk, event: MappingEvent) {
        self.event(event);
    }
}
