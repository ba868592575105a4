//! Matches a trace with a known world: the poses that fit the percepts so far. Section 2.1.

use super::{Trace, TraceEvent, TraceEventKind};
use crate::{
    aid::{Action, Aid, RefusedAction, State},
    embedded_graph::{Dart, EmbeddedGraph},
    percept::{Percept, WalkEvent},
    world::GraphWorld,
};

/// The possible states of a robot in a known world, event by event. `P` is the state of its marking aid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Poses<P = Dart> {
    /// The number of states after each percept and each door that fits.
    pub left: Vec<usize>,
    /// The pose after each of them, if there is only one state.
    pub alone: Vec<Option<Dart>>,
    /// The states after the last event that fits.
    pub states: Vec<State<P>>,
    pub misfit: Option<Misfit<P>>,
}

/// An event that fits no possible state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Misfit<P = Dart> {
    pub event: TraceEvent,
    /// The number of moves before it.
    pub moves: usize,
    /// The possible states before it (for a percept, after the move), and why the event does not fit each.
    pub candidates: Vec<(State<P>, MisfitReason)>,
}

/// Why an event does not fit a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MisfitReason {
    Percept { expected: Percept },
    NoSuchDoor { degree: u32 },
    Refused(RefusedAction),
}

/// The states of a robot that has just put its aid down along its entry dart, at every dart.
pub fn anywhere<A: Aid>(graph: &EmbeddedGraph, aid: &A) -> Vec<State<A::Placed>> {
    let start = |pose| State { pose, placed: aid.placed(graph, pose) };
    graph.darts().map(start).collect()
}

/// Follows a trace in a known world from all possible start states.
pub fn poses<A: Aid + Copy>(
    graph: &EmbeddedGraph,
    aid: &A,
    starts: &[State<A::Placed>],
    trace: &Trace,
) -> Poses<A::Placed> {
    poses_amended(graph, aid, starts, trace, |_| None)
}

/// Follows a trace in a known world. At a percept that fits no state, `amend` may return the percept that
/// takes its place; it must be one that a candidate expects.
pub fn poses_amended<A: Aid + Copy>(
    graph: &EmbeddedGraph,
    aid: &A,
    starts: &[State<A::Placed>],
    trace: &Trace,
    mut amend: impl FnMut(&Misfit<A::Placed>) -> Option<Percept>,
) -> Poses<A::Placed> {
    let mut states = starts.to_vec();
    let mut left = Vec::with_capacity(trace.len());
    let mut alone = Vec::with_capacity(trace.len());
    let mut moves = 0;
    for (at, event) in trace.events() {
        moves = at.map_or(moves, WalkEvent::moves);
        if matches!(at, Some(WalkEvent::Percept(number)) if trace.is_relocation(number)) {
            states = relocated(graph, &states);
        }
        let (mut fit, mut candidates) = (Vec::new(), Vec::new());
        for state in &states {
            match after(graph, aid, state, event.kind) {
                Ok(after) => fit.push(after),
                Err(why) => candidates.push((state.clone(), why)),
            }
        }
        if fit.is_empty() {
            let misfit = Misfit { event, moves, candidates };
            if let Some(expected) = amend(&misfit) {
                let expects = |(_, why): &&(State<A::Placed>, MisfitReason)| {
                    *why == MisfitReason::Percept { expected }
                };
                let expecting = misfit.candidates.iter().filter(expects);
                fit = expecting.map(|(state, _)| state.clone()).collect();
            }
            if fit.is_empty() {
                return Poses { left, alone, states, misfit: Some(misfit) };
            }
        }
        if at.is_some() {
            left.push(fit.len());
            alone.push(if let [state] = &fit[..] { Some(state.pose) } else { None });
        }
        states = fit;
    }
    Poses { left, alone, states, misfit: None }
}

/// The states of a robot that got lost: it may be anywhere, with its aid as it was.
fn relocated<P: Clone + Ord>(graph: &EmbeddedGraph, states: &[State<P>]) -> Vec<State<P>> {
    let mut placed: Vec<_> = states.iter().map(|state| state.placed.clone()).collect();
    placed.sort_unstable();
    placed.dedup();
    let everywhere =
        |placed: P| graph.darts().map(move |pose| State { pose, placed: placed.clone() });
    placed.into_iter().flat_map(everywhere).collect()
}

/// The state after an event, if the event fits.
fn after<A: Aid + Copy>(
    graph: &EmbeddedGraph,
    aid: &A,
    state: &State<A::Placed>,
    event: TraceEventKind,
) -> Result<State<A::Placed>, MisfitReason> {
    let mut world = GraphWorld::in_state(graph, *aid, state.clone());
    let action = match event {
        TraceEventKind::Percept(percept) => {
            let expected = world.sensed();
            let fits = percept == expected;
            return if fits { Ok(world.state()) } else { Err(MisfitReason::Percept { expected }) };
        }
        TraceEventKind::Action(action) => Action::Do(action),
        TraceEventKind::Door(door) => Action::Take(door),
    };
    match world.act(action) {
        Ok(()) => Ok(world.state()),
        Err(RefusedAction::NoSuchDoor { degree, .. }) => Err(MisfitReason::NoSuchDoor { degree }),
        Err(refused) => Err(MisfitReason::Refused(refused)),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        any_graph::{Class, any_graph},
        embedded_graph::Dart,
        marker::{Directional, NoMarker},
        percept::{Door, Sighting},
        trace::tests::{explored, lollipop, walked},
    };

    #[test]
    fn the_poses_that_fit_grow_fewer() {
        let graph = lollipop();
        // Without a marker, from the end of the tail: 8 poses, one with degree 1. A robot that comes to a vertex with
        // two doors may stand in 4 ways.
        let trace = walked(&graph, Dart(0), &[Door(0), Door(1), Door(1)]).without_marker();
        for (trace, left) in [(trace.without(0, 2), 4), (trace, 1)] {
            let found = poses(&graph, &NoMarker, &anywhere(&graph, &NoMarker), &trace);
            assert_eq!((found.left[0], found.misfit), (left, None));
        }
    }

    #[test]
    fn a_wrong_percept_and_a_missing_door_are_reported() {
        let graph = lollipop();
        let start = [GraphWorld::new(&graph, Dart(0)).state()];
        let trace = walked(&graph, Dart(0), &[Door(0), Door(1)]);
        let expected = Percept { degree: 3, sighting: Sighting::Nothing };
        let (mut percept, mut door) = (trace.clone(), trace);
        percept.percepts[1].degree = 2;
        door.doors[1] = Door(3);
        for (trace, event, reason) in [
            (percept, 2, MisfitReason::Percept { expected }),
            (door, 3, MisfitReason::NoSuchDoor { degree: 3 }),
        ] {
            let misfit = poses(&graph, &Directional, &start, &trace).misfit.unwrap();
            assert_eq!((misfit.event.id, misfit.moves), (event, 1));
            assert_eq!(misfit.candidates[0].1, reason);
        }
    }

    #[test]
    fn a_percept_that_is_amended_leaves_the_poses_that_expect_it() {
        let graph = lollipop();
        let starts = anywhere(&graph, &NoMarker);
        let percept = |degree| Percept { degree, sighting: Sighting::Nothing };
        let trace = Trace::new([TraceEventKind::Percept(percept(9))]).unwrap();
        // One end, a fork with three doors, and two corners with two doors each.
        for (degree, count) in [(1, 1), (2, 4), (3, 3), (4, 0)] {
            let mut asked = 0;
            let found = poses_amended(&graph, &NoMarker, &starts, &trace, |misfit| {
                asked += 1;
                assert_eq!((misfit.event.id, misfit.moves, misfit.candidates.len()), (0, 0, 8));
                Some(percept(degree))
            });
            assert_eq!((asked, found.left.first().copied().unwrap_or(0)), (1, count));
            assert_eq!(found.misfit.is_some(), count == 0);
        }
    }

    proptest! {
        #[test]
        fn a_run_fits_its_start_and_no_start_that_is_not_isomorphic(
            graph in any_graph(Class::Multigraph, 12),
        ) {
            let trace = explored(&graph, Dart(0));
            let found = poses(&graph, &Directional, &anywhere(&graph, &Directional), &trace);
            prop_assert_eq!(found.misfit, None);
            // A directional marker distinguishes any two starts that no automorphism relates.
            let code = |dart| crate::isomorphism::code(&graph, dart);
            let alike = graph.darts().filter(|&dart| code(dart) == code(Dart(0))).count();
            prop_assert_eq!(*found.left.last().unwrap(), alike);
        }
    }
}
