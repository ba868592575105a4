//! The output of `--json`: one object a line, with actions and percepts.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::{Value, json};
use toposlam_model::{percept::Percept, world::Action};

use super::Failure;

/// Prints one object on a line of its own.
pub(super) fn print_object(out: &mut dyn Write, object: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string(object).map_err(io::Error::from)?;
    Ok(writeln!(out, "{text}")?)
}

/// A door is a number, another action is a word.
pub(super) fn action_json(action: Action) -> Value {
    match action {
        Action::Take(door) => json!(door.0),
        other => json!(other.to_string()),
    }
}

/// The degree, and the sighting in words.
pub(super) fn percept_json(percept: Percept) -> Value {
    json!({ "degree": percept.degree, "sighting": percept.sighting.to_string() })
}
