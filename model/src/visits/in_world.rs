//! Follows all choices of visits in a known world at once. The sets of states are themselves the proof that no choice
//! fits: each is what the world makes of the one before it.

use super::{VisitSet, VisitWay};
use crate::{
    embedded_graph::EmbeddedGraph,
    marker::Marker,
    world::{GraphWorld, State},
};

/// The states in which a robot may be after each visit, sorted, up to the first visit that fits none; its set is empty.
/// The pose of a state is the dart by which the robot comes to the next vertex. After a last visit without a door
/// that is the dart by which it came.
///
/// The marker stays where it lies.
pub fn states_after(
    graph: &EmbeddedGraph,
    marker: &impl Marker,
    starts: &[State],
    visits: &[VisitSet],
) -> Vec<Vec<State>> {
    let mut after: Vec<Vec<State>> = Vec::with_capacity(visits.len());
    for (index, visit) in visits.iter().enumerate() {
        let is_last = index + 1 == visits.len();
        let before = after.last().map_or(starts, Vec::as_slice);
        let mut states = Vec::new();
        for &state in before {
            add_states(graph, marker, state, (visit, is_last), &mut states);
        }
        states.sort_unstable();
        states.dedup();
        let is_misfit = states.is_empty();
        after.push(states);
        if is_misfit {
            break;
        }
    }
    after
}

fn add_states(
    graph: &EmbeddedGraph,
    marker: &impl Marker,
    state: State,
    (visit, is_last): (&VisitSet, bool),
    states: &mut Vec<State>,
) {
    let at = |pose| State { pose, ..state };
    let sensed = GraphWorld::with_marker(graph, marker, state.placed.unwrap_or(state.pose));
    let sensed = sensed.at(state).sensed();
    for alternative in visit.alternatives() {
        match alternative {
            None if visit.way() == VisitWay::Through => states.push(state),
            None => states.push(at(graph.opposite(state.pose))),
            Some(alternative) if alternative.percept != sensed => {}
            Some(alternative) if is_last && alternative.door.is_none() => states.push(state),
            Some(alternative) => {
                let far = |door| graph.opposite(graph.behind(state.pose, door));
                states.extend(alternative.doors().map(|door| at(far(door))));
            }
        }
    }
}
