//! Follows all choices of visits in a known world at once. The sets of states are themselves the proof that no choice
//! fits: each is what the world makes of the one before it.

use std::collections::BTreeSet;

use super::{VisitAlternative, VisitSet, VisitWay};
use crate::{
    aid::State,
    embedded_graph::{Dart, EmbeddedGraph},
    marker::Marker,
    percept::Door,
    world::GraphWorld,
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
        let before = after.last().map_or(starts, Vec::as_slice);
        let step =
            &VisitStep { graph, marker, way: visit.way(), is_last: index + 1 == visits.len() };
        let all = before.iter().flat_map(|&state| {
            visit.alternatives().iter().flat_map(move |&alternative| step.after(state, alternative))
        });
        let states: BTreeSet<State> = all.collect();
        let is_misfit = states.is_empty();
        after.push(states.into_iter().collect());
        if is_misfit {
            break;
        }
    }
    after
}

/// The alternatives of each visit that are in some choice that fits the world: none if no choice fits. If there is only
/// one, the world decides the visit.
pub fn alternatives_left(
    graph: &EmbeddedGraph,
    marker: &impl Marker,
    starts: &[State],
    visits: &[VisitSet],
) -> Vec<Vec<Option<VisitAlternative>>> {
    let after = states_after(graph, marker, starts, visits);
    let mut left = vec![Vec::new(); visits.len()];
    if after.len() < visits.len() {
        return left;
    }
    // The states from which the later visits fit.
    let mut fitting: BTreeSet<State> = after.last().into_iter().flatten().copied().collect();
    for (index, visit) in visits.iter().enumerate().rev() {
        let before = index.checked_sub(1).map_or(starts, |before| after[before].as_slice());
        let step =
            &VisitStep { graph, marker, way: visit.way(), is_last: index + 1 == visits.len() };
        let fits = |&state: &State, alternative| {
            step.after(state, alternative).iter().any(|state| fitting.contains(state))
        };
        let is_left = |&alternative: &_| before.iter().any(|state| fits(state, alternative));
        left[index] = visit.alternatives().iter().copied().filter(is_left).collect();
        let goes_on = |state: &&State| left[index].iter().any(|&one| fits(state, one));
        let earlier = before.iter().filter(goes_on).copied().collect();
        fitting = earlier;
    }
    left
}

/// An alternative that is chosen of a visit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChosenAlternative {
    /// Among the visit's [alternatives](VisitSet::alternatives).
    pub number: usize,
    /// The door by which the robot left, if the alternative does not say it.
    pub door: Option<Door>,
}

/// A choice that fits the world, and the state at its start; `None` if no choice does.
pub fn choice_in_world(
    graph: &EmbeddedGraph,
    marker: &impl Marker,
    starts: &[State],
    visits: &[VisitSet],
) -> Option<(State, Vec<ChosenAlternative>)> {
    let after = states_after(graph, marker, starts, visits);
    let Some(last) = after.last() else { return Some((*starts.first()?, Vec::new())) };
    let mut state = *last.first()?;
    let mut choice = Vec::with_capacity(visits.len());
    for (index, visit) in visits.iter().enumerate().rev() {
        let before = index.checked_sub(1).map_or(starts, |before| after[before].as_slice());
        let is_last = index + 1 == visits.len();
        let step = &VisitStep { graph, marker, way: visit.way(), is_last };
        let alternatives = || visit.alternatives().iter().copied().enumerate();
        let (earlier, chosen) = before.iter().find_map(|&earlier| {
            alternatives().find_map(|(number, alternative)| {
                let at =
                    step.after(earlier, alternative).iter().position(|&found| found == state)?;
                let open = alternative.filter(|chosen| chosen.door.is_none() && !is_last);
                let door = open.and_then(|chosen| chosen.doors().nth(at));
                Some((earlier, ChosenAlternative { number, door }))
            })
        })?;
        state = earlier;
        choice.push(chosen);
    }
    choice.reverse();
    Some((state, choice))
}

/// A visit in a world.
pub(super) struct VisitStep<'g, M> {
    pub(super) graph: &'g EmbeddedGraph,
    pub(super) marker: &'g M,
    pub(super) way: VisitWay,
    pub(super) is_last: bool,
}

impl<M: Marker> VisitStep<'_, M> {
    /// The states after a visit with this alternative: none if it does not fit, several if it leaves the door open.
    pub(super) fn after(&self, state: State, alternative: Option<VisitAlternative>) -> Vec<State> {
        let Self { graph, marker, way, is_last } = *self;
        let at = |pose: Dart| State { pose, ..state };
        let Some(alternative) = alternative else {
            let back = way == VisitWay::Back;
            return vec![if back { at(graph.opposite(state.pose)) } else { state }];
        };
        let world = GraphWorld::with_aid(graph, marker, state.placed);
        if alternative.percept != world.at(state).sensed() {
            return Vec::new();
        }
        if is_last && alternative.door.is_none() {
            return vec![state];
        }
        let far = |door| at(graph.opposite(graph.behind(state.pose, door)));
        alternative.doors().map(far).collect()
    }
}
