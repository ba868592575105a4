//! What the page is told, as the JSON that its script reads.

use std::fmt;

use serde_json::{Value, json};

use super::{Action, Mark, Side, State, WalkPage};

/// The data as JSON that can stand inside a `script` element: nothing in it ends the element or
/// begins a comment.
pub(super) fn json(page: &WalkPage) -> String {
    let walk = page.walk.map(|walk| walk.iter().map(Action::to_string).collect::<Vec<_>>());
    let data = json!({
        "sides": page.sides.iter().map(side).collect::<Vec<_>>(),
        "relation": page.relation,
        "walk": walk,
    });
    data.to_string().replace('<', "\\u003c")
}

fn side(side: &Side) -> Value {
    json!({
        "name": side.name,
        "start": side.start,
        "states": side.states.iter().map(state).collect::<Vec<_>>(),
    })
}

fn state(state: &State) -> Value {
    let actions = state.actions.iter().map(|(action, to)| json!([action.to_string(), to]));
    json!({
        "text": state.text,
        "dart": state.dart.0,
        "vertex": state.vertex.0,
        "percept": state.percept,
        "actions": actions.collect::<Vec<_>>(),
        "marks": state.marks.iter().copied().map(mark).collect::<Vec<_>>(),
    })
}

/// What kind of mark it is, and the vertex or the dart that it is told by.
fn mark(mark: Mark) -> Value {
    match mark {
        Mark::At(vertex) => json!(["at", vertex.0]),
        Mark::OtherAt(vertex) => json!(["other at", vertex.0]),
        Mark::Along(dart) => json!(["along", dart.0]),
        Mark::On(dart) => json!(["on", dart.0]),
        Mark::OnAwayFrom(dart) => json!(["on away from", dart.0]),
        Mark::Carried => json!(["carried"]),
    }
}

impl fmt::Display for Action {
    /// A door is its number.
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Door(door) => write!(formatter, "{}", door.0),
            Self::PickUp => formatter.write_str("pick up"),
            Self::Drop => formatter.write_str("drop"),
        }
    }
}
