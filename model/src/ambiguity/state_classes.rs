//! Classes of states that no walk distinguishes: a witness that is linear in the number of states, where
//! the pairs of a [`Relation`](super::Relation) are quadratic.

use super::space::{PlacedRobot, Space, StateLabel, States};
use crate::aid::{Aid, Places, State};

/// A partition of the states of two worlds: states of one class are indistinguishable.
#[derive(Clone, Debug)]
pub struct StateClasses {
    states: [States; 2],
    /// The class of each state of the first and then of the second world.
    class: Vec<u32>,
    count: usize,
}

impl StateClasses {
    /// The classes of the states of two worlds, from 0, those of the first world first.
    pub(super) fn new(states: [States; 2], class: Vec<u32>) -> Self {
        let count = class.iter().max().map_or(0, |&last| last as usize + 1);
        Self { states, class, count }
    }

    pub fn count(&self) -> usize {
        self.count
    }

    /// The states of each class: those of the first world, and those of the second.
    pub fn classes(&self) -> Vec<[Vec<State<Places>>; 2]> {
        let mut classes = vec![[Vec::new(), Vec::new()]; self.count];
        let (one, other) = self.class.split_at(self.states[0].len().min(self.class.len()));
        for (side, of_side) in [one, other].into_iter().enumerate() {
            for (number, &class) in (0..).zip(of_side) {
                classes[class as usize][side].push(self.states[side].state(number));
            }
        }
        classes
    }

    /// Whether this proves that the robots in the two worlds never perceive a difference: each state has
    /// a class, the robots are in states of one class, states of one class have the same percept, and
    /// what the robots can do leads from them to states of one class.
    // paper: fig1.base, fig1.step, fig1.cases
    pub fn verify<'a>(&self, one: &PlacedRobot<'a>, other: &PlacedRobot<'a>) -> bool {
        /// What states of one class have in common.
        type Common = (StateLabel, Vec<u32>);
        let mut common: Vec<Option<Common>> = vec![None; self.count];
        let mut first = 0;
        let mut starts = Vec::new();
        for (robot, known) in [one, other].into_iter().zip(&self.states) {
            if !robot.aid().is_seen_everywhere(robot.graph()) {
                return false;
            }
            let Some(class) = self.class.get(first..first + known.len()) else { return false };
            let class_of = |state: &State<Places>| Some(class[known.number(state)? as usize]);
            // The states of the robot's own world, which may be others than those that are known.
            let space = Space::new(robot);
            let states = (0..space.states.len() as u32).map(|number| space.states.state(number));
            let classes: Option<Vec<u32>> = states.map(|state| class_of(&state)).collect();
            let Some(classes) = classes.filter(|classes| classes.len() == known.len()) else {
                return false;
            };
            for (number, &label) in space.labels.iter().enumerate() {
                let maps = &space.maps[..space.arities[number]];
                let leads_to = maps.iter().map(|map| classes[map[number] as usize]).collect();
                let this: Common = (label, leads_to);
                let Some(common) = common.get_mut(classes[number] as usize) else { return false };
                if common.as_ref().is_some_and(|common| *common != this) {
                    return false;
                }
                *common = Some(this);
            }
            let Some(start) = class_of(&robot.state()) else { return false };
            starts.push(start);
            first += known.len();
        }
        first == self.class.len() && starts.windows(2).all(|pair| pair[0] == pair[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        aid::named,
        ambiguity::{Bisimulation, Comparison},
        embedded_graph::{Dart, EmbeddedGraph},
    };

    #[test]
    fn classes_are_verified_only_if_their_states_are_indistinguishable() {
        for kind in ["none", "directional", "movable", "movable-directional", "string-1", "team-2"]
        {
            let (one, other) = (EmbeddedGraph::chain(3), EmbeddedGraph::chain(3));
            let aid = named(kind).unwrap();
            let comparison = Comparison::new(aid, (&one, Dart(0)), (&other, Dart(0)));
            let poses = [Dart(0); 2];
            let found = comparison.bisimulation(poses, 0, &()).unwrap().unwrap();
            let Bisimulation::Classes(classes) = found else { panic!("at most 0 pairs") };
            let [here, there] = comparison.starts(poses);
            assert!(classes.verify(&here, &there), "{kind}");
            assert!(classes.count() > 1);
            let wrong = |class: Vec<u32>| {
                let wrong = StateClasses { class, ..classes.clone() };
                assert!(!wrong.verify(&here, &there), "{kind}: {wrong:?}");
            };
            wrong(vec![0; classes.class.len()]);
            wrong(Vec::new());
            wrong(classes.class[1..].to_vec());
            wrong([&classes.class[..], &[0]].concat());
            for state in 0..classes.class.len() {
                for class in (0..=classes.count() as u32).filter(|&c| c != classes.class[state]) {
                    let mut moved = classes.class.clone();
                    moved[state] = class;
                    wrong(moved);
                }
            }
        }
    }
}
