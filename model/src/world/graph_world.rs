//! An embedded graph with a robot and its marking aid in it, as a world. Section 2.1.

use super::{AidHandler, World};
use crate::{
    aid::{Action, Aid, AidAction, RefusedAction, State},
    embedded_graph::{Dart, EmbeddedGraph},
    marker::{Directional, MarkerKind},
    percept::{Door, Percept},
};

/// An embedded graph with a robot and its marking aid in it, as a [`World`].
#[derive(Clone, Debug)]
pub struct GraphWorld<'g, A: Aid = MarkerKind> {
    graph: &'g EmbeddedGraph,
    aid: A,
    state: State<A::Placed>,
    moves: u64,
    bound: u64,
}

impl<'g> GraphWorld<'g> {
    /// The world of a start: the directional marker lies at the start vertex and points along the
    /// facing dart, which is one of the graph's, and the robot's entry dart.
    pub fn new(graph: &'g EmbeddedGraph, facing: Dart) -> Self {
        Self::with_aid(graph, Directional, facing)
    }
}

impl<'g, A: Aid> GraphWorld<'g, A> {
    /// The world of a start with any aid, placed by the facing dart, which is one of the graph's,
    /// and the robot's entry dart.
    pub fn with_aid(graph: &'g EmbeddedGraph, aid: A, facing: Dart) -> Self {
        let state = State { pose: facing, placed: aid.placed(graph, facing) };
        Self { graph, aid, state, moves: 0, bound: u64::MAX }
    }

    /// The world with a robot and its aid in this state, which is one of the graph's.
    pub fn in_state(graph: &'g EmbeddedGraph, aid: A, state: State<A::Placed>) -> Self {
        Self { graph, aid, state, moves: 0, bound: u64::MAX }
    }

    /// The same world in another state.
    #[must_use]
    pub fn at(self, state: State<A::Placed>) -> Self {
        Self { state, ..self }
    }

    /// The same world, in which at most `bound` moves are possible.
    #[must_use]
    pub fn with_bound(self, bound: u64) -> Self {
        Self { bound, ..self }
    }

    /// The robot's percept: a graph can always be sensed.
    #[inline]
    pub fn sensed(&self) -> Percept {
        let degree = self.graph.degree_around(self.state.pose);
        Percept { degree, sighting: self.aid.sighting(self.graph, &self.state) }
    }

    /// The possible actions: the doors, and those of the aid.
    pub fn actions(&self) -> Vec<Action> {
        let Self { graph, aid, state, .. } = self;
        let can_leave = |door: &Door| {
            let by = graph.behind(state.pose, *door);
            !aid.moves() || aid.leave(graph, &mut state.clone(), by).is_ok()
        };
        let doors = (0..graph.degree_around(state.pose)).map(Door).filter(can_leave);
        let others = aid.actions(graph, state).into_iter().map(Action::Do);
        doors.map(Action::Take).chain(others).collect()
    }

    /// Does one of the [`actions`](Self::actions).
    ///
    /// # Errors
    /// Returns an error if it is not one of them.
    pub fn act(&mut self, action: Action) -> Result<(), RefusedAction> {
        match action {
            Action::Take(door) => self.traverse(door),
            Action::Do(action) => self.handle(action),
        }
    }

    /// What the robot carries, as a number: see [`Aid::held`].
    pub fn held(&self) -> u32 {
        self.aid.held(&self.state)
    }

    pub fn graph(&self) -> &'g EmbeddedGraph {
        self.graph
    }

    pub fn aid(&self) -> &A {
        &self.aid
    }

    pub fn pose(&self) -> Dart {
        self.state.pose
    }

    pub fn moves(&self) -> u64 {
        self.moves
    }

    pub fn state(&self) -> State<A::Placed> {
        self.state.clone()
    }
}

impl<A: Aid> World for GraphWorld<'_, A> {
    type Error = RefusedAction;

    #[inline]
    fn percept(&mut self) -> Result<Percept, RefusedAction> {
        Ok(self.sensed())
    }

    #[inline]
    fn traverse(&mut self, door: Door) -> Result<(), RefusedAction> {
        let degree = self.graph.degree_around(self.state.pose);
        if door.0 >= degree {
            return Err(RefusedAction::NoSuchDoor { door, degree });
        }
        if self.moves >= self.bound {
            return Err(RefusedAction::OutOfMoves { bound: self.bound });
        }
        let by = self.graph.behind(self.state.pose, door);
        self.aid.leave(self.graph, &mut self.state, by)?;
        self.state.pose = self.graph.opposite(by);
        self.moves += 1;
        Ok(())
    }

    fn handler(&mut self) -> Option<&mut dyn AidHandler<Error = RefusedAction>> {
        Some(self)
    }
}

impl<A: Aid> AidHandler for GraphWorld<'_, A> {
    type Error = RefusedAction;

    fn handle(&mut self, action: AidAction) -> Result<(), RefusedAction> {
        let moves = Action::Do(action).moves();
        if self.moves.saturating_add(moves) > self.bound {
            return Err(RefusedAction::OutOfMoves { bound: self.bound });
        }
        self.aid.act(self.graph, &mut self.state, action)?;
        self.moves += moves;
        Ok(())
    }
}
