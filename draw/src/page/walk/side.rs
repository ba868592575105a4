//! One of the two worlds of a walk page: its picture, and every state that its robot can be in.

use std::collections::HashMap;

use toposlam_model::{
    ambiguity::PlacedRobot,
    embedded_graph::Dart,
    format::named_world::NamedWorld,
    world::{Action, State},
};

use crate::picture::{WorldPicture, svg};

/// A world, and the states that a robot can reach in it.
pub(in crate::page) struct WalkSide<'a> {
    pub(in crate::page) world: &'a NamedWorld,
    /// The robot in each state that it can reach, the start first.
    pub(in crate::page) robots: Vec<PlacedRobot<'a>>,
    /// The actions in each state, and the index of the state after each.
    pub(in crate::page) actions: Vec<Vec<(Action, usize)>>,
    place: HashMap<State, usize>,
}

impl<'a> WalkSide<'a> {
    pub(in crate::page) fn new(world: &'a NamedWorld, start: &PlacedRobot<'a>) -> Self {
        let robots = vec![start.clone()];
        let place = HashMap::from([(start.state(), 0)]);
        let mut side = Self { world, robots, actions: Vec::new(), place };
        while let Some(robot) = side.robots.get(side.actions.len()).cloned() {
            let leads_to = |action| {
                let mut after = robot.clone();
                after.act(action).ok()?;
                let place = *side.place.entry(after.state()).or_insert_with(|| {
                    side.robots.push(after);
                    side.robots.len() - 1
                });
                Some((action, place))
            };
            let actions = robot.actions().filter_map(leads_to).collect();
            side.actions.push(actions);
        }
        side
    }

    /// The index of a state; that of the start if the robot cannot reach the state.
    pub(in crate::page) fn place(&self, state: State) -> usize {
        self.place.get(&state).copied().unwrap_or_default()
    }

    /// The drawing of the world, without texts; and without its marker if that can be moved, because the
    /// page draws it.
    pub(in crate::page) fn picture(&self) -> String {
        let marker = *self.robots[0].marker();
        let start = self.placed().filter(|_| !marker.is_movable());
        svg(&WorldPicture {
            start,
            marker,
            title: "",
            caption: "",
            ..WorldPicture::from(self.world)
        })
    }

    pub(in crate::page) fn marker_place(&self) -> String {
        let marker = *self.robots[0].marker();
        let picture =
            WorldPicture { start: self.placed(), marker, ..WorldPicture::from(self.world) };
        let place = picture.marker_place().unwrap_or_default();
        if marker.is_movable() {
            format!("{place} at first; a red robot carries it")
        } else {
            place
        }
    }

    /// The facing dart that places the marker at the start.
    fn placed(&self) -> Option<Dart> {
        self.robots[0].state().placed
    }
}
