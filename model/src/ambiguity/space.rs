//! All states of a placed world: where the robot can be, and where its marking aid.

use hashbrown::HashMap;

use crate::{
    aid::{Aid, AnyAid, Places, State},
    embedded_graph::{Dart, EmbeddedGraph},
    percept::Percept,
    world::GraphWorld,
};

pub type PlacedRobot<'a> = GraphWorld<'a, AnyAid<'a>>;

/// What a robot knows in a state without moving: its percept, and what it holds.
pub(super) type StateLabel = (Percept, u32);

/// Whether a robot and its aid can be in more than so many states from a start: its poses, and for each of them the states
/// of an aid that moves.
pub fn has_more_states<'a>(
    graph: &'a EmbeddedGraph,
    aid: impl Into<AnyAid<'a>>,
    facing: Dart,
    most: usize,
) -> bool {
    let start = GraphWorld::with_aid(graph, aid.into(), facing);
    if start.aid().moves() {
        Space::reachable(&start, most).is_none()
    } else {
        graph.dart_count() > most
    }
}

/// The states of a placed world that are reachable from a start, numbered.
#[derive(Clone, Debug)]
pub(super) enum States {
    /// The poses, in the order of the darts; the aid stays.
    Poses { darts: usize, placed: Places },
    /// In the order in which they were met.
    Met { list: Vec<State<Places>>, number: HashMap<State<Places>, u32> },
}

impl States {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Poses { darts, .. } => *darts,
            Self::Met { list, .. } => list.len(),
        }
    }

    /// The state with a number, which must be less than their number.
    pub(super) fn state(&self, number: u32) -> State<Places> {
        match self {
            Self::Poses { placed, .. } => State { pose: Dart(number), placed: placed.clone() },
            Self::Met { list, .. } => list[number as usize].clone(),
        }
    }

    /// The number of a state, if it is reachable.
    pub(super) fn number(&self, state: &State<Places>) -> Option<u32> {
        match self {
            Self::Poses { darts, placed } => {
                (state.pose.at() < *darts && state.placed == *placed).then_some(state.pose.0)
            }
            Self::Met { number, .. } => number.get(state).copied(),
        }
    }

    /// The number of a state, which is a new one if it was not met.
    fn meet(&mut self, state: &State<Places>) -> u32 {
        if let Some(number) = self.number(state) {
            return number;
        }
        let new = self.len() as u32;
        if let Self::Met { list, number } = self {
            number.insert(state.clone(), new);
            list.push(state.clone());
        }
        new
    }
}

/// What is sensed in each state of a placed world, and where each action leads.
///
/// With a fixed marker, every action is made of two maps of states to states: turn to the next dart, and cross to the
/// opposite one. A partition that keeps percepts and these maps keeps percepts and actions, for door `i` is `i`
/// turns and a crossing. The converse holds too: crossing is door 0, and turning is door 1 and then
/// door 0, which brings the robot back, having now come in by the next dart. With an aid that moves, map `i` is the
/// action with that place in the list of the state's actions; states with the same label have the same actions.
#[derive(Clone, Debug)]
pub(super) struct Space {
    pub(super) states: States,
    pub(super) labels: Vec<StateLabel>,
    /// Where a state has fewer actions it stays.
    pub(super) maps: Vec<Vec<u32>>,
    /// The number of maps of each state.
    pub(super) arities: Vec<usize>,
}

impl Space {
    /// The states that are reachable.
    pub(super) fn new(start: &PlacedRobot<'_>) -> Self {
        if start.aid().moves() {
            // There is no limit.
            Self::reachable(start, usize::MAX).unwrap_or_else(|| Self::of_poses(start))
        } else {
            Self::of_poses(start)
        }
    }

    /// The poses of a robot whose aid stays.
    fn of_poses(start: &PlacedRobot<'_>) -> Self {
        let (graph, aid, mut state) = (start.graph(), start.aid(), start.state());
        let darts = graph.dart_count();
        let label = |pose| {
            state.pose = pose;
            let percept = Percept {
                degree: graph.degree_around(pose),
                sighting: aid.sighting(graph, &state),
            };
            (percept, aid.held(&state))
        };
        Self {
            labels: graph.darts().map(label).collect(),
            maps: vec![
                graph.darts().map(|dart| graph.clockwise(dart).0).collect(),
                graph.darts().map(|dart| graph.opposite(dart).0).collect(),
            ],
            arities: vec![2; darts],
            states: States::Poses { darts, placed: state.placed },
        }
    }

    /// The states that are reachable by actions; `None` if there are more than `most`.
    fn reachable(start: &PlacedRobot<'_>, most: usize) -> Option<Self> {
        let mut states = States::Met { list: Vec::new(), number: HashMap::new() };
        states.meet(&start.state());
        let (mut labels, mut arities, mut leads) = (Vec::new(), Vec::new(), Vec::new());
        let mut here = start.clone();
        while labels.len() < states.len() {
            let state = states.state(labels.len() as u32);
            here = here.at(state.clone());
            labels.push((here.sensed(), here.held()));
            let actions = here.actions();
            arities.push(actions.len());
            for action in actions {
                // Each action of a state is possible.
                let _ = here.act(action);
                leads.push(states.meet(&here.state()));
                here = here.at(state.clone());
            }
            if states.len() > most {
                return None;
            }
        }
        let all = 0..states.len() as u32;
        let mut maps: Vec<Vec<u32>> = Vec::new();
        let mut leads = leads.into_iter();
        for (number, &arity) in arities.iter().enumerate() {
            maps.resize_with(maps.len().max(arity), || all.clone().collect());
            for (map, to) in maps.iter_mut().zip(leads.by_ref().take(arity)) {
                map[number] = to;
            }
        }
        Some(Self { states, labels, maps, arities })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        aid::{AIDS, Action},
        any_graph::{Class, any_graph},
        percept::Door,
    };

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn every_action_is_made_of_the_maps(graph in any_graph(Class::Multigraph, 3)) {
            for aid in AIDS {
                let start = GraphWorld::with_aid(&graph, aid.into(), Dart(0));
                let space = Space::new(&start);
                for number in 0..space.states.len() as u32 {
                    let state = space.states.state(number);
                    prop_assert_eq!(space.states.number(&state), Some(number));
                    let world = start.clone().at(state);
                    for (place, action) in world.actions().into_iter().enumerate() {
                        let mut world = world.clone();
                        world.act(action).unwrap();
                        let map = |map: usize, number: u32| space.maps[map][number as usize];
                        let expected = match action {
                            Action::Take(Door(turns)) if !aid.moves() => {
                                map(1, (0..turns).fold(number, |number, _| map(0, number)))
                            }
                            _ => map(place, number),
                        };
                        prop_assert_eq!(space.states.number(&world.state()), Some(expected));
                    }
                }
            }
        }

        /// A robot knows what it can do.
        #[test]
        fn states_with_the_same_label_have_the_same_actions(graph in any_graph(Class::Multigraph, 3)) {
            for aid in AIDS {
                let start = GraphWorld::with_aid(&graph, aid.into(), Dart(0));
                let states = Space::new(&start).states;
                let mut known: HashMap<StateLabel, Vec<Action>> = HashMap::new();
                for state in (0..states.len() as u32).map(|number| states.state(number)) {
                    let world = start.clone().at(state.clone());
                    let actions = world.actions();
                    let label = (world.sensed(), world.held());
                    let same = known.entry(label).or_insert_with(|| actions.clone());
                    prop_assert_eq!(&*same, &actions, "{:?} {:?}", aid, state);
                }
            }
        }
    }
}
