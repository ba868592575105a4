//! Recorded runs, checked against a known world, against all worlds, and against an algorithm.
//! Sections 2.1 and 2.3.

mod algorithm_match;
mod choice_search;
mod coverage;
mod known_world;
mod match_end;
mod recovery_match;
mod shorten;
mod trace_world;

use thiserror::Error;

pub use crate::mapping::{MapDart, StepPurpose};
pub use algorithm_match::{
    AlgorithmMatch, Amendment, MatchedChoices, match_algorithm, match_amended, match_audited,
};
pub use choice_search::TraceClaim;
pub use coverage::{AlgorithmCase, AlgorithmCoverage, reachable};
pub use known_world::{Misfit, MisfitReason, Poses, anywhere, poses, poses_amended};
pub use match_end::{AllowedStep, Departure, MatchEnd};
pub use recovery_match::{RecordedVisit, match_recovering};
pub use shorten::shortened;
pub use trace_world::{TracePosition, TraceWorld, TraceWorldError};

use crate::{
    aid::AidAction,
    percept::{Door, Percept, WalkEvent},
};

/// What a robot perceived and the doors that it took, in turn, beginning with the percept at the start, and what it did with
/// its marking aid in between. A robot that got lost and [recovers](crate::mapping::Relocate) may have come to a vertex by
/// any way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trace {
    percepts: Vec<Percept>,
    doors: Vec<Door>,
    /// Of each percept and door.
    ids: Vec<usize>,
    /// In order.
    actions: Vec<TraceAction>,
    /// The percepts at vertices to which the robot came after it got lost, in order.
    relocations: Vec<usize>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TraceEvent {
    /// The number of the recorded event that it came from, counted from 0.
    pub id: usize,
    pub kind: TraceEventKind,
}

/// What a robot perceived or did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TraceEventKind {
    Percept(Percept),
    /// Something with the marking aid.
    Action(AidAction),
    Door(Door),
}

/// What a robot did with its marking aid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TraceAction {
    /// After how many moves.
    pub moves: usize,
    pub action: AidAction,
    /// What it then perceived where it stands, if that is recorded, and the id of the event.
    then: Option<(Percept, usize)>,
    /// As of [`TraceEvent::id`].
    id: usize,
}

impl TraceAction {
    pub fn event(self) -> TraceEvent {
        TraceEvent { id: self.id, kind: TraceEventKind::Action(self.action) }
    }

    /// What the robot then perceived where it stands, if that is recorded.
    pub fn percept(self) -> Option<Percept> {
        self.then.map(|(percept, _)| percept)
    }

    /// The event of what the robot then perceived.
    pub fn percept_event(self) -> Option<TraceEvent> {
        self.then.map(|(percept, id)| TraceEvent { id, kind: TraceEventKind::Percept(percept) })
    }

    /// The action, and what was perceived after it.
    fn events(self) -> impl Iterator<Item = TraceEvent> {
        [self.event()].into_iter().chain(self.percept_event())
    }
}

/// Events that do not alternate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum TraceOrderError {
    #[error("there is no event")]
    Empty,
    #[error("a percept follows a percept: no door was taken in between")]
    NoDoor { event: usize },
    #[error("a door follows a door: nothing was perceived in between")]
    NoPercept { event: usize },
    #[error(
        "the robot did something with its marking aid before anything was perceived where it was"
    )]
    ActionOnTheWay { event: usize },
}

impl Trace {
    /// A trace of events that are numbered from 0.
    ///
    /// # Errors
    /// Returns the first event that is out of turn.
    pub fn new(kinds: impl IntoIterator<Item = TraceEventKind>) -> Result<Self, TraceOrderError> {
        let kinds = kinds.into_iter().enumerate();
        Self::from_events(kinds.map(|(id, kind)| TraceEvent { id, kind }))
    }

    /// A trace of events whose ids increase.
    ///
    /// # Errors
    /// Returns the first event that is out of turn.
    pub fn from_events(
        events: impl IntoIterator<Item = TraceEvent>,
    ) -> Result<Self, TraceOrderError> {
        let mut trace = Self {
            percepts: Vec::new(),
            doors: Vec::new(),
            ids: Vec::new(),
            actions: Vec::new(),
            relocations: Vec::new(),
        };
        for TraceEvent { id, kind } in events {
            let standing = trace.percepts.len() > trace.doors.len();
            let moves = trace.doors.len();
            let acted = trace.actions.last_mut().filter(|it| standing && it.moves == moves);
            match kind {
                TraceEventKind::Percept(percept)
                    if let Some(acted) = acted
                        && acted.then.is_none() =>
                {
                    acted.then = Some((percept, id));
                    continue;
                }
                TraceEventKind::Percept(_) if standing => {
                    return Err(TraceOrderError::NoDoor { event: id });
                }
                TraceEventKind::Door(_) if !standing => {
                    return Err(TraceOrderError::NoPercept { event: id });
                }
                TraceEventKind::Action(_) if !standing => {
                    return Err(TraceOrderError::ActionOnTheWay { event: id });
                }
                TraceEventKind::Action(action) => {
                    trace.actions.push(TraceAction { moves, action, then: None, id });
                    continue;
                }
                TraceEventKind::Percept(percept) => trace.percepts.push(percept),
                TraceEventKind::Door(door) => trace.doors.push(door),
            }
            trace.ids.push(id);
        }
        if trace.ids.is_empty() { Err(TraceOrderError::Empty) } else { Ok(trace) }
    }

    /// The same trace of a robot that got lost before it came to these vertices. They are given by the ids of the
    /// events of their percepts; other ids are ignored.
    #[must_use]
    pub fn with_relocations(self, ids: impl IntoIterator<Item = usize>) -> Self {
        let number = |id| match WalkEvent::at(self.ids.binary_search(&id).ok()?) {
            WalkEvent::Percept(number) => Some(number),
            WalkEvent::Door(_) => None,
        };
        let mut relocations: Vec<_> = ids.into_iter().filter_map(number).collect();
        relocations.sort_unstable();
        relocations.dedup();
        Self { relocations, ..self }
    }

    /// The percepts, by their numbers from 0, at vertices to which the robot came after it got lost. The first
    /// one is among them if the run began at an unknown place.
    pub fn relocations(&self) -> &[usize] {
        &self.relocations
    }

    /// Whether a percept, by its number from 0, is at a vertex to which the robot came after it got lost.
    pub fn is_relocation(&self, percept: usize) -> bool {
        self.relocations.binary_search(&percept).is_ok()
    }

    /// Those of [`Self::relocations`] at which the robot got lost in this run: without the first percept.
    pub fn lost(&self) -> &[usize] {
        self.relocations.strip_prefix(&[0]).unwrap_or(&self.relocations)
    }

    /// The trace before the robot got lost for the first time, with the door that it took then.
    #[must_use]
    pub fn before_relocation(&self) -> Self {
        match self.lost().first() {
            Some(percept) => self.up_to(WalkEvent::Door(percept - 1).index()),
            None => self.clone(),
        }
    }

    /// The number of percepts and doors; never 0.
    #[expect(clippy::len_without_is_empty, reason = "it is never empty")]
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// The percepts on arrival and the doors, with what they are of the walk, and the actions with what was perceived after
    /// each.
    pub fn events(&self) -> impl Iterator<Item = (Option<WalkEvent>, TraceEvent)> + '_ {
        (0..self.len()).flat_map(|index| {
            let at = WalkEvent::at(index);
            let actions = match at {
                WalkEvent::Percept(moves) => self.actions_after(moves),
                WalkEvent::Door(_) => &[],
            };
            let actions = actions.iter().flat_map(|action| action.events());
            let actions = actions.map(|event| (None, event));
            std::iter::once((Some(at), self.event(index))).chain(actions)
        })
    }

    /// What the robot did with its marking aid, in order.
    pub fn actions(&self) -> &[TraceAction] {
        &self.actions
    }

    /// What the robot did with its marking aid after some moves, before the next one.
    pub fn actions_after(&self, moves: usize) -> &[TraceAction] {
        let before = |moves| self.actions.partition_point(|action| action.moves < moves);
        &self.actions[before(moves)..before(moves + 1)]
    }

    /// The percepts on arrival: at the start, and after each move.
    pub fn percepts(&self) -> &[Percept] {
        &self.percepts
    }

    pub fn doors(&self) -> &[Door] {
        &self.doors
    }

    /// The trace up to and including a percept or door.
    #[must_use]
    pub fn up_to(&self, index: usize) -> Self {
        let (percepts, doors) = match WalkEvent::at(index) {
            WalkEvent::Percept(moves) => (moves + 1, moves),
            WalkEvent::Door(moves) => (moves + 1, moves + 1),
        };
        let (percepts, doors) = (self.percepts.len().min(percepts), self.doors.len().min(doors));
        // Those after the last percept are before its door.
        let actions = self.actions.iter().filter(|action| action.moves < doors);
        Self {
            percepts: self.percepts[..percepts].to_vec(),
            doors: self.doors[..doors].to_vec(),
            ids: self.ids[..percepts + doors].to_vec(),
            actions: actions.copied().collect(),
            relocations: self.relocations_below(percepts).to_vec(),
        }
    }

    /// The relocations before a percept.
    fn relocations_below(&self, percept: usize) -> &[usize] {
        &self.relocations[..self.relocations.partition_point(|&one| one < percept)]
    }

    /// A percept or door by its index; the last one if there are fewer.
    pub fn event(&self, index: usize) -> TraceEvent {
        let index = index.min(self.len() - 1);
        let kind = match WalkEvent::at(index) {
            WalkEvent::Percept(moves) => TraceEventKind::Percept(self.percepts[moves]),
            WalkEvent::Door(moves) => TraceEventKind::Door(self.doors[moves]),
        };
        TraceEvent { id: self.ids[index], kind }
    }

    /// The percept after some moves; the last event if there are fewer.
    pub fn percept_event(&self, moves: usize) -> TraceEvent {
        self.event(WalkEvent::Percept(moves).index())
    }

    /// The door that was taken after some moves; the last event if there are fewer.
    pub fn door_event(&self, moves: usize) -> TraceEvent {
        self.event(WalkEvent::Door(moves).index())
    }

    /// The index of the first percept or door with this id or a larger one.
    pub fn index_of(&self, id: usize) -> usize {
        self.ids.partition_point(|&one| one < id)
    }

    /// The trace without the moves `from..to`. The later percept takes the place of the earlier one.
    fn without(&self, from: usize, to: usize) -> Self {
        let percepts = [&self.percepts[..from], &self.percepts[to..]].concat();
        let doors = [&self.doors[..from], &self.doors[to..]].concat();
        let [before, after] = [from, to].map(|moves| WalkEvent::Percept(moves).index());
        let ids = [&self.ids[..before], &self.ids[after..]].concat();
        let (before, left_out) = (self.relocations_below(from), self.relocations_below(to).len());
        let after = self.relocations[left_out..].iter().map(|percept| percept - (to - from));
        let relocations = before.iter().copied().chain(after).collect();
        let is_left = |action: &&TraceAction| !(from..to).contains(&action.moves);
        let moved = |action: &TraceAction| {
            let left_out = if action.moves < to { 0 } else { to - from };
            TraceAction { moves: action.moves - left_out, ..*action }
        };
        let actions = self.actions.iter().filter(is_left).map(moved).collect();
        Self { percepts, doors, ids, actions, relocations }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::{
        aid::Aid,
        aid::RefusedAction,
        any_graph::{by_neighbours, walk},
        embedded_graph::{Dart, EmbeddedGraph},
        mapping::{
            MapWalk, MappingAlgorithm, MappingError, MappingEvent, Observed, Observer, explore,
            with_explorer,
        },
        percept::Sighting,
        world::GraphWorld,
    };

    impl Trace {
        /// The same walk of a robot that sees no marker.
        pub(crate) fn without_marker(mut self) -> Self {
            self.percepts.iter_mut().for_each(|percept| percept.sighting = Sighting::Nothing);
            self
        }
    }

    /// What a robot perceives on a walk.
    pub(crate) fn recorded<A: Aid>(
        world: GraphWorld<'_, A>,
        turns: impl IntoIterator<Item = u32>,
    ) -> Trace {
        let (percepts, doors) = walk(world, turns);
        let ids = (0..percepts.len() + doors.len()).collect();
        Trace { percepts, doors, ids, actions: Vec::new(), relocations: Vec::new() }
    }

    /// What a robot perceives on a walk from a start.
    pub(crate) fn walked(graph: &EmbeddedGraph, facing: Dart, doors: &[Door]) -> Trace {
        recorded(GraphWorld::new(graph, facing), doors.iter().map(|door| door.0))
    }

    pub(crate) fn explored(graph: &EmbeddedGraph, facing: Dart) -> Trace {
        explored_by(MappingAlgorithm::Algorithm1, graph, facing)
    }

    pub(crate) fn explored_by(
        algorithm: MappingAlgorithm,
        graph: &EmbeddedGraph,
        facing: Dart,
    ) -> Trace {
        with_explorer!(algorithm, new => doors_of(graph, facing, |world| explore(&mut new(), world)))
    }

    pub(crate) fn doors_of(
        graph: &EmbeddedGraph,
        facing: Dart,
        run: impl FnOnce(&mut Recorded<'_, '_>) -> Result<(), MappingError<RefusedAction>>,
    ) -> Trace {
        let mut listen = Doors::default();
        let mut world = GraphWorld::new(graph, facing);
        run(&mut Observed::new(&mut world, &mut listen)).unwrap();
        walked(graph, facing, &listen.0)
    }

    pub(crate) type Recorded<'a, 'g> = Observed<'a, GraphWorld<'g>, Doors>;

    #[derive(Default)]
    pub(crate) struct Doors(Vec<Door>);

    impl<W> Observer<W> for Doors {
        fn event(&mut self, _: &mut W, _: &MapWalk, event: MappingEvent) {
            if let MappingEvent::Moved { door, .. } = event {
                self.0.push(door);
            }
        }
    }

    /// A triangle with a tail; dart 0 is the end of the tail.
    pub(crate) fn lollipop() -> EmbeddedGraph {
        by_neighbours("end: a | a: end b c | b: a c | c: b a")
    }

    #[test]
    fn percepts_and_doors_take_turns() {
        let percept = TraceEventKind::Percept(Percept { degree: 1, sighting: Sighting::Nothing });
        let door = TraceEventKind::Door(Door::BACK);
        let trace = |events: &[TraceEventKind]| Trace::new(events.iter().copied());
        assert_eq!(trace(&[]), Err(TraceOrderError::Empty));
        assert_eq!(trace(&[door]), Err(TraceOrderError::NoPercept { event: 0 }));
        assert_eq!(trace(&[percept, percept]), Err(TraceOrderError::NoDoor { event: 1 }));
        assert_eq!(trace(&[percept, door, door]), Err(TraceOrderError::NoPercept { event: 2 }));
        let whole = [percept, door, percept, door];
        for length in 1..=whole.len() {
            let trace = trace(&whole[..length]).unwrap();
            assert_eq!(trace.len(), length);
            assert_eq!(
                trace.events().map(|(_, event)| event.kind).collect::<Vec<_>>(),
                whole[..length]
            );
            for event in 0..length {
                assert_eq!(trace.up_to(event).len(), event + 1);
                assert_eq!((trace.event(event).id, trace.index_of(event)), (event, event));
            }
        }
    }

    #[test]
    fn actions_stay_with_their_percepts() {
        let percept = TraceEventKind::Percept(Percept { degree: 2, sighting: Sighting::Nothing });
        let door = TraceEventKind::Door(Door::BACK);
        let [drop, pick_up] = [AidAction::Drop, AidAction::PickUp].map(TraceEventKind::Action);
        let on_the_way = Trace::new([percept, door, drop]);
        assert_eq!(on_the_way, Err(TraceOrderError::ActionOnTheWay { event: 2 }));
        let whole = [percept, pick_up, drop, door, percept, pick_up, door, percept, drop];
        let trace = Trace::new(whole).unwrap();
        assert_eq!(trace.events().map(|(_, event)| event.kind).collect::<Vec<_>>(), whole);
        let walk: Vec<_> = trace.events().filter_map(|(at, _)| at).map(WalkEvent::index).collect();
        assert_eq!(walk, [0, 1, 2, 3, 4]);
        assert_eq!(
            trace.events().map(|(_, event)| event.id).collect::<Vec<_>>(),
            [0, 1, 2, 3, 4, 5, 6, 7, 8]
        );
        // A percept after an action is not one on arrival; two in a row are none.
        let seen = [percept, drop, percept, door, percept];
        let seen_after = Trace::new(seen).unwrap();
        assert_eq!(seen_after.events().map(|(_, event)| event.kind).collect::<Vec<_>>(), seen);
        assert_eq!((seen_after.percepts().len(), seen_after.len()), (2, 3));
        let twice = Trace::new([percept, drop, percept, percept]);
        assert_eq!(twice, Err(TraceOrderError::NoDoor { event: 3 }));
        let kinds = |trace: &Trace| trace.actions().iter().map(|one| one.moves).collect::<Vec<_>>();
        // What was done after a percept is before its door.
        assert_eq!([2, 3, 4].map(|index| kinds(&trace.up_to(index)).len()), [2, 3, 3]);
        for (from, to, left) in [(0, 1, &[0, 1][..]), (1, 2, &[0, 0, 1]), (0, 2, &[0])] {
            assert_eq!(kinds(&trace.without(from, to)), left, "{from}..{to}");
        }
    }

    #[test]
    fn relocations_stay_with_their_percepts() {
        let kinds = [0, 1, 2, 3]
            .map(|degree| TraceEventKind::Percept(Percept { degree, sighting: Sighting::Nothing }));
        let doors = [TraceEventKind::Door(Door::BACK); 4];
        let events = kinds.into_iter().zip(doors).flat_map(|(percept, door)| [percept, door]);
        let events = events.enumerate().map(|(at, kind)| TraceEvent { id: 10 * at, kind });
        // The ids of a door and of no event are ignored.
        let trace = Trace::from_events(events).unwrap().with_relocations([60, 40, 40, 30, 7]);
        assert_eq!(trace.relocations(), [2, 3]);
        assert_eq!(trace.before_relocation().events().last().map(|(_, event)| event.id), Some(30));
        assert_eq!(trace.up_to(5).relocations(), [2]);
        assert_eq!(trace.up_to(3).relocations(), [0; 0]);
        assert_eq!(trace.up_to(3).before_relocation(), trace.up_to(3));
        // The percept of degree 2 takes the place of an earlier one, with its relocation.
        for (from, to, left) in [(0, 1, &[1, 2][..]), (1, 2, &[1, 2]), (2, 3, &[2]), (1, 3, &[1])] {
            let shorter = trace.without(from, to);
            assert_eq!(shorter.relocations(), left, "{from}..{to}");
            for &percept in left {
                assert!(shorter.percepts()[percept].degree >= 2);
            }
        }
    }
}
