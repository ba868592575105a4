//! The data of the page, as JSON for its script.

use serde_json::{Value, json};
use toposlam_model::{
    ambiguity::{Bisimulation, PlacedRobot},
    marker::{Marker, MarkerPart},
    world::Action,
};

use super::{MOST_PAIRS, WalkPage, side::WalkSide};
use crate::page::template::in_script;

/// The data as JSON that can stand inside a `script` element.
pub(super) fn json(page: &WalkPage, [one, other]: [&WalkSide; 2]) -> String {
    let relation = match page.comparison.bisimulation(page.poses, MOST_PAIRS, &()) {
        Ok(Some(Bisimulation::Relation(relation))) => {
            let places = |&(here, there): &_| [one.place(here), other.place(there)];
            Some(relation.0.iter().map(places).collect::<Vec<_>>())
        }
        _ => None,
    };
    let walk = page.comparison.walk(page.poses);
    let walk = walk.map(|walk| walk.actions.iter().map(Action::to_string).collect::<Vec<_>>());
    let data = json!({
        "sides": [side(one), side(other)],
        "relation": relation,
        "walk": walk,
    });
    in_script(&data)
}

/// A world, and the states of its robot.
pub(in crate::page) fn side(side: &WalkSide) -> Value {
    let states = side.robots.iter().zip(&side.actions);
    json!({
        "name": side.world.name,
        "start": 0,
        "states": states.map(|(robot, actions)| state(side, robot, actions)).collect::<Vec<_>>(),
    })
}

fn state(side: &WalkSide, robot: &PlacedRobot, actions: &[(Action, usize)]) -> Value {
    let actions = actions.iter().map(|(action, to)| json!([action.to_string(), to]));
    // A marker that stays in its place is in the picture.
    let marker = match robot.state().placed {
        _ if !robot.marker().is_movable() => Value::Null,
        Some(placed) => json!(robot.graph().vertex(placed).0),
        None => json!("carried"),
    };
    let pointing = robot.state().placed.and_then(|placed| {
        let parts = robot.marker().parts(robot.graph(), placed);
        parts.into_iter().find_map(|part| match part {
            MarkerPart::Pointing(dart) => Some(dart.0),
            _ => None,
        })
    });
    json!({
        "text": side.world.state_text(robot.marker(), robot.state()),
        "dart": robot.pose().0,
        "vertex": robot.graph().vertex(robot.pose()).0,
        "percept": robot.sensed().to_string(),
        "actions": actions.collect::<Vec<_>>(),
        "marker": marker,
        "pointing": pointing,
    })
}
