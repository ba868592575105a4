//! Walks: percepts and doors in turn.

use std::iter;

use super::{NotProved, text};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    folding::MAX_DARTS,
    mapping::{MapWalk, MappingEvent, MovableEvent, Observer, SafeguardEvent},
    marker::{Marker, MarkerKind},
    percept::{Door, Percept},
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
    /// Returns an error if there is no percept, or a sighting that is not of a fixed marker, or if the vertices have more
    /// than [`MAX_DARTS`] doors together.
    pub fn new(percepts: &[Percept], doors: &[Door]) -> Result<Self, NotProved> {
        let visits = percepts.len().min(doors.len() + 1);
        let percepts = &percepts[..visits];
        if let Some(other) = percepts.iter().find(|percept| text::word(percept.sighting).is_none())
        {
            return Err(NotProved::Sighting(other.sighting));
        }
        let darts: u64 = percepts.iter().map(|percept| u64::from(percept.degree)).sum();
        if darts > MAX_DARTS as u64 {
            return Err(NotProved::TooManyDarts);
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
        let percepts: Vec<_> = percepts((graph, facing), marker, from, doors).collect();
        let doors = doors[..percepts.len() - 1].to_vec();
        Self { percepts, doors }
    }

    /// The first visit with another percept than in a world, or to which no door leads there; `None` if the walk is one in
    /// this world.
    pub fn first_difference(
        &self,
        start: (&EmbeddedGraph, Dart),
        marker: MarkerKind,
        from: Dart,
    ) -> Option<usize> {
        let mut there = percepts(start, marker, from, &self.doors);
        self.percepts.iter().position(|&percept| there.next() != Some(percept))
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

/// The percepts of a walk in a world, up to the first door that does not exist. There is one at least.
fn percepts<'w>(
    (graph, facing): (&'w EmbeddedGraph, Dart),
    marker: MarkerKind,
    from: Dart,
    doors: &'w [Door],
) -> impl Iterator<Item = Percept> + 'w {
    let sensed = move |pose| Percept {
        degree: graph.degree_around(pose),
        sighting: marker.sighting(graph, facing, pose),
    };
    let behind = move |pose: &mut Dart, door: &Door| {
        let exists = door.0 < graph.degree_around(*pose);
        *pose = graph.opposite(graph.behind(*pose, *door));
        exists.then_some(*pose)
    };
    iter::once(from).chain(doors.iter().scan(from, behind)).map(sensed)
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
