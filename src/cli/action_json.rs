//! What a robot does, in JSON.

use serde_json::{Value, json};
use toposlam_model::world::Action;

/// A door as its number, another action as its word.
pub(super) fn action_json(action: Action) -> Value {
    match action {
        Action::Take(door) => json!(door.0),
        other => json!(other.to_string()),
    }
}
