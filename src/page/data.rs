//! What the page is told, as the JSON that its script reads.

use serde_json::{Value, json};

use super::{WalkPage, side::Side};
use crate::model::{
    ambiguity::PlacedRobot,
    marker::{Look, Part},
    world::Action,
};

/// The data as JSON that can stand inside a `script` element: nothing in it ends the element or
/// begins a comment.
pub(super) fn json(page: &WalkPage, [one, other]: [&Side; 2]) -> String {
    let relation = page.comparison.relation(page.poses).map(|relation| {
        let places = |&(here, there): &_| [one.place(here), other.place(there)];
        relation.0.iter().map(places).collect::<Vec<_>>()
    });
    let walk = page.comparison.walk(page.poses);
    let walk = walk.map(|walk| walk.actions.iter().map(Action::to_string).collect::<Vec<_>>());
    let data = json!({
        "sides": [side(one), side(other)],
        "relation": relation,
        "walk": walk,
    });
    data.to_string().replace('<', "\\u003c")
}

fn side(side: &Side) -> Value {
    let states = side.robots.iter().zip(&side.actions);
    json!({
        "name": side.world.name,
        "start": 0,
        "states": states.map(|(robot, actions)| state(side, robot, actions)).collect::<Vec<_>>(),
    })
}

fn state(side: &Side, robot: &PlacedRobot, actions: &[(Action, usize)]) -> Value {
    let actions = actions.iter().map(|(action, to)| json!([action.to_string(), to]));
    let marks = match robot.state().placed {
        Some(placed) => robot.marker().parts(robot.graph(), placed).into_iter().map(mark).collect(),
        None => vec![json!(["carried"])],
    };
    json!({
        "text": side.world.state_text(robot.marker(), robot.state()),
        "dart": robot.pose().0,
        "vertex": robot.graph().vertex(robot.pose()).0,
        "percept": robot.sensed().to_string(),
        "actions": actions.collect::<Vec<_>>(),
        "marks": marks,
    })
}

/// What a part of a marker is, and the vertex or the dart that it is told by.
fn mark(part: Part) -> Value {
    match part {
        Part::At { vertex, look: Look::One } => json!(["at", vertex.0]),
        Part::At { vertex, look: Look::Other } => json!(["other at", vertex.0]),
        Part::Pointing(dart) => json!(["along", dart.0]),
        Part::OnEdge(dart) => json!(["on", dart.0]),
        Part::OnEdgeAlong(dart) => json!(["on away from", dart.0]),
    }
}
