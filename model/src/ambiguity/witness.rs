//! The witnesses: a relation between states that no walk leaves, or a walk that distinguishes states.
//! Each is verified without regard to how it was found.

use super::PlacedRobot;
use crate::{
    aid::{Action, Aid, Places, RefusedAction, State},
    embedded_graph::Dart,
    percept::Percept,
};

/// Pairs of states, one of each world, in which two robots that do the same can be: a bisimulation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Relation(pub Vec<(State<Places>, State<Places>)>);

/// What two robots do to find that their worlds differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Walk {
    /// What both do; it may be nothing.
    pub actions: Vec<Action>,
    /// What the one and the other perceives at the end. It is the first difference.
    pub percepts: [Percept; 2],
}

impl Relation {
    /// Whether this proves that the robots in the two worlds, with what they can do there, will
    /// never perceive a difference: they are among the pairs; in each pair they perceive the same
    /// and can do the same; and whatever they do leads to another of the pairs.
    // paper: fig1.base, fig1.step, fig1.cases
    pub fn verify<'a>(&self, one: &PlacedRobot<'a>, other: &PlacedRobot<'a>) -> bool {
        if [one, other].iter().any(|robot| !robot.aid().is_seen_everywhere(robot.graph())) {
            return false;
        }
        let mut pairs = self.0.clone();
        pairs.sort_unstable();
        let among = |here: &State<Places>, there: &State<Places>| {
            let order =
                |pair: &(State<Places>, State<Places>)| (&pair.0, &pair.1).cmp(&(here, there));
            pairs.binary_search_by(order).is_ok()
        };
        // A claim may name states that do not exist.
        let exists = |world: &PlacedRobot<'_>, state: &State<Places>| {
            let is_dart = |dart: Dart| dart.at() < world.graph().dart_count();
            is_dart(state.pose) && world.aid().exists(world.graph(), &state.placed)
        };
        if !self.0.iter().all(|(here, there)| exists(one, here) && exists(other, there)) {
            return false;
        }
        let is_kept = |(here, there): &(State<Places>, State<Places>)| {
            let (one, other) = (one.clone().at(here.clone()), other.clone().at(there.clone()));
            let actions = one.actions();
            one.sensed() == other.sensed()
                && actions == other.actions()
                && actions.into_iter().all(|action| {
                    let after = |world: &PlacedRobot<'_>| {
                        let mut world = world.clone();
                        world.act(action).map(|()| world.state())
                    };
                    match (after(&one), after(&other)) {
                        (Ok(here), Ok(there)) => among(&here, &there),
                        _ => false,
                    }
                })
        };
        among(&one.state(), &other.state()) && self.0.iter().all(is_kept)
    }
}

impl Walk {
    /// Whether this walk can be walked by the robots in both worlds, and they perceive the same up
    /// to its end, and there what it says, which differs.
    pub fn verify<'a>(&self, one: &PlacedRobot<'a>, other: &PlacedRobot<'a>) -> bool {
        let replayed = |world: &PlacedRobot<'_>| replay(world.clone(), &self.actions);
        let (Ok(mut one), Ok(mut other)) = (replayed(one), replayed(other)) else {
            return false;
        };
        let ends = one.pop().zip(other.pop());
        one == other && ends == Some(self.percepts.into()) && self.percepts[0] != self.percepts[1]
    }
}

/// What a robot perceives: at the start, and after each action.
///
/// # Errors
/// Returns an error if an action is impossible.
pub fn replay(
    mut world: PlacedRobot<'_>,
    actions: &[Action],
) -> Result<Vec<Percept>, RefusedAction> {
    let mut percepts = vec![world.sensed()];
    for &action in actions {
        world.act(action)?;
        percepts.push(world.sensed());
    }
    Ok(percepts)
}
