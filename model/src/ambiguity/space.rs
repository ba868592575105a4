//! All states of a placed world: where the robot can be, and where the marker.

use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::Marker,
    percept::Percept,
    world::{Action, GraphWorld, State},
};

pub type PlacedRobot<'a> = GraphWorld<'a, &'a dyn Marker>;

/// What a robot knows in a state without moving: its percept, and whether it carries the marker.
pub(super) type StateLabel = (Percept, bool);

/// How many states a robot and the marker can be in, in a world: its poses, and for each of them, with
/// a marker that can be moved, where this lies or that it is carried.
pub fn state_count(graph: &EmbeddedGraph, marker: &dyn Marker) -> usize {
    States::from_start(graph, marker, Dart(0)).len()
}

/// The states of a placed world, numbered.
#[derive(Clone, Debug)]
pub(super) struct States {
    darts: usize,
    /// The places of the marker, each as the first of the facing darts alike.
    places: Vec<Dart>,
    /// Whether the robot can carry it: these states come after those of all places.
    can_carry: bool,
}

impl States {
    pub(super) fn from_start(graph: &EmbeddedGraph, marker: &dyn Marker, facing: Dart) -> Self {
        let can_carry = marker.is_movable();
        let places = if can_carry {
            graph.darts().filter(|&dart| marker.first_alike(graph, dart) == dart).collect()
        } else {
            vec![marker.first_alike(graph, facing)]
        };
        Self { darts: graph.dart_count(), places, can_carry }
    }

    pub(super) fn len(&self) -> usize {
        self.darts * (self.places.len() + usize::from(self.can_carry))
    }

    pub(super) fn state(&self, number: u32) -> State {
        let place = number as usize / self.darts;
        let pose = Dart(number % self.darts as u32);
        State { pose, placed: self.places.get(place).copied() }
    }

    pub(super) fn number(&self, state: State) -> u32 {
        let place = match state.placed {
            Some(placed) => self.places.binary_search(&placed).unwrap_or_default(),
            None => self.places.len(),
        };
        (place * self.darts) as u32 + state.pose.0
    }
}

/// What is sensed in each state of a placed world, and three maps of states to states that every
/// action is made of: turn to the next dart, cross to the opposite one, and pick up or drop the
/// marker, where that is possible (else stay).
///
/// A partition that keeps percepts and these maps keeps percepts and actions, for door `i` is `i`
/// turns and a crossing. The converse holds too: crossing is door 0, and turning is door 1 and then
/// door 0, which brings the robot back, having now come in by the next dart.
pub(super) struct Space {
    pub(super) labels: Vec<StateLabel>,
    pub(super) maps: Vec<Vec<u32>>,
}

impl Space {
    pub(super) fn from_states(graph: &EmbeddedGraph, marker: &dyn Marker, states: &States) -> Self {
        let count = states.len();
        let mut labels = Vec::with_capacity(count);
        let (mut turn, mut cross, mut handle) =
            (Vec::with_capacity(count), Vec::with_capacity(count), Vec::new());
        // The state that it begins with does not matter.
        let world = GraphWorld::with_marker(graph, marker, Dart(0));
        for number in 0..count {
            let state = states.state(number as u32);
            let mut world = world.clone().at(state);
            labels.push((world.sensed(), world.carries()));
            turn.push(states.number(State { pose: graph.clockwise(state.pose), ..state }));
            cross.push(states.number(State { pose: graph.opposite(state.pose), ..state }));
            if states.can_carry {
                // Where neither is possible, the state stays.
                let _ = world.act(Action::PickUp).or_else(|_| world.act(Action::Drop));
                handle.push(states.number(world.state()));
            }
        }
        let maps = if states.can_carry { vec![turn, cross, handle] } else { vec![turn, cross] };
        Self { labels, maps }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        any_graph::{Class, any_graph},
        marker::MARKERS,
        percept::Door,
    };

    proptest! {
        #[test]
        fn every_action_is_made_of_the_maps(graph in any_graph(Class::Multigraph, 6)) {
            for marker in MARKERS {
                let states = States::from_start(&graph, marker, Dart(0));
                let space = Space::from_states(&graph, marker, &states);
                for number in 0..states.len() as u32 {
                    let state = states.state(number);
                    prop_assert_eq!(states.number(state), number);
                    let world = GraphWorld::with_marker(&graph, marker, Dart(0)).at(state);
                    for action in world.actions() {
                        let mut world = world.clone();
                        world.act(action).unwrap();
                        let map = |map: usize, number: u32| space.maps[map][number as usize];
                        let expected = match action {
                            Action::Take(Door(turns)) => {
                                map(1, (0..turns).fold(number, |number, _| map(0, number)))
                            }
                            Action::PickUp | Action::Drop => map(2, number),
                        };
                        prop_assert_eq!(states.number(world.state()), expected);
                    }
                }
            }
        }
    }
}
